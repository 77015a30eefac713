// SPDX-License-Identifier: BSD-3-Clause
// livens sample for people, and as a table.
#include <cmath>
#include <initializer_list>

#include <fmt/format.h>

#include "console.h"
#include "livens/base/text.h"
#include "livens/io/shown_unit.h"
#include "sample_query.h"

namespace livens::program {

namespace {

/// "rad/s" of "rad".
std::string rate_of(const std::string& unit, const char* power = "") { return unit + "/s" + power; }

/// Rows of an instant.
class Rows {
public:
    explicit Rows(const std::vector<std::string>& units) : units_(units) {}

    template <int N>
    void add(const std::string& name, const std::string& unit, const Matrix<N, 1>& v)
    {
        const ShownUnit shown = shown_unit(unit, units_);
        text += fmt::format("  {:<22}", name);
        for (const double x : v.a) text += fmt::format(" {:>24}", to_text(shown.factor * x));
        text += fmt::format("  {}\n", shown.unit);
    }
    void add_number(const std::string& name, const std::string& unit, double x)
    {
        add(name, unit, Matrix<1, 1>{x});
    }

    std::string text;

private:
    const std::vector<std::string>& units_;
};

void add_joint(Rows& rows, const Query& q, double t)
{
    const JointSample s = joint_at(q, t);
    if (!s.is_bounded) {
        rows.text += "  (no force or torque: the joints lose rank here, and reactions grow without bound)\n";
        return;
    }
    for (const auto& [name, of, value] : coordinates_at(q, t)) {
        const std::string unit = of->is_angle() ? "rad" : "m";
        rows.add_number(name, unit, value.value);
        rows.add_number(name + " rate", rate_of(unit), value.rate);
        rows.add_number(name + " acceleration", rate_of(unit, "^2"), value.acceleration);
    }
    rows.add("force", "N", s.right.force);
    rows.add("torque", "N m", s.right.torque);
    if (!(s.left.force == s.right.force && s.left.torque == s.right.torque)) {
        rows.add("force before", "N", s.left.force);
        rows.add("torque before", "N m", s.left.torque);
    }
    if (!s.is_unique)
        rows.text += "  (not unique: other joints could carry part of " + in_words(s.shared) + ")\n";
    if (const double error = joint_error(q, t) * q.run.estimate.largest_reaction; std::isfinite(error))
        rows.text += fmt::format("  {:<22} {:.1e} N, {:.1e} N m\n", "estimated error", error,
                                 error * q.run.estimate.length);
    if (!s.is_acceleration_level)
        rows.text += "  (interpolated multipliers)\n";
    else if (!q.arguments.exact && element_end_at(q.run.motion.mesh, t) < 0)
        rows.text += "  (between element ends; --exact has the full order)\n";
}

void add_body(Rows& rows, const Query& q, double t)
{
    const BodySample s = body_at(q, t);
    const BodyAcceleration a = acceleration_at(q, t);
    rows.add("position", "m", s.position);
    rows.add("center of mass", "m", s.center_of_mass);
    rows.add("velocity", "m/s", s.velocity);
    rows.add("acceleration", "m/s^2", a.linear);
    if (!q.scenario.model.bodies()[q.index].is_point) {
        for (int i = 0; i < 3; ++i) rows.add(i == 0 ? "d1" : i == 1 ? "d2" : "d3", "", s.directors.column(i));
        rows.add("quaternion w x y z", "", s.quaternion);
        rows.add("angular velocity", "rad/s", s.angular_velocity);
        rows.add("  in body axes", "rad/s", s.angular_velocity_body);
        rows.add("angular acceleration", "rad/s^2", a.angular);
    }
    rows.add("linear momentum", "N s", s.linear_momentum);
    rows.add("angular momentum", "N m s", s.angular_momentum);
    const BodyGap error = body_error(q, t);
    if (std::isfinite(error.position))
        rows.text +=
            fmt::format("  {:<22} {:.1e} m, {:.1e} rad{}\n", "estimated error",
                        error.position * q.run.estimate.length, error.orientation,
                        std::isfinite(error.velocity) ? fmt::format(", {:.1e} m/s", error.velocity) : "");
}

/// A table whose head is made by its first row.
class Table {
public:
    explicit Table(const std::vector<std::string>& units) : units_(units) {}

    void begin(double t)
    {
        if (is_first_) head_ = "t [s]";
        rows_ += to_text(t);
    }
    /// Components, which share a unit; the empty unit is not told.
    template <int N>
    void add(std::initializer_list<std::string> names, const std::string& unit, const Matrix<N, 1>& v)
    {
        const ShownUnit shown = shown_unit(unit, units_);
        for (const std::string& name : names)
            if (is_first_) head_ += "," + name + (unit.empty() ? "" : " [" + shown.unit + "]");
        for (const double x : v.a) rows_ += "," + (std::isfinite(x) ? to_text(shown.factor * x) : "");
    }
    void add_number(const std::string& name, const std::string& unit, double x)
    {
        add({name}, unit, Matrix<1, 1>{x});
    }
    void add_answer(const std::string& name, std::optional<bool> is_so)
    {
        if (is_first_) head_ += "," + name;
        rows_ += !is_so ? "," : *is_so ? ",1" : ",0";
    }
    void end()
    {
        rows_ += "\r\n";
        is_first_ = false;
    }
    std::string text() const { return head_ + "\r\n" + rows_; }

private:
    const std::vector<std::string>& units_;
    bool is_first_ = true;
    std::string head_, rows_;
};

void add_body(Table& table, const Query& q, double t)
{
    const BodySample s = body_at(q, t);
    const BodyAcceleration a = acceleration_at(q, t);
    const BodyGap error = body_error(q, t);
    table.add({"x", "y", "z"}, "m", s.position);
    table.add({"qw", "qx", "qy", "qz"}, "", s.quaternion);
    table.add({"vx", "vy", "vz"}, "m/s", s.velocity);
    table.add({"wx", "wy", "wz"}, "rad/s", s.angular_velocity);
    table.add({"ax", "ay", "az"}, "m/s^2", a.linear);
    table.add({"alphax", "alphay", "alphaz"}, "rad/s^2", a.angular);
    table.add_number("estimated_position_error", "1", error.position);
    table.add_number("estimated_orientation_error", "rad", error.orientation);
    table.add_number("estimated_velocity_error", "m/s", error.velocity);
    table.add_answer("beyond_horizon", beyond_horizon(q, t));
}

void add_joint(Table& table, const Query& q, double t)
{
    const JointSample s = joint_at(q, t);
    table.add({"fx", "fy", "fz"}, "N", s.right.force);
    table.add({"mx", "my", "mz"}, "N m", s.right.torque);
    table.add_number("estimated_reaction_error", "1", joint_error(q, t));
    table.add_answer("beyond_horizon", beyond_horizon(q, t));
    for (const auto& [name, of, value] : coordinates_at(q, t)) {
        const std::string unit = of->is_angle() ? "rad" : "m";
        table.add_number(name, unit, value.value);
        table.add_number(name + "_rate", rate_of(unit), value.rate);
        table.add_number(name + "_acceleration", rate_of(unit, "^2"), value.acceleration);
    }
}

}   // namespace

std::string text_of(const Query& q, double t)
{
    Rows rows(q.arguments.units);
    rows.text = fmt::format("t = {} s\n", to_text(t));
    if (beyond_horizon(q, t).value_or(false))
        rows.text += fmt::format(
            "  (beyond the horizon of {} s: one of many motions, rounding at the start chose it)\n",
            to_text(q.run.verdict.horizon, 4));
    if (q.arguments.body.empty())
        add_joint(rows, q, t);
    else
        add_body(rows, q, t);
    return rows.text;
}

std::string csv_of(const Query& q, const std::vector<double>& times)
{
    Table table(q.arguments.units);
    for (const double t : times) {
        table.begin(t);
        if (q.arguments.body.empty())
            add_joint(table, q, t);
        else
            add_body(table, q, t);
        table.end();
    }
    return table.text();
}

std::vector<std::string> units_shown(const Query& q)
{
    if (!q.arguments.body.empty()) return {"m", "m/s", "m/s^2", "rad/s", "rad/s^2", "rad", "N s", "N m s"};
    std::vector<std::string> units{"N", "N m"};
    for (const auto& [name, of, value] : coordinates_at(q, q.run.motion.start())) {
        const std::string unit = of->is_angle() ? "rad" : "m";
        units.insert(units.end(), {unit, rate_of(unit), rate_of(unit, "^2")});
    }
    return units;
}

}   // namespace livens::program
