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

constexpr std::string_view introduction = R"(# Scenario files

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
- Every number must be finite.

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
)";

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
