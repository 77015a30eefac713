// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/lobatto/bends.h"

#include <algorithm>
#include <limits>

namespace livens {

namespace {

/// Of an element's length: nearer to its start is where the one before ended, for a law bends there.
constexpr double behind_start = 1e-7;
/// Looks for each degree and one more: roots of the polynomials that lie nearer to each other are passed
/// over.
constexpr int looks_a_degree = 4;

}   // namespace

Bends::Bends(const Tables& tables, const ElementRule& rule) : tables_(tables)
{
    if (!tables.model->has_pieces()) return;
    for (std::size_t l = 0; l < tables.model->loads().size(); ++l)
        if (tables.model->loads()[l].piece) loads_.push_back(static_cast<int>(l));
    basis_ = basis_on(rule.points, rule.degree);
    values_.assign(rule.nodes.size(), 0.0);
    slopes_ = values_;
    X_.assign(12 * tables.bodies.size(), 0.0);
    V_ = X_;
}

Bends::Look Bends::look(const Stretch& stretch, const Nodes& nodes, double share, const Look& from)
{
    basis_->values(share, values_);
    basis_->derivatives(share, slopes_);
    std::copy_n(nodes.X(0), X_.size(), X_.begin());
    std::ranges::fill(V_, 0.0);
    for (int A = 1; A < basis_->size(); ++A)
        for (std::size_t i = 0; i < X_.size(); ++i) {
            X_[i] += values_[A] * nodes.dX(0, A)[i];
            V_[i] += slopes_[A] / stretch.h(0) * nodes.dX(0, A)[i];
        }
    Look look{share, {}, from.angles};
    tables_.turns.follow(Configurations(X_.data()), look.angles);
    const Instant at{stretch.times[0] + share * stretch.h(0), Side::middle};
    for (const int l : loads_) {
        const LoadArguments arguments = tables_.arguments(l, at, X_.data(), V_.data(), look.angles);
        look.pieces.push_back(tables_.model->loads()[l].piece(arguments));
    }
    return look;
}

LoadForces Bends::forces(const Stretch& stretch, const Nodes& nodes, int load, const Look& at)
{
    look(stretch, nodes, at.share, at);   // X_ and V_ there
    const Instant instant{stretch.times[0] + at.share * stretch.h(0), Side::middle};
    LoadForces F{};
    tables_.model->loads()[load].forces(tables_.arguments(load, instant, X_.data(), V_.data(), at.angles), F);
    return F;
}

int Bends::find_jump(const Stretch& stretch, const Nodes& nodes, const Look& before, const Look& after,
                     const Look& end)
{
    constexpr double jump = 1e-6;   // of the force where the look ends: at a bend it may be none
    for (std::size_t i = 0; i < loads_.size(); ++i) {
        if (before.pieces[i] == after.pieces[i]) continue;
        const LoadForces a = forces(stretch, nodes, loads_[i], before),
                         b = forces(stretch, nodes, loads_[i], after),
                         c = forces(stretch, nodes, loads_[i], end);
        for (std::size_t side = 0; side < 2; ++side)
            if (norm(b[side] - a[side]) > jump * std::max({norm(a[side]), norm(b[side]), norm(c[side])}))
                return loads_[i];
    }
    return -1;
}

double Bends::first(const Stretch& stretch, const Nodes& nodes, double until)
{
    Look start;
    start.angles = stretch.angles;
    Look before = look(stretch, nodes, behind_start, start);
    const std::vector<std::uint64_t> wanted = before.pieces;
    const int n = looks_a_degree * basis_->size();
    for (int i = 1; before.share < until; ++i) {
        Look after = look(stretch, nodes, std::min(static_cast<double>(i) / n, until), before);
        if (after.pieces == wanted) {
            before = std::move(after);
            continue;
        }
        const Look end = after;
        for (double middle = 0; middle = before.share + 0.5 * (after.share - before.share),
                    middle > before.share && middle < after.share;) {
            Look between = look(stretch, nodes, middle, before);
            (between.pieces == wanted ? before : after) = std::move(between);
        }
        jumping_ = find_jump(stretch, nodes, before, after, end);
        return after.share;
    }
    return std::numeric_limits<double>::infinity();
}

}   // namespace livens
