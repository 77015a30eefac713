// SPDX-License-Identifier: BSD-3-Clause
// The seam between families of elements and those who solve them: a stretch of elements solved together.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "livens/diagnostics/estimate.h"
#include "livens/multibody/motion.h"
#include "livens/solvers/newton.h"
#include "livens/solvers/report.h"

namespace livens::inline spacetime_internal {

/// A motion that is about right, at any instant.
using Guess = std::function<State(double t)>;

/// Where something is worst, for a person.
struct WorstResidual {
    std::string name;       ///< "joint 'elbow' (row 'x'), body 'upper'"; empty: nowhere in particular
    double t = 0;           ///< s
    std::string bad_load;   ///< what is told of a load that is not finite
};

/// Beyond these an element has not seen the motion, or has met a root of its equations that is none
/// (docs/theory.md, "Spurious elements").
struct AcceptanceCriteria {
    double velocity_jump = std::numeric_limits<double>::infinity();   ///< see velocity_jump()
    bool turns = false;       ///< refuse also a body that turns by more than 90 degrees from node to node
    bool full_rank = false;   ///< refuse also an element with a node too near to a singular position
};

/// Where an element is too near to an instant at which the joints lose rank (docs/theory.md, "Singular
/// positions").
enum class RankLoss { none, inside, at_end };

/// How many elements of a window were closed, whether the next one was refused by Trust or since rows that
/// were left out as redundant do not hold at its end, and the velocity jump of the last one that was looked
/// at (infinite where a body turned too far or rows do not hold; 0 if Trust asks for nothing, or if its rank
/// is why it was refused).
struct AcceptedElements {
    int n_elements = 0;
    bool is_refused = false;
    double velocity_jump = 0;
    RankLoss loss = RankLoss::none;
    std::string contradiction{};   ///< of rows, if shorter elements do not help
    /// The load whose law decided about the velocity jump: as large as one that goes with what the law did
    /// inside of the element unseen; empty: none.
    std::string load{};
    bool jumps_back = false;   ///< at its end the law is on the side of a jump that the element has left
};

/// What conditions at both ends leave open.
struct Uncertainty {
    double size =
        0;   ///< how far the rounding of rows may move the solution, by the motion inside of elements
    std::string name;                ///< what moves most then: "body 'rod' near t = 0.5 s"
    double moved = 0;                ///< that far, in lengths of the model or rad
    std::vector<double> numbers{};   ///< how far it may move each unknown number, by its scale
};

/// What a family may know beyond the equations of its windows: of single elements of a march forwards or
/// backwards, and of a solution between conditions. As it stands here it knows nothing.
class ElementMonitor {
public:
    virtual ~ElementMonitor() = default;

    /// A way to the solution of the open window that is quicker than Newton's iteration: the same equations,
    /// to the same digits. False: nothing was found, the window is as before. `soon`: or nothing at all,
    /// since shorter elements are free to be tried.
    virtual bool solve(const NewtonOptions&, bool /*soon*/, NewtonReport&) { return false; }
    /// The next element might be so many times as long, as far as its error goes, if it took fewer steps.
    virtual void hold_back(double /*longer*/) {}
    /// What a tangent of the open window costs, in elements that solve() solves; 0: it solves none.
    virtual double tangent_cost() const { return 0; }
    /// Where the only element of the open window, as iterations left it, is too near to a singular position:
    /// at one Newton's iteration converges by chance.
    virtual RankLoss rank_loss() const { return RankLoss::none; }
    /// The first share of the only open element's length, up to `until`, at which a law of a load bends on
    /// the way of the solution at hand; infinite: none.
    virtual double bend(double /*until*/) { return std::numeric_limits<double>::infinity(); }
    /// The load whose force jumps there; empty: none was found so far, or it bends.
    virtual std::string jumping_load() const { return ""; }
    /// The mesh has one element more: `element`, which is not closed, was divided in two.
    virtual void divided(int) {}
    /// What laws of loads did unseen inside of the elements closed so far, in the order of their solution.
    virtual std::vector<Unseen> take_unseen() { return {}; }
    /// What was closed so far; null: the family cannot say.
    virtual const Motion* so_far() { return nullptr; }
    /// Of the solution at hand, by the last factors. 0: the family does not say.
    virtual Uncertainty uncertainty() { return {}; }
};

/// A family of elements on a mesh: it states the equations of any stretch of elements, a window, and keeps
/// what was solved of them. Which windows are solved, in which order and from which guess, is not its
/// business.
///
/// Windows are opened one after the other from the end of time where the state is known; with conditions at
/// both ends there is one window of all elements.
class Window {
public:
    Window() = default;
    /// A family that knows more of elements than the equations of windows.
    explicit Window(ElementMonitor& monitor) : monitor_(&monitor) {}
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;
    virtual ~Window() = default;

    ElementMonitor& monitor() { return monitor_ != nullptr ? *monitor_ : none_; }
    const ElementMonitor& monitor() const { return monitor_ != nullptr ? *monitor_ : none_; }

    /// Makes elements first..last - 1 current, with what the window closed last hands on (or with the
    /// conditions) at its near end. False: there is no state to go on from; the report says why.
    virtual bool open(int first, int last, SolveReport& report) = 0;
    /// The equations of the open window.
    virtual NewtonProblem& equations() = 0;
    /// False: the guess is not finite. An empty one is the family's own, cheap and good for short windows;
    /// false: it has none here.
    virtual bool start_from(const Guess& guess) = 0;
    /// X of all bodies at an end of an element of the open window; at its near end, where the state is known,
    /// all of that.
    virtual State at(int element_end) const = 0;
    /// Takes the solution at hand into the motion, and its far end as the near end of the next window:
    /// element by element from the near end, up to one that is not to be believed (a velocity jump or a turn
    /// between nodes beyond `trust`), or whose end is no state to go on from (the report says why). What was
    /// refused for its rank may be closed all the same, without asking for that.
    virtual AcceptedElements close(const AcceptanceCriteria& criteria, SolveReport& report) = 0;
    /// Where the residual is worst, or the load that is not finite.
    virtual WorstResidual worst() const = 0;
    /// Figures that only the family knows: unknowns, pivots, entries of factors.
    virtual void describe(SolveReport& report) const = 0;
    /// Everything closed so far.
    virtual Motion take_motion() = 0;

private:
    ElementMonitor* monitor_ = nullptr;
    ElementMonitor none_;
};

}   // namespace livens::inline spacetime_internal
