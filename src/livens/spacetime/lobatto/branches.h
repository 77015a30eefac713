// SPDX-License-Identifier: BSD-3-Clause
// Elements that step over a position in which joints lose rank, onto another branch of the motion.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "livens/multibody/orientation.h"
#include "livens/spacetime/lobatto/nodes.h"
#include "livens/spacetime/lobatto/stretch.h"
#include "livens/time/basis.h"

namespace livens {

/// A mechanism may come near a singular position and turn back, or pass through it: nodes on both sides know
/// neither. What passes through holds its joints and is rigid there; what jumped over is not (docs/theory.md,
/// "Singular positions").
class Branches {
public:
    /// References must outlive it.
    Branches(const Tables& tables, const ElementRule& rule);

    /// Whether the polynomial of element e is on one branch before and on another behind, with joints open in
    /// between, or has joints open at its end. `rows`: the independent ones.
    bool leaves(const Stretch& stretch, const Nodes& nodes, const std::vector<int>& rows, int e);

private:
    /// Of an element.
    struct Place {
        const Stretch& stretch;
        const Nodes& nodes;
        const std::vector<int>& rows;
        int element;
    };

    /// The last two, since an element begins where one has ended or where it was tried before.
    struct Known {
        double t = std::numeric_limits<double>::quiet_NaN();
        std::vector<int> rows;
        std::vector<double> X;
        Orientation of;
    };

    bool may_cross(const Place& place);
    /// Not into the place of the one beside it.
    const Orientation& orientation(const Place& place, int node, const Orientation* beside);
    bool is_turned_over(const Place& place, int from, int to);
    bool is_open(const std::vector<int>& rows, Instant at, double most) const;
    bool is_bent() const;
    bool is_open_between(const Place& place, int from);
    Instant at(const Place& place, double share) const;
    const double* X(const Place& place, int node) const;

    const Tables& tables_;
    const ElementRule& rule_;
    bool has_loops_ = false;   // or drives, and not too many rows
    std::optional<LagrangeBasis> basis_;
    Known known_[2];
    std::vector<double> X_, values_;
};

}   // namespace livens
