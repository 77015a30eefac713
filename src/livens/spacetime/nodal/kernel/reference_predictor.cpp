// SPDX-License-Identifier: BSD-3-Clause
// Places of nodes as another motion on the same elements has them: shifts of centres of mass and quaternions
// R_0^T R from the start of the element on, interpolated where its degree is another (docs/theory.md, "The
// estimated error": the second solution follows the first).
#include "livens/spacetime/nodal/kernel/reference_predictor.h"

#include <algorithm>
#include <cmath>

#include "livens/dynamics/instant/instant.h"

namespace livens {

namespace {

/// Lower degrees say less than velocities and accelerations at the start do.
constexpr int lowest_known_degree = 3;

struct Quaternion {
    double s, v[3];
};

/// Of the turn R, column after column, from its largest number, so that none is a small difference.
Quaternion quaternion_of(const double* R)
{
    const double trace = R[0] + R[4] + R[8];
    int largest = 3;   // the scalar
    double most = trace;
    for (int i = 0; i < 3; ++i) {
        if (R[4 * i] <= most) continue;
        most = R[4 * i];
        largest = i;
    }
    const auto entry = [R](int row, int column) { return R[3 * column + row]; };
    Quaternion q{};
    if (largest == 3) {
        q.s = 0.5 * std::sqrt(1 + trace);
        const double by = 0.25 / q.s;
        for (int i = 0; i < 3; ++i)
            q.v[i] = by * (entry((i + 2) % 3, (i + 1) % 3) - entry((i + 1) % 3, (i + 2) % 3));
        return q;
    }
    const int i = largest, j = (i + 1) % 3, k = (i + 2) % 3;
    q.v[i] = 0.5 * std::sqrt(1 + entry(i, i) - entry(j, j) - entry(k, k));
    const double by = 0.25 / q.v[i];
    q.v[j] = by * (entry(i, j) + entry(j, i));
    q.v[k] = by * (entry(i, k) + entry(k, i));
    q.s = by * (entry(k, j) - entry(j, k));
    return q;
}

}   // namespace

ReferencePredictor::ReferencePredictor(const Motion& motion, const ModelTables& tables,
                                       const ElementRule& rule, const lanes::Functions& functions)
    : motion_(&motion), tables_(&tables), rule_(&rule), functions_(&functions)
{}

/// Of the motion's nodes at those of the rule.
void ReferencePredictor::weigh()
{
    degree_ = motion_->X.degree;
    const int W = functions_->width, p = rule_->degree;
    weights_.resize(static_cast<std::size_t>(W * (W + 1)));
    places_.resize(static_cast<std::size_t>(7 * W) * tables_->bodies.size());
    std::ranges::fill(weights_, 0.0);
    std::ranges::fill(places_, 0.0);
    const LagrangeBasis basis = motion_->X.basis();
    std::vector<double> values(static_cast<std::size_t>(degree_) + 1);
    for (int l = 0; l < W; ++l) {
        if (l >= p) {   // stands for no node
            weights_[W * W + l] = 1;
            continue;
        }
        basis.values(rule_->nodes[l == 0 ? p : l], values);
        for (int a = 0; a <= degree_; ++a) weights_[(a == 0 ? W : a) * W + l] = values[a];
    }
    for (std::size_t b = 0; b < tables_->bodies.size(); ++b) places_[(7 * b + 3) * W] = 1;   // its start
}

/// Nodes 1 .. degree of a body, from one end of an element, the last of them in its own lane.
void ReferencePredictor::follow_body(int body, int element, bool is_backwards, int last_lane, double* places)
{
    const int W = functions_->width;
    const BodyTable& of = tables_->bodies[body];
    const int stride = (is_backwards ? -1 : 1) * motion_->X.n_values;
    const double* X0 = motion_->X.coefficient(element, is_backwards ? degree_ : 0).data() +
                       static_cast<std::ptrdiff_t>(12 * body);
    Quaternion before{1, {}};
    for (int a = 1; a <= degree_; ++a) {
        const double* X = X0 + static_cast<std::ptrdiff_t>(a) * stride;
        double* place = places + (a == degree_ ? last_lane : a);
        for (int i = 0; i < 3; ++i) place[i * W] = X[i] - X0[i];
        if (of.dofs == 3) continue;
        for (int c = 0; of.offset && c < 3; ++c)
            for (int i = 0; i < 3; ++i) place[i * W] += of.center[c] * (X[3 + 3 * c + i] - X0[3 + 3 * c + i]);
        double R[9];
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r) {
                const double *d = X + 3 + 3 * c, *e = X0 + 3 + 3 * r;
                R[3 * c + r] = e[0] * d[0] + e[1] * d[1] + e[2] * d[2];
            }
        Quaternion q = quaternion_of(R);
        // q and -q are one turn; the sign goes on from node to node, so that numbers can be interpolated
        const double sign =
            q.s * before.s + q.v[0] * before.v[0] + q.v[1] * before.v[1] + q.v[2] * before.v[2];
        if (sign < 0) q = {-q.s, {-q.v[0], -q.v[1], -q.v[2]}};
        place[3 * W] = q.s;
        for (int i = 0; i < 3; ++i) place[(4 + i) * W] = q.v[i];
        before = q;
    }
}

bool ReferencePredictor::place(const WindowLayout& layout, double* place)
{
    if (motion_ == nullptr) return false;
    const int n_bodies = tables_->n_bodies(), W = functions_->width;
    // rational functions are not what weigh() interpolates, and there must be as many bodies
    if (!motion_->X.denominators.empty() || motion_->X.degree < lowest_known_degree ||
        motion_->X.n_values != 12 * n_bodies)
        return false;
    // its nodes are those that are asked for
    const bool is_alike = motion_->X.degree == rule_->degree && motion_->X.points == rule_->points;
    if (!is_alike && (motion_->X.points != Points::lobatto || motion_->X.degree >= W)) return false;
    const auto [start, end] = std::minmax(layout.times.front(), layout.times.back());
    const std::vector<double>& ends = motion_->mesh.ends;
    const auto found = std::ranges::lower_bound(ends, start);
    if (found == ends.end() || *found != start || found + 1 == ends.end() || *(found + 1) != end)
        return false;
    const int element = static_cast<int>(found - ends.begin());
    const bool is_backwards = layout.times.front() == end;
    if (is_alike) {   // also where there are as many nodes as lanes
        degree_ = rule_->degree;
        for (int i = 0; i < 7 * n_bodies; ++i) std::fill_n(place + i * W, W, i % 7 == 3 ? 1.0 : 0.0);
        for (int b = 0; b < n_bodies; ++b) follow_body(b, element, is_backwards, 0, place + 7 * b * W);
        return true;
    }
    if (degree_ != motion_->X.degree) weigh();
    for (int b = 0; b < n_bodies; ++b)
        follow_body(b, element, is_backwards, degree_, places_.data() + 7 * b * W);
    functions_->extrapolate(n_bodies, rule_->degree, places_.data(), weights_.data(), place);
    return true;
}

}   // namespace livens
