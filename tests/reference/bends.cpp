// SPDX-License-Identifier: BSD-3-Clause
// Laws that bend or jump where the motion decides, against solutions piece by piece.
#include <cmath>
#include <functional>
#include <random>

#include "livens/base/text.h"
#include "reference/solved.h"

namespace livens::tests::bends_test {
namespace {

using Real = long double;

/// x'' = pull - stiffness x - damping x' on a piece: by mass.
struct Piece {
    Real pull = 0, stiffness = 0, damping = 0;
};

struct State1 {
    Real x = 0, v = 0;
};

/// By the Taylor series of a linear equation, whose terms follow from each other.
State1 after(const Piece& piece, const State1& s, Real h)
{
    Real x = s.x, v = s.v, power = 1;
    Real derivative[2] = {s.v, piece.pull - piece.stiffness * s.x - piece.damping * s.v};
    for (int n = 1; n < 30; ++n) {
        power *= h / n;
        x += derivative[0] * power;
        v += derivative[1] * power;
        const Real next = -piece.stiffness * derivative[0] - piece.damping * derivative[1];
        derivative[0] = derivative[1];
        derivative[1] = next;
    }
    return {x, v};
}

struct Oscillator {
    std::string load;
    std::function<int(const State1&)> piece_at;
    std::vector<Piece> pieces;
    double x = 0, v = 0, end = 0;

    /// Steps of 0.2 ms; one in which the piece changes is divided where it does, to the last digit.
    State1 at_end() const
    {
        constexpr Real step = 2e-4L;
        State1 s{x, v};
        int piece = piece_at(s);
        for (Real t = 0; t < end;) {
            Real h = std::min(step, end - t);
            State1 next = after(pieces[piece], s, h);
            if (piece_at(next) != piece) {
                Real before = 0;
                for (int i = 0; i < 80; ++i) {
                    const Real middle = 0.5L * (before + h);
                    const bool is_same = piece_at(after(pieces[piece], s, middle)) == piece;
                    (is_same ? before : h) = middle;
                }
                next = after(pieces[piece], s, h);
                piece = piece_at(next);
            }
            s = next;
            t += h;
        }
        return s;
    }

    std::string scenario(const std::string& time) const
    {
        return "[[body]]\nname = \"b\"\nmass = 2\ninertia = [1, 1, 1]\nposition = [0, 0, 0]\n"
               "[[joint]]\nname = \"slide\"\ntype = \"prismatic\"\nbetween = [\"world\", \"b\"]\n"
               "at = [0, 0, 0]\naxis = [1, 0, 0]\n[start]\ncoordinates = [{ joint = \"slide\", coordinate = "
               "\"displacement\", value = " +
               to_text(x) + ", rate = " + to_text(v) + " }]\n" + load + "[time]\nend = " + to_text(end) +
               "\n" + time;
    }
};

constexpr double mass = 2;

std::string actuator(const std::string& expression)
{
    const std::string rate =
        expression.find('v') == std::string::npos ? "" : ", v = \"slide.displacement_rate\"";
    return "[[load]]\ntype = \"actuator\"\njoint = \"slide\"\ninputs = { x = \"slide.displacement\"" + rate +
           " }\nexpression = \"" + expression + "\"\n";
}

/// One of each kind in turn, with data that are rounded so that texts hold them.
class Oscillators {
public:
    explicit Oscillators(unsigned seed) : random_(seed) {}

    Oscillator next(int kind)
    {
        Oscillator o;
        const double k = any(1, 30), c = any(0.5, 20), at = any(-0.4, 0.4);
        const std::string by_k = "-" + to_text(k) + "*x";
        switch (kind) {
        case 0: {   // a stop
            const double stop = std::round(std::pow(10, any(1, 4)));
            o.load = actuator(by_k + " - " + to_text(stop) + "*max(0, x - (" + to_text(at) + "))");
            o.piece_at = [at](const State1& s) { return s.x > at ? 1 : 0; };
            o.pieces = {{0, k, 0}, {stop * at, k + stop, 0}};
            break;
        }
        case 1:   // a damper of one direction
            o.load = actuator(by_k + " - " + to_text(c) + "*max(0, v)");
            o.piece_at = [](const State1& s) { return s.v > 0 ? 1 : 0; };
            o.pieces = {{0, k, 0}, {0, k, c}};
            break;
        case 2:   // a force that jumps
            o.load = actuator(by_k + " - " + to_text(c) + "*x/abs(x)");
            o.piece_at = [](const State1& s) { return s.x > 0 ? 1 : 0; };
            o.pieces = {{c, k, 0}, {-c, k, 0}};
            break;
        case 3: {   // a saturated spring
            const double most = any(0.5, 4);
            o.load = actuator("min(" + to_text(most) + ", max(-" + to_text(most) + ", " + by_k + "))");
            o.piece_at = [=](const State1& s) { return k * s.x > most ? 2 : k * s.x < -most ? 0 : 1; };
            o.pieces = {{most, 0, 0}, {0, k, 0}, {-most, 0, 0}};
            break;
        }
        default: {   // a table of three lines through the origin
            const double a = any(-0.4, -0.1), b = any(0.1, 0.4), left = any(1, 600), right = any(1, 600);
            const double f_a = k * a, f_b = k * b;
            o.load =
                "[[load]]\ntype = \"spring\"\njoint = \"slide\"\nlaw = \"table\"\ntable = { elongations = [" +
                to_text(a - 1) + ", " + to_text(a) + ", " + to_text(b) + ", " + to_text(b + 1) +
                "], forces = [" + to_text(f_a - left) + ", " + to_text(f_a) + ", " + to_text(f_b) + ", " +
                to_text(f_b + right) + "] }\n";
            o.piece_at = [=](const State1& s) { return s.x > b ? 2 : s.x < a ? 0 : 1; };
            o.pieces = {{left * a - f_a, left, 0}, {0, k, 0}, {right * b - f_b, right, 0}};
        }
        }
        for (Piece& piece : o.pieces)
            piece = {piece.pull / mass, piece.stiffness / mass, piece.damping / mass};
        o.x = any(0.01, 1) * (any(-1, 1) < 0 ? -1 : 1);   // not where a force jumps
        o.v = any(-3, 3);
        o.end = any(2, 8);
        return o;
    }

private:
    double any(double from, double until)
    {
        return std::round(1000 * std::uniform_real_distribution<double>(from, until)(random_)) / 1000;
    }

    std::mt19937 random_;
};

constexpr int n_kinds = 5;

struct Seen {
    SolveStatus status;
    double error, estimate;
};

Seen seen(const Oscillator& o, const std::string& time, bool end_at_bends = true)
{
    const ScenarioResult read = parse_scenario("format = 1\n" + o.scenario(time), "test.toml");
    for (const Diagnostic& d : read.diagnostics) EXPECT_EQ(d.message, "");
    const Scenario& s = read.scenario.value();
    SolveOptions options = s.options;
    options.end_at_bends = options.look_at_laws = end_at_bends;
    const Solution solution = solve(s.model, {s.model.start()}, s.time, s.method, options);
    const double x = solution.motion.at_end(solution.motion.n_elements()).X[0](0, 0);
    return {solution.report.status, static_cast<double>(std::abs(x - o.at_end().x)) / s.model.length(),
            solution.estimate.largest};
}

/// Twelve of each kind to five accuracies: all are reached, and hold.
TEST(Bends, AnyAccuracyIsReached)
{
    Oscillators oscillators(11);
    for (int i = 0; i < 12 * n_kinds; ++i) {
        const Oscillator o = oscillators.next(i % n_kinds);
        for (const double accuracy : {1e-3, 1e-4, 1e-6, 1e-8, 1e-10}) {
            const Seen s = seen(o, "accuracy = " + to_text(accuracy) + "\n");
            EXPECT_EQ(s.status, SolveStatus::converged) << o.scenario("") << accuracy;
            EXPECT_LT(s.error, accuracy) << o.scenario("") << accuracy;
        }
    }
}

/// On stated elements what is good is off by no more than ten estimates, and short elements of a high degree
/// have all digits.
TEST(Bends, OnStatedElementsTheEstimateHolds)
{
    Oscillators oscillators(12);
    for (int i = 0; i < 8 * n_kinds; ++i) {
        const Oscillator o = oscillators.next(i % n_kinds);
        for (const char* elements : {"elements = 15\n", "elements = 40\n"}) {
            const Seen s = seen(o, elements);
            if (s.status == SolveStatus::converged) {
                EXPECT_LT(s.error, 10 * s.estimate + 1e-9) << o.scenario(elements);
            }
        }
        EXPECT_LT(seen(o, "elements = 400\n[method]\ndegree = 8\n").error, 1e-11) << o.scenario("");
    }
}

/// What is true of a motion between two places: the rate at the start that leads from one to the other, by
/// the secant through motions that leave beside the one that was found.
struct Between {
    SolveStatus status;
    double error, estimate;   // of the place in the middle
};

Between between(Oscillator o, const std::string& time, bool end_at_bends = true)
{
    constexpr double duration = 0.8;
    o.end = duration;
    const double target = static_cast<double>(o.at_end().x);
    const auto known = [](double x) {
        return "known = { \"slide.displacement\" = " + to_text(x) + " }\n";
    };
    std::string text = "format = 1\n" + o.scenario(time);
    const std::size_t start = text.find("[start]"), load = text.find("[[load]]");
    text.replace(start, load - start,
                 "[start]\ncoordinates = [{ joint = \"slide\", value = " + to_text(o.x) + " }]\n" + known(o.x) +
                     "[end]\n" + known(target));
    const ScenarioResult read = parse_scenario(text, "test.toml");
    for (const Diagnostic& d : read.diagnostics) EXPECT_EQ(d.message, "");
    const Scenario& s = read.scenario.value();
    SolveOptions options = s.options;
    options.end_at_bends = options.look_at_laws = end_at_bends;
    const Solution solution = solve(s.model, {s.conditions}, s.time, s.method, options);
    if (!solution.report.reached_end()) return {solution.report.status, 0, 0};
    Real v = solution.motion.at_end(0).V[0](0, 0);
    const auto missed = [&](Real rate) {
        Oscillator other = o;
        other.v = static_cast<double>(rate);
        return other.at_end().x - target;
    };
    for (int i = 0; i < 4; ++i) {
        const Real off = missed(v), step = 1e-5L;
        v -= off * step / (missed(v + step) - off);
    }
    o.v = static_cast<double>(v);
    o.end = 0.5 * duration;
    const double x = solution.motion.at(o.end).X[0](0, 0);
    return {solution.report.status, static_cast<double>(std::abs(x - o.at_end().x)) / s.model.length(),
            solution.estimate.largest};
}

/// Elements that are solved together end there in further tries; those that step over bends are the control.
/// Where tries do not settle the motion is suspect.
TEST(Bends, BetweenBothEndsTheEstimateHolds)
{
    Oscillators oscillators(14);
    int n_good = 0, n_farther = 0;
    for (int i = 0; i < 4 * n_kinds; ++i) {
        const Oscillator o = oscillators.next(i % n_kinds);
        for (const char* elements : {"elements = 10\n", "elements = 40\n"}) {
            const Between b = between(o, elements), over = between(o, elements, false);
            if (b.status == SolveStatus::converged) {
                ++n_good;
                EXPECT_LT(b.error, 5 * b.estimate + 1e-12) << o.scenario(elements);
                EXPECT_LT(b.error, 1e-5) << o.scenario(elements);
                n_farther += over.error > 1e-5;
            }
        }
    }
    EXPECT_GT(n_good, 34) << "of 40";
    EXPECT_GT(n_farther, 20);
}

/// Likewise with radau, but for forces that jump: its last load point lies at the bend, which the second
/// solution may pass there, so that some are refused.
TEST(Bends, ElementsOfRadauEndThere)
{
    Oscillators oscillators(13);
    for (int i = 0; i < 2 * n_kinds; ++i) {
        const Oscillator o = oscillators.next(i % n_kinds);
        const Seen s = seen(o, "accuracy = 1e-8\n[method]\nfamily = \"radau\"\n");
        const bool is_refused = s.status == SolveStatus::inaccurate && i % n_kinds == 2;
        EXPECT_TRUE(is_refused || s.status == SolveStatus::converged) << o.scenario("");
        EXPECT_LT(is_refused ? 0 : s.error, 1e-8) << o.scenario("");
    }
}

/// Elements that step over bends are wrong by more than they say, or refused: what the tests above would
/// miss.
TEST(Bends, ElementsThatStepOverThemAreSeenToBeWrong)
{
    Oscillators oscillators(11);
    int n_refused = 0, n_wrong = 0;
    for (int i = 0; i < 12 * n_kinds; ++i) {
        const Oscillator o = oscillators.next(i % n_kinds);
        for (const double accuracy : {1e-4, 1e-8}) {
            const Seen s = seen(o, "accuracy = " + to_text(accuracy) + "\n", false);
            if (s.status != SolveStatus::converged)
                ++n_refused;
            else if (s.error > accuracy)
                ++n_wrong;
        }
    }
    EXPECT_GT(n_refused + n_wrong, 40) << "of 120";
    EXPECT_GT(n_wrong, 2);
    RecordProperty("refused", n_refused);
    RecordProperty("wrong", n_wrong);
}

/// Two bodies between stops, one of them of two bends: an end that is found by an element which is refused
/// afterwards is found anew by the next. The angle is that of 600 elements of degree 8.
TEST(Bends, EndsAreFoundAnewByShorterElements)
{
    const Solved s = solved(R"toml(
gravity = [0, 0, -9.81]
[[body]]
name = "a"
shape = { box = [1, 0.1, 0.1] }
mass = 0.86
position = [0.5, 0, 0]
[[body]]
name = "b"
shape = { box = [1, 0.1, 0.1] }
mass = 0.66
position = [1.5, 0, 0]
[[joint]]
name = "j"
type = "revolute"
between = ["world", "a"]
at = [0, 0, 0]
axis = [0, 1, 0]
rate = -1.19
[[joint]]
name = "k"
type = "revolute"
between = ["a", "b"]
at = [1, 0, 0]
axis = [0, 1, 0]
rate = 0.62
[[load]]
type = "spring"
joint = "k"
law = "table"
table = { elongations = [-2, -1, 0.71, 3], forces = [-47.4, 0, 0, 41.7] }
[[load]]
type = "actuator"
joint = "j"
inputs = { q = "j.angle", v = "j.angle_rate" }
expression = "-1112.5*max(0, q - 1.03) - 1.02*max(0, -v)"
[time]
end = 3
accuracy = 1e-10
)toml");
    EXPECT_NEAR(s.coordinate("k", "angle", 3).value, 1.950857204111968, 3e-10);
}

/// Dry friction that stops what it brakes: no law says what it holds then, and elements would vanish.
TEST(Bends, WhatRestsOnAJumpIsRefusedByName)
{
    const std::string text =
        "format = 1\n" +
        Oscillator{actuator("-40*x - 12*v/abs(v)"), nullptr, {}, 0.5, 0.1, 6}.scenario("accuracy = 1e-6\n");
    const ScenarioResult read = parse_scenario(text, "test.toml");
    const Scenario& s = read.scenario.value();
    const Solution solution = solve(s.model, {s.model.start()}, s.time, s.method, s.options);
    EXPECT_EQ(solution.report.status, SolveStatus::not_converged);
    EXPECT_NE(solution.report.message.find("at a discontinuity of load 'actuator on slide'"), std::string::npos)
        << solution.report.message;
    EXPECT_LT(solution.report.n_elements, 5000);
}

/// What comes to rest at a bend does not: its elements grow.
TEST(Bends, WhatRestsOnAStopIsSolved)
{
    const std::string text =
        "format = 1\n" +
        Oscillator{actuator("-5 + 400*max(0, 0 - x) - 30*v"), nullptr, {}, 0.5, 0.1, 20}.scenario(
            "accuracy = 1e-8\n");
    const ScenarioResult read = parse_scenario(text, "test.toml");
    const Scenario& s = read.scenario.value();
    const Solution solution = solve(s.model, {s.model.start()}, s.time, s.method, s.options);
    ASSERT_TRUE(solution.report.converged()) << solution.report.message;
    EXPECT_NEAR(solution.motion.at_end(solution.motion.n_elements()).X[0](0, 0), -5.0 / 400, 1e-8);
}

/// A rod against a stop after one and a half turns: angles of springs are counted while looking for the bend.
TEST(Bends, AnglesAreCountedOnTheWay)
{
    // phi'' = 0 up to 10 rad, then -k (phi - 10): the rod comes back to 10 rad after half a period
    const Solved s = solved(R"(
[[body]]
name = "wheel"
mass = 1
inertia = [1, 1, 1]
position = [0, 0, 0]
[[joint]]
name = "hub"
type = "revolute"
between = ["world", "wheel"]
at = [0, 0, 0]
axis = [0, 0, 1]
rate = 4
[[load]]
type = "spring"
joint = "hub"
law = "table"
table = { elongations = [0, 10, 11], forces = [0, 0, 25] }
[time]
end = 4
accuracy = 1e-10
)");
    const double hit = 2.5, back = hit + std::acos(-1.0) / 5;
    EXPECT_NEAR(s.coordinate("hub", "angle", 4).value, 10 - 4 * (4 - back), 1e-10);
    EXPECT_NEAR(s.coordinate("hub", "angle", 4).rate, -4, 1e-10);
}

/// A floor whose damper begins with a jump: a neighbour that is early by a nanosecond had the last load point
/// of an element behind it, and grew by 4e9. Bounces that are 1e-6 or 1e-8 apart part by 5 times that
/// (DOP853, piece by piece); what is pushed along the floor goes on, 10 s at 11.25 lengths a second.
TEST(Bends, NeighboursBounceAtInstantsOfTheirOwn)
{
    const Solved s = solved(R"toml(
gravity = [0, 0, -9.81]
[[body]]
name = "ball"
shape = { sphere = 0.1 }
mass = 1
position = [0, 0, 1.1]
[[sensor]]
name = "c"
type = "point"
body = "ball"
[[load]]
type = "force"
body = "ball"
inputs = { z = "c.z", vz = "c.vz" }
expression = ["0", "0", "max(0, (1e5 * (0.1 - z) - 45 * vz) * (1 + abs(0.1 - z)/(0.1 - z))/2)"]
[time]
end = 10
accuracy = 1e-6
)toml");
    EXPECT_TRUE(s.solution.report.converged()) << s.solution.report.message;
    EXPECT_GT(s.solution.verdict.growth, 100);
    EXPECT_LT(s.solution.verdict.growth, 130);
}

}   // namespace
}   // namespace livens::tests::bends_test
