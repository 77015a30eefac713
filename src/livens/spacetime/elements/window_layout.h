// SPDX-License-Identifier: BSD-3-Clause
// The elements of a window, in the direction in which they are solved.
#pragma once

#include <cassert>
#include <cstddef>
#include <optional>
#include <vector>

#include "livens/spacetime/elements/rule.h"
#include "livens/time/time_mesh.h"

namespace livens::inline spacetime_internal {

/// Elements, or nodes, that a thread has at least where threads share a window: fewer are not worth waking
/// it.
inline constexpr int least_shared = 8;

/// Nodes 0..n of consecutive elements of degree p; element e spans nodes e p .. (e + 1) p. Where the state is
/// given at the end of time the elements are numbered, and their nodes lie, against time: all lengths are
/// negative then, and no equation changes (docs/theory.md, "Against time").
///
/// What is known at the ends says which nodes are unknown and which rows are active; inner nodes are both.
///
/// | known                        | unknown X | rows and multipliers | constraints |
/// | X and P at the first node    | 1..n      | 0..n-1               | 1..n        |
/// | X at both                    | 1..n-1    | 1..n-1               | 1..n-1      |
/// | X at the first, P at the last| 1..n      | 1..n                 | 1..n        |
/// | P at the first, X at the last| 0..n-1    | 0..n-1               | 0..n-1      |
/// | P at both                    | 0..n      | 0..n                 | 0..n        |
/// | X and P at the first, radau  | 1..n      | 1..n                 | 1..n        |
/// | components                   | 0..n      | 0..n                 | 0..n        |
struct WindowLayout {
    std::vector<double> times;    ///< element ends
    std::vector<double> angles;   ///< of loads at the first node, or about there; see Turns
    int degree = 1;
    Points points = Points::lobatto;   ///< radau: one element, whose state is known at the first node
    bool X_first = true, P_first = true, X_last = false, P_last = false;
    bool are_momenta_unknown = false;   ///< those at both ends; conditions by component are rows instead
    int n_numbers = 0;                  ///< of the model that are unknown beside them
    /// Of a part of time that one of several ranks has: its rows of conditions, and unknowns that join two
    /// rows of one condition.
    struct Part {
        int n_closing = 0, n_joins = 0;
        bool operator==(const Part&) const = default;
    };
    std::optional<Part> part{};

    int n_elements() const { return static_cast<int>(times.size()) - 1; }
    int n_nodes() const { return n_elements() * degree + 1; }
    double h(int e) const { return times[e + 1] - times[e]; }
    bool is_unknown(int A) const { return !(A == 0 && X_first) && !(A == n_nodes() - 1 && X_last); }
    bool is_active(int A) const
    {
        const bool is_radau = points == Points::radau;
        return A == 0 ? P_first && !is_radau : P_last || is_radau || A != n_nodes() - 1;
    }
    /// All is known at the first node: the equations are block triangular over elements.
    bool is_march() const { return X_first && P_first; }
    /// The first and last element that node A belongs to.
    int first_element(int A) const { return A == 0 ? 0 : (A - 1) / degree; }
    int last_element(int A) const { return A == n_nodes() - 1 ? n_elements() - 1 : A / degree; }
    double time(const ElementRule& rule, int A) const
    {
        const int e = first_element(A), a = A - e * degree;
        return a == 0 ? times[e] : a == degree ? times[e + 1] : times[e] + rule.nodes[a] * h(e);
    }
    /// The instant of load point c of element e, seen from inside the element.
    Instant load_point(const ElementRule& rule, int e, int c) const
    {
        if (rule.loads.points[c] == 1) return {times[e + 1], Side::left};
        return {times[e] + rule.loads.points[c] * h(e), Side::middle};
    }
    std::vector<Instant> load_points(const ElementRule& rule, int e) const
    {
        std::vector<Instant> instants;
        for (int c = 0; c < degree; ++c) instants.push_back(load_point(rule, e, c));
        return instants;
    }
    /// Quadrature weight of node A: the sum of h w over its elements.
    double weight(const ElementRule& rule, int A) const
    {
        double sum = 0;
        for (int e = first_element(A); e <= last_element(A); ++e) sum += h(e) * rule.weights[A - e * degree];
        return sum;
    }
};

}   // namespace livens::inline spacetime_internal
