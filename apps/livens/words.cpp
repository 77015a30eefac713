#include "words.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "console.h"

namespace livens::program {

namespace {

std::string number(double x) { return std::isfinite(x) ? fmt::format("{:.1e}", x) : "not known"; }

const char* grade(double drift)
{
    if (drift <= 1e-10) return "to rounding";
    if (drift <= 1e-6) return "very well";
    if (drift <= 1e-3) return "well enough for most purposes";
    return "coarsely: take more elements or a higher degree";
}

}   // namespace

std::string figures(const RunSummary& s)
{
    return fmt::format("  constraints       violated by {} at most, their rates by {} 1/s\n"
                       "  energy            off its balance by {} of the largest kinetic energy\n"
                       "  angular momentum  off its balance by {} of its largest value\n"
                       "  residual          {}\n",
                       number(s.max_constraint_violation), number(s.max_velocity_violation),
                       number(s.energy_drift), number(s.angular_momentum_drift), number(s.residual_norm));
}

std::string verdict(const RunSummary& s)
{
    if (s.status == "cancelled") return "Cancelled: the file holds the motion up to the last solved element.";
    if (!s.converged)
        return "Not converged (" + plain(s.status) +
               "): the file holds the motion up to the last solved element. " + plain(s.message);
    if (s.status == "suspect")
        return "Suspect: the solver converged, but the motion fails the checks noted above.";
    return fmt::format("Converged. Constraints hold{} and the balances are kept {}.",
                       s.max_constraint_violation <= 1e-10 ? " to rounding" : "",
                       grade(std::max(s.energy_drift, s.angular_momentum_drift)));
}

}   // namespace livens::program
