// SPDX-License-Identifier: BSD-3-Clause
// States of rest and vibrations about them, of scenarios, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "livens/multibody/motion.h"
#include "livens/statics/equilibrium.h"
#include "reference/shipped.h"

namespace livens::tests::rest_test {
namespace {

struct Rest {
    Model model;
    Equilibrium at;
    std::vector<VibrationMode> modes;
};

Rest rest_of(const ScenarioResult& read)
{
    if (!read.scenario) {
        ADD_FAILURE() << render(read.diagnostics, read.text, DiagnosticFormat::human);
        throw std::runtime_error("the scenario cannot be read");
    }
    Rest rest{read.scenario->model, {}, {}};
    rest.at = find_equilibrium(rest.model, read.scenario->conditions.start);
    EXPECT_TRUE(rest.at.is_found) << rest.at.message;
    rest.modes = vibration_modes(linearise(rest.model, rest.at.state));
    return rest;
}

Rest rest_of_example(const std::string& name)
{
    return rest_of(read_scenario(root / "examples" / (name + ".toml")));
}
Rest rest_of_text(const std::string& text)
{
    return rest_of(parse_scenario(
        "format = 1\ngravity = [0, 0, -9.81]\n[time]\nend = 1\nelements = 10\n" + text, "text"));
}

/// sqrt(m g c / (J + m c^2)), from a start far away.
TEST(VibrationModes, OfAPhysicalPendulum)
{
    const Rest rest = rest_of_text(R"toml(
[[body]]
name = "rod"
shape = { box = [0.8, 0.1, 0.06] }
mass = 3
center_of_mass = [0.3, 0, 0]
[[joint]]
name = "pivot"
type = "revolute"
between = ["world", "rod"]
at = [0, 0, 0]
axis = [0, 1, 0]
)toml");
    const double J = 3 * (0.8 * 0.8 + 0.06 * 0.06) / 12, c = 0.3;
    ASSERT_EQ(rest.modes.size(), 1u);
    EXPECT_NEAR(rest.modes[0].frequency(), std::sqrt(3 * 9.81 * c / (J + 3 * c * c)), 1e-12);
    EXPECT_NEAR(std::abs(rest.modes[0].bodies[0].rotation[1]), 1, 1e-14);
    EXPECT_EQ(rest.modes[0].damping_ratio(), 0);
    // control: the pendulum of all its mass in its centre is another
    EXPECT_GT(std::abs(rest.modes[0].frequency() - std::sqrt(9.81 / c)), 0.1);
}

/// Of two equal links of length 1, gravity 10, centres in the middle, inertia J: roots of
/// det(K - w^2 M) with M = [J + 1/4 + 1, 1/2; 1/2, J + 1/4], K = diag(15, 5).
TEST(VibrationModes, OfTheDoublePendulumOfRevolutes)
{
    const Rest rest = rest_of_example("revolute_double_pendulum");
    const double J = mass_properties(rest.model.bodies()[0].mass).inertia(2, 2);
    const double m11 = J + 1.25, m12 = 0.5, m22 = J + 0.25, k1 = 15, k2 = 5;
    const double a = m11 * m22 - m12 * m12, b = -(k1 * m22 + k2 * m11), c = k1 * k2;
    const double root = std::sqrt(b * b - 4 * a * c);
    ASSERT_EQ(rest.modes.size(), 2u);
    EXPECT_NEAR(rest.modes[0].frequency(), std::sqrt((-b - root) / (2 * a)), 1e-12);
    EXPECT_NEAR(rest.modes[1].frequency(), std::sqrt((-b + root) / (2 * a)), 1e-12);
    const auto tilt = [&](std::size_t mode, std::size_t body) {
        return rest.modes[mode].bodies[body].rotation[2].real();
    };
    const double w2 = (-b - root) / (2 * a);   // the lower link goes along, and farther
    EXPECT_NEAR(tilt(0, 1) / tilt(0, 0), w2 * m12 / (k2 - w2 * m22), 1e-11);
    EXPECT_LT(tilt(1, 1) / tilt(1, 0), 0);
}

/// A parallelogram: two equal cranks and a coupler that does not turn, so that
/// w^2 = (m_1 / 2 + m_2 / 2 + m_c) g a / (J_1 + J_2 + m_c a^2).
TEST(VibrationModes, OfAParallelogram)
{
    const auto crank = [](const char* name, double x) {
        return std::string("[[body]]\nname = \"") + name +
               "\"\nshape = { box = [0.04, 0.04, 0.5] }\nmass = 2\n" + "position = [" + std::to_string(x) +
               ", 0, -0.25]\n";
    };
    const auto hinge = [](const char* name, const char* a, const char* b, double x, double z) {
        return std::string("[[joint]]\nname = \"") + name + "\"\ntype = \"revolute\"\nbetween = [\"" + a +
               "\", \"" + b + "\"]\nat = [" + std::to_string(x) + ", 0, " + std::to_string(z) +
               "]\naxis = [0, 1, 0]\n";
    };
    const Rest rest =
        rest_of_text(crank("left", 0) + crank("right", 0.8) +
                     "[[body]]\nname = \"coupler\"\nshape = { box = [0.8, 0.05, 0.05] }\nmass = 5\n"
                     "position = [0.4, 0, -0.5]\n" +
                     hinge("A", "world", "left", 0, 0) + hinge("B", "left", "coupler", 0, -0.5) +
                     hinge("C", "coupler", "right", 0.8, -0.5) + hinge("D", "world", "right", 0.8, 0));
    const double J = 2 * (0.04 * 0.04 + 0.25) / 12 + 2 * 0.25 * 0.25;
    ASSERT_EQ(rest.modes.size(), 1u);
    EXPECT_NEAR(rest.modes[0].frequency(), std::sqrt((2 + 5) * 9.81 * 0.5 / (2 * J + 5 * 0.25)), 1e-11);
    EXPECT_NEAR(std::abs(rest.modes[0].bodies[2].rotation[1]), 0, 1e-12);
    EXPECT_EQ(rest.at.stability.stability, Stability::stable);
}

/// The shipped four-bar linkage in long doubles: its loop closed exactly as a function of the crank's angle,
/// V'' / M by differences of eighth order.
class FourBar {
public:
    using Real = long double;

    FourBar(const Model& model, const State& rest)
    {
        for (int b = 0; b < 3; ++b) {
            const MassProperties p = mass_properties(model.bodies()[b].mass);
            mass_[b] = p.mass;
            inertia_[b] = p.inertia(1, 1);   // about y
            length_[b] = 2 * norm(p.center_of_mass);
        }
        const Vector3 along = rest.X[0].column(1), coupler = rest.X[1].column(1);
        crank_ = std::atan2(static_cast<Real>(along[2]), static_cast<Real>(along[0]));
        side_ = 1;
        if (std::abs(angles(crank_)[1] - std::atan2(coupler[2], coupler[0])) > 0.1) side_ = -1;
    }

    Real crank() const { return crank_; }
    Real potential(Real crank) const
    {
        Real V = 0;
        const auto c = centres(crank);
        for (int b = 0; b < 3; ++b) V += mass_[b] * 9.81L * c[b][1];
        return V;
    }
    Real mass(Real crank) const
    {
        Real M = 0;
        for (int b = 0; b < 3; ++b) {
            const Real turn = first([&](Real q) { return angles(q)[b]; }, crank),
                       x = first([&](Real q) { return centres(q)[b][0]; }, crank),
                       z = first([&](Real q) { return centres(q)[b][1]; }, crank);
            M += inertia_[b] * turn * turn + mass_[b] * (x * x + z * z);
        }
        return M;
    }
    static Real first(auto&& f, Real q)
    {
        const Real w[] = {4 / 5.0L, -1 / 5.0L, 4 / 105.0L, -1 / 280.0L};
        Real sum = 0;
        for (int i = 0; i < 4; ++i) sum += w[i] * (f(q + (i + 1) * h) - f(q - (i + 1) * h));
        return sum / h;
    }
    static Real second(auto&& f, Real q)
    {
        const Real w[] = {8 / 5.0L, -1 / 5.0L, 8 / 315.0L, -1 / 560.0L};
        Real sum = -205 / 72.0L * f(q);
        for (int i = 0; i < 4; ++i) sum += w[i] * (f(q + (i + 1) * h) + f(q - (i + 1) * h));
        return sum / (h * h);
    }

private:
    static constexpr Real h = 2e-3L;

    /// Of crank, coupler and rocker, from x towards z; the rocker stands at (1, 0).
    std::array<Real, 3> angles(Real crank) const
    {
        const Real x = length_[0] * std::cos(crank), z = length_[0] * std::sin(crank);
        const Real dx = 1 - x, dz = -z, d = std::hypot(dx, dz);
        const Real at_crank =
            std::acos((d * d + length_[1] * length_[1] - length_[2] * length_[2]) / (2 * d * length_[1]));
        const Real coupler = std::atan2(dz, dx) + side_ * at_crank;
        const Real ex = x + length_[1] * std::cos(coupler) - 1, ez = z + length_[1] * std::sin(coupler);
        return {crank, coupler, std::atan2(ez, ex)};
    }
    std::array<std::array<Real, 2>, 3> centres(Real crank) const
    {
        const auto a = angles(crank);
        const Real half[] = {length_[0] / 2, length_[1] / 2, length_[2] / 2};
        return {{{half[0] * std::cos(a[0]), half[0] * std::sin(a[0])},
                 {length_[0] * std::cos(a[0]) + half[1] * std::cos(a[1]),
                  length_[0] * std::sin(a[0]) + half[1] * std::sin(a[1])},
                 {1 + half[2] * std::cos(a[2]), half[2] * std::sin(a[2])}}};
    }

    std::array<Real, 3> mass_{}, inertia_{}, length_{};
    Real crank_ = 0, side_ = 1;
};

TEST(VibrationModes, OfTheFourBarLinkage)
{
    const Rest rest = rest_of_example("four_bar");
    const FourBar bar(rest.model, rest.at.state);
    const auto V = [&](FourBar::Real q) { return bar.potential(q); };
    EXPECT_NEAR(static_cast<double>(FourBar::first(V, bar.crank())), 0, 1e-11);   // it is in equilibrium
    const FourBar::Real squared = FourBar::second(V, bar.crank()) / bar.mass(bar.crank());
    ASSERT_EQ(rest.modes.size(), 1u);
    const double expected = static_cast<double>(std::sqrt(squared));
    EXPECT_NEAR(rest.modes[0].frequency(), expected, 1e-10 * expected);
    // control: a little beside the equilibrium V'' / M is not that
    const FourBar::Real beside = bar.crank() + 1e-6L;
    EXPECT_GT(
        std::abs(static_cast<double>(std::sqrt(FourBar::second(V, beside) / bar.mass(beside))) - expected),
        1e-9 * expected);
}

/// n links of length l between supports at a distance S: the slope of the i-th has the tangent
/// (w / H) (i - (n - 1) / 2), where the horizontal force H fits the links to S.
struct Catenary {
    int n;
    double l, S, w;

    double slope(int i, double H) const { return std::atan(w / H * (i - 0.5 * (n - 1))); }
    double span(double H) const
    {
        double sum = 0;
        for (int i = 0; i < n; ++i) sum += l * std::cos(slope(i, H));
        return sum;
    }
    double horizontal_force() const
    {
        double low = 1e-6, high = 1e6;
        for (int i = 0; i < 200; ++i) (span(std::sqrt(low * high)) < S ? low : high) = std::sqrt(low * high);
        return low;
    }
};

/// A chain of 50 links between two supports, stated as a roof: its start is about as far away as can be.
std::string chain(const Catenary& c)
{
    std::ostringstream text;
    text.precision(17);
    const double up = std::acos(c.S / (c.n * c.l));
    double x = 0, z = 0;
    for (int i = 0; i < c.n; ++i) {
        const double angle = i < c.n / 2 ? up : -up;   // about -y
        text << "[[body]]\nname = \"l" << i << "\"\nshape = { box = [" << c.l
             << ", 0.002, 0.002] }\nmass = " << c.w / 9.81 << "\nposition = ["
             << x + 0.5 * c.l * std::cos(angle) << ", 0, " << z + 0.5 * c.l * std::sin(angle)
             << "]\nrotation_vector = [0, " << -angle << ", 0]\n";
        text << "[[joint]]\nname = \"j" << i << "\"\ntype = \"revolute\"\nbetween = [\""
             << (i == 0 ? std::string("world") : "l" + std::to_string(i - 1)) << "\", \"l" << i
             << "\"]\nat = [" << x << ", 0, " << z << "]\naxis = [0, 1, 0]\n";
        x += c.l * std::cos(angle);
        z += c.l * std::sin(angle);
    }
    text << "[[joint]]\nname = \"end\"\ntype = \"revolute\"\nbetween = [\"world\", \"l" << c.n - 1
         << "\"]\nat = [" << c.S << ", 0, 0]\naxis = [0, 1, 0]\n";
    return text.str();
}

TEST(Equilibrium, OfAChainOfFiftyLinksIsItsCatenary)
{
    const Catenary c{50, 0.02, 0.8, 0.05};
    const Rest rest = rest_of_text(chain(c));
    const double H = c.horizontal_force();
    double worst = 0, x = 0, z = 0;
    for (int i = 0; i < c.n; ++i) {
        const double angle = c.slope(i, H);
        const Vector3 centre{x + 0.5 * c.l * std::cos(angle), 0, z + 0.5 * c.l * std::sin(angle)};
        worst = std::max(worst, norm(rest.at.state.X[i].column(0) - centre));
        x += c.l * std::cos(angle);
        z += c.l * std::sin(angle);
    }
    EXPECT_LT(worst, 1e-12);
    EXPECT_EQ(rest.at.stability.stability, Stability::stable);
    EXPECT_EQ(rest.at.degrees_of_freedom, 48);
    const Reaction support = joint_reaction(rest.model, 0, rest.at.state.X, rest.at.multipliers);
    EXPECT_NEAR(support.force[0], -H, 1e-11);
    EXPECT_NEAR(support.force[2], 0.5 * c.n * c.w, 1e-11);
    // control: the continuous catenary, sag a (cosh(S / 2 a) - 1) with 2 a sinh(S / 2 a) = n l, is another
    double low = 0.01, high = 10;
    for (int i = 0; i < 100; ++i) {
        const double a = 0.5 * (low + high);
        (2 * a * std::sinh(c.S / (2 * a)) > c.n * c.l ? low : high) = a;
    }
    const double sag = low * (std::cosh(c.S / (2 * low)) - 1);
    double lowest = 0;
    for (int i = 0; i < c.n / 2; ++i) lowest += c.l * std::sin(c.slope(i, H));
    EXPECT_GT(std::abs(lowest + sag), 1e-5);
    EXPECT_NEAR(lowest, -sag, 1e-3);
}

/// Springs against gravity: each bears what hangs below it.
TEST(Equilibrium, OfMassesHungOnSprings)
{
    const Rest rest = rest_of_text(R"toml(
[[body]]
name = "upper"
shape = { point = true }
mass = 2
position = [0.4, 0.1, -0.2]
[[body]]
name = "lower"
shape = { point = true }
mass = 3
position = [1.1, 0, -0.3]
[[load]]
name = "first"
type = "spring"
between = ["world", "upper"]
points = [[0, 0, 0], [0, 0, 0]]
stiffness = 500
damping = 4
free_length = 0.5
[[load]]
name = "second"
type = "spring"
between = ["upper", "lower"]
points = [[0, 0, 0], [0, 0, 0]]
stiffness = 300
damping = 0
free_length = 0.7
)toml");
    const double z1 = -0.5 - 5 * 9.81 / 500, z2 = z1 - 0.7 - 3 * 9.81 / 300;
    EXPECT_NEAR(norm(rest.at.state.X[0].column(0) - Vector3{0, 0, z1}), 0, 1e-13);
    EXPECT_NEAR(norm(rest.at.state.X[1].column(0) - Vector3{0, 0, z2}), 0, 1e-13);
    EXPECT_EQ(rest.at.stability.stability, Stability::stable);
    ASSERT_EQ(rest.modes.size(), 6u);
    for (const VibrationMode& mode : rest.modes) EXPECT_GE(mode.damping_ratio(), -1e-14);
    EXPECT_GT(rest.modes.back().damping_ratio(), 0.01);
}

}   // namespace
}   // namespace livens::tests::rest_test
