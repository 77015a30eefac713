// SPDX-License-Identifier: BSD-3-Clause
#include "properties/load_kit.h"

#include <algorithm>
#include <cmath>

#include "livens/solvers/dense_matrix.h"
#include "livens/solvers/factors.h"

namespace livens {

namespace {

LoadForces forces(const Load& load, const LoadArguments& at)
{
    LoadForces F(load.n_acted);
    load.forces(at, F);
    return F;
}

/// f'(0) by central differences of order 8.
template <typename Function>
auto derivative(Function f, double h)
{
    static constexpr double weights[4] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
    auto sum = (weights[0] / h) * (f(h) - f(-h));
    for (int k = 1; k < 4; ++k) sum += (weights[k] / h) * (f((k + 1) * h) - f(-(k + 1) * h));
    return sum;
}

constexpr int n_stacked = 48;   // of four bodies at most

/// Forces on all bodies as one column.
Matrix<n_stacked, 1> stacked(const LoadForces& F)
{
    Matrix<n_stacked, 1> column{};
    for (std::size_t b = 0; b < F.size(); ++b) std::copy_n(F[b].a, 12, column.a + 12 * b);
    return column;
}
int n_forces(const Load& load) { return 12 * static_cast<int>(load.n_acted); }

std::string decades(double error) { return "10^" + std::to_string(std::log10(std::abs(error) + 1e-300)); }

/// Compares the tangent by one variable of body c with differences; `of_V`: the variable is one of V.
void compare_column(const Load& load, const LoadArguments& at, const LoadTangent& tangent, bool of_V,
                    std::size_t c, int variable, Failures& failures)
{
    const Matrix<n_stacked, 1> expected = derivative(
        [&](double h) {
            LoadArguments moved = at;
            (of_V ? moved.V : moved.X)[c][variable] += h;
            return stacked(forces(load, moved));
        },
        2e-3);
    double error = 0, size = 1;
    for (int i = 0; i < n_forces(load); ++i) {
        if (load.bodies[i / 12] == world) continue;
        const double given = (of_V ? tangent.V : tangent.X)[i / 12][c](i % 12, variable);
        error = std::isnan(given) ? given : std::max(error, std::abs(given - expected[i]));
        size = std::max(size, std::abs(expected[i]));
    }
    if (!(error < 1e-9 * size))
        failures.push_back(std::string(of_V ? "dF/dV" : "dF/dX") + " of body " + std::to_string(c) +
                           ", variable " + std::to_string(variable) + " is off by " + decades(error));
}

/// With the flags down F must not change at all.
void compare_flag(const Load& load, const LoadArguments& at, bool of_V, Random& random, Failures& failures)
{
    LoadArguments moved = at;
    for (std::size_t b = 0; b < load.bodies.size(); ++b)
        if (load.bodies[b] != world) (of_V ? moved.V : moved.X)[b] += 0.1 * random.matrix<3, 4>();
    if (stacked(forces(load, moved)) != stacked(forces(load, at)))
        failures.push_back(std::string("it depends on ") + (of_V ? "V" : "X") + " and says that it does not");
}

double potential(const Load& load, const LoadArguments& at)
{
    return load.potential ? load.potential(at) : 0;
}

}   // namespace

LoadArguments random_arguments(Random& random, const Load& load, const LoadCase& load_case)
{
    LoadArguments at(load.bodies.size());
    at.at.t = random.number();
    for (std::size_t b = 0; b < load.bodies.size(); ++b) {
        if (load.bodies[b] == world) continue;
        at.X[b] = random.skew();
        at.V[b] = random.matrix<3, 4>();
    }
    if (load_case.place) {
        const std::array<Matrix34, 2> X = load_case.place(random);
        for (std::size_t b = 0; b < 2; ++b) at.X[b] = X[b];
    } else {
        at.X[0](0, 0) += 4;
    }
    return at;
}

Failures check_load_tangent(const LoadCase& load_case)
{
    Random random(1);
    Failures failures;
    for (int n = 0; n < of_states(1000) && failures.size() < 10; ++n) {
        const Load load = load_case.make(random);
        const LoadArguments at = random_arguments(random, load, load_case);
        LoadTangent tangent(load.bodies.size(), load.n_acted);
        if (load.depends_on_X || load.depends_on_V) load.tangent(at, tangent);
        for (const bool of_V : {false, true}) {
            if (!(of_V ? load.depends_on_V : load.depends_on_X)) {
                compare_flag(load, at, of_V, random, failures);
                continue;
            }
            for (std::size_t c = 0; c < load.bodies.size(); ++c)
                for (int variable = 0; load.bodies[c] != world && variable < 12; ++variable)
                    compare_column(load, at, tangent, of_V, c, variable, failures);
        }
    }
    return failures;
}

namespace {

/// f_k of F = sum f_k u_k; empty: F is no such sum.
std::vector<double> sizes_of_products(const Load& load, const LoadArguments& at)
{
    const std::vector<ProductSlopes> products = load.products(at);
    DenseMatrix U(n_stacked, static_cast<int>(products.size())), F(n_stacked, 1);
    const Matrix<n_stacked, 1> all = stacked(forces(load, at));
    std::copy_n(all.a, n_stacked, F.a.begin());
    for (int k = 0; k < U.cols; ++k) {
        const Matrix<n_stacked, 1> u = stacked(products[static_cast<std::size_t>(k)].direction);
        std::copy_n(u.a, n_stacked, U.a.begin() + static_cast<std::ptrdiff_t>(n_stacked * k));
    }
    std::vector<double> f = least_squares(U, F).a;
    add_scaled(F.a, -1, product(U, f));
    const bool is_sum = norm(F.a) <= 1e-11 * (1 + norm(std::span(all.a)));
    return is_sum ? f : std::vector<double>{};
}

/// The slopes of all sizes by one variable of body c.
void compare_products(const Load& load, const LoadArguments& at, bool of_V, std::size_t c, int variable,
                      Failures& failures)
{
    const std::vector<ProductSlopes> products = load.products(at);
    for (std::size_t k = 0; k < products.size(); ++k) {
        const double expected = derivative(
            [&](double h) {
                LoadArguments moved = at;
                (of_V ? moved.V : moved.X)[c][variable] += h;
                return sizes_of_products(load, moved).at(k);
            },
            2e-3);
        const double given = (of_V ? products[k].by_V : products[k].by_X)[c][variable];
        if (!(std::abs(given - expected) < 1e-8 * std::max(1.0, std::abs(expected))))
            failures.push_back(std::string("product ") + std::to_string(k) + " by " + (of_V ? "V" : "X") +
                               " of body " + std::to_string(c) + " is off by " + decades(given - expected));
    }
}

}   // namespace

Failures check_load_products(const LoadCase& load_case)
{
    Random random(7);
    Failures failures;
    for (int n = 0; n < of_states(20) && failures.size() < 10; ++n) {
        const Load load = load_case.make(random);
        LoadArguments at = random_arguments(random, load, load_case);
        if (!load.products) break;
        if (sizes_of_products(load, at).empty()) failures.push_back("F is no sum of its products");
        for (const bool of_V : {true, false}) {
            // what coordinates' rates have by X is left out
            if (!of_V) at.V = PerBody<Matrix34>(load.bodies.size());
            for (std::size_t c = 0; failures.empty() && c < load.bodies.size(); ++c)
                for (int variable = 0; load.bodies[c] != world && variable < 12; ++variable)
                    compare_products(load, at, of_V, c, variable, failures);
        }
    }
    return failures;
}

Failures check_load_energy(const LoadCase& load_case)
{
    Random random(2);
    Failures failures;
    for (int n = 0; n < 200; ++n) {
        const Load load = load_case.make(random);
        const LoadArguments at = random_arguments(random, load, load_case);
        const double gain = derivative(
            [&](double h) {
                LoadArguments moved = at;
                for (std::size_t b = 0; b < load.bodies.size(); ++b) moved.X[b] += h * at.V[b];
                return potential(load, moved);
            },
            2e-3);
        const double gap = load_power(load, at) + gain - power_without_potential(load, at);
        if (!(std::abs(gap) < 1e-9 * (1 + std::abs(gain))))
            failures.push_back("energy is lost: " + decades(gap));
    }
    return failures;
}

Failures check_load_potential(const LoadCase& load_case)
{
    Random random(3);
    Failures failures;
    for (int n = 0; n < 200; ++n) {
        const Load load = load_case.make(random);
        if (!load.potential) continue;
        LoadArguments at = random_arguments(random, load, load_case);
        at.V = PerBody<Matrix34>(at.V.size());
        const LoadForces F = forces(load, at);
        for (int i = 0; i < n_forces(load); ++i) {
            if (load.bodies[i / 12] == world) continue;
            const double slope = derivative(
                [&](double h) {
                    LoadArguments moved = at;
                    moved.X[i / 12][i % 12] += h;
                    return load.potential(moved);
                },
                2e-3);
            const double gap = F[i / 12][i % 12] + slope;
            if (!(std::abs(gap) < 1e-9 * (1 + std::abs(slope))))
                failures.push_back("F is not -dV/dX: " + decades(gap));
        }
    }
    return failures;
}

Failures check_load_breaks(const LoadCase& load_case)
{
    Random random(4);
    const Load load = load_case.make(random);
    const LoadArguments state = random_arguments(random, load, load_case);
    const auto force_at = [&](double t, Side side) {
        LoadArguments at = state;
        at.at = {t, side};
        return stacked(forces(load, at));
    };
    Failures failures;
    if (!std::ranges::is_sorted(load.breaks)) failures.push_back("breaks do not ascend");
    const double step = 1e-3;
    for (double t = -2; t < 4; t += step) {
        const bool broken =
            std::ranges::any_of(load.breaks, [&](double b) { return b >= t && b <= t + 2 * step; });
        if (broken) continue;
        const Matrix<n_stacked, 1> a = force_at(t, Side::middle), b = force_at(t + 2 * step, Side::middle);
        const Matrix<n_stacked, 1> bend = a - 2.0 * force_at(t + step, Side::middle) + b;
        if (!(largest(bend) < 1e-4 * (1 + largest(a))))
            failures.push_back("F bends or jumps at " + std::to_string(t));
    }
    for (const double t : load.breaks)
        for (const Side side : {Side::left, Side::right}) {
            const double beside = t + (side == Side::left ? -1e-9 : 1e-9);
            const double gap = largest(force_at(t, side) - force_at(beside, Side::middle));
            if (!(gap < 1e-6)) failures.push_back("a side is not its limit at " + std::to_string(t));
        }
    return failures;
}

Failures check_load_directors(const LoadCase& load_case)
{
    Random random(5);
    Failures failures;
    for (int n = 0; n < 20; ++n) {
        const Load load = load_case.make(random);
        const LoadForces F = forces(load, random_arguments(random, load, load_case));
        for (std::size_t b = 0; b < load.n_acted; ++b) {
            if (load.bodies[b] == world || load.needs_directors[b]) continue;
            if (std::any_of(F[b].a + 3, F[b].a + 12, [](double entry) { return entry != 0; }))
                failures.push_back("it acts on directors and says that it needs none");
        }
    }
    return failures;
}

Failures check_load(const LoadCase& load)
{
    Failures all;
    for (const auto check : {check_load_tangent, check_load_products, check_load_energy, check_load_potential,
                             check_load_breaks, check_load_directors, check_load_lanes})
        for (const std::string& failure : check(load)) all.push_back(load.what + ": " + failure);
    for (const std::string& failure : check_load_supply(load)) all.push_back(load.what + ": " + failure);
    Random random(6);
    if (load.make(random).type != load.type)
        all.push_back(load.what + ": its type is not '" + load.type + "'");
    return all;
}

}   // namespace livens
