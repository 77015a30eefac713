// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <limits>

#include "livens/multibody/detail/coordinate_load.h"
#include "livens/multibody/detail/load_values.h"

namespace livens {

namespace {

/// Positions do not tell whole turns: nearer than this to half a turn the spring is not a number. What steps
/// over that is found by Load::bounded_angle.
constexpr double widest_angle = 3.05;

struct JointSpringLaw {
    CoordinateLoad along;
    JointSpring spring;
    double middle;   ///< of the angles that are known; nan: all are

    /// A preload about an axis does work in every turn, of which positions do not tell: a power.
    bool knows_turns() const { return std::isnan(middle); }

    LawValue law(const LawArguments& q) const
    {
        if (spring.stiffness != 0 && std::abs(q.value - middle) > widest_angle)
            return {std::numeric_limits<double>::quiet_NaN(), 0, 0};
        return {-spring.stiffness * (q.value - spring.rest) - spring.damping * q.rate - spring.preload,
                -spring.stiffness, -spring.damping};
    }
    double potential(const LawArguments& q) const
    {
        const double stretch = q.value - spring.rest;
        return 0.5 * spring.stiffness * stretch * stretch + (knows_turns() ? spring.preload * stretch : 0);
    }
};

}   // namespace

Load joint_spring(const std::string& name, const Joint& joint, const NamedCoordinate& coordinate,
                  const JointSpring& spring, const Configurations& X)
{
    const bool is_angle = coordinate.coordinate.is_angle();
    const JointSpringLaw law{CoordinateLoad(joint, coordinate, X), spring,
                             is_angle ? coordinate.at_stated : std::numeric_limits<double>::quiet_NaN()};
    Load load = start_load(name, "joint_spring", law.along.bodies());
    check_not_negative(load, spring.stiffness, "stiffness");
    check_not_negative(load, spring.damping, "damping");
    check_load_vector(load, {spring.rest, spring.preload, 0}, "rest and preload");
    load.depends_on_X = true;
    load.depends_on_V = spring.damping > 0;
    load.needs_directors = law.along.needs_directors();
    if (is_angle && spring.stiffness > 0) {
        load.bounded_angle = law.along.coordinate();
        load.domain = "it knows its angle up to 175 degrees from where the joint stands at the start";
    }
    load.forces = [law](const LoadArguments& arguments, LoadForces& F) {
        law.along.forces(arguments, law.law(law.along.look(arguments)).force, F);
    };
    load.tangent = [law](const LoadArguments& arguments, LoadTangent& tangent) {
        law.along.tangent(arguments, law.law(law.along.look(arguments)), tangent);
    };
    load.potential = [law](const LoadArguments& arguments) {
        return law.potential(law.along.look(arguments));
    };
    load.power = [law](const LoadArguments& arguments) {
        const double rate = law.along.look(arguments).rate;
        return -(law.spring.damping * rate + (law.knows_turns() ? 0 : law.spring.preload)) * rate;
    };
    return load;
}

}   // namespace livens
