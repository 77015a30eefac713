// SPDX-License-Identifier: BSD-3-Clause
// Where on the way of an element a law of a load goes on to another of its smooth pieces.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "livens/spacetime/lobatto/nodes.h"

namespace livens {

/// Looks along the polynomials of an element that was solved as if no law bent there: what comes before the
/// first bend is about right, so that an element that ends there is smooth (docs/theory.md, "Laws that
/// bend").
class Bends {
public:
    /// References must outlive it.
    Bends(const Tables& tables, const ElementRule& rule);

    /// No law of the model has pieces.
    bool empty() const { return loads_.empty(); }
    /// The first share of the only element's length, up to `until` (beyond 1: as it goes on), from which on
    /// loads are on other pieces than just behind its start; infinite: none.
    double first(const Stretch& stretch, const Nodes& nodes, double until);
    /// The load whose force jumped there, when a bend was found last; empty: none was, or none jumps.
    std::string jumping_load() const { return jumping_ < 0 ? "" : tables_.model->loads()[jumping_].name; }

private:
    struct Look {
        double share = 0;
        std::vector<std::uint64_t> pieces;   // of each load
        std::vector<double> angles;          // see Turns
    };

    /// Of the loads that are on other pieces after than before, one whose force jumps; -1: none.
    int find_jump(const Stretch& stretch, const Nodes& nodes, const Look& before, const Look& after,
                  const Look& end);
    LoadForces forces(const Stretch& stretch, const Nodes& nodes, int load, const Look& at);
    Look look(const Stretch& stretch, const Nodes& nodes, double share, const Look& from);

    const Tables& tables_;
    std::vector<int> loads_;   // that have pieces; if there are none nothing else is made
    std::optional<LagrangeBasis> basis_;
    int jumping_ = -1;
    std::vector<double> X_, V_, values_, slopes_;
};

}   // namespace livens
