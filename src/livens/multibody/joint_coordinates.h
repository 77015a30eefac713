// SPDX-License-Identifier: BSD-3-Clause
// Numbers of joints that are no quadratic forms, and the rows that hold them: angles that may turn round and
// round, screws, gears, racks, and points on curves.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "livens/multibody/constraint.h"

namespace [[gnu::visibility("default")]] livens {

/// What a coordinate is of its forms q.
enum class CoordinateKind : std::uint8_t {
    displacement,         ///< q_1, m
    angle,                ///< atan2(q_2, q_1), with a common factor of both; turns are counted
    outer_angle,          ///< the same where the factor may vanish: the first and the third of three angles
    arc_sine,             ///< asin(q_1), up to a quarter turn: the second of three angles
    rotation_component,   ///< component of a rotation vector, up to half a turn: see rotation_component()
    rotation_angle        ///< its length, likewise
};

/// Of forms alone one is a displacement, two are an angle.
struct JointCoordinate {
    std::vector<PairForm> forms;
    CoordinateKind kind = forms.size() == 2 ? CoordinateKind::angle : CoordinateKind::displacement;

    /// It is measured in rad.
    bool is_angle() const { return kind != CoordinateKind::displacement; }
    /// Positions tell it up to whole turns, which are counted by whoever follows a motion, each the shorter
    /// way: unwrapped_angles.h has those of loads. The others are what positions tell, or nothing, as
    /// is_known() says below.
    bool counts_turns() const { return kind == CoordinateKind::angle || kind == CoordinateKind::outer_angle; }
};

/// A coordinate of a joint: how far its second body is from its first, as the maker of the joint was told
/// them, right-handed about the axis. Turns are counted from where the
/// model has its bodies.
struct NamedCoordinate {
    std::string name;   ///< "angle", "angle_1" (rad) or "displacement" (m)
    JointCoordinate coordinate;
    double at_stated = 0;   ///< what it is said to be where the model has its bodies
    /// The same while the joint holds, and what takes its place in a joint that does not always
    /// (Model::add_joint): of an angle the turn about the axis that is left when the shortest turn from axis
    /// to axis is taken off, so that no direction across the axis matters, which nobody stated. Empty:
    /// nothing else is needed.
    JointCoordinate apart{};

    /// One of several angles of a joint: where coordinates are chosen among many, those of joints that turn
    /// about one axis and slide along one come first, as the legs of a platform before the crosses at their
    /// ends.
    bool is_numbered() const { return name.starts_with("angle_"); }
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

/// Two triads, the columns of both matrices, one on each body.
struct TriadPair {
    Matrix3 first = identity<3>(), second = identity<3>();
};
/// The three angles of the turn R = A^T B from the first triad A to the second B, about axes i, j and k of
/// it: R = R_i(angle 1) R_j(angle 2) R_k(angle 3), where i, j, k are 0, 1, 2 in any order. The second angle
/// stays within a quarter turn; where it gets there, the others are one.
std::array<JointCoordinate, 3> angles_of_turn(int first, int second, const TriadPair& triads,
                                              const std::array<int, 3>& sequence);
/// Component k of the rotation vector of that turn, in axes of either triad: 0, 1, 2; and its length. Forms
/// of the latter are s1, s2, s3 and c: the sine of the turn times its axis, and its cosine.
JointCoordinate rotation_component(int first, int second, const TriadPair& triads, int k);
JointCoordinate rotation_angle(int first, int second, const TriadPair& triads);

/// A coordinate as a function of its forms.
SmoothFunction::Value coordinate_at(CoordinateKind kind, const SmoothFunction::Point& forms);
/// Up to which a rotation vector is known, rad: 175 degrees.
inline constexpr double widest_rotation = 3.05;
/// Whether the forms tell it: no angle is near where it is not unique, by 0.6 degrees of a quarter turn, or
/// by 5 degrees of half a turn.
bool is_known(CoordinateKind kind, const SmoothFunction::Point& forms);
bool is_known(const JointCoordinate& coordinate, const Configurations& X);

/// A coordinate in one configuration: an angle from -pi to pi, with no turns.
double coordinate_value(const JointCoordinate& coordinate, const Configurations& X);
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

/// A smooth law of one coordinate q: a function with two continuous derivatives by it.
struct CoordinateLaw {
    TimeFunction at;   ///< of q, as functions of time are of t
    /// Where it is known, and a motion ends; of a law with a period, one round.
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    double period = 0;   ///< after which it begins again, `rise` higher; 0: it does not
    double rise = 0;
    std::vector<double> knots{};   ///< where its third derivative jumps, ascending; of one round
};
/// A law and what it is of.
struct CoupledLaw {
    CoordinateLaw law;
    JointCoordinate coordinate;
    double shift = 0;   ///< what the law's q is more than the forms say
    std::string what;   ///< FunctionEdge::what
};

/// sum_k factor_k coordinate_k = constant, up to whole turns: a screw (displacement and -pitch / (2 pi) times
/// angle), a gear pair (two angles), a rack (displacement and angle), a differential (three angles).
///
/// X alone does not tell how often a wheel has turned. Where the factors of the angles are whole multiples
/// n_k of one number u, as teeth are, it need not: the row is known up to multiples of 2 pi u, of which the
/// value takes the nearest, and the solver follows it through time without a jump.
///
/// With a law, sum_k factor_k coordinate_k - law(q) = constant. Of an angle the law knows all turns if it has
/// a period, of which a turn is a whole multiple; else those next to the middle between low and high.
///
/// Throws InputError: `gear-ratio` for factors without a common measure of at most 10,000 parts; `joint-row`
/// for no coordinate, a factor that is zero or not finite.
ConstraintRow coupling_row(const std::vector<CoupledCoordinate>& terms, double constant, double scale,
                           const std::string& label, const CoupledLaw* law = nullptr);

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
