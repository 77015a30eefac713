// SPDX-License-Identifier: BSD-3-Clause
// The schema for people: the tables of schema.cpp as a page.
#include <algorithm>

#include "livens/io/scenario.h"
#include "livens/io/scenario/schema/schema.h"

namespace livens {

namespace {

constexpr std::string_view columns = "| key | value | default | meaning |\n| --- | --- | --- | --- |\n";

std::string markdown_row(const Key& key)
{
    std::string fallback(key.fallback);
    if (index_of(key.choices, fallback) >= 0) fallback = '"' + fallback + '"';
    if (!fallback.empty()) fallback = "`" + fallback + "`";
    return "| `" + std::string(key.name) + "` | " + describe_type(key) + " | " +
           (key.required ? "**needed**" : fallback) + " | " + key.doc + " |\n";
}

std::string markdown_rows(const std::vector<const Key*>& keys)
{
    std::string rows, later;
    for (const Key* key : keys)
        if (key->type != types::later)
            rows += markdown_row(*key);
        else
            later += (later.empty() ? "`" : ", `") + std::string(key->name) + "`";
    if (!later.empty()) rows += "\nNot part of this version: " + later + ".\n";
    return rows;
}

std::vector<const Key*> pointers(const std::vector<Key>& keys)
{
    std::vector<const Key*> all;
    for (const Key& key : keys) all.push_back(&key);
    return all;
}

/// A kind with a page of its own has a `type`; other kinds are sections of the same page.
bool has_pages(const Table& table) { return table.chooser == "type"; }

/// "joint" of "[[joint]]".
std::string word_of_table(const Table& table) { return table.heading.substr(2, table.heading.size() - 4); }

/// The words of a chooser and what they mean are below its table, not in its row.
std::string chooser_row(const Table& table, Key key)
{
    const std::string first(table.kinds.front().word);
    key.doc = key.doc.substr(0, key.doc.find(first + ": "));
    if (key.doc.ends_with("; ")) key.doc.replace(key.doc.size() - 2, 2, ". ");
    key.doc += has_pages(table) ? "One of the types below." : "One of the families below.";
    const std::string quoted = key.fallback.empty() ? "" : '"' + std::string(key.fallback) + '"';
    key.choices.clear();
    key.fallback = quoted;
    key.type = types::text;
    return markdown_row(key);
}

std::string table_of_kinds(const Table& table)
{
    const std::string word = word_of_table(table);
    std::string out = "\n| type | what it does |\n| --- | --- |\n";
    for (const Kind& kind : table.kinds)
        out += "| [`" + std::string(kind.word) + "`](" + word + "s/" + std::string(kind.word) + ".md) | " +
               std::string(kind.doc) + " |\n";
    return out;
}

/// Keys of each kind, under a heading of its own.
std::string sections_of_kinds(const Table& table)
{
    std::string out;
    for (const Kind& kind : table.kinds) {
        out += "\n### " + std::string(table.chooser) + " " + std::string(kind.word) + "\n\n" +
               std::string(kind.doc) + ".\n";
        if (!kind.keys.empty()) out += "\n" + std::string(columns) + markdown_rows(pointers(kind.keys));
    }
    return out;
}

std::string markdown_section(const Table& table, std::string_view level)
{
    std::string section = "\n" + std::string(level) + " " + table.heading + "\n\n";
    if (!table.doc.empty()) section += std::string(table.doc) + "\n\n";
    section += columns;
    for (const Key& key : table.keys)
        section += !table.kinds.empty() && key.name == table.chooser ? chooser_row(table, key)
                                                                     : markdown_rows({&key});
    if (table.kinds.empty()) return section;
    return section + (has_pages(table) ? table_of_kinds(table) : sections_of_kinds(table));
}

/// Tables inside these keys, each before those inside it.
void collect_inside(const std::vector<Key>& keys, std::vector<const Table*>& all)
{
    for (const Key& key : keys) {
        if (key.child == nullptr || std::ranges::find(all, key.child.get()) != all.end()) continue;
        all.push_back(key.child.get());
        collect_inside(key.child->keys, all);
        if (has_pages(*key.child)) continue;   // what a type has inside is on its page
        for (const Kind& kind : key.child->kinds) collect_inside(kind.keys, all);
    }
}

std::string page_of_kind(const Table& table, const Kind& kind)
{
    std::vector<const Key*> keys;
    for (const Key& key : table.keys)
        if (key.name != table.chooser) keys.push_back(&key);
    for (const Key& key : kind.keys) keys.push_back(&key);
    std::string out = std::string(columns) + markdown_rows(keys);
    std::vector<const Table*> inside;
    collect_inside(kind.keys, inside);
    for (const Table* one : inside) out += markdown_section(*one, "###");
    return out;
}

constexpr std::string_view introduction = R"md(# Scenario files

A scenario is one TOML 1.0 file that describes bodies, joints, loads, the time interval and the integration
method. This page is printed by `livens schema --md`; `livens schema --json` prints a JSON Schema for
[editors](howto/editors.md). The folder `examples/` has scenarios to start from.

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

Plain numbers are in SI units: m, kg, s, rad, N and products of these. Where the tables below name a unit, a
string with a number and a unit is accepted as well, and its dimension is checked: `"30 deg"`, `"5 mm"`,
`"60 rpm"`, `"7850 kg/m^3"`, `"2 kN/m"`, `"3 N m"`, `"8 lbf in"`. Keys that refer to a joint coordinate take
an angle if the coordinate is an angle, and a length if it is a displacement: `rate = "60 rpm"`,
`rise = "90 deg"`, `amplitude = "5 mm"`.

- Units with the prefixes n, u (or µ), m, c, d, k, M, G: m, g, s, N, J, W, Pa, bar, Hz, rad.
- Units without prefixes: t (1000 kg), min, h, deg (or °), rev, rpm; in, ft, yd, mi; lb, oz, slug (mass); lbf,
  ozf, kip, kgf (force, with 9.80665 m/s^2); psi, ksi; mph, kn (knots); hp (550 ft lbf/s). Their definitions
  are exact (NIST SP 811).
- Products are written with a blank, `*` or `·`, powers with `^`. A slash is followed by one factor or by
  parentheses: `kg/(m s)`. `J/kg m` is ambiguous and therefore an error.
- Every number must be finite, except limits of joints, where `inf` and `-inf` mean no limit.

## Parameters

`[parameters]` defines named numbers. Each is a number, a string with a unit, or an expression of other
parameters, in any order. Every number in the file can be a string with an expression of parameters.

```toml
format = 1
gravity = [0, 0, "-g"]

[parameters]
L = "400 mm"
width = "L/10"
g = "9.81 m/s^2"

[[body]]
name = "arm"
shape = { box = ["L", "width", "width"] }
density = 7850
position = ["L/2", 0, 0]

[[joint]]
type = "revolute"
between = ["world", "arm"]
at = [0, 0, 0]
axis = [0, 1, 0]

[time]
end = "5*2*pi*sqrt(2*L/(3*g))"
```

- Expressions contain numbers, `+ - * / ^`, parentheses, `pi` and the functions of
  [load expressions](joints.md#expressions), but not the time: `"2*L"`, `"L/2 + 30 mm"`, `"sqrt(2)*L"`,
  `"2*0.5 m"`. Whole numbers can be computed, too, as in `elements = "4*n"`.
- Units are checked: every number carries its dimension, different dimensions cannot be added, and the result
  must have the dimension of the key. An expression without any unit is in SI units, like a plain number.
  Beside numbers with units, a number without a unit is dimensionless: with `L = 0.4` write `"L/2 + 0.03"`,
  with `L = "400 mm"` write `"L/2 + 30 mm"`.
- An angle counts as its number of radians, so that `"v/R"` is an angular velocity and `"R*angle"` a length.
  A frequency in Hz is no angular velocity: multiply it by `2*pi`. A key without a unit takes no angle.
- A unit after a number takes precedence: `"2 m"` is two metres even if `m` is a parameter; `"2*m"` is twice
  the parameter.
- In formulas of loads and drives, parameters are numbers in SI units.
- `livens solve FILE --set L=0.3` (or `--set "L=300 mm"`) uses another value, and so do `check`, `mass`,
  `equilibrium` and `modes`. A plain number there is in the SI unit of the parameter. The result contains the
  scenario with these values. In Python: `m.parameters["L"] = 0.3`.
- Names consist of letters, digits and `_`, and differ from functions, `pi` and `t`. Unused parameters cause a
  warning.

## Unknown numbers

Between conditions at both ends of time (`[start.known]`, `[end.known]`) a number of the model, a parameter or
the end of time can be unknown: `{ unknown = 0.3, low = 0 }` in place of the number, as in
`damping = { unknown = 0.3, low = 0 }` of a load, says a guess and, if need be, bounds.

- There must be as many more conditions as unknown numbers. For the family lobatto, with `elements` or an
  `accuracy`, which is one of each number by its size, too.
- Beside `[start]` with `given = "state"` there are as many in `[end.known]` as unknown numbers.
- The instant at which a joint is released may be unknown as well, `until = { unknown = 0.4, low = 0.1 }`. It
  does not pass other instants at which joints or loads switch.
- Guess and bounds are numbers, strings with units, or expressions, as everywhere. Whole numbers and words
  cannot be unknown; a number inside of a formula can as a parameter: `A = { unknown = 2 }` in `[parameters]`.
- What is found is a note of the result, with its estimated error. The scenario in the result has it as its
  guess, so that it is that of the motion.
- `--set L=0.3` replaces the guess of an unknown parameter.

## Lists and limits

A matrix is a list of rows: `directors = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]` lists d1, d2, d3.

All errors of a file are reported in one run, with line and column; only a syntax error ends it at once. Error
codes are explained in [diagnostics.md](diagnostics.md). Unknown keys are errors: nothing is ignored.

The *model length* is the size of the mechanism, by which errors of positions are divided: the largest of
twice the distance of a centre of mass from the mean of all of them, the distances between joint points and
centres of mass, and the radii of gyration. Result files state it as `model_length`.

Limits: 16 MiB, 2 000 000 values, nesting depth 64, 10 000 bodies, joints and loads each, 10 000 000 time
elements, 8 GiB for the motion, and 8 GiB for the equations of the elements that are solved together. The
family mixed needs 72 kB for these per rigid body and time node; where joints connect bodies, 36 kB times the
number of bodies, if that is more. 100 000 linear elements of one body fit; in blocks, any number does.
)md";

}   // namespace

std::string schema_markdown()
{
    std::vector<const Table*> tables{&root_table()};
    collect_inside(root_table().keys, tables);
    std::string out(introduction);
    for (const Table* table : tables) {
        const std::string section = markdown_section(*table, "##");
        if (out.find(section) == std::string::npos) out += section;   // tables that several keys have
    }
    return out;
}

std::vector<std::string> schema_types()
{
    std::vector<std::string> all;
    for (const Table* table : schema_tables())
        if (has_pages(*table))
            for (const Kind& kind : table->kinds)
                all.push_back(word_of_table(*table) + "." + std::string(kind.word));
    return all;
}

std::string schema_markdown(std::string_view type)
{
    for (const Table* table : schema_tables())
        if (has_pages(*table))
            for (const Kind& kind : table->kinds)
                if (type == word_of_table(*table) + "." + std::string(kind.word))
                    return page_of_kind(*table, kind);
    return {};
}

}   // namespace livens
