// SPDX-License-Identifier: BSD-3-Clause
// Where on the way of an element a law of a load or row goes on to another of its smooth pieces.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "livens/spacetime/nodal/laws/calm_laws.h"
#include "livens/spacetime/nodal/laws/looks_in_lanes.h"
#include "livens/spacetime/nodal/laws/watched_law.h"

namespace livens::inline spacetime_internal {

/// Looks along the polynomials of an element that was solved as if no law bent there: what comes before the
/// first bend is about right, so that an element that ends there is smooth (docs/theory.md, "Laws that
/// bend").
class SwitchingPoints {
public:
    /// References must outlive it.
    SwitchingPoints(const ModelTables& tables, const ElementRule& rule, const CalmLaws& calm);

    /// No law of the model has pieces.
    bool empty() const { return laws_.empty(); }
    /// The first share of the only element's length, up to `until` (beyond 1: as it goes on), from which on
    /// laws are on other pieces than just behind its start; infinite: none.
    double first(const WindowLayout& layout, const NodePositions& nodes, double until);
    /// A load whose law is on another side of a jump at the state at the end of element e than where the way
    /// of the element ends.
    struct OffTheWay {
        int load = -1;              ///< none
        std::vector<double> jump;   ///< its force there less that on the way, at the jump, 12 numbers a body
    };
    /// Of numbers that are off the way by a tenth and more of what they change on it. `angles`: of loads at
    /// the end, see Turns.
    OffTheWay off_the_way(const WindowLayout& layout, const NodePositions& nodes, int e, const double* X,
                          const double* V, const std::vector<double>& angles);
    /// The load whose force jumped there, when a bend was found last; empty: none was, or none jumps.
    std::string jumping_load() const;

private:
    bool is_calm(const WatchedLaw& law) const;
    bool is_off(const WatchedLaw& law, const LawState& last, const LawState& there);

    const ModelTables& tables_;
    const ElementRule& rule_;
    const CalmLaws& calm_;
    std::vector<WatchedLaw> laws_;
    ElementPath path_;
    std::vector<double> shares_, shares_beyond_;   // of looks, on the way and half of it beyond
    int n_looks_ = 0;                              // of equal distance, on the way
    std::optional<LooksInLanes> looks_, beyond_;   // there, once they are asked for
    int jumping_ = -1;
};

}   // namespace livens::inline spacetime_internal
