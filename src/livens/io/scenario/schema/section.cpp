// SPDX-License-Identifier: BSD-3-Clause
// A table of a file, read by its schema: types, ranges, units, missing and unknown keys (docs/scenario.md).
#include "livens/io/scenario/schema/section.h"

#include <algorithm>
#include <cmath>

#include "livens/io/scenario/schema/other_words.h"
#include "livens/io/scenario/schema/value_reader.h"

namespace livens::inline io_internal {

namespace {

/// The kind that the file chooses, or its default; any_kind for a word that is none.
int kind_of(const Node& node, const Table& table)
{
    if (table.chooser.empty()) return any_kind;
    const Key& key = *find_key(table.keys_of(any_kind), table.chooser);
    const Node* given = node.find(table.chooser);
    if (given != nullptr && given->kind != Node::Kind::text) return any_kind;
    if (given == nullptr) return index_of(key.choices, key.fallback);
    const int kind = index_of(key.choices, given->text());
    std::string_view with;
    // Of a word of another program the keys are judged as those of the kind that it means.
    return kind >= 0 ? kind : index_of(key.choices, in_other_words(given->text(), key.choices, with));
}

}   // namespace

Section::Section(const Node& node, const Table& table, std::string label, Findings& findings,
                 const Parameters& parameters)
    : table_(&table), node_(&node), label_(std::move(label)), findings_(&findings), parameters_(&parameters),
      kind_(kind_of(node, table))
{
    const int errors_before = findings.n_errors();
    const std::vector<const Key*> keys = table.keys_of(kind_);
    values_.reserve(node.entries().size());
    for (const Entry& entry : node.entries()) read(entry, keys);
    // Keys of all kinds come first. Those of a kind cannot be missed where nobody knows which it is.
    const std::size_t n_known = kind_ == any_kind ? table.keys.size() : keys.size();
    for (std::size_t i = 0; i < n_known; ++i) {
        const Key& key = *keys[i];
        if (!key.required || node.find(key.name) != nullptr || is_meant(key.name)) continue;
        if (is_told_otherwise(key, node)) continue;
        const std::string name = "'" + std::string(key.name) + "'";
        findings.error(
            &table == &root_table() ? SourceLocation{1, 1, 1} : node.place, "missing-key",
            label_ + " lacks " + name,
            {name + ": " + key.doc, key.name == table.chooser ? type_told_by_keys(node, table) : ""});
    }
    // A number that needs a parameter which is wrong is not valid, though nothing is said of it.
    is_valid_ = findings.n_errors() == errors_before && std::ranges::all_of(values_, &Value::is_valid);
}

void Section::read(const Entry& entry, const std::vector<const Key*>& keys)
{
    const Key* key = find_key(keys, entry.key);
    if (key == nullptr) {
        report_unknown(entry, keys);
    } else if (key->type == types::later) {
        findings_->error(entry.place, "not-in-this-version",
                         "'" + entry.key + "' of " + label_ + " is not part of this version of livens",
                         {key->doc, ""});
    } else {
        Value& value = values_.emplace_back();
        value.key = key;
        value.node = &entry.value;
        value.is_valid = read_value(value, label_, *findings_, *parameters_);
    }
}

bool Section::is_meant(std::string_view key) const { return index_of(meant_, key) >= 0; }

const Value* Section::value(std::string_view key) const
{
    for (const Value& v : values_)
        if (v.key->name == key) return &v;
    return nullptr;
}

const Value* Section::find(std::string_view key) const
{
    const Value* v = value(key);
    return v != nullptr && v->is_valid ? v : nullptr;
}

SourceLocation Section::place(std::string_view key) const
{
    const Value* v = value(key);
    return v != nullptr ? v->node->place : place();
}

std::vector<double> Section::numbers(std::string_view key) const
{
    if (const Value* v = find(key)) return v->numbers;
    const Key* k = key_of(key);
    return k != nullptr ? fallback_numbers(*k) : std::vector<double>();
}

double Section::number(std::string_view key) const
{
    const std::vector<double> n = numbers(key);
    return n.empty() ? 0 : n.front();
}

std::string Section::text(std::string_view key) const
{
    if (const Value* v = find(key)) return v->text;
    const Key* k = key_of(key);
    return k != nullptr ? std::string(k->fallback) : std::string();
}

Vector3 Section::row(std::string_view key, int i) const
{
    const std::vector<double> n = numbers(key);
    Vector3 v{};
    for (int c = 0; c < 3; ++c)
        if (static_cast<std::size_t>(3 * i + c) < n.size()) v[c] = n[static_cast<std::size_t>(3 * i + c)];
    return v;
}

Matrix3 Section::columns(std::string_view key) const
{
    Matrix3 m{};
    for (int i = 0; i < 3; ++i) m.set_column(i, row(key, i));
    return m;
}

std::span<const Section> Section::sections(std::string_view key) const
{
    const Value* v = value(key);
    return v != nullptr ? std::span<const Section>(v->sections) : std::span<const Section>();
}

bool Section::error(std::string_view key, std::string_view code, std::string message, Advice advice) const
{
    return findings_->error(place(key), code, std::move(message), std::move(advice));
}

bool Section::at_most_one(std::initializer_list<std::string_view> keys, std::string_view code) const
{
    std::string_view first;
    for (const std::string_view key : keys) {
        if (!has(key)) continue;
        if (!first.empty())
            return error(key, code,
                         "'" + std::string(key) + "' and '" + std::string(first) + "' of " + label_ +
                             " exclude each other",
                         {"", "keep one of them"});
        first = key;
    }
    return true;
}

bool Section::refuse(std::initializer_list<std::string_view> keys, std::string_view code,
                     const std::string& reason) const
{
    bool is_clean = true;
    for (const std::string_view key : keys)
        if (has(key))
            is_clean =
                error(key, code, "'" + std::string(key) + "' of " + label_ + " has no meaning: " + reason,
                      {"", "leave it out"});
    return is_clean;
}

}   // namespace livens::inline io_internal
