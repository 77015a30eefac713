// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/proposals.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "livens/spacetime/elements/rule.h"
#include "livens/spacetime/guess_of_components.h"
#include "livens/spacetime/leading.h"

namespace livens::inline spacetime_internal {

namespace {

/// Past folds: each may cost some hundred factorisations.
constexpr int most_curves = 3;

/// Instants in the direction of solution: the ends of elements first..last - 1, each divided into `pieces`.
std::vector<double> instants(const TimeMesh& mesh, const Ends& ends, int first, int last, int pieces)
{
    std::vector<double> times;
    for (int e = first; e < last; ++e)
        for (int i = 0; i < pieces; ++i) times.push_back(mesh.ends[e] + mesh.length(e) * i / pieces);
    times.push_back(mesh.ends[last]);
    if (ends.is_backwards()) std::reverse(times.begin(), times.end());
    return times;
}

}   // namespace

Proposals::Proposals(const Problem& problem, const NumberedProblem& numbered, const Method& method,
                     const Window& window, PlannedPhases* phases)
    : model_(numbered.model()), problem_(problem), numbered_(numbered), ends_(numbered.ends()),
      method_(method), window_(window), phases_(phases)
{}

WindowOptions::Proposal Proposals::operator()(int first, int last, int attempt)
{
    if (phases_ != nullptr) return {phases_->guess(), false};
    if (!ends_.has_state()) return {between_ends(), false};
    const State state = window_.at(ends_.is_backwards() ? last : first);
    const auto* mixed = std::get_if<Mixed>(&method_);
    if (mixed != nullptr && (attempt > 0 || mixed->first_guess == Mixed::FirstGuess::steady))
        return {attempt > 0 ? Guess{} : guess_steady(state), false};
    if (attempt > 2 || (mixed == nullptr && last - first == 1)) return {};
    // Each attempt marches with elements a quarter as long as the one before.
    const std::vector<double> times = instants(numbered_.mesh(), ends_, first, last, 1 << (2 * attempt));
    const bool are_many = mixed == nullptr && attempt == 0 && times.size() > many_instants;
    MarchGuess march = are_many ? guess_over_many(model_, state, times, degree())
                                : guess_from_state(model_, state, times, mixed ? mixed->witness().degree : 2);
    return {std::move(march.motion), march.is_closed};
}

/// Plain guesses first, then ends that are led: theory.md, "Finding the motion". What was proposed before
/// is not proposed again.
Guess Proposals::between_ends()
{
    const int attempt = n_plain_++;
    if (attempt == 0 && problem_.guess) return problem_.guess;
    if (problem_.is_only_guess) return {};
    if (plain_.empty() && problem_.guess) plain_.push_back({});   // tried before
    if (attempt == static_cast<int>(plain_.size()))
        for (GuessFromEnds& one : guesses_from_ends(model_, guessed_ends(), guess_mesh(), turn_++))
            plain_.push_back(std::move(one));
    const int n_plain = static_cast<int>(plain_.size());
    if (attempt < n_plain) return plain_[attempt].motion;
    if (!nearest_) nearest_ = nearest_marches(model_, guessed_ends(), guess_mesh());
    if (attempt < n_plain + static_cast<int>(nearest_->size())) {
        told_ = "found from the stated or steady rates times " + (*nearest_)[attempt - n_plain].rates +
                ", with which a march arrives nearest";
        return (*nearest_)[attempt - n_plain].motion;
    }
    while (true) {
        const GuessFromEnds march = march_to_lead(model_, guessed_ends(), guess_mesh(), lead_);
        if (!march.motion) break;
        lead_ = march.next;
        const Leading led =
            lead(numbered_, degree(), march.motion, march.from_start, n_curves_ < most_curves);
        n_curves_ += led.has_followed ? 1 : 0;
        if (!led.motion) continue;
        told_ = in_words(led, march);
        return led.motion;
    }
    return {};
}

int Proposals::degree() const
{
    const auto* mixed = std::get_if<Mixed>(&method_);
    return mixed != nullptr ? mixed->witness().degree : rule_of(method_).degree;
}

const Ends& Proposals::guessed_ends()
{
    if (!ends_.has_components()) return ends_;
    if (!guessed_) guessed_ = ends_for_guesses(model_, ends_, numbered_.mesh().ends);
    return *guessed_;
}

}   // namespace livens::inline spacetime_internal
