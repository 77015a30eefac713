// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/march/window_notes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/base/text.h"
#include "livens/dynamics/start/locking.h"

namespace livens::inline spacetime_internal {

namespace {

/// Below, a tolerance that rounding did not let be met deserves a word; down to here it asks for all digits
/// that there are, as an accuracy of many digits does.
constexpr double finest_tolerance = 1e-15;

/// "joints 'A', 'B' and 'C'"
std::string named(const std::string& kind, const std::vector<std::string>& names)
{
    std::string text = kind + (names.size() == 1 ? " " : "s ");
    for (std::size_t i = 0; i < names.size(); ++i)
        text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
    return text;
}

/// That tell the ends of an interval apart, and how long it is to a tenth or so.
int digits_apart(double start, double end)
{
    const double share = std::abs(end - start) / std::max(std::abs(start), std::abs(end));
    return static_cast<int>(std::clamp(2 - std::floor(std::log10(share)), 6.0, 17.0));
}

}   // namespace

double distance_between(std::span<const Matrix34> X, std::span<const Matrix34> others, double length)
{
    double distance = 0;
    for (std::size_t b = 0; b < X.size(); ++b)
        for (int c = 0; c < 4; ++c)
            distance = std::max(distance, norm(X[b].column(c) - others[b].column(c)) / (c == 0 ? length : 1));
    return distance;
}

std::string count(int n, const char* what) { return std::to_string(n) + " " + what + (n == 1 ? "" : "s"); }

std::string window_at(const TimeMesh& mesh, int first, int last)
{
    const std::string name = last - first == 1 ? "element " + std::to_string(first)
                                               : "the window of elements " + std::to_string(first) + " to " +
                                                     std::to_string(last - 1);
    const double start = mesh.ends[first], end = mesh.ends[last];
    const int digits = digits_apart(start, end);
    return name + " (t = " + to_text(start, digits) + " to " + to_text(end, digits) + " s)";
}

std::string of_failure(const NewtonReport& outcome, int max_iterations, const std::string& window,
                       const WorstResidual& worst, std::string advice)
{
    if (outcome.status == SolveStatus::cancelled)
        return "stopped as asked in " + window + "; the motion up to there is complete";
    std::string what = "Newton's method stalled after " + count(outcome.iterations, "iteration");
    std::string fitting = "more and shorter elements, or a lower degree";
    if (outcome.iterations == 0) what = "Newton's method stalled from every initial guess";
    if (outcome.reached_limit)   // of one attempt; there may have been several
        what =
            "Newton's iteration did not converge in " + count(max_iterations, "iteration") + ", the limit,";
    if (outcome.status == SolveStatus::singular) {
        what = "the tangent is singular";
        fitting = "the mechanism may pass a singular position; shift the element ends or use more elements";
    } else if (outcome.status == SolveStatus::not_finite) {
        what = worst.bad_load.empty() ? "a number became infinite or undefined" : worst.bad_load;
        fitting = "look at the loads near that time; use more elements";
    } else if (!worst.bad_load.empty()) {
        what += " since " + worst.bad_load;
        fitting = "look at the loads near that time; use more elements";
    }
    if (advice.empty()) advice = std::move(fitting);
    const std::string where =
        worst.name.empty() ? "" : "; worst: " + worst.name + " near t = " + to_text(worst.t, 6) + " s";
    return what + " in " + window + where + "; try: " + advice;
}

std::string of_spurious_root(const std::string& window)
{
    return window + " meets its equations, but leaves the velocity that its momentum has, or turns a body by "
                    "more than "
                    "90 degrees between nodes; try: more and shorter elements";
}

std::string of_stop(double t)
{
    return "stopped at t = " + to_text(t, 6) + " s as asked; the motion up to there is complete";
}

std::string of_vanishing(double t, const std::string& load)
{
    if (!load.empty())
        return "the elements vanish near t = " + to_text(t, 6) + " s: the law of load '" + load +
               "' changes there within the shortest of them, or jumps; try: a less steep law, a "
               "larger error in accuracy, or an earlier end";
    return "the elements vanish near t = " + to_text(t, 6) +
           " s: the error is too large however short they are; try: a larger error in accuracy, an "
           "earlier end (none is shorter than a billionth of the whole time), or look for a load that jumps "
           "there";
}

std::string of_sticking(const std::string& load, double t)
{
    return "sliding mode near t = " + to_text(t, 6) + " s at a discontinuity of load '" + load +
           "', as in ideal dry friction: the law drives the motion back from either side, and has no force "
           "in between; try: a smooth law, such as tanh(w/0.001) for the sign of w";
}

std::string of_crawling(const std::string& load, double t, double length)
{
    return "the elements stay as short as " + to_text(length, 2) + " s near t = " + to_text(t, 6) +
           " s, thousands of them: the law of load '" + load +
           "' changes within any longer one, as friction v/|v| does where bodies come to rest; try: a law "
           "that is smooth there, such as v/sqrt(v^2 + 0.001^2)";
}

std::string of_another_period(double period, double off, double t)
{
    return "the motion comes back after " + to_text(period, 6) +
           " s and does not repeat itself: one period later it is elsewhere by " + to_text(off, 3) +
           " (in model lengths or rad) near t = " + to_text(t, 4) +
           " s, since what drives it has another period; try: a multiple of that period";
}

std::string of_singular_end(double t)
{
    return "the joints lose rank at t = " + to_text(t, 6) +
           " s, where an element has to end (the end of time, or a load that jumps): velocities and "
           "reactions are not "
           "determined there; try: moving that instant slightly";
}

namespace {

/// Where a function of a row ends and the motion is about to leave it; empty: nowhere.
std::string edge_ahead(const Model& model, const State& at)
{
    constexpr double near = 1e-3;   // of what the margin is measured by
    std::vector<Matrix34> X = at.X;
    const double step = 1e-6 * model.length();
    double speed = 0;
    for (const Matrix34& v : at.V) speed = std::max(speed, norm(v));
    // Looked at from a little before: behind its end a span would grow again.
    for (std::size_t b = 0; b < X.size() && speed > 0; ++b) X[b] -= step / speed * at.V[b];
    for (int r = 0; r < model.n_rows(); ++r) {
        const ConstraintRow& row = model.row(r);
        std::size_t first = 0;
        for (std::size_t m = 0; m < row.edges.size(); first += row.functions[m].n, ++m) {
            const FunctionEdge& edge = row.edges[m];
            const double here = edge.margin(function_point(row, row.functions[m], first, at.X));
            const double before = edge.margin(function_point(row, row.functions[m], first, X));
            if (here <= near * edge.size && here < before) return edge.what;
        }
    }
    return "";
}

}   // namespace

std::string of_locking(const Model& model, const State& first, const State& last)
{
    if (const std::string edge = edge_ahead(model, last); !edge.empty())
        return edge + " near t = " + to_text(last.t, 6) +
               " s; try: an earlier end, or lengths, loads or starts that keep away from there";
    const Lock lock = joints_that_lock(model, first, last);
    if (lock.empty()) return {};
    std::vector<std::string> driven, held;
    for (const int j : lock.drives) driven.push_back("'" + model.joints()[j].name + "'");
    for (const int j : lock.joints) held.push_back("'" + model.joints()[j].name + "'");
    const std::string when = " near t = " + to_text(last.t, 6) + " s",
                      by = held.empty() ? "" : named("joint", held) + " lose rank there";
    if (driven.empty())
        return "the mechanism locks, or runs away, or its motion parts into branches" + when + ": " + by +
               "; try: an earlier end, or lengths, loads or starts that keep away from that position";
    return "the mechanism locks" + when + ": what " + named("drive", driven) +
           (driven.size() == 1 ? " asks for is" : " ask for is") + " beyond what can be reached" +
           (by.empty() ? "" : " (" + by + ")") +
           "; try: another course of the drive, other lengths, or an earlier end";
}

void add_notes(SolveReport& report, const WindowCounts& counts)
{
    if (counts.rounded > 0 && counts.tolerance < finest_tolerance)
        report.notes.push_back("the tolerance " + to_text(counts.tolerance, 6) +
                               " is below rounding: " + count(counts.rounded, "window") + " of " +
                               std::to_string(report.iterations.size()) + " ended at rounding level");
    if (counts.splits > 0)
        report.notes.push_back(count(counts.splits, "window") +
                               " failed as a whole and were solved in halves");
    if (counts.bends > 0)
        report.notes.push_back("elements end at " + count(counts.bends, "instant") +
                               " where a law of a load bends or jumps");
    if (report.divided > 0)
        report.notes.push_back(count(report.divided, "element") +
                               " were too long for the motion and were bisected, the first near t = " +
                               to_text(report.divided_at, 6) + " s");
    if (report.shifted > 0)
        report.notes.push_back(
            count(report.shifted, "element end") +
            " fell elsewhere than asked for, to keep nodes off singular positions of the joints, the "
            "first near t = " +
            to_text(report.shifted_at, 6) + " s");
    if (report.rescued > 0 && counts.has_state)
        report.notes.push_back(
            count(report.rescued, "window") + " of " + std::to_string(report.iterations.size()) +
            " needed an initial guess from many small elements; more elements would be cheaper");
}

}   // namespace livens::inline spacetime_internal
