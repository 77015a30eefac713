// SPDX-License-Identifier: BSD-3-Clause
// Loads in lanes against the same loads alone: two ways that share the laws of springs and functions of time,
// but no geometry.
#include <algorithm>
#include <cmath>

#include "livens/dynamics/lanes/load_lanes.h"
#include "livens/dynamics/lanes/load_program.h"
#include "livens/multibody/model.h"
#include "livens/solvers/instructions.h"
#include "livens/spacetime/elements/kernel_functions.h"
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
    LoadForces F(load_.n_acted);
    LoadTangent tangent(load_.bodies.size(), load_.n_acted);
    load_.forces(here, F);
    if (load_.depends_on_X || load_.depends_on_V) load_.tangent(here, tangent);
    double scale = 0;
    for (std::size_t b = 0; b < load_.n_acted; ++b)
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
    LoadLanes side_by_side(tables_, functions.loads->run, W, n);
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

namespace {

/// F, moment and power of a load at an instant, and sums of the absolute terms that these are made of.
struct SupplyAlone {
    Vector3 force{}, moment{};
    double power, of_force = 0, of_moment = 0, of_power = 0;

    SupplyAlone(const Load& load, const LoadArguments& at) : power(power_without_potential(load, at))
    {
        LoadForces F(load.n_acted);
        load.forces(at, F);
        for (std::size_t b = 0; b < load.n_acted; ++b) {
            if (load.bodies[b] == world) continue;
            force += F[b].column(0);
            of_force += norm(F[b].column(0));
            for (int c = 0; c < 4; ++c) {
                moment += cross(at.X[b].column(c), F[b].column(c));
                of_moment += norm(at.X[b].column(c)) * norm(F[b].column(c));
                of_power += norm(at.V[b].column(c)) * norm(F[b].column(c));
            }
        }
    }
};

/// The largest gap of what the tape says of load 0 at an instant, by the larger of both sizes; -1 where it is
/// not recorded.
double supply_gap(const Model& model, const LoadArguments& here)
{
    const ModelTables tables(model, {});
    LoadLanes lanes(tables, nullptr, 1, 1, RecordedLoads::supplies);
    const Load& load = model.loads()[0];
    if (!lanes.program().others().empty()) return -1;
    AlignedDoubles X(12 * tables.bodies.size()), V(X.size());
    for (std::size_t side = 0; side < load.bodies.size(); ++side) {
        if (load.bodies[side] == world) continue;
        const double* c = tables.bodies[load.bodies[side]].center;
        const auto put = [&](Matrix34 of, AlignedDoubles& to) {
            of.set_column(0, of * Vector4{1, c[0], c[1], c[2]});
            std::copy_n(of.a, 12, to.begin() + 12 * load.bodies[side]);
        };
        put(here.X[side], X);
        put(here.V[side], V);
    }
    std::vector<double> turns(load.angles.size(), 44), alone_turns = turns;
    lanes.begin({&here.at, 1});
    lanes.go_on(turns, X.data(), V.data());
    LoadArguments at = here;
    at.angles = turns;
    const SupplyAlone alone(load, at);
    const SupplyOnTape& places = lanes.program().supply();
    const auto number = [&](int place) { return *lanes.number(place); };
    // A load may be small beside the terms that it is made of: those of the tape are single pulls.
    const double force = std::max(alone.of_force, number(places.gross));
    const double moment = std::max(alone.of_moment, number(places.gross_moment));
    double worst = 0;
    const auto compare = [&](double found, double expected, double size) {
        const double gap = std::abs(found - expected);
        if (gap != 0 && !(gap <= worst * size)) worst = gap / size;
    };
    for (int i = 0; i < 3; ++i) {
        compare(number(places.force + i), alone.force[i], force);
        compare(number(places.moment + i), alone.moment[i], moment);
    }
    compare(number(places.power), alone.power,
            std::max({std::abs(alone.power), alone.of_power, load.power ? 0 : moment}));
    if (number(places.gross) < (1 - 1e-12) * alone.of_force) worst = 1;
    return worst;
}

}   // namespace

Failures check_load_supply(const LoadCase& load_case, double bound)
{
    Failures failures;
    Random random(11);
    for (int again = 0; again < 50; ++again) {
        const Model model = model_of(random, load_case.make(random));
        const double gap = supply_gap(model, random_arguments(random, model.loads()[0], load_case));
        if (!(gap < bound))
            failures.push_back("supply differs by " + std::to_string(gap * 1e13) + " times 1e-13");
    }
    return failures;
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
