// SPDX-License-Identifier: BSD-3-Clause
// The schema for editors, from the tables of schema.cpp.
// A slip shall be one error that names it. So a value that may have several forms is one list of types, whose
// other keywords concern one type each, and no `anyOf`, of which validators only say that nothing fitted;
// kinds are a chain of `if`, `then`, `else`, so that one alone is applied, and no `allOf`, which some editors
// do not bear; what a key may be stands in one place, with the table or, where kinds differ, with the kind;
// and a key that is not allowed is an error at the key.
#include <algorithm>

#include "livens/io/json.h"
#include "livens/io/scenario.h"
#include "livens/io/scenario/schema/schema.h"

namespace livens {

namespace {

void write_members(JsonWriter& json, const Table& table);
void write_forms(JsonWriter& json, const Key& key, std::vector<Form> forms, int count);

/// What the key is in the kinds that have it: one entry where they agree.
std::vector<const Key*> meanings(const Table& table, std::string_view name)
{
    std::vector<const Key*> all;
    for (const Key* key : table.keys_of(any_kind)) {
        const auto same = [&](const Key* other) {
            return other->doc == key->doc && other->unit == key->unit && other->type == key->type &&
                   other->range == key->range && other->choices == key->choices;
        };
        if (key->name == name && key->type != types::later && std::ranges::none_of(all, same))
            all.push_back(key);
    }
    return all;
}

void write_range(JsonWriter& json, const Key& key)
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (key.range.low > -infinity)
        json.member(key.range.above ? "exclusiveMinimum" : "minimum", key.range.low);
    if (key.range.high < infinity) json.member("maximum", key.range.high);
}

void write_words(JsonWriter& json, const Key& key)
{
    json.key("enum").begin_array();
    for (const std::string_view choice : key.choices) json.value(choice);
    json.end_array();
}

/// The names of JSON for a form; a number with a unit is a string.
std::vector<std::string_view> types_of(Form form)
{
    switch (form) {
    case Form::flag:
    case Form::truth:
        return {"boolean"};
    case Form::integer:
        return {"integer", "string"};
    case Form::number:
        return {"number", "string", "object"};   // of an unknown one
    case Form::text:
    case Form::condition:
    case Form::choice:
        return {"string"};
    case Form::names:
    case Form::row:
    case Form::rows:
    case Form::tables:
    case Form::templates:
        return {"array"};
    case Form::named_texts:
    case Form::named_numbers:
    case Form::factors:
    case Form::quantities:
    case Form::table:
    case Form::model:
        return {"object"};
    case Form::none:
        break;
    }
    return {};
}

/// What a list of this form holds.
Form form_of_items(Form form)
{
    if (form == Form::names) return Form::text;
    return form == Form::rows ? Form::row : Form::number;
}

void write_list(JsonWriter& json, const Key& key, const std::vector<Form>& lists, int count)
{
    std::vector<Form> items;
    for (const Form list : lists) items.push_back(form_of_items(list));
    json.key("items");
    write_forms(json, key, items, 3);   // rows inside of rows have three numbers
    json.member("minItems", std::max(1, count));
    if (count > 0) json.member("maxItems", count);
}

/// Of a number that is a string: a quantity with its unit, or an expression. Names, units and dimensions are
/// for the reader; refused is what has neither letter nor operator, "3", and signs that no expression has.
/// Validators print the pattern, so that it is short.
void write_pattern(JsonWriter& json)
{
    const std::string rest = "[^!?:;=<>&|%$#@~]*";
    json.member("pattern", "^" + rest + "([A-Za-z_)*/^\xc2\xb0]|[0-9] *[-+] *[0-9])" + rest + "$");
}

/// The keywords of one form, beside its type.
void write_keywords(JsonWriter& json, const Key& key, Form form)
{
    switch (form) {
    case Form::flag:
        json.member("const", true);
        break;
    case Form::number:
        if (key.type.form != Form::table && key.type.other != Form::table)
            json.key("required").begin_array().value("unknown").end_array();
        [[fallthrough]];
    case Form::integer:
        if (key.type.other != Form::condition) write_pattern(json);
        write_range(json, key);
        break;
    case Form::choice:
        write_words(json, key);
        break;
    case Form::named_texts:
        json.key("additionalProperties").begin_object().member("type", "string").end_object();
        break;
    case Form::named_numbers:
        json.key("propertyNames").begin_object().member("pattern", "^[A-Za-z_][A-Za-z0-9_]*$").end_object();
        [[fallthrough]];
    case Form::factors:
        json.key("additionalProperties").begin_object();
        json.key("type")
            .begin_array()
            .value("number")
            .value("string")
            .value("object")
            .end_array()
            .end_object();
        break;
    case Form::quantities:
        json.key("additionalProperties").begin_object();
        json.key("type")
            .begin_array()
            .value("number")
            .value("string")
            .value("array")
            .value("object")
            .end_array()
            .end_object();
        break;
    case Form::templates:
        json.member("$ref", "#/properties/" + std::string(key.name));
        break;
    case Form::table:
        write_members(json, *key.child);
        break;
    case Form::tables:
        json.key("items").begin_object().member("type", "object");
        write_members(json, *key.child);
        json.end_object().member("minItems", key.required ? 1 : 0).member("maxItems", max_bodies);
        break;
    default:
        break;
    }
}

/// Keywords concern one type each, so that those of several forms stand side by side.
void write_body(JsonWriter& json, const Key& key, std::vector<Form> forms, int count)
{
    std::vector<std::string_view> names;
    std::vector<Form> lists;
    for (const Form form : forms) {
        for (const std::string_view name : types_of(form))
            if (std::ranges::find(names, name) == names.end()) names.push_back(name);
        if (form == Form::names || form == Form::row || form == Form::rows) lists.push_back(form);
    }
    if (names.size() == 1) {
        json.member("type", names.front());
    } else if (!names.empty()) {
        json.key("type").begin_array();
        for (const std::string_view name : names) json.value(name);
        json.end_array();
    }
    for (const Form form : forms) write_keywords(json, key, form);
    if (!lists.empty()) write_list(json, key, lists, count);
}

void write_forms(JsonWriter& json, const Key& key, std::vector<Form> forms, int count)
{
    json.begin_object();
    write_body(json, key, std::move(forms), count);
    json.end_object();
}

void write_type(JsonWriter& json, const Key& key)
{
    const KeyType& type = key.type;
    const bool has_words = type.other == Form::choice;   // an `enum` concerns all types
    if (has_words) {
        json.key("anyOf").begin_array();
        write_forms(json, key, {type.form}, type.count);
        write_forms(json, key, {type.other}, type.count);
        json.end_array();
        return;
    }
    std::vector<Form> forms{type.form};
    if (type.other != Form::none) forms.push_back(type.other);
    write_body(json, key, forms, type.count);
}

void write_required(JsonWriter& json, const std::vector<Key>& keys)
{
    // What the names of points may say instead is for the reader to check.
    const auto is_needed = [](const Key& key) { return key.required && key.told_by.empty(); };
    if (std::ranges::none_of(keys, is_needed)) return;
    json.key("required").begin_array();
    for (const Key& key : keys)
        if (is_needed(key)) json.value(key.name);
    json.end_array();
}

std::string described(const Key& key)
{
    std::string text = key.doc;
    if (!key.unit.empty())
        text += " In " + std::string(key.unit) +
                (key.other_unit.empty() ? "" : " or " + std::string(key.other_unit)) +
                ", or a string with a unit.";
    if (!key.fallback.empty()) text += " Default: " + std::string(key.fallback) + ".";
    return text;
}

/// A key that cannot stand here. `false` would say the same of the whole table, line by line; this one is an
/// error at the key, in which validators print the title.
void write_refusal(JsonWriter& json, std::string_view name, const std::string& why)
{
    json.key(name).begin_object().key("not").begin_object().member("title", why).end_object().end_object();
}

/// A kind: what it needs beyond what all need, what its keys are where kinds differ, and what it has not.
void write_kind(JsonWriter& json, const Table& table, const Kind& kind, const std::vector<const Key*>& names)
{
    const std::vector<const Key*> own = table.keys_of(static_cast<int>(&kind - table.kinds.data()));
    const bool is_default = find_key(own, table.chooser)->fallback == kind.word;
    json.key("if").begin_object().key("properties").begin_object();
    json.key(table.chooser).begin_object().member("const", kind.word).end_object().end_object();
    if (!is_default)   // where the key is left out, the condition of the default holds
        json.key("required").begin_array().value(table.chooser).end_array();
    json.end_object().key("then").begin_object();
    write_required(json, kind.keys);
    json.key("properties").begin_object();
    for (const Key& key : kind.keys) {
        if (meanings(table, key.name).size() < 2) continue;
        json.key(key.name).begin_object().member("description", described(key));
        write_type(json, key);
        json.end_object();
    }
    for (const Key* key : names)
        if (find_key(own, key->name) == nullptr)
            write_refusal(json, key->name,
                          "no key of " + std::string(table.chooser) + " " + std::string(kind.word));
    json.end_object().end_object();
}

/// Each kind is the `else` of the one before.
void write_kinds(JsonWriter& json, const Table& table, std::size_t from, const std::vector<const Key*>& names)
{
    write_kind(json, table, table.kinds[from], names);
    if (from + 1 == table.kinds.size()) return;
    json.key("else").begin_object();
    write_kinds(json, table, from + 1, names);
    json.end_object();
}

void write_members(JsonWriter& json, const Table& table)
{
    std::vector<const Key*> names;   // the first entry of each
    for (const Key* key : table.keys_of(any_kind))
        if (key->type != types::later && find_key(names, key->name) == nullptr) names.push_back(key);
    write_refusal(json, "additionalProperties", "unknown key");
    json.key("properties").begin_object();
    for (const Key* key : names) {
        const std::vector<const Key*> all = meanings(table, key->name);
        std::string text;
        for (const Key* one : all) text += (text.empty() ? "" : " / ") + described(*one);
        json.key(key->name).begin_object().member("description", text);
        if (all.size() == 1) write_type(json, *key);
        json.end_object();
    }
    json.end_object();
    // Of the file as a whole nothing is required: while it is being written, every line of it would be wrong.
    if (&table != &root_table()) write_required(json, table.keys);
    if (!table.kinds.empty()) write_kinds(json, table, 0, names);
}

}   // namespace

std::string schema_json()
{
    JsonWriter json(1);
    json.begin_object().member("$schema", "https://json-schema.org/draft/2020-12/schema");
    json.member("title", "livens scenario, format 1").member("type", "object");
    write_members(json, root_table());
    return json.end_object().text() + "\n";
}

}   // namespace livens
