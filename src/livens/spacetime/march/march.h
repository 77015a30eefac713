// SPDX-License-Identifier: BSD-3-Clause
// The driver of windows: one after the other along a mesh, or single elements whose lengths a pace finds.
#pragma once

#include <limits>

#include "livens/spacetime/march/ends_at_bends.h"
#include "livens/spacetime/march/window_notes.h"
#include "livens/spacetime/march/windows.h"

namespace livens {

/// Counted on the way.
struct Troubles {
    int avoided = 0;          ///< nodes too near to a singular position, since an element was closed
    int shortened = 0;        ///< elements, since one was solved without a tangent
    int contradictions = 0;   ///< elements at whose ends rows contradict each other
    int most_divisions = 0;   ///< beyond, something else is wrong
    std::string load{};       ///< for whose law the last element was refused; empty: for something else
};

class March {
public:
    March(Window& window, TimeMesh& mesh, const WindowOptions& options, SolveReport& report);
    void run();

private:
    /// Of an element by which its end is moved off a singular position, and how often in succession.
    static constexpr double shift = 0.1;
    static constexpr int most_shifts = 3;

    /// Windows of the mesh as it is.
    void run_mesh();
    /// One element after the other, each as long as the pace has it. An element that fails or is refused is
    /// tried again, shorter.
    void run_at_pace(Pace& pace);
    /// Elements have vanished, or shorter ones do not help.
    void give_up(int element, const Closed& closed, const NewtonReport& outcome);
    /// The motion rests where the law of a load jumps, or slides along it.
    void stop_at_jump(const std::string& load);
    void stop_vanishing();
    /// Remembers the load whose law an element was refused for, if it was.
    void blame(const Closed& closed);
    bool is_near_singular_end() const;
    std::string locking_in_words() const;
    /// Elements first..last - 1, split where they fail together.
    bool solve(int first, int last);
    /// Two stretches in their order. Elements that are divided in the first one move those behind it.
    bool solve_parts(int first, int middle, int last);
    bool may_divide(int first, int last, const NewtonReport& outcome) const;
    /// Whether what failed may be for want of shorter elements.
    bool may_shorten(const NewtonReport& outcome) const;
    bool divide_element(int element, double share);
    /// If what was solved steps over a bend of a law, the mesh ends an element there (2: in how many the
    /// window is to be solved anew), or moves that end (1); else 0.
    int end_at_bend(int first, int last);
    /// Newton's iteration from one guess after the other; all their iterations count. Where none leads to a
    /// solution, the first and best one tells why.
    NewtonReport attempt(int first, int last);
    /// Whether the elements that an element of unknown solution is divided into cost less than its tangent.
    bool is_tangent_too_costly(int first, int last, const NewtonReport& outcome) const;
    bool accept(int first, int last, const NewtonReport& outcome);
    /// With its end off a singular position.
    bool solve_shorter(int element);
    /// Closes the open window up to a node too near to a singular position; beyond that where nothing can be
    /// done about it, or where that did not help.
    Closed close(Trust trust, bool end_may_move, bool may_divide);
    /// Of an element that was not solved, whose end is near a singular position.
    RankLoss loss_of_failed(double end, bool end_may_move);
    bool can_move(int end) const;
    void count_shift(double t);
    void count_bend(double t);
    /// Counts what was closed of the elements first..last - 1.
    bool take(int first, int last, const Closed& closed, const NewtonReport& outcome);
    bool is_stopped_by_watch();
    /// Of the mesh, or as many as it will be if it grows as it did.
    int n_elements() const;
    bool is_done() const;
    /// The near one of the elements first..last - 1 has not seen the motion: it is solved alone, or divided.
    bool refuse(int first, int last, const Closed& closed, NewtonReport outcome);
    /// How far the motion has left the march from the same state, at element ends: another method's opinion
    /// of the same window, which a wrong root does not share.
    void compare(int first, int last);
    bool is_contradictory(const Closed& closed);
    bool set_contradiction(int first, int last, const Closed& closed);
    bool set_failed(int first, int last);
    void set_cancelled();
    bool explain(int first, int last, const NewtonReport& outcome);

    Window& window_;
    TimeMesh& mesh_;
    const WindowOptions& options_;
    SolveReport& report_;
    Newton newton_;
    NewtonOptions newton_options_;
    Guess guess_;   // that the open window started from
    bool is_march_ = false;
    bool is_rescued_ = false;   // converged from another guess than the first
    WindowCounts counts_;
    EndsAtBends bends_;
    Troubles troubles_;
    double singular_end_ = std::numeric_limits<double>::quiet_NaN();   // that can not move; the last one
    int done_ = 0;                                                     // elements
    double time_ = 0;                                                  // up to which they are solved
};

}   // namespace livens
