// SPDX-License-Identifier: BSD-3-Clause
// The pages of all codes.
#pragma once

#include <string_view>

namespace livens::inline io_internal {

/// docs/diagnostics.md, compiled in (cmake/diagnostics.cmake): a page begins with `## code`, pages stand in
/// the order of their codes.
std::string_view diagnostics_markdown();

}   // namespace livens::inline io_internal
