// X and its derivative at fixed places of every element.
#pragma once

#include <span>
#include <vector>

#include "livens/base/linear.h"
#include "livens/multibody/motion.h"

namespace livens {

/// Evaluates a motion's polynomial at the same local points s of each element; the basis is tabulated once,
/// so that a point costs (degree + 1) sums over the bodies and allocates nothing.
class ElementSampler {
public:
    /// The motion must outlive the sampler.
    ElementSampler(const Motion& motion, std::vector<double> points);

    int size() const { return static_cast<int>(points_.size()); }
    double point(int k) const { return points_[k]; }
    /// t of point k; at the element's ends to the bit, and from the element's side.
    Instant instant(int element, int k) const;

    /// X of all bodies at point k; at a node its coefficient to the bit.
    void positions(int element, int k, std::span<Matrix34> X) const;
    /// Derivative of the polynomial by time, also at the element's ends.
    void velocities(int element, int k, std::span<Matrix34> V) const;

private:
    const Motion& motion_;
    std::vector<double> points_;
    std::vector<int> nodes_;            // the node that a point is, or -1
    std::vector<double> values_;        // M_A(s_k) at [k * (degree + 1) + A]
    std::vector<double> derivatives_;   // M_A'(s_k) likewise
};

/// X of all bodies at element end number `end`.
void positions_at_end(const Motion& motion, int end, std::span<Matrix34> X);
/// V of all bodies there, from the momentum.
std::span<const Matrix34> velocities_at_end(const Motion& motion, int end);

}   // namespace livens
