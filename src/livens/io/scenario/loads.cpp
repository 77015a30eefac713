// SPDX-License-Identifier: BSD-3-Clause
// [[load]]: one table of kinds, from which the schema, the reader and the documentation follow.
#include <limits>

#include "livens/io/scenario/builder.h"

namespace livens {

namespace {

struct Interval {
    double from = -std::numeric_limits<double>::infinity();
    double until = std::numeric_limits<double>::infinity();
};

Interval read_interval(const Section& load)
{
    Interval interval;
    if (load.has("from")) interval.from = load.number("from");
    if (load.has("until")) interval.until = load.number("until");
    return interval;
}

bool check_interval(const Builder& builder, const Section& load, Findings& findings)
{
    const Interval acts = read_interval(load);
    if (acts.until <= acts.from)
        return load.error("until", "window-order",
                          "'until' of " + load.label() + " must be later than 'from'");
    const Section* time = only_section(builder.top(), "time");
    if (time == nullptr || !time->is_valid()) return true;
    if (acts.from >= time->number("end") || acts.until <= time->number("start"))
        findings.warning(load.place(load.has("from") ? "from" : "until"), "load-never-acts",
                         load.label() + " never acts: its time lies outside the motion's",
                         {"", "the motion lasts from 'start' to 'end' of [time]"});
    return true;
}

bool check_value(const Section& load)
{
    if (!load.at_most_one({"value", "table"}, "load-value")) return false;
    return load.has("value") || load.has("table") ||
           load.error("", "load-value", load.label() + " has neither 'value' nor 'table'",
                      {"", "give 'value' for a constant, 'table' for a function of time"});
}

/// Between two points, or on a joint.
bool check_spring(const Section& load)
{
    if (!load.at_most_one({"between", "joint"}, "spring-place")) return false;
    if (load.has("joint"))
        return load.refuse({"points", "free_length"}, "spring-place", "it acts on a joint: give 'rest'");
    if (!load.has("between"))
        return load.error(
            "", "spring-place", load.label() + " has neither 'between' nor 'joint'",
            {"", "give 'between', the two bodies it connects, or 'joint', the joint it acts on"});
    return load.refuse({"rest", "preload", "coordinate"}, "spring-place", "it acts between two points") &&
           (load.has("free_length") || load.error("", "spring-place", load.label() + " lacks 'free_length'",
                                                  {"", "give the length at which it has no force"}));
}

TimeVector read_table(const Section& table)
{
    const std::vector<double>& times = table.find("times")->numbers;
    const std::vector<double>& rows = table.find("values")->numbers;
    const auto make = table.text("interpolation") == "spline" ? spline_table : linear_table;
    TimeVector value;
    for (std::size_t c = 0; c < 3; ++c) {
        std::vector<double> column;
        for (std::size_t i = c; i < rows.size(); i += 3) column.push_back(rows[i]);
        value[c] = make(times, std::move(column));
    }
    return value;
}

TimeVector read_value(const Section& load)
{
    const Vector3 constant = load.vector("value");
    const Section* table = only_section(load, "table");
    const TimeVector value = table != nullptr ? read_table(*table)
                                              : TimeVector{constant[0], constant[1], constant[2]};
    const Interval acts = read_interval(load);
    return load.has("from") || load.has("until") ? window(value, acts.from, acts.until) : value;
}

/// What a load is made of; `second` is the world for a load on one body.
struct Parts {
    const Section& section;
    std::string name;
    int first, second;
    const Builder& builder;
};

struct LoadKind : Kind {
    Load (*make)(const Parts&);
};

Load make_force(const Parts& p)
{
    return point_force(p.name, p.first, p.section.vector("point"), read_value(p.section),
                       p.section.pick<Frame>("frame"));
}

Load make_torque(const Parts& p)
{
    return torque(p.name, p.first, read_value(p.section), p.section.pick<Frame>("frame"));
}

/// Texts with units must have those of the coordinate: of an angle the key's other one.
void check_units(const Section& section, bool is_angle, const std::string& path)
{
    for (const Value& v : section.values()) {
        if (v.key == nullptr || v.key->other_unit.empty() || !(is_angle ? v.has_unit : v.has_other_unit))
            continue;
        throw InputError({"unit", path + "." + std::string(v.key->name),
                          "'" + std::string(v.key->name) + "' of " + section.label() + " is along " +
                              (is_angle ? "an angle" : "a length"),
                          "", "", "",
                          "give it in " + std::string(is_angle ? v.key->other_unit : v.key->unit)});
    }
    if (const Section* table = section.takes("table") ? only_section(section, "table") : nullptr)
        check_units(*table, is_angle, path + ".table");
}

/// What acts along a coordinate of a joint.
template <class Make>
Load on_joint(const Parts& p, const Make& make)
{
    std::vector<Matrix34> X;
    for (const Body& body : p.builder.model().bodies()) X.push_back(body.X);
    const std::string path = "load[" + p.name + "]";
    const JointReference of = find_coordinate(p.builder, p.section, path);
    check_units(p.section, of.coordinate->coordinate.is_angle(), path);
    return make(*of.joint, *of.coordinate, X);
}

Load make_actuator(const Parts& p)
{
    return on_joint(p, [&](const Joint& joint, const NamedCoordinate& coordinate, const Configurations& X) {
        const Section* table = only_section(p.section, "table");
        TimeFunction value = p.section.number("value");
        if (table != nullptr) {
            const auto make = table->text("interpolation") == "spline" ? spline_table : linear_table;
            value = make(table->find("times")->numbers, table->find("values")->numbers);
        }
        const Interval acts = read_interval(p.section);
        if (p.section.has("from") || p.section.has("until")) value = window(value, acts.from, acts.until);
        return actuator(p.name, joint, coordinate, value, X);
    });
}

Load make_spring(const Parts& p)
{
    if (p.section.has("joint"))
        return on_joint(p,
                        [&](const Joint& joint, const NamedCoordinate& coordinate, const Configurations& X) {
                            const JointSpring law{p.section.number("stiffness"), p.section.number("damping"),
                                                  p.section.number("rest"), p.section.number("preload")};
                            return joint_spring(p.name, joint, coordinate, law, X);
                        });
    check_units(p.section, false, "load[" + p.name + "]");
    const SpringDamper law{p.section.number("stiffness"), p.section.number("damping"),
                           p.section.number("free_length")};
    const Vector3 a = p.section.row("points", 0), b = p.section.row("points", 1);
    if (p.first == world)   // the law is symmetric; the core wants a body first
        return spring_damper(p.name, p.second, b, p.first, a, law);
    return spring_damper(p.name, p.first, a, p.second, b, law);
}

/// A constant or a table of values over time, and when it acts.
std::vector<Key> keys_on_body(const std::string& what, std::string_view unit, const std::vector<Key>& more)
{
    std::vector<Key> keys{Key{"body", types::text, "On which body it acts."}.needed()};
    keys.insert(keys.end(), more.begin(), more.end());
    keys.push_back({"value", types::vector3, "Constant; instead of `table`.", unit});
    keys.push_back(
        Key{"table", types::table, "As a function of time."}
            .holding({"table of a " + what, "Values between the times; constant before and after.",
                      {Key{"times", types::list,
                           "Ascending, two or more; two equal ones are a jump (linear only).", "s"}.needed(),
                       Key{"values", types::rows, "One for each time.", unit}.needed(),
                       choice("interpolation", {"linear", "spline"},
                              "Straight lines, or a cubic spline with two continuous derivatives.")}}));
    keys.push_back(choice("frame", {"world", "body"},
                          "Axes of the values: fixed in the world, or turning with the body."));
    keys.push_back({"from", types::number, "Acts from then on; default: always.", "s"});
    keys.push_back({"until", types::number, "Acts until then; default: for ever.", "s"});
    return keys;
}

const std::vector<LoadKind>& kinds()
{
    static const std::vector<LoadKind> all{
        {{"force", "at a point of a body",
          keys_on_body("force", "N",
                       {{"point", types::vector3, "Where it acts, in body coordinates.", "m", "[0, 0, 0]"}})},
         make_force},
        {{"torque", "on a body", keys_on_body("torque", "N m", {})}, make_torque},
        {{"spring",
          "with a damper, along the line between two points or on a joint",
          {Key{"between", types::names, "The two bodies it connects; one may be `\"world\"`."},
           Key{"joint", types::text, "Instead of `between`: the joint along whose coordinate it acts."},
           coordinate_key(),
           Key{"points", types::pair,
               "Its ends on each body, in the body's coordinates. Default: the reference points, for the "
               "world its origin.",
               "m"},
           Key{"stiffness", types::number, "Force for each metre of elongation, or torque for each radian.",
               "N/m"}
               .or_in("N m/rad")
               .needed()
               .within(not_negative),
           Key{"damping", types::number, "Force for each m/s of elongation, or torque for each rad/s.",
               "N s/m", "0"}
               .or_in("N m s/rad")
               .within(not_negative),
           Key{"free_length", types::number, "With `between`, and needed there: length without force.", "m"}
               .within(not_negative),
           Key{"rest", types::number, "With `joint`: the coordinate without force.", "m", "0"}.or_in("rad"),
           Key{"preload", types::number, "With `joint`: a constant force or torque against the coordinate.",
               "N", "0"}
               .or_in("N m")}},
         make_spring},
        {{"actuator",
          "a force or torque along a coordinate of a joint, between its bodies",
          {Key{"joint", types::text, "The joint."}.needed(), coordinate_key(),
           Key{"value", types::number, "Constant; instead of `table`.", "N"}.or_in("N m"),
           Key{"table", types::table, "As a function of time."}.holding(
               {"table of an actuator",
                "Values between the times; constant before and after.",
                {Key{"times", types::list, "Ascending, two or more; two equal ones are a jump (linear only).",
                     "s"}
                     .needed(),
                 Key{"values", types::list, "One for each time.", "N"}.or_in("N m").needed(),
                 choice("interpolation", {"linear", "spline"},
                        "Straight lines, or a cubic spline with two continuous derivatives.")}}),
           Key{"from", types::number, "Acts from then on; default: always.", "s"},
           Key{"until", types::number, "Acts until then; default: for ever.", "s"}}},
         make_actuator}};
    return all;
}

/// A load without name is called by its type and bodies, and numbered if there are more of the kind.
std::string claim_load_name(const Section& load, std::unordered_set<std::string>& taken)
{
    if (load.has("name")) {
        if (load.find("name") != nullptr)
            claim_name(load, "load", load.text("name"), taken,
                       {"", "rename one of them, or leave out the name"});
        return load.text("name");
    }
    const std::string base = default_name(load);
    std::string name = base;
    for (int i = 2; !taken.insert(name).second; ++i) name = base + " " + std::to_string(i);
    return name;
}

/// The bodies that it names by `between` or `body`; false unless they can be used.
bool find_bodies(Builder& builder, const Section& load, BodyReference& first, BodyReference& second)
{
    if (load.has("joint")) return load.find("joint") != nullptr;
    if (load.has("between")) return builder.find_pair(load, "load-self", first, second);
    const Value* named = load.find("body");
    if (named == nullptr) return false;
    if (named->text == "world")
        return load.error("body", "load-self", load.label() + " acts on the world, which does not move");
    first = builder.find_body(named->text, named->node->place, load);
    return first.is_usable;
}

void read_load(Builder& builder, const Section& load, const std::string& name, bool has_good_name)
{
    const std::string path = "load[" + name + "]";
    builder.remember(path, load);
    if (load.kind() == any_kind) return;
    bool is_good = load.is_valid() && has_good_name;
    if (load.takes("value")) is_good = check_value(load) && is_good;
    if (load.takes("preload")) is_good = check_spring(load) && is_good;
    if (load.takes("from")) is_good = check_interval(builder, load, builder.findings()) && is_good;
    BodyReference first, second;
    if (!find_bodies(builder, load, first, second) || !is_good) return;
    const auto make = kinds()[static_cast<std::size_t>(load.kind())].make;
    builder.guard(path, [&] {
        builder.model().add_load(make({load, name, first.index, second.index, builder}));
    });
}

}   // namespace

Table load_table()
{
    return Table{"[[load]]", "Gravity is not a load: it stands at the top of the file.",
                 {Key{"name", types::text, "For messages; default: type and bodies."},
                  Key{"type", types::choice, ""}.needed()}}
        .with_kinds("type", {kinds().begin(), kinds().end()});
}

void read_loads(Builder& builder)
{
    const std::span<const Section> sections = builder.top().sections("load");
    // Known names come first, so that a default does not take one of them.
    std::unordered_set<std::string> taken;
    std::vector<std::string> names(sections.size());
    std::vector<bool> is_good(sections.size());
    for (const bool given : {true, false})
        for (std::size_t i = 0; i < sections.size(); ++i) {
            if (sections[i].has("name") != given) continue;
            const int before = builder.findings().n_errors();
            check_name(sections[i]);
            names[i] = claim_load_name(sections[i], taken);
            is_good[i] = builder.findings().n_errors() == before;
        }
    for (std::size_t i = 0; i < sections.size(); ++i) read_load(builder, sections[i], names[i], is_good[i]);
}

}   // namespace livens
