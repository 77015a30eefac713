// SPDX-License-Identifier: BSD-3-Clause
// Ropes against closed forms (Atwood's machine, tackles), and against particles whose equations are written
// down anew: lengths and tensions of spans by hand, small steps of Runge and Kutta.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "livens/base/text.h"
#include "livens/diagnostics/quantities.h"
#include "livens/statics/equilibrium.h"
#include "reference/shipped.h"
#include "reference/solved.h"

namespace livens::tests::ropes_test {
namespace {

constexpr double g = 9.81;

std::string list(const Vector3& v)
{
    return "[" + to_text(v[0]) + ", " + to_text(v[1]) + ", " + to_text(v[2]) + "]";
}

std::string body(const std::string& name, double mass, const Vector3& at, const std::string& more = "")
{
    return "[[body]]\nname = \"" + name + "\"\nmass = " + to_text(mass) +
           "\ninertia = [0.1, 0.1, 0.1]\nposition = " + list(at) + "\n" + more;
}

/// A point of `over`.
std::string on(const std::string& name, const Vector3& at = {})
{
    return "{ body = \"" + name + "\", point = " + list(at) + " }";
}

std::string over(const std::vector<std::string>& points)
{
    std::string text = "over = [";
    for (const std::string& point : points) text += (text.back() == '[' ? "" : ", ") + point;
    return text + "]\n";
}

std::string rope(const std::vector<std::string>& points)
{
    return "[[joint]]\nname = \"rope\"\ntype = \"rod\"\n" + over(points);
}

const std::string falling = "gravity = [0, 0, -9.81]\n";

Vector3 place(const Solved& run, const std::string& name, double t)
{
    const auto b = static_cast<std::size_t>(run.model.find_body(name));
    return sample_bodies(run.model, run.solution.motion, sample_state(run.solution.motion, t))[b].position;
}

double tension(const Solved& run, double t)
{
    const Joint& joint = run.model.joints()[static_cast<std::size_t>(run.joint("rope"))];
    return rope_tension(joint, sample_state(run.solution.motion, t).X, run.reaction("rope", t));
}

const std::vector<std::string> methods{"family = \"lobatto\"", "family = \"radau\""};

TEST(Ropes, AtwoodsMachine)
{
    for (const std::string& method : methods) {
        const Solved run =
            solved(falling + body("left", 3, {-0.1, 0, -1}) + body("right", 2, {0.1, 0, -1}) +
                   rope({on("left"), on("world", {-0.1, 0, 0}), on("world", {0.1, 0, 0}), on("right")}) +
                   "[time]\nend = 0.8\naccuracy = 1e-11\noutput = 0.2\n[method]\n" + method);
        const double a = g / 5;
        for (const double t : {0.2, 0.4, 0.8}) {
            EXPECT_NEAR(place(run, "left", t)[2], -1 - a * t * t / 2, 1e-12) << method;
            EXPECT_NEAR(place(run, "right", t)[2], -1 + a * t * t / 2, 1e-12) << method;
            EXPECT_NEAR(tension(run, t), 3 * (g - a), 1e-10) << method;
            EXPECT_NEAR(tension(run, t), 2 * (g + a), 1e-10) << method;
            // on its last body, which it pulls up
            EXPECT_NEAR(run.reaction("rope", t).force[2], 2 * (g + a), 1e-10) << method;
        }
        EXPECT_LT(run.solution.verdict.energy_drift, 1e-12);
    }
}

/// A block of 5 kg in the bights of a rope, n strands wide, and a weight on its free end.
std::string tackle(int n, double weight)
{
    std::vector<std::string> points{on("world", {0, 0, 0})};
    for (int k = 0; k < n; k += 2) {
        const double x = 0.1 * k;
        points.push_back(on("block", {x - 0.05 * (n - 1), 0, 0}));
        points.push_back(on("block", {x + 0.1 - 0.05 * (n - 1), 0, 0}));
        points.push_back(on("world", {x + 0.1, 0, 0}));
        points.push_back(on("world", {k + 2 == n ? 2.0 : x + 0.2, 0, 0}));
    }
    points.push_back(on("weight"));
    return falling + body("block", 5, {0.05 * (n - 1), 0, -1.5}) + body("weight", weight, {2, 0, -3}) +
           rope(points);
}

TEST(Ropes, TacklesOfTwoAndFourStrands)
{
    for (const int n : {2, 4}) {
        constexpr double m = 2;
        const Solved run = solved(tackle(n, m) + "[time]\nend = 0.4\naccuracy = 1e-11\noutput = 0.1\n");
        const double a = (5 - n * m) * g / (5 + n * n * m);   // of the block, downwards
        for (const double t : {0.1, 0.4}) {
            EXPECT_NEAR(place(run, "block", t)[2], -1.5 - a * t * t / 2, 1e-12) << n;
            EXPECT_NEAR(place(run, "weight", t)[2], -3 + n * a * t * t / 2, 1e-12) << n;
            EXPECT_NEAR(tension(run, t), m * (g + n * a), 1e-10) << n;
        }
        // one strand less is another machine
        const double other = (5 - (n - 1) * m) * g / (5 + (n - 1) * (n - 1) * m);
        EXPECT_GT(std::abs(other - a), 0.1);
    }
}

TEST(Ropes, TheExampleOfATackle)
{
    const Shipped shipped = solve_example("tackle");
    const double a = (4 * 30 - 100) * g / (100 + 16 * 30), t = 1.5;
    const State last = shipped.at(t);
    EXPECT_NEAR(last.X[0](2, 0), 0.6 + a * t * t / 2, 1e-12);
    EXPECT_NEAR(last.X[1](2, 0), 2 - 4 * a * t * t / 2, 1e-12);
    const Reaction reaction = sample_joints(shipped.model, shipped.solution.motion, 1)[0].right;
    EXPECT_NEAR(rope_tension(shipped.model.joints()[0], sample_state(shipped.solution.motion, 1).X, reaction),
                30 * (g - 4 * a), 1e-10);
}

TEST(Ropes, ATackleInBalanceIsFoundAtRest)
{
    const ScenarioResult read =
        parse_scenario("format = 1\n" + tackle(2, 2.5) + "[time]\nend = 1\n", "test.toml");
    ASSERT_TRUE(read.scenario);
    const Model& model = read.scenario->model;
    const Equilibrium rest = find_equilibrium(model, model.start(), {});
    EXPECT_TRUE(rest.is_found) << rest.message;
    const Reaction reaction = joint_reaction(model, 0, rest.state.X, rest.multipliers);
    EXPECT_NEAR(rope_tension(model.joints()[0], rest.state.X, reaction), 2.5 * g, 1e-10);
}

// --- particles

using Row = std::vector<double>;

/// Masses that a rope joins, each at a point: where a point of the rope is on no mass it stands still.
struct Particles {
    Row masses;
    std::vector<Vector3> places, speeds, forces;
    std::vector<int> over;   ///< places in `masses`, or -1 - k of fixed[k]
    std::vector<Vector3> fixed;
    double stiffness = 0, damping = 0, free_length = 0;   ///< 0: it does not stretch

    Vector3 at(const std::vector<Vector3>& x, int i) const
    {
        return i >= 0 ? x[static_cast<std::size_t>(i)] : fixed[static_cast<std::size_t>(-1 - i)];
    }
    Vector3 moves(const std::vector<Vector3>& v, int i) const
    {
        return i >= 0 ? v[static_cast<std::size_t>(i)] : Vector3{};
    }
    double length(const std::vector<Vector3>& x) const
    {
        double sum = 0;
        for (std::size_t k = 1; k < over.size(); ++k) sum += norm(at(x, over[k]) - at(x, over[k - 1]));
        return sum;
    }
    /// Accelerations, and the tension.
    std::pair<std::vector<Vector3>, double> accelerations(const std::vector<Vector3>& x,
                                                          const std::vector<Vector3>& v) const
    {
        std::vector<Vector3> pull(masses.size());   // of a unit tension
        double shrinks = 0, centripetal = 0;
        for (std::size_t k = 1; k < over.size(); ++k) {
            const Vector3 r = at(x, over[k]) - at(x, over[k - 1]),
                          w = moves(v, over[k]) - moves(v, over[k - 1]);
            const double l = norm(r);
            const Vector3 u = 1 / l * r;
            if (over[k - 1] >= 0) pull[static_cast<std::size_t>(over[k - 1])] += u;
            if (over[k] >= 0) pull[static_cast<std::size_t>(over[k])] -= u;
            shrinks -= dot(u, w);
            centripetal += (dot(w, w) - dot(u, w) * dot(u, w)) / l;
        }
        double T = stiffness * (length(x) - free_length) - damping * shrinks;
        if (stiffness == 0) {   // sum of pulls times accelerations = centripetal
            double free = 0, mobility = 0;
            for (std::size_t i = 0; i < masses.size(); ++i) {
                free += dot(pull[i], forces[i]) / masses[i];
                mobility += dot(pull[i], pull[i]) / masses[i];
            }
            T = (centripetal - free) / mobility;
        }
        std::vector<Vector3> a;
        for (std::size_t i = 0; i < masses.size(); ++i)
            a.push_back(1 / masses[i] * (forces[i] + T * pull[i]));
        return {a, T};
    }
    void step(double h)
    {
        const auto moved = [](std::vector<Vector3> x, double by, const std::vector<Vector3>& v) {
            for (std::size_t i = 0; i < x.size(); ++i) x[i] += by * v[i];
            return x;
        };
        const auto &x = places, &v = speeds;
        const auto a1 = accelerations(x, v).first;
        const auto v2 = moved(v, h / 2, a1);
        const auto a2 = accelerations(moved(x, h / 2, v), v2).first;
        const auto v3 = moved(v, h / 2, a2);
        const auto a3 = accelerations(moved(x, h / 2, v2), v3).first;
        const auto v4 = moved(v, h, a3);
        const auto a4 = accelerations(moved(x, h, v3), v4).first;
        for (std::size_t i = 0; i < x.size(); ++i) {
            places[i] += h / 6 * (v[i] + 2 * v2[i] + 2 * v3[i] + v4[i]);
            speeds[i] += h / 6 * (a1[i] + 2 * a2[i] + 2 * a3[i] + a4[i]);
        }
    }
    Particles after(double t, int n = 8000) const
    {
        Particles moved = *this;
        for (int i = 0; i < n; ++i) moved.step(t / n);
        return moved;
    }
    /// `ends`: where they are at the end of time, if that is stated.
    std::string scenario(const std::vector<Vector3>& ends = {}) const
    {
        std::string text;
        for (std::size_t i = 0; i < masses.size(); ++i) {
            const std::string name = "m" + std::to_string(i);
            text += body(name, masses[i], places[i], "velocity = " + list(speeds[i]) + "\n");
            if (!ends.empty()) text += "[body.end]\nposition = " + list(ends[i]) + "\n";
            text += "[[load]]\ntype = \"force\"\nbody = \"" + name + "\"\nvalue = " + list(forces[i]) + "\n";
        }
        std::vector<std::string> points;
        for (const int i : over)
            points.push_back(i >= 0 ? on("m" + std::to_string(i))
                                    : on("world", fixed[static_cast<std::size_t>(-1 - i)]));
        if (stiffness == 0) return text + rope(points);
        return text + "[[load]]\nname = \"rope\"\ntype = \"spring\"\nstiffness = " + to_text(stiffness) +
               "\ndamping = " + to_text(damping) + "\nfree_length = " + to_text(free_length) + "\n" +
               livens::tests::ropes_test::over(points);
    }
};

double farthest(const Solved& run, const Particles& other, double t)
{
    double most = 0;
    for (std::size_t i = 0; i < other.masses.size(); ++i)
        most = std::max(most, norm(place(run, "m" + std::to_string(i), t) - other.places[i]));
    return most;
}

std::string time(double end, const std::string& method = "family = \"lobatto\"")
{
    return "[time]\nend = " + to_text(end) + "\naccuracy = 1e-11\noutput = " + to_text(end) + "\n[method]\n" +
           method + "\n";
}

/// A mass swings on a rope over a peg, a heavier one goes up and down a guide on the other end.
Particles swinging()
{
    Particles all;
    all.masses = {1, 2.5};
    all.places = {{0.6, 0, -0.8}, {-1, 0, -1}};
    all.speeds = {{0, 0, 0}, {0, 0, 0}};
    all.forces = {{0, 0, -g}, {0, 0, -2.5 * g}};
    all.over = {0, -1, -2, 1};
    all.fixed = {{0, 0, 0}, {-1, 0, 0}};
    return all;
}

TEST(Ropes, TheSwingingAtwoodMachine)
{
    constexpr double end = 1.5;
    const Particles other = swinging().after(end);
    EXPECT_LT(norm(other.places[0] - swinging().after(end, 4000).places[0]), 1e-10) << "its own error";
    EXPECT_NEAR(other.length(other.places), swinging().length(swinging().places), 1e-11);
    for (const std::string& method : methods) {
        const Solved run = solved(swinging().scenario() + time(end, method));
        EXPECT_LT(farthest(run, other, end), 1e-9) << method;
        EXPECT_NEAR(tension(run, end), other.accelerations(other.places, other.speeds).second, 1e-8)
            << method;
        EXPECT_LT(run.solution.verdict.energy_drift, 1e-11) << method;
    }
    Particles wrong = swinging();
    wrong.fixed[0][0] += 1e-6;
    EXPECT_GT(norm(wrong.after(end).places[0] - other.places[0]), 1e-8) << "the comparison tells";
}

/// Coarse elements of other families go to the same motion.
TEST(Ropes, SteppingAndShortElementsAgree)
{
    constexpr double end = 0.5;
    const Particles other = swinging().after(end);
    const auto error = [&](const std::string& method, int n) {
        const ScenarioResult read = parse_scenario("format = 1\n" + swinging().scenario() +
                                                       "[time]\nend = 0.5\nelements = " + std::to_string(n) +
                                                       "\n[method]\nestimate = \"none\"\n" + method,
                                                   "test.toml");
        const Scenario& s = read.scenario.value();
        const State last = solve(s.model, {s.model.start()}, s.time, s.method, s.options).motion.at_end(n);
        return norm(last.X[0].column(0) - other.places[0]) + norm(last.X[1].column(0) - other.places[1]);
    };
    for (const auto& [method, order] : {std::pair{"family = \"midpoint\"\n", 2.0},
                                        {"family = \"endpoint\"\n", 1.0},
                                        {"family = \"mixed\"\ndegree = 1\n", 2.0},
                                        {"family = \"lobatto\"\ndegree = 1\n", 2.0},
                                        {"family = \"lobatto\"\ndegree = 2\n", 4.0}}) {
        const double coarse = error(method, 20), fine = error(method, 40);
        EXPECT_NEAR(std::log2(coarse / fine), order, 0.2) << method;
    }
}

/// Positions at both ends, all elements at once: momenta at the start are found, which are none.
TEST(Ropes, PositionsMayBeGivenAtBothEnds)
{
    constexpr double end = 0.5;
    const Particles other = swinging().after(end);
    for (const auto& [method, bound] : {std::pair{"family = \"lobatto\"\ndegree = 5\n", 1e-9},
                                        {"family = \"mixed\"\ndegree = 3\n", 1e-5}}) {
        const ScenarioResult read = parse_scenario(
            "format = 1\n" + swinging().scenario(other.places) +
                "[time]\nend = 0.5\nelements = 10\n[start]\ngiven = \"positions\"\n[end]\ngiven "
                "= \"positions\"\n[method]\n" +
                method,
            "test.toml");
        ASSERT_TRUE(read.scenario) << method;
        const Scenario& s = *read.scenario;
        const Solution solution = solve(s.model, {s.conditions}, s.time, s.method, s.options);
        EXPECT_TRUE(solution.report.converged()) << method << solution.report.message;
        const State first = solution.motion.at_end(0), middle = solution.motion.at_end(5);
        const Particles half = swinging().after(end / 2);
        for (std::size_t b = 0; b < 2; ++b) {
            EXPECT_LT(norm(first.V[b].column(0)), 10 * bound) << method;
            EXPECT_LT(norm(middle.X[b].column(0) - half.places[b]), bound) << method;
        }
    }
}

class Dice {
public:
    explicit Dice(unsigned seed) : random_(seed) {}
    double operator()(double low, double high)
    {
        return low + (high - low) * static_cast<double>(random_()) / static_cast<double>(std::mt19937::max());
    }
    Vector3 place() { return {(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)}; }
    int whole(int low, int high)
    {
        return low + static_cast<int>(random_() % static_cast<unsigned>(high - low + 1));
    }

private:
    std::mt19937 random_;
};

/// A rope through two to five masses and some fixed points in any order, some of them passed twice.
Particles anything(Dice& dice, bool is_elastic)
{
    Particles all;
    const int n = dice.whole(2, 5);
    for (int i = 0; i < n; ++i) {
        all.masses.push_back(dice(0.5, 2));
        all.places.push_back(2 * dice.place());
        all.speeds.push_back(is_elastic ? dice.place() : Vector3{});
        all.forces.push_back(5 * dice.place());
        all.over.push_back(i);
    }
    for (int k = 0; k < 3; ++k) all.fixed.push_back(3 * dice.place());
    for (int k = dice.whole(1, 5); k > 0; --k) {
        const int more = dice.whole(-3, n - 1);
        const auto where = static_cast<std::size_t>(dice.whole(0, static_cast<int>(all.over.size())));
        const bool repeats = (where > 0 && all.over[where - 1] == more) ||
                             (where < all.over.size() && all.over[where] == more);
        if (!repeats) all.over.insert(all.over.begin() + static_cast<std::ptrdiff_t>(where), more);
    }
    if (!is_elastic) return all;
    all.stiffness = dice(20, 80);
    all.damping = dice(0, 4);
    all.free_length = dice(0.5, 1) * all.length(all.places);
    return all;
}

/// Of spans that come near zero no comparison can be made.
double shortest(Particles all, double end)
{
    double least = 1e9;
    for (int i = 0; i < 200; ++i) {
        for (std::size_t k = 1; k < all.over.size(); ++k)
            least =
                std::min(least, norm(all.at(all.places, all.over[k]) - all.at(all.places, all.over[k - 1])));
        all.step(end / 200);
    }
    return least;
}

TEST(Ropes, RandomOnesMoveAsParticlesDo)
{
    constexpr double end = 0.5;
    int n = 0;
    for (unsigned seed = 1; seed <= 40; ++seed)
        for (const bool is_elastic : {false, true}) {
            SCOPED_TRACE(std::to_string(seed) + (is_elastic ? " elastic" : ""));
            Dice dice(seed);
            const Particles all = anything(dice, is_elastic);
            if (shortest(all, end) < 0.2) continue;
            ++n;
            const Particles other = all.after(end);
            const Solved run = solved(all.scenario() + time(end));
            EXPECT_LT(farthest(run, other, end), 2e-9);
            if (!is_elastic) {
                const double pulled = other.accelerations(other.places, other.speeds).second;
                EXPECT_NEAR(tension(run, end), pulled, 1e-7 * (1 + std::abs(pulled)));
            }
            EXPECT_LT(run.solution.verdict.energy_drift, 1e-10);
        }
    EXPECT_GT(n, 30);
}

/// A body that the rope passes at two points turns as well: what is kept tells whether all forces are there.
TEST(Ropes, RigidBodiesKeepEnergyAndMomentum)
{
    for (const bool is_elastic : {false, true}) {
        const std::string text =
            body("a", 1, {0, 0, 0}, "angular_velocity = [1, -2, 0.5]\n") +
            body("b", 2, {2, 0.3, 0.1}, "velocity = [0, 0.5, 0]\n") +
            body("c", 1.5, {1, 2, -0.4}, "angular_velocity = [0, 1, 1]\n") +
            (is_elastic ? "[[load]]\nname = \"rope\"\ntype = \"spring\"\nstiffness = 30\nfree_length = 3\n"
                        : "[[joint]]\nname = \"rope\"\ntype = \"rod\"\n") +
            over({on("a", {0.2, 0.1, 0}), on("b", {-0.2, 0, 0.1}), on("b", {0.2, 0.1, 0}),
                  on("c", {0, 0.2, 0}), on("a", {0, 0, 0.3})}) +
            "[start]\ninitial = \"project\"\n[time]\nend = 2\naccuracy = 1e-9\n";
        const Solved run = solved(text);
        EXPECT_LT(run.solution.verdict.energy_drift, 1e-9);
        EXPECT_LT(run.solution.verdict.angular_momentum_drift, 1e-9);
    }
}

TEST(Ropes, OneThatIsPulledThroughAPointIsToldByName)
{
    const ScenarioResult read = parse_scenario(
        "format = 1\n" + falling + body("left", 3, {-0.1, 0, -1}) + body("right", 2, {0.1, 0, -0.3}) +
            rope({on("left"), on("world", {-0.1, 0, 0}), on("world", {0.1, 0, 0}), on("right")}) +
            "[time]\nend = 2\naccuracy = 1e-8\n",
        "test.toml");
    ASSERT_TRUE(read.scenario);
    const Scenario& s = *read.scenario;
    const Solution solution = solve(s.model, {s.model.start()}, s.time, s.method, s.options);
    EXPECT_FALSE(solution.report.converged());
    EXPECT_NE(solution.report.message.find("the points 3 and 4 of the rope 'rope' meet near t = 0.553"),
              std::string::npos)
        << solution.report.message;
}

std::string complaint_of(const std::string& text)
{
    const ScenarioResult read = parse_scenario("format = 1\n" + text + "[time]\nend = 1\n", "test.toml");
    for (std::size_t i = 1; i < read.diagnostics.size(); ++i)
        ADD_FAILURE() << "a second one: " << read.diagnostics[i].message;
    return read.diagnostics.empty() ? "" : read.diagnostics[0].code + ": " + read.diagnostics[0].message;
}

TEST(Ropes, WhatNoRopeIsGetsOneErrorEach)
{
    const std::string two = body("a", 1, {0, 0, 0}) + body("b", 1, {1, 0, 0});
    const auto begins = [&](const std::string& rope_text, const std::string& code) {
        const std::string found = complaint_of(two + rope_text);
        EXPECT_EQ(found.substr(0, code.size()), code) << found;
    };
    const std::string spring =
        "[[load]]\nname = \"rope\"\ntype = \"spring\"\nstiffness = 1\nfree_length = 1\n";
    for (const std::string& head : {std::string("[[joint]]\nname = \"rope\"\ntype = \"rod\"\n"), spring}) {
        begins(head + over({on("a")}), "rope-points");
        begins(head + over({on("world", {1, 2, 3}), on("world")}), "rope-points");
        begins(head + over({on("a", {1, 0, 0}), on("a")}), "rope-points");
        begins(head + over({on("a"), on("b"), on("world", {1, 0, 0})}), "rope-span");
        begins(head + over({on("a"), on("a"), on("b")}), "rope-span");
        begins(head + over({on("a"), on("nobody")}), "body-unknown");
        begins(head + over({on("a"), "{ point = [0, 0, 0] }"}), "missing-key");
        begins(head + over({on("a"), "{ point = \"hook\" }"}), "point-unknown");
    }
    begins(rope({on("a"), on("b")}) + "between = [\"a\", \"b\"]\n", "rope-points");
    begins(rope({on("a"), on("b")}) + "length = -1\n", "out-of-range");
    begins(spring + over({on("a"), on("b")}) + "between = [\"a\", \"b\"]\n", "spring-place");
}

}   // namespace
}   // namespace livens::tests::ropes_test
