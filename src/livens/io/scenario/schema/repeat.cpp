// SPDX-License-Identifier: BSD-3-Clause
// Copies of tables, text by text. The schema says which texts are computed, so that the index may stand there
// as it is; elsewhere it stands in braces. Values and bytes of all copies are bounded before they are made.
#include "livens/io/scenario/schema/repeat.h"

#include <algorithm>
#include <cmath>

#include "livens/base/text.h"
#include "livens/io/scenario.h"
#include "livens/io/scenario/schema/section.h"

namespace livens::inline io_internal {

namespace {

constexpr std::string_view copied_kinds[] = {"body",  "point", "include", "joint",
                                             "drive", "stop",  "load",    "sensor"};

bool continues_word(char c) { return is_plain_name("_" + std::string(1, c)); }

/// How a text of the file is to be read.
enum class Role : std::uint8_t { word, number, formula };

bool is_numeric(Form form)
{
    return form == Form::number || form == Form::integer || form == Form::row || form == Form::rows ||
           form == Form::factors || form == Form::quantities;
}

Role role_of(const Key* key, bool is_in_list)
{
    if (key == nullptr || (!is_in_list && key->type.other == Form::text))
        return Role::word;   // names of points
    if (key->name == "expression" || key->name == "density_field") return Role::formula;
    const bool is_listed = is_in_list && is_numeric(key->type.other);
    return is_numeric(key->type.form) || is_listed ? Role::number : Role::word;
}

/// One copy.
class Copy {
public:
    struct Index {
        std::string name;
        long long value;
    };

    Copy(Index index, int origin, const Parameters& parameters, Findings& findings)
        : index_(std::move(index)), origin_(origin), parameters_(parameters), findings_(findings)
    {}

    /// Of a value of `key` (null: unknown), in a table of the schema.
    Node node(const Node& from, const Key* key, const Table* table, bool is_in_list = false)
    {
        Node to;
        to.kind = from.kind;
        to.is_unknown = from.is_unknown;
        to.place = placed(from.place);
        to.number = from.number;
        if (from.content == nullptr) return to;
        to.content = std::make_unique<NodeContent>();
        if (from.kind == Node::Kind::text)
            to.content->text = text(from.text(), from.place, role_of(key, is_in_list));
        const bool has_names = key != nullptr && key->type == types::two_points && !from.items().empty() &&
                               from.items().front().kind == Node::Kind::text;
        for (const Node& item : from.items())
            to.content->items.push_back(node(item, has_names ? nullptr : key, table, true));
        for (const Entry& entry : from.entries()) {
            const Key* inside = table == nullptr ? nullptr : find_key(table->keys_of(any_kind), entry.key);
            const Table* child = inside == nullptr ? nullptr : inside->child.get();
            // Factors stand under names of what is repeated as well.
            const bool has_factors = key != nullptr && key->type == types::factors;
            to.content->entries.push_back({has_factors ? text(entry.key, entry.place, Role::word) : entry.key,
                                           placed(entry.place),
                                           node(entry.value, has_factors ? key : inside, child)});
        }
        return to;
    }

private:
    SourceLocation placed(SourceLocation place) const
    {
        place.origin = origin_;
        return place;
    }

    std::string number(bool is_in_words) const
    {
        const std::string digits = std::to_string(index_.value);
        return is_in_words || index_.value >= 0 ? digits : "(" + digits + ")";
    }

    /// The index by its name, wherever it is a word of its own.
    std::string with_index(std::string_view from) const
    {
        std::string to;
        for (std::size_t at = 0; at < from.size();) {
            const char before = at > 0 ? from[at - 1] : ' ';
            const bool is_word = from.substr(at, index_.name.size()) == index_.name;
            const std::string_view rest = is_word ? from.substr(at + index_.name.size()) : std::string_view();
            const bool ends = is_word && (rest.empty() || (!continues_word(rest[0]) && rest[0] != '.'));
            const bool is_alone = ends && !continues_word(before) && before != '.';
            to += is_alone ? number(false) : std::string(1, from[at]);
            at += is_alone ? index_.name.size() : 1;
        }
        return to;
    }

    /// Of what stands in braces.
    std::string whole(const SourceLocation& place, std::string_view inside)
    {
        const Computed found = compute(with_index(inside), parameters_);
        const double value = found.amount.value;
        std::string said = found.error;
        if (found.code.empty() &&
            (found.amount.has_unit || value != std::round(value) || std::abs(value) > 1e15))
            said = "it is " + to_text(value) + (found.amount.has_unit ? " with a unit" : "") +
                   ", and braces hold whole numbers";
        if (said.empty() && found.code.empty()) return std::to_string(static_cast<long long>(value));
        if (!said.empty())
            findings_.error(placed(place), "repeat-braces",
                            "\"{" + std::string(inside) + "}\" cannot be read: " + said, {"", found.help});
        return {};
    }

    std::string text(const std::string& from, const SourceLocation& place, Role role)
    {
        std::string to;
        bool is_quoted = false;   // a name in a formula
        std::size_t plain = 0;    // from here on nothing has been copied
        const auto copy_until = [&](std::size_t end) {
            const std::string_view part = std::string_view(from).substr(plain, end - plain);
            to += role == Role::word || is_quoted ? std::string(part) : with_index(part);
            plain = end;
        };
        for (std::size_t at = 0; at < from.size(); ++at) {
            if (role == Role::formula && from[at] == '\'') {
                copy_until(at);
                is_quoted = !is_quoted;
            }
            if (from[at] != '{') continue;
            const std::size_t close = from.find('}', at);
            if (close == std::string::npos) {
                findings_.error(placed(place), "repeat-braces", "a brace is not closed in \"" + from + "\"",
                                {"", "write {" + index_.name + "}"});
                return {};
            }
            copy_until(at);
            const std::string value = whole(place, std::string_view(from).substr(at + 1, close - at - 1));
            const bool is_of_word =
                role == Role::word || is_quoted || (!to.empty() && continues_word(to.back()));
            to += is_of_word ? value : "(" + value + ")";
            plain = at = close + 1;
            --at;
        }
        copy_until(from.size());
        // "i" alone: a number in quotes would be one that lacks its unit.
        const bool is_index =
            role == Role::number && to != from && to.find_first_not_of("0123456789 \t") == std::string::npos;
        return is_index ? "(" + to + ")" : to;
    }

    Index index_;
    int origin_;
    const Parameters& parameters_;
    Findings& findings_;
};

/// Values and bytes of a tree.
struct Size {
    double values = 0, bytes = 0;

    void add(const Node& node)
    {
        values += 1;
        if (node.content == nullptr) return;
        bytes += static_cast<double>(node.text().size());
        for (const Node& item : node.items()) add(item);
        for (const Entry& entry : node.entries()) {
            bytes += static_cast<double>(entry.key.size());
            add(entry.value);
        }
    }
};

bool check_index(const Section& repeat, const Parameters& parameters)
{
    const std::string name = repeat.text("index");
    std::string reason;
    const std::string why = !is_plain_name(name)           ? "it has letters, digits and _, no digit first"
                            : is_word_of_expressions(name) ? "expressions have this word"
                            : parse_unit(name, reason)     ? "a unit is called so"
                            : parameters.find(name) != nullptr ? "a parameter is called so"
                                                               : "";
    return why.empty() ||
           repeat.error("index", "repeat-index", "an index cannot be called '" + name + "': " + why,
                        {"", "index = \"i\", say"});
}

/// A deep copy: nodes are not copied by accident.
Node same(const Node& from)
{
    Node to;
    to.kind = from.kind;
    to.is_unknown = from.is_unknown;
    to.place = from.place;
    to.number = from.number;
    if (from.content == nullptr) return to;
    to.content = std::make_unique<NodeContent>();
    to.content->text = from.text();
    for (const Node& item : from.items()) to.content->items.push_back(same(item));
    for (const Entry& entry : from.entries())
        to.content->entries.push_back({entry.key, entry.place, same(entry.value)});
    return to;
}

std::vector<Node>& tables_of(Node& root, std::string_view kind, const SourceLocation& place)
{
    for (Entry& entry : root.content->entries)
        if (entry.key == kind && entry.value.kind == Node::Kind::array) return entry.value.content->items;
    Entry& entry = root.content->entries.emplace_back(Entry{std::string(kind), place, {}});
    entry.value.kind = Node::Kind::array;
    entry.value.place = place;
    entry.value.content = std::make_unique<NodeContent>();
    return entry.value.content->items;
}

/// All copies of one repeat.
void repeat_tables(const Section& repeat, Node& root, Findings& findings)
{
    const Parameters& parameters = repeat.parameters();
    const long long first = repeat.integer("first"), count = repeat.integer("count");
    const std::string index = repeat.text("index");
    for (long long i = first; i < first + count; ++i) {
        const int origin = findings.add_origin(index + " = " + std::to_string(i));
        Copy copy({index, i}, origin, parameters, findings);
        for (const std::string_view kind : copied_kinds) {
            const Value* given = repeat.find(kind);
            if (given == nullptr) continue;
            const Table* table = find_key(root_table().keys_of(any_kind), kind)->child.get();
            for (const Node& one : given->node->items())
                tables_of(root, kind, given->node->place).push_back(copy.node(one, nullptr, table));
        }
    }
}

}   // namespace

std::optional<Node> without_repeats(const Node& root, const Parameters& parameters, Findings& findings)
{
    const int errors_before = findings.n_errors();
    Node all = same(root);
    std::erase_if(all.content->entries, [](const Entry& entry) { return entry.key == "repeat"; });
    Node only;   // the repeats, read by their own schema
    only.content = std::make_unique<NodeContent>();
    const Node& given = *root.find("repeat");
    only.content->entries.push_back({"repeat", given.place, same(given)});
    const Key* key = find_key(root_table().keys_of(any_kind), "repeat");
    const Table head{"top of the file", "", {*key}};
    const Section section(only, head, "the scenario", findings, parameters);
    Size size;
    bool are_valid = true;
    for (const Section& repeat : section.sections("repeat")) {
        // A count that needs a parameter which is wrong is not valid, though nothing is said of it.
        are_valid = repeat.is_valid() && check_index(repeat, parameters) && are_valid;
        if (!are_valid) continue;
        Size one;
        for (const Value& value : repeat.values()) one.add(*value.node);
        size.values += one.values * repeat.number("count");
        size.bytes += one.bytes * repeat.number("count");
        if (size.values > max_scenario_values || size.bytes > static_cast<double>(max_scenario_bytes))
            repeat.error("count", "resource-limit",
                         "the copies have more than " + std::to_string(max_scenario_values) + " values or " +
                             std::to_string(max_scenario_bytes) + " bytes");
    }
    if (!are_valid || findings.n_errors() > errors_before) return std::nullopt;
    for (const Section& repeat : section.sections("repeat")) repeat_tables(repeat, all, findings);
    return findings.n_errors() > errors_before ? std::nullopt : std::optional(std::move(all));
}

}   // namespace livens::inline io_internal
