// SPDX-License-Identifier: BSD-3-Clause
// What the tests of the elements `mixed` solve again and again, and how far it is from the truth.
#pragma once

#include "mechanisms.h"

namespace livens::tests {

// The words that choose, as scenarios spell them.
inline constexpr auto natural = Mixed::Start::natural;
inline constexpr auto strong = Mixed::Start::strong;
inline constexpr auto equal = Mixed::Multipliers::equal;
inline constexpr auto lower = Mixed::Multipliers::lower;
inline constexpr auto zero = Mixed::EndMultiplier::zero;
inline constexpr auto lagrange = Mixed::Basis::lagrange;
inline constexpr auto bspline = Mixed::Basis::bspline;
inline constexpr auto nurbs = Mixed::Basis::nurbs;

struct Pairing {
    Mixed::Basis basis = Mixed::Basis::lagrange;
    int degree = 1;
    Mixed::Start start = Mixed::Start::natural;
    Mixed::Multipliers multipliers = Mixed::Multipliers::equal;
    Mixed::EndMultiplier end_multiplier = Mixed::EndMultiplier::smooth;
};

inline Mixed mixed(const Pairing& pairing)
{
    Mixed method;
    method.basis = pairing.basis;
    method.degree = pairing.degree;
    method.start = pairing.start;
    method.multipliers = pairing.multipliers;
    method.end_multiplier = pairing.end_multiplier;
    return method;
}

/// Directors at 1 s of free_box(), by another formulation and another program: reference.json beside the
/// tests of tests/reference, free_box_constant_torque; they are good to 6e-13.
inline constexpr Matrix3 box_at_one_second{0.7978044728981125,  0.5152634957366052,  -0.3130679686347035,
                                           0.08821441839305263, 0.41390924139082147, 0.9060338604482853,
                                           0.5964278995916737,  -0.7504549752333888, 0.2847649745598858};

/// Sum of the norms of position and directors less the true ones (P26).
inline double box_error(const State& state)
{
    double error = norm(state.X[0].column(0));
    for (int i = 0; i < 3; ++i) error += norm(state.X[0].column(i + 1) - box_at_one_second.column(i));
    return error;
}

inline Solution solve_mixed_evenly(const Model& model, double end, int n, const Mixed& method,
                                   double tolerance = 1e-13)
{
    SolveOptions options;
    options.tolerance = tolerance;
    options.estimate = SolveOptions::Estimate::none;   // coarse on purpose; see convergence/mixed_estimates
    // Collocation at so few points leaves momenta at inner element ends that are none: it would be suspect.
    options.judge = method.gauss_points != method.degree;
    Solution solution = solve(model, {model.start()}, make_time_mesh(0, end, n), method, options);
    EXPECT_TRUE(solution.report.converged()) << name_of(method) << ": " << solution.report.message;
    return solution;
}

/// Angular momentum about the world's origin at an element end, of the momenta handed on.
inline Vector3 angular_momentum_at(const Motion& motion, int end)
{
    const State state = motion.at_end(end);
    Vector3 sum{};
    for (int b = 0; b < motion.n_bodies; ++b)
        for (int c = 0; c < 4; ++c)
            sum += cross(state.X[b].column(c), motion.momenta[end * motion.n_bodies + b].column(c));
    return sum;
}

}   // namespace livens::tests
