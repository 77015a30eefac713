// SPDX-License-Identifier: BSD-3-Clause
// Orders of convergence: meshes, errors, rates.
#pragma once

#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "mechanisms.h"

namespace livens::tests {

/// A figure that a test has found, for those who ask for its output (ctest -V).
inline void tell(const std::string& what, double value)
{
    std::cout << "    " << what << ": " << value << '\n';
}

/// Errors at the end of a motion for meshes of n equal elements, each at most 1.25 times as fine as the one
/// before.
struct Study {
    std::vector<int> n;
    std::vector<Distance> error;
};

/// `error(n)` for every mesh.
inline Study study(const std::vector<int>& n, const std::function<Distance(int)>& error)
{
    Study s{n, {}};
    for (int elements : n) s.error.push_back(error(elements));
    for (std::size_t i = 1; i < n.size(); ++i) EXPECT_LE(n[i], 1.25 * n[i - 1]) << "refined too coarsely";
    return s;
}

/// The meshes whose error is above the floor, from the first on.
inline std::size_t n_above(const Study& s, double Distance::*part, double floor)
{
    std::size_t k = 0;
    while (k < s.n.size() && s.error[k].*part > floor) ++k;
    return k;
}

/// log(e1 / e2) / log(n2 / n1) of the last two errors above the floor.
inline double last_rate(const Study& s, double Distance::*part, double floor)
{
    const std::size_t k = n_above(s, part, floor);
    if (k < 2) return 0;
    return std::log(s.error[k - 2].*part / (s.error[k - 1].*part)) / std::log(1.0 * s.n[k - 1] / s.n[k - 2]);
}

/// Slope of the straight line through (log n, -log e) of all errors above the floor, by least squares.
inline double slope(const Study& s, double Distance::*part, double floor)
{
    const std::size_t k = n_above(s, part, floor);
    double x = 0, y = 0, xx = 0, xy = 0;
    for (std::size_t i = 0; i < k; ++i) {
        const double u = std::log(s.n[i]), v = -std::log(s.error[i].*part);
        x += u;
        y += v;
        xx += u * u;
        xy += u * v;
    }
    const double m = static_cast<double>(k);
    return k < 2 ? 0 : (m * xy - x * y) / (m * xx - x * x);
}

/// The motion to the end by a method of degree 12, good to `floor`: another degree and mesh must agree with
/// it so well.
struct Fine {
    State end;
    Distance floor;
};
inline Fine fine(const Model& model, double end, int n)
{
    Fine f{last(solve_evenly(model, end, n, 12)), {}};
    f.floor = distance(f.end, last(solve_evenly(model, end, n + n / 2, 10)));
    return f;
}

/// The study of lobatto(p) against a fine motion.
inline Study lobatto_study(const Model& model, double end, const Fine& reference, int degree,
                           const std::vector<int>& n)
{
    return study(n, [&](int elements) {
        return distance(last(solve_evenly(model, end, elements, degree)), reference.end);
    });
}

/// Neither divided nor judged.
inline SolveOptions undivided()
{
    SolveOptions options;
    options.divide = options.judge = false;
    return options;
}

/// The study of radau(p) against the end of another motion.
inline Study radau_study(const Model& model, double end, const State& reference, int degree,
                         const std::vector<int>& n)
{
    return study(n, [&](int elements) {
        const Solution s =
            solve(model, {model.start()}, make_time_mesh(0, end, elements), Radau{degree}, undivided());
        EXPECT_TRUE(s.report.converged()) << s.report.message;
        return distance(last(s), reference);
    });
}

}   // namespace livens::tests
