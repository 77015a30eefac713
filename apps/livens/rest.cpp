// SPDX-License-Identifier: BSD-3-Clause
#include "rest.h"

#include <cmath>

#include <fmt/format.h>

#include "interrupt.h"
#include "livens/io/known_state.h"

namespace livens::program {

Equilibrium equilibrium_of(const Scenario& scenario)
{
    const KnownState known = known_state(scenario);
    EquilibriumOptions options;
    options.initial = known.initial;
    options.goes_on = [] { return InterruptWatch::signal() == 0; };
    return find_equilibrium(scenario.model, known.state, options);
}

void add_stability(Summary& summary, const StabilityReport& report, int degrees_of_freedom)
{
    if (degrees_of_freedom == 0) {
        summary.headline(Ink::good, "Held", "the joints leave no degree of freedom");
        return;
    }
    const auto directions = [](int n) { return fmt::format("{} direction{}", n, n == 1 ? "" : "s"); };
    switch (report.stability) {
    case Stability::stable:
        summary.headline(Ink::good, "Stable", "in equilibrium, and small motions about it stay small");
        return;
    case Stability::neutral:
        summary.headline(Ink::doubtful, "Neutral",
                         "in equilibrium, but nothing restores it in " + directions(report.n_neutral));
        return;
    case Stability::unstable:
        summary.headline(Ink::doubtful, "Unstable",
                         "in equilibrium, but small motions grow in " + directions(report.n_unstable));
    }
}

std::string shown(double x, double size)
{
    return std::abs(x) <= 1e-12 * size ? "0" : fmt::format("{:.6g}", x);
}

std::string shown(const Vector3& v, double size)
{
    return "(" + shown(v[0], size) + ", " + shown(v[1], size) + ", " + shown(v[2], size) + ")";
}

}   // namespace livens::program
