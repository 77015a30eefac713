// SPDX-License-Identifier: BSD-3-Clause
// Elements of a motion that is known, as those see them who solve others beside it.
#pragma once

#include <vector>

#include "livens/spacetime/nodal/kernel/extrapolation.h"
#include "livens/spacetime/nodal/kernel/reference_predictor.h"

namespace livens::inline spacetime_internal {

/// One element after the other: places of its nodes, as lanes::Values has them, and how neighbours go on.
class KnownElements {
public:
    /// References must outlive it; functions null: it is not asked for.
    KnownElements(const Motion& motion, const ModelTables& tables, const ElementRule& rule,
                  const lanes::Functions* functions);

    void open(int element);
    const WindowLayout& layout() const { return layout_; }
    /// Places of the element's nodes for a neighbour; `apart`: those of the nodes that it had in the element
    /// before, or has on the other side in this one, less those of the known motion. Null: nothing is known.
    void guess(const double* apart, double* place);
    void guess_mirrored(const double* apart, double* place) const;
    /// The element before was opened, too.
    bool is_behind_last() const { return is_behind_last_; }
    const AlignedDoubles& places() const { return place_; }
    /// By how much twists change in the element: spins alone.
    const std::vector<double>& change() const { return change_; }
    /// Whether some body's axis of turning turns itself.
    bool turns_in_space() const { return turns_in_space_; }

private:
    void look_at_spins(bool goes_on);

    const Motion& motion_;
    const ModelTables& tables_;
    ReferencePredictor nodes_;
    Extrapolation past_;
    WindowLayout layout_;
    AlignedDoubles place_, before_, foreseen_, other_;   // and what the places before foretell of a motion
    std::vector<double> change_;
    std::vector<Vector3> spins_;   // of bodies at the end
    double start_before_ = 0;
    int element_ = -1;
    bool is_behind_last_ = false, turns_in_space_ = false;
};

}   // namespace livens::inline spacetime_internal
