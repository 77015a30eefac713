// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include "livens/base/error.h"
#include "livens/time/quadrature.h"
#include "mechanisms.h"
#include "newton_euler.h"
#include "properties/integrator_kit.h"

namespace livens::integrator_kit_test {
namespace {

using Check = Failures (*)(const IntegratorCase&);

void expect_all_pass(Check check)
{
    for (const IntegratorCase& c : integrator_cases()) EXPECT_EQ(joined(check(c)), "") << c.what;
}

TEST(IntegratorKit, LONG_EveryMethodHasItsOrder) { expect_all_pass(check_integrator_order); }
TEST(IntegratorKit, LONG_EveryMethodIsRetracedAsStated) { expect_all_pass(check_integrator_reversal); }
TEST(IntegratorKit, EveryMethodKeepsWhatIsStated) { expect_all_pass(check_integrator_invariants); }
TEST(IntegratorKit, LONG_EveryMethodIsStableAsStated) { expect_all_pass(check_integrator_stability); }
TEST(IntegratorKit, LONG_EveryMethodIsStableInTurnsAsStated)
{
    expect_all_pass(check_integrator_stability_of_turns);
}

TEST(IntegratorKit, LONG_EveryMethodIsStableUnderPreloadAsStated)
{
    expect_all_pass(check_integrator_stability_with_preload);
}

bool has(const std::function<bool(const Method&)>& wanted)
{
    return std::ranges::any_of(integrator_cases(),
                               [&](const IntegratorCase& c) { return wanted(c.method); });
}

TEST(IntegratorKit, EveryFamilyIsInTheRegistry)
{
    for (std::size_t i = 0; i < std::variant_size_v<Method>; ++i)
        EXPECT_TRUE(
            has([=](const Method& method) { return method.index() == i; }) ||
            i == Method(AutomaticFamily{}).index())   // the choice between two others, with an accuracy only
            << i;
}

TEST(IntegratorKit, EveryDegreeOfLobattoIsInTheRegistry)
{
    const Model model = tests::free_box();
    int degrees = 0;
    for (int p = -1; p <= 64; ++p) {
        try {
            solve(model, {model.start()}, make_time_mesh(0, 0.01, 1), Lobatto{p});
        } catch (const InputError&) {
            continue;
        }
        ++degrees;
        EXPECT_TRUE(has([=](const Method& method) {
            const auto* lobatto = std::get_if<Lobatto>(&method);
            return lobatto && lobatto->degree == p;
        })) << p;
    }
    EXPECT_GE(degrees, 16);
}

/// How many enumerators method.h has.
int n_enumerators(const std::string& name)
{
    std::ifstream file(std::string(LIVENS_SOURCE_DIR) + "/src/livens/spacetime/method.h");
    std::string header{std::istreambuf_iterator<char>(file), {}};
    header = std::regex_replace(header, std::regex("//[^\n]*"), "");
    std::smatch found;
    if (!std::regex_search(header, found, std::regex("enum class " + name + "\\s*\\{([^}]*)\\}"))) return 0;
    const std::string list = found[1];
    return static_cast<int>(std::ranges::count(list, ',')) + 1;
}

TEST(IntegratorKit, EveryPairingOfMixedThatIsAcceptedIsInTheRegistry)
{
    const Model model = tests::free_box();
    const int bases = n_enumerators("Basis"), starts = n_enumerators("Start"),
              multipliers = n_enumerators("Multipliers");
    ASSERT_GE(bases * starts * multipliers, 12);
    int accepted = 0;
    for (int i = 0; i < bases * starts * multipliers; ++i) {
        Mixed wanted;
        wanted.basis = static_cast<Mixed::Basis>(i % bases);
        wanted.start = static_cast<Mixed::Start>(i / bases % starts);
        wanted.multipliers = static_cast<Mixed::Multipliers>(i / bases / starts);
        if (wanted.basis == Mixed::Basis::nurbs) wanted.weights.assign(6, 1.0);
        try {
            check_method(model, {model.start()}, make_time_mesh(0, 1, 4), wanted);
        } catch (const InputError&) {
            continue;
        }
        ++accepted;
        EXPECT_TRUE(has([&](const Method& method) {
            const auto* mixed = std::get_if<Mixed>(&method);
            return mixed && mixed->basis == wanted.basis && mixed->start == wanted.start &&
                   mixed->multipliers == wanted.multipliers;
        })) << name_of(wanted);
    }
    EXPECT_EQ(accepted, 12);
}

const IntegratorCase& find_case(const std::string& what)
{
    const auto found = std::ranges::find(integrator_cases(), what, &IntegratorCase::what);
    if (found == integrator_cases().end()) throw std::runtime_error("no case " + what);
    return *found;
}

bool fails(Check check, const IntegratorCase& c) { return !check(c).empty(); }

/// A case of the registry with another statement.
template <typename Change>
IntegratorCase restated(const std::string& what, Change change)
{
    IntegratorCase c = find_case(what);
    change(c);
    return c;
}

TEST(IntegratorKit, AnotherOrderThanStatedFails)
{
    for (const double off : {-0.2, 0.2})
        for (std::size_t i = 0; i < n_problems; ++i) {
            const IntegratorCase wrong = restated("lobatto(2)", [=](IntegratorCase& c) {
                c.orders = {};
                c.orders[i].order = 4 + off;
            });
            EXPECT_TRUE(fails(check_integrator_order, wrong)) << i << " off by " << off;
        }
}

TEST(IntegratorKit, MoreThanIsStatedFailsToo)
{
    EXPECT_TRUE(fails(check_integrator_reversal,
                      restated("lobatto(3)", [](IntegratorCase& c) { c.reversal = Reversal::points; })));
    EXPECT_TRUE(fails(check_integrator_invariants, restated("lobatto(3)", [](IntegratorCase& c) {
                          c.keeps_angular_momentum = false;
                      })));
    EXPECT_TRUE(fails(check_integrator_invariants,
                      restated("lobatto(3)", [](IntegratorCase& c) { c.holds = Holds::weakly; })));
    EXPECT_TRUE(fails(check_integrator_stability,
                      restated("lobatto(3)", [](IntegratorCase& c) { c.is_stable = false; })));
}

TEST(IntegratorKit, ImplicitEulerIsNotReversible)
{
    for (const Reversal reversal : {Reversal::points, Reversal::always})
        EXPECT_TRUE(fails(check_integrator_reversal, restated("endpoint", [=](IntegratorCase& c) {
                              c.reversal = reversal;
                          })));
}

TEST(IntegratorKit, WhatLosesMomentumOrStrainsDirectorsFails)
{
    EXPECT_TRUE(fails(check_integrator_invariants,
                      restated("endpoint", [](IntegratorCase& c) { c.keeps_angular_momentum = true; })));
    EXPECT_TRUE(fails(check_integrator_invariants,
                      restated("mixed(lagrange, 2, strong, equal)",
                               [](IntegratorCase& c) { c.keeps_angular_momentum = true; })));
    EXPECT_TRUE(fails(check_integrator_invariants,
                      restated("mixed(lagrange, 2, natural, equal)",
                               [](IntegratorCase& c) { c.holds = Holds::nodes; })));
    IntegratorCase wrong = find_case("lobatto(3)");
    wrong.run = [run = wrong.run](const Model& model, const State& start, const TimeMesh& mesh) {
        Solution s = run(model, start, mesh);
        double factor = 1;
        for (Matrix34& P : s.motion.momenta) P *= factor += 1e-10;
        return s;
    };
    EXPECT_TRUE(fails(check_integrator_invariants, wrong));
}

// The loads of a point on a line at other quadrature points, from the rows of DESIGN.md, 4.1 and 8: with the
// nodes themselves these are the Lobatto IIIA-IIIB pair.

/// Lagrange polynomial A of the nodes, or its derivative, at s.
double lagrange(const std::vector<double>& nodes, std::size_t A, double s, bool is_derivative)
{
    double value = 1, slope = 0;
    for (std::size_t B = 0; B < nodes.size(); ++B) {
        if (B == A) continue;
        const double scale = 1 / (nodes[A] - nodes[B]);
        slope = slope * (s - nodes[B]) * scale + value * scale;
        value *= (s - nodes[B]) * scale;
    }
    return is_derivative ? slope : value;
}

struct LinePoint {
    double x, v;
};

/// After one element of length h: sum_B k_AB x_B / h + h sum_c w_c M_A(s_c) F(s_c) = -v at the first node, 0
/// inside and v at the last, with F = -stiffness x - damping x' and a mass of 1.
LinePoint element_by_hand(int p, const Quadrature& loads, double h, double stiffness, double damping,
                          const LinePoint& start)
{
    const std::vector<double> nodes = gauss_lobatto(p + 1).points;
    const Quadrature exact = gauss(p);
    const std::size_t n = nodes.size();
    tests::Numbers rows(n * n, 0.0);   // d r_A / d x_B
    for (std::size_t A = 0; A < n; ++A)
        for (std::size_t B = 0; B < n; ++B) {
            for (std::size_t c = 0; c < exact.points.size(); ++c)
                rows[A * n + B] += exact.weights[c] * lagrange(nodes, A, exact.points[c], true) *
                                   lagrange(nodes, B, exact.points[c], true) / h;
            for (std::size_t c = 0; c < loads.points.size(); ++c)
                rows[A * n + B] -= h * loads.weights[c] * lagrange(nodes, A, loads.points[c], false) *
                                   (stiffness * lagrange(nodes, B, loads.points[c], false) +
                                    damping / h * lagrange(nodes, B, loads.points[c], true));
        }
    // unknown: x_1 .. x_p and v at the end; known: x_0 and v at the start
    tests::Numbers a(n * n, 0.0), b(n);
    for (std::size_t A = 0; A < n; ++A) {
        for (std::size_t B = 1; B < n; ++B) a[A * n + B - 1] = rows[A * n + B];
        b[A] = -rows[A * n] * start.x - (A == 0 ? start.v : 0);
    }
    a[n * n - 1] = -1;
    const tests::Numbers solution = tests::solution_of(a, b);
    return {solution[n - 2], solution[n - 1]};
}

/// A method for models of one point on a line, whose loads are linear.
IntegratorCase by_hand(int p, const Quadrature& loads)
{
    IntegratorCase c = integrator_case(Lobatto{p}, "by hand");
    c.is_stable = true;
    c.run = [=](const Model& model, const State& start, const TimeMesh& mesh) {
        auto force = [&](double x, double v) {
            LoadArguments at;
            at.X[1] = configuration({x, 0, 0}, {});
            at.V[1] = configuration({v, 0, 0}, {});
            LoadForces F{};
            model.loads()[0].forces(at, F);
            return F[1](0, 0);
        };
        const double stiffness = -force(1, 0), damping = -force(1, 1) - stiffness;
        const LinePoint end = element_by_hand(p, loads, mesh.length(0), stiffness, damping,
                                              {start.X[0](0, 0), start.V[0](0, 0)});
        Solution s;
        s.motion.n_bodies = 1;
        s.motion.mesh = mesh;
        s.motion.X = {12, 1, true, std::vector<double>(24, 0.0), {}};
        s.motion.X.values[12] = end.x;
        s.motion.velocities = {start.V[0], configuration({end.v, 0, 0}, {})};
        s.motion.momenta = s.motion.velocities;
        return s;
    };
    return c;
}

TEST(IntegratorKit, LoadsAtGaussPointsByHandAreStable)
{
    for (int p = 1; p <= 8; ++p)
        EXPECT_EQ(joined(check_integrator_stability(by_hand(p, gauss(p)))), "") << p;
}

TEST(IntegratorKit, LoadsAtNodesAreNotStable)
{
    for (const int p : {1, 2, 3, 4, 6, 8, 12})
        EXPECT_TRUE(fails(check_integrator_stability, by_hand(p, gauss_lobatto(p + 1)))) << p;
}

TEST(IntegratorKit, OneGaussPointTooFewIsNotStable)
{
    for (int p = 2; p <= 8; ++p)
        EXPECT_TRUE(fails(check_integrator_stability, by_hand(p, gauss(p - 1)))) << p;
}

/// x and v after one element of a mass of 1 kg, from x or from v.
LinePoint element_of_the_library(int p, double stiffness, double damping, const LinePoint& start)
{
    Model model;
    model.add_body(point_mass("mass", 1, {start.x, 0, 0}, {start.v, 0, 0}));
    model.add_load(spring_damper("spring", world, {}, 0, {}, {stiffness, damping, 0}));
    const Solution s = find_case("lobatto(" + std::to_string(p) + ")")
                           .run(model, model.start(), make_time_mesh(0, 1, 1));
    EXPECT_TRUE(s.report.converged()) << s.report.message;
    const State end = tests::last(s);
    return {end.X[0](0, 0), end.V[0](0, 0)};
}

// So that the library is stable for the right reason.
TEST(IntegratorKit, TheLibrarysElementIsThatByHand)
{
    for (int p = 1; p <= 8; ++p)
        for (const double omega : {0.3, 3.0, 30.0, 300.0})
            for (const double zeta : {0.0, 0.5, 20.0})
                for (const LinePoint start : {LinePoint{1 / omega, 0}, {0, 1}}) {
                    const double damping = 2 * zeta * omega;
                    const LinePoint there = element_of_the_library(p, omega * omega, damping, start);
                    const LinePoint here =
                        element_by_hand(p, gauss(p), 1, omega * omega, damping, start);
                    EXPECT_NEAR(there.x * omega, here.x * omega, 1e-11) << p << " " << omega << " " << zeta;
                    EXPECT_NEAR(there.v, here.v, 1e-11) << p << " " << omega << " " << zeta;
                }
}

TEST(IntegratorKit, SpectralRadiiAreThoseOfTheirMaps)
{
    EXPECT_DOUBLE_EQ(spectral_radius({0, 1, -1, 0}), 1);
    EXPECT_DOUBLE_EQ(spectral_radius({2, 5, 0, -3}), 3);
    EXPECT_DOUBLE_EQ(spectral_radius({1, 2, -2, 1}), std::sqrt(5));
}

}   // namespace
}   // namespace livens::integrator_kit_test
