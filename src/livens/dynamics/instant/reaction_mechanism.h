// SPDX-License-Identifier: BSD-3-Clause
// Who solves for the forces of loads that read reactions.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "livens/base/error.h"
#include "livens/dynamics/instant/reaction_laws.h"
#include "livens/dynamics/instant/reactions.h"
#include "livens/dynamics/instant/settled_instant.h"
#include "livens/multibody/motion.h"
#include "livens/solvers/factors.h"

namespace livens::inline dynamics_internal {

/// Force and torque of each joint that is read.
using Reactions = std::vector<Reaction>;

inline double number_of(const Reaction& reaction, const ReactionInput& input)
{
    const Vector3& v = input.is_torque ? reaction.torque : reaction.force;
    return input.component < 0 ? norm(v) : v[input.component];
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

/// Reactions for all forces by them, at an instant.
struct ReactionResponse {
    Reactions without;
    std::vector<Reactions> by_unit;   ///< what a unit adds

    Reactions under(const std::vector<double>& factors) const
    {
        Reactions all = without;
        for (std::size_t k = 0; k < factors.size(); ++k)
            for (std::size_t j = 0; j < all.size(); ++j) {
                all[j].force += factors[k] * by_unit[k][j].force;
                all[j].torque += factors[k] * by_unit[k][j].torque;
            }
        return all;
    }
};

/// One who solves: threads have one each.
class ReactionSolver {
public:
    ReactionSolver(const Model& model, const std::vector<ReactionLaw>& laws)
    {
        const State start = model.start();
        all_.push_back(std::make_unique<SolvedMechanism>(model, start));
        for (const ReactionLaw& law : laws)
            for (Load unit : law.units) {
                Model with = model;
                while (
                    std::ranges::any_of(with.loads(), [&](const Load& one) { return one.name == unit.name; }))
                    unit.name += "'";
                with.add_load(std::move(unit));
                all_.push_back(std::make_unique<SolvedMechanism>(std::move(with), start));
            }
    }

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
        std::vector<double> factors{};
        Reactions reactions{};
    } known{};

private:
    std::vector<std::unique_ptr<SolvedMechanism>> all_;
};

/// All laws, and who solves for them.
class ReactionMechanism {
public:
    ReactionMechanism(const Model& model, const std::vector<ReactionLaw>& laws) : model_(model), laws_(laws)
    {
        for (const ReactionLaw& law : laws)
            for (const ReactionInput& input : law.reactions)
                if (std::ranges::find(joints_, input.joint) == joints_.end()) joints_.push_back(input.joint);
        for (const Load& load : model.loads()) n_angles_ += load.angles.size();
        refuse_shared();
    }

    const Model& model() const { return model_; }
    const std::vector<ReactionLaw>& laws() const { return laws_; }
    std::size_t n_angles() const { return n_angles_; }

    /// Numbers of all laws, one after the other, and the reactions under them; not numbers where none fit.
    void solve(const State& state, const std::vector<double>& angles, Side side,
               const std::vector<LawArguments>& arguments, std::vector<double>& factors, Reactions& reactions)
    {
        std::unique_ptr<ReactionSolver> solver = take();
        ReactionSolver::Known& known = solver->known;
        const bool is_known = known.side == side && known.state.t == state.t && known.state.X == state.X &&
                              known.state.V == state.V && known.angles == angles && !known.factors.empty();
        if (!is_known) {
            known.state = state;
            known.angles = angles;
            known.side = side;
            ReactionResponse response;
            std::size_t n = 0;
            for (const ReactionLaw& law : laws_) n += law.units.size();
            known.factors.assign(n, std::numeric_limits<double>::quiet_NaN());
            known.reactions.assign(joints_.size(), {});
            if (solver->respond(state, angles, side, joints_, response)) {
                fit(response, arguments, known.factors);
                known.reactions = response.under(known.factors);
            }
        }
        factors = known.factors;
        reactions = known.reactions;
        const std::lock_guard<std::mutex> lock(mutex_);
        solvers_.push_back(std::move(solver));
    }

    /// Of one law.
    std::vector<double> inputs(const ReactionLaw& law, const Reactions& reactions) const
    {
        std::vector<double> numbers;
        for (const ReactionInput& input : law.reactions) {
            const auto at = std::ranges::find(joints_, input.joint) - joints_.begin();
            numbers.push_back(number_of(reactions[static_cast<std::size_t>(at)], input));
        }
        return numbers;
    }

private:
    std::unique_ptr<ReactionSolver> take()
    {
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            if (!solvers_.empty()) {
                std::unique_ptr<ReactionSolver> one = std::move(solvers_.back());
                solvers_.pop_back();
                return one;
            }
        }
        return std::make_unique<ReactionSolver>(model_, laws_);
    }

    std::vector<double> asked(const ReactionResponse& response, const std::vector<LawArguments>& arguments,
                              const std::vector<double>& factors) const
    {
        const Reactions reactions = response.under(factors);
        std::vector<double> all(factors.size());
        std::size_t first = 0;
        for (std::size_t i = 0; i < laws_.size(); ++i) {
            const std::size_t n = laws_[i].units.size();
            laws_[i].law(arguments[i], inputs(laws_[i], reactions), std::span(all).subspan(first, n));
            first += n;
        }
        return all;
    }

    /// Newton's method for f = law(r(f)), by differences: each asks laws alone.
    void fit(const ReactionResponse& response, const std::vector<LawArguments>& arguments,
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

    void refuse_shared() const
    {
        const State start = model_.start();
        const Model now = frozen(model_, {start.t});
        const std::vector<int> independent = most_rows(model_, std::span(&start, 1));
        const std::vector<double> none(static_cast<std::size_t>(now.n_rows()), 0.0);
        const UniqueReactions found = least_reactions(now, start.X, none, independent);
        for (const ReactionLaw& law : laws_)
            for (const ReactionInput& input : law.reactions) {
                const auto j = static_cast<std::size_t>(input.joint);
                const Joint& joint = model_.joints()[j];
                const std::string path = "load[" + law.name + "]";
                if (joint.is_partial() || std::ranges::any_of(model_.joints(), &Joint::is_partial))
                    throw InputError({"event-method", path,
                                      "a law reads a reaction, and joints begin or end in this motion", "",
                                      "", "what holds bodies changes with them",
                                      "let all joints act always"});
                if (found.joint_is_unique[j]) continue;
                throw InputError(
                    {"event-reaction", path,
                     "a law reads a reaction of joint '" + joint.name +
                         "' that is not unique: other joints could carry " +
                         livens::in_words(found.shared[j]),
                     "", "", "bodies are held more often than they need to be",
                     "let joints hold what they must and no more, as a spherical joint in place of "
                     "a revolute one"});
            }
    }

    static constexpr int most_steps = 60;
    static constexpr double met = 1e-12;   // of the forces

    Model model_;   // without loads by reactions
    std::vector<ReactionLaw> laws_;
    std::vector<int> joints_;
    std::size_t n_angles_ = 0;
    std::mutex mutex_;
    std::vector<std::unique_ptr<ReactionSolver>> solvers_;
};

}   // namespace livens::inline dynamics_internal
