// SPDX-License-Identifier: BSD-3-Clause
// By how much what is off at the start moves the arrival: theory.md, "Arrival".
#include <algorithm>
#include <cmath>
#include <new>
#include <span>
#include <vector>

#include "livens/dynamics/rows/tables.h"
#include "livens/multibody/model.h"
#include "livens/solvers/patience.h"
#include "livens/solvers/spectral.h"
#include "livens/spacetime/accuracy/accuracy.h"
#include "livens/spacetime/nodal/arrival.h"

namespace livens::inline spacetime_internal {

namespace {

/// Columns of twists in lengths of the model and radians, of all bodies.
DenseMatrix in_lengths(const ModelTables& tables, const DenseMatrix& twists)
{
    DenseMatrix scaled(twists.rows, twists.cols);
    for (int j = 0; j < twists.cols; ++j)
        for (const auto& body : tables.bodies)
            for (int i = 0; i < body.dofs; ++i)
                scaled(body.first + i, j) = twists(body.first + i, j) / (i < 3 ? tables.length : 1);
    return scaled;
}

/// The largest of the shifts and turns of bodies.
double largest_motion(const ModelTables& tables, const std::vector<double>& twists)
{
    double largest = 0;
    for (const auto& body : tables.bodies)
        for (int i = 0; i < body.dofs; i += 3)
            largest = std::max(largest, norm(std::span<const double>(twists.data() + body.first + i, 3)));
    return largest;
}

/// Of the velocities at the start those that move the arrival most, by the sums of squares over all bodies;
/// by the largest number of each then.
double response(const ModelTables& tables, const FlowDerivative& flow)
{
    const int f = tables.freedoms();
    const DenseMatrix start = in_lengths(tables, flow.start), arrival = in_lengths(tables, flow.arrival);
    const SymmetricSpectrum found =
        generalised_spectrum(transposed_product(arrival, arrival), transposed_product(start, start));
    if (!found.is_found) return 0;
    const auto worst = found.vectors.column(f - 1);
    const double of = largest_motion(tables, product(start, worst)),
                 moved = largest_motion(tables, product(arrival, worst));
    return std::isfinite(moved / of) ? moved / of : 0;
}

}   // namespace

void find_arrival(const Model& model, const Problem& problem, const SolveOptions& options, Solution& solution)
{
    const Motion& motion = solution.motion;
    if (is_over_phases(model, problem)) return;
    try {
        const Ends ends = close_ends(model, problem, motion.start(), motion.end(), options.initial);
        if (ends.has_state()) return;
        const ModelTables tables(model, ends.independent);
        const FlowDerivative flow = flow_derivative(tables, motion.mesh, rule_of(witness_of(solution.method)),
                                                    [&](double t) { return motion.at(t); });
        if (!flow.arrival.is_empty()) solution.report.arrival = response(tables, flow);
    } catch (const Stopped&) {
        solution.report.notes.push_back(
            "stopped as asked before it was found what the arrival is to the start");
    } catch (const std::bad_alloc&) {
        solution.report.notes.push_back("memory ended before it was found what the arrival is to the start");
    }
}

}   // namespace livens::inline spacetime_internal
