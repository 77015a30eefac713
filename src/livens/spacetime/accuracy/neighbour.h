// SPDX-License-Identifier: BSD-3-Clause
// A motion beside another one, over the same elements, piece by piece.
#pragma once

#include <memory>

#include "livens/spacetime/accuracy/neighbour_elements.h"
#include "livens/spacetime/accuracy/perturbations.h"
#include "livens/spacetime/march/ends.h"
#include "livens/spacetime/solve.h"

namespace livens::inline spacetime_internal {

class Neighbour {
public:
    /// References must outlive it. `closed`: as the motion begins, where a window marches it; null: elements
    /// that are solved as any problem is. `has_bends`: laws bend at instants of its own, where elements end
    /// instead of where they bend beside it; else these ends serve.
    Neighbour(const Model& model, const Method& method, const SolveOptions& options, const Motion& beside,
              std::shared_ptr<Prepared> prepared, const Ends* closed, bool has_bends);
    Neighbour(Neighbour&&) noexcept;
    ~Neighbour();

    /// Over the elements first..last - 1 from a state at the start of the first; `near` is where it may be
    /// looked for. Off its joints by no more than what bends, the state is taken as it is. `left`: what the
    /// iteration may leave, of the motion in an element. False: it does not go so far.
    bool solve(const State& start, const Motion& near, int first, int last, double left);
    /// The nodes of what was solved by that; empty where elements were gone through.
    const Motion& motion() const { return motion_; }

    /// The same element by element, all neighbours side by side. From a state at the start of element
    /// `first`, where it is beside the motion by `share` of what it was.
    bool begin(NeighbourElements& elements, const State& start, int first, double share);
    /// Through the open element.
    bool go_on(NeighbourElements& elements, const BesideLimits& limits, const Neighbour* mirror);

    /// Whether it has an element end where the motion has this one, and its state there.
    bool has_end(int end) const;
    State at_end(int end) const;
    int near_impact(int end) const;
    /// A share of how far it is from a state there.
    void apart_from(const State& other, int end, double share, Difference& apart) const;

private:
    struct March;

    bool march(const State& start, const Motion& near, double left);

    const Model& model_;
    const Method& method_;
    const SolveOptions& options_;
    const Motion& beside_;
    std::shared_ptr<Prepared> prepared_;
    const Ends* closed_;
    bool has_bends_;
    TimeMesh mesh_;
    std::unique_ptr<March> march_;   // of one element after the other, if closed
    Motion motion_;
    BesideState here_;
    std::vector<State> states_;   // at ends from first_ on, of elements that were gone through
    int first_ = 0;
};

}   // namespace livens::inline spacetime_internal
