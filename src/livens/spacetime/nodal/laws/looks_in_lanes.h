// SPDX-License-Identifier: BSD-3-Clause
// Laws of loads between the load points of an element, side by side.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "livens/dynamics/lanes/load_lanes.h"
#include "livens/multibody/loads/load_tape.h"
#include "livens/spacetime/elements/kernel_functions.h"
#include "livens/spacetime/elements/rule.h"
#include "livens/spacetime/elements/window_layout.h"

namespace livens::inline spacetime_internal {

class NodePositions;

/// The element's basis at shares: batch by batch of them, a row of lanes for each node.
struct LookWeights {
    AlignedDoubles M, slopes;   ///< by the share
    AlignedDoubles dM;          ///< by time
    double h = 0;               ///< for which they are
};

/// What loads have recorded of their laws at some shares of a solved element: numbers and factors
/// (LawInside), or guards and centres.
class LooksInLanes {
public:
    /// `shares` of the element's length ascend; numbers and factors are looked at at load points as well.
    /// References must outlive it.
    LooksInLanes(const ModelTables& tables, const ElementRule& rule, RecordedLoads what,
                 std::vector<double> shares);

    /// Whether the law of a load is known this way.
    bool knows(int load) const { return first_[static_cast<std::size_t>(load)] >= 0; }
    /// The same of a number of guards, and of its centre.
    bool knows_guards(int load, std::size_t n, bool has_centre) const
    {
        return knows(load) && watched(load)[0]->size() == n && (!has_centre || !watched(load)[1]->empty());
    }
    /// Looks at all of them. `angles`: at the first node, see Turns.
    void look(const WindowLayout& layout, const NodePositions& nodes, int e, std::span<const double> angles);

    // Of a load that is known, where was looked last.

    void guards(int load, std::size_t share, double* out) const { take(load, 0, at_shares_[share], out); }
    void centre(int load, std::size_t share, double* out) const { take(load, 1, at_shares_[share], out); }
    void factors(int load, std::size_t share, double* out) const { take(load, 1, at_shares_[share], out); }
    void factors_at_load_point(int load, std::size_t c, double* out) const
    {
        take(load, 1, at_points_[c], out);
    }
    /// Numbers at other shares, one after the other, by the polynomial through those at `shares`; `values`:
    /// its basis there.
    void numbers(int load, std::span<const double> values, std::span<double> out) const;

private:
    void take(int load, std::size_t which, std::size_t look, double* out) const;
    void collect_laws();
    void weigh();
    void gather(int body, const WindowLayout& layout, const NodePositions& nodes, int e);
    void keep(std::size_t first);
    std::array<const std::vector<int>*, 2> watched(int load) const;

    const ModelTables& tables_;
    const ElementRule& rule_;
    RecordedLoads what_;
    const lanes::Functions* functions_;
    LoadLanes lanes_;
    std::vector<double> all_;                          // shares, ascending
    std::vector<std::size_t> at_shares_, at_points_;   // places in them
    std::vector<int> bodies_;                          // that laws look at
    std::vector<int> first_;                           // of each load the first of its numbers
    std::vector<double> seen_;                         // number by number, at all shares
    LookWeights weights_;
    std::vector<double> start_;
    AlignedDoubles increments_;
    std::vector<double> turns_;
};

}   // namespace livens::inline spacetime_internal
