// SPDX-License-Identifier: BSD-3-Clause
// The problems that speed is measured on, shared by the timed, the counted and the plotted programs.
#pragma once

#include <string>
#include <vector>

#include "livens/dynamics/start/prepared.h"
#include "livens/multibody/model.h"
#include "livens/spacetime/solve.h"

namespace livens::benchmarks {

/// Two cubes on rods of 4 m between their centres (the paper's first double pendulum): they never rotate.
Model centred_double_pendulum();

/// Two bricks on ball joints, released at rest: P16 of the literature list in docs/examples.md.
Model two_bricks();

/// A problem, its discretisation, and what is known of its end.
struct Kernel {
    std::string name;
    Model model;
    TimeMesh mesh;
    Method method;
    int body = 0;               ///< whose material point is compared
    Vector3 point{};            ///< body coordinates
    Vector3 reference{};        ///< where it is at the end, m
    double largest_error = 0;   ///< m; more means that something else was measured
    double tolerance = 1e-12;
    std::shared_ptr<Prepared> prepared = std::make_shared<Prepared>();
};

/// The four kernels with a bound on their instructions.
///
///     linear_element   lobatto(1), 1000 elements of 1 ms, centred pendulum: an element of two bodies
///     centred_6        lobatto(6), 100 elements to 10 s, centred pendulum
///     bricks_6         lobatto(6), h = 0.025 to 2 s, two bricks
///     bricks_8         lobatto(8), likewise
std::vector<Kernel> counted_kernels();

/// Two bricks to 2 s with any method and number of elements.
Kernel bricks_kernel(const std::string& name, const Method& method, int n_elements);

/// Bricks of 1 m, of which the first hangs on the world: "balls" in a zigzag from rest, "hinges" likewise,
/// each across the one before, whirling at 1 rad/s (both as in benchmarks/peers/problems.py), a flat "ring"
/// from rest on balls.
Model brick_chain(int n, const std::string& kind);

/// lobatto(8) on elements of 3.5 to 15 ms, which take three steps at most: what a body and an element cost.
Kernel chain_kernel(int n, const std::string& kind, int n_elements);

Solution run(const Kernel& kernel);

/// Distance (m) of the compared point from its reference at the end; infinite if the solution failed.
double error(const Kernel& kernel, const Solution& solution);

}   // namespace livens::benchmarks
