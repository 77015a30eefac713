// SPDX-License-Identifier: BSD-3-Clause
// Laws that come nowhere near a bend in an element, by what its load points took of them.
#pragma once

#include <vector>

#include "livens/dynamics/lanes/load_lanes.h"
#include "livens/spacetime/elements/rule.h"

namespace livens::inline spacetime_internal {

/// A guard or centre moves from load point to load point by some speed. Where it is farther from a place at
/// which the law bends than that speed takes it, no look finds anything, and none is taken (docs/theory.md,
/// "Laws that bend").
class CalmLaws {
public:
    /// The tables must outlive it.
    CalmLaws(const ModelTables& tables, const ElementRule& rule);

    /// Of an element whose loads were evaluated last by these lanes; null: nothing is known of it.
    void look(const LoadLanes* loads);
    /// False: not, or nobody knows.
    bool has_calm_guards(int load) const { return guards_[static_cast<std::size_t>(load)] != 0; }
    bool has_calm_centre(int load) const { return centres_[static_cast<std::size_t>(load)] != 0; }
    /// No law is anywhere near a bend.
    bool are_all() const { return are_all_; }

private:
    bool are_guards_calm(const LoadLanes& loads, int load) const;
    bool is_centre_calm(const LoadLanes& loads, int load) const;

    const ModelTables& tables_;
    std::vector<double> shares_;   // of load points
    double widest_ = 0;            // of the gaps between them and to the ends
    std::vector<int> watched_;     // loads with guards or a centre
    std::vector<char> guards_, centres_;
    bool are_all_ = false;
};

}   // namespace livens::inline spacetime_internal
