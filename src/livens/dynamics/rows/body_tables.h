// SPDX-License-Identifier: BSD-3-Clause
// Masses of bodies, and the coordinates of their twists that a mechanism is solved in.
//
// Unknowns are twists in mass-orthonormal coordinates: y = (sqrt(M) v_c, L^T w_body) with the velocity v_c of
// the centre of mass, the spin in body axes and the Cholesky factor L of the inertia about the centre. A
// body's kinetic energy is 1/2 |y|^2, so null spaces of constraints are orthonormal in the mass metric, and
// no unit or size weighs more than another.
#pragma once

#include <vector>

#include "livens/multibody/state.h"

namespace livens::inline dynamics_internal {

/// A body's mass matrix m between columns of X.
struct MassTable {
    struct Entry {
        int from, to;   ///< columns of X
        double value;
    };
    double diagonal[4] = {};
    std::vector<Entry> others;   ///< that are not zero

    /// out <- factor * Y m, 12 numbers each.
    void times(const double* Y, double factor, double* out) const;
};

/// A body's constants.
struct BodyTable {
    int first = 0;   ///< twist unknowns from here
    int dofs = 6;
    MassTable mass;
    double weight[12] = {};
    double inverse_root_mass = 0;   ///< 1 / sqrt(M)
    double center[3] = {};          ///< of mass, body coordinates
    double spin[9] = {};            ///< L^-T, column by column: w_body = spin y_2
    double reach = 0;               ///< sizes for the rounding level: |c| and the largest of L
    double root_inertia = 0;
    bool offset = false;      ///< the centre of mass is not the reference point
    bool principal = false;   ///< spin and euler are diagonal
    double euler[9] = {};     ///< E about the centre of mass, column by column
};

/// Arrays over bodies hold 12 numbers each (columns of X); arrays over twists six a body and three a point
/// mass.
class BodyTables {
public:
    explicit BodyTables(const Model& model);

    int n_bodies() const { return n_; }
    std::size_t size() const { return tables_.size(); }
    const BodyTable& operator[](std::size_t body) const { return tables_[body]; }
    auto begin() const { return tables_.begin(); }
    auto end() const { return tables_.end(); }
    int n_twists() const { return tables_.empty() ? 0 : tables_.back().first + tables_.back().dofs; }
    /// Every inertia is definite; else L is that of a slightly larger one.
    bool are_regular() const { return are_regular_; }

    /// raw += factor * weight, 12 numbers a body.
    void add_weight(double factor, double* raw) const;
    /// q <- the rows of raw: force, and moment about the centre of mass (not the reference point).
    void twist_rows(const double* X, const double* maps, const double* raw, double* q) const;

    /// The map D of scaled to plain twists at X, 12 numbers a body: K = R L^-T, then R times the centre of
    /// mass.
    void map_twists(const double* X, double* maps) const;
    /// The same of one body; where `map` is zero it may stay so.
    void map_twist(int body, const double* X, double* map) const;
    /// xi = D y: w = K y_2, v = y_1 / sqrt(M) + c x w; also in place.
    void to_twist(const double* maps, const double* y, double* xi) const;
    /// Central rows in scaled twists: y_1 = f / sqrt(M), y_2 = K^T tau.
    void to_scaled_rows(const double* maps, const double* q, double* y) const;
    /// Central rows in scaled twists of a load g, 12 numbers, on one body; 0 for what a point has not.
    void scaled_row(int body, const double* X, const double* map, const double* g, double* y) const;
    /// Rows of one body about its reference point to rows about its centre of mass.
    static void to_centre(const double* f, double* q)
    {
        const double* c = f + 9;
        q[3] -= c[1] * q[2] - c[2] * q[1];
        q[4] -= c[2] * q[0] - c[0] * q[2];
        q[5] -= c[0] * q[1] - c[1] * q[0];
    }
    /// The middle part K_A^T (tr(W) 1 - W) K_B, W = R_B E R_A^T, of a body's mass between two configurations.
    void spin_mass(int body, const double* X_A, const double* X_B, double* H) const;
    /// dX <- N(X) xi.
    void rates_of(const double* X, const double* xi, double* dX) const;
    /// out <- Y m, body by body.
    void times_mass(const double* Y, double factor, double* out) const;

private:
    std::vector<BodyTable> tables_;
    int n_;   // their number, which every loop would divide for
    bool are_regular_ = true;
};

/// A body's twist rows about its centre of mass in scaled twists.
inline void scale_row(const BodyTable& body, const double* f, const double* q, double* y)
{
    const double r = body.inverse_root_mass;
    for (int i = 0; i < 3; ++i) y[i] = r * q[i];
    if (body.dofs == 3) return;
    for (int i = 0; i < 3; ++i) y[3 + i] = f[3 * i] * q[3] + f[3 * i + 1] * q[4] + f[3 * i + 2] * q[5];
}

}   // namespace livens::inline dynamics_internal
