// SPDX-License-Identifier: BSD-3-Clause
// Impacts and stops: instants, impulses and rest against closed forms.
#include <cmath>
#include <numbers>

#include "livens/base/text.h"
#include "livens/spacetime/solve.h"
#include "unit/io/swinging_rod.h"

namespace livens::stops_test {

namespace {

using test::find;
using test::hits_of;
using test::read;
using test::shown;
using test::solved;

/// On a guide 1 m above the floor.
std::string ball(const std::string& stop, const std::string& time)
{
    return R"(format = 1
gravity = [0, 0, -9.81]
body = [{ name = "ball", shape = { sphere = 0.1 }, mass = 2, position = [0, 0, 1] }]

[[joint]]
name = "guide"
type = "prismatic"
between = ["world", "ball"]
at = [0, 0, 0]
axis = [0, 0, 1]
coordinate = 1

[[stop]]
name = "floor"
joint = "guide"
limits = [0, inf]
)" + stop + "\n\n[time]\n" +
           time + "\n";
}

TEST(Stops, BallComesToRestBehindBouncesWithoutEnd)
{
    const SolvedScenario s = solved(ball("restitution = 0.7", "end = 4\naccuracy = 1e-11"));
    ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
    const std::vector<SolvedEvent> hits = hits_of(s);
    ASSERT_GT(hits.size(), 10u);
    EXPECT_LT(hits.size(), 60u);
    const double first = std::sqrt(2 / 9.81), speed = std::sqrt(2 * 9.81);
    double t = first, v = speed;
    for (std::size_t k = 0; k < hits.size(); ++k) {
        EXPECT_NEAR(hits[k].t, t, 5e-11) << k;   // places round by 1e-16
        EXPECT_NEAR(hits[k].speed, v, 1e-9) << k;
        EXPECT_NEAR(hits[k].impulse, 2 * 1.7 * v, 1e-8) << k;
        v *= 0.7;
        t += 2 * v / 9.81;
    }
    EXPECT_NEAR(hits.back().rests_at, first * 1.7 / 0.3, 1e-10);
    const Motion& motion = s.solution.motion;
    EXPECT_EQ(motion.impacts.ends.size(), hits.size());
    EXPECT_NEAR(motion.at_end(motion.n_elements()).X[0](2, 0), 0, 1e-11);
    // on both sides of an impact
    const int end = motion.impacts.ends[0];
    EXPECT_NEAR(motion.at_end(end, Side::left).V[0](2, 0), -speed, 1e-9);
    EXPECT_NEAR(motion.at_end(end).V[0](2, 0), 0.7 * speed, 1e-9);
    EXPECT_LT(s.solution.estimate.largest, 1e-11);
}

TEST(Stops, WithoutRestitutionTheyCloseAtOnce)
{
    const SolvedScenario s = solved(ball("", "end = 1\naccuracy = 1e-10"));
    ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
    const std::vector<SolvedEvent> hits = hits_of(s);
    ASSERT_EQ(hits.size(), 1u);
    EXPECT_EQ(hits[0].rests_at, hits[0].t);
    EXPECT_EQ(s.solution.events.size(), 1u);
    const Motion& motion = s.solution.motion;
    EXPECT_NEAR(motion.at_end(motion.n_elements()).X[0](2, 0), 0, 1e-14);
}

TEST(Stops, OfFullRestitutionLoseNothing)
{
    const SolvedScenario s = solved(ball("restitution = 1", "end = 4\naccuracy = 1e-10"));
    ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
    const std::vector<SolvedEvent> hits = hits_of(s);
    const double first = std::sqrt(2 / 9.81);
    ASSERT_EQ(hits.size(), 4u);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(hits[k].t, (1 + 2 * double(k)) * first, 1e-10);
}

/// Let go at 1 rad; it meets a buffer where it hangs.
std::string pendulum(const std::string& time, const std::string& more = "")
{
    return test::SwingingRod{-1}.text(time, R"([[stop]]
name = "buffer"
joint = "pin"
limits = ["-inf", "0 deg"]
restitution = 0.8
)" + more);
}

/// Instants of impacts: a swing from the angle b takes K(sin b/2) / rate to the bottom, and behind an impact
/// the angle is that whose speed there is e times the one before: sin(b'/2) = e sin(b/2).
std::vector<double> buffer_hits(int n)
{
    const double rate = test::SwingingRod::frequency();
    double k = std::sin(0.5), t = std::comp_ellint_1(k) / rate;
    std::vector<double> all{t};
    while (static_cast<int>(all.size()) < n) {
        k *= 0.8;
        t += 2 * std::comp_ellint_1(k) / rate;
        all.push_back(t);
    }
    return all;
}

TEST(Stops, PendulumMeetsABufferWhenEllipticIntegralsSay)
{
    const SolvedScenario s = solved(pendulum("end = 3.2\naccuracy = 1e-11"));
    ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
    const std::vector<SolvedEvent> hits = hits_of(s);
    const std::vector<double> truth = buffer_hits(4);
    ASSERT_GE(hits.size(), 4u);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(hits[k].t, truth[k], 1e-12) << k;
}

/// The short form, to the bit; springs are something else.
TEST(Stops, AreWhatLimitsOfAJointMean)
{
    const auto of_limits = [](const std::string& keys) {
        return solved(test::SwingingRod{-1, "limits = [\"-inf\", \"0 deg\"]\n" + keys}.text(
            "end = 2\naccuracy = 1e-9"));
    };
    const SolvedScenario stated = solved(pendulum("end = 2\naccuracy = 1e-9")),
                         limits = of_limits("limit_restitution = 0.8\n"),
                         springs = of_limits("limit_law = \"penalty\"\nlimit_damping = 0\n"),
                         as_before = of_limits("limit_damping = 0\n");
    ASSERT_TRUE(limits.solution.report.converged()) << limits.solution.report.message;
    EXPECT_EQ(stated.solution.motion.X.values, limits.solution.motion.X.values);
    EXPECT_EQ(limits.solution.events.size(), stated.solution.events.size());
    EXPECT_GE(hits_of(limits).size(), 2u);
    EXPECT_TRUE(springs.solution.events.empty());
    EXPECT_EQ(springs.solution.motion.X.values, as_before.solution.motion.X.values);
    EXPECT_NE(springs.solution.motion.X.values, limits.solution.motion.X.values);
}

class OrdersOfImpacts : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Degrees, OrdersOfImpacts, testing::Values(2, 3, 4, 5, 6));

/// Four impacts, elements halved: errors fall by 2^2p, and are told.
TEST_P(OrdersOfImpacts, AreThoseOfTheMethod)
{
    const int p = GetParam();
    const std::vector<double> truth = buffer_hits(4);
    const double end = truth[3] + 0.3;
    const int coarse[] = {0, 0, 64, 64, 32, 24, 12};
    double errors[2] = {};
    for (int i = 0; i < 2; ++i) {
        const SolvedScenario s =
            solved(pendulum("end = " + std::to_string(end) + "\nelements = " + std::to_string(coarse[p] << i),
                            "\n[method]\nfamily = \"lobatto\"\ndegree = " + std::to_string(p) + "\n"));
        const std::vector<SolvedEvent> hits = hits_of(s);
        ASSERT_EQ(hits.size(), 4u) << s.solution.report.message;
        errors[i] = std::abs(hits[3].t - truth[3]);
        EXPECT_GT(hits[3].error + 1e-14, 0.5 * errors[i]) << p << " " << i;
        EXPECT_LT(hits[3].error, 2 * errors[i] + 2e-14) << p << " " << i;
    }
    const double order = std::log2(errors[0] / errors[1]);
    // beyond degree 4 the finer one is at what is rounded
    EXPECT_GT(order, p < 5 ? 2 * p - 0.3 : 9.5) << errors[0] << " " << errors[1];
    EXPECT_LT(order, 2 * p + 0.5);
}

/// Leaves a sphere of 1 m, on which it slides, and is not caught again.
TEST(Stops, OpenWhereTheyWouldPull)
{
    const double v = 1, cosine = 2.0 / 3 + v * v / (3 * 9.81);
    const SolvedScenario s = solved(R"(format = 1
gravity = [0, 0, -9.81]
body = [{ name = "ball", shape = { point = true }, mass = 3, position = [0, 0, 1], velocity = [1, 0, 0] }]

[[stop]]
name = "sphere"
between = ["world", "ball"]
limits = [1, inf]

[[sensor]]
name = "place"
type = "point"
body = "ball"

[[event]]
name = "left"
when = "place.z < 0"
action = "stop"

[time]
end = 2
accuracy = 1e-11
)");
    const Solution& solution = s.solution;
    ASSERT_TRUE(solution.report.converged()) << solution.report.message;
    ASSERT_EQ(solution.events.size(), 3u);   // closed from the start, opens, below
    const State there = solution.motion.at(solution.events[1].t);
    EXPECT_NEAR(there.X[0](2, 0), cosine, 1e-12);
    EXPECT_EQ(solution.motion.end(), solution.events[2].t);
}

/// A rope of 1 m that is slack, comes taut with a jerk that takes what is along it, and holds.
TEST(Stops, RopesOnlyPull)
{
    const SolvedScenario s = solved(R"(format = 1
gravity = [0, 0, -9.81]
body = [{ name = "ball", shape = { point = true }, mass = 3, position = [0.6, 0, 0] }]

[[stop]]
name = "rope"
between = ["world", "ball"]
limits = [0, 1]

[time]
end = 0.8
accuracy = 1e-10
)");
    const Solution& solution = s.solution;
    ASSERT_TRUE(solution.report.converged()) << solution.report.message;
    const std::vector<SolvedEvent> hits = hits_of(s);
    ASSERT_EQ(hits.size(), 1u);
    EXPECT_NEAR(hits[0].t, std::sqrt(2 * 0.8 / 9.81), 1e-11);   // 0.6, 0.8, 1
    const double v = std::sqrt(2 * 9.81 * 0.8);
    EXPECT_NEAR(hits[0].speed, 0.8 * v, 1e-10);
    EXPECT_NEAR(hits[0].impulse, 3 * 0.8 * v, 1e-9);
    const State end = solution.motion.at_end(solution.motion.n_elements());
    EXPECT_NEAR(norm(end.X[0].column(0)), 1, 1e-13);
    // energy behind the jerk: what is across the rope, 0.6 v
    const double energy = 0.5 * dot(end.V[0].column(0), end.V[0].column(0)) + 9.81 * end.X[0](2, 0);
    EXPECT_NEAR(energy, 0.5 * 0.36 * v * v - 9.81 * 0.8, 1e-8);
}

std::string chain(bool is_doubled)
{
    std::string text = R"(format = 1
body = [
    { name = "upper", shape = { box = [1, 0.04, 0.04] }, mass = 2, position = [0.5, 0, 0] },
    { name = "lower", shape = { box = [0.8, 0.04, 0.04] }, mass = 1, position = [1.4, 0, 0] }
]
)";
    for (const char* name : {"shoulder", "elbow", "shoulder again", "elbow again"}) {
        const bool is_elbow = name[0] == 'e',
                   is_second = std::string(name).find("again") != std::string::npos;
        if (is_second && !is_doubled) continue;
        text += std::string("[[joint]]\nname = \"") + name + "\"\ntype = \"revolute\"\nbetween = [" +
                (is_elbow ? "\"upper\", \"lower\"" : "\"world\", \"upper\"") + "]\nat = [" +
                (is_elbow ? "1" : "0") + ", 0, 0]\naxis = [0, 0, 1]\n";
        if (!is_second) text += std::string("rate = ") + (is_elbow ? "3" : "-1") + "\n";
    }
    return text + R"([start]
initial = "project"

[[stop]]
name = "stop"
joint = "elbow"
limits = ["-inf", "30 deg"]
restitution = 0.6

[time]
end = 0.5
accuracy = 1e-11
)";
}

/// Of two rods that turn in a plane, whose elbow is bent by 30 degrees: M of the rates of both.
struct BentChain {
    double m11 = 2 * ((1 + 0.0016) / 12 + 0.25) + 1, m12 = 0.4 * std::cos(std::numbers::pi / 6),
           m22 = (0.64 + 0.0016) / 12 + 0.16;

    /// (-1, 1) M^-1 (-1, 1)^T
    double mobility() const { return (m11 + m22 + 2 * m12) / (m11 * m22 - m12 * m12); }
    static double rate(const State& state, int b) { return angular_velocity(state.X[b], state.V[b])[2]; }
    double energy(const State& state) const
    {
        const double a = rate(state, 0), b = rate(state, 1);
        return 0.5 * (m11 * a * a + 2 * m12 * a * b + m22 * b * b);
    }
};

/// Against minimal coordinates, all joints once and twice.
TEST(Stops, ImpulsesDoNotDependOnDoubledJoints)
{
    const BentChain bent;
    std::vector<double> impulses;
    for (const bool is_doubled : {false, true}) {
        const SolvedScenario s = solved(chain(is_doubled));
        ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
        const std::vector<SolvedEvent> hits = hits_of(s);
        ASSERT_EQ(hits.size(), 1u);
        const Motion& motion = s.solution.motion;
        const int end = motion.impacts.ends[0];
        const State before = motion.at_end(end, Side::left), behind = motion.at_end(end);
        const double u = bent.rate(before, 1) - bent.rate(before, 0);
        EXPECT_NEAR(hits[0].impulse, 1.6 * u / bent.mobility(), 1e-13);
        EXPECT_NEAR(bent.rate(behind, 1) - bent.rate(behind, 0), -0.6 * u, 1e-13);
        EXPECT_NEAR(bent.energy(before) - bent.energy(behind), 0.5 * (1 - 0.36) * u * u / bent.mobility(),
                    1e-13);
        impulses.push_back(hits[0].impulse);
    }
    EXPECT_NEAR(impulses[0], impulses[1], 1e-13);
}

/// A joint that holds both ways begins at an event and catches: what it forbids is taken off, and no more.
TEST(Stops, JointsWithARestitutionCatch)
{
    const SolvedScenario s = solved(R"(format = 1
body = [
    { name = "cart", shape = { point = true }, mass = 1, position = [0, 0, 0], velocity = [2, 0, 0] },
    { name = "wagon", shape = { point = true }, mass = 3, position = [1, 0, 0] }
]

[[joint]]
name = "coupling"
type = "rod"
between = ["cart", "wagon"]
points = [[0, 0, 0], [0, 0, 0]]
length = 0.5
from = "ahead.x - behind.x < 0.5"
restitution = 0

[[sensor]]
name = "behind"
type = "point"
body = "cart"

[[sensor]]
name = "ahead"
type = "point"
body = "wagon"

[time]
end = 1
accuracy = 1e-11
)");
    ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
    ASSERT_EQ(s.solution.events.size(), 1u);
    EXPECT_NEAR(s.solution.events[0].t, 0.25, 1e-13);
    const State end = s.solution.motion.at_end(s.solution.motion.n_elements());
    for (const Matrix34& V : end.V) EXPECT_NEAR(V(0, 0), 0.5, 1e-13);
}

/// Two balls on guides of their own, and one with two floors.
TEST(Stops, HitAtOnceNeedALawWhereTheyFeelEachOther)
{
    const auto falling = [](const std::string& lower, const std::string& upper) {
        std::string text = "format = 1\ngravity = [0, 0, -9.81]\n";
        for (const char* name : {"a", "b"}) {
            const bool is_a = name[0] == 'a';
            text += std::string("[[body]]\nname = \"") + name +
                    "\"\nshape = { sphere = 0.1 }\nmass = " + (is_a ? "1" : "2") + "\nposition = [" +
                    (is_a ? "0" : "1") + ", 0, 0.5]\n";
            text += std::string("[[joint]]\nname = \"g") + name +
                    "\"\ntype = \"prismatic\"\nbetween = [\"world\", \"" + name + "\"]\nat = [" +
                    (is_a ? "0" : "1") + ", 0, 0]\naxis = [0, 0, 1]\ncoordinate = 0.5\n";
        }
        text += "[[stop]]\nname = \"one\"\n" + lower + "\n[[stop]]\nname = \"two\"\n" + upper +
                "\n[time]\nend = 0.5\naccuracy = 1e-10\n";
        return solved(text);
    };
    const std::string of_a = "joint = \"ga\"\nlimits = [0, inf]\nrestitution = 0.5";
    // each on its own floor
    const SolvedScenario apart = falling(of_a, "joint = \"gb\"\nlimits = [0, inf]");
    EXPECT_TRUE(apart.solution.report.converged()) << apart.solution.report.message;
    EXPECT_EQ(hits_of(apart).size(), 2u);
    // one body, two floors
    const SolvedScenario twice = falling(of_a, "joint = \"ga\"\nlimits = [0, inf]\nrestitution = 0.2");
    EXPECT_FALSE(twice.solution.report.converged());
    EXPECT_NE(twice.solution.report.message.find("same instant"), std::string::npos);
    EXPECT_NEAR(twice.solution.motion.end(), std::sqrt(1 / 9.81), 1e-12);   // what was before is kept
    const std::string together = "\nimpact = \"together\"";
    const SolvedScenario named =
        falling(of_a + together, "joint = \"ga\"\nlimits = [0, inf]\nrestitution = 0.2" + together);
    ASSERT_TRUE(named.solution.report.converged()) << named.solution.report.message;
    const Motion& motion = named.solution.motion;
    EXPECT_NEAR(motion.at_end(motion.impacts.ends[0]).V[0](2, 0), 0.5 * std::sqrt(9.81), 1e-10);
}

/// Balls on a line, each `gap` from the next but for the first, which comes from half a metre with 1 m/s.
std::string row_of_balls(int n, double gap, const std::string& law)
{
    std::string text = "format = 1\n";
    for (int k = 0; k < n; ++k) {
        const std::string name = std::to_string(k), x = to_text(k == 0 ? -0.5 : (0.25 + gap) * (k - 1), 17);
        text += "[[body]]\nname = \"b" + name + "\"\nshape = { sphere = 0.1 }\nmass = 1\nposition = [" + x +
                ", 0, 0]\n[[joint]]\nname = \"g" + name +
                "\"\ntype = \"prismatic\"\nbetween = [\"world\", \"b" + name + "\"]\nat = [" + x +
                ", 0, 0]\naxis = [1, 0, 0]\n";
    }
    for (int k = 0; k + 1 < n; ++k)
        text += "[[stop]]\nname = \"s" + std::to_string(k) + "\"\nbetween = [\"b" + std::to_string(k) +
                "\", \"b" + std::to_string(k + 1) + "\"]\nlimits = [0.25, inf]\n" + law;
    return text + "[start]\ncoordinates = [{ joint = \"g0\", rate = 1 }]\n[time]\nend = 0.5\n";
}

/// Balls that touch, hit by another: by Moreau's law all share what the restitution leaves, and go on side by
/// side with no force between them. Without that law the impact of balls that were at rest is one of several.
TEST(Stops, AreMetThroughBodiesThatTouch)
{
    for (const int n : {3, 31}) {
        const SolvedScenario s = solved(row_of_balls(n, 0, "restitution = 1\nimpact = \"together\"\n") +
                                        (n == 3 ? "accuracy = 1e-10\n" : "elements = 6\n"));
        ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
        const State end = s.solution.motion.at_end(s.solution.motion.n_elements());
        EXPECT_NEAR(end.V[0](0, 0), 2.0 / n - 1, 1e-12);
        for (std::size_t k = 1; k < end.V.size(); ++k) EXPECT_NEAR(end.V[k](0, 0), 2.0 / n, 1e-12);
        ASSERT_FALSE(hits_of(s).empty());
        EXPECT_NEAR(hits_of(s)[0].speed, 1, 1e-12);   // of the distance, not of its square
        EXPECT_NEAR(hits_of(s)[0].impulse, 2 - 2.0 / n, 1e-12);
        EXPECT_EQ(s.solution.motion.impacts.ends.size(), 1u);
        EXPECT_LT(s.solution.motion.n_elements(), 20);   // what only touches divides nothing
    }
    const SolvedScenario alone = solved(row_of_balls(3, 0, "restitution = 1\n") + "accuracy = 1e-10\n");
    EXPECT_FALSE(alone.solution.report.converged());
    EXPECT_NE(alone.solution.report.message.find("same instant"), std::string::npos)
        << alone.solution.report.message;
}

/// However near balls of a row are: one impact after the other, as a list of flights has them.
TEST(Stops, PassImpactsOnOverAnyDistance)
{
    for (const double gap : {1e-11, 1e-9, 1e-3}) {
        const SolvedScenario s = solved(row_of_balls(5, gap, "restitution = 0.6\n") + "accuracy = 1e-10\n");
        ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
        std::vector<double> apart{0.25, gap, gap, gap}, v{1, 0, 0, 0, 0}, speeds, times;
        double t = 0;
        for (;;) {
            std::size_t next = 0;
            double soon = 1;
            for (std::size_t k = 0; k < apart.size(); ++k) {
                const double wait = v[k] > v[k + 1] ? apart[k] / (v[k] - v[k + 1]) : 1;
                if (wait < soon) soon = wait, next = k;
            }
            if (t + soon > 0.5) break;
            t += soon;
            for (std::size_t k = 0; k < apart.size(); ++k) apart[k] += soon * (v[k + 1] - v[k]);
            const double speed = v[next] - v[next + 1], change = 0.5 * 1.6 * speed;
            v[next] -= change;
            v[next + 1] += change;
            apart[next] = 0;
            speeds.push_back(speed);
            times.push_back(t);
        }
        ASSERT_EQ(hits_of(s).size(), times.size()) << gap;
        for (std::size_t k = 0; k < times.size(); ++k) {
            EXPECT_NEAR(hits_of(s)[k].speed, speeds[k], 1e-12) << gap;
            // the first is found to 1e-13 of an element of 0.12 s, which is a way for slower ones
            EXPECT_NEAR(hits_of(s)[k].t, times[k], 1e-14 + 1.5e-14 / speeds[k]) << gap;
        }
        const State end = s.solution.motion.at_end(s.solution.motion.n_elements());
        for (std::size_t k = 0; k < v.size(); ++k) EXPECT_NEAR(end.V[k](0, 0), v[k], 1e-12);
    }
}

TEST(Stops, AreRefusedByName)
{
    const auto refused = [](const std::string& text, const char* code) {
        const ScenarioResult result = read(text);
        EXPECT_NE(find(result, code), nullptr) << code << text << shown(result);
    };
    const std::string time = "end = 1\nelements = 10";
    refused(ball("restitution = 1.5", time), "out-of-range");
    std::string text = ball("", time);
    text.replace(text.find("[0, inf]"), 8, "[1, 0.5]");
    refused(text, "stop-limits");
    text = ball("", time);
    text.replace(text.find("[0, inf]"), 8, "[2, inf]");
    refused(text, "stop-violated");
    text = ball("", time);
    text.replace(text.find("joint = \"guide\""), 15, "joint = \"guild\"");
    refused(text, "joint-unknown");
    for (const char* until : {"0.5", "\"guide.displacement < 0.5\""}) {   // it would go on without end
        text = ball("", time);
        text.replace(text.find("coordinate = 1"), 14, std::string("coordinate = 1\nuntil = ") + until);
        refused(text, "stop-released");
    }
    refused(ball("", time) + "\n[method]\nwindow = 2\n", "event-method");
}

}   // namespace

}   // namespace livens::stops_test
