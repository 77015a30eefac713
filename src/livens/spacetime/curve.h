// SPDX-License-Identifier: BSD-3-Clause
// Ends that are led along a curve of motions, past where the way turns back.
#pragma once

#include <functional>
#include <optional>

#include "livens/spacetime/march/ends.h"
#include "livens/spacetime/march/window.h"
#include "livens/time/time_mesh.h"

namespace livens::inline spacetime_internal {

/// A motion on the curve, and the share of the way at which it meets the ends.
struct OnCurve {
    Guess motion{};
    double share = 0;
};

/// How the curve was followed.
struct Followed {
    Guess motion{};             ///< near one that meets share 1; empty: the curve did not come there
    int steps = 0, turns = 0;   ///< motions on it, and how often the share turned round
};

/// From a motion of lobatto(degree) that meets the ends at a share of the way: the curve of motions and
/// shares (pseudo-arclength, [Keller1977]), until it passes share 1, has gone too far, or ends. `ends_at`:
/// none where joints do not close.
Followed follow_curve(const Model& model, const TimeMesh& mesh, int degree, const OnCurve& begin,
                      const std::function<std::optional<Ends>(double share)>& ends_at);

}   // namespace livens::inline spacetime_internal
