#include <cassert>
#include <cmath>
#include <string>

#include "livens/base/error.h"
#include "livens/diagnostics/detail/forces.h"
#include "livens/diagnostics/detail/largest.h"
#include "livens/diagnostics/detail/sampler.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/time/quadrature.h"

namespace livens {
namespace {

/// |Phi| / scale.
double joint_violation(const ConstraintRow& row, std::span<const Matrix34> X)
{
    const Matrix34& X_i = row.body_i == world ? world_configuration : X[row.body_i];
    return std::abs(constraint_value(row, X_i, X[row.body_j])) / row.scale;
}

/// Largest |1/2 (d_a . d_b - delta_ab)|  (P4).
double rigidity_violation(const Model& model, std::span<const Matrix34> X)
{
    double largest = 0;
    for (int b = 0; b < model.n_bodies(); ++b) {
        if (model.bodies()[b].is_point) continue;
        for (int i = 1; i < 4; ++i) {
            for (int j = i; j < 4; ++j) {
                const double product = dot(X[b].column(i), X[b].column(j));
                raise_to(largest, 0.5 * std::abs(product - (i == j ? 1 : 0)));
            }
        }
    }
    return largest;
}

/// |dPhi/dt| / scale.
double velocity_violation(const ConstraintRow& row, std::span<const Matrix34> X, std::span<const Matrix34> V)
{
    const RowGradient g = row_gradient(row, X);
    double rate = dot(g.j, V[row.body_j]);
    if (row.body_i != world) rate += dot(g.i, V[row.body_i]);
    return std::abs(rate) / row.scale;
}

void at_node(const Model& model, double t, std::span<const Matrix34> X, ViolationReport& report)
{
    for (int r = 0; r < model.n_rows(); ++r) {
        if (!raise_to(report.joints_at_nodes, joint_violation(model.row(r), X))) continue;
        report.worst_row = r;
        report.worst_time = t;
    }
    raise_to(report.rigidity_at_nodes, rigidity_violation(model, X));
}

void between_nodes(const Model& model, std::span<const Matrix34> X, ViolationReport& report)
{
    for (int r = 0; r < model.n_rows(); ++r)
        raise_to(report.joints_between, joint_violation(model.row(r), X));
    raise_to(report.rigidity_between, rigidity_violation(model, X));
}

std::vector<double> points_between(const std::vector<double>& nodes, int samples)
{
    std::vector<double> points;
    for (std::size_t a = 1; a < nodes.size(); ++a) {
        for (int k = 1; k <= samples; ++k) {
            points.push_back(nodes[a - 1] + (nodes[a] - nodes[a - 1]) * k / (samples + 1));
        }
    }
    return points;
}

}   // namespace

ViolationReport violations(const Model& model, const Motion& motion, int samples)
{
    assert(model.n_bodies() == motion.n_bodies && model.n_rows() == motion.n_rows);
    if (samples < 0) {
        throw InputError({"samples", "samples", "the number of samples between nodes must not be negative",
                          std::to_string(samples), ">= 0", "", ""});
    }
    ViolationReport report;
    if (motion.mesh.ends.empty()) return report;
    std::vector<Matrix34> X(static_cast<std::size_t>(motion.n_bodies));
    for (int end = 0; end <= motion.n_elements(); ++end) {
        positions_at_end(motion, end, X);
        at_node(model, motion.mesh.ends[end], X, report);
        const std::span<const Matrix34> V = velocities_at_end(motion, end);
        for (int r = 0; r < model.n_rows(); ++r) {
            raise_to(report.velocity_level, velocity_violation(model.row(r), X, V));
        }
    }
    const std::vector<double> nodes = gauss_lobatto(motion.X.degree + 1).points;
    const ElementSampler inner(motion, {nodes.begin() + 1, nodes.end() - 1});
    const ElementSampler between(motion, points_between(nodes, samples));
    for (int e = 0; e < motion.n_elements(); ++e) {
        for (int k = 0; k < inner.size(); ++k) {
            inner.positions(e, k, X);
            at_node(model, inner.instant(e, k).t, X, report);
        }
        for (int k = 0; k < between.size(); ++k) {
            between.positions(e, k, X);
            between_nodes(model, X, report);
        }
    }
    return report;
}

}   // namespace livens
