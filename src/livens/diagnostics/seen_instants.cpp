// SPDX-License-Identifier: BSD-3-Clause
// Instants that show a motion as it is: close together, and twice where it jumps.
#include <algorithm>
#include <cmath>

#include "livens/diagnostics/quantities.h"

namespace livens {

namespace {

/// Elements end there with other accelerations or reactions than they begin with.
bool jumps_at(const Motion& motion, int end)
{
    const auto differ = [](const double* before, const double* after, std::size_t n) {
        double largest = 0, jump = 0;
        for (std::size_t i = 0; i < n; ++i) {
            largest = std::max({largest, std::abs(before[i]), std::abs(after[i])});
            jump = std::max(jump, std::abs(after[i] - before[i]));
        }
        return jump > 1e-9 * largest;
    };
    const std::size_t e = 2 * static_cast<std::size_t>(end), n = static_cast<std::size_t>(motion.n_bodies),
                      n_rows = static_cast<std::size_t>(motion.n_rows);
    const double *const A = motion.accelerations.data()->data(), *const L = motion.end_multipliers.data();
    if (!motion.accelerations.empty() && differ(A + 12 * e * n, A + 12 * (e + 1) * n, 12 * n)) return true;
    return !motion.end_multipliers.empty() && differ(L + e * n_rows, L + (e + 1) * n_rows, n_rows);
}

}   // namespace

std::vector<SeenInstant> dense_instants(const Motion& motion)
{
    constexpr int over_all = 600;
    const int n = motion.n_elements();
    std::vector<SeenInstant> all{{motion.start()}};
    const int parts = n > 0 ? std::max(motion.X.degree + 1, (over_all + n - 1) / n) : 1;
    for (int e = 0; e < n; ++e) {
        const double begin = motion.mesh.ends[static_cast<std::size_t>(e)], h = motion.mesh.length(e);
        for (int i = 1; i < parts; ++i) all.push_back({begin + h * i / parts});
        const double end = motion.mesh.ends[static_cast<std::size_t>(e) + 1];
        if (e + 1 == n || jumps_at(motion, e + 1)) all.push_back({end, Side::left});
        if (e + 1 < n) all.push_back({end});
    }
    return all;
}

std::vector<SeenInstant> end_instants(const Motion& motion)
{
    std::vector<SeenInstant> all;
    for (const double t : motion.mesh.ends) all.push_back({t});
    if (motion.n_elements() > 0) all.back().side = Side::left;
    return all;
}

}   // namespace livens
