// SPDX-License-Identifier: BSD-3-Clause
// Looks at laws as lanes: X and X' of the element's polynomials at all shares, and what is recorded of the
// laws there, some shares after the other, since angles count their turns along the way
// (docs/theory.md, "Looks at laws").
#include "livens/spacetime/nodal/laws/looks_in_lanes.h"

#include <algorithm>
#include <cmath>

#include "livens/dynamics/lanes/load_program.h"
#include "livens/multibody/model.h"
#include "livens/spacetime/elements/kernel_functions.h"
#include "livens/spacetime/nodal/nodes.h"

namespace livens {

LooksInLanes::LooksInLanes(const ModelTables& tables, const ElementRule& rule, RecordedLoads what,
                           std::vector<double> shares)
    : tables_(tables), rule_(rule), what_(what), functions_(lanes::functions(rule.degree)),
      lanes_(tables, functions_->loads->run, functions_->width, functions_->width, what), all_(shares),
      first_(tables.model->loads().size(), -1)
{
    std::vector<double> points;
    if (what == RecordedLoads::laws) points = rule.loads.points;
    all_.insert(all_.end(), points.begin(), points.end());
    std::ranges::sort(all_);
    const auto place = [this](double share) {
        return static_cast<std::size_t>(std::ranges::lower_bound(all_, share) - all_.begin());
    };
    std::ranges::transform(shares, std::back_inserter(at_shares_), place);
    std::ranges::transform(points, std::back_inserter(at_points_), place);
    collect_laws();
    if (seen_.empty()) return;
    start_.assign(12 * tables.bodies.size() + 3, 0.0);
    increments_.assign(12 * tables.bodies.size() * static_cast<std::size_t>(lanes_.width()), 0.0);
    weigh();
}

void LooksInLanes::collect_laws()
{
    int n_numbers = 0;
    for (std::size_t l = 0; l < first_.size(); ++l) {
        const auto [first, second] = watched(static_cast<int>(l));
        if (first->empty() && second->empty()) continue;
        first_[l] = n_numbers;
        n_numbers += static_cast<int>(first->size() + second->size());
        for (const int body : tables_.model->loads()[l].bodies)
            if (body != world && std::ranges::find(bodies_, body) == bodies_.end()) bodies_.push_back(body);
    }
    seen_.resize(static_cast<std::size_t>(n_numbers) * all_.size());
}

/// The element's basis at all shares: for each batch of them and each node, whose lane is that of a column, a
/// row.
void LooksInLanes::weigh()
{
    const auto W = static_cast<std::size_t>(lanes_.width());
    const std::size_t n_batches = (all_.size() + W - 1) / W, n_nodes = rule_.nodes.size();
    weights_.M.assign(n_batches * W * W, 0.0);
    weights_.slopes = weights_.dM = weights_.M;
    const LagrangeBasis basis = basis_on(rule_.points, rule_.degree);
    std::vector<double> values(n_nodes), slopes(n_nodes);
    for (std::size_t i = 0; i < n_batches; ++i)
        for (std::size_t l = 0; l < W; ++l) {   // lanes behind the last share are as this one
            const double share = all_[std::min(W * i + l, all_.size() - 1)];
            basis.values(share, values);
            basis.derivatives(share, slopes);
            for (std::size_t B = 1; B < n_nodes; ++B) {
                const std::size_t lane = B + 1 == n_nodes ? 0 : B;
                weights_.M[(i * W + lane) * W + l] = values[B];
                weights_.slopes[(i * W + lane) * W + l] = slopes[B];
            }
        }
}

std::array<const std::vector<int>*, 2> LooksInLanes::watched(int load) const
{
    return watched_of(lanes_.program().tape().watched()[static_cast<std::size_t>(load)], what_);
}

/// Of a body about its centre of mass, X at the first node and what it has moved by at the others.
void LooksInLanes::gather(int b, const WindowLayout& layout, const NodePositions& nodes, int e)
{
    const int W = lanes_.width();
    const BodyTable& body = tables_.bodies[b];
    const auto to_centre = [&](double* x, int stride) {
        for (int a = 0; body.offset && a < 3; ++a)
            for (int i = 0; i < 3; ++i) x[i * stride] += body.center[a] * x[(3 + 3 * a + i) * stride];
    };
    std::copy_n(nodes.X(e * layout.degree) + 12 * b, 12, start_.data() + 12 * b);
    to_centre(start_.data() + 12 * b, 1);
    for (int B = 1; B <= layout.degree; ++B) {
        double* to = increments_.data() + 12 * b * W + (B == layout.degree ? 0 : B);
        for (int i = 0; i < 12; ++i) to[i * W] = nodes.dX(e, B)[12 * b + i];
        to_centre(to, W);
    }
}

/// What the lanes have found, into its place.
void LooksInLanes::keep(std::size_t first)
{
    const std::size_t n = std::min(static_cast<std::size_t>(lanes_.width()), all_.size() - first);
    for (std::size_t l = 0; l < first_.size(); ++l) {
        if (first_[l] < 0) continue;
        double* to = seen_.data() + static_cast<std::size_t>(first_[l]) * all_.size() + first;
        for (const std::vector<int>* places : watched(static_cast<int>(l)))
            for (const int place : *places) {
                std::copy_n(lanes_.number(place), n, to);
                to += all_.size();
            }
    }
}

/// Width by width along the way; angles go on from the last share of one batch to the next.
void LooksInLanes::look(const WindowLayout& layout, const NodePositions& nodes, int e,
                        std::span<const double> angles)
{
    if (seen_.empty()) return;
    turns_.assign(angles.begin(), angles.end());
    const auto W = static_cast<std::size_t>(lanes_.width());
    if (const double h = layout.h(e); h != weights_.h) {
        weights_.h = h;
        for (std::size_t i = 0; i < weights_.dM.size(); ++i) weights_.dM[i] = weights_.slopes[i] / h;
    }
    for (const int b : bodies_) gather(b, layout, nodes, e);
    std::vector<Instant> instants(W);
    for (std::size_t first = 0; first < all_.size(); first += W) {
        for (std::size_t l = 0; l < W; ++l) {
            const double share = all_[std::min(first + l, all_.size() - 1)];
            instants[l] = {layout.times[e] + share * weights_.h, Side::middle};
        }
        lanes_.begin(instants);
        functions_->loads->interpolate_arms(lanes_.view(), start_.data(), increments_.data(),
                                            weights_.M.data() + first * W, weights_.dM.data() + first * W);
        lanes_.go_on(turns_);
        keep(first);
    }
}

/// Numbers of a law stand one behind the other, those of watched()[0] first, each at all shares and points.
void LooksInLanes::take(int load, std::size_t which, std::size_t look, double* out) const
{
    const auto of = watched(load);
    const std::size_t first = static_cast<std::size_t>(first_[load]) + (which == 0 ? 0 : of[0]->size());
    for (std::size_t k = 0; k < of[which]->size(); ++k) out[k] = seen_[(first + k) * all_.size() + look];
}

void LooksInLanes::numbers(int load, std::span<const double> values, std::span<double> out) const
{
    const std::size_t n = watched(load)[0]->size(), size = at_shares_.size();
    for (std::size_t A = 0; A < values.size() / size; ++A)
        for (std::size_t k = 0; k < n; ++k) {
            const double* seen = seen_.data() + (static_cast<std::size_t>(first_[load]) + k) * all_.size();
            double sum = 0;
            for (std::size_t i = 0; i < size; ++i) sum += values[A * size + i] * seen[at_shares_[i]];
            out[n * A + k] = sum;
        }
}

}   // namespace livens
