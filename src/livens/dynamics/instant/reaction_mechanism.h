// SPDX-License-Identifier: BSD-3-Clause
// Who solves for the forces of loads that read reactions.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "livens/dynamics/instant/reaction_laws.h"
#include "livens/dynamics/instant/reactions.h"
#include "livens/multibody/motion.h"

namespace livens::inline dynamics_internal {

/// Force and torque of each joint that is read.
using Reactions = std::vector<Reaction>;

/// Reactions for all forces by them, at an instant.
struct ReactionResponse {
    Reactions without;
    std::vector<Reactions> by_unit;   ///< what a unit adds

    Reactions under(const std::vector<double>& factors) const;
};

/// Of a model whose joints all act, which of these joints have reactions of their own in a state, and what
/// others could carry of the rest.
UniqueReactions unique_reactions(const Model& model, const State& state);

/// One who solves; threads have one each.
class ReactionSolver;

/// All laws, and who solves for them.
class ReactionMechanism {
public:
    ReactionMechanism(const Model& model, const std::vector<ReactionLaw>& laws);
    ~ReactionMechanism();

    const Model& model() const { return model_; }
    const std::vector<ReactionLaw>& laws() const { return laws_; }
    std::size_t n_angles() const { return n_angles_; }

    /// Numbers of all laws, one after the other, and the reactions under them; not numbers where none fit.
    void solve(const State& state, const std::vector<double>& angles, Side side,
               const std::vector<LawArguments>& arguments, std::vector<double>& factors,
               Reactions& reactions);
    /// Of one law.
    std::vector<double> inputs(const ReactionLaw& law, const Reactions& reactions) const;

private:
    struct Acting;   // the mechanism while the same joints act

    Acting& acting_at(const State& state, Side side);
    Acting mechanism_of(std::vector<int> acting, const State& state, Side side) const;
    std::unique_ptr<ReactionSolver> take(Acting& from);
    std::vector<double> asked(const ReactionResponse& response, const std::vector<LawArguments>& arguments,
                              const std::vector<double>& factors) const;
    void fit(const ReactionResponse& response, const std::vector<LawArguments>& arguments,
             std::vector<double>& factors) const;

    Model model_;   // without loads by reactions
    std::vector<ReactionLaw> laws_;
    std::vector<int> joints_;
    std::size_t n_angles_ = 0;
    bool is_partial_ = false;
    std::mutex mutex_;
    std::vector<std::unique_ptr<Acting>> mechanisms_;
};

}   // namespace livens::inline dynamics_internal
