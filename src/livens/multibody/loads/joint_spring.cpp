// SPDX-License-Identifier: BSD-3-Clause
// Spring, damper and preload along a coordinate of a joint: theory.md, "Coordinates of joints", Loads along
// coordinates. Angles are unwrapped where the force depends on them.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/multibody/loads/load_coordinate.h"
#include "livens/multibody/loads/load_laws.h"
#include "livens/multibody/loads/load_values.h"

namespace livens {

namespace {

/// The spring at one limit. With s, how far q is beyond it, the force back is stiffness times the positive
/// part of g = s + max(s, 0) damping s', which is the guard: it passes zero where the spring begins to act,
/// and where it would begin to pull.
struct AtLimit {
    double limit, outwards;   ///< 1 at the upper one, -1 at the lower one
    double stiffness, damping;

    double beyond(double q) const { return outwards * (q - limit); }
    double guard(const CoordinateState& q) const
    {
        const double s = beyond(q.value);
        return s + std::max(s, 0.0) * damping * outwards * q.rate;
    }
    /// Adds to a force along q.
    void add(const CoordinateState& q, LawValue& Q) const
    {
        const double s = beyond(q.value), g = guard(q);
        if (s <= 0 || g <= 0) return;
        Q.force -= outwards * stiffness * g;
        Q.by_value -= stiffness * (1 + damping * outwards * q.rate);
        Q.by_rate -= stiffness * s * damping;
    }
    double potential(double q) const
    {
        const double s = std::max(beyond(q), 0.0);
        return 0.5 * stiffness * s * s;
    }
    /// Of what is not the spring: the force less stiffness s back, times the rate.
    double power(const CoordinateState& q) const
    {
        const double s = std::max(beyond(q.value), 0.0);
        return -stiffness * (std::max(guard(q), 0.0) - s) * outwards * q.rate;
    }

    TapeNumber positive(TapeNumber a) const { return made(TapeKind::greatest, a, a.tape->number(0).place); }
    TapeNumber recorded_beyond(TapeNumber q) const { return outwards > 0 ? q - limit : limit + -q; }
    TapeNumber recorded_guard(TapeNumber q, TapeNumber rate) const
    {
        const TapeNumber s = recorded_beyond(q);
        return damping > 0 ? s + outwards * damping * (positive(s) * rate) : s;
    }
    TapeNumber recorded_force(TapeNumber q, TapeNumber rate) const
    {
        const TapeNumber g = recorded_guard(q, rate);
        q.tape->watch_guard(g);
        return -outwards * stiffness * positive(g);
    }
    TapeNumber recorded_power(TapeNumber q, TapeNumber rate) const
    {
        const TapeNumber more = positive(recorded_guard(q, rate)) - positive(recorded_beyond(q));
        return -outwards * stiffness * (more * rate);
    }
};

/// A joint that stands at a limit is not beyond it by what rounding makes of it: springs begin this far out.
double rounding_at(double limit) { return 1e-12 * std::max(1.0, std::abs(limit)); }

std::vector<AtLimit> springs_at(const JointLimits& limits)
{
    std::vector<AtLimit> all;
    if (limits.stiffness > 0 && std::isfinite(limits.low))
        all.push_back({limits.low - rounding_at(limits.low), -1, limits.stiffness, limits.damping});
    if (limits.stiffness > 0 && std::isfinite(limits.high))
        all.push_back({limits.high + rounding_at(limits.high), 1, limits.stiffness, limits.damping});
    return all;
}

struct AlongJoint {
    LoadCoordinate along;
    JointSpring spring;
    std::vector<AtLimit> limits;

    SpringValue elastic(double value) const
    {
        const double e = value - spring.rest;
        if (spring.law) return spring.law(e);
        return {spring.stiffness * e, spring.stiffness, 0.5 * spring.stiffness * e * e};
    }
    bool is_elastic() const { return spring.law || spring.stiffness != 0; }
    LawValue force(const CoordinateState& q) const
    {
        LawValue Q{-spring.damping * q.rate - spring.preload, 0, -spring.damping};
        if (is_elastic()) {   // else the value does not count, which may be no number
            const SpringValue value = elastic(q.value);
            Q.force = -value.force + Q.force;
            Q.by_value = -value.stiffness;
        }
        for (const AtLimit& limit : limits) limit.add(q, Q);
        return Q;
    }
    void record(LoadTape& tape, TapeNumber factor) const
    {
        TapeNumber Q{&tape};
        const auto add = [&](TapeNumber more) { Q = Q.place < 0 ? more : Q + more; };
        if (spring.damping > 0) add(-spring.damping * along.rate(tape));
        if (is_elastic()) {
            const TapeNumber e = along.value(tape) - spring.rest;
            if (spring.law && !spring.law.bends.empty()) tape.watch_guard(e);
            add(spring.law ? -recorded(spring.law, e) : -spring.stiffness * e);
        }
        for (const AtLimit& limit : limits) add(limit.recorded_force(along.value(tape), along.rate(tape)));
        if (Q.place < 0)
            Q = tape.number(-spring.preload);
        else
            Q = -spring.preload + Q;
        along.pull(tape, factor * Q);
    }
    double potential(const CoordinateState& q) const
    {
        double energy = (is_elastic() ? elastic(q.value).energy : 0) +
                        (spring.preload == 0 ? 0 : spring.preload * (q.value - spring.rest));
        for (const AtLimit& limit : limits) energy += limit.potential(q.value);
        return energy;
    }
    double power(const CoordinateState& q) const
    {
        double sum = -spring.damping * q.rate * q.rate;
        for (const AtLimit& limit : limits) sum += limit.power(q);
        return sum;
    }
    TapeNumber recorded_power(LoadTape& tape) const
    {
        TapeNumber sum{&tape};
        const TapeNumber rate = along.rate(tape);
        const auto add = [&](TapeNumber more) { sum = sum.place < 0 ? more : sum + more; };
        if (spring.damping > 0) add(-spring.damping * (rate * rate));
        for (const AtLimit& limit : limits) add(limit.recorded_power(along.value(tape), rate));
        return sum.place < 0 ? tape.number(0) : sum;
    }
    /// What decides on which piece the force is: where the law of the spring bends, then the limits.
    std::vector<Guard> guards() const
    {
        std::vector<Guard> all;
        if (!spring.law.bends.empty()) all.push_back({spring.law.bends});
        for (std::size_t i = 0; i < limits.size(); ++i) all.emplace_back();
        return all;
    }
    void guarded(const CoordinateState& q, std::span<double> numbers) const
    {
        std::size_t n = 0;
        if (!spring.law.bends.empty()) numbers[n++] = q.value - spring.rest;
        for (const AtLimit& limit : limits) numbers[n++] = limit.guard(q);
    }
    /// How far the coordinate is beyond its limits.
    double penetration(const CoordinateState& q) const
    {
        double most = 0;
        for (const AtLimit& limit : limits) most = std::max(most, limit.beyond(q.value));
        return most;
    }
};

/// Where nobody knows the coordinate.
const char* domain_of(CoordinateKind kind)
{
    switch (kind) {
    case CoordinateKind::displacement:
        return "";
    case CoordinateKind::angle:
        return "this family knows its angle up to 175 degrees from where the joint stands at the start";
    case CoordinateKind::outer_angle:
    case CoordinateKind::arc_sine:
        return "three angles of a ball joint are not unique where the second one is 90 degrees, and end 0.6 "
               "degrees before";
    case CoordinateKind::rotation_component:
    case CoordinateKind::rotation_angle:
        break;
    }
    return "the rotation vector of a ball joint changes its sign at half a turn, and ends at 175 degrees";
}

void check_joint_spring(const Load& load, const JointSpring& spring, const JointLimits& limits)
{
    check_not_negative(load, spring.stiffness, "stiffness");
    check_not_negative(load, spring.damping, "damping");
    check_not_negative(load, limits.stiffness, "limit_stiffness");
    check_not_negative(load, limits.damping, "limit_damping");
    check_load_vector(load, {spring.rest, spring.preload, 0}, "rest and preload");
    if (!(limits.low < limits.high))
        throw InputError({"joint-limits", "load[" + load.name + "].limits",
                          "the limits of '" + load.name + "' are not in order",
                          to_text(limits.low) + ", " + to_text(limits.high),
                          "the lower one first, then the upper one", "", ""});
}

}   // namespace

Load joint_spring(const std::string& name, const NamedCoordinate& coordinate, const JointSpring& spring,
                  const Configurations& X)
{
    return joint_spring(name, coordinate, spring, {}, X);
}

Load joint_spring(const std::string& name, const NamedCoordinate& coordinate, const JointSpring& spring,
                  const JointLimits& limits, const Configurations& X)
{
    const bool is_angle = coordinate.coordinate.is_angle();
    AlongJoint placed{LoadCoordinate(coordinate.coordinate, coordinate.at_stated, X), spring,
                      springs_at(limits)};
    Load load = start_load(name, "joint_spring", placed.along.bodies());
    check_joint_spring(load, spring, limits);
    load.depends_on_X = true;
    load.depends_on_V = spring.damping > 0 || (limits.acts() && limits.damping > 0);
    load.needs_directors = placed.along.needs_directors();
    // A damper alone does not read the angle, so it works in families that do not count turns.
    const bool reads_angle =
        is_angle && (placed.is_elastic() || spring.preload != 0 || !placed.limits.empty());
    placed.along.place(load, reads_angle);
    // One for all functions of the load and its copies.
    const auto of = std::make_shared<const AlongJoint>(std::move(placed));
    if (reads_angle) load.domain = domain_of(coordinate.coordinate.kind);
    load.forces = [of](const LoadArguments& arguments, LoadForces& F) {
        of->along.add_forces(arguments, of->force(of->along.look(arguments)).force, F);
    };
    load.forces.record = [of](LoadTape& tape, const TapeNumber& factor) { of->record(tape, factor); };
    load.tangent = [of](const LoadArguments& arguments, LoadTangent& tangent) {
        of->along.add_tangent(arguments, of->force(of->along.look(arguments)), tangent);
    };
    load.products = [of](const LoadArguments& arguments) {
        const LawValue Q = of->force(of->along.look(arguments));
        ProductSlopes found(arguments.X.size());
        of->along.add_forces(arguments, 1, found.direction);
        of->along.add_products(arguments, Q.by_value, Q.by_rate, found);
        return std::vector{std::move(found)};
    };
    load.guards = of->guards();
    if (!load.guards.empty())
        load.guarded = [of](const LoadArguments& arguments, std::span<double> numbers) {
            of->guarded(of->along.look(arguments), numbers);
        };
    load.potential = [of](const LoadArguments& arguments) {
        return of->potential(of->along.look(arguments));
    };
    load.power = [of](const LoadArguments& arguments) { return of->power(of->along.look(arguments)); };
    load.recorded_power = [of](LoadTape& tape) { return of->recorded_power(tape); };
    load.readings = {{"effort", is_angle ? "N m" : "N", [of](const LoadArguments& arguments) {
                          return of->force(of->along.look(arguments)).force + 0.0;   // no -0
                      }}};
    if (of->limits.empty()) return load;
    load.readings.push_back({"penetration", is_angle ? "rad" : "m", [of](const LoadArguments& arguments) {
                                 return of->penetration(of->along.look(arguments));
                             }});
    load.readings.push_back({"limit_stiffness", is_angle ? "N m/rad" : "N/m",
                             [stiffness = limits.stiffness](const LoadArguments&) { return stiffness; }});
    load.readings.push_back({"limit_damping", is_angle ? "s/rad" : "s/m",
                             [damping = limits.damping](const LoadArguments&) { return damping; }});
    return load;
}

}   // namespace livens
