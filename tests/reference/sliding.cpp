// SPDX-License-Identifier: BSD-3-Clause
// Motions that slide along a discontinuity of a load, and such as pass one many times.
#include <cmath>
#include <string>

#include "livens/base/text.h"
#include "reference/solved.h"

namespace livens::tests::sliding_test {
namespace {

/// A carriage of 2 kg on a rail, from x = 0, under a law of x, its rate v and t.
std::string carriage(const std::string& law, double rate, double end, const std::string& time)
{
    std::string inputs;
    if (law.find('x') != std::string::npos) inputs += "x = \"slide.displacement\"";
    if (law.find('v') != std::string::npos)
        inputs += (inputs.empty() ? "" : ", ") + std::string("v = \"slide.displacement_rate\"");
    return "[[body]]\nname = \"b\"\nmass = 2\ninertia = [1, 1, 1]\nposition = [0, 0, 0]\n"
           "[[joint]]\nname = \"slide\"\ntype = \"prismatic\"\nbetween = [\"world\", \"b\"]\n"
           "at = [0, 0, 0]\naxis = [1, 0, 0]\nrate = " +
           to_text(rate) +
           "\n[[load]]\nname = \"steady\"\ntype = \"actuator\"\njoint = \"slide\"\nexpression = "
           "\"0.1*slide.displacement\"\n"
           "[[load]]\nname = \"relay\"\ntype = \"actuator\"\njoint = \"slide\"\ninputs = { " +
           inputs + " }\nexpression = \"" + law + "\"\n[time]\nend = " + to_text(end) + "\n" + time;
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
    EXPECT_LT(solution.report.n_elements, 100);
    return solution.motion.end();
}

/// No element has a solution on one side, however short it is.
TEST(Sliding, FromTheStartIsToldThere)
{
    for (const std::string law :
         {"-10*sign(v) + 5", "-10*sign(v) + 9.99", "-400*sign(v) + 50*sign(sin(40*t)) + 20"})
        EXPECT_EQ(slides_at(carriage(law, 0, 2, "accuracy = 1e-5\n")), 0) << law;
    // which would be over after 5 ms, and within the accuracy of places
    EXPECT_EQ(slides_at(carriage("-10*sign(v) + 9 + 200*t", 0, 2, "accuracy = 1e-3\n")), 0);
}

TEST(Sliding, OnASurfaceIsToldWhereItIsMet)
{
    // 1 - 20 t + 5 (t - 10 t^2) = 0, but for the tenth of a newton a metre
    const double met = (std::sqrt(425.0) - 15) / 100;
    for (const std::string accuracy : {"1e-4", "1e-7", "1e-10"})
        EXPECT_NEAR(slides_at(carriage("-40*sign(v + 5*x)", 1, 2, "accuracy = " + accuracy + "\n")), met,
                    1e-5);
}

/// Held for 5 ms on its way: v = 1.56 - 25 t + 100 t^2 is zero at 0.12 s, when 8 N push.
TEST(Sliding, ForAShortTimeIsToldToo)
{
    for (const std::string accuracy : {"1e-3", "1e-6", "1e-9"})
        EXPECT_NEAR(slides_at(carriage("-10*sign(v) + 400*(t - 0.1) - 0.1*x", 1.56, 2,
                                       "accuracy = " + accuracy + "\n")),
                    0.12, 1e-8);
}

TEST(Sliding, OfOneOfManyBodiesIsTold)
{
    std::string text = carriage("-10*sign(v) + 5", 0, 2, "accuracy = 1e-5\n");
    for (int i = 0; i < 20; ++i) {
        const std::string n = std::to_string(i), x = to_text(i + 1.0);
        text += "[[body]]\nname = \"p" + n + "\"\nmass = 1\ninertia = [1, 1, 1]\nposition = [" + x +
                ", 0, 0]\n[[joint]]\nname = \"h" + n + "\"\ntype = \"revolute\"\nbetween = [\"world\", \"p" +
                n + "\"]\nat = [" + x + ", 0, 0.5]\naxis = [0, 1, 0]\nrate = " + to_text(1 + 0.3 * i) + "\n";
    }
    EXPECT_EQ(slides_at(text), 0);
}

/// Arms whose hinges are at right angles, turned by 30 degrees: the lower one swings, the upper one rests but
/// for rounding, which is on one side of a kink and on the other.
std::string crossed(const std::string& law)
{
    const std::string c = to_text(std::sqrt(0.75), 17), s = to_text(0.5);
    return "gravity = [0, 0, -9.81]\n"
           "[[body]]\nname = \"a\"\nshape = { sphere = 0.1 }\nmass = 1\nposition = [0, 0, -0.5]\n"
           "[[body]]\nname = \"b\"\nshape = { sphere = 0.1 }\nmass = 1\nposition = [" +
           to_text(0.4 * std::sqrt(0.75), 17) +
           ", 0.2, -1.3]\n"
           "[[joint]]\nname = \"ja\"\ntype = \"revolute\"\nbetween = [\"world\", \"a\"]\nat = [0, 0, "
           "0]\naxis = [" +
           c + ", " + s +
           ", 0]\n"
           "[[joint]]\nname = \"jb\"\ntype = \"revolute\"\nbetween = [\"a\", \"b\"]\nat = [0, 0, -0.5]\naxis "
           "= [-" +
           s + ", " + c + ", 0]\nrate = 1.7\n" + law + "[time]\nend = 3\naccuracy = 1e-9\n";
}

TEST(Sliding, RestsAtAKinkThatRoundingPasses)
{
    const auto on_hinge = [](const std::string& law) {
        return "[[load]]\nname = \"law\"\ntype = \"actuator\"\njoint = \"ja\"\nexpression = \"" + law +
               "\"\n";
    };
    const Solved bare = solved(crossed(""));
    for (const std::string law :
         {"-5*max(0, ja.angle_rate)", "-5*max(0, ja.angle_rate) - 20*min(0, ja.angle_rate)",
          "-5*ja.angle_rate*abs(ja.angle)"}) {
        const Solved s = solved(crossed(on_hinge(law)));
        EXPECT_LT(s.solution.motion.n_elements(), 1.5 * bare.solution.motion.n_elements()) << law;
        EXPECT_NEAR(s.coordinate("jb", "angle", 3).value, bare.coordinate("jb", "angle", 3).value, 2e-9)
            << law;
        EXPECT_NEAR(s.coordinate("ja", "angle", 3).value, 0, 1e-12) << law;
    }
    // what jumps there holds it, and nobody knows by how much
    const ScenarioResult read =
        parse_scenario("format = 1\n" + crossed(on_hinge("-5*sign(ja.angle_rate)")), "test.toml");
    const Scenario& s = read.scenario.value();
    EXPECT_EQ(solve(s.model, {s.model.start()}, s.time, s.method, s.options).report.status,
              SolveStatus::not_converged);
}

/// Friction of a vector has no side to be on: what it brings to rest goes on about it in ever so many
/// elements.
TEST(Sliding, FrictionInAPlaneIsToldWhereItBringsToRest)
{
    const ScenarioResult read = parse_scenario(R"toml(format = 1
[[body]]
name = "puck"
shape = { box = [0.2, 0.1, 0.1] }
mass = 2
position = [0, 0, 0]
velocity = [1.2, 0.5, 0]
[[joint]]
name = "table"
type = "planar"
between = ["world", "puck"]
at = [0, 0, 0]
axis = [0, 0, 1]
[[sensor]]
name = "s"
type = "point"
body = "puck"
[[load]]
name = "friction"
type = "force"
body = "puck"
inputs = { x = "s.vx", y = "s.vy" }
expression = ["-6*x/sqrt(x^2+y^2)", "-6*y/sqrt(x^2+y^2)", "0"]
[time]
end = 2
accuracy = 1e-4
)toml",
                                               "test.toml");
    const Scenario& s = read.scenario.value();
    const Solution solution = solve(s.model, {s.model.start()}, s.time, s.method, s.options);
    EXPECT_EQ(solution.report.status, SolveStatus::not_converged);
    const std::string& message = solution.report.message;
    EXPECT_NE(message.find("the law of load 'friction' changes within any longer one"), std::string::npos)
        << message;
    EXPECT_NEAR(solution.motion.end(), 1.3 / 3, 0.03);
}

/// The control: 2 v' = 60 sin(20 t) - 3 sign(v) turns back at once wherever it comes to rest.
TEST(Sliding, IsNotTakenForPassing)
{
    const Solved s = solved(carriage("60*sin(20*t) - 3*sign(v) - 0.1*x", 3.1, 20, "accuracy = 1e-8\n"));
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
