// SPDX-License-Identifier: BSD-3-Clause
// The one table of single numbers of a run: files, JSON, reports and the page of results are made from it.
// One more figure is a row here and one in docs/results.md.
#include "livens/io/results/figures.h"

#include <cmath>
#include <limits>

#include "livens/io/json.h"

namespace livens {

namespace {

constexpr Figure figures[] = {
    {"elements", "1", "time elements solved", &SolveReport::n_elements},
    {"unknowns", "1", "unknowns in one window of elements", &SolveReport::unknowns},
    {"newton_iterations", "1", "Newton iterations over all windows and first guesses",
     &SolveReport::newton_iterations},
    {"most_iterations", "1", "most Newton iterations in one window", &SolveReport::most_iterations},
    {"factorisations", "1", "factorisations of the tangent matrix of a window", &SolveReport::factorisations},
    {"guess_factorisations", "1", "factorisations of the smaller matrices used for first guesses",
     &SolveReport::guess_factorisations},
    {"rescued", "1", "windows that converged only from a second first guess", &SolveReport::rescued},
    {"divided", "1", "elements that were too long and were divided in two", &SolveReport::divided, false, 1},
    {"divided_at", "s", "time at which the first of them begins", &SolveReport::divided_at, false, 1},
    {"accuracy", "1", "accuracy asked for; 0: none", &SolveReport::accuracy, false, 2},
    {"tries", "1", "motions solved until the accuracy was reached", &SolveReport::tries, false, 2},
    {"refused", "1", "elements rejected for the accuracy and solved again with a shorter length",
     &SolveReport::rejected, false, 2},
    {"evaluations", "1", "evaluations of the equations at a node of an element, in the final motion",
     &SolveReport::evaluations, false, 2},
    {"evaluations_in_all", "1", "likewise over all tries and their second solutions, with an accuracy",
     &SolveReport::evaluations_in_all, false, 2},
    {"residual_norm", "1", "largest scaled residual when Newton's iteration stopped",
     &SolveReport::residual_norm},
    {"smallest_pivot", "1",
     "smallest pivot of the scaled constraint Jacobian; below 1e-6 the constraints nearly lose rank",
     &SolveReport::smallest_pivot},
    {"failed_at", "s", "time at which the failed window begins", &SolveReport::failed_at},
    {"condition_1", "1",
     "condition number in the 1-norm (mixed: last block; lobatto: all elements, reduced; radau: last "
     "element); 0: not computed",
     &SolveReport::condition_1, true},
    {"condition_2", "1", "likewise in the 2-norm", &SolveReport::condition_2, true},
    {"scaled_condition", "1", "likewise in the 1-norm, of the matrix as scaled for factorisation",
     &SolveReport::scaled_condition, true},
    {"factor_entries", "1", "stored entries of the sparse factors of a window; 0: dense",
     &SolveReport::factor_entries},
    {"guess_distance", "1",
     "largest distance from the solution used as first guess, in model lengths; 0: none",
     &SolveReport::guess_distance},
    {"guess_distance_time", "s", "time at which it first exceeds 0.05, else at which it is largest",
     &SolveReport::guess_distance_time},
    {"arrival", "s",
     "between both ends: by how many m a rate that is off by 1 m/s at the start moves the motion at its end, "
     "at most (rad times the model length likewise); 0: not known",
     &SolveReport::arrival, true, 5},
    {"max_constraint_violation", "1",
     "largest constraint error at nodes, each row relative to its scale; rigidity included",
     &Verdict::max_constraint_violation},
    {"max_velocity_violation", "1/s", "largest error of the time derivatives of constraints at element ends",
     &Verdict::max_velocity_violation},
    {"max_weak_violation", "1", "for constraints that hold weakly: largest mean over an element; else 0",
     &Verdict::max_weak_violation},
    {"energy_drift", "1",
     "largest abs(energy - start - work), relative to kinetic energy or change of potential; radau: its rise",
     &Verdict::energy_drift},
    {"linear_momentum_drift", "1",
     "largest error of the balance, relative to the largest sum of abs(p) or impulse",
     &Verdict::linear_momentum_drift},
    {"angular_momentum_drift", "1",
     "largest error of the balance, relative to the largest sum of abs(x) abs(P)",
     &Verdict::angular_momentum_drift},
    {"zigzag_positions", "1", "alternation of velocities from node to node: 0 smooth, 1 pure zig-zag",
     &Verdict::zigzag_positions},
    {"zigzag_momenta", "1", "likewise of momenta", &Verdict::zigzag_momenta},
    {"zigzag_time", "s", "time at which the larger of both is largest", &Verdict::zigzag_time},
    {"velocity_jump", "1",
     "largest h abs(V - dX/dt) at element ends (radau: element starts), in model lengths",
     &Verdict::velocity_jump},
    {"velocity_jump_time", "s", "end of the element in which it is largest", &Verdict::velocity_jump_time},
    {"estimated_error", "1", "largest estimated error over bodies and element ends, in model lengths or rad",
     &Verdict::estimated_error, false, 1},
    {"estimated_digits", "1", "-log10 of the estimated error", &Verdict::estimated_digits, false, 1},
    {"estimated_error_time", "s", "time at which it is largest", &Verdict::estimated_error_time, false, 1},
    {"good_digits", "1", "digits to which all positions and orientations are right up to good_until",
     &Verdict::good_digits, false, 2},
    {"good_until", "s", "element end for which good_digits times the elapsed time is largest",
     &Verdict::good_until, false, 2},
    {"model_length", "m", "model length, to which estimated position errors are relative",
     &ErrorEstimate::length, false, 2},
    {"largest_reaction", "N", "largest reaction, to which estimated reaction errors are relative",
     &ErrorEstimate::largest_reaction, false, 2},
    {"growth", "1",
     "largest factor by which a small change of the initial state grows, in model lengths and rad",
     &Verdict::growth, false, 2},
    {"horizon", "s",
     "time at which an initial error of 1e-13, where rounding can make one, has grown to 1e-2: later, the "
     "motion can no longer be predicted; nan if that is after the end or was not measured",
     &Verdict::horizon, false, 2},
    {"largest_kinetic_energy", "J", "largest over element ends and instants between",
     &BalanceFigures::largest_kinetic},
    {"largest_momentum", "kg m/s", "largest sum of abs(p) over element ends",
     &BalanceFigures::largest_momentum},
    {"largest_moment_of_momentum", "kg m2/s", "largest sum over columns of abs(x) abs(P) over element ends",
     &BalanceFigures::largest_moment},
    {"reference_energy", "J", "largest sum of abs(F) (abs(x) + length), plus the largest potential energy",
     &BalanceFigures::reference_energy},
    {"reference_impulse", "N s", "integral of the sum of abs(F), with contributions of stiffness",
     &BalanceFigures::reference_impulse},
    {"reference_moment", "N m s", "integral of the same terms times (abs(x) + length)",
     &BalanceFigures::reference_moment},
    {"n_bodies", "1", "number of bodies", &Motion::n_bodies},
    {"n_rows", "1", "number of scalar constraints of the joints", &Motion::n_rows},
    {"order_at_element_ends", "1", "order of accuracy of positions and momenta at element ends",
     &Motion::order_at_ends},
    {"dense_order_of_X", "1", "order of accuracy of positions between nodes", &Motion::dense_order_X},
    {"dense_order_of_V", "1", "order of accuracy of velocities between nodes", &Motion::dense_order_V},
    {"gauss_points", "1", "Gauss points per element; 0: the method uses its nodes", &Motion::gauss_points},
};

/// What is no figure came with 4.
constexpr int newest = [] {
    int minor = 4;
    for (const Figure& figure : figures) minor = figure.since > minor ? figure.since : minor;
    return minor;
}();

/// The part of a run that has such members.
template <class Owner, class AnyRun>
auto& part(AnyRun& run)
{
    if constexpr (std::is_same_v<Owner, SolveReport>)
        return run.report;
    else if constexpr (std::is_same_v<Owner, Verdict>)
        return run.verdict;
    else if constexpr (std::is_same_v<Owner, BalanceFigures>)
        return run.verdict.balance;
    else if constexpr (std::is_same_v<Owner, ErrorEstimate>)
        return run.estimate;
    else
        return run.motion;
}

/// Calls `work` with the number itself.
template <class AnyRun, class Work>
auto with_number(AnyRun& run, const Figure& figure, Work work)
{
    return std::visit(
        [&]<class Number, class Owner>(Number Owner::*member) { return work(part<Owner>(run).*member); },
        figure.member);
}

}   // namespace

const int format_minor = newest;

std::span<const Figure> io_internal::run_figures() { return figures; }

double io_internal::figure_of(const Run& run, const Figure& figure)
{
    return with_number(run, figure, [](const auto& number) { return static_cast<double>(number); });
}

bool io_internal::is_whole(const Figure& figure)
{
    return std::visit([]<class Number, class Owner>(Number Owner::*) { return std::is_integral_v<Number>; },
                      figure.member);
}

bool io_internal::set_figure(Run& run, const Figure& figure, double value)
{
    return with_number(run, figure, [value]<class Number>(Number& number) {
        // Doubles hold whole numbers exactly up to 2^53; a file that says more is damaged.
        if constexpr (std::is_integral_v<Number>) {
            constexpr double limit = sizeof(Number) == sizeof(int) ? std::numeric_limits<int>::max() : 0x1p53;
            if (!(std::abs(value) <= limit) || value != std::floor(value)) return false;
        }
        number = static_cast<Number>(value);
        return true;
    });
}

void write_figures(JsonWriter& json, const Run& run)
{
    for (const Figure& figure : figures) {
        const double value = figure_of(run, figure);
        json.key(figure.name);
        if (figure.zero_is_none && value == 0)
            json.null();
        else if (is_whole(figure))
            json.value(static_cast<long long>(value));
        else
            json.value(value);
    }
}

void write_events(JsonWriter& json, const Run& run)
{
    if (run.events.names.empty()) return;
    json.key("events").begin_array();
    const RunEvents& all = run.events;
    for (std::size_t k = 0; k < all.names.size(); ++k) {
        json.begin_object();
        json.member("name", all.names[k]).member("t", all.times[k]).member("error", all.errors[k]);
        if (all.speeds[k] > 0) json.member("impulse", all.impulses[k]).member("speed", all.speeds[k]);
        if (!std::isnan(all.rests[k])) json.member("rests_at", all.rests[k]);
        json.end_object();
    }
    json.end_array();
}

void write_found_errors(JsonWriter& json, const Run& run)
{
    const RunNumbers& numbers = run.numbers;
    if (numbers.names.empty()) return;
    json.key("found_errors").begin_object();
    for (std::size_t i = 0; i < numbers.names.size(); ++i)
        json.member(numbers.names[i], i < numbers.errors.size() ? numbers.errors[i] : std::nan(""));
    json.end_object();
}

}   // namespace livens
