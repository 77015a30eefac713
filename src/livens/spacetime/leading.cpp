// SPDX-License-Identifier: BSD-3-Clause
// Continuation in the conditions at one end, with a secant for a predictor (theory.md, "Finding the motion").
#include "livens/spacetime/leading.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "livens/dynamics/rows/twist.h"
#include "livens/multibody/body.h"
#include "livens/multibody/model.h"
#include "livens/solvers/patience.h"
#include "livens/spacetime/curve.h"
#include "livens/spacetime/march/components.h"
#include "livens/spacetime/march/windows.h"
#include "livens/spacetime/nodal/window.h"

namespace livens::inline spacetime_internal {

namespace {

/// Of the way: the first step, and the one below which it is given up.
constexpr double first_step = 0.25, shortest_step = 1.0 / 512;
/// Solutions, with those that failed: at most, and before this share of the way is gone.
constexpr int most_solutions = 50, soon = 20;
constexpr double share_soon = 0.2;
/// Steps on the way need not be exact, nor is a long iteration worth its price.
constexpr double tolerance_on_the_way = 1e-7;
constexpr int most_iterations = 10;

/// X moved from one configuration on, by a share of the way to another.
Matrix34 on_the_way(const Matrix34& X, const Matrix34& from, const Matrix34& to, double share)
{
    const Vector3 step = share * (to.column(0) - from.column(0));
    if (norm(directors(X)) == 0) return configuration(X.column(0) + step, Matrix3{});
    return twist::moved(X, step, share * twist::turn_between(from, to));
}

/// What two motions foretell: the last one, and `ahead` times what changed to it.
Guess secant(const Guess& before, const Guess& last, double ahead)
{
    return [=](double t) {
        State state = last(t);
        const State earlier = before(t);
        for (std::size_t b = 0; b < state.X.size(); ++b)
            state.X[b] = on_the_way(state.X[b], earlier.X[b], state.X[b], ahead);
        return state;
    };
}

class Leader {
public:
    Leader(const NumberedProblem& problem, int degree, bool from_start)
        : problem_(problem), model_(problem.model()), ends_(problem.ends()), mesh_(problem.mesh()),
          rule_(lobatto_rule(degree)), from_start_(from_start), numbers_{problem.guesses(), {}}
    {}

    Leading go(const Guess& begin, bool may_turn)
    {
        arrival_ = begin(from_start_ ? mesh_.end() : mesh_.start());
        if (ends_.has_components()) arrived_ = values_in(model_, ends_, begin, instants());
        Guess before, last = begin;
        Leading led;
        double previous = 0, step = first_step;
        while (led.share < 1 && led.steps < most_solutions && step >= shortest_step &&
               (led.steps < soon || led.share >= share_soon)) {
            Patience::ask();
            const double share = std::min(1.0, led.share + step);
            const bool has_two = static_cast<bool>(before);
            const double ahead = has_two ? (share - led.share) / (led.share - previous) : 0;
            ++led.steps;
            Guess found = solved(share, has_two ? secant(before, last, ahead) : last);
            if (!found) {
                step = 0.5 * (share - led.share);
                continue;
            }
            before = std::exchange(last, std::move(found));
            previous = std::exchange(led.share, share);
            step *= 2;
        }
        if (led.share == 1)
            led.motion = last;
        else if (may_turn && problem_.size() == 0)
            follow({last, led.share}, led);
        return led;
    }

private:
    /// Element ends and nodes between them.
    std::vector<double> instants() const
    {
        std::vector<double> all;
        for (int e = 0; e < mesh_.n_elements(); ++e)
            for (int a = 0; a < rule_.degree; ++a)
                all.push_back(mesh_.ends[e] + rule_.nodes[a] * mesh_.length(e));
        all.push_back(mesh_.end());
        return all;
    }

    /// The way turns back somewhere: along the curve of motions, which does not.
    void follow(const OnCurve& from, Leading& led)
    {
        const Followed followed =
            follow_curve(model_, mesh_, rule_.degree, from, [this](double share) { return ends_at(share); });
        led.has_followed = true;
        led.steps += followed.steps;
        led.turns = followed.turns;
        if (followed.motion) led.motion = solved(1, followed.motion);
    }

    Guess solved(double share, const Guess& guess)
    {
        const std::optional<Ends> ends = ends_at(share);
        return ends ? solved_between(*ends, guess) : Guess{};
    }

    /// Where joints close.
    /// Places that are led are moved by steps and turns, and closed; momenta and values of conditions go
    /// linearly from those of the arrival (LedEnds).
    std::optional<Ends> ends_at(double share) const
    {
        if (ends_.has_components()) {
            Ends ends = ends_;
            ends.led.values = arrived_;
            ends.led.share = share;
            return ends;
        }
        Problem problem{{ends_.start, ends_.at_start, ends_.end, ends_.at_end}};
        State& far = from_start_ ? problem.conditions.end : problem.conditions.start;
        const State stated = far;
        const bool is_place = knows_positions(from_start_ ? ends_.at_end : ends_.at_start);
        for (std::size_t b = 0; is_place && b < far.X.size(); ++b)
            far.X[b] = on_the_way(arrival_.X[b], arrival_.X[b], stated.X[b], share);
        TriedEnds tried = try_close_ends(model_, problem, mesh_.start(), mesh_.end(), StartPolicy::project);
        if (!tried.ends) return {};
        tried.ends->led.from = arrival_;
        tried.ends->led.share = is_place ? 1 : share;
        return tried.ends;
    }

    Guess solved_between(const Ends& ends, const Guess& guess)
    {
        if (problem_.size() > 0) {
            const NumberedProblem led(model_, ends, mesh_, problem_.unknowns());
            UnknownsWindow window(led, numbers_.values, nodal_windows(rule_, true), numbers_);
            return motion_of(window, guess);
        }
        const ModelTables tables(model_, ends.independent);
        NodalWindow window(tables, mesh_, ends, rule_);
        return motion_of(window, guess);
    }

    Guess motion_of(Window& window, const Guess& guess) const
    {
        WindowOptions options;
        options.length = 0;
        options.may_split = false;
        options.solve.tolerance = tolerance_on_the_way;
        options.solve.max_iterations = most_iterations;
        options.propose = [&](int, int, int attempt) {
            return attempt == 0 ? WindowOptions::Proposal{guess, false} : WindowOptions::Proposal{};
        };
        SolveReport report;
        TimeMesh mesh = mesh_;
        solve_windows(window, mesh, options, report);
        if (!report.converged()) return {};
        const auto motion = std::make_shared<Motion>(window.take_motion());
        return [motion, mesh](double t) { return motion->at(carried_to(mesh, t, motion->mesh)); };
    }

    const NumberedProblem& problem_;
    const Model& model_;
    const Ends& ends_;
    const TimeMesh& mesh_;
    ElementRule rule_;
    bool from_start_;
    State arrival_;
    std::vector<double> arrived_;   // of conditions by component
    FoundNumbers numbers_;          // of the last solution
};

}   // namespace

Leading lead(const NumberedProblem& problem, int degree, const Guess& begin, bool from_start, bool may_turn)
{
    return Leader(problem, degree, from_start).go(begin, may_turn);
}

std::string in_words(const Leading& led, const GuessFromEnds& march)
{
    std::string words = "found by an end that was led, in " + std::to_string(led.steps) +
                        " steps, from where a march from the " + (march.from_start ? "start " : "end ") +
                        march.rates + " arrives";
    if (led.turns > 0)
        words += led.turns == 1 ? ", past a fold" : ", past " + std::to_string(led.turns) + " folds";
    return words;
}

}   // namespace livens::inline spacetime_internal
