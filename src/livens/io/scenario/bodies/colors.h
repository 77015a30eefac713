// SPDX-License-Identifier: BSD-3-Clause
// Colours as texts.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "livens/base/linear.h"

namespace livens::inline io_internal {

/// Of "#rgb", "#rrggbb" or a name of CSS, in letters of any case: red, green, blue from 0 to 1, in sRGB.
std::optional<Vector3> parse_color(std::string_view text);

/// What to write instead of a text that is no colour.
std::string color_help(std::string_view text);

}   // namespace livens::inline io_internal
