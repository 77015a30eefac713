// SPDX-License-Identifier: BSD-3-Clause
// From the text of an expression to its steps.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "livens/time/expression.h"

namespace livens::inline time_internal {

/// Throws InputError as Expression does.
std::vector<Expression::Step> read_expression(std::string_view text, const std::vector<std::string>& symbols,
                                              const ExpressionWords& words);

}   // namespace livens::inline time_internal
