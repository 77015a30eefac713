// SPDX-License-Identifier: BSD-3-Clause
// What nearest_rates() says, of many states of one model.
#pragma once

#include <span>
#include <vector>

#include "livens/dynamics/instant/instant.h"
#include "livens/dynamics/rows/tables.h"

namespace livens::inline dynamics_internal {

/// Rates [v, w x d_i] that rows allow, nearest to given ones in the mass metric: by elimination along the
/// joints where these hold the rows well, as nearest_rates() does else.
class NearestRates {
public:
    /// `rows`: independent ones, which do not depend on time. The model must outlive it.
    NearestRates(const Model& model, std::span<const int> rows);

    /// `V`: rigid, too.
    std::vector<Matrix34> at(double t, std::span<const Matrix34> X, std::span<const Matrix34> V);

private:
    bool project(double t, std::span<const Matrix34> X, std::span<const Matrix34> V);

    ModelTables tables_;
    bool is_sparse_;
    InstantSystem instant_;
    InstantState state_;
    std::vector<double> raw_, momentum_, multipliers_;
};

}   // namespace livens::inline dynamics_internal
