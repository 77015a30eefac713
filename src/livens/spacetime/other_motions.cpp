// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/other_motions.h"

#include <utility>

#include "livens/spacetime/march/window_notes.h"

namespace livens::inline spacetime_internal {

bool is_at_rest(const Model& model, const Ends& ends, const Motion& motion)
{
    constexpr double still = 1e-6;   // lengths
    if (!ends.is_free_periodic) return false;
    const State first = motion.at_end(0);
    for (int e = 0; e < motion.n_elements(); ++e)
        for (const double share : {0.5, 1.0}) {
            const double t = motion.mesh.ends[e] + share * motion.mesh.length(e);
            if (distance_between(first.X, motion.at(t).X, model.length()) > still) return false;
        }
    return true;
}

std::unique_ptr<Window> find_met(const Model& model, const Ends& ends, std::unique_ptr<Window> window,
                                 const std::function<std::unique_ptr<Window>(SolveReport&)>& next,
                                 SolveReport& report)
{
    constexpr int most = 8;
    const bool has_momenta = knows_momenta(ends.at_start) || knows_momenta(ends.at_end);
    const auto is_met = [&](Window& of) {
        const Motion* motion = of.monitor().so_far();
        return motion == nullptr || !((has_momenta && !unmet(model, ends, *motion, {}).empty()) ||
                                      is_at_rest(model, ends, *motion));
    };
    if (!report.converged() || !(has_momenta || ends.is_free_periodic) || is_met(*window)) return window;
    for (int i = 0; i < most; ++i) {
        SolveReport other;
        std::unique_ptr<Window> found = next(other);
        if (!other.converged()) break;
        if (!is_met(*found)) continue;
        report = std::move(other);
        return found;
    }
    return window;
}

}   // namespace livens::inline spacetime_internal
