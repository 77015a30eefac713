// SPDX-License-Identifier: BSD-3-Clause
// Words of expressions: functions, names with points, and what other languages call the same.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "livens/time/expression.h"

namespace livens::inline time_internal {

struct Function {
    std::string_view name;
    Expression::Operation operation;
    int n_arguments;
};

/// Null: it is no function of one operation.
const Function* find_function(std::string_view name);
/// Whether it is a function that is made of others.
bool is_composed(std::string_view name);
/// What was perhaps meant, and what is known.
std::string known_names(std::string_view word, const std::vector<std::string>& symbols);

/// What a text that cannot be read from there on has of other languages, and how it is written here; empty:
/// nothing that is known.
std::string_view habit_at(std::string_view text, std::size_t at);

bool is_digit(char c);
bool begins_name(char c);
/// A name with all its points, and where it ends in the text.
struct Name {
    std::string word;
    std::size_t end;
    bool is_open = false;   ///< a quote is not closed
};
Name name_at(std::string_view text, std::size_t at);

}   // namespace livens::inline time_internal
