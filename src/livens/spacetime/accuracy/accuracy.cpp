// SPDX-License-Identifier: BSD-3-Clause
// A motion as accurate as is asked for: elements found while marching, judged by the second solution.
#include "livens/spacetime/accuracy/accuracy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "livens/base/elementary.h"
#include "livens/base/text.h"
#include "livens/dynamics/start/prepared.h"
#include "livens/multibody/body.h"
#include "livens/multibody/model.h"
#include "livens/spacetime/accuracy/measured_growth.h"
#include "livens/spacetime/accuracy/reference_solution.h"
#include "livens/spacetime/accuracy/until_accurate.h"
#include "livens/spacetime/march/window_notes.h"
#include "livens/spacetime/nodal/window.h"
#include "livens/spacetime/solve_mesh.h"

namespace livens::inline spacetime_internal {

namespace {

// Measured on 436 cases of twelve problems (docs/theory.md, "To an accuracy").
constexpr double first_share = 2e-3;   // of the accuracy: what the elements of the first try lose
constexpr double hopeless = 30;        // times the accuracy: where a try is broken off, but for the first
// Where that is broken off, as soon as it is in vain, its error would have grown to the end as this power of
// time, by no more than so much.
constexpr double growth_in_time = 4, most_growth_in_time = 1e3;
constexpr int most_tries = 6;
constexpr double finest = 1e-22;   // that an element can be asked to lose
// Rounding of an element grows with its degree, and elements of half the length add less of it.
constexpr int quiet_degree = 9;
constexpr int preferred_radau = 5, high_radau = 8;
constexpr double fine_accuracy = 1e-8;   // below, rounding counts
constexpr double all_digits = 1e-15;     // of the iteration
// Times the time of the motion: the longest element that would see something of what is to come, for the
// first try, which may begin at rest.
constexpr double seen_by = 2;
constexpr int looked_at = 5;                              // elements that tell whether they fit between stops
constexpr int least_first_piece = 16, least_piece = 48;   // elements that the second solution solves together

const int& degree_of(const Method& method)
{
    if (const auto* radau = std::get_if<Radau>(&method)) return radau->degree;
    return std::get<Lobatto>(method).degree;
}
int& degree_of(Method& method) { return const_cast<int&>(degree_of(std::as_const(method))); }

/// What the iteration leaves in an element grows like rounding does, and would be the larger of the two.
/// Elements of the high degree are few, so that it counts only where a try was not enough: or elements would
/// be shortened in vain.
SolveOptions with_tolerance_for(double accuracy, int tries, SolveOptions options)
{
    if (accuracy <= fine_accuracy && (tries > 1 || accuracy >= high_accuracy))
        options.tolerance = std::min(options.tolerance, all_digits);
    return options;
}

/// Output times at which nothing jumps.
std::vector<double> samples_of(const Model& model, const Span& span)
{
    std::vector<double> samples = span.output;
    std::ranges::sort(samples);
    const std::vector<double> breaks = model.load_breaks();
    std::erase_if(samples, [&](double t) { return std::ranges::binary_search(breaks, t); });
    return samples;
}

/// What the last march over the time is, beside its motion.
struct Try {
    bool is_broken_off = false;   // the error became hopeless
    bool fits_badly = false;      // the degree is too high for the stops; nothing else counts then
    std::optional<StepSizeController> controller{};   // what was learnt of lengths
};

/// What shorter elements brought.
struct Tries {
    double least = infinite;     // error
    double in_vain = 0;          // largest error of those below
    bool helps = true;           // that the last one had shorter elements
    bool is_first = true;        // none was judged so far
    bool is_once_good = false;   // the last one, perhaps by chance

    void count(double error, bool is_broken_off)
    {
        helps = is_broken_off || error < well_helped * least;
        if (!helps) in_vain = std::max(in_vain, error);
        if (!is_broken_off) least = std::min(least, error);
    }
};

/// Of a degree that is not stated.
struct DegreeSearch {
    bool is_free = false;   // it has not been lowered yet
    int highest = 0;        // that is tried
};

class ToAccuracy final : public RepeatedMarch {
public:
    ToAccuracy(const Model& model, const Problem& problem, const Ends& ends, const Span& span,
               const Method& method, const SolveOptions& options, const StopPredicate& is_enough)
        : model_(model), problem_(problem), span_(span),
          options_(with_tolerance_for(span.accuracy, 1, options)), is_enough_(is_enough), ends_(ends),
          tables_(model, ends_.independent, false, problem.prepared->pattern(model)),
          stops_(stops_of(model, span)), method_(method), search_{degree_of(method) == 0},
          tolerance_(first_share * span.accuracy),
          length_(span.first_length > 0
                      ? std::min(span.first_length, span.end - span.start)
                      : std::min(0.01 * (span.end - span.start), time_of_motion(model, ends_.start)))
    {
        const bool is_high = span.accuracy < high_accuracy;
        if (search_.is_free && std::holds_alternative<Radau>(method_))
            degree_of(method_) = is_high ? high_radau : preferred_radau;
        else if (search_.is_free)
            degree_of(method_) = is_high ? high_degree : preferred_degree;
        if (search_.is_free) search_.highest = degree_of(method_);
    }

    Solution solve() override
    {
        last_ = {};
        return march(last_);
    }

    AfterTry judge(Solution& solution, int tries) override
    {
        SolveReport& report = solution.report;
        if (last_.fits_badly) {
            degree_of(method_) = fitting_degree(*last_.controller);
            search_.is_free = false;
            return AfterTry::uncounted;
        }
        report.tries = tries;
        if (!report.converged() || (!problem_.is_followed && solution.estimate.empty()))
            return AfterTry::accept;
        if (!last_.is_broken_off && look_at_rounding(solution, tries)) {
            if (grown_.least_rounding() > span_.accuracy || options_.tolerance <= all_digits)
                return give_up(solution);
            options_.tolerance = all_digits;   // what the iteration leaves is the most of it
            return AfterTry::again;
        }
        const double error = solution.estimate.largest;
        const bool is_good = !last_.is_broken_off && error <= span_.accuracy;
        if (is_good && (so_far_.is_once_good || !may_be_chance())) return AfterTry::accept;
        if (!is_good) so_far_.count(error, last_.is_broken_off);
        if (!is_good && (tries >= most_tries || tolerance_ <= finest)) return give_up(solution);
        so_far_.is_once_good = is_good;
        if (!is_good) tolerance_ *= last_.controller->lost(solution.motion.mesh);
        aim_at(error / span_.accuracy * left_out(solution.motion), is_good);
        so_far_.is_first = false;
        options_ = with_tolerance_for(span_.accuracy, tries + 1, std::move(options_));
        return AfterTry::again;
    }

    std::string why_not(const Solution& solution) const override
    {
        const SolveReport& report = solution.report;
        const std::string tries = "try " + std::to_string(report.tries);
        if (grown_.rounding() > span_.accuracy)
            return tries + "; rounding errors grow to " + to_text(grown_.rounding(), 3) + ", most in " +
                   grown_.in_words(model_);
        return tries + in_vain(report);
    }

private:
    /// What the error would have grown by from where the try was broken off.
    double left_out(const Motion& motion) const
    {
        if (!last_.is_broken_off) return 1;
        if (!so_far_.is_first) return 3;
        const double times = (span_.end - span_.start) / (motion.end() - motion.start());
        return std::min(most_growth_in_time, power(times, growth_in_time));
    }

    /// What elements of the next try may lose, their degree and first length, by how many times this one was
    /// off more than it may be.
    void aim_at(double over, bool is_good)
    {
        const double share = over > 0 ? power(target / over, 1 + 0.5 / degree_of(method_)) : blind_share;
        tolerance_ *= std::min(0.3, share);
        if (!so_far_.helps && is_noisy()) {
            search_.highest = degree_of(method_) = quiet_degree;
            tolerance_ *= power(0.5, 2 * quiet_degree + 1);
        }
        if (!is_good) tolerance_ = std::max(finest, tolerance_);   // good once more has to be on another mesh
        // a degree that was too high for the stops may not be too high for shorter elements
        if (!search_.is_free && search_.highest > 0) degree_of(method_) = fitting_degree(*last_.controller);
        length_ = std::min(length_, last_.controller->mean_length(degree_of(method_), tolerance_));
    }

    Solution march(Try& one) const
    {
        Solution solution;
        SolveReport& report = solution.report;
        TimeMesh mesh{{span_.start}};
        NodalWindow window(tables_, mesh, ends_, rule_of(method_));
        if (!options_.look_at_laws) window.ignore_laws();
        ReferenceSolution second(model_, problem_, method_, options_, *window.monitor().so_far());
        StepSizeController controller(points(), degree_of(method_), tolerance_, length_, stops_);
        controller.sample_at(samples_of(model_, span_), span_.accuracy);
        WindowOptions w = window_options(model_, options_);
        w.controller = &controller;
        w.fired = problem_.fired;
        int reached = 0;   // by the second solution, or where it would be
        w.goes_on = [&] {
            const int n = mesh.n_elements();
            if (search_.is_free && n == looked_at) {
                one.fits_badly = fitting_degree(controller) < degree_of(method_);
                if (one.fits_badly) return false;
            }
            if (n % 256 == 0 &&
                static_cast<double>(window.monitor().so_far()->n_bytes()) > options_.most_bytes)
                return say_too_long(mesh, report);
            const int piece = reached == 0 ? least_first_piece : std::max(least_piece, reached / 4);
            const bool is_piece = n - reached >= piece;
            if (!is_piece && n != looked_at) return true;
            window.describe(report);
            const MarchStatus look{*window.monitor().so_far(), controller.mean_length(),
                                   report.evaluations + second.evaluations()};
            if (is_enough_ && is_enough_(look)) {
                report.status = SolveStatus::cancelled;
                return false;
            }
            if (!is_piece) return true;
            reached = n;
            if (!problem_.is_followed) return true;
            one.is_broken_off = !second.advance(n, controller.take_jump()) || is_hopeless(second);
            return !one.is_broken_off;
        };
        report.notes = ends_.notes;
        solve_windows(window, mesh, w, report);
        one.controller = std::move(controller);
        finish(solution, one, second, *window.monitor().so_far());
        solution.unseen = window.monitor().take_unseen();
        solution.motion = window.take_motion();
        solution.method = method_;
        if (report.converged() && !one.is_broken_off && !solution.estimate.empty()) {
            add_lost_vibrations(model_, solution.motion, solution.estimate);
            add_inside(model_, solution.motion, one.controller->left(), solution.estimate);
        }
        return solution;
    }

    /// The rest of the second solution, and what it says. Where that was stopped it may be far behind.
    void finish(Solution& solution, Try& one, ReferenceSolution& second, const Motion& so_far) const
    {
        const int n = so_far.n_elements();
        SolveReport& report = solution.report;
        const SolveReport& of_second = second.report();
        // states inside of elements are judged by nobody else
        const bool is_followed = problem_.is_followed || !one.controller->left().empty();
        const bool is_wanted =
            is_followed && !one.fits_badly && n > 0 && report.status != SolveStatus::cancelled;
        if (is_wanted && second.reached() < n && of_second.converged() &&
            !second.advance(n, one.controller->take_jump()))
            one.is_broken_off = true;
        report.evaluations_in_all = report.evaluations + second.evaluations();
        solution.estimate_seconds = second.seconds();
        if (of_second.status == SolveStatus::cancelled) {
            report.status = SolveStatus::cancelled;
            report.failed_at = so_far.end();
            report.message = of_stop(so_far.end());
        } else if (!of_second.converged()) {
            report.estimate_failed = "the second solution failed: " + of_second.message;
        }
        if (second.reached() > 0) solution.estimate = second.take(n);
    }

    bool say_too_long(const TimeMesh& mesh, SolveReport& report) const
    {
        report.status = SolveStatus::not_converged;
        report.failed_at = mesh.end();
        report.message = "the motion takes more memory than it may (" +
                         to_text(options_.most_bytes / 1e9, 3) + " GB) by t = " + to_text(mesh.end(), 6) +
                         " s, with elements of " + to_text(mesh.length(mesh.n_elements() - 1), 3) +
                         " s; try: an earlier end of time, a larger error in accuracy, or the family radau "
                         "if a stiff spring or a light body vibrates";
        return false;
    }

    bool is_hopeless(const ReferenceSolution& second) const
    {
        return !(second.so_far().largest <= (so_far_.is_first ? 1 : hopeless) * span_.accuracy);
    }

    Points points() const { return std::holds_alternative<Radau>(method_) ? Points::radau : Points::lobatto; }
    bool is_fine() const { return span_.accuracy < fine_accuracy; }
    /// Another degree may have less rounding.
    bool is_noisy() const
    {
        return is_fine() && search_.is_free && search_.highest != quiet_degree &&
               std::holds_alternative<Lobatto>(method_);
    }
    /// Solutions that differ by rounding alone come near each other by chance, and of many tries one would be
    /// believed: it has to happen twice.
    bool may_be_chance() const { return is_fine() && so_far_.in_vain > far_off * span_.accuracy; }

    /// The highest whose elements are not much longer than the time between stops, by what was learnt.
    int fitting_degree(const StepSizeController& controller) const
    {
        int degree = search_.highest;
        if (!controller.tells_length() && !model_.load_breaks().empty())
            return degree;   // calm before what comes
        const bool begins_unseen =
            so_far_.is_first && tables_.freedoms() > 0;   // drives are told as they are
        const double tolerance = aimed_lower * tolerance_,
                     longest = begins_unseen ? seen_by * time_of_motion(model_, ends_.start) : infinite;
        const auto length = [&](int p) {
            const double share = power(velocity_jump_of(points(), p, tolerance), 1.0 / (p + 1));
            return std::min(controller.mean_length(p, tolerance), longest * share);
        };
        while (degree > lowest_degree && length(degree) > fit * controller.mean_stop()) --degree;
        return degree;
    }

    /// True if no mesh can be as accurate, because rounding grows to more. Asked where a try came to the end.
    bool look_at_rounding(Solution& solution, int tries)
    {
        const bool is_good = solution.estimate.largest <= span_.accuracy;
        if (!options_.growth || !(is_good || (tries > 1 && !grown_.is_asked()))) return false;
        grown_.tell(model_, problem_, options_, span_.accuracy, solution);
        return grown_.rounding() > span_.accuracy;
    }

    /// Why ever shorter elements were not enough.
    std::string in_vain(const SolveReport& report) const
    {
        const std::string tried = ", with ever shorter elements";
        if (so_far_.helps && tolerance_ > finest) return tried;
        const std::string vain = tried + ", which help no more: ";
        if (!report.steep_load.empty())
            return vain + "the law of load '" + report.steep_load + "' changes too fast inside them";
        const bool is_smooth = model_.loads().empty() && !model_.has_drives();
        if (!is_smooth && !is_fine()) return vain + "a law may bend or jump inside them";
        const std::string left =
            vain + "rounding is left" + (is_smooth ? "" : ", or a law bends inside them");
        if (!grown_.is_asked()) return left;
        return left + "; errors of the start grow by " + to_text(grown_.largest(), 3) + ", most in " +
               grown_.in_words(model_);
    }

    AfterTry give_up(Solution& last)
    {
        if (options_.growth && last.growth.empty())
            grown_.tell(model_, problem_, options_, span_.accuracy, last);
        return AfterTry::give_up;
    }

    const Model& model_;
    const Problem& problem_;
    const Span& span_;
    SolveOptions options_;
    const StopPredicate& is_enough_;
    const Ends& ends_;
    ModelTables tables_;
    std::vector<double> stops_;
    Method method_;
    DegreeSearch search_;
    double tolerance_, length_;
    MeasuredGrowth grown_;
    Tries so_far_;
    Try last_;
};

}   // namespace

std::vector<double> stops_of(const Model& model, const Span& span)
{
    std::vector<double> required = model.load_breaks();
    required.insert(required.end(), span.output.begin(), span.output.end());
    return make_time_mesh(span.start, span.end, 1, required).ends;
}

double time_of_motion(const Model& model, const State& state)
{
    const double length = model.length();
    double rate = std::sqrt(norm(model.gravity()) / length);
    for (std::size_t b = 0; b < state.V.size(); ++b) {
        if (model.bodies()[b].holds_states()) continue;
        const Matrix34& V = state.V[b];
        rate = std::max({rate, norm(V.column(0)) / length, norm(directors(V))});
    }
    return 0.5 / rate;
}

Solution solve_to_accuracy(const Model& model, const Problem& problem, const Ends& ends, const Span& span,
                           const Method& method, const SolveOptions& options, const StopPredicate& is_enough)
{
    if (const auto* automatic = std::get_if<AutomaticFamily>(&method))
        return solve_to_accuracy(model, problem, ends, span, *automatic, options);
    ToAccuracy march(model, problem, ends, span, method, options, is_enough);
    return until_accurate(march, model, span.accuracy, span.end);
}

}   // namespace livens::inline spacetime_internal
