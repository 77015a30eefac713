// SPDX-License-Identifier: BSD-3-Clause
// Values of a tree that an import makes, and TOML of them: numbers as the shortest text that reads back.
#include "livens/io/import/table_maker.h"

#include <algorithm>
#include <cmath>

#include "livens/base/text.h"

namespace livens::inline io_internal {

namespace {

Node node_at(const SourceLocation& place, Node::Kind kind)
{
    Node node;
    node.kind = kind;
    node.place = place;
    if (kind == Node::Kind::text || kind == Node::Kind::array || kind == Node::Kind::table)
        node.content = std::make_unique<NodeContent>();
    return node;
}

Node number_at(const SourceLocation& place, double value)
{
    Node node = node_at(place, Node::Kind::number);
    node.number = value + 0.0;   // no -0
    return node;
}

Node text_at(const SourceLocation& place, const std::string& value)
{
    Node node = node_at(place, Node::Kind::text);
    node.content->text = value;
    return node;
}

Node numbers_at(const SourceLocation& place, std::span<const double> values)
{
    Node node = node_at(place, Node::Kind::array);
    for (const double x : values) node.content->items.push_back(number_at(place, x));
    return node;
}

/// A basic string, in which backslashes and quotes are escaped, and line breaks too, so that each value
/// stands on one line.
std::string toml_text(std::string_view text)
{
    std::string quoted = "\"";
    for (const char c : text) {
        constexpr std::string_view special = "\b\t\n\f\r\"\\", letters = "btnfr\"\\";
        const std::size_t at = special.find(c);
        if (at != std::string_view::npos)
            quoted += std::string("\\") + letters[at];
        else
            quoted += c;   // control characters do not get through parse_xml()
    }
    return quoted + "\"";
}

std::string toml_key(std::string_view key)
{
    const bool is_bare = !key.empty() && std::ranges::all_of(key, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
               c == '-';
    });
    return is_bare ? std::string(key) : toml_text(key);
}

/// TOML takes what has neither point nor exponent for an integer; `n` is that of inf and nan.
std::string toml_number(double value)
{
    const std::string text = to_text(value);
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string toml_value(const Node& node)
{
    std::string text;
    switch (node.kind) {
    case Node::Kind::truth:
        return node.number != 0 ? "true" : "false";
    case Node::Kind::integer:
        return to_text(node.number);
    case Node::Kind::number:
        return toml_number(node.number);
    case Node::Kind::text:
        return toml_text(node.text());
    case Node::Kind::table:
        for (const Entry& e : node.entries())
            text += (text.empty() ? "" : ", ") + toml_key(e.key) + " = " + toml_value(e.value);
        return text.empty() ? "{}" : "{ " + text + " }";
    case Node::Kind::array:
        for (const Node& item : node.items()) text += (text.empty() ? "" : ", ") + toml_value(item);
        return "[" + text + "]";
    case Node::Kind::date:
        break;   // none is made
    }
    return text;
}

/// What has a header [[..]] for each of its tables.
bool is_tables(const Node& node)
{
    return node.kind == Node::Kind::array && !node.items().empty() &&
           node.items().front().kind == Node::Kind::table;
}

std::string lines_of(const Node& table)
{
    std::string text;
    for (const Entry& e : table.entries()) text += toml_key(e.key) + " = " + toml_value(e.value) + "\n";
    return text;
}

}   // namespace

TableMaker::TableMaker(const SourceLocation& place) : node_(node_at(place, Node::Kind::table)) {}

Node& TableMaker::add(std::string_view key, Node::Kind kind)
{
    node_.content->entries.push_back({std::string(key), node_.place, node_at(node_.place, kind)});
    return node_.content->entries.back().value;
}

TableMaker& TableMaker::whole(std::string_view key, int value)
{
    add(key, Node::Kind::integer).number = value;
    return *this;
}

TableMaker& TableMaker::number(std::string_view key, double value)
{
    add(key, Node::Kind::number) = number_at(node_.place, value);
    return *this;
}

TableMaker& TableMaker::text(std::string_view key, const std::string& value)
{
    add(key, Node::Kind::text) = text_at(node_.place, value);
    return *this;
}

TableMaker& TableMaker::texts(std::string_view key, const std::vector<std::string>& values)
{
    Node& node = add(key, Node::Kind::array);
    for (const std::string& value : values) node.content->items.push_back(text_at(node_.place, value));
    return *this;
}

TableMaker& TableMaker::numbers(std::string_view key, std::span<const double> values)
{
    add(key, Node::Kind::array) = numbers_at(node_.place, values);
    return *this;
}

TableMaker& TableMaker::rows(std::string_view key, const std::vector<Vector3>& values)
{
    Node& node = add(key, Node::Kind::array);
    for (const Vector3& value : values) node.content->items.push_back(numbers_at(node_.place, value.a));
    return *this;
}

TableMaker& TableMaker::table(std::string_view key, TableMaker&& value)
{
    add(key, Node::Kind::table) = value.take();
    return *this;
}

/// Without tables the key is left out: an empty list of visuals would be refused.
TableMaker& TableMaker::tables(std::string_view key, std::vector<TableMaker>&& values)
{
    if (values.empty()) return *this;
    Node& node = add(key, Node::Kind::array);
    for (TableMaker& value : values) node.content->items.push_back(value.take());
    return *this;
}

/// Plain values first: behind a header they would belong to its table. Tables inside of tables are inline.
std::string toml_of(const Node& root)
{
    std::string text;
    for (const Entry& e : root.entries())
        if (e.value.kind != Node::Kind::table && !is_tables(e.value))
            text += toml_key(e.key) + " = " + toml_value(e.value) + "\n";
    for (const Entry& e : root.entries()) {
        if (e.value.kind == Node::Kind::table) text += "\n[" + toml_key(e.key) + "]\n" + lines_of(e.value);
        if (!is_tables(e.value)) continue;
        for (const Node& item : e.value.items()) text += "\n[[" + toml_key(e.key) + "]]\n" + lines_of(item);
    }
    return text;
}

}   // namespace livens::inline io_internal
