// SPDX-License-Identifier: BSD-3-Clause
// A value of a wrong form is shown as it has to be written, with what was given inside it where that is
// possible.
#include "livens/io/scenario/schema/value_help.h"

#include <algorithm>

#include "livens/base/text.h"
#include "livens/io/scenario/schema/other_keys.h"

namespace livens::inline io_internal {

namespace {

using NodeKind = Node::Kind;

bool is_number(const Node& node) { return node.kind == NodeKind::integer || node.kind == NodeKind::number; }

std::string toml_of(const Node& node)
{
    if (node.kind == NodeKind::text) return '"' + node.text() + '"';
    return is_number(node) ? to_text(node.number) : std::string("..");
}

/// [0, -1, 0] for "-y" where a direction is wanted; empty for other words.
std::string direction_of(std::string_view word)
{
    const bool is_negative = word.starts_with('-');
    if (is_negative || word.starts_with('+')) word.remove_prefix(1);
    const std::string axis = without_case(word);
    if (axis.size() != 1 || axis[0] < 'x' || axis[0] > 'z') return {};
    std::string text = "[";
    for (char c = 'x'; c <= 'z'; ++c)
        text += std::string(c == 'x' ? "" : ", ") + (c != axis[0] ? "0" : is_negative ? "-1" : "1");
    return text + "]";
}

std::string help_with_row(const Key& key, const Node& node, int count)
{
    const std::string name(key.name);
    if (node.kind == NodeKind::text && key.unit.empty()) {
        const std::string direction = direction_of(node.text());
        return direction.empty() ? "" : name + " = " + direction;
    }
    if (key.name == "gravity" && is_number(node))
        return "along the world axes: gravity = [0, 0, " + to_text(-std::abs(node.number)) + "]";
    if (count != 3 || !(is_number(node) || node.kind == NodeKind::text)) return {};
    const std::string one = toml_of(node);
    // Lengths of equal edges; elsewhere nobody knows along which axis it is meant.
    if (key.range.is_limited()) return name + " = [" + one + ", " + one + ", " + one + "]";
    return name + " = [" + one + ", 0, 0] along x, [0, " + one + ", 0] along y, [0, 0, " + one + "] along z";
}

/// The list that was given, where the key takes as many numbers; else "..".
std::string list_for(const Key& key, const Node& node)
{
    if (node.kind != NodeKind::array || key.type.form != Form::row) return "..";
    const std::vector<Node>& items = node.items();
    if (static_cast<int>(items.size()) != key.type.count) return "..";
    std::string text = "[";
    for (const Node& item : items) text += (&item == &items.front() ? "" : ", ") + toml_of(item);
    return text + "]";
}

std::string help_with_table(const Key& key, const Node& node)
{
    const std::string name(key.name);
    std::string inside;
    const std::vector<const Key*> keys = key.child->keys_of(any_kind);
    if (node.kind == NodeKind::text && find_key(keys, node.text()) != nullptr) {
        inside = node.text() + " = ..";
    } else {
        std::vector<const Key*> needed;
        std::ranges::copy_if(keys, std::back_inserter(needed), [](const Key* k) { return k->required; });
        const auto* items = node.kind == NodeKind::array ? &node.items() : nullptr;
        for (std::size_t i = 0; i < needed.size(); ++i) {
            const bool is_given = items != nullptr && items->size() == needed.size();
            inside += (i == 0 ? "" : ", ") + std::string(needed[i]->name) + " = " +
                      (is_given ? toml_of((*items)[i]) : "..");
        }
        if (inside.empty()) inside = std::string(keys.front()->name) + " = " + list_for(*keys.front(), node);
    }
    return "tables are written in braces: " + name + " = { " + inside + " }";
}

}   // namespace

std::string help_with_form(const Key& key, const Node& node)
{
    const std::string name(key.name);
    const bool is_list = node.kind == NodeKind::array;
    switch (key.type.form) {
    case Form::number:
    case Form::integer:
        if (is_list && node.items().size() == 1)
            return "without brackets: " + name + " = " + toml_of(node.items().front());
        return {};
    case Form::row:
        // Two coordinates of what lies in a plane.
        if (is_list && key.type.count == 3 && node.items().size() == 2)
            return "the model is in space: " + name + " = [" + toml_of(node.items()[0]) + ", " +
                   toml_of(node.items()[1]) + ", 0]";
        return is_list ? "" : help_with_row(key, node, key.type.count);
    case Form::names:
        if (key.name == "expression" && node.kind == NodeKind::text)
            return "one formula for each axis: expression = [\"0\", \"0\", " + toml_of(node) + "]";
        if (key.name == "between" && (is_list ? node.items().size() == 1 : node.kind == NodeKind::text))
            return "two bodies; what stands still is the world: between = [\"world\", " +
                   toml_of(is_list ? node.items().front() : node) + "]";
        return {};
    case Form::text:
        if (is_list && node.items().size() == 1)
            return "without brackets: " + name + " = " + toml_of(node.items().front());
        return {};
    case Form::table:
        return help_with_table(key, node);
    default:
        return {};
    }
}

}   // namespace livens::inline io_internal
