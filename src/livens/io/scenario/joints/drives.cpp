// SPDX-License-Identifier: BSD-3-Clause
// [[drive]]: one table of kinds, and of laws over time, which need two continuous derivatives: a jump of the
// velocity would take an infinite force (theory.md and docs/joints.md, Drives).
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "livens/base/text.h"
#include "livens/io/scenario/joints/expressions.h"
#include "livens/io/scenario/joints/joints.h"
#include "livens/multibody/joints/drives.h"
#include "livens/time/time_laws.h"

namespace livens::inline io_internal {

namespace {

const std::vector<Kind>& drive_kinds()
{
    static const std::vector<Kind> all{
        {"joint",
         "prescribes a joint coordinate",
         {Key{"joint", types::text, "The driven joint."}.needed(), coordinate_key()}},
        {"distance",
         "prescribes the distance between two points",
         {Key{"between", types::names, two_bodies_or_points}.needed_without("points"),
          Key{"points", types::two_points,
              "One point per body, in that body's coordinates. Default: the reference points (for the world: "
              "its origin).",
              "m"}}},
        {"point",
         "prescribes the path of a point of a body",
         {Key{"body", types::text, body_or_point}.needed_without("point"),
          Key{"point", types::point, "Position of the point in body coordinates.", "m", "[0, 0, 0]"}}},
        {"body",
         "prescribes the path of a point of a body and holds the body's orientation",
         {Key{"body", types::text, body_or_point}.needed_without("point"),
          Key{"point", types::point, "Position of the point in body coordinates.", "m", "[0, 0, 0]"}}}};
    return all;
}

/// Whether its kind moves a point of one body.
bool is_path(const Section& drive)
{
    return drive_kinds()[static_cast<std::size_t>(drive.kind())].keys[0].name == "body";
}

constexpr std::array<std::string_view, 7> laws{"value",      "rate",  "harmonic",  "step",
                                               "polynomial", "table", "expression"};

/// Exactly one law.
bool check_drive_law(const Section& drive)
{
    std::vector<std::string_view> given;
    for (const std::string_view law : laws)
        if (drive.has(law)) given.push_back(law);
    if (given.empty())
        return drive.error("", "drive-law", drive.label() + " has no law",
                           {"", "give one of value, rate, harmonic, step, polynomial, table, expression"});
    if (given.size() > 1) return drive.at_most_one({given[0], given[1]}, "drive-law");
    return true;
}

/// A path needs three numbers where others have one.
bool check_sizes(const Section& drive)
{
    const std::size_t n = is_path(drive) ? 3 : 1;
    const auto check = [&](const Section& section, std::string_view key) {
        const Value* v = section.find(key);
        if (v == nullptr || v->numbers.size() == n) return true;
        return section.error(key, "drive-size",
                             "'" + std::string(key) + "' of " + section.label() + " has " +
                                 std::to_string(v->numbers.size()) + " numbers, not " + std::to_string(n),
                             {"", n == 3 ? "the path of a point has three components" : "give one number"});
    };
    bool is_good = check(drive, "value") && check(drive, "rate");
    if (const Section* one = only_section(drive, "harmonic")) is_good = check(*one, "amplitude") && is_good;
    if (const Section* one = only_section(drive, "step")) is_good = check(*one, "rise") && is_good;
    const auto is_multiple = [&](const Section& section, std::string_view key, std::size_t of) {
        const Value* v = section.find(key);
        if (v == nullptr || (v->numbers.size() % n == 0 && (of == 0 || v->numbers.size() == n * of)))
            return true;
        return section.error(key, "drive-size",
                             "'" + std::string(key) + "' of " + section.label() + " has " +
                                 std::to_string(v->numbers.size()) + " numbers",
                             {"", of == 0 ? "three for each power of t, one component after the other"
                                          : "one for each time; for a path three, x, y, z of each time"});
    };
    is_good = is_multiple(drive, "polynomial", 0) && is_good;
    if (const Value* v = drive.find("expression");
        v != nullptr && (v->texts.empty() ? 1 : v->texts.size()) != n)
        is_good =
            drive.error("expression", "drive-size",
                        "'expression' of " + drive.label() + " is " +
                            (v->texts.empty() ? "one string" : std::to_string(v->texts.size()) + " strings"),
                        {"", n == 3 ? "the path of a point has three components" : "give one string"});
    if (const Section* one = only_section(drive, "table"))
        if (const Value* times = one->find("times"))
            is_good = is_multiple(*one, "values", times->numbers.size()) && is_good;
    return is_good;
}

double component(const Section& section, std::string_view key, std::size_t c)
{
    const Value* v = section.find(key);
    return v == nullptr || c >= v->numbers.size() ? 0 : v->numbers[c];
}

std::string drive_name(const Section& drive)
{
    if (drive.has("name")) return drive.text("name");
    if (drive.find("joint") != nullptr) return "drive of " + drive.text("joint");
    if (drive.is_implied("body")) return "drive of " + drive.find("point")->text;
    if (drive.find("body") != nullptr) return "drive of " + drive.text("body");
    const Value *between = drive.find("between"), *points = drive.find("points");
    if (points != nullptr && !points->texts.empty())
        return "drive " + points->texts[0] + "-" + points->texts[1];
    return between == nullptr ? "" : "drive " + between->texts[0] + "-" + between->texts[1];
}

/// Of the motion, s.
struct Duration {
    double start, end;
    double begins;   ///< the drive, at the start or later
    double ends;     ///< the drive, at the end or earlier
};

/// A drive is held in positions and in velocities: both are numbers while it acts, beside its events.
void check_values(const Expression& expression, const Duration& during, const std::vector<double>& events,
                  const std::string& path)
{
    constexpr int n_looks = 1000;   // what passes between them is no number, and the solution says so
    for (int i = 0; i <= n_looks; ++i) {
        const double t = during.begins + (during.ends - during.begins) * i / n_looks,
                     near = 1e-9 * (during.ends - during.begins);
        if (std::ranges::any_of(events, [&](double jump) { return std::abs(t - jump) <= near; })) continue;
        const TimeValue at = expression.by_time(t);
        if (std::isfinite(at.value + at.first)) continue;
        const bool is_rate = std::isfinite(at.value);
        throw InputError(
            {"expression-value", path + ".expression",
             std::string("'expression' of a drive has no ") + (is_rate ? "finite rate" : "value"),
             expression.text() + " at t = " + to_text(t, 6) + " s", "", expression.without_value(t, {}),
             is_rate ? "joints start and stop with finite velocities: \"t^2\", 'step'"
                     : "set 'from' and 'until' where it has one, or take another formula"});
    }
}

/// With its kinks as breaks, so that the model refuses what a drive cannot follow.
TimeFunction by_formula(const Expression& expression, const Duration& during, const std::string& path)
{
    std::vector<double> events;
    if (during.end > during.start) events = expression.events(during.start, during.end);
    check_values(expression, during, events, path);
    return expression_of_time(expression, events);
}

/// A drive holds what it drives, so that it cannot follow the motion.
void check_names_of_time(const Section& drive)
{
    const Value& given = *drive.find("expression");
    for (const std::string& text : given.texts.empty() ? std::vector{given.text} : given.texts)
        for (const std::string& name : names_with_points(text))
            throw InputError({"expression-name", "drive[" + drive_name(drive) + "].expression",
                              "a drive follows time alone, not the motion", "'" + name + "'",
                              "t, pi, functions", "",
                              "a force that follows the motion is a [[load]] of type \"actuator\""});
}

/// Component c of the law; `now` is the value at the start, where a rate begins.
TimeFunction read_law(const Section& drive, std::size_t c, std::size_t n, double now, const Duration& during)
{
    if (drive.has("value")) return component(drive, "value", c);
    if (drive.has("rate")) return ramp(now, component(drive, "rate", c), during.begins);
    if (const Section* one = only_section(drive, "harmonic"))
        return harmonic(component(*one, "amplitude", c), one->number("frequency"), one->number("phase"));
    const std::string path = "drive[" + drive_name(drive) + "]";
    if (drive.has("expression")) check_names_of_time(drive);
    if (drive.has("expression")) return by_formula(read_expressions(drive, {}, path)[c], during, path);
    if (const Section* one = only_section(drive, "step")) {
        const TimeFunction step =
            smooth_step(one->number("from"), one->number("until"), component(*one, "rise", c));
        // As a rate, a step changes the coordinate from where it stands; other laws say its value.
        return shifted(step, now - step({during.start}).value);
    }
    const bool is_table = drive.has("table");
    const Section* table = only_section(drive, "table");
    const std::vector<double>& all = (is_table ? table->find("values") : drive.find("polynomial"))->numbers;
    std::vector<double> own;
    // Rows of a table hold x, y, z; the component is every n-th number.
    for (std::size_t i = c; i < all.size(); i += n) own.push_back(all[i]);
    if (!is_table) return polynomial(std::move(own));
    const std::vector<double>& times = table->find("times")->numbers;
    return straight_on(spline_table(times, std::move(own)), times.front(), times.back());
}

/// A path is a displacement from where the point stands: laws that count from a value begin at 0.
std::array<TimeFunction, 3> read_path(const Section& drive, const Duration& during)
{
    return {read_law(drive, 0, 3, 0, during), read_law(drive, 1, 3, 0, during),
            read_law(drive, 2, 3, 0, during)};
}

/// Positions do not tell whole turns: a joint that stands further than half a turn from where its drive
/// begins is led there by the shorter way, and counts on from where it is said to stand.
void warn_of_turns(Builder& builder, const Section& drive, const std::string& name,
                   const NamedCoordinate& coordinate, const TimeFunction& law, const Duration& during)
{
    if (!coordinate.coordinate.counts_turns() || during.begins > during.start) return;
    const double begins = law({during.start, Side::right}).value, gap = begins - coordinate.at_stated;
    // At exactly half a turn both ways are equally long, and rounding would decide.
    constexpr double half = std::numbers::pi * (1 - 1e-9);
    if (!(std::abs(gap) >= half)) return;
    const double turns = std::max(1.0, std::round(std::abs(gap) / (2 * std::numbers::pi)));
    builder.findings().warning(
        drive.place(), "drive-turns",
        "'" + name + "' begins at " + to_text(begins, 4) + " rad, but its joint stands at " +
            to_text(coordinate.at_stated, 4) + " rad, half a turn away or more",
        {"positions do not tell whole turns: the joint counts on from where it stands, and may read " +
             to_text(turns) + (turns == 1 ? " turn" : " turns") + " more or less than the drive",
         "give the joint a 'coordinate' within half a turn of where the drive begins, or the drive an "
         "offset"});
}

Joint make_on_joint(Builder& builder, const Section& drive, const std::string& name, const Duration& during,
                    const Configurations& X)
{
    const JointReference of = find_coordinate(builder, drive, "drive[" + name + "]");
    check_units(drive, of.coordinate->coordinate.is_angle(), "drive[" + name + "]");
    const TimeFunction law = read_law(drive, 0, 1, of.coordinate->at_stated, during);
    check_driven_angle(of, law, {during.begins, during.ends}, "drive[" + name + "]");
    warn_of_turns(builder, drive, name, *of.coordinate, law, during);
    return driven_coordinate(name, *of.joint, *of.coordinate, law, X);
}

Joint make_drive(Builder& builder, const Section& drive, const std::string& name, const BodyReference& first,
                 const BodyReference& second)
{
    const Section* time = only_section(builder.run(), "time");
    const double start = time == nullptr ? 0 : time->number("start"),
                 end = time == nullptr ? start : time->number("end");
    const Duration during{start, end,
                          std::max(start, has_number(drive, "from") ? drive.number("from") : start),
                          std::min(end, has_number(drive, "until") ? drive.number("until") : end)};
    const std::vector<Matrix34> all = builder.start_configurations();
    const Configurations X(all);
    const std::string type = drive.text("type");
    if (type == "joint") return make_on_joint(builder, drive, name, during, X);
    check_units(drive, false, "drive[" + name + "]");
    if (type == "distance") {
        const Vector3 a = builder.in_axes(first.index, drive.row("points", 0)),
                      b = builder.in_axes(second.index, drive.row("points", 1));
        const double now = norm(X[second.index] * point(b) - X[first.index] * point(a));
        const TimeFunction length = read_law(drive, 0, 1, now, during);
        constexpr int n_looks = 1000;   // what passes between them is no number, see driven_distance()
        for (int i = 0; i <= n_looks; ++i) {
            const double t = start + (end - start) * i / n_looks, l = length({t}).value;
            if (l > 0) continue;
            throw InputError({"drive-distance", "drive[" + name + "]", "a driven distance is not positive",
                              to_text(l) + " at t = " + to_text(t, 6) + " s", "> 0",
                              "points that coincide have no direction to be held along",
                              "drive a point, or a joint's displacement"});
        }
        return driven_distance(name, first.index, a, second.index, b, length, X);
    }
    const Vector3 at = builder.in_axes(first.index, drive.vector("point"));
    const auto make = type == "point" ? driven_point : driven_body;
    return make(name, first.index, at, read_path(drive, during), X, builder.length());
}

void read_drive(Builder& builder, const Section& drive, std::unordered_set<std::string>& taken)
{
    Findings& findings = builder.findings();
    const int before = findings.n_errors();
    const std::string name = drive_name(drive), path = "drive[" + name + "]";
    check_name(drive);
    if (!name.empty())
        claim_name(drive, "joint or drive", name, taken,
                   {"results refer to drives as to joints", "give it another 'name'"});
    builder.remember(path, drive);
    // In the model it is a joint, and complaints of the core call it so.
    builder.remember("joint[" + name + "]", drive);
    if (drive.kind() == any_kind) return;
    check_drive_law(drive);
    check_sizes(drive);
    BodyReference first, second;
    if (drive.takes("between")) {
        if (!builder.find_pair(drive, "drive-self", first, second)) return;
    } else if (const Value* named = drive.find("body")) {
        first = builder.find_body(named->text, named->node->place, drive);
        if (named->text == "world")
            drive.error("body", "drive-self", drive.label() + " drives the world, which does not move");
    }
    if (findings.n_errors() > before || !drive.is_valid()) return;
    builder.guard(path, [&] {
        Joint joint = make_drive(builder, drive, name, first, second);
        read_times(builder, drive, joint);
        builder.model().add_joint(std::move(joint));
    });
}

Key harmonic_key(const KeyType& numbers)
{
    return Key{"harmonic", types::table, "Harmonic motion: amplitude * sin(2*pi*frequency*t + phase)."}
        .holding({"harmonic of a drive",
                  "Sinusoidal motion.",
                  {Key{"amplitude", numbers, "Amplitude.", "m"}.or_in("rad").needed(),
                   Key{"frequency", types::number, "Frequency, in cycles per second.", "Hz"}.needed(),
                   Key{"phase", types::number, "Phase angle at t = 0.", "rad", "0"}}});
}

Key step_key(const KeyType& numbers)
{
    return Key{"step", types::table, "Smooth step with two continuous derivatives."}.holding(
        {"step of a drive",
         "A change by `rise` from the initial value between two times; constant before and after.",
         {Key{"from", types::number, "Beginning of the change.", "s"}.needed(),
          Key{"until", types::number, "End of the change.", "s"}.needed(),
          Key{"rise", numbers, "Total change.", "m"}.or_in("rad").needed()}});
}

}   // namespace

Table drive_table()
{
    const KeyType numbers = types::number_or_list;
    const Key table =
        Key{"table", types::table,
            "Cubic spline through values over time, continued by straight lines before and after."}
            .holding({"table of a drive",
                      "The spline has two continuous derivatives, since a drive cannot jump or have kinks.",
                      {Key{"times", types::list, "Two or more times, ascending.", "s"}.needed(),
                       Key{"values", types::list,
                           "One value per time; for a path, x, y, z of each time in turn.", "m"}
                           .or_in("rad")
                           .needed()}});
    return Table{
        "[[drive]]",
        "A prescribed motion, given by exactly one law over time. Angles (rad) and displacements (m) are "
        "joint coordinates, distances are in m. `rate` and `step` count from the initial value; the "
        "other laws give the coordinate itself. The types point and body prescribe a path: the displacement "
        "of a point from its initial position, in m and world axes; for a path give three numbers wherever "
        "one is listed below. The reaction of a drive acts on the second body, and its power enters the "
        "energy balance. Initial velocities must agree with the law, or `[start]` sets `initial = "
        "\"project\"`; without any velocity in the scenario, livens sets it and warns.",
        {Key{"name", types::text,
             "Name of the drive; results list drives among the joints. Default: `drive of` and the joint or "
             "body."},
         Key{"type", types::choice, ""}.needed(),
         Key{"from", types::number_or_condition,
             "Time, or condition, at which the drive engages; position and rate must agree with the law "
             "then. Default: the "
             "initial time.",
             "s"},
         Key{"until", types::number_or_condition,
             "Time, or condition, at which the drive is released; velocities continue. Default: never.", "s"},
         Key{"value", numbers, "Constant value.", "m"}.or_in("rad").or_formulas(formulas_for_value),
         Key{"rate", numbers,
             "Constant rate, such as `\"60 rpm\"`, from the time at which the drive engages. For a varying "
             "rate, give the coordinate itself as `expression`.",
             "m/s"}
             .or_in("rad/s")
             .or_formulas("for a varying rate give the angle or displacement itself as 'expression', as in "
                          "\"5*t^2\""),
         harmonic_key(numbers), step_key(numbers),
         Key{"expression", types::text_or_list,
             "Formula of the time t, in rad or m: `0.1*sin(2*pi*t)`. It must not have kinks."},
         Key{"polynomial", types::list,
             "Coefficients of 1, t, t^2, .. as plain numbers in rad or m and s; for a path, x, y, z of each "
             "coefficient."}
             .or_formulas(
                 "coefficients of powers of t have a unit each: give plain numbers, in rad or m and s"),
         table}}
        .with_kinds("type", drive_kinds());
}

void read_drives(Builder& builder)
{
    std::unordered_set<std::string> taken;
    for (const Joint& joint : builder.model().joints()) taken.insert(joint.name);
    for (const Section& drive : builder.top().sections("drive")) read_drive(builder, drive, taken);
}

}   // namespace livens::inline io_internal
