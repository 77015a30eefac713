// SPDX-License-Identifier: BSD-3-Clause
#include "livens/diagnostics/estimate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "livens/diagnostics/detail/largest.h"
#include "livens/diagnostics/sample.h"

namespace livens {

namespace {

/// Reactions of all joints on both sides of an instant: [f, t / length].
using Loads = std::vector<std::array<double, 12>>;

Loads loads_at(const Model& model, const Motion& motion, double t)
{
    Loads loads;
    const double length = model.length();
    for (const JointSample& joint : sample_joints(model, motion, t)) {
        std::array<double, 12>& all = loads.emplace_back();
        int k = 0;
        for (const Reaction* side : {&joint.left, &joint.right})
            for (int i = 0; i < 3; ++i) {
                all[k++] = side->force[i];
                all[k++] = side->torque[i] / length;
            }
    }
    return loads;
}

double norm_of(const std::array<double, 12>& load)
{
    double sum = 0;
    for (const double x : load) sum += x * x;
    return std::sqrt(0.5 * sum);
}

}   // namespace

ErrorMeter::ErrorMeter(const Model& model, const Motion& motion, double factor)
    : model_(model), motion_(motion), factor_(factor), length_(model.length())
{
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    const auto ends = static_cast<std::size_t>(motion.n_elements()) + 1;
    estimate_.n_bodies = model.n_bodies();
    estimate_.n_joints = motion.end_multipliers.empty() ? 0 : static_cast<int>(model.joints().size());
    for (auto* errors : {&estimate_.position, &estimate_.orientation, &estimate_.velocity})
        errors->assign(ends * static_cast<std::size_t>(estimate_.n_bodies), unknown);
    estimate_.reaction.assign(ends * static_cast<std::size_t>(estimate_.n_joints), unknown);
}

void ErrorMeter::compare(const Motion& finer, int first, int last)
{
    for (int end = first; end <= last; ++end) {
        const int there = element_end_at(finer.mesh, motion_.mesh.ends[end]);
        if (there < 0) continue;
        compare_states(end, motion_.at_end(end), finer.at_end(there));
        if (estimate_.n_joints > 0 && !finer.end_multipliers.empty()) compare_reactions(end, finer);
    }
}

void ErrorMeter::compare_states(int end, const State& a, const State& b)
{
    for (int k = 0; k < estimate_.n_bodies; ++k) {
        const Matrix34 dX = a.X[k] - b.X[k], dV = a.V[k] - b.V[k];
        const Vector4 centre = point(mass_properties(model_.bodies()[k].mass).center_of_mass);
        // the chord of a turn by phi is 2 sqrt(2) sin(phi / 2)
        const double chord = norm(directors(dX)) / (2 * std::sqrt(2.0));
        const auto at = static_cast<std::size_t>(end * estimate_.n_bodies + k);
        estimate_.position[at] = factor_ * norm(dX * centre) / length_;
        estimate_.orientation[at] = chord <= 1 ? factor_ * 2 * std::asin(chord) : factor_ * std::acos(-1.0);
        if (std::isnan(chord)) estimate_.orientation[at] = chord;
        estimate_.velocity[at] = factor_ * norm(dV * centre);
    }
}

void ErrorMeter::compare_reactions(int end, const Motion& finer)
{
    const double t = motion_.mesh.ends[end];
    const Loads a = loads_at(model_, motion_, t), b = loads_at(model_, finer, t);
    for (std::size_t j = 0; j < a.size(); ++j) {
        std::array<double, 12> gap;
        for (std::size_t i = 0; i < gap.size(); ++i) gap[i] = a[j][i] - b[j][i];
        estimate_.reaction[static_cast<std::size_t>(end * estimate_.n_joints) + j] = factor_ * norm_of(gap);
        largest_load_ = std::max(largest_load_, norm_of(a[j]));
    }
}

ErrorEstimate ErrorMeter::take()
{
    estimate_.largest = 0;
    for (std::size_t i = 0; i < estimate_.position.size(); ++i)
        for (const double error : {estimate_.position[i], estimate_.orientation[i]})
            if (raise_to(estimate_.largest, error)) {
                estimate_.time = motion_.mesh.ends[i / static_cast<std::size_t>(estimate_.n_bodies)];
                estimate_.body = static_cast<int>(i % static_cast<std::size_t>(estimate_.n_bodies));
            }
    for (double& error : estimate_.reaction) error = largest_load_ > 0 ? error / largest_load_ : 0;
    return std::move(estimate_);
}

double ErrorEstimate::digits(int end) const
{
    double error = 0;
    const auto n = static_cast<std::size_t>((end + 1) * n_bodies);
    for (std::size_t i = 0; i < std::min(n, position.size()); ++i) {
        raise_to(error, position[i]);
        raise_to(error, orientation[i]);
    }
    return error > 0 ? std::max(-std::log10(error), 0.0) : 16;
}

}   // namespace livens
