// SPDX-License-Identifier: BSD-3-Clause
// Elements that step over a position in which joints lose rank, onto another branch of the motion.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "livens/dynamics/start/orientation.h"
#include "livens/spacetime/nodal/element_path.h"

namespace livens::inline spacetime_internal {

class Nodes;

/// A mechanism may come near a singular position and turn back, or pass through it: nodes on both sides know
/// neither. What passes through holds its joints and is rigid there; what jumped over is not (docs/theory.md,
/// "Singular positions"). Bodies that no joint ties together are looked at apart: what one mechanism does
/// hides nothing of another.
class Branches {
public:
    /// References must outlive it.
    Branches(const ModelTables& tables, const ElementRule& rule);

    /// Whether the polynomial of element e is on one branch before and on another behind, with joints open in
    /// between, or has joints open at its end. `rows`: the independent ones.
    bool leaves(const WindowLayout& layout, const Nodes& nodes, const std::vector<int>& rows, int e);

private:
    /// The last two, since an element begins where one has ended or where it was tried before.
    struct Known {
        double t = std::numeric_limits<double>::quiet_NaN();
        std::vector<double> X;
        Orientation of;
    };
    /// Bodies that joints tie together into loops, or that drives move, and the rows that are theirs.
    struct Mechanism {
        std::vector<int> bodies, all_rows;
        std::vector<int> rows{};   // the independent ones
        Known known[2]{};
    };

    void find_mechanisms();
    void take(const std::vector<int>& rows);
    bool leaves(Mechanism& one);
    bool may_cross(Mechanism& one);
    /// At a node of the element. Not into the place of the one beside it.
    Orientation& orientation(Mechanism& one, int node, const Orientation* beside);
    bool is_turned_over(Mechanism& one, int from, int to);
    bool is_open(const Mechanism& one, Instant at, const double* X, double most) const;
    bool is_bent(const Mechanism& one) const;
    bool is_open_between(const Mechanism& one, int from);

    const ModelTables& tables_;
    const ElementRule& rule_;
    std::vector<Mechanism> mechanisms_;
    std::vector<int> rows_;             // all that were taken last
    std::optional<ElementPath> path_;   // where there are mechanisms
    const Nodes* nodes_ = nullptr;
    int first_ = 0;   // node of the element
};

}   // namespace livens::inline spacetime_internal
