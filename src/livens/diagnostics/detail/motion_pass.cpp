// SPDX-License-Identifier: BSD-3-Clause
// What is judged of the points of a motion, each looked at once: theory.md, "What is diagnosed".
#include "livens/diagnostics/detail/motion_pass.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "livens/diagnostics/detail/point_batch.h"
#include "livens/diagnostics/largest.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/solvers/patience.h"

namespace livens::inline diagnostics_internal {

namespace {

/// Points of several elements fill a batch; only the last batches of an advance may be part empty.
constexpr int elements_at_once = 32;

Supply supply_at(const SupplyOfPoints& of, int lane, const Supply* rest)
{
    Supply now;
    if (rest != nullptr) now = *rest;
    for (int i = 0; i < 3; ++i) {
        now.linear[i] += of.linear[i][lane];
        now.angular[i] += of.angular[i][lane];
    }
    now.gross += of.gross[lane];
    now.gross_moment += of.gross_moment[lane];
    return now;
}

}   // namespace

/// Rational fields, momenta of their own, rotors and potentials of loads are left to the rule of action().
bool has_own_integrals(const Model& model, const Motion& motion)
{
    const bool is_exact = motion.gauss_points >= motion.X.degree ||
                          (takes_loads_at_nodes(motion) && motion.X.points == Points::lobatto);
    return is_exact && !model.has_rotors() && motion.P.empty() && motion.X.denominators.empty() &&
           std::ranges::none_of(model.loads(), [](const Load& load) { return bool(load.potential); });
}

/// Some elements at a time.
class MotionPass::Stretch {
public:
    Stretch(const Model& model, const Motion& motion, const PassWants& wants)
        : motion_(motion), wants_(wants), model_(model, all_rows(model)), tables_(model_),
          loads_(model_, motion),
          sets_(points_of(motion, {wants.supplies || wants.integrals, wants.supplies, wants.violations})),
          first_(wants.first), end_(wants.first)
    {
        for (std::size_t i = 0; i < sets_.size(); ++i) batches_.emplace_back(model_, tables_);
        if (!wants.series || motion.X.empty()) return;
        const auto n = motion.X.values.size() / static_cast<std::size_t>(motion.X.n_values);
        figures.nodes.joints.resize(n);
        figures.nodes.rigidity.resize(n);
    }

    const LoadSupply& loads() const { return loads_; }
    int first() const { return wants_.first; }
    int end() const { return end_; }
    const Supply& supply(int element) const { return supplies_[element - first_]; }
    void advance();
    void finish();

    PassFigures figures;

private:
    void visit(const MotionPoints& set, PointBatch& batch, int element);
    void flush(const PointRoles& roles, PointBatch& batch);
    void flush_loads(PointBatch& batch);
    void flush_joints(PointBatch& batch);
    void flush_nodes(PointBatch& batch);
    void add_integrals(PointBatch& batch, const OfPoints& kinetic);
    void raise_joints(PointBatch& batch, int lane, double largest);
    void flush_rates(PointBatch& batch);

    const Motion& motion_;
    PassWants wants_;
    ModelTables model_;
    PointTables tables_;
    LoadSupply loads_;
    std::vector<MotionPoints> sets_;
    std::vector<PointBatch> batches_;
    std::vector<Supply> supplies_;
    int first_, end_;   // elements of the last advance
};

void MotionPass::Stretch::advance()
{
    first_ = end_;
    end_ = std::min(first_ + elements_at_once, motion_.n_elements());
    supplies_.assign(static_cast<std::size_t>(end_ - first_), {});
    if (wants_.integrals) {
        ActionSeries& series = figures.integrals;
        const auto n = static_cast<std::size_t>(end_ - wants_.first);
        series.lagrangian.resize(n, 0.0);
        series.hamiltonian.resize(n, 0.0);
        series.angular_momentum.resize(n, Vector3{});
    }
    for (int e = first_; e < end_; ++e) {
        Patience::ask();
        for (std::size_t i = 0; i < sets_.size(); ++i) {
            if (sets_[i].is_start() && e > 0 && motion_.X.continuous) continue;   // a node of the one before
            sets_[i].go_to(e);
            visit(sets_[i], batches_[i], e);
        }
    }
    for (std::size_t i = 0; i < sets_.size(); ++i) flush(sets_[i].roles(), batches_[i]);
}

/// Loads are looked at for all points of the element at once. Their stiffness has sizes alone: it adds to
/// what rounding is relative to, and supplies nothing.
void MotionPass::Stretch::visit(const MotionPoints& set, PointBatch& batch, int element)
{
    const PointRoles& roles = set.roles();
    const bool has_loads = wants_.supplies && roles.loads && !loads_.empty();
    if (has_loads) {
        loads_.go_to(set, element);
        supplies_[element - first_].add(motion_.mesh.length(element), loads_.stiffness());
    }
    for (int k = 0; k < set.size(); ++k) {
        LanePoint point{element, -1, set.instant(k).t, set.weight(k)};
        if (roles.nodes) point.node = motion_.X.index(element, roles.first_node + k);
        batch.put(set, k, point, has_loads ? &loads_.at(k) : nullptr);
        if (batch.is_full()) flush(roles, batch);
    }
}

void MotionPass::Stretch::flush(const PointRoles& roles, PointBatch& batch)
{
    if (batch.points().empty()) return;
    if (roles.loads || roles.joints) batch.lanes().find_sizes();
    if (roles.loads) flush_loads(batch);
    if (roles.joints)
        flush_joints(batch);
    else if (roles.nodes)
        batch.lanes().find_violations();
    if (roles.nodes) flush_nodes(batch);
    batch.clear();
}

void MotionPass::Stretch::flush_loads(PointBatch& batch)
{
    SupplyOfPoints of_weights;
    batch.lanes().weights(of_weights);
    const OfPoints kinetic = batch.lanes().kinetic_energy();
    for (int lane = 0; lane < std::ssize(batch.points()); ++lane) {
        const LanePoint& point = batch.points()[lane];
        const Supply now = supply_at(of_weights, lane, batch.loads(lane));
        supplies_[point.element - first_].add(point.weight, now);
        raise_to(figures.largest_gross_moment, now.gross_moment);
        raise_to(figures.largest_kinetic, kinetic[lane]);
    }
    if (wants_.integrals) add_integrals(batch, kinetic);
}

void MotionPass::Stretch::add_integrals(PointBatch& batch, const OfPoints& kinetic)
{
    OfPoints moment[3];
    batch.lanes().moments(moment);
    const OfPoints potential = batch.lanes().potential();
    for (int lane = 0; lane < std::ssize(batch.points()); ++lane) {
        const LanePoint& point = batch.points()[lane];
        const auto e = static_cast<std::size_t>(point.element - wants_.first);
        figures.integrals.lagrangian[e] += point.weight * (kinetic[lane] - potential[lane]);
        figures.integrals.hamiltonian[e] += point.weight * (kinetic[lane] + potential[lane]);
        for (int i = 0; i < 3; ++i)
            figures.integrals.angular_momentum[e][i] += point.weight * moment[i][lane];
    }
}

void MotionPass::Stretch::flush_joints(PointBatch& batch)
{
    SupplyOfPoints of_rows;
    batch.lanes().joints(of_rows);
    for (int lane = 0; lane < std::ssize(batch.points()); ++lane) {
        const LanePoint& point = batch.points()[lane];
        const Supply now = supply_at(of_rows, lane, batch.others(lane));
        supplies_[point.element - first_].add(point.weight, now);
        raise_to(figures.largest_gross_moment, now.gross_moment);
    }
}

void MotionPass::Stretch::flush_nodes(PointBatch& batch)
{
    if (model_.model->has_events()) batch.let_go();
    const OfPoints joints = batch.lanes().largest_violation(), rigidity = batch.lanes().largest_of_rigidity();
    for (int lane = 0; lane < std::ssize(batch.points()); ++lane) {
        const LanePoint& point = batch.points()[lane];
        raise_to(figures.violations.rigidity_at_nodes, rigidity[lane]);
        raise_joints(batch, lane, joints[lane]);
        if (!wants_.series) continue;
        figures.nodes.joints[point.node] = joints[lane];
        figures.nodes.rigidity[point.node] = rigidity[lane];
    }
}

/// Kernels tell the largest of all rows, not which row it is: that is asked for a new largest one alone.
void MotionPass::Stretch::raise_joints(PointBatch& batch, int lane, double at_point)
{
    if (!raise_to(figures.violations.joints_at_nodes, at_point)) return;
    double largest = 0;
    for (int r = 0; r < model_.n_rows(); ++r)
        if (raise_to(largest, std::abs(batch.lanes().violation(r, lane)))) figures.violations.worst_row = r;
    figures.violations.worst_time = batch.points()[lane].t;
}

void MotionPass::Stretch::flush_rates(PointBatch& batch)
{
    batch.lanes().find_rates();
    if (model_.model->has_events()) batch.let_go();
    const OfPoints largest = batch.lanes().largest_violation();
    for (int lane = 0; lane < std::ssize(batch.points()); ++lane)
        raise_to(figures.violations.velocity_level, largest[lane]);
    batch.clear();
}

/// Rates of rows are those of velocities at element ends, which belong to momenta: polynomials have others.
void MotionPass::Stretch::finish()
{
    while (end_ < motion_.n_elements()) advance();
    if (!wants_.violations || motion_.X.empty()) return;
    PointBatch batch(model_, tables_);
    const auto n = static_cast<std::size_t>(motion_.n_bodies);
    if (motion_.n_elements() == 0) {   // a motion that has only its start
        batch.put_instant(motion_.X.values.data(), nullptr, motion_.start());
        batch.lanes().find_violations();
        flush_nodes(batch);
        batch.clear();
    }
    for (int end = 0; end <= motion_.n_elements(); ++end) {
        Patience::ask();
        const bool is_last = end > 0 && end == motion_.n_elements();
        const auto X =
            is_last ? motion_.X.coefficient(end - 1, motion_.X.degree) : motion_.X.coefficient(end, 0);
        batch.put_instant(X.data(), motion_.velocities[static_cast<std::size_t>(end) * n].data(),
                          motion_.mesh.ends[end]);
        if (batch.is_full() || end == motion_.n_elements()) flush_rates(batch);
    }
}

MotionPass::MotionPass(const Model& model, const Motion& motion, const PassWants& wants)
    : stretch_(std::make_unique<Stretch>(model, motion, wants))
{
    assert(model.n_bodies() == motion.n_bodies && model.n_rows() == motion.n_rows);
    assert(!wants.integrals || has_own_integrals(model, motion));
}

MotionPass::~MotionPass() = default;

const LoadTurns& MotionPass::turns() const { return stretch_->loads().turns(); }

const Supply& MotionPass::supply(int element)
{
    while (element >= stretch_->end()) stretch_->advance();
    return stretch_->supply(element);
}

ActionSeries MotionPass::integrals(int last)
{
    while (stretch_->end() < last) stretch_->advance();
    ActionSeries series = std::move(stretch_->figures.integrals);
    const auto n = static_cast<std::size_t>(last - stretch_->first());
    series.lagrangian.resize(n);   // advances go on for some elements
    series.hamiltonian.resize(n);
    series.angular_momentum.resize(n);
    return series;
}

void MotionPass::finish() { stretch_->finish(); }
PassFigures& MotionPass::figures() { return stretch_->figures; }

}   // namespace livens::inline diagnostics_internal
