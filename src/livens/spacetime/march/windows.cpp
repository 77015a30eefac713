// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/march/windows.h"

#include <algorithm>
#include <string>
#include <utility>

#include "livens/base/text.h"
#include "livens/diagnostics/sample.h"
#include "livens/solvers/patience.h"
#include "livens/spacetime/march/march.h"

namespace livens {

namespace {

/// Of the model's length: beyond, a motion and its guess are two motions.
constexpr double doubtful_distance = 0.05;

/// Of the duration: what a divided element is not divided below.
constexpr double shortest_element = 1e-9;

/// Where an element is divided that has a singular position at an inner node: nodes of halves might meet it
/// again.
constexpr double uneven = 0.4;

/// What a tangent may cost, in elements without one, before shorter elements are tried instead: where lengths
/// are free, where they were stated, and where shorter ones did not help so often in succession.
constexpr double costly = 10, too_costly = 500;
constexpr int most_shortened = 3;

/// Elements whose rows contradict each other before that is believed, beside one for two that were solved.
constexpr int most_contradictions = 12;

}   // namespace

March::March(Window& window, TimeMesh& mesh, const WindowOptions& options, SolveReport& report)
    : window_(window), mesh_(mesh), options_(options), report_(report),
      bends_((options.pace != nullptr ? options.pace->end() : mesh.end()) - mesh.start())
{
    bends_.expect(std::exchange(mesh.bends, {}));
    newton_options_.tolerance = options.tolerance;
    newton_options_.max_iterations = options.max_iterations;
    if (options.progress)
        newton_options_.goes_on = [this](int iterations) {
            return options_.progress({done_, n_elements(), time_, iterations, 0});
        };
}

void March::run()
{
    time_ = options_.direction > 0 ? mesh_.start() : mesh_.end();
    try {
        options_.pace != nullptr ? run_at_pace(*options_.pace) : run_mesh();
    } catch (const Stopped&) {
        set_cancelled();
    }
    window_.describe(report_);
    counts_.tolerance = options_.pace != nullptr ? 1 : options_.tolerance;
    add_notes(report_, counts_);
}

void March::run_mesh()
{
    const std::vector<int> division = divide(mesh_.n_elements(), options_.length, options_.shortest);
    const int n = static_cast<int>(division.size()) - 1;
    const int given = mesh_.n_elements();
    troubles_.most_divisions = 200 + 4 * given;
    for (int i = 0; i < n; ++i) {
        const int at = options_.direction > 0 ? i : n - 1 - i;
        const int more = options_.direction > 0 ? mesh_.n_elements() - given : 0;
        if (!solve(division[at] + more, division[at + 1] + more)) break;
    }
}

bool March::solve(int first, int last)
{
    if (!window_.open(first, last, report_)) return set_failed(first, last);
    NewtonReport outcome = attempt(first, last);
    if (outcome.status == SolveStatus::converged) {
        const int elements = end_at_bend(first, last);
        if (elements == 1) return solve(first, last);
        return elements == 2 ? solve_parts(first, last, last + 1) : accept(first, last, outcome);
    }
    if (may_divide(first, last, outcome)) {
        const int end = options_.direction > 0 ? last : first;
        const bool is_singular = window_.monitor().rank_loss() == RankLoss::at_end &&
                                 loss_of_failed(mesh_.ends[end], can_move(end)) != RankLoss::none;
        return is_singular ? solve_shorter(first) : divide_element(first, 0.5);
    }
    const int middle = (first + last) / 2;
    const bool can_split = options_.may_split && outcome.status != SolveStatus::cancelled &&
                           middle - first >= options_.shortest && last - middle >= options_.shortest;
    if (!can_split) return explain(first, last, outcome);
    ++counts_.splits;
    return solve_parts(first, middle, last);
}

bool March::solve_parts(int first, int middle, int last)
{
    if (options_.direction < 0) return solve(middle, last) && solve(first, middle);
    const int before = mesh_.n_elements();
    if (!solve(first, middle)) return false;
    const int more = mesh_.n_elements() - before;
    return solve(middle + more, last + more);
}

bool March::may_divide(int first, int last, const NewtonReport& outcome) const
{
    return options_.may_divide && report_.divided < troubles_.most_divisions && last - first == 1 &&
           may_shorten(outcome) && mesh_.length(first) > shortest_element * (mesh_.end() - mesh_.start());
}

bool March::may_shorten(const NewtonReport& outcome) const
{
    const bool is_bad_load = outcome.status == SolveStatus::not_finite && !window_.worst().bad_load.empty();
    return outcome.status != SolveStatus::cancelled && !is_bad_load;
}

bool March::divide_element(int element, double share)
{
    const double start = mesh_.ends[element], end = mesh_.ends[element + 1];
    if (share != 0.5)
        count_shift(end);
    else if (report_.divided++ == 0)
        report_.divided_at = options_.direction > 0 ? start : end;
    mesh_.ends.insert(mesh_.ends.begin() + element + 1, start + share * (end - start));
    window_.monitor().divided(element);
    return solve_parts(element, element + 1, element + 2);
}

int March::end_at_bend(int first, int last)
{
    if (!options_.ends_at_bends || options_.direction < 0 || last - first > 1) return 0;
    const double start = mesh_.ends[first], end = mesh_.ends[last];
    bends_.begin(end);
    const bool was_found = bends_.is_found(end) && last < mesh_.n_elements();
    const double wanted = bends_.end(start, was_found ? mesh_.ends[last + 1] : end);
    const bool is_long = !was_found && wanted < end;
    if (!is_long && !bends_.moves(window_, start, end)) return 0;
    if (was_found) {
        mesh_.ends[last] = bends_.found();
        return 1;
    }
    mesh_.ends.insert(mesh_.ends.begin() + last, is_long ? wanted : bends_.found());
    window_.monitor().divided(first);
    return 2;
}

NewtonReport March::attempt(int first, int last)
{
    NewtonReport outcome, best;
    outcome.status = best.status = SolveStatus::not_converged;
    int iterations = 0, n_runs = 0;
    is_march_ = is_rescued_ = false;
    const auto run = [&] {
        outcome = newton_.run(window_.equations(), newton_options_);
        if (n_runs++ == 0) best = outcome;
        iterations += outcome.iterations;
        report_.factorisations += outcome.factorisations;
    };
    const bool soon = options_.pace != nullptr && troubles_.shortened < most_shortened &&
                      is_tangent_too_costly(first, last, outcome);
    const bool is_solved = !options_.by_newton && window_.monitor().solve(newton_options_, soon, outcome);
    if (!is_solved) outcome.status = SolveStatus::not_converged;
    if (is_solved) iterations = outcome.iterations;
    if (is_solved) troubles_.shortened = 0;
    const bool is_shortened =
        !is_solved && !options_.by_newton && is_tangent_too_costly(first, last, outcome);
    if (is_shortened) ++troubles_.shortened;
    if (!is_solved && !is_shortened && window_.start_from({})) run();
    const auto goes_on = [&] {
        return !is_shortened && outcome.status != SolveStatus::converged &&
               outcome.status != SolveStatus::cancelled;
    };
    for (int i = 0; goes_on() && options_.propose; ++i) {
        const WindowOptions::Proposal proposal = options_.propose(first, last, i);
        if (!proposal.guess) break;
        if (!window_.start_from(proposal.guess)) continue;
        guess_ = proposal.guess;
        is_march_ = proposal.is_march;
        run();
        is_rescued_ = n_runs > 1 && outcome.status == SolveStatus::converged;
    }
    if (goes_on()) outcome = best;
    outcome.iterations = iterations;
    report_.newton_iterations += iterations;
    report_.most_iterations = std::max(report_.most_iterations, iterations);
    return outcome;
}

bool March::is_tangent_too_costly(int first, int last, const NewtonReport& outcome) const
{
    const double cost = window_.monitor().tangent_cost();
    if (options_.pace == nullptr) return cost > too_costly && may_divide(first, last, outcome);
    const double most = troubles_.shortened < most_shortened ? costly : too_costly;
    return cost > most && mesh_.length(first) > 1e-6 * options_.pace->end();   // else Newton says why
}

bool March::accept(int first, int last, const NewtonReport& outcome)
{
    if (is_march_) compare(first, last);
    const int end = options_.direction > 0 ? last : first;
    const bool is_single = last - first == 1;
    const Closed closed =
        close(options_.trust, !is_single || can_move(end), !is_single || may_divide(first, last, outcome));
    if (options_.ends_at_bends && closed.n_elements == 1 && is_single &&
        bends_.accepted(mesh_.ends[first], mesh_.ends[last]))
        count_bend(mesh_.ends[last]);
    if (!is_single || closed.loss == RankLoss::none) return take(first, last, closed, outcome);
    if (closed.loss == RankLoss::inside) return divide_element(first, uneven);
    return solve_shorter(first);
}

bool March::solve_shorter(int element)
{
    double& end = mesh_.ends[options_.direction > 0 ? element + 1 : element];
    count_shift(end);
    end -= options_.direction * shift * mesh_.length(element);
    return solve(element, element + 1);
}

Closed March::close(Trust trust, bool end_may_move, bool may_divide)
{
    const Closed closed = window_.close(trust, report_);
    const bool can_help = closed.loss == RankLoss::at_end ? end_may_move : may_divide;
    const bool is_wanted = can_help && troubles_.avoided < most_shifts;
    if (closed.loss == RankLoss::at_end && !end_may_move) singular_end_ = mesh_.ends.back();
    if (closed.loss == RankLoss::none || is_wanted || closed.n_elements > 0) return closed;
    trust.full_rank = false;
    return window_.close(trust, report_);
}

RankLoss March::loss_of_failed(double end, bool end_may_move)
{
    if (!end_may_move) singular_end_ = end;
    return end_may_move && troubles_.avoided < most_shifts ? RankLoss::at_end : RankLoss::none;
}

bool March::can_move(int end) const
{
    return end > 0 && end < mesh_.n_elements() &&
           !std::binary_search(mesh_.required.begin(), mesh_.required.end(), mesh_.ends[end]);
}

void March::count_bend(double t)
{
    ++counts_.bends;
    mesh_.bends.push_back(t);
}

void March::count_shift(double t)
{
    ++troubles_.avoided;
    if (report_.shifted++ == 0) report_.shifted_at = t;
}

bool March::take(int first, int last, const Closed& closed, const NewtonReport& outcome)
{
    if (closed.n_elements > 0) {
        report_.iterations.push_back(outcome.iterations);
        report_.residual_norm = std::max(report_.residual_norm, outcome.residual);
        if (is_rescued_) ++report_.rescued;
        if (outcome.ended_by_rounding) ++counts_.rounded;
        troubles_.avoided = 0;
    }
    (options_.direction > 0 ? first : last) += options_.direction * closed.n_elements;
    report_.n_elements += closed.n_elements;
    done_ += closed.n_elements;
    time_ = mesh_.ends[options_.direction > 0 ? first : last];
    if (closed.is_refused) return refuse(first, last, closed, outcome);
    if (first < last) return set_failed(first, last);
    if (options_.watch && outcome.factorisations > 0 && is_stopped_by_watch()) return false;
    const bool goes_on = !options_.progress || options_.progress({done_, n_elements(), time_,
                                                                  outcome.iterations, outcome.residual});
    if (goes_on || is_done()) return true;
    set_cancelled();
    return false;
}

void March::set_cancelled()
{
    report_.status = SolveStatus::cancelled;
    report_.failed_at = time_;
    report_.message = of_stop(time_);
}

bool March::is_stopped_by_watch()
{
    const Motion* motion = options_.direction > 0 ? window_.monitor().so_far() : nullptr;
    if (motion == nullptr) return false;
    report_.message = options_.watch(*motion, mesh_.end());
    if (report_.message.empty()) return false;
    report_.status = SolveStatus::not_converged;
    report_.failed_at = time_;
    return true;
}

bool March::is_done() const
{
    return options_.pace != nullptr ? time_ >= options_.pace->end() : done_ == mesh_.n_elements();
}

bool March::refuse(int first, int last, const Closed& closed, NewtonReport outcome)
{
    if (last - first > 1)
        return options_.direction > 0 ? solve_parts(first, first + 1, last)
                                      : solve_parts(first, last - 1, last);
    outcome.status = SolveStatus::not_converged;
    blame(closed);
    const bool is_hopeless = is_contradictory(closed);
    if (!is_hopeless && may_divide(first, last, outcome)) return divide_element(first, 0.5);
    if (!closed.contradiction.empty()) return set_contradiction(first, last, closed);
    set_failed(first, last);
    report_.status = SolveStatus::not_converged;
    report_.message = locking_in_words();
    if (report_.message.empty()) report_.message = of_lie(window_at(mesh_, first, last));
    return false;
}

void March::compare(int first, int last)
{
    for (int end = first; end <= last; ++end) {
        const double distance =
            distance_between(window_.at(end).X, guess_(mesh_.ends[end]).X, options_.length_of_model);
        if (!(distance > report_.guess_distance)) continue;
        if (report_.guess_distance <= doubtful_distance) report_.guess_distance_time = mesh_.ends[end];
        report_.guess_distance = distance;
    }
}

bool March::is_contradictory(const Closed& closed)
{
    if (!closed.contradiction.empty()) ++troubles_.contradictions;
    return troubles_.contradictions > most_contradictions + done_ / 2;
}

bool March::set_contradiction(int first, int last, const Closed& closed)
{
    report_.status = SolveStatus::singular;
    report_.message = locking_in_words();   // rows that were redundant give way there, too
    if (report_.message.empty())
        report_.message = closed.contradiction;
    else
        report_.status = SolveStatus::not_converged;
    return set_failed(first, last);
}

bool March::set_failed(int first, int last)
{
    report_.failed_at = mesh_.ends[options_.direction > 0 ? first : last];
    return false;
}

bool March::explain(int first, int last, const NewtonReport& outcome)
{
    set_failed(first, last);
    report_.status = outcome.status;
    const bool may_lock =
        outcome.status == SolveStatus::not_converged || outcome.status == SolveStatus::singular;
    report_.message = may_lock ? locking_in_words() : "";
    if (report_.message.empty())
        report_.message = of_failure(outcome, options_.max_iterations, window_at(mesh_, first, last),
                                     window_.worst(), options_.advice);
    return false;
}

std::string March::locking_in_words() const
{
    const Motion* motion = options_.locking ? window_.monitor().so_far() : nullptr;
    if (motion == nullptr || motion->n_elements() <= 0) return "";
    const int n = motion->n_elements(), start = options_.direction > 0 ? 0 : n,
              now = options_.direction > 0 ? n : element_end_at(motion->mesh, time_);
    return now == start ? "" : options_.locking(motion->at_end(start), motion->at_end(now));
}

std::vector<int> divide(int n_elements, int length, int shortest)
{
    if (length <= 0) length = n_elements;
    std::vector<int> ends;
    for (int e = 0; e < n_elements; e += length) ends.push_back(e);
    if (ends.size() > 1 && n_elements - ends.back() < shortest) ends.pop_back();
    ends.push_back(n_elements);
    return ends;
}

void solve_windows(Window& window, TimeMesh& mesh, const WindowOptions& options, SolveReport& report)
{
    March(window, mesh, options, report).run();
}

}   // namespace livens
