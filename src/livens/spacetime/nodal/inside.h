// SPDX-License-Identifier: BSD-3-Clause
// What laws of loads do inside of an element that its load points do not see.
#pragma once

#include <optional>
#include <vector>

#include "livens/diagnostics/estimate.h"
#include "livens/spacetime/nodal/laws/calm_laws.h"
#include "livens/spacetime/nodal/laws/law_on_path.h"
#include "livens/spacetime/nodal/laws/looks_in_lanes.h"
#include "livens/spacetime/nodal/laws/missed_moments.h"

namespace livens::inline dynamics_internal {
class InstantSystem;
struct InstantState;
}   // namespace livens::inline dynamics_internal

namespace livens::inline spacetime_internal {

/// Compares, along the polynomials of a solved element, the impulse of every law that need not be smooth with
/// what the element's quadrature took of it, and estimates the velocity change that the difference would have
/// caused (docs/theory.md, "Looks at laws").
class InsideLaws {
public:
    /// References must outlive it.
    InsideLaws(const ModelTables& tables, const ElementRule& rule, const CalmLaws& calm);

    /// Of element e, whose end state is `end`, prepared by `instant`: how what was not seen would have kicked
    /// the bodies, and the load that kicks most. `angles`: at its first node, see Turns.
    Unseen look(const WindowLayout& layout, const NodePositions& nodes, int e,
                const std::vector<double>& angles, InstantSystem& instant, InstantState& end);

private:
    bool is_calm(const InspectedLaw& law);
    void add_forces(const InspectedLaw& law, const std::vector<double>& moments, const InstantState& end);
    void kick(const double* twist, const InstantState& end, Unseen& found);

    const ModelTables& tables_;
    const ElementRule& rule_;
    const CalmLaws& calm_;
    std::vector<InspectedLaw> laws_;
    ElementPath path_;
    LawOnPath along_;
    MissedMoments missed_;
    std::optional<LooksInLanes> looks_;   // at laws that are recorded, once they are asked for
    std::vector<double> forces_[MissedMoments::n_moments];   // generalised ones of all laws, 12 a body
    std::vector<double> V_;
};

}   // namespace livens::inline spacetime_internal
