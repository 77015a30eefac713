// SPDX-License-Identifier: BSD-3-Clause
// The law of a load or of a row along an element: which of its smooth pieces it is on.
#pragma once

#include <utility>
#include <vector>

#include "livens/multibody/loads.h"
#include "livens/spacetime/nodal/element_path.h"

namespace livens::inline spacetime_internal {

/// The numbers that decide about the piece, at a share of the element's length.
struct LawState {
    double share = 0;
    std::vector<double> numbers;   ///< of the guards
    Vector3 centre{};
    std::vector<double> angles;   ///< see Turns
};

class WatchedLaw {
public:
    /// Of a load, or (load < 0) of a row. References must outlive it.
    WatchedLaw(const ModelTables& tables, int load, int row);

    bool has_pieces() const { return !guards_.empty() || has_centre_; }
    bool has_centre() const { return has_centre_; }
    const std::vector<Guard>& guards() const { return guards_; }
    int load() const { return load_; }
    const std::vector<int>& bodies() const { return bodies_; }

    /// The state that follows `from` along the path; guards and angles are continued from there.
    LawState at(ElementPath& path, double share, const LawState& from) const;
    /// The same of bodies that are there, and of angles that were followed.
    LawState at(Instant instant, const double* X, const double* V, std::vector<double> angles,
                const LawState& from) const;
    /// How far rounding of the places and rates of bodies there may move each of its numbers.
    std::vector<double> rounding(ElementPath& path, const LawState& at) const;
    /// Its angles alone, followed to a share.
    std::vector<double> angles_at(ElementPath& path, double share, std::vector<double> from) const;
    /// Whether the force of a load is another behind two states next to each other; `end` is some way behind.
    bool jumps(ElementPath& path, const LawState& before, const LawState& after, const LawState& end) const;
    /// Between two velocities of bodies at X, where the second one's numbers are on another piece than those
    /// of `first`: the force of a load behind the passage less that before, 12 numbers a body; empty: it goes
    /// on.
    std::vector<double> jump_between(Instant instant, const double* X,
                                     std::pair<const double*, const double*> V, const LawState& first) const;

private:
    LoadForces forces(ElementPath& path, const LawState& at) const;

    const ModelTables& tables_;
    int load_, row_;
    std::vector<int> bodies_, all_;
    std::vector<Guard> guards_;
    bool has_centre_ = false;
};

}   // namespace livens::inline spacetime_internal
