// SPDX-License-Identifier: BSD-3-Clause
// The motion of solved elements of lobatto(p) or radau(p), in whatever order they come.
#pragma once

#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "livens/dynamics/rows/tables.h"
#include "livens/multibody/motion.h"
#include "livens/spacetime/elements/rule.h"

namespace livens::inline dynamics_internal {
class InstantSystem;
struct InstantState;
}   // namespace livens::inline dynamics_internal

namespace livens::inline spacetime_internal {

/// Fills a motion element by element; elements that were never closed are cut off at the end.
class Record {
public:
    Record(const ModelTables& tables, const TimeMesh& mesh, const ElementRule& rule);

    /// X of local node A of a mesh element, 12 numbers a body; its joint multipliers, one-sided at the ends.
    void node(int element, int A, const double* X);
    void multipliers(int element, int A, const double* lambda);
    /// Everything known at an element end; `system` has just made its accelerations. `two_sided`: they
    /// differ. `work`: 12 numbers a body, of the caller.
    void end(int place, const InstantState& state, const InstantSystem& system, bool two_sided,
             std::span<double> work);
    /// Room for all of these ends and what is between them: then several threads may write, each other ones.
    void make_room(int first, int last);
    /// Ends from..to that were written; what is written outside of them is forgotten.
    std::pair<int, int> written() const { return {first_, last_}; }
    void forget_but(std::pair<int, int> written) { std::tie(first_, last_) = written; }
    /// Multipliers of these rows of the model are not known at the element end that was written last.
    void forget_reactions(int place, std::span<const int> rows);
    /// Another motion, on what the mesh is now.
    void begin_anew();
    /// Room for an element more beside `element`, which the mesh has divided; ends behind it move on by one.
    void divided(int element);
    void note_redundant(const std::vector<int>& rows) { motion_.redundant_rows = rows; }
    const TimeMesh& mesh() const { return mesh_; }

    /// What is written of a march forwards.
    const Motion& so_far();
    /// `start`: what is left where no element end was written.
    Motion take(const State& start);

private:
    template <class Action>
    void for_arrays(Action&& action);
    void only(const State& start);

    const ModelTables& tables_;
    const TimeMesh& mesh_;
    int degree_;
    int first_, last_;   // element ends from..to that were written
    Motion motion_;
};

}   // namespace livens::inline spacetime_internal
