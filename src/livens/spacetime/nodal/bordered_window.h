// SPDX-License-Identifier: BSD-3-Clause
// Windows between both ends of time whose tangents take columns by unknown numbers.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "livens/solvers/dense_matrix.h"
#include "livens/spacetime/march/window.h"

namespace livens::inline spacetime_internal {

class Elimination;

/// Where tangents are formed: one phase of the motion after the other, mostly one.
using Formed = std::span<Elimination* const>;

class BorderedWindow : public Window {
public:
    using Window::Window;

    /// Columns of unknown numbers for the tangents to come: of all rows, balances and conditions.
    virtual void border_with(std::function<DenseMatrix(Formed)> columns) = 0;
    virtual bool factorise() = 0;
    /// What a window of the same kind and layout has kept, on another model. `is_pulled`: onto its joints.
    virtual bool adopt(const BorderedWindow& other, bool is_pulled) = 0;
    /// Rows with the opposite sign, as those of where tangents were formed.
    virtual std::vector<double> rows_in(Formed formed) = 0;
    /// Increments of such another window by the factors of this one.
    virtual void solve_for(const BorderedWindow& other, std::span<double> dx) = 0;
};

}   // namespace livens::inline spacetime_internal
