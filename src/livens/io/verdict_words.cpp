// SPDX-License-Identifier: BSD-3-Clause
#include "livens/io/verdict_words.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <fmt/format.h>

namespace livens {

namespace {

constexpr JudgedFigure judged[] = {
    {"estimated_error", "estimated error", "rad, or relative to the model length"},
    {"max_constraint_violation", "constraints", "at nodes, relative to the length of each"},
    {"max_weak_violation", "constraints in the mean", "where they hold as integrals over elements"},
    {"energy_drift", "energy", "relative to peak kinetic or stored energy"},
    {"linear_momentum_drift", "linear momentum", "relative to its peak"},
    {"angular_momentum_drift", "angular momentum", "relative to its peak"},
    {"zigzag_positions", "zig-zag of positions", "0: smooth, 1: from node to node"},
    {"zigzag_momenta", "zig-zag of momenta", "0: smooth, 1: from node to node"},
    {"velocity_jump", "velocity jump", "between the polynomial of an element and its momentum"},
    {"guess_distance", "distance from the guess", "relative to the model length"},
};

const char* grade_of(double drift)
{
    if (drift <= 1e-10) return "to rounding";
    if (drift <= 1e-6) return "very well";
    if (drift <= 1e-3) return "well enough for most purposes";
    return "coarsely: take more elements or a higher degree";
}

/// A window of all elements keeps its last iterate, and so numbers beyond where it has failed.
std::string kept_of(const Run& run, double end)
{
    const bool is_iterate = run.report.n_elements == 0 && end > run.report.failed_at;
    if (is_iterate) return "no motion was found: the last iterate is kept";
    if (run.report.n_elements == 0) return "no element was solved: only the start is known";
    return fmt::format("the motion is known up to {:.6g} s", end);
}

/// Files before format 2.2 know the last digits alone.
std::string good_of(const Verdict& s, double end)
{
    const double last = std::floor(s.estimated_digits);
    if (!std::isfinite(s.good_digits)) return digits_through(last, end);
    return digits_through(s.good_digits, s.good_until) +
           (s.good_until < end ? fmt::format(", then {:.0f}", last) : "");
}

}   // namespace

std::string digits_through(double digits, double t)
{
    return fmt::format("{:.0f} digit{} through {:.6g} s", digits, digits == 1 ? "" : "s", t);
}

Headline headline_of(const Run& run, double end)
{
    const SolveReport& report = run.report;
    const Verdict& s = run.verdict;
    if (report.status == SolveStatus::suspect)
        return {Grade::doubtful, "Suspect", "the solver converged, but the motion fails its checks", ""};
    if (report.status == SolveStatus::cancelled) return {Grade::bad, "Cancelled", kept_of(run, end), ""};
    if (!report.converged()) {
        const bool is_plain = report.status == SolveStatus::not_converged;
        return {Grade::bad,
                is_plain ? "Not converged" : fmt::format("Not converged ({})", to_string(report.status)),
                kept_of(run, end), ""};
    }
    const char* const holds = s.max_weak_violation > 0              ? " in the mean"
                              : s.max_constraint_violation <= 1e-10 ? " to rounding"
                                                                    : "";
    if (std::isfinite(s.estimated_error))
        return {Grade::good, "Converged", "good to " + good_of(s, end),
                std::string("constraints hold") + holds};
    const double drift = std::max(s.energy_drift, s.angular_momentum_drift);
    return {Grade::good, "Converged",
            fmt::format("constraints hold{} and the balances hold {}", holds, grade_of(drift)),
            "but the error is not known"};
}

std::vector<std::string> reasons_of(const Run& run)
{
    if (run.report.converged()) return {};
    if (!run.verdict.reasons.empty()) return run.verdict.reasons;
    if (run.report.message.empty()) return {};
    return {run.report.message};
}

std::span<const JudgedFigure> judged_figures() { return judged; }

const JudgedFigure& judged_figure(std::string_view figure)
{
    const auto found = std::ranges::find(judged, figure, &JudgedFigure::figure);
    assert(found != std::end(judged));
    return *found;
}

}   // namespace livens
