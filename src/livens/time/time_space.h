// SPDX-License-Identifier: BSD-3-Clause
// Spaces of functions of time over a block of elements: what the fields of a motion are made of.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "livens/time/basis.h"

namespace livens::inline time_internal {

/// A basis of functions on the elements [ends[e], ends[e + 1]]: test and trial functions of one field.
///
/// On each element degree() + 1 functions are not zero; their numbers are consecutive, first(e) ..
/// first(e) + degree(). They add up to one. At the start only function 0 is not zero, at the end only the
/// last (spaces made by lower() excepted, which may be discontinuous).
class TimeSpace {
public:
    /// Continuous Lagrange polynomials of degree 1..8 with equidistant nodes: n_elements * degree + 1
    /// functions. Throws InputError: `degree` (path method.degree) for another degree; for the ends (path
    /// time.elements) `time-elements` (no element, or more than 1e8), `not-finite`, `time-resolution` (ends
    /// that do not ascend). Ends and knots beyond 1e150, or closer together than 1e-150, count as not finite:
    /// there slopes would overflow.
    static TimeSpace lagrange(std::vector<double> ends, int degree);
    /// B-splines of degree 1..8 on a clamped knot vector: knots.size() - degree - 1 functions. Elements are
    /// the knot spans that are not empty. Throws InputError (path method.knots): `knots-decreasing`,
    /// `knots-not-clamped` (the first and the last knot stand degree + 1 times), `knots-multiplicity` (an
    /// inner knot more than degree times, which would tear the motion), `knots-few`, `knots-not-finite`;
    /// `degree` (path method.degree) outside 1..8 and `spline-degree` (there too) for a degree above the
    /// number of elements.
    static TimeSpace bspline(int degree, std::vector<double> knots);
    /// NURBS: w_A N_A / sum_B w_B N_B with the B-splines N_A of these knots, one weight for each.
    /// Throws `weights-not-positive` (path method.weights; nan and inf too, and what lies outside 1e-50 ..
    /// 1e50, where quotients of weights would overflow) and `weights-count` besides.
    static TimeSpace nurbs(int degree, std::vector<double> knots, std::vector<double> weights);

    /// Degree less one on the same elements, for multipliers (Remark 3.1): one function fewer than here.
    /// Lagrange: discontinuous, with equidistant nodes that do not touch element ends, (a + 1/2) / degree().
    /// Splines: the same knots less one at each end, which is as smooth as the derivative. NURBS: likewise,
    /// without weights. Continuous spaces only.
    TimeSpace lower() const;

    int size() const { return size_; }
    int degree() const { return degree_; }
    int n_elements() const { return static_cast<int>(ends_.size()) - 1; }
    const std::vector<double>& ends() const { return ends_; }
    double length(int element) const { return ends_[element + 1] - ends_[element]; }
    int first(int element) const { return first_[element]; }
    bool is_rational() const { return !weights_.empty(); }
    /// Whether no function jumps at an element end, the two of the whole time included.
    bool is_continuous() const;

    /// Values and derivatives by time (1/s) of the degree() + 1 functions of an element at its local
    /// coordinate s in [0, 1]. Derivatives add up to zero within rounding.
    void evaluate(int element, double s, std::span<double> values, std::span<double> derivatives) const;
    /// sum_B w_B N_B, the denominator of NURBS; 1 for others.
    double denominator(int element, double s) const;

    /// The degree()-th derivatives by the local coordinate of the degree() + 1 functions of an element, up to
    /// a common factor; they are constant. Of NURBS those of the splines w_A N_A.
    std::vector<double> highest_derivative(int element) const;

    /// One instant for each function where interpolation is unique: nodes (Lagrange), Greville abscissae
    /// (splines); first and last are the ends to the bit. Continuous spaces only.
    std::vector<double> interpolation_points() const;
    /// The element that contains t, and the local coordinate there. At an element end it is the element that
    /// starts there, except at the last; an instant outside counts as the end that is nearer.
    struct Place {
        int element = 0;
        double s = 0;
    };
    Place place(double t) const;

private:
    TimeSpace() = default;
    static TimeSpace on_knots(int degree, std::vector<double> knots);
    static TimeSpace on_nodes(std::vector<double> ends, std::vector<double> nodes, int shared);
    void evaluate_splines(int element, double s, std::span<double> values,
                          std::span<double> derivatives) const;

    int size_ = 0;
    int degree_ = 0;
    std::vector<double> ends_;
    std::vector<int> first_;               ///< function of each element
    std::optional<LagrangeBasis> local_;   ///< Lagrange: on [0, 1]; none for splines
    std::vector<double> knots_;            ///< splines
    std::vector<double> weights_;          ///< NURBS
};

/// A clamped knot vector of smoothest splines: every end once, the first and the last degree + 1 times, and
/// `kinks` among the ends degree times (where the motion has a kink, as its momentum does where a load
/// jumps).
///
/// A kink belongs to the nearest end, if that is within 1e-9 of the whole time, as make_time_mesh() merges
/// instants; other kinks, and those at the first and the last end, are left out: a spline has none inside an
/// element. Throws InputError for the degree and the ends like TimeSpace::lagrange.
std::vector<double> clamped_knots(int degree, std::span<const double> ends,
                                  std::span<const double> kinks = {});

}   // namespace livens::inline time_internal
