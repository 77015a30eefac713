// SPDX-License-Identifier: BSD-3-Clause
// Neighbouring motions that are carried along, and how far they part.  (docs/theory.md, "The horizon")
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "livens/spacetime/accuracy/neighbour.h"
#include "livens/spacetime/accuracy/perturbations.h"

namespace livens::inline spacetime_internal {

/// How near neighbours are, in lengths of the model and rad: where they are brought near again, and how far
/// they may part until then, as foreseen and at the most.
struct Nearness {
    double small, wide, too_wide;
};

/// What neighbours are made of.
struct Surroundings {
    const Model& model;
    const Method& method;
    const SolveOptions& quiet;
    const Motion& motion;
    const std::shared_ptr<Prepared>& prepared;
    const std::optional<Ends>& closed;   // where a window marches
    double rate;                         // the fastest there ever is
    bool has_bends = false;              // of their own
    bool is_careful = false;             // see Neighbours

    /// On which perturbations are put.
    std::span<const int> rows() const
    {
        return closed ? std::span<const int>(closed->independent) : std::span<const int>();
    }
};

/// A motion beside the one at hand, or one on either side of it: what bends in half their difference is of
/// third order.
struct Perturbed {
    Perturbed(Neighbour one, Neighbour other) : sides{std::move(one), std::move(other)} {}

    Neighbour sides[2];
    State starts[2]{};
    double so_far = 1;                    // by the difference at hand: what was made smaller on the way
    double share = 0;                     // of the difference that there was, where it was made smaller last
    double least = 1, most = 1;           // that it was stretched to, positions and velocities
    double deepest = 1, at_deepest = 1;   // the most that it has shrunk by, and its size then
    bool is_lost = false;
};

/// What all neighbours did, and how they go on.
struct WaySoFar {
    double largest = 1, stretched = 1, shrunk = 1, folded = 1;
    int length = 0, n_failed = 0;   // of pieces
};

/// All of them, piece by piece; between pieces they are brought near again. At first their steps leave little
/// of what is seen, on one side of the motion; where they shrink and grow again that may be too much
/// (is_unsure()), and others have to be careful.
class Neighbours {
public:
    /// `most_left`: by the iteration of the motion. References must outlive it.
    Neighbours(const Surroundings& at, double most_left);

    /// At element ends, as far as any can be solved: by the size at the start, with velocities by this rate.
    Growth grown_from(std::span<const Kicks> kicks, double rate);
    /// By what the kicks are: of the start, and of every element, as roundings are.
    Growth grown_from(Roundings& roundings);
    /// What was measured, up to there, is not to be believed.
    bool is_unsure() const;
    /// By how much one was stretched and shrunk, positions and velocities.
    double stretched() const { return way_.stretched; }
    double shrunk() const { return way_.shrunk; }

private:
    const Motion& motion() const { return at_.motion; }
    Neighbour neighbour() const;
    void add(const Kicks& kicks, double factor);
    void march(const std::function<void()>& judge);
    bool are_lost() const;
    bool have_end(int end) const;
    void apart_at(const Perturbed& one, int end, const State& here, Difference& apart) const;
    bool is_too_far(const Neighbour& one, int end);
    double left() const;
    int solve_from(int first);
    int go_through(int first, int last);
    int solve_by_windows(int first, int last);
    double lose_unless_apart(Perturbed& one, double rate) const;
    void judge_start(double rate);
    void judge_way(Perturbed& one, double width);
    bool wants_other_side() const;
    int record(int first, int last);
    Difference kicked(const State& here, const Kicks& kicks, double factor);
    void bring_near(int first, int end);

    const Surroundings& at_;
    KickedStates kicked_;
    Roundings* roundings_ = nullptr;              // that are added on the way
    std::optional<NeighbourElements> elements_;   // empty: neighbours go by windows
    bool is_careful_;
    double most_alone_;
    bool has_two_;
    Nearness near_;
    std::vector<Perturbed> all_;
    WaySoFar way_;
    Growth grown_;
    State here_;         // the motion at an element end
    Difference apart_;   // from it
};

}   // namespace livens::inline spacetime_internal
