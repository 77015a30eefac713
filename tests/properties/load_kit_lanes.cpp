// SPDX-License-Identifier: BSD-3-Clause
// Loads in lanes against the same loads alone: two ways that share the laws of springs and functions of time,
// but no geometry.
#include <algorithm>
#include <cmath>

#include "livens/dynamics/lanes/load_lanes.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/multibody/model.h"
#include "livens/spacetime/instructions.h"
#include "livens/spacetime/nodal/kernel/kernel_functions.h"
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

/// n points in the lanes of a set of instructions, side by side and one by one.
struct Points {
    const ModelTables tables;
    const Load& load;
    int n;
    const lanes::Functions& functions;
    std::vector<LoadArguments> at;

    Points(const Model& model, int n_points, Random& random, const LoadCase& load_case)
        : tables(model, {}), load(model.loads()[0]), n(n_points), functions(*lanes::functions(n_points))
    {
        for (int c = 0; c < n; ++c) at.push_back(random_arguments(random, load, load_case));
    }

    /// Of the load's bodies, 12 numbers each, about their centres of mass in lanes.
    AlignedDoubles in_lanes(PerBody<Matrix34> LoadArguments::*of) const
    {
        const int W = functions.width;
        AlignedDoubles x(12 * tables.bodies.size() * static_cast<std::size_t>(W));
        for (std::size_t side = 0; side < load.bodies.size(); ++side) {
            const int body = load.bodies[side];
            for (int l = 0; body != world && l < W; ++l) {
                Matrix34 X = (at[static_cast<std::size_t>(std::min(l, n - 1))].*of)[side];
                const double* c = tables.bodies[body].center;
                X.set_column(0, X * Vector4{1, c[0], c[1], c[2]});
                for (int i = 0; i < 12; ++i) x[(12 * body + i) * W + l] = X[i];
            }
        }
        return x;
    }

    /// The largest difference by the scale of the forces, over both ways.
    double difference()
    {
        const int W = functions.width;
        const AlignedDoubles X = in_lanes(&LoadArguments::X), V = in_lanes(&LoadArguments::V);
        AlignedDoubles factors(static_cast<std::size_t>(W)), F(X.size());
        std::vector<Instant> instants;
        for (int c = 0; c < n; ++c) {
            factors[c] = 0.1 * (c + 1);
            instants.push_back(at[static_cast<std::size_t>(c)].at);
        }
        std::vector<double> turns = tables.loads.turns.begin();
        for (double& turn : turns) turn = 44;   // seven turns
        LoadLanes side_by_side(tables, functions.loads, W, n);
        side_by_side.begin(instants);
        for (int twice = 0; twice < 2; ++twice)   // nothing stays from the first time
            side_by_side.evaluate(X.data(), V.data(), factors.data(), turns, F.data());
        double worst = 0;
        for (int l = 0; l < W; ++l) worst = std::max(worst, compare(l, factors[l], turns, F));
        return worst;
    }

    /// What F is made of: as X and X' are rounded, so is a large F times a small difference of theirs.
    double scale_of(const LoadArguments& here) const
    {
        LoadForces F{};
        LoadTangent tangent(load.bodies.size());
        load.forces(here, F);
        if (load.depends_on_X || load.depends_on_V) load.tangent(here, tangent);
        double scale = 1;
        for (std::size_t b = 0; b < 2; ++b)
            for (int i = 0; i < 12 && load.bodies[b] != world; ++i) {
                double terms = std::abs(F[b][i]);
                for (std::size_t c = 0; c < load.bodies.size(); ++c)
                    for (int k = 0; k < 12; ++k)
                        terms += std::abs(tangent.X[b][c](i, k) * here.X[c][k]) +
                                 std::abs(tangent.V[b][c](i, k) * here.V[c][k]);
                scale = std::max(scale, terms);
            }
        return scale;
    }

    double compare(int l, double factor, std::vector<double>& turns, const AlignedDoubles& F) const
    {
        const std::size_t n_all = 12 * tables.bodies.size();
        std::vector<double> X(n_all), V(n_all), raw(n_all);
        const LoadArguments& here = at[static_cast<std::size_t>(std::min(l, n - 1))];
        for (std::size_t side = 0; side < load.bodies.size(); ++side) {
            if (load.bodies[side] == world) continue;
            std::copy_n(here.X[side].a, 12, X.begin() + 12 * load.bodies[side]);
            std::copy_n(here.V[side].a, 12, V.begin() + 12 * load.bodies[side]);
        }
        if (l < n) tables.loads.turns.follow(Configurations(X.data()), turns);
        tables.loads.add(here.at, X.data(), V.data(), factor, raw.data(), turns);
        const double scale = factor * scale_of(tables.loads.arguments(0, here.at, X.data(), V.data(), turns));
        double worst = 0;
        for (int b = 0; b < tables.n_bodies(); ++b)
            for (int i = 0; i < 12; ++i) {
                const double centre = i < 3 ? 0 : tables.bodies[b].center[i / 3 - 1];
                const double alone = raw[12 * b + i] - centre * raw[12 * b + i % 3];
                const double gap = std::abs(F[(12 * b + i) * functions.width + l] - alone);
                if (!(gap <= worst)) worst = gap;   // nan, too
            }
        return scale > 0 ? worst / scale : worst;
    }
};

}   // namespace

Failures check_load_lanes(const LoadCase& load_case)
{
    const Instructions before = instructions();
    Failures failures;
    Random random(7);
    for (const Instructions set : {Instructions::sse2, Instructions::avx2, Instructions::avx512}) {
        if (!use_instructions(set)) continue;
        for (const int n : {1, 2, 3, 5, 8, 12, 18})
            for (int again = 0; again < 8; ++again) {
                const Model model = model_of(random, load_case.make(random));
                const double difference = Points(model, n, random, load_case).difference();
                if (!(difference < 1e-14))
                    failures.push_back(std::to_string(n) + " lanes of " + std::string(to_string(set)) +
                                       " differ by " + std::to_string(difference * 1e14) + " times 1e-14");
            }
    }
    use_instructions(before);
    return failures;
}

}   // namespace livens
