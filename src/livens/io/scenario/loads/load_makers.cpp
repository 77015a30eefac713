// SPDX-License-Identifier: BSD-3-Clause
// Loads of the library from the keys of a [[load]] (docs/joints.md, Along coordinates and Expressions). A
// load by a formula is a sum of loads of one unit, times the formula: its tangent is that of the units and,
// by the slopes of the formula, that of the coordinates it reads.
#include "livens/io/scenario/loads/load_makers.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/base/text.h"
#include "livens/io/scenario/joints/expressions.h"
#include "livens/io/scenario/joints/joints.h"
#include "livens/multibody/loads/surface_loads.h"
#include "livens/time/time_laws.h"

namespace livens::inline io_internal {

namespace {

/// Values over time of one component.
TimeFunction read_table(const Section& table, std::size_t component, std::size_t n)
{
    const std::vector<double>& rows = table.find("values")->numbers;
    const auto make = table.text("interpolation") == "spline" ? spline_table : linear_table;
    std::vector<double> column;
    for (std::size_t i = component; i < rows.size(); i += n) column.push_back(rows[i]);
    return make(table.find("times")->numbers, std::move(column));
}

TimeFunction while_it_acts(const Section& load, TimeFunction value)
{
    const Interval acts = read_interval(load);
    return has_number(load, "from") || has_number(load, "until")
               ? window(std::move(value), acts.from, acts.until)
               : value;
}

/// The same, if it has a value when the motion begins.
TimeFunction told(const LoadSources& p, const Expression& expression, TimeFunction value)
{
    const Section* time = only_section(p.builder.run(), "time");
    const double start = time == nullptr ? 0 : time->number("start");
    // A formula that has no value at the start would fail in the first element, with less to be said.
    if (std::isfinite(value({start, Side::right}).value)) return value;
    throw InputError({"expression-value", p.path() + ".expression", "an expression has no value at the start",
                      expression.without_value(start, {}), "", "", "in '" + expression.text() + "'"});
}

/// A law over time alone: n components.
std::vector<TimeFunction> read_values(const LoadSources& p, std::size_t n)
{
    std::vector<TimeFunction> values;
    const Section* table = only_section(p.section, "table");
    const bool is_formula = p.section.has("expression");
    const std::vector<Expression> expressions =
        is_formula ? read_expressions(p.section, {}, p.path()) : std::vector<Expression>();
    const Value* constant = p.section.find("value");
    const std::vector<double> breaks = breaks_of(p.builder, p.section, expressions);
    for (std::size_t c = 0; c < n; ++c) {
        TimeFunction value;
        if (table != nullptr)
            value = read_table(*table, c, n);
        else if (is_formula)
            value = told(p, expressions[c], expression_of_time(expressions[c], breaks));
        else if (constant != nullptr)
            value = constant->numbers[c];
        values.push_back(while_it_acts(p.section, std::move(value)));
    }
    return values;
}

/// What one factor is reported as; of three, `name` is not used.
struct FactorName {
    std::string name, unit;
};

/// By formulas that look at the motion: what units are multiplied by.
Load by_formula(const LoadSources& p, const std::string& type, const FactorName& factor,
                std::vector<Load> units, const Inputs& inputs)
{
    const std::vector<Expression> expressions = read_expressions(p.section, inputs, p.path());
    const std::vector<double> breaks = breaks_of(p.builder, p.section, expressions);
    const TimeFunction acts = while_it_acts(p.section, 1.0);
    const auto name_of = [&](std::size_t k) {
        return units.size() == 1 ? factor.name : std::string(1, "xyz"[k]);
    };
    if (!inputs.reactions.empty()) {
        ReactionLaw law = reaction_law_of(expressions, inputs, breaks, acts);
        law.name = p.name;
        law.type = type;
        for (std::size_t k = 0; k < units.size(); ++k) law.readings.push_back({name_of(k), factor.unit});
        law.units = std::move(units);
        return waiting(std::move(law));
    }
    LoadParts parts = parts_of(expressions, inputs, breaks, acts);
    for (std::size_t k = 0; k < units.size(); ++k)
        parts.readings.push_back(factor_reading(name_of(k), factor.unit, parts.law, k, units.size()));
    parts.units = std::move(units);
    if (!ends_at_bends(p.builder)) warn_of_kinks(p.builder, p.section, "expression", expressions);
    return modulated(p.name, type, parts, places(p.builder));
}

/// Of components along the directors those along the body's axes.
TimeVector in_axes(const LoadSources& p, const TimeVector& value)
{
    const Matrix3& U = p.builder.stretch(p.first);
    // Values that follow the body are stated along its directors; U leads to the orthonormal triad.
    if (U == identity<3>() || p.section.pick<Frame>("frame") != Frame::body_fixed) return value;
    const auto along = [&](int i) {
        return combination({U(i, 0), U(i, 1), U(i, 2)}, {value[0], value[1], value[2]});
    };
    return {along(0), along(1), along(2)};
}

/// A force or torque: by time alone, or by a formula over units along the axes.
template <class Make>
Load on_body(const LoadSources& p, const Make& make)
{
    const Inputs inputs = read_inputs(p.builder, p.section, p.path());
    if (inputs.reads.empty()) {
        const std::vector<TimeFunction> value = read_values(p, 3);
        return make(in_axes(p, {value[0], value[1], value[2]}));
    }
    std::vector<Load> units;
    for (std::size_t k = 0; k < 3; ++k) {
        TimeVector unit{0.0, 0.0, 0.0};
        unit[k] = 1.0;
        units.push_back(make(in_axes(p, unit)));
    }
    const std::string type = units[0].type, unit = units[0].readings[0].unit;
    return by_formula(p, type, {"", unit}, std::move(units), inputs);
}

/// Straight lines bend where they meet, which happens when the motion is there.
void warn_of_kinks(const LoadSources& p, const std::vector<double>& bends)
{
    if (bends.empty()) return;
    p.builder.findings().warning(
        p.section.place("table"), "spring-kink",
        p.section.label() + " bends where the lines of its table meet, at " + to_text(bends[0]),
        {"no element ends there but of lobatto and radau, forwards one after the other, so that the "
         "estimated error may miss it as well",
         "take the family lobatto, or interpolation = \"spline\" in the table"});
}

SpringLaw read_law(const LoadSources& p)
{
    const Section& load = p.section;
    const std::string law = load.text("law");
    if (law == "progressive") return progressive_spring(load.number("stiffness"), load.number("cubic"));
    if (law == "linear") return {};
    const Section& table = *only_section(load, "table");
    const std::vector<double>&x = table.find("elongations")->numbers, &y = table.find("forces")->numbers;
    const bool is_smooth = table.text("interpolation") == "spline";
    SpringLaw made = tabulated_spring(x, y, is_smooth);
    if (!is_smooth && !ends_at_bends(p.builder)) warn_of_kinks(p, bends_of_lines(x, y));
    return made;
}

}   // namespace

bool ends_at_bends(const Builder& builder)
{
    const Section* const method = only_section(builder.run(), "method");
    const Section* const time = only_section(builder.run(), "time");
    const Section* const start = only_section(builder.run(), "start");
    const Section* const end = only_section(builder.run(), "end");
    const std::string family = method != nullptr ? method->text("family") : "lobatto";
    const bool is_nodal = family == "lobatto" || family == "radau" || family == "auto";
    // Elements are cut at bends while a motion is followed forwards, one element after the other, and in
    // further tries where conditions at both ends have all of them solved together.
    const Known at_end = end != nullptr ? end->pick<Known>("given") : Known::nothing;
    const bool is_between = (at_end != Known::nothing && at_end != Known::state) ||
                            (end != nullptr && end->has("known")) ||
                            (start != nullptr && start->has("known")) ||
                            (time != nullptr && time->has("periodic"));
    const bool is_window = method != nullptr && method->has("window") && !is_between;
    return is_nodal && at_end != Known::state && !is_window &&
           !(time != nullptr && time->text("breaks") == "ignore");
}

const NamedCoordinate& coordinate_of(const LoadSources& p)
{
    const NamedCoordinate& coordinate = *find_coordinate(p.builder, p.section, p.path()).coordinate;
    check_units(p.section, coordinate.coordinate.is_angle(), p.path());
    return coordinate;
}

Vector3 point_of(const LoadSources& p) { return p.builder.in_axes(p.first, p.section.vector("point")); }

std::vector<Matrix34> places(const Builder& builder)
{
    const std::vector<Matrix34> X = builder.start_configurations();
    return X;
}

Interval read_interval(const Section& load)
{
    Interval interval;
    if (has_number(load, "from")) interval.from = load.number("from");
    if (has_number(load, "until")) interval.until = load.number("until");
    return interval;
}

Load make_force(const LoadSources& p)
{
    return on_body(p, [&](const TimeVector& value) {
        return point_force(p.name, p.first, point_of(p), value, p.section.pick<Frame>("frame"));
    });
}

Load make_torque(const LoadSources& p)
{
    return on_body(p, [&](const TimeVector& value) {
        return torque(p.name, p.first, value, p.section.pick<Frame>("frame"), p.second);
    });
}

namespace {

/// That of the name, or the whole. Throws InputError `surface-unknown`.
const SurfaceMoments& surface_of(const LoadSources& p)
{
    const std::vector<NamedSurface>& all = p.builder.surfaces()[static_cast<std::size_t>(p.first)];
    const std::string name = p.section.text("surface");
    std::string known;
    for (const NamedSurface& s : all) {
        if (s.name == name) return s.moments;
        if (!s.name.empty()) known += (known.empty() ? "it has '" : "', '") + s.name;
    }
    const std::string body = "body '" + p.builder.body_name(p.first) + "'";
    throw InputError(
        {"surface-unknown", p.path() + ".surface",
         name.empty() ? "all of the surface of " + body + " is not known: it is not one solid"
                      : body + " has no surface '" + name + "'",
         "", "",
         known.empty() ? "parts with names and meshes with named regions have named surfaces" : known + "'",
         ""});
}

/// A row of the gradient, while the load acts.
TimeVector gradient_of(const LoadSources& p, std::size_t row)
{
    TimeVector gradient;
    for (int j = 0; j < 3; ++j) {
        // A matrix of three rows, or for pressures one row.
        const double slope = p.section.find("gradient")->numbers[3 * row + j];
        gradient[j] = while_it_acts(p.section, slope);
    }
    return gradient;
}

}   // namespace

Load make_traction(const LoadSources& p)
{
    const SurfaceMoments& surface = surface_of(p);
    std::vector<TimeVector> gradient;
    for (std::size_t i = 0; p.section.has("gradient") && i < 3; ++i) gradient.push_back(gradient_of(p, i));
    return on_body(p, [&](const TimeVector& value) {
        return traction(p.name, p.first, surface, value, p.section.pick<Frame>("frame"), gradient);
    });
}

Load make_body_force(const LoadSources& p)
{
    const Matrix4& mass = p.builder.model().bodies()[p.first].mass;
    return on_body(p, [&](const TimeVector& value) {
        return body_force(p.name, p.first, mass, value, p.section.pick<Frame>("frame"));
    });
}

Load make_pressure(const LoadSources& p)
{
    const SurfaceMoments& surface = surface_of(p);
    const Inputs inputs = read_inputs(p.builder, p.section, p.path());
    const TimeVector gradient = p.section.has("gradient") ? gradient_of(p, 0) : TimeVector{0.0, 0.0, 0.0};
    if (inputs.reads.empty()) return pressure(p.name, p.first, surface, read_values(p, 1)[0], gradient);
    return by_formula(p, "pressure", {"pressure", "Pa"}, {pressure(p.name, p.first, surface, 1.0)}, inputs);
}

Load make_actuator(const LoadSources& p)
{
    const NamedCoordinate& coordinate = coordinate_of(p);
    const Inputs inputs = read_inputs(p.builder, p.section, p.path());
    const std::vector<Matrix34> X = places(p.builder);
    if (inputs.reads.empty()) return actuator(p.name, coordinate, read_values(p, 1)[0], X);
    return by_formula(p, "actuator", {"effort", coordinate.coordinate.is_angle() ? "N m" : "N"},
                      {unit_along(p.name, coordinate.coordinate, X)}, inputs);
}

Load make_spring(const LoadSources& p)
{
    const Section& s = p.section;
    if (s.has("joint")) {
        const NamedCoordinate& coordinate = coordinate_of(p);
        const JointSpring law{s.number("stiffness"), s.number("damping"), s.number("rest"),
                              s.number("preload"), read_law(p)};
        return joint_spring(p.name, coordinate, law, places(p.builder));
    }
    check_units(s, false, p.path());
    const SpringDamper law{s.number("stiffness"), s.number("damping"), s.number("free_length"),
                           s.number("preload"), read_law(p)};
    if (s.has("over")) return rope_spring(p.name, p.over, law, places(p.builder));
    return spring_damper(p.name, p.first, p.builder.in_axes(p.first, s.row("points", 0)), p.second,
                         p.builder.in_axes(p.second, s.row("points", 1)), law);
}

}   // namespace livens::inline io_internal
