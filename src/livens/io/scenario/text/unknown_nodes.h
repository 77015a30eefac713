// SPDX-License-Identifier: BSD-3-Clause
// Unknown numbers of a file: tables { unknown = guess, low = .., high = .. } where numbers stand.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "livens/io/scenario/text/document.h"
#include "livens/io/scenario/text/parameters.h"

namespace livens::inline io_internal {

struct StatedUnknown {
    std::string name;                ///< "friction.damping"; of a parameter its name
    std::vector<std::size_t> path;   ///< from the root: places among entries and items
    SourceLocation place = {}, guess_place = {};
    std::string unit = {};   ///< SI, if the guess has one
    double guess = 0;
    std::optional<double> low = {}, high = {};
    bool is_parameter = false;
};

/// A tree with the unknown numbers that it states, whose values stand in it as numbers.
struct NumberedTree {
    Node root;
    std::vector<StatedUnknown> unknowns;
};

/// Empty: there are none. Guesses and bounds are computed from the parameters of the file, with these
/// overrides, which take the place of guesses. What is wrong goes to `findings`.
std::optional<NumberedTree> with_guesses(const Node& root, std::span<const Override> overrides,
                                         Findings& findings);
/// A copy with other values.
Node with_numbers(const NumberedTree& tree, std::span<const double> values);
/// The text of a file in which values stand as guesses, by the names of unknowns.
std::string with_found_guesses(std::string text, std::span<const std::string> names,
                               std::span<const double> values);

}   // namespace livens::inline io_internal
