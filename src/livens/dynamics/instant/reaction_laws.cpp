// SPDX-License-Identifier: BSD-3-Clause
// Loads that read reactions, as all others are seen: docs/theory.md, "Laws of reactions".
#include "livens/dynamics/instant/reaction_laws.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "livens/base/error.h"
#include "livens/dynamics/instant/reaction_mechanism.h"
#include "livens/multibody/loads/load_coordinate.h"

namespace livens {

namespace {

using Values = std::vector<double>;

/// One law as a load: what it looks at, in its own list of bodies.
struct ByReactions {
    std::shared_ptr<ReactionMechanism> mechanism;
    std::size_t index = 0;
    std::vector<int> bodies{};                                // of the load
    std::vector<std::vector<LoadCoordinate>> coordinates{};   // of all laws

    struct Seen {
        Values factors;   // of this law
        Values values, rates, reactions;
    };

    /// Laws are solved together, since each force may change all reactions; this one takes its own part.
    Seen look(const LoadArguments& at) const
    {
        State state{
            at.at.t, std::vector<Matrix34>(static_cast<std::size_t>(mechanism->model().n_bodies())), {}};
        state.V.resize(state.X.size());
        for (std::size_t b = 0; b < bodies.size(); ++b)
            if (bodies[b] != world) {
                state.X[static_cast<std::size_t>(bodies[b])] = at.X[b];
                state.V[static_cast<std::size_t>(bodies[b])] = at.V[b];
            }
        Values angles;
        if (at.angles.size() >= mechanism->n_angles())
            angles.assign(at.angles.begin(),
                          at.angles.begin() + static_cast<std::ptrdiff_t>(mechanism->n_angles()));
        std::vector<Values> values(coordinates.size()), rates(coordinates.size());
        std::vector<LawArguments> arguments;
        for (std::size_t i = 0; i < coordinates.size(); ++i) {
            for (const LoadCoordinate& q : coordinates[i]) {
                const CoordinateState one = q.look(at);
                values[i].push_back(one.value);
                rates[i].push_back(one.rate);
            }
            arguments.push_back({at.at, values[i], rates[i]});
        }
        Values factors;
        Reactions reactions;
        mechanism->solve(state, angles, at.at.side == Side::left ? Side::left : Side::right, arguments,
                         factors, reactions);
        std::size_t first = 0;
        for (std::size_t i = 0; i < index; ++i) first += mechanism->laws()[i].units.size();
        const ReactionLaw& law = mechanism->laws()[index];
        return {Values(factors.begin() + static_cast<std::ptrdiff_t>(first),
                       factors.begin() + static_cast<std::ptrdiff_t>(first + law.units.size())),
                values[index], rates[index], mechanism->inputs(law, reactions)};
    }

    void forces(const LoadArguments& at, LoadForces& F) const
    {
        const Seen seen = look(at);
        const ReactionLaw& law = mechanism->laws()[index];
        for (std::size_t k = 0; k < seen.factors.size(); ++k) {
            LoadForces unit{};
            law.units[k].forces(at, unit);
            for (std::size_t b = 0; b < 2; ++b) F[b] += seen.factors[k] * unit[b];
        }
    }

    /// One of the numbers of its bodies.
    struct Entry {
        std::size_t body = 0;
        bool is_rate = false;
        int j = 0;
    };

    /// What a step along it adds to the forces.
    LoadForces change(const LoadArguments& at, const LoadForces& here, const Entry& by, double step) const
    {
        LoadArguments beside = at;
        (by.is_rate ? beside.V : beside.X)[by.body].a[by.j] += step;
        LoadForces there{};
        forces(beside, there);
        for (std::size_t b = 0; b < 2; ++b) there[b] -= here[b];
        return there;
    }

    /// Whether a change that is much of the forces does not become less as the step does: at a jump, on which
    /// side of it a state is may be a matter of rounding.
    bool jumps(const LoadArguments& at, const LoadForces& here, const Entry& by, double step,
               const LoadForces& changed) const
    {
        constexpr double much = 1e-3, shorter = 0.25, alike = 0.5;
        double most = 0, size = 0, off = 0;
        for (std::size_t b = 0; b < 2; ++b)
            for (int i = 0; i < 12; ++i) {
                size = std::max(size, std::abs(here[b].a[i]));
                most = std::max(most, std::abs(changed[b].a[i]));
            }
        if (!(most > much * size)) return false;
        const LoadForces less = change(at, here, by, shorter * step);
        for (std::size_t b = 0; b < 2; ++b)
            for (int i = 0; i < 12; ++i)
                off = std::max(off, std::abs(less[b].a[i] - shorter * changed[b].a[i]));
        return off > alike * shorter * most;
    }

    /// By differences: Newton's iteration asks for it, and what it leaves out costs a step. A jump beside the
    /// state is no slope, however short the step: then the other side is taken, and none between two jumps.
    void tangent(const LoadArguments& at, LoadTangent& out) const
    {
        LoadForces here{};
        forces(at, here);
        for (std::size_t c = 0; c < at.X.size(); ++c) {
            if (bodies[c] == world) continue;
            for (const bool is_rate : {false, true})
                for (int j = 0; j < 12; ++j) {
                    const Entry by{c, is_rate, j};
                    double step = 1e-6 * std::max(1.0, std::abs((is_rate ? at.V : at.X)[c].a[j]));
                    LoadForces changed = change(at, here, by, step);
                    if (jumps(at, here, by, step, changed)) {
                        step = -step;
                        changed = change(at, here, by, step);
                        if (jumps(at, here, by, step, changed)) continue;
                    }
                    for (std::size_t b = 0; b < 2; ++b)
                        for (int i = 0; i < 12; ++i)
                            (is_rate ? out.V : out.X)[b][c](i, j) += changed[b].a[i] / step;
                }
        }
    }
};

/// Of the bodies of a load: those that its law acts on, then all others of the model.
std::vector<int> bodies_of(const ReactionLaw& law, const Model& model)
{
    std::vector<int> all = law.units.empty() ? std::vector<int>{0, world} : law.units[0].bodies;
    for (int b = 0; b < model.n_bodies(); ++b)
        if (std::ranges::find(all, b) == all.end()) all.push_back(b);
    return all;
}

/// What it looks at, and what it says of itself.
void show(const std::shared_ptr<const ByReactions>& all, const ReactionLaw& law, Load& load)
{
    if (law.guarded)
        load.guarded = [all, guarded = law.guarded](const LoadArguments& at, std::span<double> numbers) {
            const ByReactions::Seen seen = all->look(at);
            guarded({at.at, seen.values, seen.rates}, seen.reactions, numbers);
        };
    for (std::size_t k = 0; k < law.readings.size(); ++k) {
        const ReactionLaw::Reading& one = law.readings[k];
        load.readings.push_back(
            {one.name, one.unit, [all, k, value = one.value](const LoadArguments& at) {
                 const ByReactions::Seen seen = all->look(at);
                 return value ? value({at.at, seen.values, seen.rates}, seen.reactions) : seen.factors[k];
             }});
    }
}

Load load_by(const std::shared_ptr<ReactionMechanism>& mechanism, std::size_t index)
{
    const ReactionLaw& law = mechanism->laws()[index];
    Load load = waiting(law);
    load.bodies = bodies_of(law, mechanism->model());
    load.readings.clear();
    ByReactions made{mechanism, index, load.bodies, {}};
    // Angles of the mechanism's loads first: look() hands them on in this order.
    for (const Load& one : mechanism->model().loads())
        load.angles.insert(load.angles.end(), one.angles.begin(), one.angles.end());
    const State start = mechanism->model().start();
    for (const ReactionLaw& each : mechanism->laws()) {
        made.coordinates.emplace_back();
        for (const LawCoordinate& q : each.coordinates) {
            made.coordinates.back().emplace_back(q.coordinate, q.at_stated, Configurations(start.X));
            made.coordinates.back().back().place(load, q.is_needed);
        }
    }
    for (const TimeSpan& span : law.times.spans())
        for (const double t : {span.from, span.until})
            if (std::isfinite(t)) load.breaks.push_back(t);
    std::ranges::sort(load.breaks);
    load.domain = "no force fits the reactions that it reads, or several do, or joints lose rank there or "
                  "share what they bear, so that it is not known";
    load.guards = law.guards;
    const auto all = std::make_shared<const ByReactions>(std::move(made));
    show(all, law, load);
    load.is_smooth = law.units.empty();
    if (law.units.empty()) return load;
    load.depends_on_X = load.depends_on_V = true;
    load.forces = [all](const LoadArguments& at, LoadForces& F) { all->forces(at, F); };
    load.tangent = [all](const LoadArguments& at, LoadTangent& out) { all->tangent(at, out); };
    if (law.type == controller_type)   // no work on what has mass
        load.power = [](const LoadArguments&) { return 0.0; };
    return load;
}

}   // namespace

std::vector<Load> loads_by_reactions(const Model& rest, const std::vector<ReactionLaw>& laws)
{
    const auto mechanism = std::make_shared<ReactionMechanism>(rest, laws);
    std::vector<Load> loads;
    for (std::size_t i = 0; i < laws.size(); ++i) loads.push_back(load_by(mechanism, i));
    return loads;
}

void check_reaction_laws(const Model& model, double t)
{
    const ActingModel acting = acting_at(model, t);
    State start = acting.model.start();
    start.t = t;
    const UniqueReactions found = unique_reactions(acting.model, start);
    for (const Load& load : acting.model.loads()) {
        if (load.by_reactions == nullptr) continue;
        for (const ReactionInput& input : load.by_reactions->reactions) {
            const auto j = static_cast<std::size_t>(input.joint);
            if (input.joint < 0 || found.joint_is_unique[j]) continue;
            throw InputError({"event-reaction", "load[" + load.name + "]",
                              "a law reads a reaction of joint '" + acting.model.joints()[j].name +
                                  "' that is not unique: other joints could carry " +
                                  livens::in_words(found.shared[j]),
                              "", "", "bodies are held more often than they need to be",
                              "let joints hold what they must and no more, as a spherical joint in place of "
                              "a revolute one"});
        }
    }
}

}   // namespace livens
