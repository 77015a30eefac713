// SPDX-License-Identifier: BSD-3-Clause
// The error of a motion by a second solution on the same elements.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <new>
#include <string>
#include <utility>
#include <variant>

#include "livens/base/elementary.h"
#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/diagnostics/largest.h"
#include "livens/solvers/crew.h"
#include "livens/solvers/patience.h"
#include "livens/spacetime/accuracy/accuracy.h"
#include "livens/spacetime/accuracy/reference_solution.h"
#include "livens/spacetime/ensemble.h"
#include "livens/spacetime/march/ends.h"
#include "livens/spacetime/rotating.h"
#include "livens/spacetime/solve_mesh.h"

namespace livens {

namespace {

/// Elements of a second solution that are kept in memory together.
constexpr int elements_at_once = 4096;

/// The degree whose distance from a degree p of lobatto tells the error of elements with such a velocity jump
/// J = rho^(p + 1). From degree to degree errors fall by rho^2; where rho is not small, in stairs, and those
/// of p and p + 1 may be alike (docs/theory.md, "The estimated error").
int finer_degree(int degree, double jump)
{
    constexpr double small = 0.3;   // rho
    return degree < 4 || jump <= power(small, degree + 1) ? degree + 1 : degree + 2;
}

/// The largest of these elements; infinite where laws of loads and drives may bend inside of one, of which J
/// tells nothing.
double telling_jump(const Model& model, const Motion& motion, int first, int last,
                    std::optional<double> known)
{
    if (!model.loads().empty() || model.has_drives()) return std::numeric_limits<double>::infinity();
    if (known) return *known;
    double jump = 0;
    for (const double of_element : velocity_jumps(model, motion, first, last)) raise_to(jump, of_element);
    return jump;
}

}   // namespace

ReferenceSolution::ReferenceSolution(const Model& model, const Problem& problem, const Method& method,
                                     const SolveOptions& options, const Motion& first)
    : model_(model), problem_(problem), method_(witness_of(method)), options_(options), first_(first),
      meter_(model, first), is_backwards_(problem.conditions.at_end == Known::state),
      is_lobatto_(std::holds_alternative<Lobatto>(method)), at_(is_backwards_ ? first.n_elements() : 0)
{
    const auto is_place = [](Known known) { return known == Known::positions; };
    if (is_place(problem.conditions.at_start)) meter_.has_given_place(0);
    if (is_place(problem.conditions.at_end)) meter_.has_given_place(first.n_elements());
    for (const Condition& one : problem.conditions.components)
        if (!one.quantity.is_rate() && one.at != Condition::At::both)
            meter_.has_given_place(one.at == Condition::At::start ? 0 : first.n_elements());
    problem_.guess = [&first](double t) { return first.at(t); };
    problem_.near = &first;
    problem_.fired = nullptr;
    options_.condition = options_.judge = problem_.is_determination_asked = false;
    options_.meeting = std::numeric_limits<double>::infinity();   // both meet it within their errors
    if (const auto* radau = std::get_if<Radau>(&method)) method_ = Radau{radau->degree + 1};
    if (!is_nodal(method))   // the given number is one for blocks or steps
        options_.max_iterations = SolveOptions{}.max_iterations;
}

bool ReferenceSolution::advance(int end, std::optional<double> jump)
{
    const int first = std::min(at_, end), last = std::max(at_, end);
    if (is_lobatto_)
        std::get<Lobatto>(method_).degree =
            finer_degree(first_.X.degree, telling_jump(model_, first_, first, last, jump));
    const TimeMesh mesh = mesh_between(first, last);
    const auto begin = std::chrono::steady_clock::now();
    Solution second = solve_unjudged(model_, problem_, mesh, method_, options_);
    if (second.cannot_begin)   // a state that the last piece made, not one that was given
        second.report.message += " of a piece at t = " + to_text(mesh.start(), 6) + " s";
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    report_ = std::move(second.report);
    evaluations_ += report_.evaluations;
    if (!report_.converged()) return false;
    compare_events(second, mesh.start(), first_.mesh.ends[last]);
    if (!std::isnan(differs_from_)) return false;
    numbers_ = std::move(second.numbers.values);
    // with unknown instants it has some of its own: elements are compared, not times
    if (!problem_.unknowns.is_empty() && second.motion.mesh.ends.size() == mesh.ends.size()) {
        const TimeMesh own = second.motion.mesh;
        const double stretched = (mesh.end() - mesh.start()) / (own.end() - own.start());
        for (std::size_t e = 0; e < mesh.ends.size(); ++e) {
            const bool bends = std::ranges::binary_search(own.bends, own.ends[e]);
            second.motion.mesh.ends[e] =
                bends ? mesh.start() + stretched * (own.ends[e] - own.start()) : mesh.ends[e];
        }
    }
    meter_.compare(second.motion, first, last);
    if (!is_backwards_) meter_.add(second.unseen, first, last);
    (is_backwards_ ? problem_.conditions.end : problem_.conditions.start) =
        second.motion.at_end(is_backwards_ ? 0 : second.motion.n_elements());
    options_.initial = StartPolicy::project;   // an end state holds its constraints to rounding
    at_ = end;
    return true;
}

void ReferenceSolution::tell_numbers(FoundNumbers& first) const
{
    if (numbers_.empty() || numbers_.size() != first.values.size()) return;
    first.errors.resize(numbers_.size());
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
        const double rounding = i < first.rounding.size() ? rounding_share * first.rounding[i] : 0,
                     left = i < first.left.size() ? first.left[i] : 0;   // at a bound that both come to
        first.errors[i] = std::max({std::abs(numbers_[i] - first.values[i]), rounding, left});
    }
}

namespace {

/// Where what a law did unseen in the first solution makes much of the error, the estimate has its name.
void name_law(const Solution& solution, ErrorEstimate& found)
{
    constexpr double much = 0.3;
    double most = much * found.largest;
    for (const Unseen& one : solution.unseen) {
        double kick = 0;
        for (std::size_t b = 0; b < one.shift.size(); ++b)
            raise_to(kick, std::max(one.shift[b], one.turn[b]));
        if (!raise_to(most, kick * (solution.motion.end() - one.t + one.duration))) continue;
        raise_to(found.unseen, most);
        found.unseen_load = one.load;
        found.unseen_time = one.t;
    }
}

/// A march is followed in pieces, each from the state where the last one has ended, in the direction of the
/// march; a window of all elements, and what counts turns for events, at once.
void measure_error(const Model& model, const Problem& problem, const Method& method,
                   const SolveOptions& options, Solution& solution)
{
    const int n = solution.motion.n_elements();
    const Conditions& given = problem.conditions;
    const bool is_march = given.has_state();
    // Between pieces angles are lost that events count.
    const int piece = is_march && model.events().empty() ? std::min(n, elements_at_once) : n;
    ReferenceSolution second(model, problem, method, options, solution.motion);
    second.expect(solution.events);
    solution.undecided_from = std::numeric_limits<double>::quiet_NaN();
    for (int done = piece;; done = std::min(done + piece, n)) {
        const bool is_good = second.advance(given.at_end == Known::state ? n - done : done);
        solution.estimate_seconds = second.seconds();
        if (!is_good) {
            if (!std::isnan(second.differs_from())) {
                solution.undecided_from = second.differs_from();
                solution.report.estimate_failed =
                    "a second solution has other events from " + to_text(second.differs_from(), 6) + " s on";
            } else if (second.report().status == SolveStatus::cancelled)
                solution.report.notes.push_back("stopped as asked before the error was estimated");
            else
                solution.report.estimate_failed = "the second solution failed: " + second.report().message;
            return;
        }
        if (done == n) break;
    }
    solution.estimate = second.take(n);
    solution.events = second.events();
    add_rests(model, solution.events, solution.motion, options.lowest_hop, solution.estimate);
    second.tell_numbers(solution.numbers);
    name_law(solution, solution.estimate);
    add_lost_vibrations(model, solution.motion, solution.estimate);
    add_events(model, solution.motion, solution.estimate);
}

/// E_e = E_(e-1) g_e / g_(e-1) + 20 C_p J^q + rounding, with the largest growth g that there was by then. On
/// mechanisms that did not calibrate C_p elements lose up to 35 times as much in the median.
ErrorEstimate grown_errors(const Model& model, const Solution& solution)
{
    const Motion& motion = solution.motion;
    const std::vector<double>& growth = solution.growth;
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    ErrorEstimate found;
    if (growth.size() != motion.mesh.ends.size()) return found;
    const std::vector<double> jumps = velocity_jumps(model, motion);
    found.n_bodies = model.n_bodies();
    found.length = model.length();
    double error = 0, largest = growth[0];
    std::size_t next = 0;   // of what laws did unseen
    const double time = time_of_motion(model, motion.at_end(0));
    for (std::size_t end = 0; end < growth.size(); ++end) {
        if (end > 0) {
            error *= std::max(1.0, growth[end] / largest);
            error += 20 * local_error(motion.X.points, motion.X.degree, jumps[end - 1]) + 1e-16;
            for (; next < solution.unseen.size() && solution.unseen[next].t <= motion.mesh.ends[end];
                 ++next) {
                const Unseen& one = solution.unseen[next];   // a kick goes on as long as the motion has time
                error += one.error * std::max(1.0, time / one.duration);
                if (!(one.error > found.unseen)) continue;
                found.unseen = one.error;
                found.unseen_load = one.load;
                found.unseen_time = one.t;
            }
        }
        raise_to(largest, growth[end]);
        for (const Body& body : model.bodies()) {
            found.position.push_back(error);
            found.orientation.push_back(body.is_point ? 0 : error);
            found.velocity.push_back(unknown);
        }
    }
    found.find_largest(motion.mesh);
    add_lost_vibrations(model, motion, found);
    add_events(model, motion, found);
    return found;
}

void estimate_all(const Model& model, const Problem& problem, const Method& method,
                  const SolveOptions& options, Solution& solution)
{
    const bool is_local = options.estimate == SolveOptions::Estimate::local;
    if (options.estimate == SolveOptions::Estimate::second && solution.estimate.empty())
        measure_error(model, problem, method, options, solution);
    if (!options.growth && !is_local) return;
    const auto begin = std::chrono::steady_clock::now();
    if (solution.growth.empty()) {
        Growth grown = growth(model, problem, solution.method, options, solution.motion,
                              told_without_rounding(solution.estimate));
        solution.growth = std::move(grown.factors);
        solution.growing = grown.part;
        solution.rounding = told_of_rounding(grown, options.tolerance);
        solution.rounding_in = grown.rounding_in;
    }
    if (is_local) {
        solution.estimate = grown_errors(model, solution);
        if (solution.estimate.empty())
            solution.report.estimate_failed =
                "no neighbouring motion reaches the end, so the growth of errors is not known";
    }
    if (!solution.estimate.empty())
        count_rounding(model, grown_rounding(solution.growth, solution.rounding), solution.motion.mesh,
                       solution.estimate);
    solution.estimate_seconds +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}   // namespace

void estimate(const Model& model, const Problem& stated, const Method& method, const SolveOptions& options,
              Solution& solution)
{
    if (solution.with_rotors != nullptr) {
        const WithRotors rotors(model);
        const std::shared_ptr<Solution> whole = solution.with_rotors;
        estimate(rotors.model(), with_rotors(rotors, stated), method, options, *whole);
        solution = without_rotors(rotors, whole);
        return;
    }
    const Problem problem = with_prepared(stated);
    const Crew crew(threads_for(options.threads));
    SolveReport& report = solution.report;
    if (!report.converged()) return;
    const int n = solution.motion.n_elements();
    std::function<bool()> goes_on;
    if (options.progress)
        goes_on = [&] { return options.progress({n, n, solution.motion.end(), 0, report.residual_norm}); };
    const Patience patience(goes_on);
    const std::string before = " before the error was estimated";
    try {
        estimate_all(model, problem, method, options, solution);
    } catch (const Stopped&) {
        solution.estimate = {};
        report.notes.push_back("stopped as asked" + before);
    } catch (const std::bad_alloc&) {
        solution.estimate = {};
        report.estimate_failed = "memory ended" + before;
    }
    if (!problem.conditions.has_state()) find_arrival(model, problem, options, solution);
}

}   // namespace livens
