// SPDX-License-Identifier: BSD-3-Clause
// Motions that are about right, for Newton's iteration to begin with: steady flight, a march of small
// elements, or one of these bent to meet the other end (theory.md, "Newton's iteration" and "The elements of
// the paper").
#include "livens/spacetime/guess.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/diagnostics/acceptance.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/multibody/body.h"
#include "livens/multibody/model.h"
#include "livens/solvers/crew.h"
#include "livens/spacetime/march/window_notes.h"
#include "livens/spacetime/march/windows.h"
#include "livens/spacetime/nodal/window.h"

namespace livens::inline spacetime_internal {

namespace {

bool is_point(const Matrix34& X) { return norm(directors(X)) == 0; }

bool is_moving(const State& state)
{
    return std::any_of(state.V.begin(), state.V.end(), [](const Matrix34& V) { return norm(V) > 0; });
}

/// The places of one state with the velocities and spins of another.
State with_rates(State places, const State& rates)
{
    for (std::size_t b = 0; b < places.X.size(); ++b) {
        const Matrix34 &X = rates.X[b], &V = rates.V[b];
        places.V[b] = is_point(X) ? V : rate(places.X[b], V.column(0), angular_velocity(X, V));
    }
    return places;
}

/// The given motion, moved by a share of what it lacks at one end: none at `from`, all at `to.t`.
Guess bent(const Guess& motion, double from, const State& to)
{
    const State reached = motion(to.t);
    std::vector<Vector3> steps, turns;
    for (std::size_t b = 0; b < to.X.size(); ++b) {
        steps.push_back(to.X[b].column(0) - reached.X[b].column(0));
        turns.push_back(is_point(to.X[b]) ? Vector3{} : twist::turn_between(reached.X[b], to.X[b]));
    }
    const double end = to.t;
    return [=](double t) {
        State state = motion(t);
        const double share = (t - from) / (end - from);
        for (std::size_t b = 0; b < state.X.size(); ++b)
            state.X[b] = is_point(state.X[b])
                             ? configuration(state.X[b].column(0) + share * steps[b], Matrix3{})
                             : twist::moved(state.X[b], share * steps[b], share * turns[b]);
        return state;
    };
}

/// How far the momenta of two states are apart: linear ones, and by the model's length moments of momentum.
double missing_momentum(const Model& model, const State& reached, const State& known)
{
    const double length = model.length();
    double sum = 0;
    for (std::size_t b = 0; b < known.X.size(); ++b) {
        Vector3 gap[2]{};
        for (const auto& [state, sign] : {std::pair{&reached, 1.0}, {&known, -1.0}}) {
            const Matrix34 P = sign * (state->V[b] * model.bodies()[b].mass);
            gap[0] += P.column(0);
            for (int c = 1; c < 4; ++c) gap[1] += cross(state->X[b].column(c), P.column(c));
        }
        sum += norm(gap[0]) + norm(gap[1]) / length;
    }
    return sum;
}

}   // namespace

MarchGuess guess_from_state(const Model& model, const State& state, std::span<const double> times, int degree,
                            double velocity_jump)
{
    const bool is_forwards = times.back() > times.front();
    Problem problem{{state, Known::state, state, Known::nothing}};
    if (!is_forwards) std::swap(problem.conditions.at_start, problem.conditions.at_end);
    TimeMesh mesh{{times.begin(), times.end()}};
    if (!is_forwards) std::reverse(mesh.ends.begin(), mesh.ends.end());
    const TriedEnds tried = try_close_ends(model, problem, mesh.start(), mesh.end(), StartPolicy::project);
    if (!tried.ends) return {guess_steady(state), times.front(), false};
    const Ends& ends = *tried.ends;
    const ModelTables tables(model, ends.independent);
    NodalWindow window(tables, mesh, ends, lobatto_rule(degree));
    SolveReport report;
    WindowOptions options;
    options.solve.tolerance = 1e-12;
    options.direction = is_forwards ? 1 : -1;
    options.may_divide = true;
    options.criteria = {velocity_jump, true};
    solve_windows(window, mesh, options, report);
    auto march = std::make_shared<Motion>(window.take_motion());
    const double reached = march->mesh.ends.empty() ? times.front()
                           : is_forwards            ? march->end()
                                                    : march->start();
    const State begin = is_forwards ? ends.start : ends.end;
    return {[march, begin](double t) {
                if (march->n_elements() == 0) return guess_steady(begin)(t);
                // Where the march broke off the motion goes on steadily; a guess must answer for all times.
                if (t > march->end()) return guess_steady(march->at_end(march->n_elements()))(t);
                if (t < march->start()) return guess_steady(march->at_end(0))(t);
                return march->at(t);
            },
            reached};
}

Guess guess_steady(const State& state)
{
    return [state](double t) {
        State moving = state;
        moving.t = t;
        for (std::size_t b = 0; b < state.X.size(); ++b) {
            const Vector3 step = (t - state.t) * state.V[b].column(0);
            if (is_point(state.X[b])) {
                moving.X[b].set_column(0, state.X[b].column(0) + step);
                continue;
            }
            const Vector3 w = angular_velocity(state.X[b], state.V[b]);
            moving.X[b] = twist::moved(state.X[b], step, (t - state.t) * w);
            moving.V[b] = rate(moving.X[b], state.V[b].column(0), w);
        }
        return moving;
    };
}

Guess guess_between(const State& first, const State& last)
{
    State steady = first;
    const double duration = last.t - first.t;
    for (std::size_t b = 0; b < first.X.size(); ++b) {
        const Vector3 v = (1 / duration) * (last.X[b].column(0) - first.X[b].column(0));
        steady.V[b] = {};
        if (is_point(first.X[b]))
            steady.V[b].set_column(0, v);
        else
            steady.V[b] = rate(first.X[b], v, (1 / duration) * twist::turn_between(first.X[b], last.X[b]));
    }
    return guess_steady(steady);
}

namespace {

/// Of many instants every fourth and the last, with those at which loads jump: elements of a march, which
/// takes time from start to end while all else is shared among threads. Where they are too long they are
/// divided.
std::vector<double> instants_of_march(const Model& model, std::span<const double> times)
{
    constexpr std::size_t joined = 4;
    const std::vector<double> breaks = model.load_breaks();
    std::vector<double> found;
    for (std::size_t i = 0; i < times.size(); ++i)
        if (i % joined == 0 || i + 1 == times.size() || std::ranges::binary_search(breaks, times[i]))
            found.push_back(times[i]);
    return found;
}

}   // namespace

MarchGuess guess_over_many(const Model& model, const State& state, std::span<const double> times, int degree)
{
    constexpr double fine = 1e-6;   // velocity jump, of a motion that may have all of its digits
    return guess_from_state(model, state, instants_of_march(model, times), degree, fine);
}

namespace {

/// The march from a state that is complete, stated or guessed, at the near end.
Guess march_from(const Model& model, const State& near, const GuessMesh& mesh, bool from_start)
{
    std::vector<double> march(mesh.times.begin(), mesh.times.end());
    if (!from_start) std::reverse(march.begin(), march.end());
    const bool are_many = march.size() > many_instants;
    return (are_many ? guess_over_many(model, near, march, mesh.degree)
                     : guess_from_state(model, near, march, mesh.degree))
        .motion;
}

/// How far a motion misses what is known at an end, in lengths, radians, or momenta of some speed.
double missing(const Model& model, const Guess& motion, const State& known, Known given)
{
    const State reached = motion(known.t);
    if (!knows_positions(given)) return missing_momentum(model, reached, known);
    return distance_between(reached.X, known.X, model.length());
}

}   // namespace

/// One end a turn, ends that move first. Of an end at rest there may be a second march, with the rates of the
/// other end; the one that arrives nearer comes first.
std::vector<GuessFromEnds> guesses_from_ends(const Model& model, const Ends& ends, const GuessMesh& mesh,
                                             int turn)
{
    const bool has_places = knows_positions(ends.at_start) && knows_positions(ends.at_end);
    const bool is_start_first = knows_positions(ends.at_start) || !knows_positions(ends.at_end);
    const auto near_of = [&](bool from_start) -> const State& { return from_start ? ends.start : ends.end; };
    std::vector<bool> from_starts;
    for (const bool from_start : {is_start_first, !is_start_first})
        // Between places stated rates choose the way, for instance how many turns; without them the shortest.
        if (!has_places || is_moving(near_of(from_start))) from_starts.push_back(from_start);
    if (from_starts.empty() && turn == 0) return {{guess_between(ends.start, ends.end), true}};
    if (turn >= std::ssize(from_starts)) return {};
    if (!is_moving(near_of(from_starts.front())) && is_moving(near_of(from_starts.back())))
        std::reverse(from_starts.begin(), from_starts.end());

    const bool from_start = from_starts[turn];
    const State &near = near_of(from_start), &far = near_of(!from_start);
    const Known given = from_start ? ends.at_end : ends.at_start;
    std::vector<State> begins{near};
    // let go at rest, or with the rates of the far end
    if (!is_moving(near) && is_moving(far)) begins.push_back(with_rates(near, far));
    struct Candidate {
        GuessFromEnds guess;
        double off = 0;
    };
    std::vector<Candidate> found(begins.size());
    for_each_item(static_cast<int>(begins.size()), 1, [&](int i) {
        const Guess march = march_from(model, begins[i], mesh, from_start);
        found[i] = {{knows_positions(given) ? bent(march, near.t, far) : march, from_start},
                    missing(model, march, far, given)};
    });
    std::ranges::stable_sort(found, {}, &Candidate::off);
    std::vector<GuessFromEnds> guesses;
    for (const Candidate& candidate : found) guesses.push_back(candidate.guess);
    return guesses;
}

/// Sizes in equal ratios. Marches of the few that are tried are made again, or all of them would be kept.
std::vector<GuessFromEnds> nearest_marches(const Model& model, const Ends& ends, const GuessMesh& mesh)
{
    constexpr int n = 40, most = 4;   // of marches, and of those that are tried
    constexpr double smallest = 0.5, largest = 2;
    const bool from_start = knows_positions(ends.at_start) || !knows_positions(ends.at_end);
    State near = from_start ? ends.start : ends.end;
    const State& far = from_start ? ends.end : ends.start;
    const Known given = from_start ? ends.at_end : ends.at_start;
    if (!is_moving(near))
        near = with_rates(near, is_moving(far) ? far : guess_between(ends.start, ends.end)(near.t));
    if (!is_moving(near)) return {};
    struct Arrival {   // without its march: all of them would be much memory
        double factor = 1, off = 0;
    };
    const auto march_with = [&](double factor) {
        State begin = near;
        for (Matrix34& V : begin.V) V = factor * V;
        return march_from(model, begin, mesh, from_start);
    };
    std::vector<Arrival> all(n + 1);
    for_each_item(n + 1, 1, [&](int i) {
        const double factor = smallest * std::pow(largest / smallest, static_cast<double>(i) / n);
        all[i] = {factor, missing(model, march_with(factor), far, given)};
    });
    std::vector<Arrival> nearest;   // nearer than those beside them
    for (std::size_t i = 0; i < all.size(); ++i) {
        const bool is_least =
            (i == 0 || all[i].off <= all[i - 1].off) && (i + 1 == all.size() || all[i].off < all[i + 1].off);
        if (is_least) nearest.push_back(all[i]);
    }
    std::ranges::stable_sort(nearest, {}, &Arrival::off);
    std::vector<GuessFromEnds> guesses;
    for (const Arrival& one : nearest) {
        if (std::ssize(guesses) == most) break;
        const Guess march = march_with(one.factor);
        guesses.push_back(
            {knows_positions(given) ? bent(march, near.t, far) : march, from_start, to_text(one.factor, 3)});
    }
    return guesses;
}

GuessFromEnds march_to_lead(const Model& model, const Ends& ends, const GuessMesh& mesh, int attempt)
{
    struct Way {
        double factor;   // of stated rates; 0: those of steady motions
        bool is_other;   // from the other end
        const char* words;
    };
    constexpr Way ways[] = {{1, false, "with the stated rates"},
                            {1, true, "with the stated rates"},
                            {0, false, "with the rates of steady motions between the ends"},
                            {0.7, false, "with 0.7 of the stated rates"},
                            {1.3, false, "with 1.3 of the stated rates"},
                            {0.4, false, "with 0.4 of the stated rates"},
                            {1.6, false, "with 1.6 of the stated rates"}};
    const bool is_start_first = is_moving(ends.start) || !is_moving(ends.end);
    for (; attempt < static_cast<int>(std::size(ways)); ++attempt) {
        const Way& way = ways[attempt];
        const bool from_start = is_start_first != way.is_other;
        State near = from_start ? ends.start : ends.end;
        if (!is_moving(near) && way.factor != 0 && attempt > 0) continue;
        if (way.factor == 0) near = with_rates(near, guess_between(ends.start, ends.end)(near.t));
        for (Matrix34& V : near.V)
            if (way.factor > 0) V = way.factor * V;
        return {march_from(model, near, mesh, from_start), from_start, way.words, attempt + 1};
    }
    return {};
}

}   // namespace livens::inline spacetime_internal
