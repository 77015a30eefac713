// SPDX-License-Identifier: BSD-3-Clause
// Numbers of joints that are no quadratic forms, and the rows that hold them: angles that may turn round and
// round, screws, gears, racks, and points on curves.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "livens/multibody/constraint.h"

namespace [[gnu::visibility("default")]] livens {

/// One form, a displacement; or two, which are cosine and sine of an angle up to a common factor.
struct JointCoordinate {
    std::vector<PairForm> forms;

    bool is_angle() const { return forms.size() == 2; }
};

/// A coordinate of a joint: how far its second body is from its first, as the maker of the joint was told
/// them, right-handed about the axis. Turns are counted from where the
/// model has its bodies.
struct NamedCoordinate {
    std::string name;   ///< "angle" (rad) or "displacement" (m)
    JointCoordinate coordinate;
    double at_stated = 0;   ///< what it is said to be where the model has its bodies
    /// The same while the joint holds, and what takes its place in a joint that does not always
    /// (Model::add_joint): of an angle the turn about the axis that is left when the shortest turn from axis
    /// to axis is taken off, so that no direction across the axis matters, which nobody stated. Empty:
    /// nothing else is needed.
    JointCoordinate apart{};
    double rotor_inertia = 0;   ///< adds 1/2 of it times the square of the rate to the kinetic energy
};

/// (X_i n) . (X_j b - X_i a): how far the point b of body j is beyond the point a of body i along the
/// direction n of body i.
JointCoordinate displacement_along(int body_i, const Vector4& n, const Vector4& a, int body_j,
                                   const Vector4& b);
/// How far the direction b of body j is turned from the direction a1 of body i towards its direction a2, in
/// rad; right-handed about a1 x a2 where these are perpendicular unit vectors.
JointCoordinate angle_between(int body_i, const Vector4& a1, const Vector4& a2, int body_j, const Vector4& b);
/// How far two triads are turned about their third axes, by their first two: cosine a1 . b1 + a2 . b2 and
/// sine a2 . b1 - a1 . b2, both 1 + (cosine of the angle between the third axes) times those of the turn that
/// is left when the shortest one from axis to axis is taken off.
JointCoordinate turn_between(int body_i, const Vector4& a1, const Vector4& a2, int body_j, const Vector4& b1,
                             const Vector4& b2);

/// A coordinate in one configuration: an angle from -pi to pi, with no turns.
double coordinate_value(const JointCoordinate& coordinate, std::span<const Matrix34> X);
/// Its rate, linear in V.
double coordinate_rate(const JointCoordinate& coordinate, std::span<const Matrix34> X,
                       std::span<const Matrix34> V);
/// How far it is from one configuration to another: an angle by the shorter way.
double coordinate_change(const JointCoordinate& coordinate, std::span<const Matrix34> from,
                         std::span<const Matrix34> to);

/// The angle with whole turns added, such that it is nearest to `near`.
double turned_to(double angle, double near);

/// A coordinate and what it is multiplied by.
struct CoupledCoordinate {
    double factor;
    JointCoordinate coordinate;
};

/// sum_k factor_k coordinate_k = constant, up to whole turns: a screw (displacement and -pitch / (2 pi) times
/// angle), a gear pair (two angles), a rack (displacement and angle), a differential (three angles).
///
/// X alone does not tell how often a wheel has turned. Where the factors of the angles are whole multiples
/// n_k of one number u, as teeth are, it need not: the row is known up to multiples of 2 pi u, of which the
/// value takes the nearest, and the solver follows it through time without a jump.
///
/// Throws InputError: `gear-ratio` for factors without a common measure of at most 10,000 parts; `joint-row`
/// for no coordinate, a factor that is zero or not finite.
ConstraintRow coupling_row(const std::vector<CoupledCoordinate>& terms, double constant, double scale,
                           const std::string& label);

/// A curve at a parameter: place, its two derivatives, and two unit normals that do not turn about the
/// tangent as they go along (each n' is parallel to the tangent; for a plane curve, the normal in the plane
/// and that of the plane) [Bishop1975].
struct CurvePoint {
    Vector3 x{}, first{}, second{};
    std::array<Vector3, 2> normals{};
};

/// A regular curve (its tangent is nowhere zero), defined a little beyond both ends unless it is closed.
struct Curve {
    std::function<CurvePoint(double s)> at;
    double first = 0;
    double last = 1;
    bool is_closed = false;
    std::function<CurvePoint(double s)> without_normals = nullptr;   ///< the same, where that is cheaper
    std::vector<double> knots{};   ///< parameters, ascending, where higher derivatives jump; of one round
};

/// The point b of body j slides along a curve in body i, whose coordinates are (1, x) of its frame: two rows
/// n_k(s) . (x - gamma(s)), with the parameter s of the curve's point that is nearest to x. Their gradients
/// by x are the normals, so the parameter is no unknown. Ends of an open curve do not stop the point.
///
/// Throws InputError `curve-crosses-itself` where it does, or nearly: the nearest point would be another one.
std::vector<ConstraintRow> curve_rows(const Curve& curve, int body_i, int body_j, const Vector4& b,
                                      double scale);

}   // namespace gnu::visibility("default")]]livens
