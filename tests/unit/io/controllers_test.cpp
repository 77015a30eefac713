// SPDX-License-Identifier: BSD-3-Clause
// Controllers: states against references that share no code, orders, rest, samples, and what is refused.
#include <array>
#include <cmath>
#include <functional>

#include "livens/diagnostics/diagnostics.h"
#include "livens/io/known_state.h"
#include "livens/multibody/controllers.h"
#include "livens/spacetime/solve.h"
#include "livens/statics/equilibrium.h"
#include "unit/io/swinging_rod.h"

namespace livens::controllers_test {

namespace {

using test::read;
using test::scenario_of;
using test::shown;

/// A pendulum of 2 kg, 0.16 + 0.02 kg m^2 x 2 about its pin, with what is said of its controller.
std::string pendulum(const std::string& controller, const std::string& time, const std::string& torque)
{
    return test::hanging_arm(R"([[controller]]
name = "pid"
)" + controller +
                             R"(
[[load]]
name = "drive"
type = "actuator"
joint = "pin"
expression = ")" + torque + "\"\n\n[time]\n" +
                             time + "\n");
}

/// PID with a filter, and a motor with its current: 60, 40, 8; 2 Ohm, 0.4 V s/rad.
std::string with_motor(double inductance, const std::string& time, const std::string& filter = "0.02")
{
    return pendulum("inputs = { q = \"pin.angle\", w = \"pin.angle_rate\" }\n"
                    "states = { i = \"0.5 - q\", d = \"((0.5 - q) - d)/" +
                        filter + "\", c = \"(u - 2*c - 0.4*w)/" + std::to_string(inductance) +
                        "\" }\noutputs = { u = \"60*(0.5 - q) + 40*i + 8*((0.5 - q) - d)/" + filter +
                        "\" }\n",
                    time, "0.4*pid.c");
}

using Numbers = std::array<double, 5>;   // q, q', i, d, c

/// Of that pendulum, whose motor has 0.05 H: angle, rate and states at 2 s by Dormand and Prince's 8(5,3),
/// with tolerances of 1e-13.
constexpr Numbers at_2_s{0.416244215716469, -0.0199781038903, 0.265993022070594, 0.0834517580457937,
                         7.80900567157475};
/// With 0.2 H and a filter of 0.1 s, at 1 s.
constexpr Numbers slower_at_1_s{0.266619641650648, 5.44328193784637, 0.243532368745726, 0.501738338899615,
                                17.5861542535732};

/// The numbers of a motion at its end.
Numbers at_end(const SolvedScenario& s, const Model& model)
{
    const Motion& motion = s.solution.motion;
    const State state = motion.at_end(motion.n_elements());
    const JointCoordinate& q = model.joints()[0].coordinates[0].coordinate;
    const std::vector<NamedState> z = states_in(model, state.V);
    return {coordinate_value(q, state.X), coordinate_rate(q, state.X, state.V), z[0].value, z[1].value,
            z[2].value};
}

double distance(const Numbers& a, const Numbers& b)
{
    double far = 0;
    for (std::size_t i = 0; i < a.size(); ++i) far = std::max(far, std::abs(a[i] - b[i]));
    return far;
}

class OrdersOfStates : public testing::TestWithParam<int> {};
std::string degree_of(const testing::TestParamInfo<int>& degree)
{
    return "p" + std::to_string(degree.param);
}

TEST_P(OrdersOfStates, AreThoseOfMotions)
{
    const int p = GetParam();
    // Where errors are not yet rounding, and no longer those of elements that are too long.
    const int first = std::array{0, 400, 100, 40, 20, 12, 8}[static_cast<std::size_t>(p)];
    double before = 0;
    for (const int n : {first, 2 * first}) {
        const std::string text =
            with_motor(0.2,
                       "end = 1\nelements = " + std::to_string(n) +
                           "\n[method]\nfamily = \"lobatto\"\ndegree = " + std::to_string(p),
                       "0.1");
        const Scenario scenario = scenario_of(text);
        const SolvedScenario s = solve_scenario(scenario, scenario.options, scenario.prepared);
        ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
        const double error = distance(at_end(s, scenario.model), slower_at_1_s);
        if (before > 0) {
            EXPECT_GT(std::log2(before / error), 2 * p - 0.3) << before << " " << error;
        }
        before = error;
    }
}
INSTANTIATE_TEST_SUITE_P(Degrees, OrdersOfStates, testing::Range(1, 7), degree_of);

TEST(Controllers, HaveTheAccuracyThatIsAskedFor)
{
    const Scenario scenario = scenario_of(with_motor(0.05, "end = 2\naccuracy = 1e-12"));
    const SolvedScenario s = solve_scenario(scenario, scenario.options, scenario.prepared);
    ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
    EXPECT_LT(distance(at_end(s, scenario.model), at_2_s), 2e-12);
    // Energy and momenta know nothing of states.
    const Balance all = balance(scenario.model, s.solution.motion);
    EXPECT_LT(all.relative_energy_drift(), 1e-11);
    EXPECT_LT(all.relative_linear_momentum_drift(), 1e-11);
    const State last = s.solution.motion.at_end(s.solution.motion.n_elements());
    const Matrix34 own = last.V[0] * scenario.model.bodies()[0].mass;
    EXPECT_EQ(all.linear_momentum.back(), own.column(0));
    EXPECT_EQ(all.kinetic.back(), 0.5 * dot(own, last.V[0]));
}

/// With an inductance of 1e-6 H its current follows within a microsecond: i = (u - 0.4 w)/2 but for 1e-6 of
/// it.
TEST(Controllers, ThatAreStiffAreLeftToRadau)
{
    const Scenario scenario = scenario_of(with_motor(1e-6, "end = 2\naccuracy = 1e-10"));
    const SolvedScenario s = solve_scenario(scenario, scenario.options, scenario.prepared);
    ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
    EXPECT_TRUE(std::holds_alternative<Radau>(s.solution.method));
    EXPECT_LT(s.solution.motion.n_elements(), 400);
    // By Radau's fifth-order method with tolerances of 3e-13.
    const Numbers truth{0.413562775931, 0.03696141743597, 0.2649731605883, 0.0872603425227, 7.720563210883};
    EXPECT_LT(distance(at_end(s, scenario.model), truth), 1e-9);
}

/// What is sampled is a recursion between motions, which are solved without livens to its rounding here.
TEST(Controllers, ThatAreSampledAreTheirRecursion)
{
    const std::string sampled = "inputs = { q = \"pin.angle\" }\nevery = \"10 ms\"\n"
                                "states = { i = \"i + 0.01*(0.5 - q)\", e = \"0.5 - q\" }\n"
                                "outputs = { u = \"20*(0.5 - q) + 15*i + 3*((0.5 - q) - e)/0.01\" }\n"
                                "start = { e = 0.5 }\n";
    const Scenario scenario = scenario_of(pendulum(sampled, "end = 2\naccuracy = 1e-10", "pid.u"));
    const SolvedScenario s = solve_scenario(scenario, scenario.options, scenario.prepared);
    ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
    const Motion& motion = s.solution.motion;
    // 200 intervals by Dormand and Prince's 8(5,3) with tolerances of 1e-13, and the recursion between them.
    const std::vector<NamedState> z = states_in(scenario.model, motion.at_end(motion.n_elements()).V);
    EXPECT_NEAR(coordinate_value(scenario.model.joints()[0].coordinates[0].coordinate,
                                 motion.at_end(motion.n_elements()).X),
                0.462283234829552, 1e-12);
    EXPECT_NEAR(z[0].value, 0.187571949391334, 1e-13);
    EXPECT_NEAR(z[1].value, 0.0377167651704476, 1e-12);
    EXPECT_NEAR(z[2].value, 3.49502253169681, 1e-9);
    // Its own recursion, of its own angles: to rounding.
    double i = 0, e = 0.5, farthest = 0;
    for (int k = 0; k <= 200; ++k) {
        const State state = motion.at(0.01 * k);
        const double q = coordinate_value(scenario.model.joints()[0].coordinates[0].coordinate, state.X);
        const double u = 20 * (0.5 - q) + 15 * i + 3 * ((0.5 - q) - e) / 0.01;
        i += 0.01 * (0.5 - q);
        e = 0.5 - q;
        const std::vector<NamedState> now = states_in(scenario.model, state.V);
        farthest = std::max({farthest, std::abs(now[0].value - i), std::abs(now[1].value - e),
                             std::abs(now[2].value - u) / 100});
    }
    EXPECT_LT(farthest, 1e-13);
    // What is held does not change between samples, and is what it was on the left side of one.
    const State between = motion.at(0.0149);
    EXPECT_NEAR(states_in(scenario.model, between.V)[2].value,
                states_in(scenario.model, motion.at(0.01).V)[2].value, 1e-11);
    const int end = element_end_at(motion.mesh, 0.02);
    ASSERT_GE(end, 0);
    EXPECT_NEAR(states_in(scenario.model, motion.at_end(end, Side::left).V)[2].value,
                states_in(scenario.model, motion.at(0.01).V)[2].value, 1e-11);
}

/// 33 times 0.01 s is not 11 times 0.03 s, nor 3 times 0.1 s what is written as 0.3: instants that rounding
/// alone keeps apart are one, at which each controller is asked once.
TEST(Controllers, ThatAreSampledTogetherAreAskedOnceAtAnInstant)
{
    const std::string two = "inputs = { q = \"pin.angle\" }\nevery = 0.03\n"
                            "states = { i = \"i + 0.03*(0.5 - q)\" }\noutputs = { u = \"15*i\" }\n"
                            "[[controller]]\nname = \"fast\"\ninputs = { q = \"pin.angle\", r = \"pid.u\" }\n"
                            "every = 0.01\nstates = { n = \"n + 1\" }\n"
                            "outputs = { u = \"20*(0.5 - q) + r\" }\n";
    for (const std::string time : {"end = 1\naccuracy = 1e-9", "end = 1\nelements = 130"}) {
        const Scenario scenario = scenario_of(pendulum(two, time, "fast.u"));
        const SolvedScenario s = solve_scenario(scenario, scenario.options, scenario.prepared);
        ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
        const Motion& motion = s.solution.motion;
        double i = 0, r = 0, farthest = 0;
        for (int k = 0; k <= 100; ++k) {
            const State state = motion.at(0.01 * k);
            const double q = coordinate_value(scenario.model.joints()[0].coordinates[0].coordinate, state.X);
            if (k % 3 == 0) {
                r = 15 * i;
                i += 0.03 * (0.5 - q);
            }
            const double expected[] = {i, r, 1.0 + k, 20 * (0.5 - q) + r};
            const std::vector<NamedState> now = states_in(scenario.model, state.V);
            ASSERT_EQ(now.size(), 4u);
            for (std::size_t j = 0; j < 4; ++j)
                farthest = std::max(farthest, std::abs(now[j].value - expected[j]) / 100);
        }
        EXPECT_LT(farthest, 1e-12) << time;
    }
}

/// What ends at 0.3 s, beside samples every 0.1 s.
TEST(Controllers, ThatAreSampledMayMeetWhatEnds)
{
    const auto angle_at_end = [](const std::string& until, const std::string& family) {
        const std::string sampled =
            "inputs = { q = \"pin.angle\" }\nevery = 0.1\noutputs = { u = \"5*(0.5 - q)\" }\n";
        const Scenario scenario =
            scenario_of(pendulum(sampled, "end = 1\naccuracy = 1e-9\n[method]\nfamily = \"" + family + "\"",
                                 "pid.u\"\nuntil = \"" + until));
        const SolvedScenario s = solve_scenario(scenario, scenario.options, scenario.prepared);
        EXPECT_TRUE(s.solution.report.converged()) << s.solution.report.message;
        const State state = s.solution.motion.at_end(s.solution.motion.n_elements());
        return coordinate_value(scenario.model.joints()[0].coordinates[0].coordinate, state.X);
    };
    for (const std::string family : {"lobatto", "radau"}) {
        const double at_sample = angle_at_end("0.3 s", family);
        EXPECT_NEAR(at_sample, angle_at_end("0.30000001 s", family), 1e-6);
        EXPECT_GT(std::abs(at_sample - angle_at_end("0.31 s", family)),
                  1e-3);   // the control: it does matter
    }
}

/// An integral at rest leaves no error: q = 0.5 and 40 i = 2 c = m g l sin(0.5)/0.4.
TEST(Controllers, AreAtRestWithTheirBodies)
{
    const Scenario scenario = scenario_of(with_motor(0.05, "end = 2"));
    const Equilibrium rest = find_equilibrium(scenario.model, scenario.model.start());
    ASSERT_TRUE(rest.is_found) << rest.message;
    const double current = 2 * 9.81 * 0.4 * std::sin(0.5) / 0.4;
    EXPECT_NEAR(rest.coordinates[0][0], 0.5, 1e-12);
    const std::vector<NamedState> z = states_in(scenario.model, rest.state.V);
    EXPECT_NEAR(z[0].value, 2 * current / 40, 1e-12);
    EXPECT_NEAR(z[1].value, 0, 1e-12);
    EXPECT_NEAR(z[2].value, current, 1e-11);
    // The state matrix of (q, q', i, d, c), by hand.
    const Linearisation linear = linearise(scenario.model, rest.state);
    ASSERT_EQ(linear.n, 1);
    const double inertia = 0.02 + 2 * 0.16, stiffness = 2 * 9.81 * 0.4 * std::cos(0.5);
    const StateMatrices matrices =
        state_matrices(scenario.model, linear, {"pin.angle"}, {"pin.angle", "pid.c"});
    ASSERT_EQ(matrices.n_states, 5);
    const auto trace = [&] {
        double sum = 0;
        for (std::size_t i = 0; i < 5; ++i) sum += matrices.A[6 * i];
        return sum;
    };
    EXPECT_NEAR(trace(), -1 / 0.02 - 2 / 0.05, 1e-9);
    // Its characteristic polynomial vanishes at each root.
    const auto residual = [&](std::complex<double> s) {
        const std::complex<double> controller =
                                       -60.0 - 40.0 / s - 8.0 / 0.02 * (1.0 - 1.0 / (1.0 + 0.02 * s)),
                                   c = (controller - 0.4 * s) / (0.05 * s + 2.0);
        return (inertia * s * s + stiffness - 0.4 * c) / (inertia * s * s + stiffness);
    };
    const std::vector<VibrationMode> modes = vibration_modes(linear);
    int n_roots = 0;
    for (const VibrationMode& mode : modes) {
        n_roots += mode.s.imag() > 0 ? 2 : 1;
        EXPECT_LT(std::abs(residual(mode.s)), 1e-9) << mode.s;
    }
    EXPECT_EQ(n_roots, 5);
    int n_unstable = 0;
    for (const VibrationMode& mode : modes) n_unstable += mode.s.real() > 0 ? (mode.s.imag() > 0 ? 2 : 1) : 0;
    EXPECT_EQ(rest.stability.n_unstable, n_unstable);
    EXPECT_EQ(rest.stability.n_neutral, 0);
}

/// The same within a part that is turned, displaced and renamed.
TEST(Controllers, ComeAlongWithParts)
{
    const std::string alone = with_motor(0.05, "end = 0.5\naccuracy = 1e-10");
    const Scenario first = scenario_of(alone);
    Model whole({0, 0, -9.81});
    const Displacement by{{1, 2, 3}, {0, 1, 0, -1, 0, 0, 0, 0, 1}};
    whole.add(first.model, "left_", by);
    whole.add(first.model, "right_");
    const Solution one = solve(first.model, {first.model.start()}, first.time, first.method, first.options),
                   both = solve(whole, {whole.start()}, first.time, first.method, first.options);
    ASSERT_TRUE(one.report.converged() && both.report.converged()) << both.report.message;
    const std::vector<NamedState> a = states_in(first.model, one.motion.at_end(one.motion.n_elements()).V),
                                  b = states_in(whole, both.motion.at_end(both.motion.n_elements()).V);
    ASSERT_EQ(b.size(), 2 * a.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
        EXPECT_NEAR(b[k].value, a[k].value, 1e-8 * std::max(1.0, std::abs(a[k].value)));
        EXPECT_NEAR(b[k + a.size()].value, a[k].value, 1e-8 * std::max(1.0, std::abs(a[k].value)));
    }
    EXPECT_EQ(b[0].name, "left_pid.i");
}

/// An event empties an integral once it is full: a saw tooth with known teeth.
TEST(Controllers, AreSetByEvents)
{
    const Scenario scenario =
        scenario_of(pendulum("states = { i = \"2\" }\n",
                             "end = 1\naccuracy = 1e-10\n[[event]]\nname = \"full\"\nwhen = "
                             "\"pid.i > 0.3\"\nset = { \"pid.i\" = \"pid.i - 0.3\" }",
                             "pid.i"));
    const SolvedScenario s = solve_scenario(scenario, scenario.options, scenario.prepared);
    ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
    ASSERT_EQ(s.solution.events.size(), 6u);
    for (int k = 0; k < 6; ++k)
        EXPECT_NEAR(s.solution.events[static_cast<std::size_t>(k)].t, 0.15 * (k + 1), 1e-12);
    const Motion& motion = s.solution.motion;
    EXPECT_NEAR(states_in(scenario.model, motion.at_end(motion.n_elements()).V)[0].value, 0.2, 1e-11);
}

TEST(Controllers, AreRefusedByName)
{
    const auto code = [](const std::string& controller, const std::string& torque = "pid.u") {
        const ScenarioResult result = read(pendulum(controller, "end = 1", torque));
        return result.diagnostics.empty() ? std::string("none") : result.diagnostics[0].code;
    };
    const std::string states = "inputs = { q = \"pin.angle\" }\nstates = { i = \"0.5 - q\" }\n",
                      good = states + "outputs = { u = \"3*i\" }\n";
    EXPECT_EQ(code(good), "none");
    EXPECT_EQ(code("outputs = { u = \"3\" }\n"), "controller-states");
    EXPECT_EQ(code(good, "pid.v"), "input-unknown");
    EXPECT_EQ(code(states + "outputs = { u = \"3*v\", v = \"i\" }\n"), "expression-name");
    EXPECT_EQ(code(states + "outputs = { i = \"3\" }\n"), "controller-name");
    EXPECT_EQ(code(good + "start = { j = 1 }\n"), "controller-name");
    EXPECT_EQ(code(good + "size = { i = 0 }\n"), "controller-size");
    EXPECT_EQ(code(good + "every = -1\n"), "controller-every");
    EXPECT_EQ(code(good + "first = 1\n"), "controller-every");
    EXPECT_EQ(code("inputs = { q = \"pin.length\" }\nstates = { i = \"q\" }\n", "pid.i"), "joint-coordinate");
    EXPECT_EQ(
        code("inputs = { q = \"pin.angle\", w = \"pin.angle_rate\" }\nstates = { i = \"q\" }\n", "pid.i"),
        "input-unused");
}

/// What is given elsewhere would be taken for places of what holds states.
TEST(Controllers, AreSolvedFromTheStart)
{
    const std::string controller = "states = { i = \"1 - i\" }\n";
    for (const char* how : {"end = 1\nelements = 20\nperiodic = true\n",
                            "end = 1\nelements = 20\n[end.known]\n\"pin.angle\" = 0.3\n"}) {
        const ScenarioResult result = read(pendulum(controller, how, "pid.i"));
        ASSERT_FALSE(result.diagnostics.empty()) << how;
        EXPECT_EQ(result.diagnostics[0].code, "controller-ends") << how << shown(result);
    }
    const Scenario scenario = scenario_of(pendulum(controller, "end = 1", "pid.i"));
    Problem problem{{scenario.model.start()}};
    problem.conditions.at_start = Known::nothing;
    problem.conditions.at_end = Known::state;
    problem.conditions.end = scenario.model.start();
    EXPECT_THROW(solve(scenario.model, problem, scenario.time, scenario.method, scenario.options),
                 InputError);
}

TEST(Controllers, ThatAreSampledHaveNoRest)
{
    const Scenario scenario = scenario_of(pendulum(
        "inputs = { q = \"pin.angle\" }\nevery = 0.1\nstates = { i = \"i + q\" }\n", "end = 1", "pid.i"));
    // Also as the program asks, of what acts at the start.
    for (const Model& model : {scenario.model, as_it_starts(scenario).model}) {
        try {
            find_equilibrium(model, model.start());
            ADD_FAILURE();
        } catch (const InputError& error) {
            EXPECT_EQ(error.complaint().code, "controller-sampled");
        }
    }
}

}   // namespace

}   // namespace livens::controllers_test
