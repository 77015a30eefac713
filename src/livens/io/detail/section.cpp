#include "livens/io/detail/section.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "livens/io/detail/units.h"
#include "livens/io/json.h"

namespace livens {

namespace {

using Kind = Node::Kind;

constexpr int any_count = -1;

/// Reads the value of one key, and reports it once if it does not fit.
class ValueReader {
public:
    ValueReader(Value& value, const std::string& label, Findings& findings)
        : value_(value),
          label_(label),
          findings_(findings)
    {}

    void read()
    {
        const Key& key = *value_.key;
        const Node& node = *value_.node;
        switch (key.type) {
        case KeyType::flag: value_.is_valid = read_flag(node); break;
        case KeyType::truth: value_.is_valid = read_truth(node); break;
        case KeyType::integer: value_.is_valid = read_integer(node); break;
        case KeyType::integer_or_choice: value_.is_valid = read_integer_or_choice(node); break;
        case KeyType::number: value_.is_valid = read_number(node); break;
        case KeyType::text: value_.is_valid = read_text(node, value_.text); break;
        case KeyType::choice: value_.is_valid = read_choice(node); break;
        case KeyType::vector3: value_.is_valid = read_row(node, 3); break;
        case KeyType::vector4: value_.is_valid = read_row(node, 4); break;
        case KeyType::triple: value_.is_valid = read_rows(node, 3); break;
        case KeyType::pair: value_.is_valid = read_rows(node, 2); break;
        case KeyType::rows: value_.is_valid = read_rows(node, any_count); break;
        case KeyType::principal_or_full:
            value_.is_valid = is_nested(node) ? read_rows(node, 3) : read_row(node, 3);
            break;
        case KeyType::list: value_.is_valid = read_row(node, any_count); break;
        case KeyType::number_or_list:
            value_.is_valid = node.kind == Kind::array ? read_row(node, any_count) : read_number(node);
            break;
        case KeyType::names: value_.is_valid = read_names(node); break;
        case KeyType::number_or_table:
            value_.is_valid = node.kind == Kind::table ? read_table(node) : read_number(node);
            break;
        case KeyType::table: value_.is_valid = read_table(node); break;
        case KeyType::tables: value_.is_valid = read_tables(node); break;
        case KeyType::later: break;
        }
    }

private:
    std::string subject() const { return "'" + std::string(value_.key->name) + "' of " + label_; }

    bool wrong_type(const Node& node, std::string help = {})
    {
        findings_.error(node.place, "wrong-type",
                        subject() + " must be " + describe_type(*value_.key) + ", not " +
                            std::string(describe(node.kind)),
                        {"", std::move(help)});
        return false;
    }

    bool wrong_count(const Node& node, std::size_t count)
    {
        findings_.error(
            node.place, "wrong-type",
            subject() + " must be " + describe_type(*value_.key) + "; here are " + std::to_string(count));
        return false;
    }

    bool read_flag(const Node& node)
    {
        if (node.kind != Kind::truth) return wrong_type(node);
        if (node.number == 1) return true;
        findings_.error(node.place, "out-of-range", subject() + " can only be true",
                        {"", "leave the key out"});
        return false;
    }

    bool read_truth(const Node& node)
    {
        if (node.kind != Kind::truth) return wrong_type(node);
        value_.numbers.push_back(node.number);
        return true;
    }

    bool read_integer_or_choice(const Node& node)
    {
        if (node.kind == Kind::integer) return accept(node, node.number);
        if (node.kind != Kind::text || !is_listed(value_.key->choices, node.text())) return wrong_type(node);
        value_.text = node.text();
        return true;
    }

    bool read_integer(const Node& node)
    {
        if (node.kind != Kind::integer) return wrong_type(node);
        return accept(node, node.number);
    }

    bool read_number(const Node& node)
    {
        if (node.kind == Kind::integer || node.kind == Kind::number) {
            if (std::isfinite(node.number)) return accept(node, node.number);
            findings_.error(node.place, "not-finite",
                            subject() + " must be finite, not " + to_text(node.number));
            return false;
        }
        if (node.kind != Kind::text || value_.key->unit.empty()) return wrong_type(node);
        const Quantity quantity = parse_quantity(node.text(), value_.key->unit);
        if (quantity.error.empty()) return accept(node, quantity.value);
        findings_.error(node.place, "unit",
                        subject() + " cannot be \"" + node.text() + "\": " + quantity.error,
                        {"", quantity.help});
        return false;
    }

    bool accept(const Node& node, double x)
    {
        value_.numbers.push_back(x);
        if (value_.key->range.holds(x)) return true;
        const std::string unit = value_.key->unit.empty() ? "" : " " + std::string(value_.key->unit);
        std::string code = "out-of-range";
        Advice advice;
        if (value_.key->name == "format") {
            code = "format-version";
            advice.help = "this version of livens reads format = 1";
        }
        findings_.error(node.place, code,
                        subject() + " must be " + value_.key->range.text() + unit + ", not " + to_text(x),
                        advice);
        return false;
    }

    bool read_text(const Node& node, std::string& text)
    {
        if (node.kind != Kind::text) return wrong_type(node, "texts stand in quotes");
        text = node.text();
        return true;
    }

    bool read_choice(const Node& node)
    {
        if (!read_text(node, value_.text)) return false;
        const Key& key = *value_.key;
        if (is_listed(key.choices, value_.text)) return true;
        if (is_listed(key.later, value_.text)) {
            findings_.error(node.place, "not-in-this-version",
                            subject() + " = \"" + value_.text + "\" is not part of this version of livens",
                            {"", "use " + quoted_alternatives(key.choices)});
            return false;
        }
        findings_.error(
            node.place, "unknown-choice",
            subject() + " must be " + quoted_alternatives(key.choices) + ", not \"" + value_.text + "\"",
            {"", suggest(value_.text, split_alternatives(key.choices))});
        return false;
    }

    static bool is_nested(const Node& node)
    {
        return node.kind == Kind::array && !node.items().empty() && node.items().front().kind == Kind::array;
    }

    bool read_row(const Node& node, int count)
    {
        if (node.kind != Kind::array) return wrong_type(node);
        const std::vector<Node>& items = node.items();
        if (count == any_count ? items.empty() : items.size() != static_cast<std::size_t>(count))
            return wrong_count(node, items.size());
        ++value_.n_rows;
        return std::all_of(items.begin(), items.end(), [&](const Node& item) { return read_number(item); });
    }

    bool read_rows(const Node& node, int count)
    {
        if (node.kind != Kind::array) return wrong_type(node);
        const std::vector<Node>& items = node.items();
        if (count == any_count ? items.empty() : items.size() != static_cast<std::size_t>(count))
            return wrong_count(node, items.size());
        return std::all_of(items.begin(), items.end(), [&](const Node& item) { return read_row(item, 3); });
    }

    bool read_names(const Node& node)
    {
        if (node.kind != Kind::array) return wrong_type(node);
        if (node.items().size() != 2) return wrong_count(node, node.items().size());
        value_.texts.resize(2);
        return read_text(node.items()[0], value_.texts[0]) && read_text(node.items()[1], value_.texts[1]);
    }

    bool read_table(const Node& node)
    {
        if (node.kind != Kind::table) return wrong_type(node);
        const std::string name(value_.key->name);
        const bool is_top = value_.key->table == TableId::root;
        value_.sections.emplace_back(node, value_.key->child,
                                     is_top ? "[" + name + "]" : name + " of " + label_, findings_);
        return value_.sections.back().is_valid();
    }

    bool read_tables(const Node& node)
    {
        const std::string name(value_.key->name);
        const std::string help = "each " + name + " begins with a line [[" + name + "]]";
        if (node.kind != Kind::array) return wrong_type(node, help);
        value_.sections.reserve(node.items().size());
        bool is_valid = true;
        int number = 0;
        for (const Node& item : node.items()) {
            ++number;
            if (item.kind != Kind::table) return wrong_type(item, help);
            const Node* title = item.find("name");
            const bool is_named = title != nullptr && title->kind == Kind::text && !title->text().empty();
            const std::string label = is_named ? name + " '" + title->text() + "'"
                                               : name + " " + std::to_string(number);
            value_.sections.emplace_back(item, value_.key->child, label, findings_);
            is_valid = value_.sections.back().is_valid() && is_valid;
        }
        return is_valid;
    }

    Value& value_;
    const std::string& label_;
    Findings& findings_;
};

/// The schema's entries of one table that belong to a type; all that belong to some type if it is not known.
std::vector<const Key*> keys_of(TableId table, std::string_view type)
{
    std::vector<const Key*> keys;
    for (const Key& key : schema_keys())
        if (key.table == table && (key.only.empty() || type.empty() || is_listed(key.only, type)))
            keys.push_back(&key);
    return keys;
}

const Key* find_key(const std::vector<const Key*>& keys, std::string_view name)
{
    for (const Key* key : keys)
        if (key->name == name) return key;
    return nullptr;
}

/// The type in hand by the discriminator; its fallback if it is missing, empty if it is not one of the
/// choices.
std::string type_of(const Node& node, TableId table)
{
    const std::string_view discriminator = schema_table(table).discriminator;
    if (discriminator.empty()) return {};
    const Key* key = find_key(keys_of(table, ""), discriminator);
    const Node* given = node.find(discriminator);
    if (given == nullptr) return std::string(key->fallback);
    if (given->kind != Kind::text || !is_listed(key->choices, given->text())) return {};
    return given->text();
}

void report_unknown(const Entry& entry, TableId table, const std::string& type, const std::string& label,
                    Findings& findings)
{
    const std::vector<const Key*> keys = keys_of(table, type);
    if (const Key* other = find_key(keys_of(table, ""), entry.key)) {
        findings.error(entry.place, "misplaced-key",
                       "'" + entry.key + "' of " + label + " does not belong to " +
                           std::string(schema_table(table).discriminator) + " \"" + type + "\"",
                       {"it belongs to " + quoted_alternatives(other->only), ""});
        return;
    }
    std::vector<std::string_view> names;
    for (const Key* key : keys)
        if (key->type != KeyType::later) names.push_back(key->name);
    findings.error(entry.place, "unknown-key", "unknown key '" + entry.key + "' in " + label,
                   {"", suggest(entry.key, names)});
}

}   // namespace

Section::Section(const Node& node, TableId table, std::string label, Findings& findings)
    : table_(table),
      node_(&node),
      label_(std::move(label)),
      type_(type_of(node, table))
{
    const int errors_before = findings.n_errors();
    const std::vector<const Key*> keys = keys_of(table, type_);
    values_.reserve(node.entries().size());
    for (const Entry& entry : node.entries()) {
        const Key* key = find_key(keys, entry.key);
        if (key == nullptr) {
            report_unknown(entry, table, type_, label_, findings);
            continue;
        }
        if (key->type == KeyType::later) {
            findings.error(entry.place, "not-in-this-version",
                           "'" + entry.key + "' of " + label_ + " is not part of this version of livens",
                           {std::string(key->doc), ""});
            continue;
        }
        values_.emplace_back();
        values_.back().key = key;
        values_.back().node = &entry.value;
        values_.back().key_place = entry.place;
        ValueReader(values_.back(), label_, findings).read();
    }
    const bool type_is_known = schema_table(table).discriminator.empty() || !type_.empty();
    for (const Key* key : keys) {
        if (!key->required || node.find(key->name) != nullptr || (!key->only.empty() && !type_is_known))
            continue;
        findings.error(table == TableId::root ? Place{1, 1, 1} : node.place, "missing-key",
                       label_ + " lacks '" + std::string(key->name) + "'",
                       {"'" + std::string(key->name) + "': " + std::string(key->doc), ""});
    }
    is_valid_ = findings.n_errors() == errors_before;
}

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

Place Section::place(std::string_view key) const
{
    const Value* v = value(key);
    return v != nullptr ? v->node->place : place();
}

std::vector<double> Section::numbers(std::string_view key) const
{
    if (const Value* v = find(key)) return v->numbers;
    const Key* k = find_key(keys_of(table_, type_), key);
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
    const Key* k = find_key(keys_of(table_, type_), key);
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

}   // namespace livens
