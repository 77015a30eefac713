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

std::string figures(const Run& run)
{
    const Verdict& s = run.verdict;
    const SolveReport& report = run.report;
    const bool is_weak = s.max_weak_violation > 0;
    std::string text = fmt::format(
        "  constraints       violated by {} at most{}, their rates by {} 1/s\n"
        "  energy            off its balance by {} of the largest that moves or is stored\n"
        "  angular momentum  off its balance by {} of its largest value\n"
        "  zig-zag           {} in positions, {} in momenta (0: smooth, 1: from node to node)\n"
        "  residual          {}\n",
        number(s.max_constraint_violation),
        is_weak ? " (they hold in the mean, within " + number(s.max_weak_violation) + ")" : "",
        number(s.max_velocity_violation), number(s.energy_drift), number(s.angular_momentum_drift),
        number(s.zigzag_positions), number(s.zigzag_momenta), number(report.residual_norm));
    if (report.condition_1 > 0)
        text += fmt::format("  condition         {} in the 1-norm, {} in the 2-norm; {} as it is "
                            "factorised\n",
                            number(report.condition_1), number(report.condition_2),
                            number(report.scaled_condition));
    return text;
}

std::string verdict(const Run& run)
{
    const SolveReport& report = run.report;
    const Verdict& s = run.verdict;
    if (report.status == SolveStatus::cancelled)
        return "Cancelled: the file holds the motion up to the last solved element.";
    if (report.status == SolveStatus::suspect)
        return "Suspect: the solver converged, but the motion fails the checks noted above.";
    if (!report.converged())
        return std::string("Not converged (") + to_string(report.status) +
               "): the file holds the motion up to the last solved element. " + plain(report.message);
    return fmt::format("Converged. Constraints hold{} and the balances are kept {}.",
                       s.max_weak_violation > 0            ? " in the mean"
                       : s.max_constraint_violation <= 1e-10 ? " to rounding"
                                                             : "",
                       grade(std::max(s.energy_drift, s.angular_momentum_drift)));
}

}   // namespace livens::program
