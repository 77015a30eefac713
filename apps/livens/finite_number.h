// SPDX-License-Identifier: BSD-3-Clause
// Numbers as people type them behind an option.
#pragma once

#include <string>
#include <string_view>

namespace livens::program {

/// A whole finite number, independent of the locale; else the usage is wrong: `option` wants `what`.
double finite_number(const std::string& text, std::string_view option, std::string_view what);

}   // namespace livens::program
