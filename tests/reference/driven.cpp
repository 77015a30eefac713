// SPDX-License-Identifier: BSD-3-Clause
// Every drive with every law: order 2p, and the balance of energy with what the drive does.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "livens/diagnostics/detail/sampler.h"
#include "reference/solved.h"

namespace livens::tests::driven_test {
namespace {

/// A cart that is driven, and a bob on a skew pin that swings.
const std::string cart_and_bob = R"toml(
gravity = [0, 0, -9.81]
[[body]]
name = "cart"
mass = 3
inertia = [1, 1, 1]
[[body]]
name = "bob"
mass = 2
inertia = [0.2, 0.3, 0.3]
position = [0.5, 0, 0]
[[joint]]
name = "pin"
type = "revolute"
between = ["cart", "bob"]
at = [0, 0, 0]
axis = [0.6, 0.8, 0]
)toml";
const std::string on_rail = R"toml([[joint]]
name = "rail"
type = "prismatic"
between = ["world", "cart"]
at = [0, 0, 0]
axis = [1, 0, 0]
[[drive]]
type = "joint"
joint = "rail"
)toml";
const std::string on_axle = R"toml([[joint]]
name = "axle"
type = "revolute"
between = ["world", "cart"]
at = [0, 0, 0]
axis = [0, 0, 1]
[[drive]]
type = "joint"
joint = "axle"
)toml";

struct Driven {
    const char* what;
    std::string text;
    int finer = 1;   ///< elements, where the motion is quick
};

std::vector<Driven> all_drives()
{
    const std::string wave = "harmonic = { amplitude = 0.3, frequency = 0.7 }\n";
    return {
        {"displacement, harmonic", on_rail + wave},
        {"angle, harmonic", on_axle + wave},
        {"angle, rate", on_axle + "rate = 3\n"},
        {"displacement, step", on_rail + "step = { from = 0.25, until = 1.5, rise = 0.7 }\n"},
        {"displacement, table",
         on_rail + "table = { times = [0, 0.5, 1, 2], values = [0, 0.2, -0.1, 0.4] }\n"},
        {"body, expression", "[[drive]]\ntype = \"body\"\nbody = \"cart\"\n"
                             "expression = [\"0.3*sin(2*t)\", \"0.1*t^2\", \"0.2*cos(3*t) - 0.2\"]\n"},
        {"point, polynomial",
         "[[drive]]\ntype = \"point\"\nbody = \"cart\"\npolynomial = [0, 0, 0, 0.1, 0.2, 0, 0.3, 0, 0.1]\n"},
        {"distance, expression",
         "[[drive]]\ntype = \"distance\"\nbetween = [\"world\", \"bob\"]\npoints = [[0, 2, 1], [0.2, 0, 0]]\n"
         "expression = \"2.179449471770337 + 0.1*sin(2*t)^2\"\n",
         4}};
}

Solved moved(const Driven& driven, const std::string& how)
{
    return solved(cart_and_bob + driven.text + "[start]\ninitial = \"project\"\n[time]\nend = 2\n" + how);
}

TEST(EveryDrive, HasOrder2pAndItsPowerInTheBalance)
{
    for (const Driven& driven : all_drives()) {
        SCOPED_TRACE(driven.what);
        const Solved fine = moved(driven, "accuracy = 1e-12\n");
        EXPECT_LT(fine.solution.verdict.energy_drift, 1e-11);
        EXPECT_LT(fine.solution.estimate.largest, 1e-12);
        const State right = fine.solution.motion.at(2);
        for (const int p : {1, 2, 3}) {
            double before = 0;
            const int n = driven.finer * (p == 1   ? 640
                                          : p == 2 ? 64
                                                   : 32);   // elements end at 0.25, 0.5, 1 and 1.5
            for (const int elements : {n, 2 * n}) {
                const State state =
                    moved(driven, "elements = " + std::to_string(elements) +
                                      "\n[method]\ndegree = " + std::to_string(p) + "\nestimate = \"none\"\n")
                        .solution.motion.at(2);
                double error = 0;
                for (int b = 0; b < 2; ++b)
                    error = std::max({error, norm(state.X[b] - right.X[b]), norm(state.V[b] - right.V[b])});
                if (before > 0) {
                    EXPECT_NEAR(std::log2(before / error), 2 * p, 0.35) << p << ": " << error;
                }
                before = error;
            }
        }
    }
}

/// What looks like a jump where it passes zero, and is none; beside it what is one.
TEST(EveryDrive, MayPassZeroWhereOperationsJumpElsewhereOnly)
{
    const auto led = [](const std::string& law) {
        return on_rail.substr(0, on_rail.find("[[drive]]")) +
               "[[body]]\nname = \"cart\"\nmass = 3\ninertia = [1, 1, 1]\n[[drive]]\ntype = \"joint\"\njoint "
               "= "
               "\"rail\"\nexpression = \"" +
               law +
               "\"\n[start]\ninitial = \"project\"\n[time]\nend = 1\noutput = [0.9]\naccuracy = 1e-12\n";
    };
    const double at = 0.9, before = at - 0.5;
    const auto atan = [](double t) { return std::asin(0.1 * std::sin(10 * t)); };
    const std::pair<std::string, double> laws[] = {
        {"atan2(0.1*sin(10*t), sqrt(1 - 0.01*sin(10*t)^2))", atan(at)},
        {"0.2*atan2(sin(6*t), 3 + cos(6*t))", 0.2 * std::atan2(std::sin(6 * at), 3 + std::cos(6 * at))},
        {"max(0, t - 0.5)^2", before * before},
        {"max(0, t - 0.5)^3", before * before * before},
        {"0.3 + (t - 0.5)*abs(t - 0.5)", 0.3 + before * before},
        {"1 - cos(max(0, t - 0.5))", 1 - std::cos(before)}};
    for (const auto& [law, value] : laws)
        EXPECT_NEAR(solved(led(law)).coordinate("rail", "displacement", at).value, value, 1e-12) << law;
    for (const std::string law :
         {"max(0, t - 0.5)", "0.1*abs(t - 0.5)", "atan2(t - 0.5, -1)", "1e-6*max(0, t - 0.5)",
          "1e-6*abs(t - 0.5)/(t - 0.5)", "atan2(sin(10*t), cos(10*t))"}) {
        const ScenarioResult read = parse_scenario("format = 1\n" + led(law), "test.toml");
        ASSERT_EQ(read.diagnostics.size(), 1u) << law;
        EXPECT_EQ(read.diagnostics[0].code, "drive-jumps") << law;
    }
}

// A ram that a crank would lead, against a steep cutting force: all is driven, so that the force of the drive
// is that of the formula at every instant, also between element ends, where the law changes faster than
// polynomials follow.
TEST(Driven, ForcesBetweenElementEndsAreThoseOfTheFormula)
{
    const double A = 0.1, f = 1, w = 2 * std::numbers::pi * f, m = 3;
    const Solved s = solved(R"toml(
[[body]]
name = "ram"
mass = 3
inertia = [1, 1, 1]
[[joint]]
name = "slide"
type = "prismatic"
between = ["world", "ram"]
at = [0, 0, 0]
axis = [1, 0, 0]
[[drive]]
name = "crank"
type = "joint"
joint = "slide"
harmonic = { amplitude = 0.1, frequency = 1 }
[[load]]
type = "actuator"
joint = "slide"
inputs = { v = "slide.displacement_rate" }
expression = "-250*(1 + tanh(v/0.02))"
[start]
initial = "project"
[time]
end = 1
elements = 16
)toml");
    const int drive = s.joint("crank");
    double worst = 0, interpolated = 0;
    const Motion& motion = s.solution.motion;
    for (int i = 1; i < 400; ++i) {
        const double t = i / 400.0, v = A * w * std::cos(w * t), a = -A * w * w * std::sin(w * t);
        const double force = m * a + 250 * (1 + std::tanh(v / 0.02));
        const std::vector<JointSample> joints = sample_joints(s.model, motion, t);
        EXPECT_TRUE(joints[drive].is_acceleration_level);
        worst = std::max(worst, std::abs(joints[drive].right.force[0] - force));
        const int row = s.model.first_row(drive);
        interpolated =
            std::max(interpolated, std::abs(std::abs(field_at(motion.multipliers, motion.mesh, t)[row]) - std::abs(force)));
    }
    EXPECT_LT(worst, 1e-9);
    EXPECT_GT(interpolated, 10) << "negative control: the nodes' multipliers between them";
}

}   // namespace
}   // namespace livens::tests::driven_test
