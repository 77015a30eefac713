// The schema for editors and for people.
#include <array>

#include "livens/io/detail/schema.h"
#include "livens/io/json.h"
#include "livens/io/scenario.h"

namespace livens {

namespace {

void write_table(JsonWriter& json, TableId table);

/// A number, or a text with number and unit. The unit itself is for the reader to check.
void write_number(JsonWriter& json, const Key& key)
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const bool takes_unit = !key.unit.empty();
    if (takes_unit) json.begin_object().key("anyOf").begin_array();
    const bool is_whole = key.type == KeyType::integer || key.type == KeyType::integer_or_choice;
    json.begin_object().member("type", is_whole ? "integer" : "number");
    if (key.range.low > -infinity)
        json.member(key.range.above ? "exclusiveMinimum" : "minimum", key.range.low);
    if (key.range.high < infinity) json.member("maximum", key.range.high);
    json.end_object();
    if (!takes_unit) return;
    json.begin_object().member("type", "string").member("pattern", "^[ \\t]*[-+]?[0-9.].*[A-Za-z]");
    json.end_object().end_array().end_object();
}

void write_array(JsonWriter& json, const Key& key, int count, bool is_nested)
{
    json.begin_object().member("type", "array").key("items");
    if (is_nested) write_array(json, key, 3, false);
    else write_number(json, key);
    if (count > 0) json.member("minItems", count).member("maxItems", count);
    else json.member("minItems", 1);
    json.end_object();
}

template <class First, class Second>
void write_either(JsonWriter& json, First first, Second second)
{
    json.begin_object().key("anyOf").begin_array();
    first();
    second();
    json.end_array().end_object();
}

void write_choice(JsonWriter& json, const Key& key)
{
    json.begin_object().key("enum").begin_array();
    for (const std::string_view choice : split_alternatives(key.choices)) json.value(choice);
    json.end_array().end_object();
}

void write_tables(JsonWriter& json, const Key& key)
{
    json.begin_object().member("type", "array").member("minItems", key.required ? 1 : 0);
    json.member("maxItems", max_bodies).key("items");
    write_table(json, key.child);
    json.end_object();
}

void write_type(JsonWriter& json, const Key& key)
{
    const auto number = [&] { write_number(json, key); };
    const auto list = [&] { write_array(json, key, 0, false); };
    switch (key.type) {
    case KeyType::flag: json.begin_object().member("const", true).end_object(); break;
    case KeyType::truth: json.begin_object().member("type", "boolean").end_object(); break;
    case KeyType::integer_or_choice: write_either(json, number, [&] { write_choice(json, key); }); break;
    case KeyType::integer:
    case KeyType::number: number(); break;
    case KeyType::text: json.begin_object().member("type", "string").end_object(); break;
    case KeyType::choice: write_choice(json, key); break;
    case KeyType::vector3: write_array(json, key, 3, false); break;
    case KeyType::vector4: write_array(json, key, 4, false); break;
    case KeyType::triple: write_array(json, key, 3, true); break;
    case KeyType::pair: write_array(json, key, 2, true); break;
    case KeyType::rows: write_array(json, key, 0, true); break;
    case KeyType::list: list(); break;
    case KeyType::names:
        json.begin_object().member("type", "array").member("minItems", 2).member("maxItems", 2);
        json.key("items").begin_object().member("type", "string").end_object().end_object();
        break;
    case KeyType::principal_or_full:
        write_either(
            json, [&] { write_array(json, key, 3, false); }, [&] { write_array(json, key, 3, true); });
        break;
    case KeyType::number_or_list: write_either(json, number, list); break;
    case KeyType::number_or_table: write_either(json, number, [&] { write_table(json, key.child); }); break;
    case KeyType::table: write_table(json, key.child); break;
    case KeyType::tables: write_tables(json, key); break;
    case KeyType::later: json.begin_object().end_object(); break;
    }
}

std::string documentation(const Key& key)
{
    std::string text(key.doc);
    if (!key.unit.empty()) text += " In " + std::string(key.unit) + ", or a text with a unit.";
    if (!key.fallback.empty()) text += " Default: " + std::string(key.fallback) + ".";
    return text;
}

/// Entries of one name for different types: the first stands for all of them.
bool is_repeated(const Key& key)
{
    for (const Key& other : schema_keys()) {
        if (&other == &key) return false;
        if (other.table == key.table && other.name == key.name) return true;
    }
    return false;
}

bool belongs(const Key& key, std::string_view type)
{
    for (const Key& other : schema_keys())
        if (other.table == key.table && other.name == key.name &&
            (other.only.empty() || is_listed(other.only, type)))
            return true;
    return false;
}

void write_property(JsonWriter& json, const Key& key)
{
    json.key(key.name).begin_object().member("description", documentation(key));
    json.key("anyOf").begin_array();   // what each type takes; write_conditions() says which
    for (const Key& other : schema_keys())
        if (other.table == key.table && other.name == key.name) write_type(json, other);
    json.end_array().end_object();
}

/// Whether another entry of this name, for other types, allows other numbers. Units JSON Schema does not see.
bool has_own_range(const Key& key)
{
    for (const Key& other : schema_keys())
        if (other.table == key.table && other.name == key.name &&
            (other.range.low != key.range.low || other.range.high != key.range.high))
            return true;
    return false;
}

/// One type: what it needs beyond what all need, what it narrows, what it has not.
void write_condition(JsonWriter& json, TableId table, const Key& chooser, std::string_view type)
{
    json.begin_object().key("if").begin_object().key("properties").begin_object();
    json.key(chooser.name).begin_object().member("const", type).end_object().end_object();
    if (chooser.fallback != type)   // where the key is left out, the condition of the default holds
        json.key("required").begin_array().value(chooser.name).end_array();
    json.end_object().key("then").begin_object().key("required").begin_array();
    for (const Key& key : schema_keys())
        if (key.table == table && key.required && is_listed(key.only, type)) json.value(key.name);
    json.end_array().key("properties").begin_object();
    for (const Key& key : schema_keys()) {
        if (key.table != table) continue;
        if (is_listed(key.only, type) && has_own_range(key)) {
            json.key(key.name);
            write_type(json, key);
        }
        if (!is_repeated(key) && !belongs(key, type)) json.key(key.name).raw("false");
    }
    json.end_object().end_object().end_object();
}

/// { if: { type is "rod" }, then: { required: [...] } } for every type.
void write_conditions(JsonWriter& json, TableId table, std::string_view discriminator)
{
    json.key("allOf").begin_array();
    for (const Key& chooser : schema_keys()) {
        if (chooser.table != table || chooser.name != discriminator) continue;
        for (const std::string_view type : split_alternatives(chooser.choices))
            write_condition(json, table, chooser, type);
    }
    json.end_array();
}

void write_members(JsonWriter& json, TableId table)
{
    json.member("type", "object").member("additionalProperties", false);
    json.key("properties").begin_object();
    for (const Key& key : schema_keys())
        if (key.table == table && key.type != KeyType::later && !is_repeated(key)) write_property(json, key);
    json.end_object().key("required").begin_array();
    for (const Key& key : schema_keys())
        if (key.table == table && key.required && key.only.empty()) json.value(key.name);
    json.end_array();
    const std::string_view discriminator = schema_table(table).discriminator;
    if (!discriminator.empty()) write_conditions(json, table, discriminator);
}

void write_table(JsonWriter& json, TableId table)
{
    json.begin_object();
    write_members(json, table);
    json.end_object();
}

std::string markdown_row(const Key& key)
{
    std::string kind = describe_type(key);
    if (!key.only.empty()) kind += " — " + quoted_alternatives(key.only);
    std::string fallback = key.required           ? "**needed**"
                           : key.fallback.empty() ? ""
                                                  : "`" + std::string(key.fallback) + "`";
    const bool is_word = key.type == KeyType::choice || key.type == KeyType::integer_or_choice;
    if (is_word && !key.fallback.empty())
        fallback = "`\"" + std::string(key.fallback) + "\"`";
    return "| `" + std::string(key.name) + "` | " + kind + " | " + fallback + " | " + std::string(key.doc) +
           " |\n";
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
`"2 rpm"`, `"7850 kg/m^3"`, `"2 kN/m"`, `"3 N m"`.

- Units: m, g, s, N, J, W, Pa, rad with the prefixes n, u (or µ), m, c, d, k, M, G; and without prefixes t,
  min, h, deg, rev, rpm.
- Products are written with a blank, `*` or `·`, powers with `^`. Behind a slash stands one factor or a
  parenthesis: `kg/(m s)`; `J/kg m` could mean two things and is refused.
- Every number must be finite.

Lists of rows are lists of lists: `directors = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]` lists d1, d2, d3.

What is wrong with a file is said with line and column, all of it in one run (a syntax error ends the run);
codes are explained in [diagnostics.md](diagnostics.md). Nothing is ignored: unknown keys are errors.

Limits: 16 MiB, 2 000 000 values, nesting of 64, 1000 bodies, joints and loads each, 10 000 000 time elements,
a motion of 8 GiB, and with the family mixed 8 GiB for the system of one block, at 72 kB a rigid body and time
node (where joints tie bodies together 36 kB times their number, if that is more): 100 000 linear elements of
one body fit, and any number of them in blocks.
)";

}   // namespace

std::string schema_json()
{
    JsonWriter json(1);
    json.begin_object().member("$schema", "https://json-schema.org/draft/2020-12/schema");
    json.member("title", "livens scenario, format 1");
    write_members(json, TableId::root);
    return json.end_object().text() + "\n";
}

std::string schema_markdown()
{
    std::string out(introduction);
    for (const Table& table : schema_tables()) {
        out += "\n## " + std::string(table.heading) + "\n\n";
        if (!table.doc.empty()) out += std::string(table.doc) + "\n\n";
        out += "| key | value | default | meaning |\n| --- | --- | --- | --- |\n";
        std::string later;
        for (const Key& key : schema_keys()) {
            if (key.table != table.id) continue;
            if (key.type != KeyType::later) out += markdown_row(key);
            else later += std::string(later.empty() ? "" : ", ") + "`" + std::string(key.name) + "`";
            if (!key.later.empty())
                later += std::string(later.empty() ? "" : ", ") + "`" + std::string(key.name) + " = " +
                         quoted_alternatives(key.later) + "`";
        }
        if (!later.empty()) out += "\nNot part of this version: " + later + ".\n";
    }
    return out;
}

}   // namespace livens
