// SPDX-License-Identifier: BSD-3-Clause
// Scales of unknowns and rows, and what is measured in them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "livens/spacetime/mixed/fields.h"

namespace livens::mixed {

/// Where a block's residual is worst, in words.
struct Worst {
    double value = 0;
    std::string name;
    double t = 0;
};

/// Diagonal scales by mass and element length: X ~ h / sqrt(m), P ~ sqrt(m), lambda ~ 1 / h (docs/theory.md,
/// "The elements of the paper": Scaling).
class Scaling {
public:
    /// `space` must outlive the scales.
    explicit Scaling(const FieldSpace& space) : space_(space) {}

    /// At X0 of `fields`; once, before an iteration begins.
    void set(const Fields& fields);
    std::span<const double> rows() const { return rows_; }
    std::span<const double> columns() const { return columns_; }
    /// Largest increment: |dx| / length of points, |dd| of directors, and what the momenta's would move in
    /// one element.
    double size_of(std::span<const double> increment) const;
    /// The largest scaled residual and its place.
    Worst worst(const std::vector<double>& r) const;
    /// The largest scaled momentum or multiplier.
    double largest(const Fields& fields) const;

private:
    template <class LookAt>
    double largest_of_functions(const LookAt& look_at) const;

    const FieldSpace& space_;
    std::vector<double> rows_, columns_;
};

}   // namespace livens::mixed
