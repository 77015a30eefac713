// SPDX-License-Identifier: BSD-3-Clause
// Elements that step over a position in which joints lose rank, onto another branch of the motion.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "livens/dynamics/start/orientation.h"
#include "livens/spacetime/nodal/stretch.h"
#include "livens/time/basis.h"

namespace livens {

class Nodes;

/// A mechanism may come near a singular position and turn back, or pass through it: nodes on both sides know
/// neither. What passes through holds its joints and is rigid there; what jumped over is not (docs/theory.md,
/// "Singular positions"). Bodies that no joint ties together are looked at apart: what one mechanism does
/// hides nothing of another.
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
        int element;
    };

    /// The last two, since an element begins where one has ended or where it was tried before.
    struct Known {
        double t = std::numeric_limits<double>::quiet_NaN();
        std::vector<double> X;
        Orientation of;
    };
    /// Bodies that joints tie together into loops, or that drives move, and those of the independent rows
    /// that are theirs.
    struct Mechanism {
        std::vector<int> bodies, rows;
        Known known[2];
    };

    void find_mechanisms();
    void take(const std::vector<int>& rows);
    bool leaves(Mechanism& one, const Place& place);
    bool may_cross(Mechanism& one, const Place& place);
    /// Not into the place of the one beside it.
    Orientation& orientation(Mechanism& one, const Place& place, int node, const Orientation* beside);
    bool is_turned_over(Mechanism& one, const Place& place, int from, int to);
    bool is_open(const Mechanism& one, Instant at, const double* X, double most) const;
    bool is_bent(const Mechanism& one) const;
    bool is_open_between(const Mechanism& one, const Place& place, int from);
    const double* X(const Place& place, int node) const;

    const Tables& tables_;
    const ElementRule& rule_;
    std::vector<Mechanism> mechanisms_;
    std::vector<int> mechanism_of_;   // of each row of the model; -1: none that is looked at
    std::vector<int> rows_;           // all that were taken last
    std::optional<LagrangeBasis> basis_;
    std::vector<double> X_, values_;
};

}   // namespace livens
