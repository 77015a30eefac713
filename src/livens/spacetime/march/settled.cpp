// SPDX-License-Identifier: BSD-3-Clause
// Guesses that meet what is given at an end: theory.md, "Conditions by component".
#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/solvers/dense.h"
#include "livens/spacetime/march/components.h"
#include "livens/spacetime/march/end_point.h"

namespace livens::inline spacetime_internal {

namespace {

/// Least steps along free motions, until conditions at one end are met or no step helps.
class Settling {
public:
    Settling(const ModelTables& tables, std::vector<Condition> conditions, double duration)
        : tables_(tables), conditions_(std::move(conditions)), duration_(duration)
    {}

    /// A step moves no body by more than half a length or rad, by the sum over free motions; it is halved up
    /// to six times until it makes the largest miss smaller. At 1e-12 of their scales conditions are met.
    State settled(const State& guess) const
    {
        constexpr int most = 30;
        EndPoint one(tables_), other(tables_);
        EndPoint *now = &one, *trial = &other;
        if (!now->place(guess)) return guess;
        for (int i = 0; i < most && largest(*now) > 1e-12; ++i) {
            const std::vector<double> step = least_step(*now);
            double share = std::min(1.0, 0.5 / std::max(size_of(*now, step), 1e-300));
            bool is_better = false;
            for (int halvings = 0; halvings < 6 && !is_better; ++halvings, share *= 0.5)
                is_better = take(*now, step, share, *trial) && largest(*trial) < largest(*now);
            if (!is_better) break;
            std::swap(now, trial);
        }
        return now->state();
    }

private:
    double missing(const EndPoint& point, const Condition& one) const
    {
        const double off = one.value - point.value(one.quantity);
        return one.quantity.counts_turns() ? turned_to(off, 0) : off;
    }

    double largest(const EndPoint& point) const
    {
        double size = 0;
        for (const Condition& one : conditions_)
            size = std::max(size, std::abs(missing(point, one)) / scale_of(one, tables_.length, duration_));
        return size;
    }

    /// A^T (A A^T)^-1 of what is missing, rows by their scales and columns by sizes.
    std::vector<double> least_step(const EndPoint& point) const
    {
        const int f = tables_.freedoms(), m = static_cast<int>(conditions_.size());
        DenseMatrix A = point.derivatives(quantities_at(conditions_, false), point.basis(), 1 / duration_);
        std::vector<double> x(static_cast<std::size_t>(m)), sizes(static_cast<std::size_t>(2 * f));
        for (int j = 0; j < 2 * f; ++j) {
            sizes[j] = point.size_along(point.basis(), point.maps(), j % f) * (j < f ? 1 : duration_);
            for (int i = 0; i < m; ++i)
                A(i, j) /= sizes[j] * scale_of(conditions_[i], tables_.length, duration_);
        }
        Cholesky normal;
        normal.resize(m);
        for (int i = 0; i < m; ++i) {
            x[i] = missing(point, conditions_[i]) / scale_of(conditions_[i], tables_.length, duration_);
            for (int k = 0; k < m; ++k) {
                // keeps the matrix regular where conditions depend on each other; its entries are about 1
                double sum = i == k ? 1e-12 : 0;
                for (int j = 0; j < 2 * f; ++j) sum += A(i, j) * A(k, j);
                normal.row(i)[k] = sum;
            }
        }
        if (!normal.factorise()) return std::vector<double>(static_cast<std::size_t>(2 * f), 0.0);
        normal.solve(x.data());
        std::vector<double> step = transposed_product(A, x);
        for (int j = 0; j < 2 * f; ++j) step[j] /= sizes[j];
        return step;
    }

    double size_of(const EndPoint& point, const std::vector<double>& step) const
    {
        double size = 0;
        for (int j = 0; j < tables_.freedoms(); ++j)
            size += std::abs(step[j]) * point.size_along(point.basis(), point.maps(), j);
        return size;
    }

    bool take(const EndPoint& from, const std::vector<double>& step, double share, EndPoint& to) const
    {
        const int f = tables_.freedoms();
        std::vector<double> y(static_cast<std::size_t>(tables_.n_twists), 0.0), p = from.momenta(), along(y);
        for (int j = 0; j < f; ++j) {
            y[tables_.rank + j] = share * step[j];
            from.momenta_along(from.basis(), from.maps(), j, along.data());
            add_scaled(p, share * step[f + j], along);
        }
        from.basis().q.apply(y.data());
        return to.place_moved(from, y.data(), p);
    }

    const ModelTables& tables_;
    std::vector<Condition> conditions_;
    double duration_;
};

}   // namespace

State settled(const ModelTables& tables, const Ends& ends, Condition::At at, const State& guess)
{
    std::vector<Condition> here;
    for (const Condition& one : ends.components)
        if (one.at == at) here.push_back(one);
    if (here.empty() || tables.freedoms() == 0) return guess;
    return Settling(tables, std::move(here), ends.end.t - ends.start.t).settled(guess);
}

}   // namespace livens::inline spacetime_internal
