// SPDX-License-Identifier: BSD-3-Clause
// What to type instead of a value of a wrong form.
#pragma once

#include <string>

#include "livens/io/scenario/schema/schema.h"
#include "livens/io/scenario/text/document.h"

namespace livens::inline io_internal {

/// "axis = [0, 1, 0]" for "y", "sphere = 0.1" for [0.1]; empty where nothing is likely.
std::string help_with_form(const Key& key, const Node& node);

}   // namespace livens::inline io_internal
