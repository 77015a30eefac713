// SPDX-License-Identifier: BSD-3-Clause
// Loads as units times factors, F = sum f_k(t, q, q') F_k: theory.md, "Coordinates of joints", Laws.
// Expressions, drag, attraction and bushings state their law; forces, tangents, looks and guards are made
// here, once for all.
#include "livens/multibody/loads/load_laws.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "livens/base/error.h"
#include "livens/multibody/loads/load_coordinate.h"
#include "livens/multibody/loads/load_values.h"

namespace livens {

namespace {

/// The type of a unit that is a generalised force.
constexpr const char* of_coordinate = "unit";

/// What a load is made of, and how it is evaluated. Its functions share it, as models are copied for each
/// phase of a motion.
struct Modulated {
    LoadParts parts;
    std::vector<LoadCoordinate> coordinates;

    struct Seen {
        std::vector<double> values, rates;
        LawArguments arguments(Instant at) const { return {at, values, rates}; }
    };

    Seen look(const LoadArguments& arguments) const
    {
        Seen seen;
        for (const LoadCoordinate& coordinate : coordinates) {
            const CoordinateState q = coordinate.look(arguments);
            seen.values.push_back(q.value);
            seen.rates.push_back(q.rate);
        }
        return seen;
    }

    void forces(const LoadArguments& arguments, LoadForces& F) const
    {
        const Seen seen = look(arguments);
        std::vector<double> factors(parts.units.size());
        parts.law(seen.arguments(arguments.at), factors, {});
        for (std::size_t k = 0; k < factors.size(); ++k) {
            LoadForces unit{};
            parts.units[k].forces(arguments, unit);
            // Forces act on the first two bodies; further ones are only looked at by the law.
            for (std::size_t b = 0; b < 2; ++b) F[b] += factors[k] * unit[b];
        }
    }

    LawOnTape on(LoadTape& tape) const
    {
        return {tape, [&](std::size_t i) { return coordinates[i].value(tape); },
                [&](std::size_t i) { return coordinates[i].rate(tape); }};
    }

    void record(LoadTape& tape, TapeNumber factor) const
    {
        std::vector<TapeNumber> factors(parts.units.size(), TapeNumber{&tape});
        const LawOnTape at = on(tape);
        if (parts.recorded_law)
            parts.recorded_law(at, factors);
        else
            call_law(at, factors);
        if (tape.takes_looks() && !parts.is_smooth) {
            std::vector<TapeNumber> numbers;
            for (std::size_t i = 0; i < coordinates.size(); ++i) numbers.push_back(at.value(i));
            for (std::size_t i = 0; i < coordinates.size(); ++i) numbers.push_back(at.rate(i));
            tape.watch_law(numbers, factors);
        }
        for (std::size_t k = 0; k < factors.size(); ++k)
            parts.units[k].forces.record(tape, factor * factors[k]);
    }

    /// Where the law is not known but by its values.
    void call_law(const LawOnTape& at, std::span<TapeNumber> factors) const
    {
        const std::size_t m = coordinates.size();
        std::vector<TapeNumber> numbers;
        for (std::size_t i = 0; i < m; ++i) numbers.push_back(at.value(i));
        for (std::size_t i = 0; i < m; ++i) numbers.push_back(at.rate(i));
        const auto call = [law = parts.law, m](Instant instant, std::span<const double> in,
                                               std::span<double> out) {
            law({instant, in.first(m), in.subspan(m)}, out, {});
        };
        const int n = static_cast<int>(factors.size());
        const TapeVector results = at.tape.outer(call, numbers, n);
        for (int k = 0; k < n; ++k) factors[static_cast<std::size_t>(k)] = results[k];
    }

    /// The slopes of factors alone, and of coordinates as they stand.
    /// The law writes slopes factor by factor, 2 m each: by values, then by rates of the m coordinates.
    std::vector<ProductSlopes> products(const LoadArguments& arguments) const
    {
        const std::size_t m = coordinates.size();
        const Seen seen = look(arguments);
        std::vector<double> factors(parts.units.size()), slopes(factors.size() * 2 * m);
        parts.law(seen.arguments(arguments.at), factors, slopes);
        std::vector<ProductSlopes> found(factors.size(), ProductSlopes(arguments.X.size()));
        for (std::size_t k = 0; k < factors.size(); ++k) {
            parts.units[k].forces(arguments, found[k].direction);
            const double* slope = slopes.data() + 2 * m * k;
            for (std::size_t i = 0; i < m; ++i)
                coordinates[i].add_products(arguments, slope[i], slope[m + i], found[k]);
        }
        return found;
    }

    /// dF_b/dX_c = sum_k f_k dF_bk/dX_c + F_bk df_k/dX_c, and dF_b/dV_c likewise.
    void tangent(const LoadArguments& arguments, LoadTangent& tangent) const
    {
        const std::size_t n = arguments.X.size(), m = coordinates.size();
        const Seen seen = look(arguments);
        std::vector<double> factors(parts.units.size()), slopes(factors.size() * 2 * m);
        parts.law(seen.arguments(arguments.at), factors, slopes);
        for (std::size_t k = 0; k < factors.size(); ++k) {
            PerBody<Matrix34> by_X(n), by_V(n);
            const double* slope = slopes.data() + 2 * m * k;
            for (std::size_t i = 0; i < m; ++i)
                coordinates[i].add_slopes(arguments, slope[i], slope[m + i], by_X, by_V);
            LoadForces unit{};
            parts.units[k].forces(arguments, unit);
            // The product rule: the factor times the unit's tangent, and the unit times the factor's slopes.
            std::optional<LoadTangent> of_unit;
            if (parts.units[k].depends_on_X) parts.units[k].tangent(arguments, of_unit.emplace(n));
            for (std::size_t b = 0; b < 2; ++b)
                for (std::size_t c = 0; c < n; ++c) {
                    if (of_unit) tangent.X[b][c] += factors[k] * of_unit->X[b][c];
                    add_outer(tangent.X[b][c], unit[b], by_X[c]);
                    add_outer(tangent.V[b][c], unit[b], by_V[c]);
                }
        }
    }
};

/// The bodies of the units, and behind them others that the law looks at.
void collect_bodies(Load& load, const std::vector<LoadCoordinate>& coordinates)
{
    for (const LoadCoordinate& coordinate : coordinates)
        for (const int body : coordinate.bodies())
            if (body != world && std::ranges::find(load.bodies, body) == load.bodies.end())
                load.bodies.push_back(body);
}

using SharedLaw = std::shared_ptr<const Modulated>;

LawInside inside_of(const SharedLaw& all)
{
    const std::size_t m = all->coordinates.size();
    LawInside law;
    law.n_numbers = 2 * m;
    law.n_factors = all->parts.units.size();
    law.numbers = [all, m](const LoadArguments& arguments, std::span<double> numbers) {
        const Modulated::Seen seen = all->look(arguments);
        std::ranges::copy(seen.values, numbers.begin());
        std::ranges::copy(seen.rates, numbers.begin() + static_cast<std::ptrdiff_t>(m));
    };
    law.factors = [all, m](Instant at, std::span<const double> numbers, std::span<double> factors) {
        all->parts.law({at, numbers.first(m), numbers.subspan(m)}, factors, {});
    };
    law.unit = [all](const LoadArguments& arguments, std::size_t k, LoadForces& F) {
        all->parts.units[k].forces(arguments, F);
    };
    if (all->parts.steepest)
        law.steepest = [all](const EnclosedValue& t, std::span<const EnclosedValue> numbers,
                             std::span<double> bounds) { all->parts.steepest(t, numbers, bounds); };
    law.only_at_centre = all->parts.is_smooth_off_centre;
    return law;
}

/// Where the law bends, and what is to be looked at.
void add_smoothness(Load& load, const SharedLaw& all)
{
    const LoadParts& parts = all->parts;
    load.is_smooth = parts.is_smooth;
    // Smooth laws need no looks between the load points (theory.md, "Looks at laws").
    if (!load.is_smooth) load.inside = inside_of(all);
    load.guards = parts.guards.guards;
    if (parts.guards.values)
        load.guarded = [all](const LoadArguments& arguments, std::span<double> numbers) {
            all->parts.guards.values(all->look(arguments).arguments(arguments.at), numbers);
        };
    load.bends_at_centre = static_cast<bool>(parts.guards.centre);
    if (parts.guards.centre)
        load.centre = [all](const LoadArguments& arguments) {
            return all->parts.guards.centre(all->look(arguments).arguments(arguments.at));
        };
}

}   // namespace

Load modulated(const std::string& name, const std::string& type, const LoadParts& parts,
               const Configurations& X)
{
    const auto refuse = [&](const std::string& message) {
        throw InputError({"load-empty", "load[" + name + "]", message, "", "", "", ""});
    };
    if (parts.units.empty() || !parts.law) refuse("a load needs units and a law");
    for (const Load& unit : parts.units)
        // The tangent above takes units for functions of X alone: rates enter by the factors.
        if (unit.bodies != parts.units[0].bodies || unit.depends_on_V)
            refuse("units of a load act on the same bodies, whatever their velocity");
    const std::vector<int>& bodies = parts.units[0].bodies;
    Load load = start_load(name, type.c_str(), {bodies[0], bodies[1]});
    Modulated made{parts, {}};
    for (const LawCoordinate& q : parts.coordinates)
        made.coordinates.emplace_back(q.coordinate, q.at_stated, X);
    collect_bodies(load, made.coordinates);
    for (std::size_t i = 0; i < made.coordinates.size(); ++i)
        made.coordinates[i].place(load, parts.coordinates[i].is_needed);
    const SharedLaw all = std::make_shared<const Modulated>(std::move(made));
    load.depends_on_X = !parts.coordinates.empty();
    load.depends_on_V = parts.depends_on_rates;
    load.breaks = parts.breaks;
    std::ranges::sort(load.breaks);
    load.domain = parts.domain;
    for (const Load& unit : parts.units) {
        load.rotations.insert(load.rotations.end(), unit.rotations.begin(), unit.rotations.end());
        load.depends_on_X = load.depends_on_X || unit.depends_on_X;
        for (std::size_t b = 0; b < 2; ++b)
            load.needs_directors[b] = load.needs_directors[b] || unit.needs_directors[b];
    }
    load.forces = [all](const LoadArguments& arguments, LoadForces& F) { all->forces(arguments, F); };
    load.tangent = [all](const LoadArguments& arguments, LoadTangent& tangent) {
        all->tangent(arguments, tangent);
    };
    if (std::ranges::all_of(parts.units, [](const Load& unit) { return unit.type == of_coordinate; }))
        load.products = [all](const LoadArguments& arguments) { return all->products(arguments); };
    if (std::ranges::all_of(parts.units, [](const Load& unit) { return unit.forces.record != nullptr; }))
        load.forces.record = [all](LoadTape& tape, const TapeNumber& factor) { all->record(tape, factor); };
    const auto energy = [&](const LawEnergy& given) -> std::function<double(const LoadArguments&)> {
        if (!given) return nullptr;
        return [all, of = std::make_shared<const LawEnergy>(given)](const LoadArguments& arguments) {
            return (*of)(all->look(arguments).arguments(arguments.at));
        };
    };
    for (const LawReading& reading : parts.readings)
        load.readings.push_back({reading.name, reading.unit, energy(reading.value)});
    add_smoothness(load, all);
    load.potential = energy(parts.potential);
    load.power = energy(parts.power);
    if (parts.recorded_power)
        load.recorded_power = [all](LoadTape& tape) { return all->parts.recorded_power(all->on(tape)); };
    return load;
}

LawReading factor_reading(const std::string& name, const std::string& unit, const LoadLaw& law, std::size_t k,
                          std::size_t n_factors)
{
    return {name, unit, [law, k, n_factors](const LawArguments& at) {
                std::vector<double> factors(n_factors);
                law(at, factors, {});
                return factors[k];
            }};
}

Load unit_along(const std::string& name, const JointCoordinate& coordinate, const Configurations& X)
{
    LoadCoordinate along(coordinate, 0, X);
    Load load = start_load(name, of_coordinate, along.bodies());
    along.place(load, false);   // its direction is the same in every turn
    load.depends_on_X = true;
    load.needs_directors = along.needs_directors();
    const auto shared = std::make_shared<const LoadCoordinate>(std::move(along));
    load.forces = [shared](const LoadArguments& arguments, LoadForces& F) {
        shared->add_forces(arguments, 1, F);
    };
    load.tangent = [shared](const LoadArguments& arguments, LoadTangent& tangent) {
        shared->add_tangent(arguments, {1, 0, 0}, tangent);
    };
    load.forces.record = [shared](LoadTape& tape, const TapeNumber& factor) { shared->pull(tape, factor); };
    return load;
}

}   // namespace livens
