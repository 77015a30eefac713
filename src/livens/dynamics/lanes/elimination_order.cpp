// SPDX-License-Identifier: BSD-3-Clause
// Who is coupled is kept as lists, which are filled in as nodes go: elimination couples all neighbours of a
// node with each other (docs/theory.md, "Without a tangent", Elimination).
#include "livens/dynamics/lanes/elimination_order.h"

#include <functional>
#include <queue>
#include <utility>

namespace livens::inline dynamics_internal {

namespace {

using Neighbours = std::vector<std::vector<int>>;

/// Of each node the others that share a thing with it, each once.
Neighbours coupled(const Neighbours& things_of, int n_things)
{
    Neighbours nodes_at(n_things), beside(things_of.size());
    for (int node = 0; node < std::ssize(things_of); ++node)
        for (const int thing : things_of[node]) nodes_at[thing].push_back(node);
    std::vector<int> seen(things_of.size(), -1);   // by which node last
    for (int node = 0; node < std::ssize(things_of); ++node) {
        seen[node] = node;
        for (const int thing : things_of[node])
            for (const int other : nodes_at[thing])
                if (std::exchange(seen[other], node) != node) beside[node].push_back(other);
    }
    return beside;
}

}   // namespace

std::vector<int> order_of_least_degree(const Neighbours& things_of, int n_things,
                                       const std::vector<int>& sizes)
{
    Neighbours beside = coupled(things_of, n_things);
    const auto degree = [&](int node) {
        int sum = 0;
        for (const int other : beside[node]) sum += sizes[other];
        return sum;
    };
    using Waiting = std::pair<int, int>;   // a node stands there with each degree that it had
    std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> waiting;
    const int n = static_cast<int>(beside.size());
    std::vector<int> degrees(n), order, seen(n, -1);
    for (int node = 0; node < n; ++node) waiting.emplace(degrees[node] = degree(node), node);
    std::vector<bool> is_done(n, false);
    int mark = 0;
    while (!waiting.empty()) {
        const auto [known, node] = waiting.top();
        waiting.pop();
        // Degrees change as neighbours go; of the entries of a node the one with its last degree counts.
        if (is_done[node] || known != degrees[node]) continue;
        is_done[node] = true;
        order.push_back(node);
        for (const int s : beside[node]) {   // is now coupled to all others that were coupled to it
            std::erase(beside[s], node);
            seen[s] = ++mark;
            for (const int other : beside[s]) seen[other] = mark;
            for (const int other : beside[node])
                if (std::exchange(seen[other], mark) != mark) beside[s].push_back(other);
            if (const int now = degree(s); now != degrees[s]) waiting.emplace(degrees[s] = now, s);
        }
    }
    return order;
}

}   // namespace livens::inline dynamics_internal
