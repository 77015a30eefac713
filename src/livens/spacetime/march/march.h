// SPDX-License-Identifier: BSD-3-Clause
// The driver of windows: one loop of tries, each with its remedy where it was not accepted.
#pragma once

#include <limits>
#include <variant>

#include "livens/spacetime/march/event_locator.h"
#include "livens/spacetime/march/partition.h"
#include "livens/spacetime/march/window_notes.h"
#include "livens/spacetime/march/windows.h"

namespace livens::inline spacetime_internal {

/// Counted on the way.
struct RetryCounts {
    int avoided = 0;          ///< nodes too near to a singular position, since an element was closed
    int shortened = 0;        ///< elements, since one was solved without a tangent
    int contradictions = 0;   ///< elements at whose ends rows contradict each other
    std::string load{};       ///< for whose law the last element was refused; empty: for something else
    std::string slides{};   ///< load that jumps back in the last element that was solved, if that was refused
    double singular_end = std::numeric_limits<double>::quiet_NaN();   ///< that cannot move; the last one
};

/// Where the open window's solution comes from.
struct Attempt {
    Guess guess{};              ///< that it started from
    bool is_march = false;      ///< see WindowOptions::Proposal
    bool is_rescued = false;    ///< converged from another guess than the first
    bool has_iterate = false;   ///< else nothing proposed where to begin
};

class March {
public:
    March(Window& window, TimeMesh& mesh, const WindowOptions& options, SolveReport& report);
    void run();

private:
    /// Tries a window. False: the march ends, and the report says why unless the caller wants no more.
    bool advance(const Elements& of);
    /// Newton's iteration from one guess after the other; all their iterations count. Where none leads to a
    /// solution, the first one tells why.
    NewtonReport attempt(const Elements& of);
    /// Whether shorter elements cost less than the tangent of one that has no solution yet.
    bool is_tangent_too_costly(const Elements& of);
    /// What was solved steps over a bend of a law: an element is to end there.
    bool ends_at_bend(const Elements& of);
    /// How far the motion has left the march from the same state, at element ends: another method's opinion
    /// of the same window, which a wrong root does not share.
    void compare(const Elements& of);
    /// Closes the open window up to a node too near to a singular position; beyond that where nothing can be
    /// done about it, or where that did not help.
    AcceptedElements close(const Elements& of);
    /// Of an element that was not solved, whose end is near a singular position.
    RankLoss loss_of_failed(const Elements& of);
    void move_off(const Elements& of, RankLoss loss);
    /// Counts what was closed; what is left of the window.
    Elements take(Elements of, const AcceptedElements& closed, const NewtonReport& outcome);
    /// After a window that was closed: whether all who are asked let the march go on.
    bool goes_on(const NewtonReport& outcome);
    /// A window that failed as a whole.
    bool split(const Elements& of, const NewtonReport& outcome);
    /// Elements that were not accepted, from the near one on.
    bool refuse(const Elements& of, const AcceptedElements& closed, const NewtonReport& outcome);

    // Ends of the march, all false.
    /// Elements have vanished, or an element has not seen the motion and shorter ones do not help.
    bool stop(const Elements& of);
    bool explain(const Elements& of, const NewtonReport& outcome);
    bool fail(SolveStatus status, const std::string& message);

    Partition& partition();
    bool is_near_singular_end() const;
    std::string locking_in_words() const;
    int far(const Elements& of) const { return options_.direction > 0 ? of.last : of.first; }
    /// Of the mesh, or as many as it will be if it grows as it did.
    int n_elements() const;

    Window& window_;
    TimeMesh& mesh_;
    const WindowOptions& options_;
    SolveReport& report_;
    Newton newton_;
    NewtonOptions newton_options_;
    WindowCounts counts_;
    double start_, end_;   // in the direction of the march
    EventLocator events_;
    std::variant<GivenMesh, AdaptiveElements> partition_;   // in place: many marches are an element long
    Attempt attempt_;
    RetryCounts troubles_;
    int done_ = 0;      // elements
    double time_ = 0;   // up to which they are solved
};

}   // namespace livens::inline spacetime_internal
