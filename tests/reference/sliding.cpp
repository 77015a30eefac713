// SPDX-License-Identifier: BSD-3-Clause
// Motions that slide along a discontinuity of a load, and such as pass one many times.
#include <cmath>
#include <string>

#include "livens/base/text.h"
#include "reference/solved.h"

namespace livens::tests::sliding_test {
namespace {

/// A carriage of 2 kg on a rail, from x = 0.
std::string carriage(const std::string& law, double rate, double end, const std::string& time)
{
    return "[[body]]\nname = \"b\"\nmass = 2\ninertia = [1, 1, 1]\nposition = [0, 0, 0]\n"
           "[[joint]]\nname = \"slide\"\ntype = \"prismatic\"\nbetween = [\"world\", \"b\"]\n"
           "at = [0, 0, 0]\naxis = [1, 0, 0]\nrate = " +
           to_text(rate) +
           "\n[[load]]\nname = \"steady\"\ntype = \"actuator\"\njoint = \"slide\"\nexpression = "
           "\"0.1*slide.displacement\"\n"
           "[[load]]\nname = \"relay\"\ntype = \"actuator\"\njoint = \"slide\"\nexpression = \"" +
           law + "\"\n[time]\nend = " + to_text(end) + "\n" + time;
}

/// The instant at which a motion is told to slide; it is known up to there.
double slides_at(const std::string& text)
{
    const ScenarioResult read = parse_scenario("format = 1\n" + text, "test.toml");
    const Scenario& s = read.scenario.value();
    const Solution solution = solve(s.model, {s.model.start()}, s.time, s.method, s.options);
    EXPECT_EQ(solution.report.status, SolveStatus::not_converged);
    const std::string& message = solution.report.message;
    EXPECT_NE(message.find("sliding mode near t = " + to_text(solution.motion.end(), 6)), std::string::npos)
        << message;
    EXPECT_NE(message.find("at a discontinuity of load 'relay'"), std::string::npos) << message;
    EXPECT_LT(solution.report.n_elements, 2000);
    return solution.motion.end();
}

/// Its elements are as short as they may be from the first one on: none is short beside the others.
TEST(Sliding, FromTheStartIsToldAtOnce)
{
    EXPECT_LT(slides_at(carriage("-10*sign(slide.displacement_rate) + 5", 0, 2, "accuracy = 1e-5\n")), 0.01);
    EXPECT_LT(slides_at(carriage("-400*sign(slide.displacement_rate) + 50*sign(sin(40*t)) + 20", 0, 2,
                                 "accuracy = 1e-5\n")),
              0.01);
    // back from one side nineteen times as fast as from the other
    EXPECT_LT(slides_at(carriage("-10*sign(slide.displacement_rate) + 9", 0, 2, "accuracy = 1e-6\n")), 0.1);
}

TEST(Sliding, OnASurfaceIsToldWhereItIsMet)
{
    // 1 - 20 t + 5 (t - 10 t^2) = 0, but for the tenth of a newton a metre
    const double met = (std::sqrt(425.0) - 15) / 100;
    for (const std::string accuracy : {"1e-4", "1e-7", "1e-10"})
        EXPECT_NEAR(slides_at(carriage("-40*sign(slide.displacement_rate + 5*slide.displacement)", 1, 2,
                                       "accuracy = " + accuracy + "\n")),
                    met, 2e-3);
}

TEST(Sliding, OfOneOfManyBodiesIsTold)
{
    std::string text = carriage("-10*sign(slide.displacement_rate) + 5", 0, 2, "accuracy = 1e-5\n");
    for (int i = 0; i < 20; ++i) {
        const std::string n = std::to_string(i), x = to_text(i + 1.0);
        text += "[[body]]\nname = \"p" + n + "\"\nmass = 1\ninertia = [1, 1, 1]\nposition = [" + x +
                ", 0, 0]\n[[joint]]\nname = \"h" + n + "\"\ntype = \"revolute\"\nbetween = [\"world\", \"p" +
                n + "\"]\nat = [" + x + ", 0, 0.5]\naxis = [0, 1, 0]\nrate = " + to_text(1 + 0.3 * i) + "\n";
    }
    EXPECT_LT(slides_at(text), 0.05);
}

/// The control: 2 v' = 60 sin(20 t) - 3 sign(v) turns back at once wherever it comes to rest.
TEST(Sliding, IsNotTakenForPassing)
{
    const Solved s =
        solved(carriage("60*sin(20*t) - 3*sign(slide.displacement_rate) - 0.1*slide.displacement", 3.1, 20,
                        "accuracy = 1e-8\n"));
    double t = 0, x = 0, v = 3.1, side = 1;
    int passages = 0;
    const auto rate = [&](double at) {
        return v - 1.5 * (std::cos(20 * at) - std::cos(20 * t)) - 1.5 * side * (at - t);
    };
    const auto go = [&](double to) {
        const double h = to - t;
        x += (v + 1.5 * std::cos(20 * t)) * h - 0.075 * (std::sin(20 * to) - std::sin(20 * t)) -
             0.75 * side * h * h;
        v = rate(to);
        t = to;
    };
    while (t < 20) {
        double before = t, behind = t + 1e-9;
        while (behind < 20 && side * rate(behind) > 0) {
            before = behind;
            behind += 1e-3;
        }
        if (side * rate(std::min(behind, 20.0)) > 0) {
            go(20);
            break;
        }
        for (int i = 0; i < 60; ++i) {
            const double middle = 0.5 * (before + behind);
            (side * rate(middle) > 0 ? before : behind) = middle;
        }
        go(behind);
        v = 0;
        side = -side;
        ++passages;
    }
    EXPECT_GT(passages, 100);
    EXPECT_NEAR(s.coordinate("slide", "displacement", 20).value, x, 1e-7);
}

}   // namespace
}   // namespace livens::tests::sliding_test
