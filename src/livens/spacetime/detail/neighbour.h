// SPDX-License-Identifier: BSD-3-Clause
// A motion beside another one, over the same elements, piece by piece.
#pragma once

#include <memory>

#include "livens/spacetime/solve.h"

namespace livens {

class Neighbour {
public:
    /// References must outlive it.
    Neighbour(const Model& model, const Method& method, const SolveOptions& options, const Motion& beside);
    Neighbour(Neighbour&&) noexcept;
    ~Neighbour();

    /// Over the elements first..last - 1 from a state at the start of the first; `near` is where it may be
    /// looked for. Off its joints by no more than what bends, the state is taken as it is. False: it does not
    /// go so far.
    bool solve(const State& start, const Motion& near, int first, int last);
    const Motion& motion() const { return motion_; }

private:
    struct March;

    bool march(const State& start, const Motion& near);

    const Model& model_;
    const Method& method_;
    const SolveOptions& options_;
    const Motion& beside_;
    TimeMesh mesh_;
    std::unique_ptr<March> march_;   // of one element after the other, where nothing else is needed
    Motion motion_;
};

}   // namespace livens
