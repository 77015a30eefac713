// SPDX-License-Identifier: BSD-3-Clause
// Growth measured on one try of an accuracy, for all.
#pragma once

#include <string>

#include "livens/spacetime/solve.h"

namespace livens::inline spacetime_internal {

/// That of the motion, whatever the elements.
class MeasuredGrowth {
public:
    bool is_asked() const { return !mesh_.ends.empty(); }
    /// Measured unless that was done as far as this motion goes; the solution gets it, and its estimate
    /// counts what rounding has grown to.
    void tell(const Model& model, const Problem& problem, const SolveOptions& options, double accuracy,
              Solution& solution);
    /// What rounding has grown to by the end.
    double rounding() const { return rounding_; }
    /// The same, were nothing left by the iteration.
    double least_rounding() const { return least_rounding_; }
    /// Of what rounding reaches, and the body and direction that it is most in.
    double largest() const;
    std::string in_words(const Model& model) const;

private:
    bool is_whole() const { return !growth_.factors.empty() && growth_.factors.size() == mesh_.ends.size(); }
    std::vector<double> at(const std::vector<double>& ends, const std::vector<double>& figures) const;

    Growth growth_;
    TimeMesh mesh_;
    double rounding_ = 0, least_rounding_ = 0;
};

}   // namespace livens::inline spacetime_internal
