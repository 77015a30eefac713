// SPDX-License-Identifier: BSD-3-Clause
// Elements of a motion that is solved all at once, as long as their local errors allow.
#pragma once

#include <span>
#include <vector>

#include "livens/diagnostics/estimate.h"
#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"
#include "livens/spacetime/found.h"

namespace livens::inline spacetime_internal {

/// What the elements of a motion of lobatto tell of those that it should have.
class ElementScales {
public:
    ElementScales(const Model& model, const Motion& motion, const std::vector<Unseen>& unseen);

    /// What elements lose, on the average.
    double mean_error() const { return mean_error_; }
    /// The length of elements of this degree that lose `error` each, as a geometric mean over the motion.
    double mean_length(int degree, double error) const;
    /// Element ends such that elements of this degree lose `error` each, with these instants among them.
    /// Elements are at most a few times as long as those that are known, or as short.
    std::vector<double> ends(int degree, double error, std::span<const double> stops) const;

private:
    std::vector<double> lengths(int degree, double error) const;

    const TimeMesh& mesh_;
    std::vector<double> scales_;   // h J^(-1 / (p + 1)), at which an element would see nothing
    std::vector<double> unseen_;   // what laws of loads did inside of elements
    double mean_error_ = 0;
};

TimeMesh halved(const TimeMesh& mesh);

/// Where laws of loads bend on the way of a motion: from each element's own state to its end, or to the next
/// one that is not one of the bends as they were known before.
std::vector<double> bends_of(const Stated& of, const Motion& motion, const std::vector<double>& known,
                             const Lobatto& lobatto, SolveOptions options);

}   // namespace livens::inline spacetime_internal
