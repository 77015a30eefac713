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
        spring_case("nothing", 1, [](SpringDamper& law) { law = {}; }),
    };
    return cases;
}

}   // namespace livens
