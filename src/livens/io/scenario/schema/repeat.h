// SPDX-License-Identifier: BSD-3-Clause
// [[repeat]]: bodies, joints, drives, loads and sensors that are stated once and stand many times.
#pragma once

#include <optional>

#include "livens/io/scenario/schema/schema.h"
#include "livens/io/scenario/text/parameters.h"

namespace livens::inline io_internal {

/// The tree with the tables of its repeats behind those that stand in the file, and without `repeat`. In
/// texts
/// `{i}` and `{i-1}` are numbers, and in computed numbers and formulas `i` is one, too. Each copy says in
/// findings which one it is. Empty after an error.
std::optional<Node> without_repeats(const Node& root, const Parameters& parameters, Findings& findings);

}   // namespace livens::inline io_internal
