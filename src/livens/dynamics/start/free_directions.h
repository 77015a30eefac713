// SPDX-License-Identifier: BSD-3-Clause
// What the rows of joints leave free, direction by direction.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "livens/dynamics/rows/rank.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/multibody/model.h"
#include "livens/solvers/dense.h"

namespace livens::inline dynamics_internal {

/// What rows leave free, of which coordinates take one direction after the other.
class FreeDirections {
public:
    FreeDirections(const Model& model, std::span<const Matrix34> X, const std::vector<int>& independent)
        : n_(6 * model.n_bodies()), rank_(static_cast<int>(independent.size()))
    {
        basis_.resize(n_, rank_);
        const TwistRows held = twist_rows(model, X, independent);
        for (int k = 0; k < rank_; ++k) {
            std::fill_n(basis_.column(k), n_, 0.0);
            spread(held.rows[k], basis_.column(k));
        }
        std::vector<int> order(independent.size());
        basis_.factorise_pivoted(rank_, order);
    }

    /// False if rows and what was taken before hold it.
    bool take(const BodyRow& row)
    {
        std::vector<double> y(n_, 0.0);
        spread(row, y.data());
        basis_.apply_transposed(y.data());
        // In the coordinates of Q the first entries are what joints hold; the rest is what they leave free.
        std::fill_n(y.begin(), rank_, 0.0);
        for (int pass = 0; pass < 2; ++pass)   // the second takes the rounding of the first
            for (const std::vector<double>& other : taken_) {
                const double part = std::inner_product(y.begin(), y.end(), other.begin(), 0.0);
                for (int i = 0; i < n_; ++i) y[i] -= part * other[i];
            }
        const double size = std::sqrt(std::inner_product(y.begin(), y.end(), y.begin(), 0.0));
        if (!(size > least_part)) return false;
        for (double& entry : y) entry /= size;
        taken_.push_back(std::move(y));
        return true;
    }

private:
    static void spread(const BodyRow& row, double* y)
    {
        for (const BodyRow::Part& part : row.parts)
            for (int i = 0; i < 6; ++i) y[6 * part.body + i] += part.entries[i];
    }

    static constexpr double least_part = 1e-6;   // of a row of norm one, that is free
    int n_, rank_;
    OrthogonalBasis basis_;
    std::vector<std::vector<double>> taken_;
};

}   // namespace livens::inline dynamics_internal
