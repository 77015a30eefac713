// SPDX-License-Identifier: BSD-3-Clause
// Loads in lanes against the same loads alone: two ways that share the laws of springs and functions of time,
// but no geometry.
#include <algorithm>
#include <cmath>

#include "livens/dynamics/lanes/load_lanes.h"
#include "livens/multibody/model.h"
#include "livens/spacetime/elements/kernel_functions.h"
#include "livens/spacetime/instructions.h"
#include "properties/load_kit.h"

namespace livens {

namespace {

/// The load alone, on bodies whose centres of mass are anywhere.
Model model_of(Random& random, const Load& load)
{
    Model model;
    for (int b = 0; b <= *std::ranges::max_element(load.bodies); ++b) {
        const MassProperties mass = with_center(box(1, {1, 1.2, 0.9}), random.vector());
        model.add_body(rigid_body(std::to_string(b), mass, {}));
    }
    model.add_load(load);
    return model;
}

}   // namespace

LoadAtPoints::LoadAtPoints(const Model& model, std::vector<LoadArguments> at)
    : tables_(model, {}), load_(model.loads()[0]), at_(std::move(at))
{
    std::vector<double> turns = first_turns();
    for (std::size_t c = 0; c < at_.size(); ++c) add_alone(c, turns);
}

/// Seven turns at the start.
std::vector<double> LoadAtPoints::first_turns() const
{
    return std::vector<double>(tables_.loads.turns.begin().size(), 44);
}

double LoadAtPoints::factor(std::size_t c) { return 0.1 * (static_cast<double>(c) + 1); }

void LoadAtPoints::add_alone(std::size_t c, std::vector<double>& turns)
{
    const std::size_t n_all = 12 * tables_.bodies.size();
    std::vector<double> X(n_all), V(n_all), raw(n_all);
    const LoadArguments& here = at_[c];
    for (std::size_t side = 0; side < load_.bodies.size(); ++side) {
        if (load_.bodies[side] == world) continue;
        std::copy_n(here.X[side].a, 12, X.begin() + 12 * load_.bodies[side]);
        std::copy_n(here.V[side].a, 12, V.begin() + 12 * load_.bodies[side]);
    }
    tables_.loads.turns.follow(Configurations(X.data()), turns);
    tables_.loads.add(here.at, X.data(), V.data(), factor(c), raw.data(), turns);
    for (int b = 0; b < tables_.n_bodies(); ++b)   // about the centres of mass
        for (int i = 3; i < 12; ++i)
            raw[12 * b + i] -= tables_.bodies[b].center[i / 3 - 1] * raw[12 * b + i % 3];
    alone_.push_back(raw);
    scales_.push_back(factor(c) * scale_of(tables_.loads.arguments(0, here.at, X.data(), V.data(), turns)));
}

/// What F is made of: as X and X' are rounded, so is a large F times a small difference of theirs.
double LoadAtPoints::scale_of(const LoadArguments& here) const
{
    LoadForces F{};
    LoadTangent tangent(load_.bodies.size());
    load_.forces(here, F);
    if (load_.depends_on_X || load_.depends_on_V) load_.tangent(here, tangent);
    double scale = 0;
    for (std::size_t b = 0; b < 2; ++b)
        for (int i = 0; i < 12 && load_.bodies[b] != world; ++i) {
            double terms = std::abs(F[b][i]);
            for (std::size_t c = 0; c < load_.bodies.size(); ++c)
                for (int k = 0; k < 12; ++k)
                    terms += std::abs(tangent.X[b][c](i, k) * here.X[c][k]) +
                             std::abs(tangent.V[b][c](i, k) * here.V[c][k]);
            scale = std::max(scale, terms);
        }
    return scale;
}

/// Of all bodies, 12 numbers each, about their centres of mass in W lanes.
AlignedDoubles LoadAtPoints::in_lanes(int W, PerBody<Matrix34> LoadArguments::*of) const
{
    AlignedDoubles x(12 * tables_.bodies.size() * static_cast<std::size_t>(W));
    for (std::size_t side = 0; side < load_.bodies.size(); ++side) {
        const int body = load_.bodies[side];
        for (int l = 0; body != world && l < W; ++l) {
            Matrix34 X = (at_[std::min(static_cast<std::size_t>(l), at_.size() - 1)].*of)[side];
            const double* c = tables_.bodies[body].center;
            X.set_column(0, X * Vector4{1, c[0], c[1], c[2]});
            for (int i = 0; i < 12; ++i) x[(12 * body + i) * W + l] = X[i];
        }
    }
    return x;
}

double LoadAtPoints::difference(const std::function<void(AlignedDoubles& F, int width)>& spoil) const
{
    const int n = static_cast<int>(at_.size());
    const lanes::Functions& functions = *lanes::functions(n);
    const int W = functions.width;
    const AlignedDoubles X = in_lanes(W, &LoadArguments::X), V = in_lanes(W, &LoadArguments::V);
    AlignedDoubles factors(static_cast<std::size_t>(W)), F(X.size());
    std::vector<Instant> instants;
    for (std::size_t c = 0; c < at_.size(); ++c) {
        factors[c] = factor(c);
        instants.push_back(at_[c].at);
    }
    LoadLanes side_by_side(tables_, functions.loads, W, n);
    side_by_side.begin(instants);
    for (int twice = 0; twice < 2; ++twice)   // nothing stays from the first time
        side_by_side.evaluate(X.data(), V.data(), factors.data(), first_turns(), F.data());
    if (spoil) spoil(F, W);
    double worst = 0;
    for (int l = 0; l < W; ++l)
        for (std::size_t i = 0; i < 12 * tables_.bodies.size(); ++i) {
            const bool is_point = l < n;
            const double found = F[i * static_cast<std::size_t>(W) + static_cast<std::size_t>(l)];
            const double gap = std::abs(found - (is_point ? alone_[l][i] : 0));
            const double relative = gap == 0 ? 0 : gap / (is_point ? scales_[l] : 0);
            if (!(relative <= worst)) worst = relative;   // nan, too
        }
    return worst;
}

Failures check_load_lanes(const LoadCase& load_case)
{
    const Instructions before = instructions();
    Failures failures;
    Random random(7);
    for (const int n : {1, 2, 3, 5, 8, 12, 18})
        for (int again = 0; again < 8; ++again) {
            const Model model = model_of(random, load_case.make(random));
            std::vector<LoadArguments> at;
            for (int c = 0; c < n; ++c) at.push_back(random_arguments(random, model.loads()[0], load_case));
            const LoadAtPoints points(model, at);
            for (const Instructions set : {Instructions::sse2, Instructions::avx2, Instructions::avx512}) {
                if (!use_instructions(set)) continue;
                const double difference = points.difference();
                if (!(difference < 1e-14))
                    failures.push_back(std::to_string(n) + " lanes of " + std::string(to_string(set)) +
                                       " differ by " + std::to_string(difference * 1e14) + " times 1e-14");
            }
        }
    use_instructions(before);
    return failures;
}

}   // namespace livens
