// SPDX-License-Identifier: BSD-3-Clause
// Pseudo-arclength: the share of the way is an unknown, and steps go along the tangent of the curve, which is
// never across it (theory.md, "Finding the motion").
#include "livens/spacetime/curve.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "livens/multibody/model.h"
#include "livens/solvers/newton.h"
#include "livens/solvers/patience.h"
#include "livens/spacetime/nodal/window.h"

namespace livens::inline spacetime_internal {

namespace {

constexpr double first_arc = 0.5, longest_arc = 2, shortest_arc = 1e-3;   // of the curve
constexpr int most_factors = 300, most_corrections = 8, few_corrections = 4;
constexpr double farthest_share = 20, returned = 0.1;   // of how far it was
constexpr double of_share = 1e-5;                       // at which rows are compared
constexpr double tolerance = 1e-5;                      // of motions on the way

/// The window of all elements at a share of the way, as Newton's iteration sees it: unknowns are the twists
/// of all nodes, what conditions by component add, and the share. Increments are across the tangent.
class Curve final : public NewtonProblem {
public:
    using EndsAt = std::function<std::optional<Ends>(double share)>;

    Curve(const Model& model, const TimeMesh& mesh, int degree, const EndsAt& ends_at)
        : model_(model), mesh_(mesh), rule_(lobatto_rule(degree)), ends_at_(ends_at)
    {}

    /// On the curve. False: there is no such motion near.
    bool begin(const OnCurve& from)
    {
        now_ = kept_ = make(from.share);
        if (now_ == nullptr || !now_->window.start_from(from.motion)) return false;
        Newton newton;
        const bool is_found =
            newton.run(system(), {tolerance, most_corrections, {}}).status == SolveStatus::converged;
        first_ = places();
        return is_found && set_tangent();
    }
    /// To the next motion, `step` along the curve; iterations, or 0: it was not found.
    int go(double step);
    double share() const { return kept_->share; }
    /// Largest distance of a node from where the curve began, in coordinates of X.
    double distance() const;
    /// Of the share along the curve.
    double ahead() const { return tangent_.back(); }
    int factors() const { return n_factors_; }
    Guess motion();

    int n_unknowns() const override { return now_->window.equations().n_unknowns() + 1; }
    bool residual() override { return system().residual(); }
    bool factorise() override;
    void solve(std::span<double> dx) override;
    bool move(std::span<const double> dx, double damping) override;
    void keep() override
    {
        system().keep();
        kept_ = now_;
    }
    double size_of(std::span<const double> dx) const override
    {
        return std::max(now_->window.equations().size_of(dx.first(dx.size() - 1)), std::abs(dx.back()));
    }
    double scale() const override { return now_->window.equations().scale(); }
    NewtonProblem::Rows rows() const override { return now_->window.equations().rows(); }

private:
    struct Instance {
        Instance(const Model& model, const TimeMesh& mesh, Ends&& made, const ElementRule& rule, double at)
            : share(at), ends(std::move(made)), tables(model, ends.independent),
              window(tables, mesh, ends, rule)
        {}
        double share;
        Ends ends;
        ModelTables tables;
        NodalWindow window;
    };
    using Shared = std::shared_ptr<Instance>;

    NodalSystem& system() { return now_->window.equations(); }
    Shared make(double share) const;
    double product(std::span<const double> a, std::span<const double> b) const;
    bool set_tangent();
    std::vector<double> places() const;

    const Model& model_;
    TimeMesh mesh_;
    ElementRule rule_;
    const EndsAt& ends_at_;
    Shared now_, kept_, formed_;     // the current point, the kept one, that of the factors
    std::vector<double> by_share_;   // dq/ds of the curve where factors were formed
    std::vector<double> tangent_;    // of length 1, by the nodes and the share
    std::vector<double> first_;      // X of all nodes where it began
    int n_factors_ = 0;
};

Curve::Shared Curve::make(double share) const
{
    Patience::ask();
    std::optional<Ends> ends = ends_at_(share);
    if (!ends) return nullptr;
    auto made = std::make_shared<Instance>(model_, mesh_, *std::move(ends), rule_, share);
    SolveReport report;
    return made->window.open(0, mesh_.n_elements(), report) ? made : nullptr;
}

/// Mean over nodes and bodies, in lengths of the model and radians; momenta of conditions follow from places.
double Curve::product(std::span<const double> a, std::span<const double> b) const
{
    const BodyTables& bodies = now_->tables.bodies;
    const WindowLayout& layout = now_->window.equations().layout();
    double sum = 0;
    int n = 0;
    for (int A = 0; A < layout.n_nodes(); ++A) {
        if (!layout.is_unknown(A)) continue;
        for (const BodyTable& body : bodies)
            for (int i = 0; i < body.dofs; ++i) {
                const int k = n * now_->tables.n_twists + body.first + i;
                const double unit = i < 3 ? now_->tables.length : 1;
                sum += a[k] * b[k] / (unit * unit);
            }
        ++n;
    }
    return sum / (std::max(n, 1) * static_cast<double>(bodies.size()));
}

/// dq/ds = -J^-1 dR/ds, with rows at shares on both sides of this one and nodes held: the difference of what
/// both ask for as increments.
bool Curve::factorise()
{
    formed_ = now_;
    ++n_factors_;
    if (!system().factorise()) return false;
    by_share_.assign(static_cast<std::size_t>(system().n_unknowns()), 0.0);
    std::vector<double> dx(by_share_.size());
    for (const double sign : {1.0, -1.0}) {   // increments that would take other ends' rows off
        const Shared other = make(now_->share + sign * of_share);
        if (other == nullptr) return false;
        NodalSystem& there = other->window.equations();
        if (!there.adopt(system(), true) || !there.residual()) return false;
        system().solve_for(there, dx);
        for (std::size_t i = 0; i < dx.size(); ++i) by_share_[i] += sign * dx[i] / (2 * of_share);
    }
    return true;
}

/// Newton's increment at this share, and as much along the curve as takes it across the tangent.
void Curve::solve(std::span<double> dx)
{
    const std::span<double> nodes = dx.first(dx.size() - 1);
    formed_->window.equations().solve_for(system(), nodes);
    const std::span<const double> tangent = std::span<const double>(tangent_).first(nodes.size());
    const double along = product(tangent, by_share_) + tangent_.back();
    dx.back() = -product(tangent, nodes) / along;
    for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] += dx.back() * by_share_[i];
}

bool Curve::move(std::span<const double> dx, double damping)
{
    now_ = kept_;
    if (damping == 0) return true;
    const Shared other = make(kept_->share + damping * dx.back());
    if (other == nullptr) return false;
    NodalSystem& there = other->window.equations();
    const bool is_placed =
        there.adopt(kept_->window.equations(), false) && there.move(dx.first(dx.size() - 1), damping);
    now_ = other;
    return is_placed;
}

/// Of the curve where it stands, on the same side as the last one.
bool Curve::set_tangent()
{
    if (!residual() || !factorise()) return false;
    std::vector<double> next = by_share_;
    next.push_back(1);
    const double norm = std::sqrt(product(next, next) + 1);
    if (!std::isfinite(norm)) return false;
    const double with_last = tangent_.empty() ? 1 : product(next, tangent_) + tangent_.back();
    for (double& v : next) v /= with_last < 0 ? -norm : norm;
    tangent_ = std::move(next);
    return true;
}

std::vector<double> Curve::places() const
{
    const Nodes& nodes = kept_->window.equations().nodes();
    const int n = kept_->window.equations().layout().n_nodes();
    const std::size_t size = 12 * kept_->tables.bodies.size();
    std::vector<double> all;
    for (int A = 0; A < n; ++A) all.insert(all.end(), nodes.X(A), nodes.X(A) + size);
    return all;
}

double Curve::distance() const
{
    const std::vector<double> now = places();
    double far = 0;
    for (std::size_t i = 0; i < now.size(); ++i) far = std::max(far, std::abs(now[i] - first_[i]));
    return far;
}

/// Where it is not found the curve stands where it stood.
int Curve::go(double step)
{
    const Shared before = kept_;
    const std::vector<double> last = tangent_;
    std::vector<double> dx = last;
    for (double& v : dx) v *= step;
    NewtonReport report;
    const bool is_moved = move(dx, 1) && residual();
    if (is_moved) report = Newton().run(*this, {tolerance, most_corrections, {}});
    if (is_moved && report.status == SolveStatus::converged && set_tangent())
        return std::max(report.iterations, 1);
    now_ = kept_ = before;
    tangent_ = last;
    return 0;
}

Guess Curve::motion()
{
    SolveReport report;
    kept_->window.close({}, report);
    const auto motion = std::make_shared<Motion>(kept_->window.take_motion());
    return [motion](double t) { return motion->at(t); };
}

}   // namespace

Followed follow_curve(const Model& model, const TimeMesh& mesh, int degree, const OnCurve& begin,
                      const std::function<std::optional<Ends>(double share)>& ends_at)
{
    Followed found;
    Curve curve(model, mesh, degree, ends_at);
    if (!curve.begin(begin)) return found;
    double step = first_arc, farthest = 0;
    while (curve.factors() < most_factors && step >= shortest_arc &&
           std::abs(curve.share()) <= farthest_share) {
        const double share = curve.share(), ahead = curve.ahead();
        const double to_end = ahead > 0 && share < 1 ? (1 - share) / ahead : step;
        const int iterations = curve.go(std::min(step, to_end));
        if (iterations == 0) {
            step /= 2;
            continue;
        }
        ++found.steps;
        if (ahead * curve.ahead() < 0) ++found.turns;
        if ((share - 1) * (curve.share() - 1) <= 0 || std::abs(curve.share() - 1) < 1e-3) {
            found.motion = curve.motion();
            return found;
        }
        farthest = std::max(farthest, curve.distance());
        if (found.turns >= 2 && curve.distance() < returned * farthest) return found;   // a closed curve
        if (iterations <= few_corrections) step = std::min(1.5 * step, longest_arc);
    }
    return found;
}

}   // namespace livens::inline spacetime_internal
