// SPDX-License-Identifier: BSD-3-Clause
// The boundary term of (P10) at an end whose directors are unknown: P = [v, w x d_a] m of a rigid motion with
// given p and L, and its derivative by X (docs/theory.md, "The elements of the paper": Natural and strong).
#include "livens/spacetime/mixed/end_momentum.h"

#include <algorithm>
#include <limits>

#include "livens/solvers/dense.h"

namespace livens::mixed {

namespace {

/// [v, w x d_i] m.
Matrix34 momentum(const Matrix34& X, const Vector3& v, const Vector3& w, const Matrix4& m)
{
    return rate(X, v, w) * m;
}

/// Sum of d_i cross the directors' columns of P.
Vector3 moment(const Matrix34& X, const Matrix34& P)
{
    Vector3 L{};
    for (int c = 1; c < 4; ++c) L += cross(X.column(c), P.column(c));
    return L;
}

void put(const Vector3& p, const Vector3& L, double* six)
{
    std::copy_n(p.a, 3, six);
    std::copy_n(L.a, 3, six + 3);
}

}   // namespace

TurningMomentum::TurningMomentum(const Body& body, const Matrix34& X, const Matrix34& V)
    : is_point_(body.is_point), mass_(body.mass), p_((V * body.mass).column(0)), L_(moment(X, V * body.mass))
{}

TurningMomentum::TurningMomentum(const Body& body, const double* momenta)
    : is_point_(body.is_point), mass_(body.mass), p_{momenta[0], momenta[1], momenta[2]}, L_{}
{
    if (!is_point_) L_ = {momenta[3], momenta[4], momenta[5]};
}

/// v and w follow from p and L by the 6 x 6 inertia about the reference point, nan where that is singular. By
/// the directors they change such that p and L stay; the place of the body is in none of them.
Matrix34 TurningMomentum::at(const Matrix34& X, Matrix<12, 12>* tangent) const
{
    if (tangent != nullptr) *tangent = {};
    if (is_point_) return {p_[0], p_[1], p_[2]};
    DenseLU inertia;   // columns: (P_0, moment of P) of unit twists
    inertia.resize(6);
    for (int q = 0; q < 6; ++q) {
        Matrix<6, 1> unit{}, column{};
        unit[q] = 1;
        const Matrix34 P = momentum(X, {unit[0], unit[1], unit[2]}, {unit[3], unit[4], unit[5]}, mass_);
        put(P.column(0), moment(X, P), column.a);
        for (int i = 0; i < 6; ++i) inertia.row(i)[q] = column[i];
    }
    Matrix34 P{};
    if (!inertia.factorise()) {
        std::fill(std::begin(P.a), std::end(P.a), std::numeric_limits<double>::quiet_NaN());
        return P;
    }
    double twist[6];
    put(p_, L_, twist);
    inertia.solve(twist);
    const Vector3 v{twist[0], twist[1], twist[2]}, w{twist[3], twist[4], twist[5]};
    P = momentum(X, v, w, mass_);
    if (tangent == nullptr) return P;
    for (int i = 3; i < 12; ++i) {
        Matrix34 dX{};
        dX.a[i] = 1;
        const Matrix34 at_fixed_twist = momentum(dX, {}, w, mass_);
        double change[6];   // of the twist, so that p and L stay
        put(-at_fixed_twist.column(0), -(moment(dX, P) + moment(X, at_fixed_twist)), change);
        inertia.solve(change);
        const Matrix34 dP = at_fixed_twist + momentum(X, {change[0], change[1], change[2]},
                                                      {change[3], change[4], change[5]}, mass_);
        std::copy_n(dP.a, 12, tangent->a + 12 * i);
    }
    return P;
}

}   // namespace livens::mixed
