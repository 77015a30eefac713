// SPDX-License-Identifier: BSD-3-Clause
// A spanning tree of the joints, and what eliminating bodies from its leaves on couples: loads between bodies
// that no joint couples, and joints that close loops (docs/theory.md, "Without a tangent", Stiff loads).
#include "livens/spacetime/nodal/kernel/tree_plan.h"

#include <algorithm>
#include <span>
#include <utility>

#include "livens/multibody/model.h"

namespace livens {

namespace {

/// The bodies that a group of rows has twists of, ascending.
std::vector<int> bodies_of(const ModelTables& tables, const lanes::Pattern& p, const lanes::Group& group)
{
    std::vector<char> twists(static_cast<std::size_t>(p.n_twists), 0);
    for (int r = group.first; r < group.first + group.n; ++r)
        for (int u = p.gradients.unit_begin[r]; u < p.gradients.unit_begin[r + 1]; ++u)
            twists[static_cast<std::size_t>(p.gradients.units[u].twist)] = 1;
    for (int c = group.columns; c < (&group)[1].columns; ++c)
        twists[static_cast<std::size_t>(p.gradients.columns[c].twist)] = 1;
    std::vector<int> bodies;
    for (int b = 0; b < tables.n_bodies(); ++b) {
        const BodyTable& body = tables.bodies[b];
        const auto first = twists.begin() + body.first;
        if (std::any_of(first, first + body.dofs, [](char is_in) { return is_in; })) bodies.push_back(b);
    }
    return bodies;
}

/// act(body, body) for whose forces turn with each other: a function of a few forms has a slope by all of
/// their bodies, so that a coupling of many joints does not tie all of them to each other.
template <typename Act>
void for_each_slope(const ConstraintRow& row, const Act& act)
{
    act(row.body_i, row.body_j);
    for_each_function(row, [&](const SmoothFunction& F, std::size_t first) {
        const auto forms = std::span(row.coordinates).subspan(first, F.n);
        for (const PairForm& one : forms)
            for (const PairForm& other : forms)
                for (const int b : {one.body_i, one.body_j})
                    for (const int c : {other.body_i, other.body_j}) act(b, c);
    });
}

void add_once(std::vector<int>& to, int what)
{
    if (std::ranges::find(to, what) == to.end()) to.push_back(what);
}

}   // namespace

TreePlan::TreePlan(const ModelTables& tables, const RowPattern& pattern)
{
    std::vector<JointRows> joints;
    collect(tables, pattern, joints);
    grow(tables.n_bodies(), joints);
    insert_loops(tables);
    couple(tables, pattern);
}

/// Groups between the same bodies are one joint.
void TreePlan::collect(const ModelTables& tables, const RowPattern& pattern, std::vector<JointRows>& joints)
{
    const lanes::Pattern& p = pattern.view();
    for (int g = 0; g < p.n_groups; ++g) {
        const lanes::Group& group = p.groups[g];
        std::vector<int> bodies = bodies_of(tables, p, group);
        while (bodies.size() < 2) bodies.insert(bodies.begin(), world);
        auto joint = std::ranges::find(joints, bodies, &JointRows::bodies);
        if (joint == joints.end()) joint = joints.insert(joint, {bodies, {}});
        for (int r = group.first; r < group.first + group.n; ++r) joint->rows.push_back(r);
    }
}

/// A spanning tree from the world, and from a body of each part that floats.
void TreePlan::grow(int n_bodies, std::vector<JointRows>& joints)
{
    const auto n = static_cast<std::size_t>(n_bodies);
    parent.assign(n, world);
    held.assign(n, {});
    std::vector<char> is_reached(n, 0), is_used(joints.size(), 0);
    const auto reach_from = [&](std::vector<int> front) {
        for (std::size_t at = 0; at < front.size(); ++at)
            for (std::size_t j = 0; j < joints.size(); ++j) {
                const int a = joints[j].bodies[0], b = joints[j].bodies[1];
                if (is_used[j] || joints[j].bodies.size() > 2 || (a != front[at] && b != front[at])) continue;
                const int next = a == front[at] ? b : a;
                if (next == world || is_reached[static_cast<std::size_t>(next)]) continue;
                is_used[j] = is_reached[static_cast<std::size_t>(next)] = 1;
                parent[static_cast<std::size_t>(next)] = front[at];
                held[static_cast<std::size_t>(next)] = joints[j];
                front.push_back(next);
            }
        order.insert(order.end(), front.begin() + (front[0] == world ? 1 : 0), front.end());
    };
    reach_from({world});
    for (int b = 0; b < n_bodies; ++b) {
        if (is_reached[static_cast<std::size_t>(b)]) continue;
        is_reached[static_cast<std::size_t>(b)] = 1;
        reach_from({b});
    }
    std::ranges::reverse(order);
    for (std::size_t j = 0; j < joints.size(); ++j)
        if (!is_used[j]) closing.push_back(std::move(joints[j]));
}

/// The bodies whose freedoms tell the rows of a loop apart: those between its ends, but not the one where it
/// closes, with which they move alike; of a coupling all down to the root. The point of a rotor, which is in
/// no other joint, does so alone.
std::vector<int> TreePlan::inside(const JointRows& loop, const ModelTables& tables) const
{
    std::vector<int> passed(parent.size(), 0), bodies;
    for (const int end : loop.bodies) {
        if (is_point_of_rotors(tables, end)) return {end};
        for (int b = end; b != world; b = parent[static_cast<std::size_t>(b)])
            ++passed[static_cast<std::size_t>(b)];
    }
    const int all = loop.bodies.size() == 2 ? 2 : 0;   // ways that go on together where it closes
    for (int b = 0; b < static_cast<int>(passed.size()); ++b)
        if (passed[static_cast<std::size_t>(b)] > 0 && passed[static_cast<std::size_t>(b)] != all)
            bodies.push_back(b);
    return bodies;
}

/// Rotors first, and each loop as soon as all that is inside of it is gone: so it couples no more than that.
void TreePlan::insert_loops(const ModelTables& tables)
{
    std::stable_partition(order.begin(), order.end(), [&](int b) { return is_point_of_rotors(tables, b); });
    const int n = tables.n_bodies();
    parent.resize(parent.size() + closing.size(), world);
    for (int k = 0; k < static_cast<int>(closing.size()); ++k) {
        auto behind = order.begin();
        for (const int b : inside(closing[static_cast<std::size_t>(k)], tables))
            behind = std::max(behind, std::ranges::find(order, b) + 1);
        while (behind != order.end() && *behind >= n) ++behind;
        order.insert(behind, n + k);
    }
}

/// What elimination fills in. The axes of a rotor's point know nothing of each other.
void TreePlan::couple(const ModelTables& tables, const RowPattern& pattern)
{
    const int n = tables.n_bodies();
    std::vector<std::vector<int>> neighbours(parent.size());
    const auto pair_up = [&](int a, int b) {
        if (a == b || a == world || b == world) return;
        add_once(neighbours[static_cast<std::size_t>(a)], b);
        add_once(neighbours[static_cast<std::size_t>(b)], a);
    };
    for (const int l : tables.loads.with_tangent)
        for (const int a : tables.model->loads()[l].bodies)
            for (const int b : tables.model->loads()[l].bodies) pair_up(a, b);
    for (std::size_t j = 0; j < closing.size(); ++j) {
        for (const int place : closing[j].rows)
            for_each_slope(*tables.rows[pattern.rows()[static_cast<std::size_t>(place)]].row, pair_up);
        for (const int b : closing[j].bodies) pair_up(b, n + static_cast<int>(j));
    }
    coupled.assign(parent.size(), {});
    std::vector<char> is_gone(parent.size(), 0);
    for (const int b : order) {
        std::vector<int>& later = coupled[static_cast<std::size_t>(b)];
        const int above = parent[static_cast<std::size_t>(b)];
        if (above != world) later.push_back(above);
        for (const int other : neighbours[static_cast<std::size_t>(b)])
            if (!is_gone[static_cast<std::size_t>(other)]) add_once(later, other);
        is_gone[static_cast<std::size_t>(b)] = 1;
        if (is_point_of_rotors(tables, b)) continue;
        for (const int one : later)
            for (const int other : later) pair_up(one, other);
    }
}

bool spacetime_internal::is_point_of_rotors(const ModelTables& tables, int unknown)
{
    return unknown != world && unknown < tables.n_bodies() &&
           tables.model->bodies()[static_cast<std::size_t>(unknown)].is_rotor;
}

}   // namespace livens
