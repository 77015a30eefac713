// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/windows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "livens/base/text.h"
#include "livens/spacetime/detail/window_notes.h"

namespace livens {

namespace {

/// Of the model's length: beyond, a motion and its guess are two motions.
constexpr double doubtful_distance = 0.05;

/// Of the duration: what a divided element is not divided below.
constexpr double shortest_element = 1e-9;

/// Of an element by which its end is moved off a singular position, and where one is divided that has such a
/// position at an inner node (nodes of halves might meet it again); and how often in succession.
constexpr double shift = 0.1, uneven = 0.4;
constexpr int most_shifts = 3;

/// Iterations of an element that is about as long as it can be.
constexpr int slow = 10;

/// The velocity jump of an element without a solution.
constexpr double unseen = std::numeric_limits<double>::infinity();

class March {
public:
    March(Window& window, TimeMesh& mesh, const WindowOptions& options, SolveReport& report)
        : window_(window), mesh_(mesh), options_(options), report_(report)
    {
        newton_options_.tolerance = options.tolerance;
        newton_options_.max_iterations = options.max_iterations;
        if (options.progress)
            newton_options_.goes_on = [this](int iterations) {
                return options_.progress({done_, n_elements(), time_, iterations, 0});
            };
    }

    void run()
    {
        time_ = options_.direction > 0 ? mesh_.start() : mesh_.end();
        options_.pace != nullptr ? run_at_pace(*options_.pace) : run_mesh();
        window_.describe(report_);
        counts_.tolerance = options_.pace != nullptr ? 1 : options_.tolerance;
        add_notes(report_, counts_);
    }

private:
    /// Windows of the mesh as it is.
    void run_mesh()
    {
        const std::vector<int> division = divide(mesh_.n_elements(), options_.length, options_.shortest);
        const int n = static_cast<int>(division.size()) - 1;
        const int given = mesh_.n_elements();
        most_divisions_ = 200 + 4 * given;
        for (int i = 0; i < n; ++i) {
            const int at = options_.direction > 0 ? i : n - 1 - i;
            const int more = options_.direction > 0 ? mesh_.n_elements() - given : 0;
            if (!solve(division[at] + more, division[at + 1] + more)) break;
        }
    }

    /// One element after the other, each as long as the pace has it. An element that fails or is refused is
    /// tried again, shorter.
    void run_at_pace(Pace& pace)
    {
        while (time_ < pace.end()) {
            const double start = time_, end = pace.next_end(start), length = end - start;
            const double most = pace.largest_jump(start, end);
            mesh_.ends.push_back(end);
            const int e = mesh_.n_elements() - 1;
            if (!window_.open(e, e + 1, report_)) return void(set_failed(e, e + 1));
            const NewtonReport outcome = attempt(e, e + 1);
            Closed closed{0, outcome.status != SolveStatus::converged, unseen};
            const bool end_may_move = !pace.is_stop(end) || pace.may_leave(end);
            if (!closed.is_refused)
                closed = close({most, true, true}, end_may_move, true);
            else if (window_.rank_loss() == RankLoss::at_end)
                closed.loss = loss_of_failed(end, end_may_move);
            if (closed.loss != RankLoss::none) {
                count_shift(end);
                if (closed.loss == RankLoss::at_end) pace.leave(end);
                pace.shorten((1 - shift) * length);
                mesh_.ends.pop_back();
                continue;
            }
            if (closed.n_elements > 0) {
                pace.accepted(length, closed.velocity_jump, outcome.iterations > slow);
                if (!take(e, e + 1, closed, outcome) || (options_.goes_on && !options_.goes_on())) return;
                continue;
            }
            ++report_.refused;
            const bool can_help = closed.is_refused && may_shorten(outcome);
            if (!can_help || !pace.refused(length, closed.velocity_jump, most))
                return give_up(e, closed, outcome);
            mesh_.ends.pop_back();
        }
    }

    /// Elements have vanished, or shorter ones do not help.
    void give_up(int element, const Closed& closed, const NewtonReport& outcome)
    {
        if (!closed.is_refused) return void(set_failed(element, element + 1));   // the report says why
        const bool is_singular =
            std::abs(mesh_.ends[element] - singular_end_) < 1e-3 * (options_.pace->end() - mesh_.start());
        if (outcome.status != SolveStatus::converged && !(is_singular && may_shorten(outcome)))
            return void(explain(element, element + 1, outcome));
        set_failed(element, element + 1);
        report_.status = SolveStatus::not_converged;
        report_.message = is_singular ? of_singular_end(singular_end_) : of_vanishing(mesh_.ends[element]);
    }

    /// Elements first..last - 1, split where they fail together.
    bool solve(int first, int last)
    {
        if (!window_.open(first, last, report_)) return set_failed(first, last);
        NewtonReport outcome = attempt(first, last);
        if (outcome.status == SolveStatus::converged) return accept(first, last, outcome);
        if (may_divide(first, last, outcome)) {
            const int end = options_.direction > 0 ? last : first;
            const bool is_singular = window_.rank_loss() == RankLoss::at_end &&
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

    /// Two stretches in their order. Elements that are divided in the first one move those behind it.
    bool solve_parts(int first, int middle, int last)
    {
        if (options_.direction < 0) return solve(middle, last) && solve(first, middle);
        const int before = mesh_.n_elements();
        if (!solve(first, middle)) return false;
        const int more = mesh_.n_elements() - before;
        return solve(middle + more, last + more);
    }

    bool may_divide(int first, int last, const NewtonReport& outcome) const
    {
        return options_.may_divide && report_.divided < most_divisions_ && last - first == 1 &&
               may_shorten(outcome) && mesh_.length(first) > shortest_element * (mesh_.end() - mesh_.start());
    }

    /// Whether what failed may be for want of shorter elements.
    bool may_shorten(const NewtonReport& outcome) const
    {
        const bool is_bad_load =
            outcome.status == SolveStatus::not_finite && !window_.worst().bad_load.empty();
        return outcome.status != SolveStatus::cancelled && !is_bad_load;
    }

    bool divide_element(int element, double share)
    {
        const double start = mesh_.ends[element], end = mesh_.ends[element + 1];
        if (share != 0.5)
            count_shift(end);
        else if (report_.divided++ == 0)
            report_.divided_at = options_.direction > 0 ? start : end;
        mesh_.ends.insert(mesh_.ends.begin() + element + 1, start + share * (end - start));
        window_.divided(element);
        return solve_parts(element, element + 1, element + 2);
    }

    /// Newton's iteration from one guess after the other; all their iterations count. Where none leads to a
    /// solution, the first and best one tells why.
    NewtonReport attempt(int first, int last)
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
        const bool is_solved = !options_.by_newton && window_.solve(newton_options_, outcome);
        if (!is_solved) outcome.status = SolveStatus::not_converged;
        const bool is_divisible =   // else Newton says why
            options_.pace ? mesh_.length(first) > 1e-6 * options_.pace->end()
                          : may_divide(first, last, outcome);
        const bool is_too_large = !is_solved && !options_.by_newton && window_.is_too_large() && is_divisible;
        if (is_solved) iterations = outcome.iterations;   // too large: shorter ones cost less than a tangent
        if (!is_solved && !is_too_large && window_.predict()) run();
        const auto goes_on = [&] {
            return !is_too_large && outcome.status != SolveStatus::converged &&
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

    bool accept(int first, int last, const NewtonReport& outcome)
    {
        if (is_march_) compare(first, last);
        const int end = options_.direction > 0 ? last : first;
        const bool is_single = last - first == 1;
        const Closed closed = close(options_.trust, !is_single || can_move(end),
                                    !is_single || may_divide(first, last, outcome));
        if (!is_single || closed.loss == RankLoss::none) return take(first, last, closed, outcome);
        if (closed.loss == RankLoss::inside) return divide_element(first, uneven);
        return solve_shorter(first);
    }

    /// With its end off a singular position.
    bool solve_shorter(int element)
    {
        double& end = mesh_.ends[options_.direction > 0 ? element + 1 : element];
        count_shift(end);
        end -= options_.direction * shift * mesh_.length(element);
        return solve(element, element + 1);
    }

    /// Closes the open window up to a node too near to a singular position; beyond that where nothing can be
    /// done about it, or where that did not help.
    Closed close(Trust trust, bool end_may_move, bool may_divide)
    {
        const Closed closed = window_.close(trust, report_);
        const bool can_help = closed.loss == RankLoss::at_end ? end_may_move : may_divide;
        const bool is_wanted = can_help && avoided_ < most_shifts;
        if (closed.loss == RankLoss::at_end && !end_may_move) singular_end_ = mesh_.ends.back();
        if (closed.loss == RankLoss::none || is_wanted || closed.n_elements > 0) return closed;
        trust.full_rank = false;
        return window_.close(trust, report_);
    }

    /// Of an element that was not solved, whose end is near a singular position.
    RankLoss loss_of_failed(double end, bool end_may_move)
    {
        if (!end_may_move) singular_end_ = end;
        return end_may_move && avoided_ < most_shifts ? RankLoss::at_end : RankLoss::none;
    }

    bool can_move(int end) const
    {
        return end > 0 && end < mesh_.n_elements() &&
               !std::binary_search(mesh_.required.begin(), mesh_.required.end(), mesh_.ends[end]);
    }

    void count_shift(double t)
    {
        ++avoided_;
        if (report_.shifted++ == 0) report_.shifted_at = t;
    }

    /// Counts what was closed of the elements first..last - 1.
    bool take(int first, int last, const Closed& closed, const NewtonReport& outcome)
    {
        if (closed.n_elements > 0) {
            report_.iterations.push_back(outcome.iterations);
            report_.residual_norm = std::max(report_.residual_norm, outcome.residual);
            if (is_rescued_) ++report_.rescued;
            if (outcome.ended_by_rounding) ++counts_.rounded;
            avoided_ = 0;
        }
        (options_.direction > 0 ? first : last) += options_.direction * closed.n_elements;
        report_.n_elements += closed.n_elements;
        done_ += closed.n_elements;
        time_ = mesh_.ends[options_.direction > 0 ? first : last];
        if (closed.is_refused) return refuse(first, last, outcome);
        if (first < last) return set_failed(first, last);
        const bool goes_on = !options_.progress || options_.progress({done_, n_elements(), time_,
                                                                      outcome.iterations, outcome.residual});
        if (goes_on || is_done()) return true;
        report_.status = SolveStatus::cancelled;
        report_.failed_at = time_;
        report_.message =
            "stopped at t = " + to_text(time_, 6) + " s as asked; the motion up to there is complete";
        return false;
    }

    /// Of the mesh, or as many as it will be if it grows as it did.
    int n_elements() const
    {
        if (options_.pace == nullptr) return mesh_.n_elements();
        const double share = (time_ - mesh_.start()) / (options_.pace->end() - mesh_.start());
        return share > 0 ? static_cast<int>(std::lround(std::min(done_ / share, 1e9))) : 0;
    }

    bool is_done() const
    {
        return options_.pace != nullptr ? time_ >= options_.pace->end() : done_ == mesh_.n_elements();
    }

    /// The near one of the elements first..last - 1 has not seen the motion: it is solved alone, or divided.
    bool refuse(int first, int last, NewtonReport outcome)
    {
        if (last - first > 1)
            return options_.direction > 0 ? solve_parts(first, first + 1, last)
                                          : solve_parts(first, last - 1, last);
        outcome.status = SolveStatus::not_converged;
        if (may_divide(first, last, outcome)) return divide_element(first, 0.5);
        set_failed(first, last);
        report_.status = SolveStatus::not_converged;
        report_.message = window_at(mesh_, first, last) +
                          " meets its equations, but leaves the velocity that its momentum has, or turns a "
                          "body by more than 90 degrees between nodes; try: more and shorter elements";
        return false;
    }

    /// How far the motion has left the march from the same state, at element ends: another method's opinion
    /// of the same window, which a wrong root does not share.
    void compare(int first, int last)
    {
        for (int end = first; end <= last; ++end) {
            const std::vector<Matrix34> X = window_.positions(end);
            const State state = guess_(mesh_.ends[end]);
            double distance = 0;
            for (std::size_t b = 0; b < X.size(); ++b)
                for (int c = 0; c < 4; ++c)
                    distance = std::max(distance, norm(X[b].column(c) - state.X[b].column(c)) /
                                                      (c == 0 ? options_.length_of_model : 1));
            if (!(distance > report_.guess_distance)) continue;
            if (report_.guess_distance <= doubtful_distance) report_.guess_distance_time = mesh_.ends[end];
            report_.guess_distance = distance;
        }
    }

    bool set_failed(int first, int last)
    {
        report_.failed_at = mesh_.ends[options_.direction > 0 ? first : last];
        return false;
    }

    bool explain(int first, int last, const NewtonReport& outcome)
    {
        set_failed(first, last);
        report_.status = outcome.status;
        report_.message = outcome.status == SolveStatus::cancelled
                              ? "stopped as asked in " + window_at(mesh_, first, last) +
                                    "; the motion up to there is complete"
                              : of_failure(outcome, options_.max_iterations, window_at(mesh_, first, last),
                                           window_.worst(), options_.advice);
        return false;
    }

    Window& window_;
    TimeMesh& mesh_;
    const WindowOptions& options_;
    SolveReport& report_;
    Newton newton_;
    NewtonOptions newton_options_;
    Guess guess_;   // that the open window started from
    bool is_march_ = false;
    bool is_rescued_ = false;   // converged from another guess than the first
    WindowCounts counts_;
    int most_divisions_ = 0;   // beyond, something else is wrong
    int avoided_ = 0;          // nodes too near to a singular position, since an element was closed
    double singular_end_ = std::numeric_limits<double>::quiet_NaN();   // that can not move; the last one
    int done_ = 0;                                                     // elements
    double time_ = 0;                                                  // up to which they are solved
};

}   // namespace

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
