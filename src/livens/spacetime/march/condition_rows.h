// SPDX-License-Identifier: BSD-3-Clause
// Rows of conditions by component at places where their rank is judged.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "livens/solvers/dense_matrix.h"
#include "livens/spacetime/march/components.h"
#include "livens/spacetime/march/end_point.h"

namespace livens::inline spacetime_internal {

/// Of a row, where others are taken off it: less is left of none that says something new.
constexpr double dependent = 1e-7;

/// Numbers between -1 and 1 that nobody chose, always the same.
class Scatter {
public:
    double next()
    {
        state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
        return static_cast<double>(static_cast<std::int64_t>(state_ >> 11)) / 4503599627370496.0 - 1;
    }

private:
    std::uint64_t state_ = 0x9E3779B97F4A7C15ULL;
};

/// A place about another, with momenta that nobody chose; as far off as it closes.
void place_about(const EndPoint& from, const ModelTables& tables, double rate, Scatter& scatter,
                 EndPoint& to);

/// Derivatives of conditions by lengths, radians and rates times the duration along free motions at both
/// ends, one row each, by their scales: numbers about 1, zero where joints hold a quantity. Columns by
/// unknown numbers follow, of the first conditions.
DenseMatrix rows_at(const std::array<const ModelTables*, 2>& tables, const std::vector<Condition>& conditions,
                    const std::array<const EndPoint*, 2>& points, double duration,
                    const DenseMatrix& by_numbers);

/// What is left of a row when those before it are taken off, and by how much each was there.
struct Remainder {
    double norm = 0, of = 0;        ///< what is left, and the row's own
    std::vector<double> shares{};   ///< of rows before, in norms of the row
};

std::vector<Remainder> remainders(const DenseMatrix& rows);

}   // namespace livens::inline spacetime_internal
