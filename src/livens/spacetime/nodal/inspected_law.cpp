// SPDX-License-Identifier: BSD-3-Clause
// Which laws are looked at inside of elements, as sums of factors f_k times units F_k, and how far a factor
// of 1 moves what it acts on: by the mass of the bodies alone, an order of magnitude that says which doubts
// are negligible (docs/theory.md, "Looks at laws").
#include "livens/spacetime/nodal/inspected_law.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace livens {

namespace {

/// F itself, of a load of which nothing else is known: an entry is a factor. It looks at X and V of its
/// bodies and its angles.
LawInside whole(const Load& load)
{
    const std::size_t n = load.bodies.size();
    LawInside law;
    law.n_numbers = 24 * n + load.angles.size();
    law.n_factors = 24;
    law.numbers = [n](const LoadArguments& at, std::span<double> numbers) {
        for (std::size_t b = 0; b < n; ++b) {
            std::copy_n(at.X[b].a, 12, numbers.begin() + static_cast<std::ptrdiff_t>(24 * b));
            std::copy_n(at.V[b].a, 12, numbers.begin() + static_cast<std::ptrdiff_t>(24 * b + 12));
        }
        std::ranges::copy(at.angles, numbers.begin() + static_cast<std::ptrdiff_t>(24 * n));
    };
    law.factors = [n, forces = load.forces](Instant t, std::span<const double> numbers,
                                            std::span<double> factors) {
        LoadArguments at(n);
        at.at = t;
        for (std::size_t b = 0; b < n; ++b) {
            std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(24 * b), 12, at.X[b].a);
            std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(24 * b + 12), 12, at.V[b].a);
        }
        at.angles = numbers.subspan(24 * n);
        LoadForces F{};
        forces(at, F);
        for (std::size_t b = 0; b < 2; ++b)
            std::copy_n(F[b].a, 12, factors.begin() + static_cast<std::ptrdiff_t>(12 * b));
    };
    law.unit = [](const LoadArguments&, std::size_t k, LoadForces& F) { F[k / 12].a[k % 12] += 1; };
    return law;
}

/// By the bodies alone, where they are at the start: what matters is decided with the joints, later.
void weigh(const Tables& tables, InspectedLaw& law)
{
    const State start = tables.model->start();
    std::vector<double> X, V, maps(12 * tables.bodies.size()), q(static_cast<std::size_t>(tables.n_twists));
    for (const Matrix34& x : start.X) X.insert(X.end(), std::begin(x.a), std::end(x.a));
    for (const Matrix34& v : start.V) V.insert(V.end(), std::begin(v.a), std::end(v.a));
    tables.map_twists(X.data(), maps.data());
    const LoadArguments at = tables.arguments(law.load, {start.t}, X.data(), V.data(), {});
    const Load& load = tables.model->loads()[static_cast<std::size_t>(law.load)];
    for (std::size_t k = 0; k < law.inside.n_factors; ++k) {
        LoadForces F{};
        law.inside.unit(at, k, F);
        std::vector<double> raw(X.size(), 0.0);
        for (std::size_t b = 0; b < 2; ++b)
            if (load.bodies[b] != world)
                std::copy_n(F[b].a, 12, raw.begin() + static_cast<std::ptrdiff_t>(12 * load.bodies[b]));
        tables.twist_rows(X.data(), maps.data(), raw.data(), q.data());
        tables.to_scaled_rows(maps.data(), q.data(), q.data());
        tables.to_twist(maps.data(), q.data(), q.data());
        double mobility = 0;
        for (std::size_t i = 0; i < q.size(); ++i)
            mobility += std::abs(q[i]);   // m/s^2 and rad/s^2: lengths are of the order of the model's
        law.mobility.push_back(mobility * std::max(1.0, 1 / tables.length));
    }
}

}   // namespace

std::vector<InspectedLaw> laws_to_inspect(const Tables& tables)
{
    std::vector<InspectedLaw> laws;
    const std::vector<Load>& loads = tables.model->loads();
    for (std::size_t l = 0; l < loads.size(); ++l) {
        if (loads[l].is_smooth) continue;
        InspectedLaw law{
            static_cast<int>(l), loads[l].bodies, loads[l].inside ? *loads[l].inside : whole(loads[l]), {}};
        std::erase(law.bodies, world);
        weigh(tables, law);
        laws.push_back(std::move(law));
    }
    return laws;
}

}   // namespace livens
