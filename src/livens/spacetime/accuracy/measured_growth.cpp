// SPDX-License-Identifier: BSD-3-Clause
// docs/theory.md, "The horizon": What rounding does.
#include "livens/spacetime/accuracy/measured_growth.h"

#include <algorithm>

#include "livens/diagnostics/largest.h"
#include "livens/multibody/model.h"
#include "livens/spacetime/accuracy/reference_solution.h"

namespace livens::inline spacetime_internal {

namespace {

constexpr double half_spacing = 0x1p-53;   // of numbers, by half

}   // namespace

/// Twice half a spacing, or what the iteration leaves as a rule, a tenth of its tolerance.
double rounded_by(double tolerance)
{
    constexpr double some = 2, left = 0.1;
    return std::max(some * half_spacing, left * tolerance);
}

std::vector<double> told_of_rounding(const Growth& grown, double tolerance)
{
    std::vector<double> told = grown.rounding;
    for (double& r : told) r *= rounded_by(tolerance);
    return told;
}

/// What was measured, else the growth of half a spacing at the start. It never falls.
std::vector<double> grown_rounding(std::span<const double> growth, std::span<const double> measured)
{
    std::vector<double> grown;
    double largest = 0;
    for (std::size_t e = 0; e < growth.size(); ++e) {
        raise_to(largest, e < measured.size() ? measured[e] : half_spacing * growth[e]);
        // behind the horizon nothing is told
        grown.push_back(growth[e] < growth_at_horizon ? largest
                                                      : std::min(largest, half_spacing * growth_at_horizon));
    }
    return grown;
}

double told_without_rounding(const ErrorEstimate& found)
{
    constexpr double least = 1e-11, share = 0.3;   // below, it is not worth what it costs to know
    return std::max(least, share * found.largest);
}

/// Places and turns, where growth is measured; velocities are left as they are.
void count_rounding(const Model& model, std::span<const double> rounding, const TimeMesh& mesh,
                    ErrorEstimate& found)
{
    const auto n = static_cast<std::size_t>(found.n_bodies);
    for (std::size_t i = 0; i < found.position.size() && i / n < rounding.size(); ++i) {
        const double least = rounding[i / n];
        raise_to(found.position[i], least);
        if (!model.bodies()[i % n].is_point) raise_to(found.orientation[i], least);
    }
    found.find_largest(mesh);
}

/// At the ends of other elements.
std::vector<double> MeasuredGrowth::at(const std::vector<double>& ends,
                                       const std::vector<double>& figures) const
{
    if (ends == mesh_.ends || !is_whole() || figures.empty()) return figures;
    std::vector<double> there;
    for (const double t : ends) {
        const int e = mesh_.element_at(t);
        const double share = (t - mesh_.ends[e]) / mesh_.length(e);
        there.push_back((1 - share) * figures[e] + share * figures[e + 1]);
    }
    return there;
}

void MeasuredGrowth::tell(const Model& model, const Problem& problem, const SolveOptions& options,
                          double accuracy, Solution& solution)
{
    constexpr double share = 0.3;   // of the accuracy: what rounding may be without a closer look
    const TimeMesh& mesh = solution.motion.mesh;
    const double told = std::min(share * accuracy, told_without_rounding(solution.estimate));
    const bool is_open = growth_.rounding.empty() && is_rounding_open(growth_, told, options.tolerance);
    if (!is_whole() || mesh_.end() < mesh.end() || is_open) {
        growth_ = growth(model, problem, solution.method, options, solution.motion, told);
        mesh_ = mesh;
    }
    solution.growth = at(mesh.ends, growth_.factors);
    solution.growing = growth_.part;
    solution.rounding = at(mesh.ends, told_of_rounding(growth_, options.tolerance));
    solution.rounding_in = growth_.rounding_in;
    const std::vector<double> rounding = grown_rounding(solution.growth, solution.rounding);
    rounding_ = rounding.empty() ? 0 : rounding.back();
    least_rounding_ =
        solution.rounding.empty() ? rounding_ : rounding_ * rounded_by(0) / rounded_by(options.tolerance);
    count_rounding(model, rounding, mesh, solution.estimate);
}

std::string MeasuredGrowth::in_words(const Model& model) const
{
    return livens::in_words(growth_.rounding.empty() ? growth_.part : growth_.rounding_in, model);
}

double MeasuredGrowth::largest() const
{
    double largest = 0;
    for (const double g : growth_.factors) raise_to(largest, g);
    double rounding = 0;
    for (const double r : growth_.rounding) raise_to(rounding, r);
    return growth_.rounding.empty() ? largest : std::min(largest, rounding);
}

}   // namespace livens::inline spacetime_internal
