// SPDX-License-Identifier: BSD-3-Clause
// Norms of matrices known by their products alone.
// The 1-norm is estimated by block search over columns [Higham2000], the 2-norm by Golub and Kahan's
// bidiagonalisation with bisection. Both need products alone, and so serve the inverse by solutions:
// theory.md, "The whole matrix of lobatto".
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "livens/solvers/sparse.h"

namespace livens {

namespace {

using Values = std::vector<double>;
using Columns = std::vector<Values>;

constexpr double not_representable = std::numeric_limits<double>::infinity();

/// Fixed pseudo-random numbers: the standard prescribes this engine's, to the bit.
class Random {
public:
    double sign() { return engine_() >> 63 ? 1.0 : -1.0; }
    /// Uniform in [0, 1).
    double fraction() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

private:
    std::mt19937_64 engine_;
};

double sum_of_sizes(const Values& x)
{
    double sum = 0;
    for (double v : x) sum += std::abs(v);
    return sum;
}

// --- the 1-norm: algorithm 2.4 of [Higham2000], with its names ---

constexpr int n_columns = 4;      ///< t: vectors that search at a time
constexpr int n_iterations = 5;   ///< itmax; two or three are the rule

bool parallel(const Values& s, const Values& other)
{
    const double product = std::inner_product(s.begin(), s.end(), other.begin(), 0.0);
    return std::abs(product) == static_cast<double>(s.size());   // sums of +-1 are exact
}

bool parallel_to_any(const Values& s, const Columns& others, std::size_t n)
{
    return std::any_of(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(n),
                       [&](const Values& other) { return parallel(s, other); });
}

/// Columns of signs that tell nothing new are replaced by random ones. There are 2^(size - 1) >= 16
/// directions and at most 7 to avoid, so that a try fails with a chance of a half at most.
void renew_parallel(Columns& S, const Columns& old, Random& random)
{
    for (std::size_t j = 0; j < S.size(); ++j)
        for (int tries = 0; tries < 50; ++tries) {
            if (!parallel_to_any(S[j], S, j) && !parallel_to_any(S[j], old, old.size())) break;
            for (double& s : S[j]) s = random.sign();
        }
}

void take_signs(const Columns& Y, Columns& S)
{
    for (std::size_t j = 0; j < Y.size(); ++j)
        for (std::size_t i = 0; i < Y[j].size(); ++i) S[j][i] = Y[j][i] >= 0 ? 1.0 : -1.0;
}

/// h_i = max_j |Z_ij|: how fast |A x|_1 grows towards unit vector i.
Values largest_of_rows(const Columns& Z)
{
    Values h(Z.front().size(), 0.0);
    for (const Values& z : Z)
        for (std::size_t i = 0; i < h.size(); ++i) h[i] = std::max(h[i], std::abs(z[i]));
    return h;
}

class OneNormSearch {
public:
    explicit OneNormSearch(std::size_t size)
        : size_(size), X_(n_columns, Values(size, 1.0)), Y_(X_), S_(X_), tried_(size, 0)
    {
        // The first column stays all ones, as in the published algorithm; the others get random signs.
        renew_parallel(X_, {}, random_);
        for (Values& x : X_)
            for (double& v : x) v /= static_cast<double>(size);
    }

    double run(const LinearMap& apply, const LinearMap& apply_transposed)
    {
        for (int iteration = 0; iteration < n_iterations; ++iteration) {
            // The three ways to end are those of the paper: no longer column, no new signs, or the steepest
            // unit vector is the one that gave the estimate. Every estimate is a lower bound of the norm.
            if (!improve(apply)) break;
            const Columns old_S = iteration == 0 ? Columns() : S_;
            take_signs(Y_, S_);
            const bool nothing_new = std::all_of(S_.begin(), S_.end(), [&](const Values& s) {
                return parallel_to_any(s, old_S, old_S.size());
            });
            if (nothing_new) break;
            renew_parallel(S_, old_S, random_);
            for (std::size_t j = 0; j < S_.size(); ++j) apply_transposed(S_[j], Y_[j]);
            const Values h = largest_of_rows(Y_);
            const double steepest = *std::max_element(h.begin(), h.end());
            if (!std::isfinite(steepest)) return not_representable;
            const bool local_maximum = !units_.empty() && steepest == h[units_[best_]];
            if (local_maximum || !choose_unit_vectors(h)) break;
        }
        return estimate_;
    }

private:
    /// Y = A X. True if a column of Y is longer than all before; false too where one is not finite.
    bool improve(const LinearMap& apply)
    {
        bool improved = false;
        for (std::size_t j = 0; j < X_.size(); ++j) {
            apply(X_[j], Y_[j]);
            const double sum = sum_of_sizes(Y_[j]);
            if (!std::isfinite(sum)) {
                estimate_ = not_representable;
                return false;
            }
            if (sum <= estimate_) continue;
            estimate_ = sum;
            best_ = j;
            improved = true;
        }
        return improved;
    }

    /// X becomes the unit vectors of the largest h that were not tried yet; false if there are none.
    bool choose_unit_vectors(const Values& h)
    {
        units_.clear();
        for (std::size_t i = 0; i < size_; ++i)
            if (!tried_[i]) units_.push_back(i);
        const std::size_t n = std::min<std::size_t>(n_columns, units_.size());
        std::partial_sort(units_.begin(), units_.begin() + static_cast<std::ptrdiff_t>(n), units_.end(),
                          [&](std::size_t a, std::size_t b) {
                              return h[a] != h[b] ? h[a] > h[b] : a < b;   // ties by place: repeatable
                          });
        units_.resize(n);
        X_.assign(n, Values(size_, 0.0));
        Y_.resize(n);
        S_.resize(n);
        for (std::size_t j = 0; j < n; ++j) {
            X_[j][units_[j]] = 1;
            tried_[units_[j]] = 1;
        }
        return n > 0;
    }

    std::size_t size_;
    Random random_;
    Columns X_, Y_, S_;
    std::vector<char> tried_;
    std::vector<std::size_t> units_;   // X_j = e_(units[j]), from the second iteration on
    std::size_t best_ = 0;             // the column of X that gave the estimate
    double estimate_ = 0;
};

/// Largest column sum by the unit vectors, one product each.
double one_norm_exactly(std::size_t size, const LinearMap& apply)
{
    Values x(size, 0.0), y(size);
    double largest = 0;
    for (std::size_t j = 0; j < size; ++j) {
        x[j] = 1;
        apply(x, y);
        x[j] = 0;
        const double sum = sum_of_sizes(y);
        if (!std::isfinite(sum)) return not_representable;
        largest = std::max(largest, sum);
    }
    return largest;
}

// --- the 2-norm ---

/// Without overflow of the squares: norms of inverses may be of any size.
double length(const Values& x)
{
    double largest = 0;
    for (double v : x) {
        if (!std::isfinite(v)) return not_representable;
        largest = std::max(largest, std::abs(v));
    }
    if (largest == 0) return 0;
    double sum = 0;
    for (double v : x) sum += (v / largest) * (v / largest);
    return largest * std::sqrt(sum);
}

/// Entries of size 1/2 to 1 with random signs: no unit vector and, but for a freak, no smooth one is far from
/// it.
Values starting_vector(std::size_t size)
{
    Random random;
    Values v(size);
    for (double& x : v) {
        const double sign = random.sign();
        x = sign * (0.5 + 0.5 * random.fraction());
    }
    const double norm = length(v);
    for (double& x : v) x /= norm;
    return v;
}

/// Whether every eigenvalue of the symmetric tridiagonal matrix with zero diagonal and `couplings` is below x
/// > 0: its eigenvalues are +- the singular values of the bidiagonal matrix that holds the couplings in turn.
bool all_below(double x, const Values& couplings)
{
    // Sylvester's law of inertia: all pivots of T - x are negative if and only if all eigenvalues lie below
    // x.
    double pivot = -x;
    for (double c : couplings) {
        pivot = -x - (c / pivot) * c;
        if (!(pivot < 0)) return false;
    }
    return true;
}

/// Largest singular value, to rounding, by bisection from `low`, which is known not to exceed it.
double largest_singular_value(const Values& couplings, double low)
{
    // Gershgorin's bound: the row sums of a matrix with zero diagonal. Widened by a few spacings for its own
    // rounding.
    double high = couplings.front();
    for (std::size_t i = 1; i < couplings.size(); ++i) high = std::max(high, couplings[i - 1] + couplings[i]);
    high *= 1 + 4 * std::numeric_limits<double>::epsilon();
    while (true) {
        const double middle = low + 0.5 * (high - low);
        if (middle <= low || middle >= high) return middle;
        (all_below(middle, couplings) ? high : low) = middle;
    }
}

/// Golub and Kahan's two-sided Lanczos process, A V = U B with B upper bidiagonal. [Golub2013, 10.4]
/// Vectors are not orthogonalised again: what is lost with orthogonality is that converged values come twice,
/// and of the largest one a copy does no harm. So the memory is three vectors, however slow the convergence.
class Bidiagonalisation {
public:
    Bidiagonalisation(std::size_t size, const LinearMap& apply, const LinearMap& apply_transposed)
        : apply_(apply), apply_transposed_(apply_transposed), v_(starting_vector(size)), u_(size, 0.0),
          product_(size)
    {}

    /// One more column of B. False if there is none: the process has found an invariant subspace, or
    /// overflowed.
    bool advance()
    {
        if (!couplings_.empty()) {
            apply_transposed_(u_, product_);
            if (!replace(v_)) return false;
        }
        apply_(v_, product_);
        return replace(u_);
    }
    bool overflowed() const { return overflowed_; }
    /// The diagonal of B and what stands above it, in turn.
    const Values& couplings() const { return couplings_; }

private:
    /// old <- (product - last coupling * old) / its length, which is the next coupling.
    bool replace(Values& old)
    {
        const double last = couplings_.empty() ? 0 : couplings_.back();
        for (std::size_t i = 0; i < old.size(); ++i) old[i] = product_[i] - last * old[i];
        const double norm = length(old);
        overflowed_ = !std::isfinite(norm);
        largest_ = std::max(largest_, norm);
        // What is left after rounding has no direction.
        if (overflowed_ || norm <= 8 * std::numeric_limits<double>::epsilon() * largest_) return false;
        for (double& x : old) x /= norm;
        couplings_.push_back(norm);
        return true;
    }

    const LinearMap& apply_;
    const LinearMap& apply_transposed_;
    Values v_, u_, product_, couplings_;
    double largest_ = 0;
    bool overflowed_ = false;
};

}   // namespace

double one_norm(int n, const LinearMap& apply, const LinearMap& apply_transposed)
{
    const auto size = static_cast<std::size_t>(n);
    return n <= n_columns ? one_norm_exactly(size, apply) : OneNormSearch(size).run(apply, apply_transposed);
}

double two_norm(int n, const LinearMap& apply, const LinearMap& apply_transposed)
{
    if (n == 0) return 0;
    // The largest value of a spectrum without gaps is met like 1/k^2 in the number k of steps. From one check
    // to the next k grows by 5/4, so what is missing is then 16/9 of the last change; with a gap it is far
    // less. Ends when 2 * change <= tolerance * value.
    const double tolerance = 1e-6;
    const int most_steps = 1200;
    Bidiagonalisation process(static_cast<std::size_t>(n), apply, apply_transposed);
    double value = 0;
    for (int step = 1, check = 6; step <= most_steps; ++step) {
        const bool goes_on = process.advance();
        if (process.overflowed()) return not_representable;
        if (process.couplings().empty()) return 0;
        if (goes_on && step < check && step < most_steps) continue;
        const double last = value;
        // The value never falls from step to step, so the last one is a lower bound to begin the bisection
        // from.
        value = largest_singular_value(process.couplings(), last);
        if (!goes_on || 2 * (value - last) <= tolerance * value) break;
        check = check + (check + 3) / 4;
    }
    return value;
}

}   // namespace livens
