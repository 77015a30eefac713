// SPDX-License-Identifier: BSD-3-Clause
// What a run takes of memory. It is bounded before the solution begins, by formulas that were fitted to
// measured peaks: a computer that swaps or kills the program tells nothing. The numbers are estimates, not
// inequalities.
#include <algorithm>

#include "livens/io/scenario/run/run.h"

namespace livens {

namespace {

constexpr double gibibyte = 1u << 30;
constexpr double max_motion_bytes = 8 * gibibyte;
constexpr double max_matrix_bytes = 8 * gibibyte;
// The whole solution of 20,000 linear elements of one rigid body (56 entries of the factors an unknown, and
// the matrix, its pattern and copies) took 2.3 kB an unknown, as much as 150 entries of 16 bytes. Bodies that
// hang together fill the factors: chains of 2, 4 and 8 hinges took 240, 400 and 770 entries, linear elements.
constexpr double least_entries_per_unknown = 150;
constexpr double entries_per_unknown = 2.57;   // beyond 60, for each unknown of a node
constexpr double bytes_per_factor_entry = 16;

int degree_of(const Method& method)
{
    if (const auto* lobatto = std::get_if<Lobatto>(&method)) return lobatto->degree;
    if (const auto* radau = std::get_if<Radau>(&method)) return radau->degree;
    const auto* mixed = std::get_if<Mixed>(&method);
    return mixed != nullptr ? mixed->degree : 1;
}

double elements_at_once(int window, double n_elements)
{
    return window > 0 ? std::min<double>(window, n_elements) : n_elements;
}

/// Numbers of Field and end values a node and an element end, see Motion.
double motion_bytes(const Model& model, const Method& method, double n_elements)
{
    const double bodies = model.n_bodies(), rows = model.n_rows();
    const double at_ends = 48 * bodies + 2 * rows;   // P, V, and X'' on both sides
    // The elements mixed have fields of momenta and of rigidity of their own.
    const double inside = (std::holds_alternative<Mixed>(method) ? 30 : 12) * bodies + rows;
    return sizeof(double) * n_elements * (inside * std::max(degree_of(method), 1) + at_ends);
}

/// Of lobatto's elements that are solved together: blocks of the unknowns of one node, a row of 6 (3 for
/// point masses) a body, and what belongs to a node besides. Chains of 1, 4 and 8 bodies took 4.4, 29 and 87
/// kB a node.
double window_bytes(const Model& model, const Lobatto& lobatto, double n_elements)
{
    if (lobatto.window == 1) return 0;
    double unknowns = 0;
    for (const Body& body : model.bodies()) unknowns += body.is_point ? 3 : 6;
    return lobatto.degree * elements_at_once(lobatto.window, n_elements) * unknowns * (600 + 24 * unknowns);
}

/// What condition numbers of a march take beside the motion: of all elements together the blocks of their
/// matrix, its factors, its entries that are not zero, null spaces, and what belongs to a node besides. One
/// free body took 24 kB an element of degree 4, chains of 1, 4 and 10 hinges what follows within 3 percent.
double condition_bytes(const Model& model, const Method& method, double n_elements)
{
    const double bodies = model.n_bodies(), rows = model.n_rows();
    double twists = 0;
    for (const Body& body : model.bodies()) twists += body.is_point ? 3 : 6;
    const double f = std::max(twists - rows, 1.0), p = degree_of(method);
    const bool is_free = model.joints().empty() && model.loads().empty();
    const double density = is_free ? 1 / (3 * bodies) : 1;   // of the blocks
    const double blocks = 8 * (p + 1) * (p + 1) * f * f, factors = 8 * f * f * (p * p + 2 * p + 1),
                 entries = 12 * density * p * (p + 1) * f * f,
                 node = 8 * twists * f + (12 * twists + 550) * rows + 600 * bodies + 650;
    return n_elements * (blocks + factors + entries + p * node);
}

/// Conditions at both ends take one window of all elements, and its condition number, which tells whether
/// they determine the motion; those of a second solution are of one degree more; and the derivative of the
/// arrival, whose matrix has a border. Free bodies (1 to 6) and chains of 1 to 8 hinges, degrees 1 to 6, took
/// what follows within a sixth.
double both_ends_bytes(const Model& model, const Lobatto& lobatto, double n_elements, bool is_estimated)
{
    double twists = 0;
    for (const Body& body : model.bodies()) twists += body.is_point ? 3 : 6;
    const double f = std::max(twists - model.n_rows(), 1.0), p = lobatto.degree + (is_estimated ? 1 : 0);
    return n_elements * p * (twists * (400 + 16 * twists) + (140 + 12 * p) * f * f + 200 * f + 500);
}

/// Of the factors of one block's matrix, which outweigh all else.
double matrix_bytes(const Model& model, const Mixed& mixed, double n_elements)
{
    double unknowns = model.n_rows();   // a node
    for (const Body& body : model.bodies()) unknowns += body.is_point ? 6 : 30;
    const bool is_free = model.joints().empty();
    const double entries = is_free ? least_entries_per_unknown
                                   : std::max(least_entries_per_unknown, 60 + entries_per_unknown * unknowns);
    // the factors fill a band as wide as an element: degrees 1 to 8 took 1.1, 1.3, .. 3.4 times the entries,
    // 2.7 times of free bodies, 4.2 times of chains
    const double p = mixed.degree, of_chain = std::clamp(unknowns / 35 - 1, 0.0, 1.0),
                 width = is_free ? 0.75 + 0.25 * p
                                 : std::max(1.0, 0.65 + 0.34 * p) + of_chain * 0.012 * (p * p - 1);
    return unknowns * mixed.degree * elements_at_once(mixed.window, n_elements) * entries * width *
           bytes_per_factor_entry;
}

double system_bytes(const Model& model, const Method& method, double n_elements)
{
    if (const auto* lobatto = std::get_if<Lobatto>(&method)) return window_bytes(model, *lobatto, n_elements);
    const auto* mixed = std::get_if<Mixed>(&method);
    return mixed != nullptr ? matrix_bytes(model, *mixed, n_elements) : 0;
}

std::string gibibytes(double bytes)
{
    return std::to_string(static_cast<long long>(bytes / gibibyte)) + " GiB";
}

}   // namespace

bool io_internal::check_size(const Model& model, const Method& method, double n_elements,
                             const SourceLocation& place, Findings& findings)
{
    const std::string what = std::to_string(static_cast<long long>(n_elements)) + " time elements for " +
                             std::to_string(model.n_bodies()) + " bodies";
    const auto fits = [&](const char* thing, double bytes, double most, const char* help) {
        return bytes <= most || findings.error(place, "resource-limit",
                                               std::string(thing) + " would take " + gibibytes(bytes) +
                                                   ", more than " + gibibytes(most),
                                               {what, help});
    };
    return fits("the motion", motion_bytes(model, method, n_elements), max_motion_bytes,
                "use fewer elements; a higher degree makes up for it") &&
           fits("the system of one block", system_bytes(model, method, n_elements), max_matrix_bytes,
                "solve fewer of them at once, for instance with window = 1000 in [method]");
}

MemoryNeed memory_needed(const Scenario& scenario)
{
    const Model& model = scenario.model;
    const Method& method = scenario.method;
    const bool is_march = scenario.conditions.has_state();
    const auto* mesh = std::get_if<TimeMesh>(&scenario.time);
    const double n_output = static_cast<double>(scenario.output.size());
    // for an accuracy at least one between output times is found
    const double n = mesh != nullptr ? mesh->n_elements() : std::max(n_output - 1, 1.0);
    const bool is_estimated = scenario.options.estimate != SolveOptions::Estimate::none;
    const double estimates =
        is_estimated ? 3 * model.n_bodies() + static_cast<int>(model.joints().size()) : 0;
    MemoryNeed need;
    need.motion =
        motion_bytes(model, method, n) + sizeof(double) * (2 * n + n_output);   // ends and iterations
    need.system = system_bytes(model, method, n);
    const auto* lobatto = std::get_if<Lobatto>(&method);
    if (lobatto != nullptr && !is_march)
        need.system = both_ends_bytes(model, *lobatto, n, is_estimated);
    else if (lobatto != nullptr && scenario.options.condition)
        need.system = std::max(need.system, condition_bytes(model, method, n));
    need.checks = sizeof(double) * (estimates * n + 6 * n * degree_of(method)) + (8u << 20);
    return need;
}

}   // namespace livens
