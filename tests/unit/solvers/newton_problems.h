// SPDX-License-Identifier: BSD-3-Clause
// Systems of one to three equations for the tests of Newton's iteration.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "livens/solvers/dense.h"
#include "livens/solvers/newton.h"

namespace livens {

using Values = std::vector<double>;

inline double largest(const Values& x)
{
    double size = 0;
    for (double v : x) size = std::max(size, std::abs(v));
    return size;
}

/// f(x) = 0 with df/dx row by row.
class Equations : public NewtonProblem {
public:
    using Function = void (*)(const Values& x, Values& f);

    Equations(Values start, Function f, Function tangent)
        : x(std::move(start)), kept(x), rows_here(x.size()), f_(f), tangent_(tangent)
    {
        lu_.resize(n_unknowns());
        matrix_.resize(x.size() * x.size());
    }

    int n_unknowns() const override { return static_cast<int>(x.size()); }
    bool residual() override
    {
        ++n_residuals;
        f_(x, rows_here);
        for (double& r : rows_here) r *= row_factor;
        return std::isfinite(largest(rows_here)) && !std::isnan(sum(rows_here));
    }
    bool factorise() override
    {
        errors.push_back(solution.empty() ? 0 : distance(solution));
        tangent_(x, matrix_);
        for (double& v : matrix_) v *= row_factor;
        lu_.exchange(matrix_);
        return lu_.factorise();
    }
    void solve(std::span<double> dx) override
    {
        ++n_solves;
        for (std::size_t i = 0; i < dx.size(); ++i) dx[i] = -rows_here[i];
        lu_.solve(dx.data());
    }
    bool move(std::span<const double> dx, double damping) override
    {
        for (std::size_t i = 0; i < dx.size(); ++i) x[i] = kept[i] + damping * dx[i];
        return true;
    }
    void keep() override { kept = x; }
    double size_of(std::span<const double> dx) const override
    {
        double size = 0;
        for (double v : dx)
            if (!(std::abs(v) <= size)) size = std::abs(v);
        return size;
    }
    Rows rows() const override
    {
        return {.size = largest(rows_here),
                .terms = terms * row_factor,
                .rounding = rounding,
                .foretell = foretell};
    }

    double distance(const Values& y) const
    {
        double d = 0;
        for (std::size_t i = 0; i < x.size(); ++i) d = std::max(d, std::abs(x[i] - y[i]));
        return d;
    }

    Values x, kept, rows_here;
    double row_factor = 1;
    double terms = 1, rounding = 0;
    bool foretell = false;
    int n_residuals = 0, n_solves = 0;
    Values solution;   ///< if known: the distances from it where factors were made come into `errors`
    Values errors;

private:
    static double sum(const Values& v)
    {
        double s = 0;
        for (double x : v) s += x;
        return s;
    }

    Function f_, tangent_;
    Values matrix_;
    DenseLU lu_;
};

inline void linear(const Values& x, Values& f) { f = {2 * x[0] + x[1] - 3, x[0] - 3 * x[1] + 2}; }
inline void linear_tangent(const Values&, Values& J) { J = {2, 1, 1, -3}; }

inline void square(const Values& x, Values& f) { f[0] = x[0] * x[0] - 2; }
inline void square_tangent(const Values& x, Values& J) { J[0] = 2 * x[0]; }

inline void rosenbrock(const Values& x, Values& f)
{
    f[0] = 10 * (x[1] - x[0] * x[0]);
    f[1] = 1 - x[0];
}
inline void rosenbrock_tangent(const Values& x, Values& J)
{
    J[0] = -20 * x[0];
    J[1] = 10;
    J[2] = -1;
    J[3] = 0;
}

inline void arctangent(const Values& x, Values& f) { f[0] = std::atan(x[0]); }
inline void arctangent_tangent(const Values& x, Values& J) { J[0] = 1 / (1 + x[0] * x[0]); }

inline void logarithm(const Values& x, Values& f) { f[0] = std::log(x[0]); }
inline void logarithm_tangent(const Values& x, Values& J) { J[0] = 1 / x[0]; }

/// Nearly linear: Newton's factors from the start contract by about 0.03.
inline void mild(const Values& x, Values& f)
{
    f[0] = x[0] + 0.2 * x[1] * x[1] - 0.05;
    f[1] = x[1] - 0.2 * x[0] * x[0] - 0.06;
}
inline void mild_tangent(const Values& x, Values& J)
{
    J[0] = 1;
    J[1] = 0.4 * x[1];
    J[2] = -0.4 * x[0];
    J[3] = 1;
}

/// Rows with an error of a level that the problem may know or not.
class Noisy : public Equations {
public:
    using Equations::Equations;
    bool residual() override
    {
        const bool finite = Equations::residual();
        for (double& r : rows_here) {
            state_ = state_ * 6364136223846793005u + 1442695040888963407u;
            r += level * (2 * (static_cast<double>(state_ >> 11) * 0x1p-53) - 1);
        }
        return finite;
    }
    double level = 1e-13;

private:
    unsigned long long state_ = 1;
};

/// Increments and rows one after the other as written down, whatever the point; then zeros.
class Scripted : public NewtonProblem {
public:
    Scripted(Values increments, Values rows) : increments_(std::move(increments)), rows_(std::move(rows)) {}

    int n_unknowns() const override { return 1; }
    bool residual() override
    {
        size_ = next_row_ < rows_.size() ? rows_[next_row_] : 0;
        ++next_row_;
        return true;
    }
    bool factorise() override
    {
        solves_before.push_back(n_solves);
        steps_before.push_back(n_kept - 1);   // the start is kept first
        return true;
    }
    void solve(std::span<double> dx) override
    {
        const auto i = static_cast<std::size_t>(n_solves++);
        dx[0] = i < increments_.size() ? increments_[i] : 0;
    }
    bool move(std::span<const double>, double damping) override
    {
        dampings.push_back(damping);
        return true;
    }
    void keep() override { ++n_kept; }
    double size_of(std::span<const double> dx) const override { return std::abs(dx[0]); }
    double scale() const override { return length; }
    Rows rows() const override
    {
        return {.size = size_, .terms = 1, .rounding = rounding, .foretell = foretell};
    }

    bool foretell = false;
    double length = 1, rounding = 0;
    int n_solves = 0, n_kept = 0;
    std::vector<int> solves_before, steps_before;   ///< each factorisation
    Values dampings;                                ///< of all moves

private:
    Values increments_, rows_;
    std::size_t next_row_ = 0;
    double size_ = 0;
};

/// R with R a = b for two pairs of vectors: rows sum (R a_i) x b_i, moved by rotation vectors.
class Turning : public NewtonProblem {
public:
    using Vector = std::array<double, 3>;

    int n_unknowns() const override { return 3; }
    bool residual() override
    {
        rows_ = {0, 0, 0};
        for (int p = 0; p < 2; ++p) {
            const Vector u = turned(p), c = cross(u, b[p]);
            for (int i = 0; i < 3; ++i) rows_[i] += c[i];
        }
        return true;
    }
    bool factorise() override
    {
        lu_.resize(3);
        for (int p = 0; p < 2; ++p) {
            const Vector u = turned(p);
            for (int i = 0; i < 3; ++i)   // (xi x u) x b = u (xi b) - xi (u b)
                for (int j = 0; j < 3; ++j) lu_.row(i)[j] += u[i] * b[p][j] - (i == j ? dot(u, b[p]) : 0);
        }
        return lu_.factorise();
    }
    void solve(std::span<double> dx) override
    {
        for (std::size_t i = 0; i < 3; ++i) dx[i] = -rows_[i];
        lu_.solve(dx.data());
    }
    bool move(std::span<const double> dx, double damping) override
    {
        const Vector turn = {damping * dx[0], damping * dx[1], damping * dx[2]};
        for (int p = 0; p < 3; ++p) R[p] = rotated(turn, kept_[p]);
        return true;
    }
    void keep() override { kept_ = R; }
    double size_of(std::span<const double> dx) const override { return std::hypot(dx[0], dx[1], dx[2]); }
    Rows rows() const override { return {.size = std::hypot(rows_[0], rows_[1], rows_[2]), .terms = 1}; }

    Vector turned(int p) const
    {
        Vector u{};
        for (int k = 0; k < 3; ++k)
            for (int i = 0; i < 3; ++i) u[i] += R[k][i] * a[p][k];
        return u;
    }
    static double dot(const Vector& x, const Vector& y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; }
    static Vector cross(const Vector& x, const Vector& y)
    {
        return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
    }
    static Vector rotated(const Vector& w, const Vector& x)
    {
        const double angle = std::hypot(w[0], w[1], w[2]);
        if (angle == 0) return x;
        const double s = std::sin(angle) / angle, half = std::sin(angle / 2) / angle;
        const Vector wx = cross(w, x), wwx = cross(w, wx);
        Vector y{};
        for (int i = 0; i < 3; ++i) y[i] = x[i] + s * wx[i] + 2 * half * half * wwx[i];
        return y;
    }

    std::array<Vector, 2> a{Vector{1, 0.2, 0}, Vector{0, 1, -0.5}};
    std::array<Vector, 2> b{};
    std::array<Vector, 3> R{Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{0, 0, 1}};   // columns

private:
    Vector rows_{};
    std::array<Vector, 3> kept_{};
    DenseLU lu_;
};

inline NewtonReport run(NewtonProblem& problem, double tolerance = 1e-12)
{
    return Newton().run(problem, {.tolerance = tolerance, .max_iterations = 30, .goes_on = {}});
}

}   // namespace livens
