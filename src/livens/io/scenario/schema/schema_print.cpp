// SPDX-License-Identifier: BSD-3-Clause
// The schema for people: the tables of schema.cpp as a page.
#include <algorithm>

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
            if (same == rows.end())
                rows.push_back({&key, {kind.word}});
            else
                same->kinds.push_back(kind.word);
        }
    return rows;
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

constexpr std::string_view introduction = R"md(# Scenario files

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
a string with a number and a unit may stand instead, and its dimension is checked: `"30 deg"`, `"5 mm"`,
`"60 rpm"`, `"7850 kg/m^3"`, `"2 kN/m"`, `"3 N m"`, `"8 lbf in"`. Keys that follow a joint's coordinate take
angles for angles and lengths for lengths: `rate = "60 rpm"`, `rise = "90 deg"`, `amplitude = "5 mm"`.

- With the prefixes n, u (or µ), m, c, d, k, M, G: m, g, s, N, J, W, Pa, bar, Hz, rad.
- Without prefixes: t (1000 kg), min, h, deg (or °), rev, rpm; in, ft, yd, mi; lb, oz, slug (mass); lbf, ozf,
  kip, kgf (force, with 9.80665 m/s^2); psi, ksi; mph, kn (knots); hp (550 ft lbf/s). Their definitions are
  exact (NIST SP 811).
- Products are written with a blank, `*` or `·`, powers with `^`. Behind a slash stands one factor or a
  parenthesis: `kg/(m s)`; `J/kg m` could mean two things and is refused.
- Every number must be finite.

## Parameters

`[parameters]` gives names to numbers. Each is a number, a string with a unit or an expression of other
parameters, in any order; and every number of the file may be a string with an expression of them.

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

- Expressions have numbers, `+ - * / ^`, parentheses, `pi` and the functions of [those of
  loads](joints.md#expressions), but no time: `"2*L"`, `"L/2 + 30 mm"`, `"sqrt(2)*L"`, `"2*0.5 m"`. Whole
  numbers may be computed, too, as in `elements = "4*n"`.
- Units are checked through: each number carries its dimension, unlike ones cannot be added, and what
  comes out has to be what the key measures. What has no unit anywhere is in SI units, as plain numbers
  are; beside numbers with units it is a plain number: with `L = 0.4` it is `"L/2 + 0.03"`, with `L =
  "400 mm"` `"L/2 + 30 mm"`.
- Angles are ratios, so that `"v/R"` is an angular velocity; but 3 Hz is none without its `2*pi`, and 30
  deg no ratio.
- Behind a number stands its unit, as long as it can be read: `"2 m"` are two metres even if `m` is a
  parameter, and `"2*m"` is twice that.
- In the formulas of loads and drives parameters are numbers in SI units.
- `livens solve FILE --set L=0.3` (or `--set "L=300 mm"`) solves with another value, as do `check`,
  `mass`, `equilibrium` and `modes`. A plain number there is in SI units of what the parameter measures.
  The result holds the scenario with the values that were set. In Python: `m.parameters["L"] = 0.3`.
- A name has letters, digits and `_`; it is not that of a function, `pi` or `t`. A parameter that nothing
  uses is warned of.

## Lists and limits

Lists of rows are lists of lists: `directors = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]` lists d1, d2, d3.

What is wrong with a file is reported with line and column, all of it in one run (a syntax error ends it);
codes are explained in [diagnostics.md](diagnostics.md). Nothing is ignored: unknown keys are errors.

Limits: 16 MiB, 2 000 000 values, nesting of 64, 10 000 bodies, joints and loads each, 10 000 000 time
elements, a motion of 8 GiB, and with the family mixed 8 GiB for the system of one block, at 72 kB a rigid
body and time node (where joints tie bodies together 36 kB times their number, if that is more): 100 000
linear elements of one body fit, and any number of them in blocks.
)md";

}   // namespace

std::string schema_markdown()
{
    std::string out(introduction);
    for (const Table* table : schema_tables()) {
        std::string section = "\n## " + table->heading + "\n\n";
        if (!table->doc.empty()) section += std::string(table->doc) + "\n\n";
        section += "| key | value | default | meaning |\n| --- | --- | --- | --- |\n";
        std::string later;
        for (const Row& row : rows_of(*table))
            if (row.key->type != types::later)
                section += markdown_row(row);
            else
                later += (later.empty() ? "`" : ", `") + std::string(row.key->name) + "`";
        if (!later.empty()) section += "\nNot part of this version: " + later + ".\n";
        if (out.find(section) == std::string::npos) out += section;   // tables that several kinds have
    }
    return out;
}

}   // namespace livens
