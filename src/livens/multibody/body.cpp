// SPDX-License-Identifier: BSD-3-Clause
// Bodies as X = [phi d1 d2 d3] (P3), rigid, skew or without directors, and their orientations: theory.md,
// "Bodies without rotation parameters". Directors are never normalised on the way; only where a body is made
// are they put onto the nearest triad.
#include "livens/multibody/body.h"

#include <algorithm>
#include <cmath>

#include "livens/base/elementary.h"
#include "livens/base/error.h"
#include "livens/multibody/directors.h"
#include "livens/multibody/wording.h"
#include "livens/solvers/spectral.h"

namespace livens {

double skewness(const Matrix3& directors)
{
    const Matrix3 gap = transpose(directors) * directors - identity<3>();
    double largest = 0;
    for (const double entry : gap.a) largest = std::max(largest, std::abs(entry));
    return largest;
}

namespace {

constexpr double flattest = 1e-6;   // volume of a triad by the product of its lengths

void check_handedness(const Matrix3& directors, const std::string& path)
{
    if (determinant(directors) < 0)
        throw InputError({"directors-left-handed", path, "directors must be right-handed, d1 x d2 = d3",
                          "d1 x d2 = -d3", "", "", "change the sign of one director, or swap two"});
}

void check_skew_directors(const Matrix3& directors, const std::string& path)
{
    require_finite(directors, path, "directors");
    double product = 1;
    for (int i = 0; i < 3; ++i) product *= norm(directors.column(i));
    if (!(std::abs(determinant(directors)) > flattest * product))
        throw InputError({"directors-dependent", path, "directors must not lie in one plane",
                          "d1 x d2 . d3 = " + to_text(determinant(directors)),
                          "above " + to_text(flattest * product) + " in size", "",
                          "three directors span space: coordinates along them tell every point apart"});
    check_handedness(directors, path);
}

}   // namespace

void multibody_internal::check_directors(const Matrix3& directors, const std::string& path)
{
    require_finite(directors, path, "directors");
    const double gap = skewness(directors);
    // Inequality: max |d_a . d_b - delta_ab| <= 1e-10. What is within is rounding of the input, and is
    // projected away.
    if (gap > 1e-10)
        throw InputError(
            {"directors-not-orthonormal", path, "directors must be perpendicular unit vectors",
             "largest |d_a . d_b - delta_ab| = " + to_text(gap), "<= 1e-10", "",
             "directors are the columns of a rotation matrix; a quaternion avoids the question"});
    check_handedness(directors, path);
}

Body rigid_body(const std::string& name, const MassProperties& properties, const Placement& placement)
{
    const std::string path = "body[" + name + "]";
    check_mass_properties(properties, path);
    require_finite(placement.position, path + ".position", "the position");
    require_finite(placement.velocity, path + ".velocity", "the velocity");
    require_finite(placement.angular_velocity, path + ".angular_velocity", "the angular velocity");
    check_directors(placement.directors, path + ".directors");
    Body body;
    body.name = name;
    body.mass = mass_matrix(properties);
    body.X = configuration(placement.position, project_directors(placement.directors));
    body.V = rate(body.X, placement.velocity, placement.angular_velocity);
    body.upright = directors(body.X);
    return body;
}

/// D = R U with the polar factor R: theta along D is U theta along R, so that m becomes A m A^T with
/// A = diag(1, U).  (docs/theory.md, "Skew directors")
Body skew_body(const std::string& name, const Matrix4& mass, const Placement& placement)
{
    const std::string path = "body[" + name + "]";
    check_skew_directors(placement.directors, path + ".directors");
    check_mass_properties({mass(0, 0), {}, {}}, path);   // before anything is divided by it
    if (skewness(placement.directors) <= 1e-10) return rigid_body(name, mass_properties(mass), placement);
    Placement straight = placement;
    straight.directors = project_directors(placement.directors);
    const Matrix3 U = transpose(straight.directors) * placement.directors;
    // U is symmetric in exact numbers; its rounding must not make the mass matrix unsymmetric.
    const Matrix3 stretch = 0.5 * (U + transpose(U));
    Matrix4 A{};
    A(0, 0) = 1;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) A(i + 1, j + 1) = stretch(i, j);
    Body body = rigid_body(name, mass_properties(A * mass * transpose(A)), straight);
    body.stretch = stretch;
    return body;
}

bool is_skew(const Body& body) { return !(body.stretch == identity<3>()); }

Body point_mass(const std::string& name, double mass, const Vector3& position, const Vector3& velocity)
{
    const std::string path = "body[" + name + "]";
    check_mass_properties({mass, {}, {}}, path);
    require_finite(position, path + ".position", "the position");
    require_finite(velocity, path + ".velocity", "the velocity");
    Body body;
    body.name = name;
    body.is_point = true;
    body.mass(0, 0) = mass;
    body.X.set_column(0, position);
    body.V.set_column(0, velocity);
    return body;
}

Matrix3 directors_from_quaternion(const Vector4& quaternion)
{
    double largest = 0;
    for (const double part : quaternion.a)
        largest = std::isfinite(part) ? std::max(largest, std::abs(part)) : part;
    if (!(largest > 0) || !all_finite(quaternion))
        throw InputError({"quaternion-zero", "", "a quaternion must be finite and not zero",
                          "[" + to_text(quaternion[0]) + ", " + to_text(quaternion[1]) + ", " +
                              to_text(quaternion[2]) + ", " + to_text(quaternion[3]) + "]",
                          "", "", "no rotation is [1, 0, 0, 0]"});
    Vector4 q = quaternion;
    for (double& part : q.a) part /= largest;   // squares neither overflow nor vanish
    const double s = 2 / dot(q, q);
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    return {1 - s * (y * y + z * z), s * (x * y + w * z),     s * (x * z - w * y),
            s * (x * y - w * z),     1 - s * (x * x + z * z), s * (y * z + w * x),
            s * (x * z + w * y),     s * (y * z - w * x),     1 - s * (x * x + y * y)};
}

Matrix3 directors_from_rotation_vector(const Vector3& rotation_vector)
{
    require_finite(rotation_vector, "", "a rotation vector");
    const double angle = hypotenuse(rotation_vector[0], rotation_vector[1], rotation_vector[2]);
    if (angle == 0) return identity<3>();
    const SineCosine half = sine_cosine(angle / 2);
    const Vector3 v = (half.sine / angle) * rotation_vector;
    return directors_from_quaternion({half.cosine, v[0], v[1], v[2]});
}

/// [Shepperd 1978]: divide by the largest of the four parts, so that half turns lose no digits.
Vector4 quaternion_from_directors(const Matrix3& directors)
{
    const Matrix3& R = directors;
    const double t = trace(R);
    const double squares[4] = {t, R(0, 0), R(1, 1), R(2, 2)};   // each 4 q_k^2 - 1 up to a common part
    const int largest = static_cast<int>(std::ranges::max_element(squares) - squares);
    Vector4 q{};
    if (largest == 0) {
        q = {1 + t, R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1)};
    } else {
        const int i = largest - 1, j = (i + 1) % 3, k = (i + 2) % 3;
        q[0] = R(k, j) - R(j, k);
        q[i + 1] = 1 + R(i, i) - R(j, j) - R(k, k);
        q[j + 1] = R(i, j) + R(j, i);
        q[k + 1] = R(i, k) + R(k, i);
    }
    // q and -q are one rotation; the one with w >= 0 is returned, so that equal triads have equal
    // quaternions.
    const double scale = (q[0] < 0 ? -1 : 1) / norm(q);
    return scale * q;
}

/// Newton's iteration D <- (D + D^-T) / 2 [Higham 2008, eq. 8.17]: near a triad two steps reach the last bit,
/// entries that are exactly zero by symmetry stay so, and the limit is the polar factor.
Matrix3 project_directors(const Matrix3& directors)
{
    Matrix3 D = directors;
    const double size = norm(D);
    if (std::abs(determinant(D)) > 1e-9 * size * size * size) {
        for (int i = 0; i < 50; ++i) {
            const Matrix3 next = 0.5 * (D + transpose(inverse(D)));
            const double change = norm(next - D);
            D = next;
            if (change < 1e-9) return D;   // the next change would be of order 1e-18
        }
    }
    // Nearly singular: no inverse to trust. The factor is U V^T, one of many if two directors are parallel.
    return orthogonal_factor(directors);
}

Matrix34 rate(const Matrix34& X, const Vector3& velocity, const Vector3& angular_velocity)
{
    Matrix34 V{};
    V.set_column(0, velocity);
    for (int i = 1; i < 4; ++i) V.set_column(i, cross(angular_velocity, X.column(i)));
    return V;
}

/// The normal equations of min sum |w x d_i - d_i'|^2: (tr(D D^T) I - D D^T) w = sum d_i x d_i'.
Vector3 angular_velocity(const Matrix34& X, const Matrix34& V)
{
    const Matrix3 D = directors(X);
    const Matrix3 DDt = D * transpose(D);
    const Matrix3 normal = trace(DDt) * identity<3>() - DDt;
    if (determinant(normal) == 0) return {};   // a point mass
    Vector3 moment{};
    for (int i = 1; i < 4; ++i) moment += cross(X.column(i), V.column(i));
    return inverse(normal) * moment;
}

}   // namespace livens
