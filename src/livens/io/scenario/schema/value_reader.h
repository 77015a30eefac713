// SPDX-License-Identifier: BSD-3-Clause
// The value of one key, by its type: forms, units, ranges, expressions.
#pragma once

#include <string>

#include "livens/io/scenario/schema/section.h"

namespace livens::inline io_internal {

/// Fills in what `value.node` says of `value.key`, in a table that messages call `label`. False after an
/// error, or where a parameter is needed that is wrong itself.
bool read_value(Value& value, const std::string& label, Findings& findings, const Parameters& parameters);

}   // namespace livens::inline io_internal
