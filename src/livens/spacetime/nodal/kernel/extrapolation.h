// SPDX-License-Identifier: BSD-3-Clause
// Guesses for an element of a march from the one before it, whose polynomial goes on.
#pragma once

#include <cmath>
#include <vector>

#include "livens/dynamics/lanes/aligned_doubles.h"
#include "livens/spacetime/elements/kernel_functions.h"
#include "livens/spacetime/elements/rule.h"
#include "livens/time/basis.h"

namespace livens::inline spacetime_internal {

/// Places of nodes as lanes::Values has them: of each body the shift of its centre and the quaternion that
/// turns it from the start of the element, 7 numbers, each for all nodes in lanes; lane 0 is the end of the
/// element, and lane l the node l.
class Extrapolation {
public:
    Extrapolation() = default;
    Extrapolation(const ElementRule& rule, const lanes::Functions& functions);

    /// Whether there is anything to gain: low degrees say less than velocities and accelerations do.
    bool serves() const { return degree_ >= 4; }
    /// An element that was solved; its places must stay as they are.
    void remember(const double* place, int n_bodies, double start, double end);
    /// Whether an element of length h that begins at `start` follows what was remembered, and is not so much
    /// longer that the polynomial says nothing of it.
    bool follows(double start, double h) const
    {
        constexpr double longest = 3;
        return serves() && places_ != nullptr && start == end_ && std::abs(h) <= longest * std::abs(h_);
    }
    void forget() { places_ = nullptr; }
    /// Nodes of the element that follows, if it has the length h.
    void place(double h, double* place);

private:
    void weigh(double ratio);

    int degree_ = 0;
    const lanes::Functions* functions_ = nullptr;
    std::vector<double> nodes_;    // of the rule
    std::vector<int> used_;        // those that the polynomial goes through
    LagrangeBasis basis_{{0.0}};   // on them
    const double* places_ = nullptr;
    int n_bodies_ = 0;
    double end_ = 0, h_ = 0;
    double ratio_ = 0;         // of lengths, for which the weights below are
    AlignedDoubles weights_;   // of lane l of what is remembered (last: its start), row by row of lanes
};

}   // namespace livens::inline spacetime_internal
