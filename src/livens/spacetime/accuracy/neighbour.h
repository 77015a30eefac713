// SPDX-License-Identifier: BSD-3-Clause
// A motion beside another one, over the same elements, piece by piece.
#pragma once

#include <memory>

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
    const Motion& motion() const { return motion_; }

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
};

}   // namespace livens::inline spacetime_internal
