// SPDX-License-Identifier: BSD-3-Clause
// Loads that joints state themselves: what arrives, and how far a motion is from one that was integrated by
// hand.
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "livens/diagnostics/sample.h"
#include "livens/io/solve_scenario.h"
#include "unit/io/scenario_text.h"

namespace livens::joint_loads_test {

namespace {

using test::find;
using test::read;
using test::shown;

/// A body that a joint holds, and what stands behind the joint.
std::string held(const std::string& type, const std::string& keys, const std::string& more = "")
{
    return "format = 1\ngravity = [0, 0, -9.81]\n[[body]]\nname = \"b\"\nmass = 2\ninertia = [0.5, 0.6, "
           "0.7]\n"
           "center_of_mass = [0.3, 0, 0]\n[[joint]]\nname = \"j\"\nbetween = [\"world\", \"b\"]\ntype = \"" +
           type + "\"\nat = [0, 0, 0]\naxis = [0, -1, 0]\n" + keys + "\n" + more +
           "\n[time]\nend = 1\naccuracy = 1e-10\n";
}

Model model_of(const std::string& text)
{
    const ScenarioResult result = read(text);
    EXPECT_TRUE(result.scenario.has_value()) << shown(result);
    return result.scenario ? result.scenario->model : Model();
}

Motion motion_of(const std::string& text)
{
    const ScenarioResult result = read(text);
    if (!result.scenario) throw std::logic_error(shown(result));
    SolvedScenario solved = solve_scenario(*result.scenario, result.scenario->options, nullptr);
    EXPECT_TRUE(solved.solution.report.converged()) << solved.solution.report.message;
    return std::move(solved.solution.motion);
}

const std::string along = "damping = 0.5\nstiffness = \"3 N m/rad\"\nrest = \"20 deg\"";

TEST(JointLoads, AreTheSpringOnTheJointToTheBit)
{
    const Motion keys = motion_of(held("revolute", along)),
                 load =
                     motion_of(held("revolute", "", "[[load]]\ntype = \"spring\"\njoint = \"j\"\n" + along)),
                 free = motion_of(held("revolute", ""));
    ASSERT_EQ(keys.X.values, load.X.values);
    EXPECT_NE(keys.X.values, free.X.values) << "negative control";
}

TEST(JointLoads, AreNamedAfterTheJointAndAfterTheCoordinateWhereThereAreTwo)
{
    const std::vector<Load> one = model_of(held("planar", "damping = 1")).loads();
    ASSERT_EQ(one.size(), 1u);
    EXPECT_EQ(one[0].name, "j");
    EXPECT_EQ(one[0].readings[0].name, "effort");
    const std::vector<Load> two =
        model_of(held("cylindrical",
                      "angle = { damping = 1 }\ndisplacement = { stiffness = 100, rest = \"1 cm\" }"))
            .loads();
    ASSERT_EQ(two.size(), 2u);
    EXPECT_EQ(two[0].name, "j angle");
    EXPECT_EQ(two[0].readings[0].unit, "N m");
    EXPECT_EQ(two[1].name, "j displacement");
    EXPECT_EQ(two[1].readings[0].unit, "N");
    const Model model = model_of(held("cylindrical", "displacement = { stiffness = 100, rest = \"1 cm\" }"));
    const State at = model.start();
    EXPECT_NEAR(model.loads()[0].readings[0].value(load_arguments(model.loads()[0], {0}, at.X, at.V)), 1,
                1e-14);
    EXPECT_TRUE(model_of(held("revolute", "damping = 0\nstiffness = 0")).loads().empty()) << "nothing acts";
}

/// Angle and rate of the hinge above, by Runge and Kutta's rule of order 4, whatever its torque.
std::array<double, 2> by_hand(const std::function<double(double q, double w)>& torque, int n)
{
    constexpr double inertia = 0.6 + 2 * 0.3 * 0.3, weight = 2 * 9.81 * 0.3;
    const auto slope = [&](const std::array<double, 2>& y) {
        return std::array<double, 2>{y[1], (torque(y[0], y[1]) - weight * std::cos(y[0])) / inertia};
    };
    const auto moved = [](const std::array<double, 2>& y, double h, const std::array<double, 2>& k) {
        return std::array<double, 2>{y[0] + h * k[0], y[1] + h * k[1]};
    };
    std::array<double, 2> y{0, 0};
    const double h = 1.0 / n;
    for (int i = 0; i < n; ++i) {
        const auto k1 = slope(y), k2 = slope(moved(y, h / 2, k1)), k3 = slope(moved(y, h / 2, k2)),
                   k4 = slope(moved(y, h, k3));
        for (std::size_t c = 0; c < 2; ++c) y[c] += h / 6 * (k1[c] + 2 * k2[c] + 2 * k3[c] + k4[c]);
    }
    return y;
}

/// Of the last state, by the first director in the plane of the motion.
double angle_at_end(const Motion& motion)
{
    const Matrix34 X = sample_state(motion, 1).X[0];
    return std::atan2(X.column(1)[2], X.column(1)[0]);
}

TEST(JointLoads, MoveTheJointAsIntegratedByHand)
{
    const double rest = std::acos(-1.0) / 9;
    const auto torque = [&](double q, double w) { return -3 * (q - rest) - 0.5 * w; };
    EXPECT_NEAR(angle_at_end(motion_of(held("revolute", along))), by_hand(torque, 4000)[0], 1e-9);
}

/// A body that spins about its centre, on a ball: J w' = -w x J w - c w in its own axes, by the same rule.
TEST(JointLoads, SlowABallAsIntegratedByHand)
{
    const std::string text = "format = 1\n[[body]]\nname = \"b\"\nmass = 2\ninertia = [0.5, 0.6, "
                             "0.7]\nangular_velocity = [1, 4, -2]\n"
                             "[[joint]]\nname = \"j\"\nbetween = [\"world\", \"b\"]\ntype = "
                             "\"spherical\"\nat = [0, 0, 0]\ndamping = 0.4\n"
                             "[time]\nend = 1\naccuracy = 1e-10\n";
    const auto slope = [](const Vector3& w) {
        const Vector3 J{0.5, 0.6, 0.7}, L{J[0] * w[0], J[1] * w[1], J[2] * w[2]};
        const Vector3 torque = -1. * cross(w, L) - 0.4 * w;
        return Vector3{torque[0] / J[0], torque[1] / J[1], torque[2] / J[2]};
    };
    Vector3 w{1, 4, -2};
    constexpr double h = 1.0 / 4000;
    for (int i = 0; i < 4000; ++i) {
        const Vector3 k1 = slope(w), k2 = slope(w + h / 2 * k1), k3 = slope(w + h / 2 * k2),
                      k4 = slope(w + h * k3);
        w += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    const State end = sample_state(motion_of(text), 1);
    EXPECT_LT(norm(transpose(directors(end.X[0])) * angular_velocity(end.X[0], end.V[0]) - w), 1e-9);
}

/// It falls upon its lower limit, -0.4 rad, and bounces; k d (1 + c d') is none where it would pull.
TEST(JointLimits, BounceAsIntegratedByHand)
{
    for (const double damping : {0.0, 0.2}) {
        const auto torque = [&](double q, double w) {
            const double d = -0.4 - q;
            return d > 0 ? std::max(5000 * d * (1 - damping * w), 0.0) : 0;
        };
        const std::string keys =
            "limits = [-0.4, inf]\nlimit_stiffness = 5000\nlimit_damping = " + std::to_string(damping);
        EXPECT_NEAR(angle_at_end(motion_of(held("revolute", keys))), by_hand(torque, 1'000'000)[0], 1e-8)
            << damping;
    }
}

TEST(JointLimits, NeverPullAndStoreWhatTheyTake)
{
    const Model model =
        model_of(held("revolute", "limits = [\"-90 deg\", 1]\nlimit_stiffness = 100\nlimit_damping = 2"));
    const Load& load = model.loads()[0];
    const auto told = [&](double q, double w) {
        State at = model.start();
        at.X[0] = configuration({}, directors_from_rotation_vector({0, -q, 0}));
        at.V[0] = rate(at.X[0], {}, {0, -w, 0});
        const LoadArguments seen = load_arguments(load, {0}, at.X, at.V);
        return std::array{load.readings[0].value(seen), load.readings[1].value(seen), load.potential(seen),
                          power_without_potential(load, seen)};
    };
    const double low = -std::acos(-1.0) / 2;
    const auto expect = [&](double q, double w, const std::array<double, 4>& wanted) {
        const auto found = told(q, w);
        for (std::size_t i = 0; i < 4; ++i)
            EXPECT_NEAR(found[i], wanted[i], 1e-9) << q << ' ' << w << ' ' << i;
    };
    expect(0.9, 5, {0, 0, 0, 0});
    expect(1.1, 0, {-10, 0.1, 0.5, 0});
    expect(1.1, 0.25, {-15, 0.1, 0.5, -1.25});
    expect(1.1, -0.25, {-5, 0.1, 0.5, -1.25});
    expect(1.1, -3, {0, 0.1, 0.5, -30});   // it lags behind the joint: what it stored is lost
    expect(low - 0.1, -0.25, {15, 0.1, 0.5, -1.25});
    expect(low - 0.1, 3, {0, 0.1, 0.5, -30});
    // What rounding makes of a joint that stands there is no contact, or there would be contacts without end.
    EXPECT_EQ(told(1 + 5e-13, 0)[0], 0);
    EXPECT_LT(told(1 + 1e-11, 0)[0], 0);
}

TEST(JointLimits, HaveTheirSpringsFromTheBodies)
{
    // 0.6 + 2 * 0.3^2 about the axis; the length of the model is that of Model::length().
    const Model model = model_of(held("revolute", "limits = [-1, 1]\nlimit_law = \"penalty\""));
    const double T = std::sqrt(model.length() / 9.81), w = std::acos(-1.0) / (0.03 * T);
    State at = model.start();
    at.X[0] = configuration({}, directors_from_rotation_vector({0, -1.01, 0}));
    at.V[0] = rate(at.X[0], {}, {0, -0.5, 0});
    const Load& load = model.loads()[0];
    EXPECT_NEAR(load.readings[0].value(load_arguments(load, {0}, at.X, at.V)) / (0.78 * w * w),
                -0.01 * (1 + 0.5 * T), 1e-9);
    // Between two free bodies, a third welded to the second: about the common point, with their centres on
    // one line through it, T = 1/2 (J1 w1^2 + J2 w2^2 + m (l1 w1 + l2 w2)^2), m = m1 m2 / (m1 + m2).
    const auto chain = [](const std::string& keys) {
        return "format = 1\n[[body]]\nname = \"a\"\nmass = 2\ninertia = [2, 3, 2]\n[[body]]\nname = "
               "\"b\"\nmass = 1\n"
               "inertia = [1, 1, 1]\nposition = [1, 0, 0]\n[[body]]\nname = \"c\"\nmass = 1\ninertia = [1, "
               "1, 1]\n"
               "position = [2, 0, 0]\n[[joint]]\nname = \"j\"\ntype = \"revolute\"\nbetween = [\"a\", "
               "\"b\"]\n"
               "at = [1, 0, 0]\naxis = [0, 1, 0]\n" +
               keys +
               "\n[[joint]]\ntype = \"weld\"\nbetween = [\"c\", \"b\"]\n"
               "at = [1.5, 0, 0]\n[time]\nend = 1\nelements = 4\n";
    };
    const Model two = model_of(chain("limits = [-1, 1]\nlimit_law = \"penalty\""));
    const double m = 1, l1 = 1, l2 = 0.5, J1 = 3 + m * l1 * l1, J2 = 2.5 + m * l2 * l2, J12 = m * l1 * l2,
                 reduced = (J1 * J2 - J12 * J12) / (J1 + J2 + 2 * J12),
                 frequency = std::acos(-1.0) / (0.03 * 0.3);   // there is no gravity
    State bent = two.start();
    const Matrix3 R = directors_from_rotation_vector({0, 1.01, 0});
    bent.X[1] = configuration({1, 0, 0}, R);
    const Load& limit = two.loads()[0];
    EXPECT_NEAR(limit.readings[0].value(load_arguments(limit, {0}, bent.X, bent.V)),
                -0.01 * reduced * frequency * frequency, 1e-6);
}

TEST(JointLimits, AreToldWhereTheyAreReached)
{
    const auto notes = [](const std::string& limits) {
        const ScenarioResult result =
            read(held("revolute", "limits = " + limits + "\nlimit_stiffness = 5000\nlimit_damping = 0.3"));
        EXPECT_TRUE(result.scenario.has_value()) << shown(result);
        const Scenario& scenario = *result.scenario;
        const livens::Run run = judged_run(scenario, solve_scenario(scenario, scenario.options, nullptr), {});
        std::string all;
        for (const std::string& note : run.notes) all += note + "\n";
        return all;
    };
    const std::string reached = notes("[-0.4, inf]");
    EXPECT_EQ(notes("[\"-0.4 rad\", \"inf\"]"), notes("[-0.4, inf]"));
    EXPECT_NE(reached.find("'j' was beyond its limits by "), std::string::npos) << reached;
    EXPECT_NE(reached.find("5000 N m/rad and damping 0.3 s/rad"), std::string::npos) << reached;
    EXPECT_EQ(notes("[-4, 4]").find("limits"), std::string::npos);
}

}   // namespace
}   // namespace livens::joint_loads_test

namespace livens {

std::vector<test::Case> test::cases_of_joint_loads()
{
    using namespace joint_loads_test;
    const auto one = [](const std::string& keys) { return held("revolute", keys); };
    return {
        {"joint-loads", one("rest = 1"), "1\n\n[time]"},
        {"joint-loads", one("limit_damping = 1"), "1\n\n[time]"},
        {"joint-loads", one("damping = 1\nuntil = 0.5"), "[[joint]]"},
        {"joint-limits", one("limits = [1, -1]"), "[1, -1]"},
        {"joint-limits", one("limits = [0.5, 1]\nlimit_law = \"penalty\""), "[0.5, 1]"},
        {"stop-violated", one("limits = [0.5, 1]"), "\"j\""},
        {"joint-loads", one("limit_law = \"rigid\""), "\"rigid\""},
        {"joint-loads", one("limits = [-1, 1]\nlimit_law = \"rigid\"\nlimit_stiffness = 3"), "3\n\n[time]"},
        {"joint-loads", one("limits = [-1, 1]\nlimit_damping = 1\nlimit_restitution = 0.3"), "0.3\n\n[time]"},
        {"joint-loads", one("limits = [-1, 1]\nuntil = 0.5"), "[[joint]]"},
        {"out-of-range", one("limits = [-1, 1]\nlimit_restitution = 1.1"), "1.1\n\n[time]"},
        {"event-method", one("limits = [-1, 1]\n[method]\nfamily = \"midpoint\""), "\"j\""},
        {"event-method", one("limits = [-1, 1]\n[method]\nfamily = \"mixed\""), "\"j\""},
        {"name-duplicate",
         one("limits = [-1, 1]\n[[stop]]\nname = \"j.low\"\njoint = \"j\"\nlimits = [-2, inf]"), "\"j.low\""},
        {"joint-limits",
         one("limits = [-1, 1]\n[[body]]\nname = \"p\"\nmass = 0.1\nshape = { point = true }\nposition = [0, "
             "1, 0]\n"
             "[[joint]]\nname = \"k\"\ntype = \"point_on_line\"\nbetween = [\"world\", \"p\"]\nat = [0, 1, "
             "0]\n"
             "axis = [1, 0, 0]\nlimit_law = \"penalty\"\nlimits = [\"1 mm\", 1]"),
         "[\"1 mm\", 1]"},
        {"unit", one("damping = \"5 N s/m\""), "\"5 N s/m\""},
        {"not-finite", one("limits = [nan, 1]"), "nan"},
        {"out-of-range", one("limits = [-1, 1]\nlimit_stiffness = 0"), "0\n\n[time]"},
        {"misplaced-key", held("cylindrical", "damping = 1"), "damping"},
        {"rotor-inertia", one("rotor_inertia = 0.2\nuntil = 0.5"), "0.2"},
        {"rotor-method", one("rotor_inertia = 0.2\n[method]\nfamily = \"midpoint\""), "\"midpoint\""},
        {"out-of-range", one("rotor_inertia = -1"), "-1\n\n[time]"},
        {"name-duplicate",
         one("damping = 1\n[[load]]\nname = \"j\"\ntype = \"force\"\nbody = \"b\"\nvalue = [0, 0, 1]"),
         "\"j\"\ntype = \"force\""},
    };
}

}   // namespace livens
