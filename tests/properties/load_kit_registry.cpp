// SPDX-License-Identifier: BSD-3-Clause
// Every load of the library in every variant, one entry each: the kit runs over this list.
#include "properties/load_kit.h"

namespace livens {

namespace {

TimeVector steady(Random& random) { return {random.number(), random.number(), random.number()}; }

/// One component of every kind of time function.
TimeVector varying(Random& random)
{
    return {linear_table({-1, 0.5, 0.5, 2}, {random.number(), 1.2, -1, random.number()}),
            spline_table({-1, 0, 0.5, 2}, {random.number(), random.number(), 0.3, 1}),
            window(TimeFunction(1 + random.number() / 2), 0.25, 3)};
}

SpringDamper spring(Random& random)
{
    return {5 + 4 * random.number(), 2 + random.number(), 1 + random.number()};
}

LoadCase force_case(const std::string& what, Frame frame, TimeVector (*value)(Random&))
{
    return {"force", what, [=](Random& random) {
                const Vector3 place = random.vector();
                return point_force("l", 0, place, value(random), frame);
            }};
}

LoadCase torque_case(const std::string& what, Frame frame, TimeVector (*value)(Random&))
{
    return {"torque", what, [=](Random& random) { return torque("l", 0, value(random), frame); }};
}

/// `change` takes parts of the spring away.
LoadCase spring_case(const std::string& what, int second, void (*change)(SpringDamper&))
{
    return {"spring_damper", what, [=](Random& random) {
                SpringDamper law = spring(random);
                change(law);
                const Vector3 a = random.vector(), b = random.vector();
                return spring_damper("l", 0, a, second, b, law);
            }};
}

/// A pipe between two bodies that stand anywhere, or between one and the world.
struct Pipe {
    std::array<Matrix34, 2> X;
    Vector3 at, axis;
    Joint joint;

    explicit Pipe(int first)
    {
        Random random(5);
        X = {random.rigid(), first == world ? world_configuration : random.rigid()};
        at = random.vector();
        axis = random.unit();
        joint = cylindrical("pipe", first, 0, joint_frame(X[1], X[0], at, axis));
    }
};

using MakeAlong = Load (*)(Random&, const Joint&, const NamedCoordinate&, const Configurations&);

/// Bodies turned by up to 2 rad, beyond which differences would meet half a turn, and a little deformed.
LoadCase along_case(const std::string& type, const std::string& what, int first, const char* coordinate,
                    MakeAlong make)
{
    const Pipe pipe(first);
    return {type, what,
            [=](Random& random) {
                return make(random, pipe.joint, *find_coordinate(pipe.joint, coordinate),
                            std::vector(pipe.X.begin(), pipe.X.end()));
            },
            [=](Random& random) {
                std::array<Matrix34, 2> X = pipe.X;
                const Matrix3 R = directors_from_rotation_vector(2 * random.number() * pipe.axis);
                X[0] = configuration(pipe.at + R * (X[0].column(0) - pipe.at), R * directors(X[0]));
                X[0] += 0.1 * random.matrix<3, 4>();
                if (first != world) X[1] += 0.1 * random.matrix<3, 4>();
                return X;
            }};
}

Load any_joint_spring(Random& random, const Joint& joint, const NamedCoordinate& coordinate,
                      const Configurations& X)
{
    const double preload = coordinate.coordinate.is_angle() ? 0 : random.number();   // else a power
    return joint_spring("l", joint, coordinate,
                        {5 + 4 * random.number(), 2 + random.number(), random.number(), preload}, X);
}
Load any_joint_damper(Random& random, const Joint& joint, const NamedCoordinate& coordinate,
                      const Configurations& X)
{
    return joint_spring("l", joint, coordinate, {0, 2 + random.number(), 0, 0}, X);
}
Load any_actuator(Random& random, const Joint& joint, const NamedCoordinate& coordinate,
                  const Configurations& X)
{
    return actuator("l", joint, coordinate, varying(random)[0], X);
}

}   // namespace

const std::vector<LoadCase>& load_cases()
{
    static const std::vector<LoadCase> cases{
        force_case("force", Frame::inertial, steady),
        force_case("force that varies", Frame::inertial, varying),
        force_case("force in body axes", Frame::body_fixed, varying),
        {"force", "force at the reference point",
         [](Random& random) { return point_force("l", 0, {}, steady(random), Frame::inertial); }},
        torque_case("torque", Frame::inertial, steady),
        torque_case("torque that varies", Frame::inertial, varying),
        torque_case("torque in body axes", Frame::body_fixed, varying),
        spring_case("spring and damper", 1, [](SpringDamper&) {}),
        spring_case("spring and damper on the world", world, [](SpringDamper&) {}),
        spring_case("spring", 1, [](SpringDamper& law) { law.damping = 0; }),
        spring_case("spring without free length", 1,
                    [](SpringDamper& law) { law.damping = law.free_length = 0; }),
        spring_case("damper", 1, [](SpringDamper& law) { law.stiffness = 0; }),
        along_case("joint_spring", "spring along a slide", 1, "displacement", any_joint_spring),
        along_case("joint_spring", "spring along a slide of the world", world, "displacement",
                   any_joint_spring),
        along_case("joint_spring", "spring about an axis", 1, "angle", any_joint_spring),
        along_case("joint_spring", "damper about an axis", 1, "angle", any_joint_damper),
        along_case("actuator", "motor", 1, "angle", any_actuator),
        along_case("actuator", "motor on the world", world, "angle", any_actuator),
        along_case("actuator", "cylinder", 1, "displacement", any_actuator),
        spring_case("nothing", 1, [](SpringDamper& law) { law = {}; }),
    };
    return cases;
}

}   // namespace livens
