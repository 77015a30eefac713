// SPDX-License-Identifier: BSD-3-Clause
// What the names of points stand for, put into a table that has been read: who looks at it sees coordinates.
#include <algorithm>

#include "livens/io/scenario/schema/section.h"

namespace livens::inline io_internal {

namespace {

/// By names, or by tables that have some.
bool is_told_by(const Node* given)
{
    if (given == nullptr) return false;
    const bool is_list = given->kind == Node::Kind::array && !given->items().empty();
    const Node::Kind kind = (is_list ? given->items().front() : *given).kind;
    return kind == Node::Kind::text || (is_list && kind == Node::Kind::table);
}

}   // namespace

bool is_told_otherwise(const Key& key, const Node& node)
{
    for (std::string_view rest = key.told_by; !rest.empty();) {
        const std::size_t end = std::min(rest.find(' '), rest.size());
        if (is_told_by(node.find(rest.substr(0, end)))) return true;
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return false;
}

std::span<Section> Section::sections(std::string_view key)
{
    for (Value& v : values_)
        if (v.key->name == key) return v.sections;
    return {};
}

void Section::tell(std::string_view key, const std::vector<double>& numbers)
{
    for (Value& v : values_)
        if (v.key->name == key) v.numbers = numbers;
}

/// Its node is that of the value that tells it: complaints point there, and is_implied() knows it by that.
/// Values may move as one is added: pointers that find() has given are not to be used behind this.
void Section::imply(std::string_view key, const std::vector<std::string>& texts, const Value& told_by)
{
    Value implied;
    implied.key = key_of(key);
    implied.node = told_by.node;
    implied.is_valid = true;
    implied.text = texts.front();
    if (texts.size() > 1) implied.texts = texts;
    values_.push_back(std::move(implied));
}

bool Section::is_implied(std::string_view key) const
{
    const Value* v = value(key);
    if (v == nullptr) return false;
    return std::ranges::any_of(values_,
                               [&](const Value& other) { return &other != v && other.node == v->node; });
}

}   // namespace livens::inline io_internal
