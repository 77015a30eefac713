// SPDX-License-Identifier: BSD-3-Clause
// What laws do inside of elements: steep, narrow, at rest on a sharp law, knots, reversals, grazes. The truth
// is a quadrature or DOP853 with steps far below what is narrow.
#include <cmath>

#include "livens/base/text.h"
#include "reference/solved.h"

namespace livens::tests::inside_test {
namespace {

struct Tried {
    Solution solution;
    double error = 0;   // of the last place, in lengths of the model or rad

    bool converged() const { return solution.report.converged(); }
    double told() const { return solution.estimate.largest; }
};

std::string wheel(const std::string& start, const std::string& loads)
{
    return "gravity = [0, 0, 0]\n[[body]]\nname = \"wheel\"\nmass = 1\ninertia = [1, 1, 1]\n[[joint]]\n"
           "name = \"shaft\"\ntype = \"revolute\"\nbetween = [\"world\", \"wheel\"]\nat = [0, 0, 0]\naxis = "
           "[0, 0, 1]\n" +
           start + loads;
}

std::string torque(const std::string& expression)
{
    std::string inputs;
    if (expression.find('q') != std::string::npos) inputs = "q = \"shaft.angle\"";
    if (expression.find('w') != std::string::npos)
        inputs += std::string(inputs.empty() ? "" : ", ") + "w = \"shaft.angle_rate\"";
    return "[[load]]\nname = \"law\"\ntype = \"actuator\"\njoint = \"shaft\"\ninputs = { " + inputs +
           " }\nexpression = \"" + expression + "\"\n";
}

/// A mass on a slide along x, which begins at `x` with the velocity `v`.
std::string slider(double x, double v, const std::string& loads)
{
    return "gravity = [0, 0, 0]\n[[body]]\nname = \"m\"\nmass = 1\ninertia = [0.01, 0.01, 0.01]\nvelocity = "
           "[" +
           to_text(v) +
           ", 0, 0]\n[[joint]]\nname = \"p\"\ntype = \"prismatic\"\nbetween = [\"world\", \"m\"]"
           "\nat = [0, 0, 0]\naxis = [1, 0, 0]\ncoordinate = " +
           to_text(x) + "\n" + loads;
}

std::string force(const std::string& expression)
{
    const std::string rate = expression.find('v') == std::string::npos ? "" : ", v = \"p.displacement_rate\"";
    return "[[load]]\nname = \"law\"\ntype = \"actuator\"\njoint = \"p\"\ninputs = { x = \"p.displacement\"" +
           rate + " }\nexpression = \"" + expression + "\"\n";
}

Tried run(const std::string& scenario, const std::string& time, double truth, bool looks = true)
{
    const ScenarioResult read = parse_scenario("format = 1\n" + scenario + "[time]\n" + time, "test.toml");
    for (const Diagnostic& d : read.diagnostics)
        if (d.severity == Severity::error) ADD_FAILURE() << d.message;
    const Scenario& s = read.scenario.value();
    SolveOptions options = s.options;
    options.look_at_laws = options.end_at_bends = looks;
    Tried run{solve(s.model, {s.model.start()}, s.time, s.method, options)};
    const JointCoordinates all(s.model, run.solution.motion);
    const double end = run.solution.motion.end();
    run.error = std::abs(all.at(end)[0].value - truth) /
                (all.coordinate(0).coordinate.is_angle() ? 1 : s.model.length());
    return run;
}

struct Case {
    const char* name;
    std::string scenario, end;
    double accuracy, truth;
};

std::vector<Case> cases()
{
    const std::string spline =
        "[[load]]\ntype = \"spring\"\njoint = \"p\"\nlaw = \"table\"\ntable = { elongations = [-0.63, -0.55, "
        "-0.47, 0.49], forces = [-31.2, -24.2, -10.9, 10.6], interpolation = \"spline\" }\n";
    const std::string drag = force("-12.9*x") + "[[load]]\ntype = \"drag\"\nbody = \"m\"\nquadratic = 2.93\n";
    return {
        {"a narrow pulse of an angle", wheel("rate = 5\n", torque("100*exp(-((q-2)/0.01)^2)")), "end = 3\n",
         1e-6, 15.8911601972},
        {"dry friction by a smooth sign, from rest", wheel("", torque("20 - 5*tanh(3000*w)")), "end = 0.5\n",
         1e-8, 1.875032694},
        {"the same beside a spring, driven",
         slider(0.46, -1.25, force("-35.7*x - 5.5*tanh(251.0*v) + 15.5*sin(5.2*t)")), "end = 2.3\n", 1e-5,
         -1.3743235695319},
        {"a smooth sign of a place", slider(-0.2, -1.07, force("-48.6*x - 4.6*tanh(3676.0*x)")),
         "end = 2.8\n", 1e-5, 0.058117073382},
        {"quadratic drag that reverses", slider(0.22, -1.27, drag), "end = 1.3\n", 1e-8, 0.075527249067},
        {"knots of a spline over elongation", slider(0, 6, spline), "end = 2.2\n", 1e-7, -1.167092953755},
    };
}

/// w' = 20 - 5 tanh(s w) from rest: behind the layer w = 15 (t + c/s), q = w^2/30 - d/s^2, by quadrature over
/// y = s w of 1/15 - 1/(20 - 5 tanh y) for c, and of y times that for d. First elements are a thousand times
/// as long as the layer or as long as it, as the accuracy wants: what load points take of it is anything.
TEST(Inside, LayersOfAnyWidthAreInTheEstimate)
{
    constexpr double c = 0.01307772337349, d = 0.008315332011677, end = 0.5;
    for (const double steepness : {300.0, 1000.0, 2000.0, 3000.0, 4500.0, 8000.0, 30000.0})
        for (const double accuracy : {1e-3, 1e-4, 1e-5, 1e-6}) {
            const double w = 15 * (end + c / steepness), q = w * w / 30 - d / (steepness * steepness);
            const Tried r = run(wheel("", torque("20 - 5*tanh(" + to_text(steepness) + "*w)")),
                                "end = 0.5\naccuracy = " + to_text(accuracy) + "\n", q);
            EXPECT_TRUE(r.converged()) << steepness << ": " << r.solution.report.message;
            EXPECT_LT(r.error, accuracy) << steepness;
            EXPECT_LT(r.error, 3 * r.told() + 1e-9) << steepness << ", " << accuracy;
        }
}

/// Families without looks of their own have a witness that looks. By half their steps the rules told a tenth
/// of what they are off by: both miss the layer.
TEST(Inside, OtherFamiliesKnowHowFarTheyAreOff)
{
    constexpr double c = 0.01307772337349, d = 0.008315332011677, end = 0.5, steepness = 3000;
    const double w = 15 * (end + c / steepness), q = w * w / 30 - d / (steepness * steepness);
    for (const char* family : {"midpoint", "endpoint", "mixed"})
        for (const int elements : {400, 500, 1000}) {
            const Tried r = run(wheel("", torque("20 - 5*tanh(3000*w)")),
                                "end = 0.5\nelements = " + std::to_string(elements) +
                                    "\n[method]\nfamily = \"" + family + "\"\n",
                                q);
            EXPECT_TRUE(r.converged()) << family << ": " << r.solution.report.message;
            EXPECT_GT(r.error, 1e-5) << family << " " << elements;
            EXPECT_LT(r.error, 1.2 * r.told()) << family << " " << elements;
            EXPECT_LT(r.told(), 3 * r.error) << family << " " << elements;
        }
}

TEST(Inside, LawsAreFollowedToTheAccuracyThatIsTold)
{
    for (const Case& c : cases()) {
        const Tried r = run(c.scenario, c.end + "accuracy = " + to_text(c.accuracy) + "\n", c.truth);
        EXPECT_TRUE(r.converged()) << c.name << ": " << r.solution.report.message;
        EXPECT_LT(r.error, c.accuracy) << c.name;
        EXPECT_LT(r.error, 3 * r.told() + 1e-9) << c.name;
    }
}

/// The control: taken for smooth they are as wrong as can be, and nobody says so.
TEST(Inside, WithoutLooksTheyAreWrongAndSayThatTheyAreNot)
{
    int n_wrong = 0;   // on which meshes is a matter of luck, not that it happens
    for (const Case& c : cases())
        for (const double accuracy : {1e-4, 1e-5, 1e-6, 1e-7}) {
            const Tried r = run(c.scenario, c.end + "accuracy = " + to_text(accuracy) + "\n", c.truth, false);
            n_wrong += r.converged() && r.error > 3 * std::max(accuracy, r.told()) ? 1 : 0;
        }
    EXPECT_GE(n_wrong, 4);
}

/// On elements that are stated the second solution misses a pulse as the first does: what it cannot have seen
/// is in the estimate, with the name of the load.
TEST(Inside, WhatStatedElementsDoNotSeeIsInTheEstimate)
{
    int n_suspect = 0, n_named = 0;
    for (const double width : {0.1, 0.03, 0.01, 0.003, 0.001}) {
        const double kick = 100 * width * std::sqrt(std::acos(-1.0)), after = std::sqrt(25 + 2 * kick);
        const double truth = 2 + after * (3 - 0.4);   // but for the way inside of the pulse
        for (const int elements : {9, 20, 60}) {
            const std::string time = "end = 3\nelements = " + std::to_string(elements) + "\n";
            const std::string pulse = torque("100*exp(-((q-2)/" + to_text(width) + ")^2)");
            const Tried r = run(wheel("rate = 5\n", pulse), time, truth);
            EXPECT_LT(r.error, 4 * r.told() + 2 * width) << width << " " << elements;
            if (r.converged()) continue;
            ++n_suspect;
            n_named += r.solution.report.message.find("'law'") != std::string::npos ? 1 : 0;
        }
    }
    EXPECT_GT(n_suspect, 2);
    EXPECT_GT(2 * n_named, n_suspect) << n_suspect;
}

/// A one-sided spring is touched less and less: no touch is missed whatever the looks meet.
TEST(Inside, GrazedStopsAreTouched)
{
    const double k = 1e5;
    for (const double depth : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
        // x'' = -9 (x - stop) .. an oscillation of amplitude 1 about 0 that reaches `depth` beyond the stop
        const double stop = 1 - depth, w = 3;
        const std::string law = force("-9*x - 1e5*max(0, x - " + to_text(stop) + ")");
        const double W = std::sqrt(w * w + k), c = k * stop / (W * W);
        const double t_in = std::acos(stop) / w, v_in = w * std::sin(w * t_in);   // of x = cos(w t)
        const double first = std::acos(-1.0) / w - t_in;                          // from x = -1 to the stop
        // in the stop x - c = A cos(W t) + B sin(W t), until it is back
        const double A = stop - c, B = v_in / W, back = 2 * std::atan2(B, A) / W;
        const double end = 2.5, after = end - first - back;
        // x = stop cos(w t) - v_in / w sin(w t)
        const double truth = stop * std::cos(w * after) - v_in / w * std::sin(w * after);
        const Tried r = run(slider(-1, 0, law), "end = 2.5\naccuracy = 1e-9\n", truth);
        EXPECT_TRUE(r.converged()) << depth << " " << r.solution.report.message;
        EXPECT_LT(r.error, 3e-9) << depth;
    }
}

/// A force that jumps where the motion decides: the second solution has instants of its own, so that errors
/// of instants are in the estimate.
TEST(Inside, InstantsOfJumpsAreInTheEstimate)
{
    const std::string rod =
        "gravity = [0, 0, -9.81]\nbody = [{ name = \"rod\", shape = { box = [0.05, 0.05, 1] }, mass = 2, "
        "position = [0, 0, -0.5] }]\n[[joint]]\nname = \"pin\"\ntype = \"revolute\"\nbetween = [\"world\", "
        "\"rod\"]\nat = [0, 0, 0]\naxis = [0, 1, 0]\n[start]\ncoordinates = [{ joint = \"pin\", value = -1.1 "
        "}]\n[[load]]\nname = \"stop\"\ntype = \"actuator\"\njoint = \"pin\"\ninputs = { q = \"pin.angle\" "
        "}\nexpression = \"-6*q/abs(q)\"\n";
    const Tried fine = run(rod, "end = 5\nelements = 400\n[method]\ndegree = 10\n", 0);
    const double truth =
        JointCoordinates(
            parse_scenario("format = 1\n" + rod + "[time]\nend = 5\n", "t").scenario.value().model,
            fine.solution.motion)
            .at(5)[0]
            .value;
    for (const int degree : {2, 3, 4, 5})
        for (const int elements : {60, 80, 110}) {
            const std::string time = "end = 5\nelements = " + std::to_string(elements) +
                                     "\n[method]\ndegree = " + std::to_string(degree) + "\n";
            const Tried r = run(rod, time, truth);
            EXPECT_LT(r.error, 1.5 * r.told() + 1e-12) << degree << " " << elements;
        }
}

/// A spring with a free length whose mass goes straight through its anchor: the force turns round there.
TEST(Inside, SpringsThroughTheirAnchorTurnRound)
{
    const double w = 2, free_length = 0.5;
    // from x = 1 with -4: x'' = -4 (x - 1/2), then -4 (x + 1/2)
    const double A = 1 - free_length, B = -4 / w;
    double t = 0.2;
    for (int i = 0; i < 50; ++i) {
        const double x = free_length + A * std::cos(w * t) + B * std::sin(w * t);
        t -= x / (w * (B * std::cos(w * t) - A * std::sin(w * t)));
    }
    const double v = w * (B * std::cos(w * t) - A * std::sin(w * t)), rest = 0.5 - t;
    const double truth = -free_length + free_length * std::cos(w * rest) + v / w * std::sin(w * rest);
    const std::string spring =
        "[[load]]\ntype = \"spring\"\nbetween = [\"world\", \"m\"]\npoints = [[0, 0, 0], "
        "[0, 0, 0]]\nstiffness = 4\nfree_length = 0.5\n";
    const Tried r = run("gravity = [0, 0, 0]\n[[body]]\nname = \"m\"\nmass = 1\ninertia = [0.01, 0.01, "
                        "0.01]\nposition = [1, 0, 0]\nvelocity = [-4, 0, 0]\n[[joint]]\nname = \"p\"\ntype = "
                        "\"prismatic\"\nbetween = [\"world\", \"m\"]\nat = [0, 0, 0]\naxis = [1, 0, "
                        "0]\ncoordinate = 1\n" +
                            spring,
                        "end = 0.5\naccuracy = 1e-9\n", truth);
    EXPECT_TRUE(r.converged()) << r.solution.report.message;
    EXPECT_LT(r.error, 1e-9);
}

}   // namespace
}   // namespace livens::tests::inside_test
