// SPDX-License-Identifier: BSD-3-Clause
// The family that suits a mechanism: lobatto, or radau where it is stiff.  (docs/theory.md, "Stiffness")
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "livens/base/text.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/spacetime/accuracy/accuracy.h"
#include "livens/spacetime/march/ends.h"
#include "livens/statics/frequencies.h"
#include "livens/statics/rate_bounds.h"

namespace livens::inline spacetime_internal {

namespace {

/// Times the time of the motion, or the length of an element: a decay so fast is over before anything moves,
/// while lobatto rings.
constexpr double fast_decay = 20;
/// Elements between two looks, as a share of those before; and how much larger than at the last one a decay
/// may be by its bound.
constexpr double between_looks = 0.25, unlike = 2;
constexpr int tried_after = 32;   // elements of lobatto
constexpr double gain = 0.5;      // of lobatto's work, to be worth the change
constexpr int highest_radau = 8;
/// Work by evaluations leaves tangents out, which lobatto rarely forms and radau always: by freedoms, those
/// with which they cost as much as they evaluate.
constexpr double small_tangent = 15;

class Choice {
public:
    Choice(const Model& model, const Problem& problem, const Ends& ends, const Span& span,
           const AutomaticFamily& automatic, const SolveOptions& options)
        : model_(model), problem_(problem), span_(span),
          options_(options), lobatto_{automatic.degree, 1}, radau_{std::min(automatic.degree, highest_radau)},
          ends_(ends), start_(ends_.start), freedoms_(ModelTables(model, ends_.independent).freedoms()),
          at_start_(highest_frequencies(model, start_)),
          length_(std::min(time_of_motion(model, start_), span.end - span.start))
    {
        // both families are compared by what their second solutions say and cost
        if (at_start_.fastest_vibration().rate * length_ >= fast_vibration) problem_.is_followed = true;
    }

    Solution run()
    {
        if (decays(at_start_, length_)) return by_radau({});
        Solution solution = solve_to_accuracy(model_, problem_, ends_, span_, lobatto_, options_,
                                              [this](const MarchStatus& look) { return doubts(look); });
        if (!why_.empty()) return by_radau(std::move(solution));
        const Frequency& vibration = at_start_.fastest_vibration();
        if (solution.report.status == SolveStatus::cancelled || vibration.rate * length_ < fast_vibration ||
            is_good(solution))
            return solution;
        say(vibration, "vibrates at " + to_text(vibration.rate, 3) + " rad/s, which lobatto did not follow");
        Solution other = by_radau(solution);
        return other.report.converged() && is_good(other) ? other : solution;
    }

private:
    /// Whether lobatto is to be left.
    bool doubts(const MarchStatus& look)
    {
        const int n = look.motion.n_elements();
        const double length = std::min(look.mean_length, span_.end - span_.start);
        if (n >= looks_.next && decays_at(look.motion.at_end(n), length)) return true;
        const Frequency& vibration = at_start_.fastest_vibration();
        if (is_tried_ || n < tried_after || vibration.rate * length_ < fast_vibration) return false;
        is_tried_ = true;
        const Span part{span_.start, look.motion.end(), span_.accuracy};
        const double tangents = std::max(1.0, freedoms_ * freedoms_ / (small_tangent * small_tangent));
        const double allowed = gain * static_cast<double>(look.evaluations) / tangents;
        const auto spend = [&](const MarchStatus& other) {
            return static_cast<double>(other.evaluations) > allowed;
        };
        const Solution trial = solve_to_accuracy(model_, problem_, ends_, part, radau_, options_, spend);
        if (!trial.report.converged() || static_cast<double>(trial.report.evaluations_in_all) > allowed)
            return false;
        say(vibration, "vibrates at " + to_text(vibration.rate, 3) +
                           " rad/s with less than the accuracy, which would rule the elements of lobatto");
        return true;
    }

    /// A bound, which costs far less, tells how much faster than at the last look it may be.
    bool decays_at(const State& state, double length)
    {
        const auto is_damper = [](const Load& load) { return load.depends_on_V; };
        looks_.next += static_cast<int>(std::ceil(between_looks * looks_.next));
        if (!std::ranges::any_of(model_.loads(), is_damper)) return false;
        if (!looks_.bounds) {
            looks_.bounds.emplace(model_);
            looks_.share_of_bound = at_start_.dampers.rate / looks_.bounds->dampers(start_);
        }
        const double bound = looks_.bounds->dampers(state),
                     share = std::min(unlike * looks_.share_of_bound, 1.0);
        if (!(share * bound * length > fast_decay)) return false;
        const HighestFrequencies found = highest_frequencies(model_, state);
        looks_.share_of_bound = found.dampers.rate / bound;
        return decays(found, length);
    }

    bool decays(const HighestFrequencies& at, double length)
    {
        const double rate = at.dampers.rate;
        if (!(rate * length > fast_decay)) return false;
        say(at.dampers,
            "takes motions away at " + to_text(rate, 3) + " 1/s, of which elements of lobatto ring");
        return true;
    }

    void say(const Frequency& who, const std::string& what)
    {
        why_ = "radau was taken: " + who.where(model_) + " " + what;
    }

    bool is_good(Solution& solution) const
    {
        constexpr double doubtful =
            0.01;   // of the energy: vibrations that lobatto does not follow take or give it
        if (!solution.report.converged()) return false;
        solution.measured = std::make_shared<Measured>(model_, solution.motion);
        const Verdict verdict = judge(model_, solution.motion, solution.report, solution.estimate, {}, {}, {},
                                      {}, solution.measured.get());
        return verdict.reasons.empty() && !(verdict.energy_drift > doubtful);
    }

    Solution by_radau(const Solution& before) const
    {
        Solution solution = solve_to_accuracy(model_, problem_, ends_, span_, radau_, options_);
        solution.report.notes.push_back(why_);
        solution.report.evaluations_in_all += before.report.evaluations_in_all;
        solution.estimate_seconds += before.estimate_seconds;
        return solution;
    }

    const Model& model_;
    Problem problem_;
    const Span& span_;
    const SolveOptions& options_;
    Lobatto lobatto_;
    Radau radau_;
    const Ends& ends_;
    const State& start_;
    double freedoms_;
    HighestFrequencies at_start_;
    struct Looks {
        std::optional<RateBounds> bounds{};
        double share_of_bound = 1;   // that the fastest decay had at the last one
        int next = 1;                // element end
    } looks_;
    double length_;   // of time in which the motion goes half a length
    std::string why_;
    bool is_tried_ = false;
};

}   // namespace

Solution solve_to_accuracy(const Model& model, const Problem& problem, const Ends& ends, const Span& span,
                           const AutomaticFamily& automatic, const SolveOptions& options)
{
    return Choice(model, problem, ends, span, automatic, options).run();
}

}   // namespace livens::inline spacetime_internal
