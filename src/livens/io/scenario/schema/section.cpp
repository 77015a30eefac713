// SPDX-License-Identifier: BSD-3-Clause
// A table of a file, read by its schema: types, ranges, units, missing and unknown keys (docs/scenario.md).
#include "livens/io/scenario/schema/section.h"

#include <algorithm>
#include <cmath>

#include "livens/base/text.h"
#include "livens/io/scenario/schema/other_keys.h"
#include "livens/io/scenario/schema/other_words.h"
#include "livens/io/scenario/schema/value_help.h"
#include "livens/io/scenario/text/units.h"

namespace livens::inline io_internal {

namespace {

using NodeKind = Node::Kind;

/// Reads the value of one key, and reports it once if it does not fit.
class ValueReader {
public:
    ValueReader(Value& value, const std::string& label, Findings& findings)
        : value_(value), key_(*value.key), label_(label), findings_(findings)
    {}

    bool read()
    {
        const Node& node = *value_.node;
        return read(is_of_other_form(node) ? key_.type.other : key_.type.form, node);
    }

private:
    bool is_of_other_form(const Node& node) const
    {
        switch (key_.type.other) {
        case Form::choice:
            return node.kind == NodeKind::text && index_of(key_.choices, node.text()) >= 0;
        case Form::text:
            return node.kind == NodeKind::text;
        case Form::names:
            return node.kind == NodeKind::array &&
                   (key_.type.form != Form::rows ||
                    (!node.items().empty() && node.items().front().kind == NodeKind::text));
        case Form::row:
        case Form::tables:
            return node.kind == NodeKind::array;
        case Form::rows:
            return node.kind == NodeKind::array && !node.items().empty() &&
                   node.items().front().kind == NodeKind::array;
        case Form::table:
            return node.kind == NodeKind::table;
        default:
            return false;
        }
    }

    bool read(Form form, const Node& node)
    {
        switch (form) {
        case Form::flag:
            return read_flag(node);
        case Form::truth:
            return node.kind == NodeKind::truth ? keep(node.number) : wrong_type(node);
        case Form::integer:
            return node.kind == NodeKind::integer ? accept(node, node.number) : wrong_type(node);
        case Form::number:
            return read_number(node);
        case Form::text:
            return read_text(node, value_.text);
        case Form::choice:
            return read_choice(node);
        case Form::names:
            return read_each(node, key_.type.count,
                             [&](const Node& item) { return read_text(item, value_.texts.emplace_back()); });
        case Form::named_texts:
            return read_named_texts(node);
        case Form::row:
            return read_row(node, key_.type.count);
        case Form::rows:
            return read_each(node, key_.type.count, [&](const Node& item) { return read_row(item, 3); });
        case Form::table:
            return read_table(node);
        case Form::tables:
            return read_tables(node);
        case Form::model:
            return node.kind == NodeKind::table || wrong_type(node);
        case Form::none:
            break;
        }
        return false;
    }

    std::string subject() const { return "'" + std::string(key_.name) + "' of " + label_; }
    std::string demand() const { return subject() + " must be " + describe_type(key_); }

    bool wrong_type(const Node& node, std::string help = {})
    {
        if (help.empty()) help = help_with_form(key_, node);
        return findings_.error(
            node.place, "wrong-type", demand() + ", not " + std::string(describe(node.kind)),
            {node.kind == NodeKind::text ? std::string(key_.formulas) : "", std::move(help)});
    }

    bool keep(double x)
    {
        value_.numbers.push_back(x);
        return true;
    }

    bool read_flag(const Node& node)
    {
        if (node.kind != NodeKind::truth) return wrong_type(node);
        return node.number == 1 ||
               findings_.error(node.place, "out-of-range", subject() + " can only be true",
                               {"", "leave the key out"});
    }

    bool read_number(const Node& node)
    {
        if (node.kind == NodeKind::integer || node.kind == NodeKind::number) {
            if (std::isfinite(node.number)) return accept(node, node.number);
            return findings_.error(node.place, "not-finite",
                                   subject() + " must be finite, not " + to_text(node.number));
        }
        if (node.kind != NodeKind::text || unit_.empty()) return wrong_type(node);
        const Quantity other = parse_quantity(node.text(), key_.other_unit);
        if (!key_.other_unit.empty() && other.error.empty()) {
            value_.has_other_unit = true;
            return accept(node, other.value);
        }
        Quantity quantity = parse_quantity(node.text(), unit_);
        if (quantity.error.empty()) {
            value_.has_unit = true;
            return accept(node, quantity.value);
        }
        if (!key_.other_unit.empty() && quantity.help.starts_with("it is measured in"))
            quantity.help += " or " + std::string(key_.other_unit);
        return findings_.error(node.place, "unit",
                               subject() + " cannot be \"" + node.text() + "\": " + quantity.error,
                               {std::string(key_.formulas), quantity.help});
    }

    bool accept(const Node& node, double x)
    {
        keep(x);
        if (key_.range.holds(x)) return true;
        const bool is_version = key_.name == "format";
        const std::string unit = key_.unit.empty() ? "" : " " + std::string(key_.unit);
        return findings_.error(node.place, is_version ? "format-version" : "out-of-range",
                               subject() + " must be " + key_.range.text() + unit + ", not " + to_text(x),
                               {"", is_version ? "this version of livens reads format = 1" : ""});
    }

    bool read_text(const Node& node, std::string& text)
    {
        if (node.kind != NodeKind::text) return wrong_type(node, "strings are written in quotes");
        text = node.text();
        return true;
    }

    bool read_choice(const Node& node)
    {
        if (!read_text(node, value_.text)) return false;
        if (index_of(key_.choices, value_.text) >= 0) return true;
        const std::string other = in_other_words(value_.text, key_.choices);
        return findings_.error(node.place, "unknown-choice", demand() + ", not \"" + value_.text + "\"",
                               {"", other.empty() ? suggest(value_.text, key_.choices) : other});
    }

    /// A list of so many (0: of any number but none).
    template <class ReadItem>
    bool read_each(const Node& node, int count, ReadItem read_item)
    {
        if (node.kind != NodeKind::array) return wrong_type(node);
        const std::vector<Node>& items = node.items();
        if (count == 0 ? items.empty() : items.size() != static_cast<std::size_t>(count))
            return findings_.error(node.place, "wrong-type",
                                   demand() + ", not " + std::to_string(items.size()),
                                   {"", help_with_form(key_, node)});
        return std::all_of(items.begin(), items.end(), read_item);
    }

    bool read_named_texts(const Node& node)
    {
        if (node.kind != NodeKind::table) return wrong_type(node);
        return std::ranges::all_of(node.entries(), [&](const Entry& entry) {
            if (entry.value.kind == NodeKind::text)
                return read_text(entry.value, value_.texts.emplace_back());
            return findings_.error(entry.value.place, "wrong-type",
                                   "'" + entry.key + "' in " + subject() + " must be a string, not " +
                                       std::string(describe(entry.value.kind)),
                                   {"", "strings are written in quotes"});
        });
    }

    bool read_row(const Node& node, int count)
    {
        ++value_.n_rows;
        std::size_t i = 0;
        return read_each(node, count, [&](const Node& item) {
            unit_ = key_.unit_of(i++, node.items().size());
            return read_number(item);
        });
    }

    bool read_table(const Node& node)
    {
        const std::string name(key_.name);
        if (node.kind != NodeKind::table) return wrong_type(node);
        const bool is_top = find_key(root_table().keys_of(any_kind), name) == &key_;
        value_.sections.emplace_back(node, *key_.child, is_top ? "[" + name + "]" : name + " of " + label_,
                                     findings_);
        return value_.sections.back().is_valid();
    }

    bool read_tables(const Node& node)
    {
        const std::string name(key_.name);
        const bool is_inside = key_.type.form == Form::table;   // one table may stand instead
        const std::string help = is_inside ? "write " + name + " = [{ " +
                                                 std::string(key_.child->keys.front().name) + " = ... }, ...]"
                                           : "each " + name + " begins with a line [[" + name + "]]";
        if (node.kind != NodeKind::array) return wrong_type(node, help);
        value_.sections.reserve(node.items().size());
        bool is_valid = true;
        for (const Node& item : node.items()) {
            if (item.kind != NodeKind::table) return wrong_type(item, help);
            const Node* title = item.find("name");
            const bool is_named = title != nullptr && title->kind == NodeKind::text && !title->text().empty();
            const std::string label =
                is_named ? "'" + title->text() + "'" : std::to_string(value_.sections.size() + 1);
            value_.sections.emplace_back(item, *key_.child,
                                         name + " " + label + (is_inside ? " of " + label_ : ""), findings_);
            is_valid = value_.sections.back().is_valid() && is_valid;
        }
        return is_valid;
    }

    Value& value_;
    const Key& key_;
    const std::string& label_;
    Findings& findings_;
    std::string_view unit_ = key_.unit;   ///< of the number that is read
};

/// The kind that the file chooses, or its default; any_kind for a word that is none.
int kind_of(const Node& node, const Table& table)
{
    if (table.chooser.empty()) return any_kind;
    const Key& key = *find_key(table.keys_of(any_kind), table.chooser);
    const Node* given = node.find(table.chooser);
    if (given != nullptr && given->kind != NodeKind::text) return any_kind;
    if (given == nullptr) return index_of(key.choices, key.fallback);
    const int kind = index_of(key.choices, given->text());
    std::string_view with;
    // Of a word of another program the keys are judged as those of the kind that it means.
    return kind >= 0 ? kind : index_of(key.choices, in_other_words(given->text(), key.choices, with));
}

}   // namespace

Section::Section(const Node& node, const Table& table, std::string label, Findings& findings)
    : table_(&table), node_(&node), label_(std::move(label)), findings_(&findings),
      kind_(kind_of(node, table))
{
    const int errors_before = findings.n_errors();
    const std::vector<const Key*> keys = table.keys_of(kind_);
    values_.reserve(node.entries().size());
    for (const Entry& entry : node.entries()) read(entry, keys);
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
    is_valid_ = findings.n_errors() == errors_before;
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
        value.is_valid = ValueReader(value, label_, *findings_).read();
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
