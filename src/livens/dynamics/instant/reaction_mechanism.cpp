// SPDX-License-Identifier: BSD-3-Clause
// Reactions are linear in the forces that read them: one solution of the mechanism without them and one for
// each unit tell all, and forces follow from few equations (docs/theory.md, "Laws of reactions").
#include "livens/dynamics/instant/reaction_mechanism.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "livens/dynamics/instant/settled_instant.h"
#include "livens/solvers/factors.h"

namespace livens::inline dynamics_internal {

namespace {

constexpr int most_steps = 60;
constexpr double met = 1e-12;   // of the forces

/// But for what drives say.
bool holds(const Model& model, const State& state)
{
    constexpr double near = 1e-6;   // of the scale of a row
    for (const Joint& joint : model.joints())
        for (const ConstraintRow& row : joint.rows)
            if (row.drives.empty() && std::abs(constraint_value(row, state.X)) > near * row.scale)
                return false;
    return true;
}

}   // namespace

Reactions ReactionResponse::under(const std::vector<double>& factors) const
{
    Reactions all = without;
    for (std::size_t k = 0; k < factors.size(); ++k)
        for (std::size_t j = 0; j < all.size(); ++j) {
            all[j].force += factors[k] * by_unit[k][j].force;
            all[j].torque += factors[k] * by_unit[k][j].torque;
        }
    return all;
}

UniqueReactions unique_reactions(const Model& model, const State& state)
{
    const std::vector<double> none(static_cast<std::size_t>(model.n_rows()), 0.0);
    return least_reactions(frozen(model, {state.t}), state.X, none, most_rows(model, std::span(&state, 1)));
}

/// A mechanism under no force by reactions, or under one unit of them.
struct SolvedMechanism {
    Model model;
    SettledInstant instant;

    SolvedMechanism(Model of, const State& start)
        : model(std::move(of)), instant(model, most_rows(model, std::span(&start, 1)))
    {}

    /// False: joints lose rank there.
    bool react(const State& state, const std::vector<double>& angles, Side side,
               const std::vector<int>& joints, Reactions& out)
    {
        if (!instant.accelerate(state, angles, side)) return false;
        out.clear();
        for (const int j : joints) {
            if (j < 0) {   // it does not act
                out.push_back({});
                continue;
            }
            const Joint& joint = model.joints()[static_cast<std::size_t>(j)];
            const double* multiplier = instant.multipliers(side).data() + model.first_row(j);
            Matrix34 F{};
            for (const ConstraintRow& row : joint.rows)
                F -= *multiplier++ *
                     constraint_gradient(frozen(row, {state.t, side}), state.X).of(joint.second);
            out.push_back(joint_reaction(joint, state.X[static_cast<std::size_t>(joint.second)], F));
        }
        return true;
    }
};

/// One who solves: threads have one each.
class ReactionSolver {
public:
    /// `place`: near which joints hold bodies as they do elsewhere.
    ReactionSolver(const Model& model, const std::vector<ReactionLaw>& laws, const State& place)
    {
        all_.push_back(std::make_unique<SolvedMechanism>(model, place));
        for (const ReactionLaw& law : laws)
            for (Load unit : law.units) {
                Model with = model;
                while (
                    std::ranges::any_of(with.loads(), [&](const Load& one) { return one.name == unit.name; }))
                    unit.name += "'";
                with.add_load(std::move(unit));
                all_.push_back(std::make_unique<SolvedMechanism>(std::move(with), place));
            }
    }

    /// Linear in forces: a unit adds what the mechanism with it has beside the one without.
    bool respond(const State& state, const std::vector<double>& angles, Side side,
                 const std::vector<int>& joints, ReactionResponse& response)
    {
        if (!all_[0]->react(state, angles, side, joints, response.without)) return false;
        response.by_unit.resize(all_.size() - 1);
        for (std::size_t k = 1; k < all_.size(); ++k) {
            Reactions& by = response.by_unit[k - 1];
            if (!all_[k]->react(state, angles, side, joints, by)) return false;
            for (std::size_t j = 0; j < by.size(); ++j) {
                by[j].force -= response.without[j].force;
                by[j].torque -= response.without[j].torque;
            }
        }
        return true;
    }

    /// What was found last, by what.
    struct Known {
        State state{};
        std::vector<double> angles{};
        Side side{};
        bool is_solved = false;
        std::vector<double> factors{};
        Reactions reactions{};
    } known{};

private:
    std::vector<std::unique_ptr<SolvedMechanism>> all_;
};

/// A mechanism while the same joints act.
struct ReactionMechanism::Acting {
    std::vector<int> acting;   ///< joints of the whole
    Model model;
    std::vector<int> joints;   ///< that are read; -1: one that does not act
    State place{};
    bool is_unique = true;                                    ///< what is read of them
    std::vector<std::unique_ptr<ReactionSolver>> solvers{};   ///< that nobody uses
};

ReactionMechanism::ReactionMechanism(const Model& model, const std::vector<ReactionLaw>& laws)
    : model_(model), laws_(laws)
{
    for (const ReactionLaw& law : laws)
        for (const ReactionInput& input : law.reactions)
            if (std::ranges::find(joints_, input.joint) == joints_.end()) joints_.push_back(input.joint);
    for (const Load& load : model.loads()) n_angles_ += load.angles.size();
    is_partial_ = std::ranges::any_of(model.joints(), &Joint::is_partial);
}

ReactionMechanism::~ReactionMechanism() = default;

void ReactionMechanism::solve(const State& state, const std::vector<double>& angles, Side side,
                              const std::vector<LawArguments>& arguments, std::vector<double>& factors,
                              Reactions& reactions)
{
    Acting& mechanism = acting_at(state, side);
    std::unique_ptr<ReactionSolver> solver = take(mechanism);
    ReactionSolver::Known& known = solver->known;
    const bool is_known = known.side == side && known.state.t == state.t && known.state.X == state.X &&
                          known.state.V == state.V && known.angles == angles && known.is_solved;
    if (!is_known) {
        known = {state, angles, side, true};
        ReactionResponse response;
        std::size_t n = 0;
        for (const ReactionLaw& law : laws_) n += law.units.size();
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        known.factors.assign(n, none);
        known.reactions.assign(joints_.size(), {Vector3{none, none, none}, Vector3{none, none, none}});
        if (mechanism.is_unique && solver->respond(state, angles, side, mechanism.joints, response)) {
            fit(response, arguments, known.factors);
            known.reactions = response.under(known.factors);
        }
    }
    factors = known.factors;
    reactions = known.reactions;
    const std::lock_guard<std::mutex> lock(mutex_);
    mechanism.solvers.push_back(std::move(solver));
}

std::vector<double> ReactionMechanism::inputs(const ReactionLaw& law, const Reactions& reactions) const
{
    std::vector<double> numbers;
    for (const ReactionInput& input : law.reactions) {
        const auto at = std::ranges::find(joints_, input.joint) - joints_.begin();
        numbers.push_back(number_of(reactions[static_cast<std::size_t>(at)], input));
    }
    return numbers;
}

/// By the joints that act on this side of the instant.
ReactionMechanism::Acting& ReactionMechanism::acting_at(const State& state, Side side)
{
    std::vector<int> acting;
    for (std::size_t j = 0; j < model_.joints().size(); ++j) {
        const Joint& joint = model_.joints()[j];
        const bool acts =
            !is_partial_ || (side == Side::left ? joint.acts_before(state.t) : joint.acts_at(state.t));
        if (acts) acting.push_back(static_cast<int>(j));
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const std::unique_ptr<Acting>& known : mechanisms_)
        if (known->acting == acting) return *known;
    mechanisms_.push_back(std::make_unique<Acting>(mechanism_of(std::move(acting), state, side)));
    return *mechanisms_.back();
}

ReactionMechanism::Acting ReactionMechanism::mechanism_of(std::vector<int> acting, const State& state,
                                                          Side side) const
{
    constexpr double before = -std::numeric_limits<double>::infinity();
    // On the left side those joints act that did so just before.
    const double t = side == Side::left ? std::nextafter(state.t, before) : state.t;
    Acting made{std::move(acting), is_partial_ ? livens::acting_at(model_, t).model : model_, {}};
    for (const int joint : joints_) {
        const auto at = std::ranges::find(made.acting, joint);
        made.joints.push_back(at == made.acting.end() ? -1 : static_cast<int>(at - made.acting.begin()));
    }
    // The same place for all who ask, where joints can tell by it how they hold bodies.
    made.place = made.model.start();
    if (!holds(made.model, made.place)) made.place = state;
    const UniqueReactions found = unique_reactions(made.model, made.place);
    for (const int joint : made.joints)
        made.is_unique =
            made.is_unique && (joint < 0 || found.joint_is_unique[static_cast<std::size_t>(joint)]);
    return made;
}

std::unique_ptr<ReactionSolver> ReactionMechanism::take(Acting& from)
{
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (!from.solvers.empty()) {
            std::unique_ptr<ReactionSolver> one = std::move(from.solvers.back());
            from.solvers.pop_back();
            return one;
        }
    }
    return std::make_unique<ReactionSolver>(from.model, laws_, from.place);
}

std::vector<double> ReactionMechanism::asked(const ReactionResponse& response,
                                             const std::vector<LawArguments>& arguments,
                                             const std::vector<double>& factors) const
{
    const Reactions reactions = response.under(factors);
    std::vector<double> all(factors.size());
    std::size_t first = 0;
    for (std::size_t i = 0; i < laws_.size(); ++i) {
        const ReactionLaw& law = laws_[i];
        const std::size_t n = law.units.size();
        const Instant at = arguments[i].at;
        const bool acts = at.side == Side::left ? law.times.acts_before(at.t) : law.times.acts_at(at.t);
        if (n > 0 && acts) law.law(arguments[i], inputs(law, reactions), std::span(all).subspan(first, n));
        first += n;
    }
    return all;
}

/// Newton's method for f = law(r(f)), by differences: each asks laws alone.
void ReactionMechanism::fit(const ReactionResponse& response, const std::vector<LawArguments>& arguments,
                            std::vector<double>& factors) const
{
    const std::size_t n = factors.size();
    std::vector<double> now(n, 0.0);
    double before = std::numeric_limits<double>::infinity();
    for (int i = 0; i < most_steps; ++i) {
        const std::vector<double> said = asked(response, arguments, now);
        std::vector<double> rest(n);
        double far = 0, size = 0;
        for (std::size_t k = 0; k < n; ++k) {
            rest[k] = said[k] - now[k];
            far = std::max(far, std::abs(rest[k]));
            size = std::max({size, std::abs(said[k]), std::abs(now[k])});
        }
        if (!std::isfinite(far)) return;
        if (far <= 4 * std::numeric_limits<double>::epsilon() * size ||
            (far <= met * size && !(far < 0.5 * before))) {
            factors = said;
            return;
        }
        before = far;
        DenseMatrix J(static_cast<int>(n), static_cast<int>(n));
        for (std::size_t k = 0; k < n; ++k) {
            const double step = 1e-7 * std::max(size, far);
            std::vector<double> beside = now;
            beside[k] += step;
            const std::vector<double> there = asked(response, arguments, beside);
            for (std::size_t r = 0; r < n; ++r)
                J(static_cast<int>(r), static_cast<int>(k)) =
                    (r == k ? 1.0 : 0.0) - (there[r] - said[r]) / step;
        }
        const std::vector<double> step = lu_solution(J, rest).x;
        for (std::size_t k = 0; k < n; ++k) now[k] += step[k];
    }
}

}   // namespace livens::inline dynamics_internal
