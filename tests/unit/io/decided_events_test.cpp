// SPDX-License-Identifier: BSD-3-Clause
// What the motion decides: instants against closed forms, and what is refused.
#include <cmath>
#include <numbers>

#include "livens/spacetime/solve.h"
#include "unit/io/swinging_rod.h"

namespace livens::decided_events_test {

namespace {

using test::find;
using test::read;
using test::scenario_of;
using test::shown;
using test::solved;

/// Let go 0.5 rad from where it hangs.
std::string pendulum(const std::string& time, const std::string& more = "")
{
    return test::SwingingRod{-0.5}.text(time, more);
}

/// From rest at 0.5 rad to where it hangs.
double quarter_period() { return std::comp_ellint_1(std::sin(0.25)) / test::SwingingRod::frequency(); }

TEST(DecidedEvents, EndTheMotionWhereACoordinateIs)
{
    for (const char* how : {"accuracy = 1e-11", "elements = 40"}) {
        const SolvedScenario s = solved(pendulum(std::string("end = 5\nuntil = \"pin.angle > 0\"\n") + how));
        const Solution& solution = s.solution;
        ASSERT_TRUE(solution.report.converged()) << solution.report.message;
        ASSERT_EQ(solution.events.size(), 1u);
        const double error = std::abs(solution.events[0].t - quarter_period());
        EXPECT_LT(error, how[0] == 'a' ? 1e-12 : 1e-9) << how;
        EXPECT_EQ(solution.motion.end(), solution.events[0].t);
        EXPECT_NEAR(solution.events[0].error, error, 0.1 * error + 1e-13) << how;
        EXPECT_FALSE(solution.estimate.empty());
    }
}

/// Where its rate changes sign: the slope of the polynomial is of a lower order than the velocity at the end.
TEST(DecidedEvents, HaveTheOrderOfStatesAlsoWhereRatesAreAskedFor)
{
    double before = 0;
    for (const int n : {8, 16, 32}) {
        const SolvedScenario s =
            solved(pendulum("end = 2\nuntil = \"pin.angle_rate < 0\"\nelements = " + std::to_string(n),
                            "[method]\nfamily = \"lobatto\"\ndegree = 3\n"));
        ASSERT_EQ(s.solution.events.size(), 1u) << s.solution.report.message;
        const double error = std::abs(s.solution.events[0].t - 2 * quarter_period());
        if (before > 0) {
            EXPECT_LT(error, before / 30) << n;   // order 2p = 6
        }
        EXPECT_LT(error, 3 * s.solution.events[0].error + 1e-14) << n;
        EXPECT_LT(s.solution.events[0].error, 10 * error + 1e-14) << n;
        before = error;
    }
}

/// Of a mass on a rod that is let go near the top the rod's force changes from push to pull at cos = 2/3 +
/// v^2/(3 g R).
TEST(DecidedEvents, ReadReactions)
{
    const double v = 1, g = 9.81, cosine = 2.0 / 3 + v * v / (3 * g);
    const SolvedScenario s = solved(R"(format = 1
gravity = [0, 0, -9.81]
body = [{ name = "ball", shape = { point = true }, mass = 3, position = [0, 0, 1], velocity = [1, 0, 0] }]

[[joint]]
name = "rod"
type = "rod"
points = [[0, 0, 0], [0, 0, 0]]
between = ["world", "ball"]

[time]
end = 5
accuracy = 1e-11
until = "rod.force_z < 0"
)");
    ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
    ASSERT_EQ(s.solution.events.size(), 1u);
    const Motion& motion = s.solution.motion;
    EXPECT_NEAR(motion.at_end(motion.n_elements()).X[0](2, 0), cosine, 1e-11);
}

/// The same on stated elements, wherever the zero lies among them: reactions are of velocities, and those of
/// polynomials and of states differ at element ends.
TEST(DecidedEvents, AreFoundWhereReactionsChangeTheirSignInTheJump)
{
    for (const int n : {20, 40, 49, 50, 51, 60, 80}) {
        const SolvedScenario s = solved(R"(format = 1
gravity = [0, 0, -9.81]
body = [{ name = "ball", shape = { point = true }, mass = 3, position = [0, 0, 1], velocity = [1, 0, 0] }]

[[joint]]
name = "rod"
type = "rod"
points = [[0, 0, 0], [0, 0, 0]]
between = ["world", "ball"]

[time]
end = 5
until = "rod.force_z < 0"
elements = )" + std::to_string(n));
        const Motion& motion = s.solution.motion;
        ASSERT_EQ(s.solution.events.size(), 1u) << n;
        EXPECT_NEAR(motion.at_end(motion.n_elements()).X[0](2, 0), 2.0 / 3 + 1 / (3 * 9.81), 1e-7) << n;
    }
}

std::string door(const std::string& latch, const std::string& until, const std::string& time)
{
    return R"(format = 1
gravity = [0, 0, -9.81]
body = [{ name = "door", shape = { box = [1, 0.04, 2] }, mass = 20, position = [0.5, 0, 0] }]

[[joint]]
name = "hinge"
type = "revolute"
between = ["world", "door"]
at = [0, 0, 0]
axis = [0, 0, 1]

[[joint]]
name = "latch"
type = "point_in_plane"
between = ["world", "door"]
at = [1, 0, 0]
axis = [0, 1, 0]
)" + latch +
           R"(
[[load]]
name = "push"
type = "actuator"
joint = "hinge"
expression = "100*t"
)" + until +
           R"(
[time]
end = 2
accuracy = 1e-10
)" + time + "\n";
}

/// A latch at 1 m carries 100 t N, opens at 80 N, and from then on the door turns by a torque of 100 t N m.
TEST(DecidedEvents, ReleaseAJointByItsOwnReaction)
{
    const SolvedScenario s =
        solved(door("until = \"latch.force > 80 N\"", "", "until = \"hinge.angle > 30 deg\""));
    const Solution& solution = s.solution;
    ASSERT_TRUE(solution.report.converged()) << solution.report.message;
    ASSERT_EQ(solution.events.size(), 2u);
    EXPECT_NEAR(solution.events[0].t, 0.8, 1e-13);
    const double inertia = 20 * ((1 + 0.04 * 0.04) / 12 + 0.25), t = solution.events[1].t;
    const double turned = 100 / inertia * (t * t * t / 6 - 0.8 * 0.8 * t / 2 + 0.8 * 0.8 * 0.8 / 3);
    EXPECT_NEAR(turned, std::numbers::pi / 6, 1e-11);
    ASSERT_NE(solution.decided, nullptr);
    EXPECT_TRUE(solution.decided->joints()[1].acts_at(0.79));
    EXPECT_FALSE(solution.decided->joints()[1].acts_at(0.81));
    // a model that is decided anew from what was told is the same
    const Model again = decided_model(s.found->model, 0, solution.events);
    EXPECT_FALSE(again.joints()[1].acts_at(0.81));
}

TEST(DecidedEvents, EndLoadsAndTakeWhatActsTogether)
{
    // the latch holds until 0.8 s, when two things happen at once
    const SolvedScenario s =
        solved(door("until = \"latch.force > 80 N\"", "until = \"latch.force > 80 N\"",
                    "[[event]]\nname = \"both\"\nwhen = \"latch.force > 40 and t > 0.6\""));
    const Solution& solution = s.solution;
    ASSERT_TRUE(solution.report.converged()) << solution.report.message;
    ASSERT_EQ(solution.events.size(), 3u);
    EXPECT_NEAR(solution.events[0].t, 0.6, 1e-13);   // the later of both terms
    EXPECT_NEAR(solution.events[1].t, 0.8, 1e-13);
    EXPECT_EQ(solution.events[1].t, solution.events[2].t);
    const State end = solution.motion.at_end(solution.motion.n_elements());
    EXPECT_NEAR(end.V[0](1, 0), 0, 1e-14);   // nothing pushes the door any more
}

/// What an error of an instant does later is told: a torque begins where the rod hangs, and ends where it
/// turns back.
TEST(DecidedEvents, TellErrorsByInstantsOfTheirOwn)
{
    const std::string text = pendulum("end = 1.2\nelements = 9\n", R"([[load]]
name = "kick"
type = "actuator"
joint = "pin"
value = 6
from = "pin.angle > 0"
until = "pin.angle_rate < 0"

[method]
family = "lobatto"
degree = 2
)");
    std::string fine = text;
    fine.replace(fine.find("elements = 9"), 12, "accuracy = 1e-12");
    fine.erase(fine.find("degree = 2"), 10);
    const SolvedScenario coarse = solved(text), truth = solved(fine);
    ASSERT_TRUE(coarse.solution.report.converged()) << coarse.solution.report.message;
    ASSERT_TRUE(truth.solution.report.converged()) << truth.solution.report.message;
    ASSERT_EQ(coarse.solution.events.size(), truth.solution.events.size());
    ASSERT_GE(coarse.solution.events.size(), 1u);
    const Motion &a = coarse.solution.motion, &b = truth.solution.motion;
    const double error =
        norm(a.at_end(a.n_elements()).X[0].column(0) - b.at_end(b.n_elements()).X[0].column(0)) /
        coarse.solution.estimate.length;
    const double told = coarse.solution.estimate.position.back();
    EXPECT_GT(told, 0.5 * error);
    EXPECT_LT(told, 3 * error);
}

/// Two links that are let go where they lie, and a condition that comes true on the way.
std::string two_links(const std::string& time)
{
    std::string text = "gravity = [0, 0, -9.81]\n";
    for (const char* n : {"0", "1"}) {
        const std::string at = n[0] == '0' ? "0" : "0.5", center = n[0] == '0' ? "0.25" : "0.75",
                          before = n[0] == '0' ? "world" : "b0";
        text += std::string("[[body]]\nname = \"b") + n +
                "\"\nshape = { box = [0.5, 0.1, 0.1] }\nmass = 1\nposition = [" + center +
                ", 0, 0]\n[[joint]]\nname = \"j" + n + "\"\ntype = \"revolute\"\nbetween = [\"" + before +
                "\", \"b" + n + "\"]\nat = [" + at + ", 0, 0]\naxis = [0, 1, 0]\n";
    }
    return "format = 1\n" + text + "[[event]]\nname = \"low\"\nwhen = \"j0.angle > 0.5\"\n[time]\n" + time;
}

/// Where the whole is as accurate as it should be phases have none of their own, whose work counts beside the
/// motion's; else they begin anew.
TEST(DecidedEvents, HaveOneSecondSolutionWhereItIsEnough)
{
    const SolvedScenario once = solved(two_links("end = 2\naccuracy = 1e-7\n")),
                         truth = solved(two_links("end = 2\naccuracy = 1e-11\n"));
    ASSERT_TRUE(once.solution.report.converged()) << once.solution.report.message;
    ASSERT_TRUE(truth.solution.report.converged()) << truth.solution.report.message;
    EXPECT_EQ(once.solution.report.evaluations_in_all, once.solution.report.evaluations);
    EXPECT_GT(3 * truth.solution.report.evaluations_in_all, 4 * truth.solution.report.evaluations);
    const Motion &a = once.solution.motion, &b = truth.solution.motion;
    const Vector3 apart = a.at_end(a.n_elements()).X[1].column(0) - b.at_end(b.n_elements()).X[1].column(0);
    const double error = norm(apart) / once.solution.estimate.length;
    EXPECT_LE(once.solution.estimate.largest, 1e-7);
    EXPECT_GT(once.solution.estimate.position.back(), 0.3 * error);

    // errors grow by thousands
    const SolvedScenario again = solved(two_links("end = 4\naccuracy = 1e-5\n"));
    ASSERT_TRUE(again.solution.report.converged()) << again.solution.report.message;
    EXPECT_GT(again.solution.report.evaluations_in_all, 2 * again.solution.report.evaluations);
    EXPECT_LE(again.solution.estimate.largest, 1e-5);
}

/// A slide that a weld catches where it stands as stated: until then its start is not held by the weld.
TEST(DecidedEvents, JointsThatDoNotActYetLeaveTheStartFree)
{
    const auto text = [](const std::string& from) {
        return "format = 1\nbody = [{ name = \"b\", mass = 1, inertia = [0.1, 0.1, 0.1] }]\n"
               "[[joint]]\nname = \"j\"\ntype = \"prismatic\"\nbetween = [\"world\", \"b\"]\n"
               "at = [0, 0, 0]\naxis = [1, 0, 0]\n[[joint]]\nname = \"k\"\ntype = \"weld\"\n"
               "between = [\"world\", \"b\"]\nat = [0, 0, 0]\n" +
               from +
               "[start]\ncoordinates = [{ joint = \"j\", value = -0.2, rate = 1 }]\n"
               "[time]\nend = 1\naccuracy = 1e-9\n";
    };
    for (const std::string from : {"\"j.displacement > 0\"", "0.2"}) {
        const SolvedScenario s = solved(text("restitution = 0\nfrom = " + from + "\n"));
        ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
        const Motion& motion = s.solution.motion;
        EXPECT_NEAR(motion.at(0.1).X[0](0, 0), -0.1, 1e-9);
        EXPECT_NEAR(motion.at_end(motion.n_elements()).X[0](0, 0), 0, 1e-9);
    }
    EXPECT_NE(find(read(text("")), "start-coordinate"), nullptr);   // the control: it acts from the start on
}

TEST(DecidedEvents, AreRefusedByName)
{
    const auto refused = [](const std::string& text, const char* code) {
        const ScenarioResult result = read(text);
        EXPECT_NE(find(result, code), nullptr) << code << text << shown(result);
    };
    const std::string until = "end = 1\nelements = 10\nuntil = ";
    refused(pendulum(until + "\"pin.angle\""), "event-condition");
    refused(pendulum(until + "\"pin.angle > 0.1 > 0\""), "event-condition");
    refused(pendulum(until + "\"pin.angle >\""), "event-condition");
    refused(pendulum(until + "\"max(pin.angle, 0) > 0.1\""), "event-condition");
    refused(pendulum(until + "\"pin.angel > 0.1\""), "joint-coordinate");
    refused(pendulum(until + "\"pim.angle > 0.1\""), "input-unknown");
    refused(pendulum(until + "\"limit > 0.1\""), "expression-name");
    refused(pendulum(until + "\"pin.angle > 0.1\"", "[method]\nfamily = \"mixed\"\n"), "event-method");
    refused(pendulum(until + "\"pin.angle > 0.1\"", "[method]\nwindow = 2\n"), "event-method");
    refused(pendulum("breaks = \"ignore\"\n" + until + "\"pin.angle > 0.1\""), "event-method");
    refused(pendulum(until + "\"pin.force > 9000\"",
                     "[[joint]]\nname = \"again\"\ntype = \"revolute\"\nbetween = [\"world\", \"rod\"]\n"
                     "at = [0, 0.2, 0]\naxis = [0, 1, 0]\n"),
            "event-reaction");
}

}   // namespace

}   // namespace livens::decided_events_test
