// SPDX-License-Identifier: BSD-3-Clause
// Conditions that become true through a jump: a sample, an impact, an event, a load that begins to pull.
// Their instants are those of what jumps.
#include <cmath>
#include <numbers>

#include "livens/base/text.h"
#include "livens/multibody/controllers.h"
#include "livens/spacetime/solve.h"
#include "unit/io/swinging_rod.h"

namespace livens::events_by_jumps_test {

namespace {

using test::solved;

/// The arm with a computer that counts its samples, one every 0.1 s from 0 s on.
std::string counting(const std::string& events, const std::string& time)
{
    return test::hanging_arm(R"toml([[controller]]
name = "c"
every = 0.1
inputs = { q = "pin.angle" }
states = { n = "n + 1" }
outputs = { u = "5*(0.5 - q)" }

[[load]]
name = "drive"
type = "actuator"
joint = "pin"
expression = "c.u"

)toml" + events + "\n[time]\n" +
                             time + "\n");
}

std::string event(const std::string& name, const std::string& when, const std::string& more = "")
{
    return "[[event]]\nname = \"" + name + "\"\nwhen = \"" + when + "\"\n" + more + "\n";
}

std::vector<double> times_of(const SolvedScenario& s)
{
    EXPECT_TRUE(s.solution.report.converged()) << s.solution.report.message;
    std::vector<double> times;
    for (const SolvedEvent& one : s.solution.events) times.push_back(one.t);
    return times;
}

/// Sample k, at 0.1 k s, counts to k + 1. A border that is counted to is passed by the next one, whatever
/// rounding makes of it.
TEST(EventsByJumps, AreAtTheSampleThatMakesThemTrue)
{
    for (const std::string how : {"end = 1\naccuracy = 1e-9", "end = 1\nelements = 60"}) {
        const std::vector<double> half = times_of(solved(counting(event("e", "c.n > 5.5"), how)));
        ASSERT_EQ(half.size(), 1u) << how;
        EXPECT_NEAR(half[0], 0.5, 1e-15);
        const std::vector<double> whole = times_of(solved(counting(event("e", "c.n > 6"), how)));
        ASSERT_EQ(whole.size(), 1u) << how;
        EXPECT_NEAR(whole[0], 0.6, 1e-15);
        EXPECT_TRUE(times_of(solved(counting(event("e", "c.n > 100"), how))).empty());   // the control
    }
}

TEST(EventsByJumps, EndTheMotionAndWhatActsThere)
{
    const SolvedScenario s = solved(counting("", "end = 1\naccuracy = 1e-9\nuntil = \"c.n > 5.5\""));
    ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
    EXPECT_NEAR(s.solution.motion.end(), 0.5, 1e-15);
    const State last = s.solution.motion.at_end(s.solution.motion.n_elements());
    EXPECT_NEAR(states_in(*s.solution.decided, last.V)[0].value, 6, 1e-12);
    // a load that ends with the sample is one that ends when it is asked to
    const std::string by_sample = counting("", "end = 1\naccuracy = 1e-9"), drive = "expression = \"c.u\"\n";
    const auto angle = [&](const std::string& until) {
        std::string text = by_sample;
        text.insert(text.find(drive) + drive.size(), "until = \"" + until + "\"\n");
        const SolvedScenario one = solved(text);
        EXPECT_TRUE(one.solution.report.converged()) << one.solution.report.message;
        const State state = one.solution.motion.at_end(one.solution.motion.n_elements());
        return std::atan2(-state.X[0](2, 1), state.X[0](0, 1));
    };
    EXPECT_NEAR(angle("c.n > 5.5"), angle("0.5 s"), 1e-9);
    EXPECT_GT(std::abs(angle("c.n > 5.5") - angle("0.6 s")), 1e-3);   // the control
}

/// What a motion that ends before leaves of samples is not asked for.
TEST(EventsByJumps, SamplesBehindTheEndOfAMotionAreNone)
{
    const SolvedScenario s = solved(counting("", "end = 1\nelements = 60\nuntil = \"pin.angle > 0.1\""));
    ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
    EXPECT_LT(s.solution.motion.end(), 0.9);
    EXPECT_FALSE(s.solution.estimate.empty());
}

TEST(EventsByJumps, FollowEachOtherAtAnInstant)
{
    const std::string both = event("first", "t > 0.52", "set = { \"c.n\" = \"100\" }") +
                             event("second", "c.n > 50", "set = { \"c.n\" = \"200\" }") +
                             event("third", "c.n > 150");
    const std::vector<double> times = times_of(solved(counting(both, "end = 1\naccuracy = 1e-9")));
    ASSERT_EQ(times.size(), 3u);
    for (const double t : times) EXPECT_NEAR(t, 0.52, 1e-13);
    const std::string without_end = event("up", "c.n > 2.5", "set = { \"c.n\" = \"-5\" }") +
                                    event("down", "c.n < -2.5", "set = { \"c.n\" = \"5\" }");
    const SolvedScenario s = solved(counting(without_end, "end = 1\naccuracy = 1e-9"));
    EXPECT_FALSE(s.solution.report.converged());
    EXPECT_NE(s.solution.report.message.find("events follow each other without an end"), std::string::npos)
        << s.solution.report.message;
}

/// A ball that falls 1 m: it goes up behind each bounce, and not where it stays.
TEST(EventsByJumps, AreAtTheImpactThatMakesThemTrue)
{
    const auto ball = [](const std::string& restitution) {
        return R"(format = 1
gravity = [0, 0, -9.81]
body = [{ name = "ball", mass = 1, inertia = [1, 1, 1], position = [0, 0, 1] }]

[[sensor]]
name = "s"
type = "point"
body = "ball"

[[joint]]
name = "rail"
type = "prismatic"
between = ["world", "ball"]
at = [0, 0, 1]
axis = [0, 0, 1]
limits = [-1, 5]
limit_restitution = )" +
               restitution + "\n\n" + event("up", "s.vz > 0") + "[time]\nend = 1.2\naccuracy = 1e-10\n";
    };
    const double fall = std::sqrt(2 / 9.81);
    std::vector<double> ups;
    const SolvedScenario bouncing = solved(ball("0.5"));
    ASSERT_TRUE(bouncing.solution.report.converged()) << bouncing.solution.report.message;
    for (const SolvedEvent& one : bouncing.solution.events)
        if (one.speed == 0) ups.push_back(one.t);
    ASSERT_EQ(ups.size(), 3u);
    EXPECT_NEAR(ups[0], fall, 1e-12);
    EXPECT_NEAR(ups[1], 2 * fall, 1e-12);
    EXPECT_NEAR(ups[2], 2.5 * fall, 1e-12);
    for (const SolvedEvent& one : solved(ball("0")).solution.events) EXPECT_GT(one.speed, 0);
}

/// The force of the pin jumps with what pulls at the arm from 0.3 s on.
TEST(EventsByJumps, AreWhereALoadBeginsToPull)
{
    for (const std::string pull :
         {"value = [0, 30, 0]\nfrom = 0.3\n", "expression = [\"0\", \"15 + 15*sign(t - 0.3)\", \"0\"]\n"})
        for (const std::string how : {"accuracy = 1e-9", "elements = 20"}) {
            const SolvedScenario s = solved(
                test::hanging_arm("[[load]]\nname = \"side\"\ntype = \"force\"\nbody = \"arm\"\n" + pull +
                                  event("e", "pin.force > 32") + "[time]\nend = 1\n" + how + "\n"));
            const std::vector<double> times = times_of(s);
            ASSERT_EQ(times.size(), 1u) << pull << how;
            EXPECT_NEAR(times[0], 0.3, 1e-12);
        }
}

/// A mass on a spring whose rate is v cos(w t): elements end wherever it passes the border, also where the
/// condition becomes false, and short ones behind tell no direction by their polynomials.
TEST(DirectionsOfEvents, ConditionsBecomeTrueWhereTheyRiseAlone)
{
    const struct {
        double v, k;
        char sign;
        double border, end;
        std::string how;
    } cases[] = {{1, 65.1, '>', -0.1, 6, "accuracy = 1e-6\n[method]\nfamily = \"lobatto\""},
                 {1, 11.8, '>', 0, 6, "accuracy = 1e-8\n[method]\nfamily = \"lobatto\""},
                 {1, 10.4, '<', -0.31, 6, "accuracy = 1e-4\n[method]\nfamily = \"lobatto\""},
                 {1, 28.1, '>', 0.43, 6, "elements = 200\n[method]\nfamily = \"radau\""},
                 {1, 38.2, '<', -0.56, 6, "elements = 150\n[method]\nfamily = \"radau\""},
                 {1.7821682679383737, 76.99706976462166, '>', -1.670225872522151, 5.853640341297627,
                  "accuracy = 1e-4\n[method]\nfamily = \"lobatto\""},
                 {1.6343493053480884, 55.78443701002028, '<', -0.4745810489655287, 2.6034422111321875,
                  "accuracy = 1e-4"},
                 {1, 39.3955032040296, '>', 0.2604859677121458, 3.226450774163981, "accuracy = 1e-6"},
                 {0.752495329223319, 42.31524265689517, '>', 0.38160151082502186, 6.454066985937944,
                  "accuracy = 1e-6"},
                 {1, 59.864834780015826, '<', 0.3066521861045426, 4.445670068427605, "accuracy = 1e-8"}};
    for (const auto& one : cases) {
        const SolvedScenario s = solved(
            "format = 1\nbody = [{ name = \"b\", mass = 1, inertia = [0.1, 0.1, 0.1] }]\n[[joint]]\n"
            "name = \"j\"\ntype = \"prismatic\"\nbetween = [\"world\", \"b\"]\nat = [0, 0, 0]\n"
            "axis = [1, 0, 0]\nrate = " +
            to_text(one.v, 17) + "\nstiffness = " + to_text(one.k, 17) + "\n" +
            event("e", "j.displacement_rate " + std::string(1, one.sign) + " " + to_text(one.border, 17)) +
            "[start]\ninitial = \"project\"\n[time]\nend = " + to_text(one.end, 17) + "\n" + one.how + "\n");
        const double w = std::sqrt(one.k), first = std::acos(one.border / one.v),
                     turn = 2 * std::numbers::pi;   // of the phase
        std::vector<double> expected;               // it falls at `first` and rises at a turn less that
        for (int n = 0; n < 20; ++n) {
            const double t = (n * turn + (one.sign == '<' ? first : turn - first)) / w;
            if (t < one.end) expected.push_back(t);
        }
        const std::vector<double> times = times_of(s);
        ASSERT_EQ(times.size(), expected.size()) << one.k << " " << one.how;
        for (std::size_t k = 0; k < times.size(); ++k) EXPECT_NEAR(times[k], expected[k], 1e-4);
    }
}

}   // namespace

}   // namespace livens::events_by_jumps_test
