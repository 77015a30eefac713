// SPDX-License-Identifier: BSD-3-Clause
// The schema for editors and for people.
// Both come from the tables of schema.cpp. Kinds are `if`/`then` in JSON Schema, one for each, which forbid
// the keys of the others: editors then complain where the reader would.
#include <algorithm>

#include "livens/io/json.h"
#include "livens/io/scenario.h"
#include "livens/io/scenario/schema/schema.h"

namespace livens {

namespace {

/// An entry as pages show it: once for all kinds that share it.
struct Row {
    const Key* key;
    Words kinds;   ///< empty: all
};

std::vector<Row> rows_of(const Table& table)
{
    std::vector<Row> rows;
    for (const Key& key : table.keys) rows.push_back({&key, {}});
    for (const Kind& kind : table.kinds)
        for (const Key& key : kind.keys) {
            // Keys that several kinds share are one row, which names them.
            const auto same = std::find_if(rows.begin(), rows.end(), [&](const Row& row) {
                return row.key->name == key.name && row.key->doc == key.doc && row.key->unit == key.unit &&
                       row.key->type == key.type;
            });
            if (same == rows.end()) rows.push_back({&key, {kind.word}});
            else same->kinds.push_back(kind.word);
        }
    return rows;
}

void write_table(JsonWriter& json, const Table& table);
void write_form(JsonWriter& json, const Key& key, Form form, int count);

void write_range(JsonWriter& json, const Key& key, bool is_whole)
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    json.begin_object().member("type", is_whole ? "integer" : "number");
    if (key.range.low > -infinity)
        json.member(key.range.above ? "exclusiveMinimum" : "minimum", key.range.low);
    if (key.range.high < infinity) json.member("maximum", key.range.high);
    json.end_object();
}

/// A number, or a text with number and unit. The unit itself is for the reader to check.
void write_number(JsonWriter& json, const Key& key)
{
    if (key.unit.empty()) return write_range(json, key, false);
    json.begin_object().key("anyOf").begin_array();
    write_range(json, key, false);
    json.begin_object().member("type", "string").member("pattern", "^[ \\t]*[-+]?[0-9.].*[A-Za-z]");
    json.end_object().end_array().end_object();
}

template <class WriteItem>
void write_array(JsonWriter& json, int least, int most, WriteItem write_item)
{
    json.begin_object().member("type", "array").key("items");
    write_item();
    json.member("minItems", least);
    if (most > 0) json.member("maxItems", most);
    json.end_object();
}

void write_list(JsonWriter& json, const Key& key, Form of, int count)
{
    write_array(json, std::max(1, count), count, [&] { write_form(json, key, of, 3); });
}

void write_form(JsonWriter& json, const Key& key, Form form, int count)
{
    switch (form) {
    case Form::none: json.begin_object().end_object(); break;
    case Form::flag: json.begin_object().member("const", true).end_object(); break;
    case Form::truth: json.begin_object().member("type", "boolean").end_object(); break;
    case Form::integer: write_range(json, key, true); break;
    case Form::number: write_number(json, key); break;
    case Form::text: json.begin_object().member("type", "string").end_object(); break;
    case Form::choice:
        json.begin_object().key("enum").begin_array();
        for (const std::string_view choice : key.choices) json.value(choice);
        json.end_array().end_object();
        break;
    case Form::names: write_list(json, key, Form::text, count); break;
    case Form::named_texts:
        json.begin_object().member("type", "object").key("additionalProperties");
        write_form(json, key, Form::text, 0);
        json.end_object();
        break;
    case Form::row: write_list(json, key, Form::number, count); break;
    case Form::rows: write_list(json, key, Form::row, count); break;
    case Form::table: write_table(json, *key.child); break;
    case Form::tables:
        write_array(json, key.required ? 1 : 0, max_bodies, [&] { write_table(json, *key.child); });
        break;
    }
}

void write_type(JsonWriter& json, const Key& key)
{
    const KeyType& type = key.type;
    if (type.other == Form::none) return write_form(json, key, type.form, type.count);
    json.begin_object().key("anyOf").begin_array();
    write_form(json, key, type.form, type.count);
    write_form(json, key, type.other, type.count);
    json.end_array().end_object();
}

void write_required(JsonWriter& json, const std::vector<Key>& keys)
{
    json.key("required").begin_array();
    for (const Key& key : keys)
        if (key.required) json.value(key.name);
    json.end_array();
}

/// What each kind takes under this name; write_kind() says which.
void write_property(JsonWriter& json, const Key& key, const std::vector<Row>& rows)
{
    std::string text = key.doc;
    if (!key.unit.empty())
        text += " In " + std::string(key.unit) +
                (key.other_unit.empty() ? "" : " or " + std::string(key.other_unit)) +
                ", or a text with a unit.";
    if (!key.fallback.empty()) text += " Default: " + std::string(key.fallback) + ".";
    json.key(key.name).begin_object().member("description", text).key("anyOf").begin_array();
    for (const Row& row : rows)
        if (row.key->name == key.name) write_type(json, *row.key);
    json.end_array().end_object();
}

/// { if: { type is "rod" }, then: ... }: what the kind needs beyond what all need, and has not.
void write_kind(JsonWriter& json, const Table& table, const Kind& kind, const std::vector<const Key*>& names)
{
    const std::vector<const Key*> own = table.keys_of(static_cast<int>(&kind - table.kinds.data()));
    const bool is_default = find_key(own, table.chooser)->fallback == kind.word;
    json.begin_object().key("if").begin_object().key("properties").begin_object();
    json.key(table.chooser).begin_object().member("const", kind.word).end_object().end_object();
    if (!is_default)   // where the key is left out, the condition of the default holds
        json.key("required").begin_array().value(table.chooser).end_array();
    json.end_object().key("then").begin_object();
    write_required(json, kind.keys);
    json.key("properties").begin_object();
    for (const Key& key : kind.keys) {
        json.key(key.name);
        write_type(json, key);
    }
    for (const Key* key : names)
        if (find_key(own, key->name) == nullptr) json.key(key->name).raw("false");
    json.end_object().end_object().end_object();
}

void write_members(JsonWriter& json, const Table& table)
{
    const std::vector<Row> rows = rows_of(table);
    std::vector<const Key*> names;   // the first entry of each
    for (const Row& row : rows)
        if (row.key->type != types::later && find_key(names, row.key->name) == nullptr)
            names.push_back(row.key);
    json.member("type", "object").member("additionalProperties", false);
    json.key("properties").begin_object();
    for (const Key* key : names) write_property(json, *key, rows);
    json.end_object();
    write_required(json, table.keys);
    if (table.kinds.empty()) return;
    json.key("allOf").begin_array();
    for (const Kind& kind : table.kinds) write_kind(json, table, kind, names);
    json.end_array();
}

void write_table(JsonWriter& json, const Table& table)
{
    json.begin_object();
    write_members(json, table);
    json.end_object();
}

std::string markdown_row(const Row& row)
{
    const Key& key = *row.key;
    std::string kind = describe_type(key), fallback(key.fallback);
    if (!row.kinds.empty()) kind += " — " + quoted_alternatives(row.kinds);
    if (index_of(key.choices, fallback) >= 0) fallback = '"' + fallback + '"';
    if (!fallback.empty()) fallback = "`" + fallback + "`";
    return "| `" + std::string(key.name) + "` | " + kind + " | " + (key.required ? "**needed**" : fallback) +
           " | " + key.doc + " |\n";
}

constexpr std::string_view introduction = R"(# Scenario files

A scenario is one TOML 1.0 file that describes bodies, joints, loads, time and method. This page is printed
by `livens schema --md`; `livens schema --json` prints a JSON Schema for editors. The folder `examples/` holds
scenarios to begin with.

```toml
format = 1
title = "a pendulum"
gravity = [0, 0, -9.81]

[[body]]
name = "arm"
shape = { box = [1, "5 cm", "5 cm"] }
density = 7850
position = [0.5, 0, 0]

[[joint]]
type = "revolute"
between = ["world", "arm"]
at = [0, 0, 0]
axis = [0, 1, 0]

[time]
end = 2
elements = 40
```

## Numbers and units

A plain number is in SI units: m, kg, s, rad, N and products of them. Wherever the tables below name a unit,
a text with a number and a unit may stand instead, and its dimension is checked: `"30 deg"`, `"5 mm"`,
`"60 rpm"`, `"7850 kg/m^3"`, `"2 kN/m"`, `"3 N m"`, `"8 lbf in"`. Keys that follow a joint's coordinate take
angles for angles and lengths for lengths: `rate = "60 rpm"`, `rise = "90 deg"`, `amplitude = "5 mm"`.

- With the prefixes n, u (or µ), m, c, d, k, M, G: m, g, s, N, J, W, Pa, bar, Hz, rad.
- Without prefixes: t (1000 kg), min, h, deg (or °), rev, rpm; in, ft, yd, mi; lb, oz, slug (mass); lbf, ozf,
  kip, kgf (force, with 9.80665 m/s^2); psi, ksi; mph, kn (knots); hp (550 ft lbf/s). Their definitions are
  exact (NIST SP 811).
- Products are written with a blank, `*` or `·`, powers with `^`. Behind a slash stands one factor or a
  parenthesis: `kg/(m s)`; `J/kg m` could mean two things and is refused.
- Every number must be finite.

Lists of rows are lists of lists: `directors = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]` lists d1, d2, d3.

What is wrong with a file is said with line and column, all of it in one run (a syntax error ends the run);
codes are explained in [diagnostics.md](diagnostics.md). Nothing is ignored: unknown keys are errors.

Limits: 16 MiB, 2 000 000 values, nesting of 64, 10 000 bodies, joints and loads each, 10 000 000 time
elements, a motion of 8 GiB, and with the family mixed 8 GiB for the system of one block, at 72 kB a rigid
body and time node (where joints tie bodies together 36 kB times their number, if that is more): 100 000
linear elements of one body fit, and any number of them in blocks.
)";

}   // namespace

std::string schema_json()
{
    JsonWriter json(1);
    json.begin_object().member("$schema", "https://json-schema.org/draft/2020-12/schema");
    json.member("title", "livens scenario, format 1");
    write_members(json, root_table());
    return json.end_object().text() + "\n";
}

std::string schema_markdown()
{
    std::string out(introduction);
    for (const Table* table : schema_tables()) {
        std::string section = "\n## " + table->heading + "\n\n";
        if (!table->doc.empty()) section += std::string(table->doc) + "\n\n";
        section += "| key | value | default | meaning |\n| --- | --- | --- | --- |\n";
        std::string later;
        for (const Row& row : rows_of(*table))
            if (row.key->type != types::later) section += markdown_row(row);
            else later += (later.empty() ? "`" : ", `") + std::string(row.key->name) + "`";
        if (!later.empty()) section += "\nNot part of this version: " + later + ".\n";
        if (out.find(section) == std::string::npos) out += section;   // tables that several kinds have
    }
    return out;
}

}   // namespace livens
