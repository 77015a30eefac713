// SPDX-License-Identifier: BSD-3-Clause
// Spring, damper and preload along a coordinate of a joint: theory.md, "Coordinates of joints", Loads along
// coordinates. Angles are unwrapped where the force depends on them.
#include "livens/multibody/loads/load_coordinate.h"
#include "livens/multibody/loads/load_values.h"

namespace livens {

namespace {

struct AlongJoint {
    LoadCoordinate along;
    JointSpring spring;

    SpringValue elastic(double value) const
    {
        const double e = value - spring.rest;
        if (spring.law) return spring.law(e);
        return {spring.stiffness * e, spring.stiffness, 0.5 * spring.stiffness * e * e};
    }
    bool is_elastic() const { return spring.law || spring.stiffness != 0; }
    LawValue force(const CoordinateState& q) const
    {
        const double drag = spring.damping * q.rate + spring.preload;
        if (!is_elastic()) return {-drag, 0, -spring.damping};   // also where turns are not known
        const SpringValue value = elastic(q.value);
        return {-value.force - drag, -value.stiffness, -spring.damping};
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
        if (Q.place < 0)
            Q = tape.number(-spring.preload);
        else
            Q = -spring.preload + Q;
        along.pull(tape, factor * Q);
    }
    double potential(const CoordinateState& q) const
    {
        return (is_elastic() ? elastic(q.value).energy : 0) +
               (spring.preload == 0 ? 0 : spring.preload * (q.value - spring.rest));
    }
    double power(const CoordinateState& q) const { return -spring.damping * q.rate * q.rate; }
    TapeNumber recorded_power(LoadTape& tape) const
    {
        if (spring.damping == 0) return tape.number(0);
        const TapeNumber rate = along.rate(tape);
        return -spring.damping * (rate * rate);
    }
};

}   // namespace

Load joint_spring(const std::string& name, const NamedCoordinate& coordinate, const JointSpring& spring,
                  const Configurations& X)
{
    const bool is_angle = coordinate.coordinate.is_angle();
    AlongJoint of{LoadCoordinate(coordinate.coordinate, coordinate.at_stated, X), spring};
    Load load = start_load(name, "joint_spring", of.along.bodies());
    check_not_negative(load, spring.stiffness, "stiffness");
    check_not_negative(load, spring.damping, "damping");
    check_load_vector(load, {spring.rest, spring.preload, 0}, "rest and preload");
    load.depends_on_X = true;
    load.depends_on_V = spring.damping > 0;
    load.needs_directors = of.along.needs_directors();
    // A damper alone does not read the angle, so it works in families that do not count turns.
    const bool counts_turns = is_angle && (of.is_elastic() || spring.preload != 0);
    of.along.place(load, counts_turns);
    if (counts_turns)
        load.domain =
            "this family knows its angle up to 175 degrees from where the joint stands at the start";
    load.forces = [of](const LoadArguments& arguments, LoadForces& F) {
        of.along.add_forces(arguments, of.force(of.along.look(arguments)).force, F);
    };
    load.forces.record = [of](LoadTape& tape, const TapeNumber& factor) { of.record(tape, factor); };
    load.tangent = [of](const LoadArguments& arguments, LoadTangent& tangent) {
        of.along.add_tangent(arguments, of.force(of.along.look(arguments)), tangent);
    };
    load.products = [of](const LoadArguments& arguments) {
        const LawValue Q = of.force(of.along.look(arguments));
        ProductSlopes found(arguments.X.size());
        of.along.add_forces(arguments, 1, found.direction);
        of.along.add_products(arguments, Q.by_value, Q.by_rate, found);
        return std::vector{std::move(found)};
    };
    if (!spring.law.bends.empty()) {
        load.guards = {{spring.law.bends}};
        load.guarded = [of](const LoadArguments& arguments, std::span<double> e) {
            e[0] = of.along.look(arguments).value - of.spring.rest;
        };
    }
    load.potential = [of](const LoadArguments& arguments) { return of.potential(of.along.look(arguments)); };
    load.power = [of](const LoadArguments& arguments) { return of.power(of.along.look(arguments)); };
    load.recorded_power = [of](LoadTape& tape) { return of.recorded_power(tape); };
    load.readings = {{"force", is_angle ? "N m" : "N", [of](const LoadArguments& arguments) {
                          return of.force(of.along.look(arguments)).force;
                      }}};
    return load;
}

}   // namespace livens
