// SPDX-License-Identifier: BSD-3-Clause
// Trees of scenarios, made value by value, and as text.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "livens/base/linear.h"
#include "livens/io/scenario/text/document.h"

namespace livens::inline io_internal {

/// A table; everything in it is said to stand at one place.
class TableMaker {
public:
    explicit TableMaker(const SourceLocation& place);

    TableMaker& whole(std::string_view key, int value);
    TableMaker& number(std::string_view key, double value);
    TableMaker& text(std::string_view key, const std::string& value);
    TableMaker& texts(std::string_view key, const std::vector<std::string>& values);
    TableMaker& numbers(std::string_view key, std::span<const double> values);
    TableMaker& vector(std::string_view key, const Vector3& value) { return numbers(key, value.a); }
    TableMaker& rows(std::string_view key, const std::vector<Vector3>& values);
    TableMaker& table(std::string_view key, TableMaker&& value);
    /// Nothing, if there are none.
    TableMaker& tables(std::string_view key, std::vector<TableMaker>&& values);

    Node take() { return std::move(node_); }

private:
    Node& add(std::string_view key, Node::Kind kind);

    Node node_;
};

/// The tree as a file: what has no header first, then tables and arrays of tables of the root.
std::string toml_of(const Node& root);

}   // namespace livens::inline io_internal
