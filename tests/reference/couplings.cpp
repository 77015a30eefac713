// SPDX-License-Identifier: BSD-3-Clause
// Couplings of many coordinates against closed forms. Bodies that turn about and slide along one line, each
// on another one, have constant masses in their joint coordinates: random trees of them under constant loads
// move with constant accelerations, which three small matrices tell.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "livens/base/text.h"
#include "livens/statics/equilibrium.h"
#include "reference/solved.h"

namespace livens::tests::couplings_test {
namespace {

using Row = std::vector<double>;
using Rows = std::vector<Row>;

/// Solves A x = b by Gauss elimination with pivots.
Row solved_for(Rows A, Row b)
{
    const std::size_t n = b.size();
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t pivot = k;
        for (std::size_t i = k; i < n; ++i)
            if (std::abs(A[i][k]) > std::abs(A[pivot][k])) pivot = i;
        std::swap(A[k], A[pivot]);
        std::swap(b[k], b[pivot]);
        for (std::size_t i = k + 1; i < n; ++i) {
            const double factor = A[i][k] / A[k][k];
            for (std::size_t j = k; j < n; ++j) A[i][j] -= factor * A[k][j];
            b[i] -= factor * b[k];
        }
    }
    for (std::size_t k = n; k-- > 0;) {
        for (std::size_t j = k + 1; j < n; ++j) b[k] -= A[k][j] * b[j];
        b[k] /= A[k][k];
    }
    return b;
}

double product(const Row& a, const Row& b)
{
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

/// Bodies on one line, each on one before it or on the world.
struct LineTree {
    struct Link {
        int parent;
        bool slides, is_reversed;   // reversed: the joint names its outer body first
        double mass, inertia, torque;
        double sign() const { return is_reversed ? -1 : 1; }
    };
    std::vector<Link> links;
    Vector3 line{};
    double gravity = 0;   // along the line
    Row rates;
    Rows couplings;                        // a factor for each coordinate
    std::vector<std::vector<int>> order;   // of their terms

    /// How fast body b moves (slides, or turns) by each rate.
    Row motion_of(int b, bool slides) const
    {
        Row by(links.size(), 0.0);
        for (; b >= 0; b = links[b].parent)
            if (links[b].slides == slides) by[b] = links[b].sign();
        return by;
    }
    Rows masses() const
    {
        Rows M(links.size(), Row(links.size(), 0.0));
        for (int b = 0; b < std::ssize(links); ++b)
            for (const bool slides : {false, true}) {
                const Row by = motion_of(b, slides);
                for (std::size_t i = 0; i < M.size(); ++i)
                    for (std::size_t j = 0; j < M.size(); ++j)
                        M[i][j] += (slides ? links[b].mass : links[b].inertia) * by[i] * by[j];
            }
        return M;
    }
    Row forces() const
    {
        Row F(links.size(), 0.0);
        for (int b = 0; b < std::ssize(links); ++b)
            for (const bool slides : {false, true}) {
                const Row by = motion_of(b, slides);
                for (std::size_t i = 0; i < F.size(); ++i)
                    F[i] += (slides ? links[b].mass * gravity : links[b].torque) * by[i];
            }
        return F;
    }
    /// The multipliers for which M x + C^T lambda = b has C x = 0, and x.
    std::pair<Row, Row> held(const Row& b) const
    {
        const Rows M = masses();
        Rows moved, A;
        const Row free = solved_for(M, b);
        Row right;
        for (const Row& c : couplings) moved.push_back(solved_for(M, c)), right.push_back(product(c, free));
        for (const Row& c : couplings) {
            A.emplace_back();
            for (const Row& m : moved) A.back().push_back(product(c, m));
        }
        Row x = free;
        const Row lambda = solved_for(A, right);
        for (std::size_t k = 0; k < couplings.size(); ++k)
            for (std::size_t i = 0; i < x.size(); ++i) x[i] -= lambda[k] * moved[k][i];
        return {lambda, x};
    }
    Row momenta() const
    {
        Row p;
        for (const Row& row : masses()) p.push_back(product(row, rates));
        return p;
    }
    std::string coordinate(int b) const
    {
        return "j" + std::to_string(b) + (links[b].slides ? ".displacement" : ".angle");
    }
};

std::string list(const Vector3& v)
{
    return "[" + to_text(v[0]) + ", " + to_text(v[1]) + ", " + to_text(v[2]) + "]";
}

std::string scenario_of(const LineTree& tree)
{
    std::string text = "gravity = " + list(tree.gravity * tree.line) + "\n";
    for (int b = 0; b < std::ssize(tree.links); ++b) {
        const LineTree::Link& link = tree.links[b];
        const std::string name = "b" + std::to_string(b);
        const std::string below = link.parent < 0 ? "world" : "b" + std::to_string(link.parent);
        text += "[[body]]\nname = \"" + name + "\"\nmass = " + to_text(link.mass) +
                "\ninertia = " + list(link.inertia * Vector3{1, 1, 1}) +
                "\nvelocity = " + list(product(tree.motion_of(b, true), tree.rates) * tree.line) +
                "\nangular_velocity = " + list(product(tree.motion_of(b, false), tree.rates) * tree.line) +
                "\n";
        text += "[[joint]]\nname = \"j" + std::to_string(b) + "\"\ntype = \"" +
                (link.slides ? "prismatic" : "revolute") + "\"\nbetween = [\"" +
                (link.is_reversed ? name : below) + "\", \"" + (link.is_reversed ? below : name) +
                "\"]\nat = [0, 0, 0]\naxis = " + list(tree.line) + "\n";
        text += "[[load]]\ntype = \"torque\"\nbody = \"" + name +
                "\"\nvalue = " + list(link.torque * tree.line) + "\n";
    }
    for (std::size_t k = 0; k < tree.couplings.size(); ++k) {
        text += "[[joint]]\nname = \"c" + std::to_string(k) + "\"\ntype = \"coupling\"\nterms = { ";
        for (const int b : tree.order[k])
            text += (b == tree.order[k][0] ? "\"" : ", \"") + tree.coordinate(b) +
                    "\" = " + to_text(tree.couplings[k][static_cast<std::size_t>(b)]);
        text += " }\n";
    }
    return text + "[start]\ninitial = \"project\"\n[time]\nend = 3\naccuracy = 1e-10\noutput = 1\n";
}

class Dice {
public:
    explicit Dice(unsigned seed) : random_(seed) {}
    double operator()(double low, double high)
    {
        return low + (high - low) * static_cast<double>(random_()) / static_cast<double>(std::mt19937::max());
    }
    int whole(int low, int high)
    {
        return low + static_cast<int>(random_() % static_cast<unsigned>(high - low + 1));
    }

private:
    std::mt19937 random_;
};

LineTree random_tree(Dice& dice)
{
    LineTree tree;
    tree.line = {dice(-1, 1), dice(-1, 1), dice(0.2, 1)};
    tree.line = 1 / norm(tree.line) * tree.line;
    tree.gravity = dice(-9, 9);
    const int n = dice.whole(3, 10);
    for (int b = 0; b < n; ++b) {
        tree.links.push_back({dice.whole(-1, b - 1), dice.whole(0, 1) == 1, dice.whole(0, 1) == 1,
                              dice(0.5, 2), dice(0.05, 0.3), dice(-5, 5)});
        tree.rates.push_back(dice(-3, 3));
    }
    const int n_couplings = dice.whole(1, std::min(3, n - 1));
    for (int k = 0; k < n_couplings; ++k) {
        std::vector<int> order(static_cast<std::size_t>(n));
        for (int b = 0; b < n; ++b) order[static_cast<std::size_t>(b)] = b;
        for (std::size_t i = order.size(); i-- > 1;)
            std::swap(order[i], order[static_cast<std::size_t>(dice.whole(0, static_cast<int>(i)))]);
        order.resize(static_cast<std::size_t>(dice.whole(2, std::min(8, n))));
        tree.order.push_back(order);
        tree.couplings.emplace_back(static_cast<std::size_t>(n), 0.0);
        for (const int b : order)   // of angles in quarters, as teeth are; displacements by anything
            tree.couplings.back()[static_cast<std::size_t>(b)] =
                (dice.whole(0, 1) == 1 ? 1 : -1) *
                (tree.links[b].slides ? dice(0.3, 3) : 0.25 * dice.whole(1, 12));
    }
    return tree;
}

/// Coordinates at t by the closed form, where `rates` and `accelerations` are those that couplings leave.
double largest_error(const Solved& run, const LineTree& tree, const Row& rates, const Row& accelerations)
{
    double error = 0;
    for (const double t : {1.0, 2.0, 3.0})
        for (int b = 0; b < std::ssize(tree.links); ++b) {
            const auto i = static_cast<std::size_t>(b);
            const CoordinateValue q =
                run.coordinate("j" + std::to_string(b), tree.links[i].slides ? "displacement" : "angle", t);
            const double expected = (rates[i] + 0.5 * accelerations[i] * t) * t;
            error = std::max(error, std::abs(q.value - expected) / (1 + std::abs(expected)));
            error = std::max(error,
                             std::abs(q.rate - rates[i] - accelerations[i] * t) / (1 + std::abs(expected)));
        }
    return error;
}

/// What a unit multiplier of a coupling does to a body, force or torque along the line.
double share_of(const LineTree& tree, const Row& coupling, int body, bool slides)
{
    double share = 0;
    for (int b = 0; b < std::ssize(tree.links); ++b) {
        const LineTree::Link& link = tree.links[b];
        if (link.slides != slides) continue;
        if (b == body) share += link.sign() * coupling[static_cast<std::size_t>(b)];
        if (link.parent == body) share -= link.sign() * coupling[static_cast<std::size_t>(b)];
    }
    return share;
}

TEST(Couplings, RandomTreesOnALineMoveAsTheirReducedMasses)
{
    int n_turns = 0, n_long = 0;
    for (unsigned seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE(seed);
        Dice dice(seed);
        LineTree tree = random_tree(dice);
        const Solved run = solved(scenario_of(tree));
        const auto [lambda, accelerations] = tree.held(tree.forces());
        const Row rates = tree.held(tree.momenta()).second;
        ASSERT_LT(largest_error(run, tree, rates, accelerations), 1e-9);
        EXPECT_LT(run.solution.verdict.energy_drift, 1e-11);
        for (std::size_t k = 0; k < tree.couplings.size(); ++k) {
            const LineTree::Link& last = tree.links[tree.order[k].back()];
            const int body = last.is_reversed && last.parent >= 0 ? last.parent : tree.order[k].back();
            const Reaction found = run.reaction("c" + std::to_string(k), 1);
            const double size = 1 + std::abs(lambda[k]);
            EXPECT_NEAR(dot(found.torque, tree.line),
                        -lambda[k] * share_of(tree, tree.couplings[k], body, false), 1e-8 * size);
            EXPECT_NEAR(dot(found.force, tree.line),
                        -lambda[k] * share_of(tree, tree.couplings[k], body, true), 1e-8 * size);
        }
        for (int b = 0; b < std::ssize(tree.links); ++b)
            n_turns += !tree.links[b].slides &&
                       std::abs(run.coordinate("j" + std::to_string(b), "angle", 3).value) > 10;
        n_long += tree.order[0].size() > 4 ? 1 : 0;
        // the comparison tells a factor that is off by a thousandth, and one that has the wrong sign
        for (const double wrong : {1.001, -1.0}) {
            LineTree other = tree;
            other.couplings[0][static_cast<std::size_t>(tree.order[0][0])] *= wrong;
            EXPECT_GT(largest_error(run, tree, rates, other.held(other.forces()).second), 1e-7) << wrong;
        }
    }
    EXPECT_GT(n_turns, 50);
    EXPECT_GT(n_long, 10);
}

/// A parallelogram in the plane of x and z that hangs at x0: cranks of length 1 with masses of 1 kg at their
/// middles, and a bar of `mass` between their ends.
std::string parallelogram(const std::string& name, double x0, double mass)
{
    const auto body = [](const std::string& called, double m, double x, double z) {
        return "[[body]]\nname = \"" + called + "\"\nmass = " + to_text(m) + "\ninertia = [0.1, 0.1, 0.1]\n" +
               "position = [" + to_text(x) + ", 0, " + to_text(z) + "]\n";
    };
    const auto joint = [&](const std::string& called, const char* type, const std::string& first,
                           const std::string& second, double x, double z) {
        return "[[joint]]\nname = \"" + called + "\"\ntype = \"" + type + "\"\nbetween = [\"" + first +
               "\", \"" + second + "\"]\nat = [" + to_text(x) + ", 0, " + to_text(z) + "]\n" +
               (std::string(type) == "revolute" ? "axis = [0, -1, 0]\n" : "");
    };
    const std::string left = name + " left", right = name + " right", bar = name + " bar";
    return body(left, 1, x0, -0.5) + body(right, 1, x0 + 1, -0.5) + body(bar, mass, x0 + 0.5, -1) +
           joint(name, "revolute", "world", left, x0, 0) +
           joint(name + " 2", "revolute", "world", right, x0 + 1, 0) +
           joint(name + " 3", "revolute", left, bar, x0, -1) +
           joint(name + " 4", "spherical", right, bar, x0 + 1, -1);
}

/// One crank angle by the reduced equation (I_1 + r^2 I_2) q'' = -g (k_1 sin q + r k_2 sin(r q)), by small
/// steps of Runge and Kutta.
double swung(double rate, double r, const std::array<double, 2>& masses, double t)
{
    const auto inertia = [&](int i) { return 2 * (0.1 + 0.25) + masses[static_cast<std::size_t>(i)]; };
    const auto moment = [&](int i) { return 9.81 * (1 + masses[static_cast<std::size_t>(i)]); };
    const auto acceleration = [&](double q) {
        return -(moment(0) * std::sin(q) + r * moment(1) * std::sin(r * q)) /
               (inertia(0) + r * r * inertia(1));
    };
    constexpr int n = 20000;
    const double h = t / n;
    double q = 0, v = rate;
    for (int i = 0; i < n; ++i) {
        const double v1 = v, a1 = acceleration(q), v2 = v + h / 2 * a1, a2 = acceleration(q + h / 2 * v1),
                     v3 = v + h / 2 * a2, a3 = acceleration(q + h / 2 * v2), v4 = v + h * a3,
                     a4 = acceleration(q + h * v3);
        q += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
        v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
    return q;
}

/// Two of them whose cranks swing together.
std::string swinging_text(double r)
{
    return "gravity = [0, 0, -9.81]\n" + parallelogram("a", 0, 2) + parallelogram("b", 3, 0.5) +
           "[[joint]]\nname = \"both\"\ntype = \"coupling\"\nterms = { \"a.angle\" = " + to_text(-r) +
           ", \"b.angle\" = 1 }\n";
}

/// From below with a rate of the first.
Solved swinging(double r, const std::string& method, const std::string& accuracy = "accuracy = 1e-10")
{
    return solved(swinging_text(r) + "[start]\ncoordinates = [{ joint = \"a\", value = 0, rate = 2 }]\n" +
                  "[time]\nend = 2\noutput = 0.5\n" + accuracy + "\n" + method);
}

TEST(Couplings, LoopsSwingTogetherByTheReducedEquation)
{
    for (const double r : {-0.5, 0.75, 1.0})
        for (const char* method : {"", "[method]\nfamily = \"radau\"\n"}) {
            SCOPED_TRACE(to_text(r) + method);
            const Solved run = swinging(r, method);
            for (const double t : {0.5, 1.0, 2.0}) {
                const double q = swung(2, r, {2, 0.5}, t);
                EXPECT_NEAR(run.coordinate("a", "angle", t).value, q, 2e-9) << t;
                EXPECT_NEAR(run.coordinate("b", "angle", t).value, r * q, 2e-9) << t;
                EXPECT_GT(std::abs(q - swung(2, -r, {2, 0.5}, t)) +
                              std::abs(q - swung(2, 1.001 * r, {2, 0.5}, t)),
                          1e-6)
                    << "the reference tells";
            }
            EXPECT_LT(run.solution.verdict.energy_drift, 1e-9);
        }
    const Solved whole = swinging(-0.5, "[method]\nwindow = \"all\"\ndegree = 6\n", "elements = 40");
    EXPECT_NEAR(whole.coordinate("a", "angle", 2).value, swung(2, -0.5, {2, 0.5}, 2), 1e-8);
}

/// Small vibrations about the place below have (I_1 + r^2 I_2) w^2 = g (k_1 + r^2 k_2).
TEST(Couplings, ModesAreThoseOfTheReducedEquation)
{
    for (const double r : {-0.5, 0.75}) {
        const ScenarioResult read = parse_scenario(
            "format = 1\n" + swinging_text(r) + "[time]\nend = 1\nelements = 10\n", "test.toml");
        const Equilibrium at = find_equilibrium(read.scenario.value().model, read.scenario->conditions.start);
        ASSERT_TRUE(at.is_found) << at.message;
        const std::vector<VibrationMode> modes = vibration_modes(linearise(read.scenario->model, at.state));
        ASSERT_EQ(modes.size(), 1u);
        const double inertia = 0.7 + 2 + r * r * (0.7 + 0.5), stiffness = 9.81 * (3 + r * r * 1.5);
        EXPECT_NEAR(modes[0].frequency(), std::sqrt(stiffness / inertia), 1e-10);
    }
}

/// Where hinges that are stated wrongly are closed far from there, a coupling holds what was stated, though
/// many positions are one to it: after 3333 turns of one angle the other has 10000.
TEST(Couplings, AProjectedStartKeepsWhatTheStatedOneHad)
{
    std::string text;
    for (const auto& [name, tilt] : {std::pair{"a", "[0.5, -0.3, 0.2]"}, {"b", "[-0.4, 0.6, 0.6]"}})
        text += "[[body]]\nname = \"of " + std::string(name) +
                "\"\nmass = 1\ninertia = [0.1, 0.2, 0.25]\nangular_velocity = [0, 0, 1]\nrotation_vector = " +
                tilt + "\n[[joint]]\nname = \"" + name +
                "\"\ntype = \"revolute\"\nbetween = [\"world\", \"of " + name +
                "\"]\npoints = [[0, 0, 0], [0.3, 0, 0]]\naxes = [[0, 0, 1], [0, 0, 1]]\n";
    const Solved run = solved(text + R"([[joint]]
name = "both"
type = "coupling"
terms = { "a.angle" = 0.3333, "b.angle" = 1 }
[start]
initial = "project"
[time]
end = 0.1
accuracy = 1e-8
)");
    const double a = run.coordinate("a", "angle", 0).value, b = run.coordinate("b", "angle", 0).value;
    EXPECT_GT(std::abs(a), 0.01);
    EXPECT_NEAR(0.3333 * a + b, 0, 1e-12);
}

TEST(Couplings, OneOfManyTermsIsAsExact)
{
    constexpr int n = 40;
    LineTree tree;
    tree.line = {0, 0, 1};
    Dice dice(5);
    tree.order.emplace_back();
    tree.couplings.emplace_back();
    for (int b = 0; b < n; ++b) {
        tree.links.push_back({-1, b % 3 == 0, false, dice(0.5, 2), dice(0.05, 0.3), dice(-5, 5)});
        tree.rates.push_back(dice(-3, 3));
        tree.order[0].push_back(b);
        tree.couplings[0].push_back(0.5 * dice.whole(1, 5));
    }
    tree.gravity = -2;
    const Solved run = solved(scenario_of(tree));
    EXPECT_LT(largest_error(run, tree, tree.held(tree.momenta()).second, tree.held(tree.forces()).second),
              1e-9);
}

}   // namespace
}   // namespace livens::tests::couplings_test
