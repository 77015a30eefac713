// SPDX-License-Identifier: BSD-3-Clause
// docs/theory.md, "An accuracy between both ends".
#include "livens/spacetime/accuracy/remeshing.h"

#include <algorithm>
#include <cmath>

#include "livens/base/elementary.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/diagnostics/largest.h"
#include "livens/spacetime/march/step_size_controller.h"
#include "livens/spacetime/solve_mesh.h"

namespace livens::inline spacetime_internal {

namespace {

/// Times the length of an element before: those that follow it are no longer, nor shorter.
constexpr double most_stretched = 2.5, most_shrunk = 1.0 / 16;
/// By which lengths beside each other may differ: a jump that passes through zero says nothing of its
/// element.
constexpr double grading = 2;
/// What rounding alone makes of a velocity jump.
constexpr double rounded_jump = 1e-15;
/// Elements that a stop shortens by less than this share are not divided.
constexpr double slack = 0.02;

}   // namespace

ElementScales::ElementScales(const Model& model, const Motion& motion, const std::vector<Unseen>& unseen)
    : mesh_(motion.mesh), unseen_(static_cast<std::size_t>(motion.n_elements()), 0.0)
{
    for (const Unseen& one : unseen) {
        const double middle = one.t - 0.5 * one.duration;
        raise_to(unseen_[static_cast<std::size_t>(mesh_.element_at(middle))], one.error);
    }
    const std::vector<double> jumps = velocity_jumps(model, motion);
    for (int e = 0; e < motion.n_elements(); ++e) {
        const double jump = std::max(jumps[e], rounded_jump);
        scales_.push_back(mesh_.length(e) * power(jump, -1.0 / (motion.X.degree + 1)));
        mean_error_ += std::max(local_error(motion.X.points, motion.X.degree, jump), unseen_[e]);
    }
    mean_error_ /= motion.n_elements();
}

double ElementScales::mean_length(int degree, double error) const
{
    double sum = 0;
    for (const double scale : scales_) sum += logarithm(scale);
    return exponential(sum / static_cast<double>(scales_.size())) *
           power(velocity_jump_of(Points::lobatto, degree, error), 1.0 / (degree + 1));
}

/// Of elements in the place of those that are known. What laws do unseen falls by two orders at least where
/// they bend, and the elements around are none of its business.
std::vector<double> ElementScales::lengths(int degree, double error) const
{
    const double share = power(velocity_jump_of(Points::lobatto, degree, error), 1.0 / (degree + 1));
    std::vector<double> lengths(scales_.size());
    for (std::size_t e = 0; e < scales_.size(); ++e) {
        const double known = mesh_.length(static_cast<int>(e));
        lengths[e] = std::clamp(share * scales_[e], most_shrunk * known, most_stretched * known);
    }
    // Between two bends there may be a piece of any length: those beside it are not as short all along.
    const auto grade = [&](std::size_t e, std::size_t beside) {
        const double shortest = most_shrunk * mesh_.length(static_cast<int>(e));
        lengths[e] = std::min(lengths[e], std::max(grading * lengths[beside], shortest));
    };
    for (std::size_t e = 1; e < lengths.size(); ++e) grade(e, e - 1);
    for (std::size_t e = lengths.size() - 1; e-- > 0;) grade(e, e + 1);
    for (std::size_t e = 0; e < lengths.size(); ++e)
        if (unseen_[e] > error)
            lengths[e] = std::min(lengths[e], mesh_.length(static_cast<int>(e)) *
                                                  std::max(most_shrunk, std::sqrt(error / unseen_[e])));
    return lengths;
}

/// The number of wanted elements up to t is piecewise linear; between two stops it is divided into equal
/// parts and solved for t.
std::vector<double> ElementScales::ends(int degree, double error, std::span<const double> stops) const
{
    const std::vector<double> wanted = lengths(degree, error);
    std::vector<double> sums{0};   // of elements, up to the ends that are known
    for (std::size_t e = 0; e < wanted.size(); ++e)
        sums.push_back(sums.back() + mesh_.length(static_cast<int>(e)) / wanted[e]);
    const auto elements_until = [&](double t) {
        const int e = mesh_.element_at(t);
        return sums[e] + (t - mesh_.ends[e]) / wanted[e];
    };
    std::vector<double> ends{stops.front()};
    for (std::size_t k = 1; k < stops.size(); ++k) {
        const double first = elements_until(stops[k - 1]), all = elements_until(stops[k]) - first;
        const int n = std::max(1, static_cast<int>(std::ceil(all - slack)));
        for (int i = 1; i < n; ++i) {
            const double sum = first + all * i / n;
            const auto above = std::ranges::upper_bound(sums, sum);
            const auto e = std::min(static_cast<std::size_t>(above - sums.begin()), wanted.size()) - 1;
            const double t = mesh_.ends[e] + (sum - sums[e]) * wanted[e];
            if (t > ends.back() && t < stops[k]) ends.push_back(t);
        }
        ends.push_back(stops[k]);
    }
    return ends;
}

TimeMesh halved(const TimeMesh& mesh)
{
    TimeMesh fine{{mesh.start()}, mesh.required, mesh.bends};
    for (int e = 0; e < mesh.n_elements(); ++e) {
        fine.ends.push_back(mesh.ends[e] + 0.5 * mesh.length(e));
        fine.ends.push_back(mesh.ends[e + 1]);
    }
    return fine;
}

/// Ends that were put at bends before are stepped over: a piece of both elements beside one finds its own.
std::vector<double> bends_of(const Stated& of, const Motion& motion, const std::vector<double>& known,
                             const Lobatto& lobatto, SolveOptions options)
{
    const Model& model = *of.model;
    std::vector<double> bends;
    if (!options.end_at_bends || !model.has_pieces()) return bends;
    options.condition = options.judge = false;
    options.initial = StartPolicy::project;
    for (int e = 0, next = 1; e < motion.n_elements(); e = next++) {
        while (std::ranges::binary_search(known, motion.mesh.ends[next])) ++next;
        Problem part{{motion.at_end(e)}};
        part.prepared = of.problem.prepared;
        const TimeMesh one{{motion.mesh.ends[e], motion.mesh.ends[next]}};
        const Solution s = solve_unjudged(model, part, one, lobatto, options);
        bends.insert(bends.end(), s.motion.mesh.bends.begin(), s.motion.mesh.bends.end());
    }
    return bends;
}

}   // namespace livens::inline spacetime_internal
