// SPDX-License-Identifier: BSD-3-Clause
// Laws of loads that need not be smooth inside of an element: their factors along its polynomials, and bounds
// of the slopes of these.
#pragma once

#include <span>
#include <vector>

#include "livens/multibody/loads.h"
#include "livens/spacetime/nodal/element_path.h"

namespace livens::inline spacetime_internal {

/// F = sum_k f_k(t, q) F_k with numbers q of the motion.
struct InspectedLaw {
    int load = 0;
    std::vector<int> bodies;   ///< that it looks at or acts on
    LawInside inside;
    std::vector<double> mobility;   ///< of each unit F_k: acceleration in lengths or rad
};

class LooksInLanes;

/// Of all loads that are not smooth.
std::vector<InspectedLaw> laws_to_inspect(const ModelTables& tables);

/// The numbers q(s) of a law are taken at p + 3 points, and are the polynomial through them.
class LawOnPath {
public:
    /// References must outlive it.
    LawOnPath(const ModelTables& tables, const ElementRule& rule);

    /// Takes the numbers of a law along the path. `angles`: at the first node, see Turns. `looks`: they know
    /// the law at the shares that they were made with; null: it is asked.
    void follow(const InspectedLaw& law, ElementPath& path, const std::vector<double>& angles,
                const LooksInLanes* looks);
    /// What looks at these shares are multiplied with.
    void use(const std::vector<double>& shares);
    const InspectedLaw& law() const { return *law_; }
    std::size_t n_factors() const { return law_->inside.n_factors; }
    double h() const { return h_; }

    void factors_at(double share, double* factors);
    /// Bounds of |df_k/ds| between two shares; only of a law that knows them.
    void bound_slopes(double first, double last, std::span<double> bounds);

private:
    EnclosedValue range(std::size_t number, double width) const;

    void bound_derivatives();

    const ModelTables& tables_;
    LagrangeBasis basis_;
    std::vector<double> from_looks_;   // values at its nodes of the basis on the shares of looks
    const InspectedLaw* law_ = nullptr;
    double start_ = 0, h_ = 0;
    // At the nodes of basis_, and bounds of derivatives.
    std::vector<double> numbers_, slopes_, second_, third_;
    std::vector<double> values_, at_;
};

}   // namespace livens::inline spacetime_internal
