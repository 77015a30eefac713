// SPDX-License-Identifier: BSD-3-Clause
// Gauss, Gauss-Lobatto and right Radau rules on [0, 1]: the load points and nodes of theory.md, "The element"
// and "Radau points". Points are roots of combinations of Legendre polynomials, found by Newton's iteration;
// weights are the closed forms in P_n at the roots.
#include "livens/time/quadrature.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "livens/base/error.h"

namespace livens {
namespace {

// Points and weights are worked out in long double, so that what is rounded to double in the end is right to
// the last bit on machines where long double is longer; elsewhere an ulp or two is lost.
using Real = long double;

constexpr int max_points = 64;
constexpr int max_iterations = 20;   // 4 or 5 are needed; the cap ends a walk at rounding level

struct LegendrePair {
    // Both are kept, since P_n' and all weights are combinations of two neighbours.
    Real p;          // P_n(x)
    Real previous;   // P_{n-1}(x)
};

/// Three-term recurrence, n >= 1.
LegendrePair legendre(int n, Real x)
{
    LegendrePair l{x, 1};
    for (int k = 2; k <= n; ++k) {
        const Real next = ((2 * k - 1) * x * l.p - (k - 1) * l.previous) / k;
        l = {next, l.p};
    }
    return l;
}

/// Newton's method from x with the given step (f/f').
template <class Step>
Real newton(Real x, Step step)
{
    for (int i = 0; i < max_iterations; ++i) {
        const Real dx = step(x);
        // The step is taken before the test: convergence is quadratic, so the last one costs nothing and
        // gains a digit.
        x -= dx;
        if (std::fabs(dx) <= 2 * std::numeric_limits<Real>::epsilon()) break;
    }
    return x;
}

/// Enters the pair of points (1 -+ x) / 2 with the weight on [-1, 1]. The larger point is 1 minus the smaller
/// one as it was rounded, hence the symmetry to the bit; the smaller one keeps its full relative precision.
void set_pair(Quadrature& rule, int i, Real x, Real weight)
{
    const std::size_t low = static_cast<std::size_t>(i), high = rule.points.size() - 1 - low;
    rule.points[low] = static_cast<double>((1 - x) / 2);
    rule.points[high] = 1 - rule.points[low];
    rule.weights[low] = rule.weights[high] = static_cast<double>(weight / 2);
}

Quadrature empty_rule(int n, int fewest)
{
    if (n < fewest || n > max_points) {
        throw InputError({"quadrature-points", "quadrature.points", "there is no such quadrature rule",
                          std::to_string(n), std::to_string(fewest) + " .. " + std::to_string(max_points), "",
                          ""});
    }
    const std::size_t size = static_cast<std::size_t>(n);
    return {std::vector<double>(size), std::vector<double>(size)};
}

}   // namespace

Quadrature gauss(int n_points)
{
    const int n = n_points;
    Quadrature rule = empty_rule(n, 1);
    // P_n' = n (P_{n-1} - x P_n) / (1 - x^2). The denominator is kept as a product, which loses no digits
    // near the ends, where points crowd.
    const auto slope = [n](Real x, const LegendrePair& l) {
        return n * (l.previous - x * l.p) / ((1 - x) * (1 + x));
    };
    for (int i = 0; i < (n + 1) / 2; ++i) {
        // Only half of the roots is sought; set_pair() mirrors them. The guess is the leading term of their
        // asymptotic expansion, from which Newton's iteration converges quadratically.
        const bool middle = 2 * i + 1 == n;
        const Real guess = std::cos(std::numbers::pi_v<Real> * (i + 0.75L) / (n + 0.5L));
        const Real x = middle ? 0 : newton(guess, [&](Real y) {
            const LegendrePair l = legendre(n, y);
            return l.p / slope(y, l);
        });
        const Real dp = slope(x, legendre(n, x));
        set_pair(rule, i, x, 2 / ((1 - x) * (1 + x) * dp * dp));
    }
    return rule;
}

Quadrature gauss_lobatto(int n_points)
{
    const int n = n_points - 1;   // inner points are the roots of P_n'
    Quadrature rule = empty_rule(n_points, 2);
    for (int i = 0; i < (n_points + 1) / 2; ++i) {
        // The ends are points of the rule and stay at 1 to the bit; the middle one of an odd rule stays at 0.
        Real x = 1;
        if (2 * i == n) {
            x = 0;
        } else if (i > 0) {
            // (1 - x^2) P_n' = n (P_{n-1} - x P_n), whose derivative is -n (n + 1) P_n.
            x = newton(std::cos(std::numbers::pi_v<Real> * i / n), [n](Real y) {
                const LegendrePair l = legendre(n, y);
                return (y * l.p - l.previous) / ((n + 1) * l.p);
            });
        }
        const Real p = legendre(n, x).p;
        set_pair(rule, i, x, 2 / (n * (n + 1) * p * p));
    }
    return rule;
}

Quadrature radau(int n_points)
{
    const int n =
        n_points;   // points are the roots of P_n - P_{n-1}, whose slope is n (P_n + P_{n-1}) / (1 + x)
    Quadrature rule = empty_rule(n, 1);
    for (int i = 0; i < n; ++i) {
        // The roots are not symmetric, so each is sought for itself; the guesses are the points of the rule
        // of Chebyshev, Gauss and Radau, which lie close to these.
        const Real guess = std::cos(2 * std::numbers::pi_v<Real> * (n - 1 - i) / (2 * n - 1));
        const Real x = i == n - 1 ? 1 : newton(guess, [n](Real y) {
            const LegendrePair l = legendre(n, y);
            return (l.p - l.previous) * (1 + y) / (n * (l.p + l.previous));
        });
        const Real p = legendre(n, x).previous;
        rule.points[static_cast<std::size_t>(i)] = static_cast<double>((1 + x) / 2);
        rule.weights[static_cast<std::size_t>(i)] = static_cast<double>((1 + x) / (2 * n * n * p * p));
    }
    return rule;
}

}   // namespace livens
