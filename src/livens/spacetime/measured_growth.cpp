// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/detail/measured_growth.h"

#include <algorithm>

#include "livens/diagnostics/largest.h"
#include "livens/spacetime/second.h"

namespace livens {

namespace {

constexpr double spacing = 0x1p-53;   // of numbers, by half

}   // namespace

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
    if (!is_whole() || mesh_.end() < mesh.end()) {
        const double told = std::min(share * accuracy, told_without_rounding(solution.estimate));
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

}   // namespace livens
