// SPDX-License-Identifier: BSD-3-Clause
// The one loop of a march. A window is opened, solved, held against bends of laws, closed as far as it is to
// be believed, and taken; for what is not accepted the partition has a remedy, and the loop goes on with what
// that left.
// docs/theory.md: "Spurious elements", "Singular positions", "Laws that bend", "To an accuracy".
#include "livens/spacetime/march/march.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "livens/base/text.h"
#include "livens/diagnostics/sample.h"
#include "livens/solvers/crew.h"
#include "livens/solvers/patience.h"

namespace livens::inline spacetime_internal {

namespace {

/// Of the model's length: beyond, a motion and its guess are two motions.
constexpr double doubtful_distance = 0.05;

/// How often in succession nodes are moved off singular positions.
constexpr int most_shifts = 3;
constexpr int least_compared = 32;   // element ends that a thread takes

/// What a tangent may cost, in elements without one, before shorter elements are tried instead: where lengths
/// are free, where they were stated, and where shorter ones did not help so often in succession.
constexpr double costly = 10, too_costly = 500;
constexpr int most_shortened = 3;
/// Of the duration: a shorter element is solved whatever it costs, and Newton's iteration says why it fails.
constexpr double short_element = 1e-6;

/// Elements like the last one for the rest of the time, if a law has kept thousands of them short.
constexpr double most_left = 1e6;

/// Elements whose rows contradict each other before that is believed, beside one for two that were solved.
constexpr int most_contradictions = 12;

/// Of the duration: how near the last closed end is to a singular one where elements vanish before it.
constexpr double near_singular = 1e-3;

/// The velocity jump of an element without a solution.
constexpr double unseen = std::numeric_limits<double>::infinity();

/// Whether a window that failed may be solved with shorter elements: a load that is not finite is the user's.
bool may_help(const NewtonReport& outcome, const Window& window)
{
    const bool is_bad_load = outcome.status == SolveStatus::not_finite && !window.worst().bad_load.empty();
    return outcome.status != SolveStatus::cancelled && !is_bad_load;
}

}   // namespace

March::March(Window& window, TimeMesh& mesh, const WindowOptions& options, SolveReport& report)
    : window_(window), mesh_(mesh), options_(options), report_(report), start_(mesh.start()),
      end_(options.controller != nullptr ? options.controller->end() : mesh.end()), events_(end_ - start_),
      partition_(options.controller != nullptr
                     ? decltype(partition_)(AdaptiveElements(mesh, *options.controller, events_))
                     : decltype(partition_)(GivenMesh(mesh, window.monitor(), options)))
{
    events_.expect(std::exchange(mesh.bends, {}));
    if (options.direction < 0) std::swap(start_, end_);
    time_ = start_;
    newton_options_.tolerance = options.solve.tolerance;
    newton_options_.max_iterations = options.solve.max_iterations;
    if (options.solve.progress)
        newton_options_.goes_on = [this](int iterations) {
            return options_.solve.progress({done_, n_elements(), time_, iterations, 0});
        };
}

Partition& March::partition()
{
    if (auto* given = std::get_if<GivenMesh>(&partition_)) return *given;
    return *std::get_if<AdaptiveElements>(&partition_);
}

void March::run()
{
    bool goes_on = true;
    try {
        while (goes_on) {
            const std::optional<Elements> next = partition().next(time_);
            if (!next) break;
            goes_on = advance(*next);
        }
        if (goes_on && time_ != end_) stop({});
    } catch (const Stopped&) {
        fail(SolveStatus::cancelled, of_stop(time_));
    }
    window_.describe(report_);
    counts_.tolerance = options_.controller != nullptr ? 1 : options_.solve.tolerance;
    counts_.has_state = options_.has_state;
    add_notes(report_, counts_);
}

/// Bends come first: an end that moves to a bend makes the solution void, so nothing is compared, closed or
/// refused before. Singular positions come next: their remedy is another than that of a refusal.
bool March::advance(const Elements& of)
{
    // the report says why a window cannot be opened, or was closed to an end that is no state to go on from
    const auto failed = [this] { return fail(report_.status, report_.message); };
    if (!window_.open(of.first, of.last, report_)) return failed();
    const NewtonReport outcome = attempt(of);
    const bool is_solved = outcome.status == SolveStatus::converged;
    if (!is_solved && of.size() > 1) return split(of, outcome);
    if (is_solved && ends_at_bend(of)) return true;
    if (is_solved && attempt_.is_march) compare(of);
    AcceptedElements closed = is_solved ? close(of) : AcceptedElements{0, true, unseen};
    if (!is_solved && partition().may_shorten(of) && may_help(outcome, window_))
        closed.loss = loss_of_failed(of);
    if (of.size() == 1 && closed.loss != RankLoss::none) {
        move_off(of, closed.loss);
        return true;
    }
    const Elements left = take(of, closed, outcome);
    if (closed.is_refused) return refuse(left, closed, outcome);
    return left.size() > 0 ? failed() : goes_on(outcome);
}

/// The window's own iteration, then Newton's from its own guess, then from one proposal after the other. If
/// all of them fail it is the first run of Newton's that is told, with the iterations of all.
NewtonReport March::attempt(const Elements& of)
{
    NewtonReport outcome, first;
    outcome.status = first.status = SolveStatus::not_converged;
    int iterations = 0, n_runs = 0;
    attempt_ = {};
    const auto run = [&] {
        outcome = newton_.run(window_.equations(), newton_options_);
        if (n_runs++ == 0) first = outcome;
        iterations += outcome.iterations;
        report_.factorisations += outcome.factorisations;
    };
    const bool soon =
        options_.controller != nullptr && troubles_.shortened < most_shortened && is_tangent_too_costly(of);
    const bool is_quick = !options_.solve.by_newton;
    if (options_.controller != nullptr) window_.monitor().hold_back(options_.controller->held_back());
    const bool is_solved = is_quick && window_.monitor().solve(newton_options_, soon, outcome);
    const bool is_left = !is_solved && is_quick && is_tangent_too_costly(of);
    if (is_solved) iterations = outcome.iterations;
    if (!is_solved) outcome.status = SolveStatus::not_converged;
    if (is_solved) troubles_.shortened = 0;
    if (is_left) ++troubles_.shortened;
    const auto goes_on = [&] {
        return !is_left && outcome.status != SolveStatus::converged &&
               outcome.status != SolveStatus::cancelled;
    };
    if (!is_solved && !is_left && window_.start_from({})) run();
    for (int i = 0; goes_on() && options_.propose; ++i) {
        const WindowOptions::Proposal proposal = options_.propose(of.first, of.last, i);
        if (!proposal.guess) break;
        if (!window_.start_from(proposal.guess)) continue;
        run();
        attempt_ = {proposal.guess, proposal.is_march,
                    n_runs > 1 && outcome.status == SolveStatus::converged};
    }
    if (goes_on()) outcome = first;
    attempt_.has_iterate = is_solved || n_runs > 0;
    outcome.iterations = iterations;
    report_.newton_iterations += iterations;
    report_.most_iterations = std::max(report_.most_iterations, iterations);
    return outcome;
}

bool March::is_tangent_too_costly(const Elements& of)
{
    const bool is_free = options_.controller != nullptr;
    if (!partition().may_shorten(of)) return false;
    if (is_free && mesh_.length(of.first) <= short_element * std::abs(end_ - start_)) return false;
    const double most = is_free && troubles_.shortened < most_shortened ? costly : too_costly;
    return window_.monitor().tangent_cost() > most;
}

bool March::ends_at_bend(const Elements& of)
{
    if (!options_.ends_at_bends || options_.direction < 0 || of.size() > 1) return false;
    const double start = mesh_.ends[of.first], end = mesh_.ends[of.last];
    events_.begin(end);
    const bool is_found = events_.is_found(end);
    const double wanted = events_.end(start, partition().wanted_end(of, is_found));
    const bool is_long = wanted < end && !(is_found && of.last < mesh_.n_elements());
    if (!is_long && !events_.moves(window_, start, end)) return false;
    partition().end_at(of, is_long ? wanted : events_.found(), is_found);
    return true;
}

/// The instant that is told is that of the largest distance, or, once one is doubtful, that of the first of
/// these.
void March::compare(const Elements& of)
{
    const auto distance_at = [&](int end) {
        return distance_between(window_.at(end).X, attempt_.guess(mesh_.ends[end]).X,
                                options_.length_of_model);
    };
    std::vector<double> distances;   // of many
    if (Crew::divides(of.size() + 1, least_compared)) {
        distances.resize(static_cast<std::size_t>(of.size() + 1));
        for_each_item(of.size() + 1, least_compared,
                      [&](int i) { distances[i] = distance_at(of.first + i); });
    }
    for (int end = of.first; end <= of.last; ++end) {
        const double distance = distances.empty() ? distance_at(end) : distances[end - of.first];
        if (!(distance > report_.guess_distance)) continue;
        if (report_.guess_distance <= doubtful_distance) report_.guess_distance_time = mesh_.ends[end];
        report_.guess_distance = distance;
    }
}

AcceptedElements March::close(const Elements& of)
{
    AcceptanceCriteria criteria = partition().criteria(of);
    AcceptedElements closed = window_.close(criteria, report_);
    if (closed.loss == RankLoss::none || closed.n_elements > 0 || of.size() > 1) return closed;
    const bool is_end = closed.loss == RankLoss::at_end, can_move = partition().may_move_end(of);
    if (is_end && !can_move) troubles_.singular_end = mesh_.ends[far(of)];
    if ((is_end ? can_move : partition().may_shorten(of)) && troubles_.avoided < most_shifts) return closed;
    criteria.full_rank = false;   // nothing can be done about it, or that did not help
    closed = window_.close(criteria, report_);
    return closed;
}

RankLoss March::loss_of_failed(const Elements& of)
{
    if (window_.monitor().rank_loss() != RankLoss::at_end) return RankLoss::none;
    const bool can_move = partition().may_move_end(of);
    if (!can_move) troubles_.singular_end = mesh_.ends[far(of)];
    return can_move && troubles_.avoided < most_shifts ? RankLoss::at_end : RankLoss::none;
}

void March::move_off(const Elements& of, RankLoss loss)
{
    ++troubles_.avoided;
    if (report_.shifted++ == 0) report_.shifted_at = mesh_.ends[far(of)];
    partition().avoid(of, loss);
}

Elements March::take(Elements of, const AcceptedElements& closed, const NewtonReport& outcome)
{
    if (closed.n_elements == 0) return of;
    report_.iterations.push_back(outcome.iterations);
    report_.residual_norm = std::max(report_.residual_norm, outcome.residual);
    if (attempt_.is_rescued) ++report_.rescued;
    if (outcome.ended_by_rounding) ++counts_.rounded;
    troubles_.avoided = 0;
    troubles_.slides.clear();
    partition().accepted(of, closed, outcome);
    const double end = mesh_.ends[far(of)];
    if (of.size() == 1 && events_.accepted(mesh_.ends[of.first], end)) {
        ++counts_.bends;
        mesh_.bends.push_back(end);
    }
    (options_.direction > 0 ? of.first : of.last) += options_.direction * closed.n_elements;
    report_.n_elements += closed.n_elements;
    done_ += closed.n_elements;
    time_ = mesh_.ends[options_.direction > 0 ? of.first : of.last];
    return of;
}

bool March::goes_on(const NewtonReport& outcome)
{
    if (options_.watch && (outcome.factorisations > 0 || outcome.took_slopes)) {
        const Motion* motion = options_.direction > 0 ? window_.monitor().so_far() : nullptr;
        const std::string why = motion != nullptr ? options_.watch(*motion, mesh_.end()) : "";
        if (!why.empty()) return fail(SolveStatus::not_converged, why);
    }
    const ProgressCallback& progress = options_.solve.progress;
    const bool is_let =
        !progress || progress({done_, n_elements(), time_, outcome.iterations, outcome.residual});
    if (!is_let && time_ != end_) return fail(SolveStatus::cancelled, of_stop(time_));
    if (options_.goes_on && !options_.goes_on()) return false;
    if (options_.fired) {
        report_.fired = options_.fired(*window_.monitor().so_far());
        if (!report_.fired.empty()) return false;
    }
    if (options_.controller == nullptr || !events_.is_stuck()) return true;
    const std::string load = options_.ends_at_bends ? window_.monitor().jumping_load() : "";
    if (!load.empty()) return fail(SolveStatus::not_converged, of_sticking(load, time_));
    const double length = mesh_.length(mesh_.n_elements() - 1);
    const bool is_endless = events_.is_crawling() && std::abs(end_ - time_) > most_left * length;
    if (!is_endless || report_.steep_load.empty()) return true;
    return fail(SolveStatus::not_converged, of_crawling(report_.steep_load, time_, length));
}

bool March::split(const Elements& of, const NewtonReport& outcome)
{
    const int middle = (of.first + of.last) / 2;
    const bool can_split = options_.may_split && outcome.status != SolveStatus::cancelled &&
                           middle - of.first >= options_.shortest && of.last - middle >= options_.shortest;
    if (!can_split) return explain(of, outcome);
    ++counts_.splits;
    partition().split(of, middle);
    return true;
}

bool March::refuse(const Elements& of, const AcceptedElements& closed, const NewtonReport& outcome)
{
    if (of.size() > 1) {   // the near one has not seen the motion: it is solved alone
        partition().split(of, options_.direction > 0 ? of.first + 1 : of.last - 1);
        return true;
    }
    troubles_.load = closed.load;
    if (outcome.status == SolveStatus::converged) troubles_.slides = closed.jumps_back ? closed.load : "";
    if (!closed.load.empty()) report_.steep_load = closed.load;
    if (!closed.contradiction.empty()) ++troubles_.contradictions;
    const bool is_contradictory = troubles_.contradictions > most_contradictions + done_ / 2;
    const bool can_help = !is_contradictory && may_help(outcome, window_);
    if (partition().reject(of, closed.velocity_jump, can_help, report_)) return true;
    if (!closed.contradiction.empty()) {   // rows that were redundant give way where a mechanism locks, too
        const std::string lock = locking_in_words();
        return lock.empty() ? fail(SolveStatus::singular, closed.contradiction)
                            : fail(SolveStatus::not_converged, lock);
    }
    if (!troubles_.slides.empty())
        return fail(SolveStatus::not_converged, of_sticking(troubles_.slides, time_));
    const bool is_singular = is_near_singular_end() && may_help(outcome, window_);
    if (outcome.status != SolveStatus::converged && !is_singular) return explain(of, outcome);
    return stop(of);
}

bool March::stop(const Elements& of)
{
    if (is_near_singular_end())
        return fail(SolveStatus::not_converged, of_singular_end(troubles_.singular_end));
    std::string message = locking_in_words();
    if (message.empty())
        message = options_.controller != nullptr ? of_vanishing(time_, troubles_.load)
                                                 : of_spurious_root(window_at(mesh_, of.first, of.last));
    return fail(SolveStatus::not_converged, message);
}

bool March::explain(const Elements& of, const NewtonReport& outcome)
{
    const bool may_lock =
        outcome.status == SolveStatus::not_converged || outcome.status == SolveStatus::singular;
    std::string message = may_lock ? locking_in_words() : "";
    if (message.empty())
        message = of_failure(outcome, options_.solve.max_iterations, window_at(mesh_, of.first, of.last),
                             window_.worst(), options_.advice);
    const bool is_finite =
        outcome.status != SolveStatus::not_finite && outcome.status != SolveStatus::cancelled;
    SolveReport ignored;
    if (options_.keeps_iterate && attempt_.has_iterate && is_finite) window_.close({}, ignored);
    return fail(outcome.status, message);
}

bool March::fail(SolveStatus status, const std::string& message)
{
    report_.status = status;
    report_.failed_at = time_;
    report_.message = message;
    return false;
}

bool March::is_near_singular_end() const
{
    return options_.controller != nullptr &&
           std::abs(time_ - troubles_.singular_end) < near_singular * std::abs(end_ - start_);
}

std::string March::locking_in_words() const
{
    const Motion* motion = options_.locking ? window_.monitor().so_far() : nullptr;
    if (motion == nullptr || motion->n_elements() <= 0) return "";
    const int n = motion->n_elements(), start = options_.direction > 0 ? 0 : n,
              now = options_.direction > 0 ? n : element_end_at(motion->mesh, time_);
    return now == start ? "" : options_.locking(motion->at_end(start), motion->at_end(now));
}

/// Of a march that finds its lengths: as many as there will be if the rest of the time goes on like what is
/// done; 0 before anything is.
int March::n_elements() const
{
    if (options_.controller == nullptr) return mesh_.n_elements();
    const double share = (time_ - start_) / (end_ - start_);
    return share > 0 ? static_cast<int>(std::lround(std::min(done_ / share, 1e9))) : 0;
}

void solve_windows(Window& window, TimeMesh& mesh, const WindowOptions& options, SolveReport& report)
{
    March(window, mesh, options, report).run();
}

}   // namespace livens::inline spacetime_internal
