// SPDX-License-Identifier: BSD-3-Clause
// Every load of the library in every variant, one entry each: the kit runs over this list.
#include "livens/multibody/joints.h"
#include "livens/multibody/loads/load_laws.h"
#include "livens/multibody/loads/surface_loads.h"
#include "livens/time/expression.h"
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

SurfaceMoments any_surface(Random& random)
{
    SurfaceMoments m;
    for (double& x : m.area.a) x = random.number();
    for (Matrix4& of : m.normal)
        for (double& x : of.a) x = random.number();
    m.area = m.area + transpose(m.area);   // as integrals are
    for (Matrix4& of : m.normal) of = of + transpose(of);
    return m;
}

LoadCase traction_case(const std::string& what, Frame frame, TimeVector (*value)(Random&))
{
    return {"traction", what, [=](Random& random) {
                const SurfaceMoments surface = any_surface(random);
                return traction("l", 0, surface, value(random), frame);
            }};
}

LoadCase linear_traction_case(const std::string& what, Frame frame)
{
    return {"traction", what, [=](Random& random) {
                const SurfaceMoments surface = any_surface(random);
                const std::vector<TimeVector> gradient{steady(random), varying(random), steady(random)};
                return traction("l", 0, surface, varying(random), frame, gradient);
            }};
}

LoadCase linear_pressure_case(const std::string& what, TimeVector (*gradient)(Random&))
{
    return {"pressure", what, [=](Random& random) {
                const SurfaceMoments surface = any_surface(random);
                const TimeFunction value = varying(random)[2];
                return pressure("l", 0, surface, value, gradient(random));
            }};
}

LoadCase body_force_case(const std::string& what, Frame frame, TimeVector (*value)(Random&))
{
    return {"body_force", what, [=](Random& random) {
                Matrix4 m{};
                for (double& x : m.a) x = random.number();
                return body_force("l", 0, m, value(random), frame);
            }};
}

LoadCase pressure_case(const std::string& what, TimeVector (*value)(Random&))
{
    return {"pressure", what, [=](Random& random) {
                const SurfaceMoments surface = any_surface(random);
                return pressure("l", 0, surface, value(random)[1]);
            }};
}

LoadCase torque_case(const std::string& what, Frame frame, TimeVector (*value)(Random&), int reaction = world)
{
    return {"torque", what, [=](Random& random) { return torque("l", 0, value(random), frame, reaction); }};
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

/// A rope that passes bodies, and the world, at the places of `on`; `change` takes parts of its law away. Its
/// points are far apart: differences across a place where two of them meet are not smooth.
LoadCase rope_case(const std::string& what, const std::vector<int>& on, void (*change)(SpringDamper&))
{
    return {"rope_spring", what, [=](Random& random) {
                SpringDamper law = spring(random);
                law.stiffness *= 0.02;   // ropes are long
                change(law);
                std::vector<BodyPoint> over;
                for (const int body : on) over.push_back({body, 15 * random.vector()});
                const std::vector<Matrix34> X(4, configuration({}, identity<3>()));
                return rope_spring("l", over, law, X);
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

Load any_joint_spring(Random& random, const Joint&, const NamedCoordinate& coordinate,
                      const Configurations& X)
{
    const double preload = coordinate.coordinate.is_angle() ? 0 : random.number();   // else a power
    return joint_spring("l", coordinate,
                        {5 + 4 * random.number(), 2 + random.number(), random.number(), preload}, X);
}
Load any_joint_damper(Random& random, const Joint&, const NamedCoordinate& coordinate,
                      const Configurations& X)
{
    return joint_spring("l", coordinate, {0, 2 + random.number(), 0, 0}, X);
}
/// Always beyond one of its limits, where the spring pushes.
Load limited_joint(Random& random, const Joint&, const NamedCoordinate& coordinate, const Configurations& X)
{
    const JointSpring law{0, 2 + random.number(), 0, 0};
    const bool is_upper = random.number() > 0;
    const JointLimits limits{is_upper ? -20.0 : 10.0, is_upper ? -10.0 : 20.0, 2 + random.number(), 0.05};
    return joint_spring("l", coordinate, law, limits, X);
}
Load any_actuator(Random& random, const Joint&, const NamedCoordinate& coordinate, const Configurations& X)
{
    return actuator("l", coordinate, varying(random)[0], X);
}

/// A universal or a ball joint between bodies that stand anywhere; its coordinate or reading of that name.
struct Turning {
    std::array<Matrix34, 2> X;
    Vector3 at;
    Joint joint;

    Turning(int first, bool is_ball)
    {
        Random random(7);
        X = {random.rigid(), first == world ? world_configuration : random.rigid()};
        at = random.vector();
        JointFrame frame = joint_frame(X[1], X[0], at, {1, 0, 0});
        frame.axis_second = joint_frame(X[1], X[0], at, {0, 1, 0}).axis_second;
        TriadPair triads;
        triads.second = transpose(directors(X[0])) * directors(X[1]);
        joint = is_ball ? spherical("ball", first, 0, frame, {triads, "yxz"}, X[1], X[0])
                        : universal("cross", first, 0, frame);
    }
    const NamedCoordinate& named(const std::string& name) const
    {
        for (const auto* all : {&joint.coordinates, &joint.readings})
            for (const NamedCoordinate& one : *all)
                if (one.name == name) return one;
        throw std::logic_error(name);
    }
};

/// Turned by 0.3 to 1.1 rad about any axis, far from where angles of a ball joint end, and a little deformed.
LoadCase turning_case(const std::string& type, const std::string& what, int first, bool is_ball,
                      const char* coordinate, MakeAlong make)
{
    const Turning of(first, is_ball);
    return {type, what,
            [=](Random& random) {
                return make(random, of.joint, of.named(coordinate), std::vector(of.X.begin(), of.X.end()));
            },
            [=](Random& random) {
                std::array<Matrix34, 2> X = of.X;
                const double angle = 0.7 + 0.4 * random.number();
                const Matrix3 R = directors_from_rotation_vector(angle * (1 / std::sqrt(3.0)) *
                                                                 Vector3{std::copysign(1, random.number()),
                                                                         std::copysign(1, random.number()),
                                                                         std::copysign(1, random.number())});
                X[0] = configuration(of.at + R * (X[0].column(0) - of.at), R * directors(X[0]));
                X[0] += 0.02 * random.matrix<3, 4>();
                if (first != world) X[1] += 0.02 * random.matrix<3, 4>();
                return X;
            }};
}

Load any_ball_spring(Random& random, const Joint& joint, const NamedCoordinate&, const Configurations& X)
{
    return ball_spring("l", joint, 5 + 4 * random.number(), 2 + random.number(), X);
}

// Knots of tables stand outside of where bodies are: differences across one are not smooth.

/// By a formula that looks at the pipe's angle and slide, and their rates.
Load any_formula(Random& random, const Joint& joint, const NamedCoordinate& coordinate,
                 const Configurations& X)
{
    const double gain = random.number();
    LoadParts parts;
    parts.units = {unit_along("l", coordinate.coordinate, X)};
    for (const char* name : {"angle", "displacement"}) {
        const NamedCoordinate& q = *find_coordinate(joint, name);
        parts.coordinates.push_back({q.coordinate, q.at_stated});
    }
    const Expression of("sin(a)*b - gain*v^2 + w*cos(a - t)", {"a", "b", "w", "v", "gain"});
    parts.law = [=](const LawArguments& at, std::span<double> factors, std::span<double> slopes) {
        const std::array<double, 5> x{at.values[0], at.values[1], at.rates[0], at.rates[1], gain};
        std::array<double, 5> by{};
        factors[0] = of(at.at.t, x, by);
        std::copy_n(by.begin(), slopes.size(), slopes.begin());
    };
    parts.depends_on_rates = true;
    return modulated("l", "actuator", parts, X);
}

/// The same, recorded: every operation that formulas have.
Load recorded_formula(Random&, const Joint& joint, const NamedCoordinate& coordinate, const Configurations& X)
{
    const std::vector<Expression> of{Expression(
        "sin(a)*b - v^2 + w*cos(a - t) + tan(a/3) + tanh(b) * exp(-b^2) + log(2 + b^2) * sqrt(1 + w^2) + "
        "abs(a + 9) + min(a, b + 9) + max(w, v - 99) + atan2(a + 9, b + 9) / (2 + cos(t))",
        {"a", "b", "w", "v"})};
    LoadParts parts;
    parts.units = {unit_along("l", coordinate.coordinate, X)};
    for (const char* name : {"angle", "displacement"}) {
        const NamedCoordinate& q = *find_coordinate(joint, name);
        parts.coordinates.push_back({q.coordinate, q.at_stated});
    }
    parts.law = [of](const LawArguments& at, std::span<double> factors, std::span<double> slopes) {
        const std::array<double, 4> x{at.values[0], at.values[1], at.rates[0], at.rates[1]};
        std::array<double, 4> by{};
        factors[0] = of[0](at.at.t, x, by);
        std::copy_n(by.begin(), slopes.size(), slopes.begin());
    };
    parts.recorded_law = recorded_law(of, {{0, false}, {1, false}, {0, true}, {1, true}}, {}, 1.0);
    parts.depends_on_rates = true;
    return modulated("l", "actuator", parts, X);
}

/// A force that is nothing but a function.
Load any_function(Random& random)
{
    Load load = point_force("l", 0, random.vector(), steady(random), Frame::inertial);
    load.depends_on_X = load.depends_on_V = true;
    load.forces = [](const LoadArguments& at, LoadForces& F) { F[0] = at.X[0] - 2. * at.V[0]; };
    load.needs_directors[0] = true;
    load.tangent = [](const LoadArguments&, LoadTangent& tangent) {
        tangent.X[0][0] = identity<12>();
        tangent.V[0][0] = -2. * identity<12>();
    };
    return load;
}

/// A force by how far a third body is.
Load formula_of_a_third(Random& random)
{
    LoadParts parts;
    parts.units = {point_force("l", 0, random.vector(), {1.0, 0.5, 2.0}, Frame::body_fixed)};
    const std::vector<ConstraintRow> rows =
        coincidence_rows(2, point(random.vector()), 0, point({0, 1, 0}), 1);
    parts.coordinates = {{{{rows[1]}}, 0.3}};
    parts.law = [](const LawArguments& at, std::span<double> factors, std::span<double> slopes) {
        const double q = at.values[0], v = at.rates[0];
        factors[0] = q * q + q * v;
        if (slopes.empty()) return;
        slopes[0] = 2 * q + v;
        slopes[1] = q;
    };
    parts.depends_on_rates = true;
    const std::vector<Matrix34> X{world_configuration, world_configuration, world_configuration};
    return modulated("l", "force", parts, X);
}

Load bent_joint_spring(Random& random, const Joint&, const NamedCoordinate& coordinate,
                       const Configurations& X)
{
    JointSpring law{0, 2 + random.number(), random.number(), 0,
                    progressive_spring(1 + random.number() / 2, 2 + random.number())};
    if (random.number() > 0)
        law.law = tabulated_spring({-9, -5, 5, 9}, {-4, -1, 2 + random.number(), 20}, true);
    return joint_spring("l", coordinate, law, X);
}

Matrix<6, 6> positive_matrix(Random& random)
{
    const Matrix<6, 6> A = random.matrix<6, 6>();
    return A * transpose(A);
}

/// Turned by up to 1.5 rad, where both stand at about the same place, and a little deformed.
LoadCase bushing_case(const std::string& what, int second, double size, bool by_angular_velocity = false)
{
    const std::array<Matrix34, 2> X{world_configuration, world_configuration};
    return {"bushing", what,
            [=](Random& random) {
                const auto frame = [&] { return BodyFrame{random.vector(), directors(random.rigid())}; };
                Bushing law{positive_matrix(random), positive_matrix(random), random.matrix<6, 1>()};
                law.by_angular_velocity = by_angular_velocity;
                BodyFrame first = frame(), second_frame = frame();
                second_frame.axes = first.axes;
                return bushing("l", 0, first, second, second_frame, law, std::vector(X.begin(), X.end()));
            },
            [=](Random& random) {
                std::array<Matrix34, 2> place = X;
                for (int b = 0; b < (second == world ? 1 : 2); ++b) {
                    const Matrix3 R = directors_from_rotation_vector(size / 2 * random.unit());
                    place[b] = configuration(random.vector(), R) + (0.05 * size) * random.matrix<3, 4>();
                }
                return place;
            }};
}

/// However far it turns.
LoadCase damper_case(const std::string& what, int first)
{
    return {"rotational_damper", what,
            [=](Random& random) {
                const std::vector<Matrix34> X{world_configuration, world_configuration};
                return rotational_damper("l", first, first == 0 ? 1 : 0, 2 + random.number(), X);
            },
            [=](Random& random) {
                return std::array<Matrix34, 2>{random.rigid() + 0.1 * random.matrix<3, 4>(),
                                               first == world ? world_configuration
                                                              : random.rigid() + 0.1 * random.matrix<3, 4>()};
            }};
}

LoadCase attraction_case(const std::string& what, bool has_gradient)
{
    return {
        "attraction", what,
        [=](Random& random) {
            const Body body = rigid_body(
                "b", {2 + random.number(), random.vector(), {1.2, 0.1, 0, 0.1, 1.5, 0.2, 0, 0.2, 1.1}});
            const std::vector<Matrix34> X{world_configuration};
            return attraction("l", 0, body, {{9, 0, 1}, 3 + random.number(), has_gradient}, X);
        },
        [](Random& random) {
            return std::array<Matrix34, 2>{random.rigid() + 0.1 * random.matrix<3, 4>(), world_configuration};
        }};
}

Load any_drag(Random& random)
{
    const std::vector<Matrix34> X{world_configuration};
    return drag("l", 0, random.vector(), {2 + random.number(), 1.5 + random.number(), 3 * random.vector()},
                X);
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
        traction_case("traction", Frame::inertial, varying),
        traction_case("traction in body axes", Frame::body_fixed, varying),
        pressure_case("pressure", steady),
        pressure_case("pressure that varies", varying),
        linear_traction_case("traction linear in the place", Frame::inertial),
        linear_traction_case("traction linear in the place, in body axes", Frame::body_fixed),
        linear_pressure_case("pressure linear in the place", steady),
        linear_pressure_case("pressure linear in the place that varies", varying),
        body_force_case("force per unit mass", Frame::inertial, varying),
        body_force_case("force per unit mass in body axes", Frame::body_fixed, steady),
        torque_case("torque", Frame::inertial, steady),
        torque_case("torque that varies", Frame::inertial, varying),
        torque_case("torque in body axes", Frame::body_fixed, varying),
        torque_case("couple", Frame::inertial, varying, 1),
        torque_case("couple about axes of a body", Frame::body_fixed, varying, 1),
        spring_case("spring and damper", 1, [](SpringDamper&) {}),
        spring_case("spring and damper on the world", world, [](SpringDamper&) {}),
        spring_case("spring", 1, [](SpringDamper& law) { law.damping = 0; }),
        spring_case("spring without free length", 1,
                    [](SpringDamper& law) { law.damping = law.free_length = 0; }),
        spring_case("damper", 1, [](SpringDamper& law) { law.stiffness = 0; }),
        rope_case("rope over two bodies", {0, 1, 1, 0}, [](SpringDamper&) {}),
        rope_case("rope over a body and the world", {world, 0, world},
                  [](SpringDamper& law) { law.preload = 2; }),
        rope_case("rope over three bodies and the world", {0, world, 1, 2, 1, 0}, [](SpringDamper&) {}),
        rope_case("rope without a damper", {0, 1, 2, 3, 0}, [](SpringDamper& law) { law.damping = 0; }),
        rope_case("rope by a law", {0, 1, world, 2},
                  [](SpringDamper& law) { law.law = progressive_spring(0.3, 1e-5); }),
        along_case("joint_spring", "spring along a slide", 1, "displacement", any_joint_spring),
        along_case("joint_spring", "spring along a slide of the world", world, "displacement",
                   any_joint_spring),
        along_case("joint_spring", "spring about an axis", 1, "angle", any_joint_spring),
        along_case("joint_spring", "damper about an axis", 1, "angle", any_joint_damper),
        along_case("joint_spring", "limits of an angle", 1, "angle", limited_joint),
        along_case("joint_spring", "limits of a slide on the world", world, "displacement", limited_joint),
        turning_case("joint_spring", "spring of a cross", 1, false, "angle_1", any_joint_spring),
        turning_case("joint_spring", "spring of a cross on the world", world, false, "angle_2",
                     any_joint_spring),
        turning_case("joint_spring", "limits of a cross", 1, false, "angle_2", limited_joint),
        turning_case("joint_spring", "spring of a ball, outer angle", 1, true, "angle_1", any_joint_spring),
        turning_case("joint_spring", "spring of a ball, middle angle", 1, true, "angle_2", any_joint_spring),
        turning_case("joint_spring", "damper of a ball on the world", world, true, "angle_2",
                     any_joint_damper),
        turning_case("joint_spring", "spring of a ball on the world", world, true, "angle_3",
                     any_joint_spring),
        turning_case("joint_spring", "spring along a rotation vector", 1, true, "rotation_vector_y",
                     any_joint_spring),
        turning_case("joint_spring", "spring along the angle of a rotation", 1, true, "rotation_angle",
                     any_joint_spring),
        turning_case("joint_spring", "limit of a ball on the world", world, true, "rotation_angle",
                     limited_joint),
        turning_case("bushing", "spring against all turns of a ball", 1, true, "angle_1", any_ball_spring),
        turning_case("actuator", "motor of a cross", 1, false, "angle_1", any_actuator),
        turning_case("actuator", "motor of a ball", 1, true, "angle_2", any_actuator),
        along_case("actuator", "motor", 1, "angle", any_actuator),
        along_case("actuator", "motor on the world", world, "angle", any_actuator),
        along_case("actuator", "cylinder", 1, "displacement", any_actuator),
        along_case("actuator", "formula about an axis", 1, "angle", any_formula),
        along_case("actuator", "formula on a tape", 1, "angle", recorded_formula),
        along_case("actuator", "formula along an axis of the world", world, "displacement", any_formula),
        along_case("joint_spring", "progressive or tabulated spring", 1, "angle", bent_joint_spring),
        spring_case("progressive spring and preload", 1,
                    [](SpringDamper& law) {
                        law.law = progressive_spring(law.stiffness, 2);
                        law.preload = -0.7;
                    }),
        spring_case("tabulated spring", world,
                    [](SpringDamper& law) {
                        law.law = tabulated_spring({-9, -4, 12, 20}, {-4, -1, 2, 20}, true);
                    }),
        bushing_case("bushing", 1, 1.5),
        bushing_case("bushing on the world", world, 2.5),
        bushing_case("bushing that hardly turns", 1, 0.02),
        bushing_case("bushing damped by angular velocity", 1, 1.5, true),
        bushing_case("bushing on the world damped by angular velocity", world, 2.5, true),
        damper_case("rotational damper", 0),
        damper_case("rotational damper, bodies exchanged", 1),
        damper_case("rotational damper on the world", world),
        {"drag", "drag", any_drag},
        {"force", "force by a third body", formula_of_a_third},
        {"force", "function", any_function},
        attraction_case("attraction", false),
        attraction_case("attraction with a gradient", true),
        spring_case("nothing", 1, [](SpringDamper& law) { law = {}; }),
    };
    return cases;
}

}   // namespace livens
