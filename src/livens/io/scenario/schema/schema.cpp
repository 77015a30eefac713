// SPDX-License-Identifier: BSD-3-Clause
// The schema of scenario files: one tree of tables and keys, from which follow the reader (section.cpp), the
// page docs/scenario.md and the JSON Schema. Keys that are added here appear in all three.
#include "livens/io/scenario/schema/schema.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "livens/base/text.h"

namespace livens::inline io_internal {

namespace {

Table time_table()
{
    return {
        "[time]",
        "Time interval of the motion. It is divided into time elements: either such that the motion has a "
        "given `accuracy`, or into a given number of `elements`.",
        {Key{"start", types::number, "Initial time.", "s", "0"},
         Key{"end", types::number, "Final time, later than `start`.", "s"}.needed(),
         Key{"until", types::condition,
             "Condition that ends the motion before `end`, such as `\"door.angle > 60 deg\"` "
             "([conditions](howto/events.md#conditions))."},
         Key{"elements", types::integer,
             "Number of time elements, each of length (end - start) / elements. Output times and jumps of "
             "loads that do not fall on this grid add further elements. Excludes `accuracy`."}
             .within({1, max_elements}),
         Key{"output", types::number_or_list,
             "Interval between output times (start and end are included), or an ascending list of output "
             "times. Output times are element ends, where results are most accurate, unless joints are "
             "singular there. Those of a list that lie behind an unknown end are left out. Default: all "
             "element ends.",
             "s"},
         choice("breaks", {"from_loads", "ignore"},
                "from_loads: elements end at jumps and kinks of loads; ignore: they do not."),
         Key{"accuracy", types::number,
             "Permitted error at all element ends: of centres of mass relative to the model "
             "length, and of orientations in rad; and of unknown numbers relative to their size. The "
             "elements, and the degree unless given, are chosen accordingly. For the families lobatto and "
             "radau with the state at the "
             "initial time, and for lobatto with conditions at both ends. Used by default if neither "
             "`elements` nor `knots` of `[method]` is given.",
             "", "1e-6"}
             .within({0, 0.1, true}),
         Key{"periodic", types::truth_or_table,
             "Whether the motion ends in the state in which it begins, but for whole turns: a periodic "
             "motion, of which `end` - `start` is the period, or some of them. A table: it ends in that "
             "state "
             "turned about an axis. The bodies as they are placed, and their velocities, are a first guess. "
             "Where something depends on time it must have this period. Else `end` may be unknown, and "
             "`[start.known]` has as many conditions as numbers are unknown, and one more for each of "
             "energy, "
             "momenta and angular momenta that no motion changes. For the family lobatto.",
             "", "false"}
             .holding({"periodic of [time]",
                       "",
                       {Key{"turn", types::number, "Angle by which the end is turned, right-handed.", "rad"}
                            .needed(),
                        Key{"axis", types::vector3, "Axis of the turn.", "", "[0, 0, 1]"},
                        Key{"at", types::vector3, "A point on the axis.", "m", "[0, 0, 0]"}}})}};
}

}   // namespace

Table repeat_table()
{
    return {
        "[[repeat]]",
        "Tables that are repeated `count` times, as if the copies were appended to the file: all tables of "
        "the first index, then all of the next. In strings, `{i}`, `{i-1}` and similar stand for whole "
        "numbers computed from the index and parameters. In numbers and formulas the index is a number, "
        "too: `position = [\"(i-0.5)*L\", 0, 0]`.",
        {Key{"index", types::text, "Name of the index.", "", "i"},
         Key{"count", types::integer, "Number of copies."}.needed().within({1, max_bodies}),
         Key{"first", types::integer, "First value of the index.", "", "1"}.within({-1000000, 1000000}),
         Key{"body", types::templates, "Repeated bodies: `[[repeat.body]]`."},
         Key{"point", types::templates, "Repeated points: `[[repeat.point]]`."},
         Key{"include", types::templates, "Repeated includes: `[[repeat.include]]`."},
         Key{"joint", types::templates, "Repeated joints: `[[repeat.joint]]`."},
         Key{"drive", types::templates, "Repeated drives: `[[repeat.drive]]`."},
         Key{"stop", types::templates, "Repeated stops: `[[repeat.stop]]`."},
         Key{"load", types::templates, "Repeated loads: `[[repeat.load]]`."},
         Key{"sensor", types::templates, "Repeated sensors: `[[repeat.sensor]]`."}}};
}

namespace {

void collect(const Table& table, std::vector<const Table*>& all)
{
    if (std::ranges::find(all, &table) != all.end()) return;   // kinds share tables
    all.push_back(&table);
    for (const Key* key : table.keys_of(any_kind))
        if (key->child != nullptr) collect(*key->child, all);
}

}   // namespace

Key choice(std::string_view name, Words words, const std::string& doc)
{
    return {name, types::choice, doc, "", words.front(), false, words};
}

Key Key::holding(Table t) && { return child = std::make_shared<const Table>(std::move(t)), std::move(*this); }

const Table& root_table()
{
    static const Table table{
        "top of the file",
        "Keys above the first table header. `format` comes first.",
        {Key{"format", types::integer, "Version of this file format."}.needed().within({1, 1}),
         Key{"title", types::text, "A title; copied to the result file."},
         Key{"gravity", types::vector3, "Gravitational acceleration, world axes.", "m/s^2", "[0, 0, 0]"},
         Key{"parameters", types::named_numbers,
             "Named numbers: each is a number, a string with a unit, or an expression of other parameters; "
             "see [parameters](#parameters)."},
         Key{"body", types::tables, "Bodies, at least one, here or in an included file."}
             .needed_without("include")
             .holding(body_table()),
         Key{"world", types::table, "Shapes drawn in the world; they have no effect on the motion."}.holding(
             world_table()),
         Key{"point", types::tables, "Named points of bodies or of the world."}.holding(point_table()),
         Key{"include", types::tables, "Other files, included as parts of this model."}.holding(
             include_table()),
         Key{"joint", types::tables, "Joints between two bodies, or between a body and the world."}.holding(
             joint_table()),
         Key{"drive", types::tables,
             "Prescribed motions: joint coordinates, distances or points as functions of time."}
             .holding(drive_table()),
         Key{"stop", types::tables,
             "Limits that nothing passes, of joint coordinates and distances, with impacts."}
             .holding(stop_table()),
         Key{"load", types::tables, "Forces, torques, springs and dampers."}.holding(load_table()),
         Key{"controller", types::tables, "Controllers, filters and motors: states with rates of their own."}
             .holding(controller_table()),
         Key{"event", types::tables, "Conditions of the motion that are reported, or end it."}.holding(
             event_table()),
         Key{"sensor", types::tables, "Quantities to record: points, joint coordinates, loads, energies."}
             .holding(sensor_table()),
         Key{"repeat", types::tables, "Bodies, joints, drives, loads and sensors that are repeated."}.holding(
             repeat_table()),
         Key{"time", types::table, "Time interval, accuracy or elements, output times."}.needed().holding(
             time_table()),
         Key{"method", types::table, "Integration method and its options."}.holding(method_table()),
         Key{"start", types::table, "Initial conditions."}.holding(start_table()),
         Key{"end", types::table, "Conditions at the final time."}.holding(end_table())}};
    return table;
}

/// The same keys, none of which a part needs: the file around it may say what it leaves out.
const Table& part_table()
{
    static const Table table = [] {
        Table part = root_table();
        for (Key& key : part.keys) key.required = false;
        return part;
    }();
    return table;
}

std::vector<const Table*> schema_tables()
{
    std::vector<const Table*> all;
    collect(root_table(), all);
    return all;
}

Table Table::with_kinds(std::string_view choosing_key, std::vector<Kind> all) &&
{
    chooser = choosing_key;
    kinds = std::move(all);
    for (Key& key : keys) {
        if (key.name != chooser) continue;
        for (const Kind& kind : kinds) {
            key.choices.push_back(kind.word);
            key.doc += (key.doc.empty() ? "" : "; ") + std::string(kind.word) + ": " + std::string(kind.doc);
        }
        key.doc += ".";
    }
    return std::move(*this);
}

std::vector<const Key*> Table::keys_of(int kind) const
{
    std::vector<const Key*> all;
    for (const Key& key : keys) all.push_back(&key);
    for (std::size_t i = 0; i < kinds.size(); ++i)
        // Without a known kind the keys of all kinds count: none is called unknown because of a wrong type.
        if (kind == any_kind || kind == static_cast<int>(i))
            for (const Key& key : kinds[i].keys) all.push_back(&key);
    return all;
}

std::string Range::text() const
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto number = [](double x) {   // whole numbers without exponent
        const bool is_whole = x == std::floor(x) && std::abs(x) < 1e15;
        return is_whole ? std::to_string(static_cast<long long>(x)) : to_text(x);
    };
    const std::string below = (above ? "> " : ">= ") + number(low);
    if (low == high) return number(low);
    if (high == infinity) return below;
    if (low == -infinity) return "<= " + number(high);
    return above ? below + " and <= " + number(high) : number(low) + " to " + number(high);
}

const Key* find_key(const std::vector<const Key*>& keys, std::string_view name)
{
    const auto found = std::find_if(keys.begin(), keys.end(), [&](const Key* k) { return k->name == name; });
    return found == keys.end() ? nullptr : *found;
}

int index_of(const Words& words, std::string_view word)
{
    const auto found = std::find(words.begin(), words.end(), word);
    return found == words.end() ? -1 : static_cast<int>(found - words.begin());
}

std::string quoted_alternatives(const Words& words)
{
    std::string text;
    for (const std::string_view& word : words) {
        if (!text.empty()) text += &word == &words.back() ? " or " : ", ";
        text += '"' + std::string(word) + '"';
    }
    return text;
}

/// Of a diagonal that stands alone for an n x n matrix, number i is the entry i (n + 1), row by row.
std::string_view Key::unit_of(std::size_t i, std::size_t n) const
{
    if (units.empty()) return unit;
    if (n == units.size()) return units[i];
    return n * n == units.size() ? units[i * (n + 1)] : std::string_view();
}

std::string describe_type(const Key& key)
{
    std::string text(key.type.words);
    if (!key.unit.empty()) text += " in " + std::string(key.unit);
    if (!key.other_unit.empty()) text += " or " + std::string(key.other_unit);
    const bool is_one = key.type.form == Form::number || key.type.form == Form::integer;
    if (key.range.is_limited())
        text += (is_one && key.type.other != Form::table ? ", " : ", each ") + key.range.text();
    if (!key.choices.empty()) text += (text.empty() ? "" : ", or ") + quoted_alternatives(key.choices);
    return text;
}

std::vector<double> fallback_numbers(const Key& key)
{
    std::vector<double> numbers;
    const char* p = key.fallback.data();
    const char* const end = p + key.fallback.size();
    while (p < end) {
        double x = 0;
        const std::from_chars_result r = std::from_chars(p, end, x);
        // Defaults are texts for people, such as "[0, 0, 0]"; their numbers are what stands between brackets.
        if (r.ec == std::errc()) numbers.push_back(x);
        p = r.ec == std::errc() ? r.ptr : p + 1;
    }
    return numbers;
}

}   // namespace livens::inline io_internal
