// SPDX-License-Identifier: BSD-3-Clause
// Criteria by which a solved element is accepted or refused.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "livens/spacetime/march/window.h"
#include "livens/spacetime/nodal/branches.h"
#include "livens/spacetime/nodal/inside.h"
#include "livens/spacetime/nodal/laws/calm_laws.h"
#include "livens/spacetime/nodal/laws/switching_points.h"

namespace livens::inline spacetime_internal {

class ElementEnd;
class NodalSystem;

/// Of elements of a window; `end` is at the one that is looked at.
class ElementChecks {
public:
    /// References must outlive it.
    ElementChecks(const ModelTables& tables, const ElementRule& rule);

    /// The lanes that evaluated the loads of the element solved last; null: nobody knows them.
    void look_at(const LoadLanes* loads) { calm_.look(loads); }
    /// No law of it is anywhere near a bend.
    bool are_laws_calm() const { return calm_.are_all(); }
    /// Laws of loads are not inspected between load points.
    void ignore_laws() { inside_.reset(); }
    bool ignores_laws() const { return !inside_; }
    /// The velocity jump h |V - X_h'| at the end of an element (radau: at its start), as velocity_jump() of
    /// diagnostics has it; infinite where a body turns by more than 90 degrees from node to node, if that is
    /// refused.
    double velocity_jump(const NodalSystem& system, int e, const ElementEnd& end, bool refuse_turns) const;
    /// The element has left the branch of the motion.
    bool leaves(const NodalSystem& system, int e, const ElementEnd& end);
    /// The load whose law is on another side of a jump at the end of an element than its way is there; empty:
    /// none is, or the jump moves nothing.
    std::string jumps_back(const NodalSystem& system, int e, ElementEnd& end);
    /// The error of unseen laws is converted into an equivalent velocity jump.
    Unseen look_at_laws(const NodalSystem& system, int e, ElementEnd& end, AcceptedElements& closed);
    RankLoss rank_loss(const Nodes& nodes, int e) const;
    /// Reactions at the end of an element have digits left.
    bool has_reactions(const Nodes& nodes, int e) const;
    /// See ElementMonitor.
    double bend(const NodalSystem& system, double until);
    std::string jumping_load() const { return switching_points_.jumping_load(); }

    /// The element is believed.
    void take(const Nodes& nodes, int e, Unseen&& unseen);
    std::vector<Unseen> take_unseen() { return std::move(unseen_); }
    /// Of all that were taken.
    double smallest_pivot() const { return smallest_pivot_; }

private:
    bool has_small_turns(const Nodes& nodes, int e) const;
    double rank_left(const Nodes& nodes, int e, int first, int last) const;

    const ModelTables& tables_;
    int degree_;
    Branches branches_;
    CalmLaws calm_;
    SwitchingPoints switching_points_;
    std::optional<InsideLaws> inside_;   // where a law need not be smooth, and is not ignored
    std::vector<Unseen> unseen_;
    double smallest_pivot_ = 1;
};

}   // namespace livens::inline spacetime_internal
