// SPDX-License-Identifier: BSD-3-Clause
// Gradients are sums over the numbers of a configuration, as in the march (dynamics/lanes/row_sums.h).
#include "livens/spacetime/nodal/rows_in_lanes.h"

#include <algorithm>
#include <iterator>

namespace livens {

namespace {

std::vector<int> quadratic_ones(const ModelTables& tables, const std::vector<int>& rows)
{
    std::vector<int> some;
    std::ranges::copy_if(rows, std::back_inserter(some), [&](int r) { return tables.rows[r].is_quadratic; });
    return some;
}

}   // namespace

/// `begin_` tells of each row where twists of its first body end, and where those of its second do. A row
/// that is no single form has none.
RowsInLanes::RowsInLanes(const ModelTables& tables, const std::vector<int>& rows, int n_nodes)
    : tables_(tables), rows_(rows), sums_(tables, quadratic_ones(tables, rows)),
      functions_(lanes::functions(std::min(n_nodes, 8)))
{
    begin_.push_back(0);
    int quadratic = 0;
    for (const int r : rows) {
        const int first = begin_.back();
        const int end = tables.rows[r].is_quadratic ? sums_.begin[++quadratic] : first;
        const BodyTable& body = tables.bodies[tables.rows[r].bodies[0]];
        const auto is_of_first = [&](int twist) {
            return twist >= body.first && twist < body.first + body.dofs;
        };
        const auto entry = sums_.twist.begin();
        begin_.push_back(static_cast<int>(std::find_if_not(entry + first, entry + end, is_of_first) - entry));
        begin_.push_back(end);
    }
    pattern_.n_bodies = tables.n_bodies();
    pattern_.n_twists = tables.n_twists;
    pattern_.n_rows = static_cast<int>(rows.size());
    pattern_.products = sums_.products.data();
    pattern_.n_products = static_cast<int>(sums_.products.size());
    pattern_.gradients.entries = sums_.entries.view();
    pattern_.n_entries = static_cast<int>(sums_.twist.size());
}

RowsInLanes::Workspace RowsInLanes::workspace() const
{
    const auto W = static_cast<std::size_t>(width());
    Workspace one;
    one.numbers.assign((12 * tables_.bodies.size() + sums_.products.size()) * W, 0.0);
    for (const double constant : sums_.entries.constants)
        one.gradients.insert(one.gradients.end(), W, constant);
    one.entries = one.gradients;
    one.scales.assign(rows_.size() * W, 1.0);
    return one;
}

void RowsInLanes::place(int lane, const double* X, Workspace& to) const
{
    const int W = width();
    double* x = to.numbers.data() + lane;
    for (const BodyTable& body : tables_.bodies) {
        for (int i = 0; i < 12; ++i) x[i * W] = X[i];
        for (int i = 0; body.offset && i < 3; ++i)
            x[i * W] += X[3 + i] * body.center[0] + X[6 + i] * body.center[1] + X[9 + i] * body.center[2];
        X += 12;
        x += 12 * W;
    }
}

void RowsInLanes::evaluate(Workspace& of) const
{
    lanes::Values nodes{};
    nodes.numbers = of.numbers.data();
    nodes.gradients = of.gradients.data();
    functions_->unit_rows(pattern_, nodes, {begin_.data(), of.entries.data(), of.scales.data()});
}

}   // namespace livens
