// SPDX-License-Identifier: BSD-3-Clause
// A TOML file as a tree of values that know where they stand. The only source that sees toml++ is
// toml_reader.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "livens/io/scenario/text/findings.h"

namespace livens::inline io_internal {

struct NodeContent;

/// A value of the file. Kept small: a table of loads may have a million numbers.
struct Node {
    enum class Kind : std::uint8_t { truth, integer, number, text, array, table, date };

    Kind kind = Kind::table;
    bool is_unknown = false;                ///< the value of an unknown number, see NumberedTree
    SourceLocation place;                   ///< of the value; of its header for a table with one
    double number = 0;                      ///< of truth, integer, number
    std::unique_ptr<NodeContent> content;   ///< of text, array, table

    const std::string& text() const;
    const std::vector<Node>& items() const;
    const std::vector<struct Entry>& entries() const;   ///< in the order of the file
    const Node* find(std::string_view key) const;       ///< of a table; null if there is none
};

struct Entry {
    std::string key;
    SourceLocation place;   ///< of the key
    Node value;
};

struct NodeContent {
    std::string text;
    std::vector<Node> items;
    std::vector<Entry> entries;
};

inline const std::string& Node::text() const { return content->text; }
inline const std::vector<Node>& Node::items() const { return content->items; }
inline const std::vector<Entry>& Node::entries() const { return content->entries; }

/// "a number", "a text", "a table", for messages.
std::string_view describe(Node::Kind kind);

/// Most values in a file (16 MiB of zeros would become a gigabyte of tree).
inline constexpr int max_scenario_values = 2'000'000;

/// What must hold before a parser may see the text: UTF-8 without control characters, values nested at most
/// max_scenario_depth deep (a dotted key counts with its parts), at most max_scenario_values values. The
/// parser and the destructors of its tree recurse. False after an error in `findings`.
bool scan(std::string_view text, Findings& findings);

/// The tree of a text that scan() has passed; empty after a syntax error, of which the parser finds the first
/// only.
std::optional<Node> parse_toml(std::string_view text, Findings& findings);
/// All places of a tree are in a file that Findings::add_file() knows.
void place_in(Node& node, int file);

}   // namespace livens::inline io_internal
