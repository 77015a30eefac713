// SPDX-License-Identifier: BSD-3-Clause
// A motion between both ends of time as accurate as is asked for: all its elements are solved together, and
// again with others until the second solution is near enough. (docs/theory.md, "An accuracy between both
// ends")
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "livens/base/text.h"
#include "livens/diagnostics/acceptance.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/dynamics/start/prepared.h"
#include "livens/spacetime/accuracy/accuracy.h"
#include "livens/spacetime/accuracy/reference_solution.h"
#include "livens/spacetime/accuracy/remeshing.h"
#include "livens/spacetime/accuracy/settled_bends.h"
#include "livens/spacetime/accuracy/until_accurate.h"
#include "livens/spacetime/found.h"
#include "livens/spacetime/march/step_size_controller.h"
#include "livens/spacetime/solve_mesh.h"

namespace livens::inline spacetime_internal {

namespace {

constexpr double first_length = 1;   // of an element, in times of the motion
constexpr int most_first = 10000;    // elements
constexpr int most_searches = 3;     // meshes on which a motion is looked for, each twice as fine
constexpr int most_meshes = 10;
constexpr int most_in_vain = 2;         // tries that did not help
constexpr int most_lost = 3;            // tries that did not find the motion of the one before
constexpr double telling = 1e-2;        // errors that are larger say no more than that elements are too long
constexpr double most_response = 100;   // an error by what elements lose together
constexpr double wasteful = 1.5;        // times the elements that are needed
constexpr double nothing = 1e-4;        // of the error: what elements lose together does not make it
constexpr double coarsened_share = 2e-3;   // of the accuracy: what longer elements may lose together
constexpr double near_rounding = 10;   // times what rounding makes of the motion: errors that may be no more

/// Times that the motion has between the ends, each as long as something takes to move or turn by half a
/// length or half a radian: at the mean of the rates there, or by steady motions from one to the other.
double times_of_motion(const Model& model, const Ends& ends)
{
    State steady = ends.start;
    const double duration = ends.end.t - ends.start.t;
    for (std::size_t b = 0; b < steady.X.size(); ++b)
        steady.V[b] = (1 / duration) * (ends.end.X[b] - ends.start.X[b]);
    const auto rate = [&](const State& state) { return 1 / time_of_motion(model, state); };
    return duration * std::max(0.5 * (rate(ends.start) + rate(ends.end)), rate(steady));
}

/// What is asked for, with unknown numbers as they were guessed or found by what was solved last.
struct Asked {
    std::shared_ptr<const Stated> asked_;      // of the next try
    std::shared_ptr<const Stated> found_of_;   // of the motion that was found last, with its numbers
    Lobatto lobatto_;
    SolveOptions options_;
    bool is_degree_free_;

    const Model& model() const { return *found_of_->model; }
    const Span& span() const { return found_of_->span; }
    double duration() const { return span().end - span().start; }
};

/// What tries so far have come to.
struct Tried {
    std::optional<Solution> found_;
    std::vector<std::string> told_;
    std::string why_;
    int n_in_vain_ = 0, n_lost_ = 0;
    double least_ = infinite, in_vain_ = 0;   // errors
    bool is_once_good_ = false, is_coarsened_ = false;
};

class BetweenEnds final : public RepeatedMarch, private Asked, private Tried {
public:
    BetweenEnds(const std::shared_ptr<const Stated>& stated, const Lobatto& lobatto,
                const SolveOptions& options)
        : Asked{stated, stated, lobatto, options, lobatto.degree == 0}, stops_(stops_of(model(), span())),
          gap_(nearest_ends * duration())
    {
        options_.meeting = std::max(options_.meeting, span().accuracy);
        if (is_degree_free_)
            lobatto_.degree = span().accuracy < high_accuracy ? high_degree : preferred_degree;
        const double times = times_of_motion(model(), stated->ends), wanted = times / first_length;
        rate_ = times / duration();
        begin_with(static_cast<int>(std::ceil(std::clamp(wanted, 1.0, 1.0 * most_first))));
        const double p_f = lobatto_.degree * ModelTables(model(), stated->ends.independent).freedoms();
        bytes_ = 8 * (4 * p_f * p_f + 24 * lobatto_.degree * (12 * model().n_bodies() + model().n_rows()));
    }

    Solution solve() override
    {
        Problem problem = asked_->problem;
        if (found_) {
            problem.guess = [this](double t) { return found_->motion.at(t); };
            problem.is_only_guess = true;
        }
        Solution solution = solve_mesh(*asked_->model, problem, mesh_, asked_->ends, lobatto_, options_);
        solution.report.evaluations_in_all = solution.report.evaluations;
        SettledBends settled = settle_bends(asked_, mesh_, lobatto_, options_, std::move(solution));
        solution = std::move(settled.solution);
        is_bent_ = !settled.is_settled;
        bends_ = solution.motion.mesh.bends;
        if (!solution.report.converged()) return solution;
        if (auto found = stated_with(asked_, solution.numbers, options_.initial))
            found_of_ = std::move(found);
        else
            solution.report.status = SolveStatus::not_converged;
        if (solution.report.converged()) estimate(solution);
        return solution;
    }

    AfterTry judge(Solution& solution, int tries) override
    {
        SolveReport& report = solution.report;
        report.tries = tries;
        if (report.status == SolveStatus::cancelled) return AfterTry::accept;
        if (!report.converged() && found_) return lost(solution, tries);
        if (!found_ && !is_seen(solution) && search_on(tries)) return AfterTry::again;
        if (!report.converged()) return AfterTry::accept;
        const double error = error_of(solution);
        // both solutions would miss a bend inside of an element alike
        const bool is_off = is_bent_ || misses_outputs(solution.motion);
        stops_ = stops_of(model(), span());
        const bool is_good = has_stops_ && !is_off && error <= span().accuracy;
        const bool is_believed = is_once_good_ || in_vain_ <= far_off * span().accuracy;
        is_once_good_ = is_good;
        if (has_stops_ && !is_off && !is_good && error < telling) count(error);
        return next(solution, tries, is_good && is_believed);
    }

    std::string why_not(const Solution& solution) const override
    {
        return "try " + std::to_string(solution.report.tries) + ", with " +
               std::to_string(solution.motion.n_elements()) + " elements" + why_;
    }
    std::string error_in_words(const Model& model, const Solution& solution) const override
    {
        const NumberError worst = of_numbers(solution);
        if (!(worst.largest > solution.estimate.largest))
            return RepeatedMarch::error_in_words(model, solution);
        return "the error of the unknown '" + worst.name + "' is about " + to_text(worst.largest, 3) +
               " of its size";
    }
    bool is_march() const override { return false; }

private:
    /// Elements of equal length between jumps of loads. Output times can wait.
    void begin_with(int n)
    {
        n_first_ = n;
        const Span& time = asked_->span;
        has_stops_ = time.output.empty();
        mesh_ = make_time_mesh(time.start, time.end, n, asked_->model->load_breaks());
    }

    void estimate(Solution& solution) const
    {
        Problem problem = found_of_->problem;
        problem.is_only_guess = true;
        const int n = solution.motion.n_elements();
        ReferenceSolution second(model(), problem, lobatto_, options_, solution.motion);
        const bool is_good = second.advance(n);
        solution.report.evaluations_in_all += second.evaluations();
        solution.estimate_seconds = second.seconds();
        if (is_good) {
            solution.estimate = second.take(n);
            second.tell_numbers(solution.numbers);
            const double rounding = rounding_share * solution.report.moved_by_rounding;
            add_events(model(), solution.motion, solution.estimate);
            count_rounding(model(), std::vector<double>(solution.motion.mesh.ends.size(), rounding),
                           solution.motion.mesh, solution.estimate);
        } else if (second.report().status == SolveStatus::cancelled) {
            solution.report.status = SolveStatus::cancelled;
            solution.report.failed_at = solution.motion.end();
            solution.report.message = "stopped as asked before the error was estimated";
        } else {
            solution.report.estimate_failed = "the second solution failed: " + second.report().message;
        }
    }

    NumberError of_numbers(const Solution& solution) const
    {
        return error_of_numbers(found_of_->problem.unknowns, solution.numbers);
    }

    /// Two solutions may agree by chance to less.
    double rounded(const Solution& solution) const
    {
        return rounding_share * std::max(solution.report.moved_by_rounding, of_numbers(solution).rounding);
    }

    /// Of the motion, or of a number by its size.
    double error_of(const Solution& solution) const
    {
        const double error = solution.estimate.empty() ? infinite : solution.estimate.largest;
        return std::isnan(error) ? infinite : std::max(error, of_numbers(solution).largest);
    }

    /// Whether elements end beside output times, since the time that was found is not the one of the try
    /// before.
    bool misses_outputs(const Motion& motion) const
    {
        if (asked_->problem.unknowns.is_empty() || !has_stops_) return false;
        return std::ranges::any_of(span().output, [&](double t) {
            const int e = motion.mesh.element_at(t);
            return std::min(t - motion.mesh.ends[e], motion.mesh.ends[e + 1] - t) >
                   std::max(span().accuracy / rate_, gap_);
        });
    }

    void count(double error)
    {
        const bool has_helped = error < well_helped * least_;
        n_in_vain_ = has_helped ? 0 : n_in_vain_ + 1;
        if (!has_helped) in_vain_ = std::max(in_vain_, error);
        least_ = std::min(least_, error);
    }

    /// Whether there is a motion that its elements have seen.
    bool is_seen(const Solution& solution) const
    {
        return solution.report.converged() &&
               velocity_jump(model(), solution.motion).largest <= acceptable_velocity_jump;
    }

    /// Elements that are too long may have no solution that is near one of the motion's.
    bool search_on(int tries)
    {
        if (tries >= most_searches || n_first_ >= most_first) return false;
        begin_with(2 * n_first_);
        return true;
    }

    /// The motion of an earlier try is all that there is.
    AfterTry lost(Solution& solution, int tries)
    {
        if (tries < most_meshes && ++n_lost_ < most_lost) {
            mesh_ = halved(mesh_);
            return AfterTry::again;
        }
        why_ = ": on " + std::to_string(mesh_.n_elements()) + " elements Newton's iteration does not find it";
        take_best(solution);
        return AfterTry::give_up;
    }

    AfterTry give_up(Solution& solution, const std::string& why)
    {
        why_ = why;
        take_best(solution);
        return AfterTry::give_up;
    }

    void take_best(Solution& solution)
    {
        if (found_ && (!solution.report.converged() || error_of(*found_) < error_of(solution))) {
            found_->report.evaluations_in_all = solution.report.evaluations_in_all;
            found_->estimate_seconds = solution.estimate_seconds;
            solution = std::move(*found_);
        }
        tell(solution);
    }

    /// How the motion was found is a matter of the first try.
    void tell(Solution& solution) const
    {
        for (const std::string& note : told_)
            if (std::ranges::find(solution.report.notes, note) == solution.report.notes.end())
                solution.report.notes.push_back(note);
    }

    AfterTry next(Solution& solution, int tries, bool is_enough)
    {
        const double error = error_of(solution);
        if (!found_) told_ = solution.report.notes;
        const ElementScales scales(model(), solution.motion, solution.unseen);
        const int n = solution.motion.n_elements();
        const double lost = aimed(scales.mean_error() * n, error) / n;
        if (is_enough) return accept(solution, scales, lost);
        if (rounded(solution) > span().accuracy && error <= near_rounding * rounded(solution))
            return give_up(solution, in_vain(solution));
        if (n_in_vain_ >= most_in_vain || !(lost > 0)) return give_up(solution, in_vain(solution));
        if (tries >= most_meshes) return give_up(solution, ", and as many tries before it");
        if (is_degree_free_ && !found_) choose_degree(scales, lost);
        TimeMesh mesh = is_bent_ ? halved(solution.motion.mesh) : mesh_of(scales, lost);
        if (mesh.n_elements() * bytes_ > options_.most_bytes)
            return give_up(solution, "; the " + std::to_string(mesh.n_elements()) +
                                         " of the next one take more memory than they may");
        return go_on(std::move(mesh), solution);
    }

    /// A mesh on which a motion was looked for may have many times the elements that it needs.
    AfterTry accept(Solution& solution, const ElementScales& scales, double lost)
    {
        if (!found_) {
            TimeMesh mesh = mesh_of(scales, lost);
            if (solution.motion.n_elements() > wasteful * mesh.n_elements())
                return go_on(std::move(mesh), solution);
        }
        tell(solution);
        return AfterTry::accept;
    }

    AfterTry go_on(TimeMesh mesh, Solution& solution)
    {
        mesh_ = std::move(mesh);
        has_stops_ = has_stops_ || !is_bent_;   // else they are those of the try before, in halves
        Stated next = *found_of_;
        next.problem.unknowns.held = held_outputs(next, error_of(solution));
        asked_ = std::make_shared<const Stated>(std::move(next));
        found_ = std::move(solution);
        return AfterTry::again;
    }

    TimeMesh mesh_of(const ElementScales& scales, double lost) const
    {
        std::vector<double> stops = stops_;
        stops.insert(stops.end(), bends_.begin(), bends_.end());
        std::ranges::sort(stops);
        return {scales.ends(lobatto_.degree, lost, stops), {stops_.begin() + 1, stops_.end() - 1}, bends_};
    }

    /// What elements of the next try shall lose together. 0: they do not lose what is missing.
    double aimed(double lost, double error)
    {
        if (error >= telling) return blind_share * lost;
        if (error > span().accuracy && lost < nothing * error) {
            // rounding adds up from element to element: longer ones have less of it, if they see enough
            return std::exchange(is_coarsened_, true) ? 0 : coarsened_share * span().accuracy;
        }
        const double ratio = target * span().accuracy / error;
        if (error > span().accuracy) return lost * std::min(std::pow(ratio, 1 + 0.5 / lobatto_.degree), 0.3);
        return target * span().accuracy / std::clamp(error / lost, 1.0, most_response);
    }

    /// The highest whose elements are not much longer than the time between stops.
    void choose_degree(const ElementScales& scales, double error)
    {
        const double stop = duration() / static_cast<double>(stops_.size() - 1);
        int& degree = lobatto_.degree;
        while (degree > lowest_degree && scales.mean_length(degree, aimed_lower * error) > fit * stop)
            --degree;
    }

    std::string in_vain(const Solution& solution) const
    {
        const LargestError& found = solution.estimate;
        std::string text = "; more of them help no more: ";
        if (rounded(solution) > span().accuracy) {
            const bool is_motion = rounding_share * solution.report.moved_by_rounding == rounded(solution);
            text += "rounding may move " + std::string(is_motion ? "the motion" : "an unknown number") +
                    " by " + to_text(rounded(solution) / rounding_share, 3) +
                    (is_motion ? "" : " of its size");
        } else if (found.unseen_load >= 0)
            text += "the law of load '" + model().loads()[static_cast<std::size_t>(found.unseen_load)].name +
                    "' changes too fast inside them";
        else
            text += model().loads().empty() && !model().has_drives()
                        ? "rounding is left"
                        : "rounding is left, or a law bends or jumps inside them";
        return text;
    }

    std::vector<double> stops_, bends_;   // where elements of the next try end, and where they do for laws
    bool is_bent_ = false;                // a law bends inside of elements
    int n_first_ = 0;
    double bytes_ = 0;         // an element
    double gap_;               // instants that are closer are one
    double rate_ = 0;          // of the motion, 1/s
    TimeMesh mesh_;            // of the next try
    bool has_stops_ = false;   // it ends elements at all of them
};

}   // namespace

Solution solve_between_ends(const Model& model, const Problem& problem, const Ends& ends, const Span& span,
                            const Method& method, const SolveOptions& options)
{
    const auto* automatic = std::get_if<AutomaticFamily>(&method);
    const Lobatto lobatto = automatic != nullptr ? Lobatto{automatic->degree} : std::get<Lobatto>(method);
    const std::shared_ptr<const Model> own(std::shared_ptr<const Model>(), &model);
    BetweenEnds tries(std::make_shared<const Stated>(Stated{own, problem, ends, span}), lobatto, options);
    return until_accurate(tries, model, span.accuracy, span.end);
}

}   // namespace livens::inline spacetime_internal
