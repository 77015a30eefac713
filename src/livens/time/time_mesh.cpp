// SPDX-License-Identifier: BSD-3-Clause
// The division of time into elements. Output times, jumps and kinks of loads are element ends (theory.md,
// "Why two rules"); between two such instants elements have one length. Refusals name the key of the
// scenario.
#include "livens/time/time_mesh.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <functional>
#include <set>
#include <string>

#include "livens/base/error.h"
#include "livens/base/text.h"

namespace livens {
namespace {

void check_interval(double start, double end, int n_elements)
{
    if (!std::isfinite(start)) {
        throw InputError({"time-start", "time.start", "the motion must start at a finite time",
                          to_text(start), "finite", "", ""});
    }
    if (!std::isfinite(end)) {
        throw InputError(
            {"time-end", "time.end", "the motion must end at a finite time", to_text(end), "finite", "", ""});
    }
    if (!(end > start)) {
        throw InputError({"time-end", "time.end", "the end must lie after the start", to_text(end),
                          "> " + to_text(start), "", ""});
    }
    if (!std::isfinite(end - start)) {
        throw InputError({"time-end", "time.end",
                          "the time from start to end exceeds the range of floating-point numbers",
                          to_text(end), "", "", ""});
    }
    if (n_elements < 1 || n_elements > most_elements) {
        throw InputError({"time-elements", "time.elements", "the number of time elements is out of range",
                          std::to_string(n_elements), "1 .. " + to_text(most_elements), "", ""});
    }
}

/// Start, end and the required instants between them, merged.
std::vector<double> fixed_ends(double start, double end, std::span<const double> required)
{
    const double gap = nearest_ends * (end - start);
    for (const double t : required)
        if (!std::isfinite(t))
            throw InputError({"time-output", "time.output",
                              "an instant that must be an element end is not finite", to_text(t), "finite",
                              "", ""});
    // Two instants that differ by rounding would leave an element of no length between them. The first one
    // that was stated stays; start and end are there before all others.
    if (std::ranges::is_sorted(required)) {   // nearly always: no tree is needed
        std::vector<double> fixed{start};
        for (const double t : required)
            if (t - fixed.back() >= gap && end - t >= gap) fixed.push_back(t);
        fixed.push_back(end);
        return fixed;
    }
    std::set<double> fixed{start, end};
    for (const double t : required) {
        if (t < start || t > end) continue;
        const auto after = fixed.lower_bound(t);   // exists, since t <= end
        const bool close_after = *after - t < gap;
        const bool close_before = after != fixed.begin() && t - *std::prev(after) < gap;
        if (!close_after && !close_before) fixed.insert(after, t);
    }
    return {fixed.begin(), fixed.end()};
}

}   // namespace

int TimeMesh::element_at(double t) const
{
    assert(n_elements() >= 1);
    // An element end belongs to the element that begins there, except for the last.
    const auto after = std::upper_bound(ends.begin(), ends.end(), t);
    return std::clamp(static_cast<int>(after - ends.begin()) - 1, 0, n_elements() - 1);
}

double start_of(const Time& time)
{
    if (const auto* mesh = std::get_if<TimeMesh>(&time)) return mesh->start();
    return std::get<Span>(time).start;
}

double end_of(const Time& time)
{
    if (const auto* mesh = std::get_if<TimeMesh>(&time)) return mesh->end();
    return std::get<Span>(time).end;
}

std::vector<double> missed(const TimeMesh& mesh, std::span<const double> instants)
{
    const double reach = nearest_ends * (mesh.end() - mesh.start());
    std::vector<double> inside;
    for (const double t : instants) {
        if (!(t >= mesh.start() && t <= mesh.end())) continue;
        const auto next = std::lower_bound(mesh.ends.begin(), mesh.ends.end(), t - reach);
        if (next == mesh.ends.end() || *next > t + reach) inside.push_back(t);
    }
    return inside;
}

TimeMesh make_time_mesh(double start, double end, int n_elements, std::span<const double> required)
{
    check_interval(start, end, n_elements);
    const std::vector<double> fixed = fixed_ends(start, end, required);

    TimeMesh mesh{{}, fixed};
    mesh.ends.reserve(static_cast<std::size_t>(n_elements) + fixed.size());
    mesh.ends.push_back(start);
    for (std::size_t i = 1; i < fixed.size(); ++i) {
        const double from = fixed[i - 1], length = fixed[i] - from;
        // An instant on the grid may be off it by rounding or by a merge; that must not cost an element.
        const double parts = length / (end - start) * n_elements;
        const std::int64_t n =
            std::max<std::int64_t>(1, std::llround(std::ceil(parts - nearest_ends * n_elements)));
        for (std::int64_t k = 1; k < n; ++k) {
            mesh.ends.push_back(from + length * static_cast<double>(k) / static_cast<double>(n));
        }
        mesh.ends.push_back(fixed[i]);
    }
    // Far from t = 0 numbers are farther apart than an element may be long; a length of zero would divide by
    // zero later.
    const auto stuck = std::adjacent_find(mesh.ends.begin(), mesh.ends.end(), std::greater_equal<>());
    if (stuck != mesh.ends.end()) {
        throw InputError(
            {"time-resolution", "time.elements",
             "time elements at t = " + to_text(*stuck) + " are shorter than the spacing of numbers there",
             std::to_string(n_elements), "", "", "use fewer elements or start nearer to zero"});
    }
    return mesh;
}

}   // namespace livens
