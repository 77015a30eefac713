// SPDX-License-Identifier: BSD-3-Clause
// How far constraints are off, each row over its scale: at nodes, at velocity level, between nodes and in the
// mean over elements. theory.md, "What is diagnosed"; (P4) is rigidity, and means are what the weak form asks
// for.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>

#include "livens/base/error.h"
#include "livens/diagnostics/detail/motion_pass.h"
#include "livens/diagnostics/detail/sampler.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/diagnostics/largest.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/solvers/patience.h"
#include "livens/time/quadrature.h"

namespace livens {
namespace {

/// Phi / scale.
double joint_violation(const ModelTables& tables, int row, double t, std::span<const Matrix34> X)
{
    return tables.rows.value(row, {t}, X.data()->data()) / tables.rows[row].row->scale;
}

/// The six 1/2 (d_a . d_b - delta_ab) of a body (P4).
std::array<double, 6> rigidity_violations(const Matrix34& X)
{
    std::array<double, 6> all{};
    int n = 0;
    for (int i = 1; i < 4; ++i) {
        for (int j = i; j < 4; ++j) {
            all[n++] = 0.5 * (dot(X.column(i), X.column(j)) - (i == j ? 1 : 0));
        }
    }
    return all;
}

/// Largest |1/2 (d_a . d_b - delta_ab)| of all bodies.
double rigidity_violation(const Model& model, std::span<const Matrix34> X)
{
    double largest = 0;
    for (int b = 0; b < model.n_bodies(); ++b) {
        if (model.bodies()[b].is_point) continue;
        for (const double violation : rigidity_violations(X[b])) raise_to(largest, std::abs(violation));
    }
    return largest;
}

bool is_held(const ModelTables& tables, int row, double t)
{
    return tables.model->joints()[tables.model->row_joint(row)].holds_at(t);
}

/// Largest |Phi| / scale of all rows that are held.
double worst_joint(const ModelTables& tables, double t, std::span<const Matrix34> X, int& row)
{
    double largest = 0;
    for (int r = 0; r < tables.n_rows(); ++r)
        if (is_held(tables, r, t) && raise_to(largest, std::abs(joint_violation(tables, r, t, X)))) row = r;
    return largest;
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

void between_nodes(const ModelTables& tables, const Motion& motion, int samples, std::span<Matrix34> X,
                   ViolationReport& report)
{
    const ElementSampler between(motion, points_between(motion.X.basis().nodes(), samples));
    for (int e = 0; e < motion.n_elements(); ++e) {
        Patience::ask();
        for (int k = 0; k < between.size(); ++k) {
            between.positions(e, k, X);
            int row = -1;
            raise_to(report.joints_between, worst_joint(tables, between.instant(e, k).t, X, row));
            raise_to(report.rigidity_between, rigidity_violation(*tables.model, X));
        }
    }
}

/// Means of all rows over each element: Phi has twice the degree of X, which the rule integrates exactly
/// (quotients of polynomials nearly).
void as_integrals(const ModelTables& tables, const Motion& motion, std::span<Matrix34> X,
                  ViolationReport& report)
{
    const Quadrature rule = gauss(std::min(2 * motion.X.degree, 64));
    const ElementSampler sampler(motion, rule.points);
    const std::size_t n_rows = static_cast<std::size_t>(tables.n_rows());
    std::vector<double> joints(n_rows), rigidity(6 * X.size());
    for (int e = 0; e < motion.n_elements(); ++e) {
        Patience::ask();
        std::ranges::fill(joints, 0.0);
        std::ranges::fill(rigidity, 0.0);
        for (int k = 0; k < sampler.size(); ++k) {
            sampler.positions(e, k, X);
            const double t = sampler.instant(e, k).t;
            for (std::size_t r = 0; r < n_rows; ++r) {
                if (!is_held(tables, static_cast<int>(r), t)) continue;
                joints[r] += rule.weights[k] * joint_violation(tables, static_cast<int>(r), t, X);
            }
            for (std::size_t b = 0; b < X.size(); ++b) {
                if (tables.model->bodies()[b].is_point) continue;
                const std::array<double, 6> now = rigidity_violations(X[b]);
                for (std::size_t i = 0; i < 6; ++i) rigidity[6 * b + i] += rule.weights[k] * now[i];
            }
        }
        for (const double mean : joints) raise_to(report.joints_weakly, std::abs(mean));
        for (const double mean : rigidity) raise_to(report.rigidity_weakly, std::abs(mean));
    }
}

}   // namespace

ViolationReport violations(const Model& model, const Motion& motion, int samples, bool means)
{
    assert(model.n_bodies() == motion.n_bodies && model.n_rows() == motion.n_rows);
    if (samples < 0) {
        throw InputError({"samples", "samples", "the number of samples between nodes must not be negative",
                          std::to_string(samples), ">= 0", "", ""});
    }
    if (motion.mesh.ends.empty()) return {};
    MotionPass pass(model, motion, {.violations = true});
    pass.finish();
    ViolationReport report = pass.figures().violations;
    if (samples == 0 && !means) return report;
    std::vector<Matrix34> X(static_cast<std::size_t>(motion.n_bodies));
    const ModelTables tables(model, all_rows(model));
    if (samples > 0) between_nodes(tables, motion, samples, X, report);
    if (means) as_integrals(tables, motion, X, report);
    return report;
}

void diagnostics_internal::add_weak_violations(const Model& model, const Motion& motion,
                                               ViolationReport& report)
{
    std::vector<Matrix34> X(static_cast<std::size_t>(motion.n_bodies));
    as_integrals(ModelTables(model, all_rows(model)), motion, X, report);
}

NodeViolations node_violations(const Model& model, const Motion& motion)
{
    if (motion.X.empty()) return {};
    MotionPass pass(model, motion, {.violations = true, .series = true});
    pass.finish();
    return std::move(pass.figures().nodes);
}

}   // namespace livens
