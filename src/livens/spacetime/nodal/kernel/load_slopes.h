// SPDX-License-Identifier: BSD-3-Clause
// What loads add to the tangent of an element.
#pragma once

#include <array>
#include <vector>

#include "livens/dynamics/lanes/lanes.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/spacetime/elements/window_layout.h"

namespace livens::inline spacetime_internal {

/// dF_i/dX_j and dF_i/dX'_j by scaled twists, 6 x 6 row by row; the bodies may be one.
struct SlopesOfPair {
    int i, j;
    double by_X[36], by_V[36];
};

/// Of a force f u: u by scaled twists of the bodies that it acts on, the second may be the world, and slopes
/// of f by those of all that it looks at.
struct SlopesOfProduct {
    using Twist = std::array<double, 6>;

    std::array<int, 2> to;
    std::array<Twist, 2> direction{};
    std::vector<int> from{};   ///< not the world
    std::vector<Twist> by_X{}, by_V{};

    SlopesOfPair of(std::size_t r, std::size_t s) const
    {
        SlopesOfPair pair{to[r], from[s], {}, {}};
        for (std::size_t a = 0; a < 36; ++a) {
            pair.by_X[a] = direction[r][a / 6] * by_X[s][a % 6];
            pair.by_V[a] = direction[r][a / 6] * by_V[s][a % 6];
        }
        return pair;
    }
};

/// Slopes of loads in the middle of an element by scaled twists, as if bodies had them all over it in their
/// own axes: J_AB of bodies i, j is S_AB dF_i/dX_j + C_AB dF_i/dX'_j.
class LoadSlopes {
public:
    LoadSlopes(const ModelTables& tables, const ElementRule& rule, int width);

    /// Where the kernel has its load points; then they stand in pairs() and products().
    void find(const WindowLayout& layout, const lanes::Values& nodes);
    const std::vector<SlopesOfPair>& pairs() const { return pairs_; }
    /// Of forces along coordinates, but for what turning of their directions adds.
    const std::vector<SlopesOfProduct>& products() const { return products_; }
    /// Row A by column l, p square; column 0 is the last node. To be multiplied by h: of X.
    const std::vector<double>& in_time_by_X() const { return S_; }
    const std::vector<double>& in_time_by_V() const { return C_; }
    /// load_terms() over the element: what rounding of X does to rows is that of these.
    double terms() const { return terms_; }

private:
    void place(const lanes::Values& nodes);
    void add(int load, const WindowLayout& layout);
    void add_product(const Load& load, const ProductSlopes& slopes, double h);

    const ModelTables& tables_;
    const ElementRule& rule_;
    int width_, middle_;
    std::vector<double> S_, C_;
    std::vector<double> X_, V_, maps_, angles_;   // at the middle load point
    std::vector<SlopesOfPair> pairs_;
    std::vector<SlopesOfProduct> products_;
    double terms_ = 0;
};

}   // namespace livens::inline spacetime_internal
