// SPDX-License-Identifier: BSD-3-Clause
// The model as the engine reads it: flat tables, unknowns numbered, and the coordinates that it is solved in.
//
// Unknowns are twists in mass-orthonormal coordinates: y = (sqrt(M) v_c, L^T w_body) with the velocity v_c of
// the centre of mass, the spin in body axes and the Cholesky factor L of the inertia about the centre. A
// body's kinetic energy is 1/2 |y|^2, so null spaces of constraints are orthonormal in the mass metric, and
// no unit or size weighs more than another.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "livens/multibody/model.h"
#include "livens/multibody/turns.h"

namespace livens {

class RowPattern;

/// The last pattern that was made of a model's rows.
struct KnownPattern {
    std::shared_ptr<const RowPattern> last;
};

/// Tables made once per solution. Arrays over bodies hold 12 numbers each (columns of X); arrays over twists
/// hold `n_twists` numbers, six a body and three a point mass.
struct Tables {
    struct BodyTable {
        int first = 0;   ///< twist unknowns from here
        int dofs = 6;
        struct Entry {
            int from, to;   ///< columns of X
            double value;
        };
        std::vector<Entry> mass;   ///< entries of m beside the diagonal that are not zero
        double diagonal[4] = {};   ///< of m
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
    /// A row and the bodies that it touches, its sides.
    struct RowTable {
        const ConstraintRow* row = nullptr;
        int n_sides = 0;
        int bodies[RowBodies::most] = {};   ///< of each side
        struct Entry {
            int from_side, from;   ///< side, and place of the column in the 12 numbers of X
            int to_side, to;
            double value;
        };
        std::vector<int> columns[RowBodies::most];   ///< of X that the gradient may touch: 0, 3, 6, 9
        /// A quadratic form alone has these tables; others are evaluated by constraint.h.
        bool is_quadratic = true;
        std::vector<Entry> form;   ///< entries of K that are not zero, by rows and columns
        Matrix4 K[2][2] = {};      ///< the same as blocks
        Matrix34 B[2] = {};
    };
    /// Numbers of a gradient: 12 a side.
    static constexpr int gradient_size = 12 * RowBodies::most;

    /// `independent`: rows of the joints, of full rank, that hold for all others.
    /// `with_rigidity`: rigidity_rows() of the bodies follow the rows of the joints.
    /// `known`: of the same model, see Prepared; null: these tables have their own.
    Tables(const Model& the_model, std::vector<int> independent, bool with_rigidity = false,
           std::shared_ptr<KnownPattern> known = nullptr);
    Tables(const Tables&) = delete;
    Tables& operator=(const Tables&) = delete;

    const Model* model;
    std::vector<BodyTable> bodies;
    std::vector<RowTable> rows;            ///< all joint rows of the model, then those of rigidity
    std::vector<ConstraintRow> rigidity;   ///< if asked for
    std::vector<int> loads_with_tangent;
    Turns turns;
    double length = 1;
    int n_twists = 0;
    std::vector<int> independent;   ///< rows that are solved for, until choose_rows() finds them unfit
    int rank = 0;                   ///< how many they are
    std::shared_ptr<KnownPattern> known_pattern;
    bool regular = true;            ///< every inertia is definite; else L is that of a slightly larger one

    int n_bodies() const { return n_bodies_; }
    int n_rows() const { return model->n_rows(); }
    int freedoms() const { return n_twists - rank; }

    /// Gradients of row r by X of its sides, 12 numbers each, one after the other. Only the columns that the
    /// row touches (RowTable::columns) are written, and only they may be read.
    void gradient(int r, Instant at, const double* X, double* g) const;
    /// Force and moment about the centre of mass of one side's gradient, 6 numbers.
    void wrench(int r, int side, const double* X, const double* maps, const double* g, double* q) const;
    /// The same as a row of scaled twists, 6 numbers (0 for what a point has not).
    void scaled_wrench(int r, int side, const double* X, const double* g, double* y) const;
    /// q += factor times these of all sides, n_twists numbers.
    void add_wrenches(int r, const double* X, const double* maps, const double* g, double factor,
                      double* q) const;
    /// The gradient as rows of scaled twists, n_twists numbers.
    void scaled_gradient(int r, const double* X, const double* maps, const double* g, double* out) const;
    /// Phi from the absolute configuration and its gradient there: 1/2 <g + B, X> + c.
    double value(int r, Instant at, const double* X, const double* g) const;
    double value(int r, Instant at, const double* X) const;
    /// Phi of a quadratic form at another place less Phi, from the gradients at both and how far they differ.
    double change(int r, const double* g_from, const double* g_to, const double* step) const;
    /// The part of dPhi/dt that stays where X does not move; 0 without drives.
    double rate(int r, Instant at, const double* X) const;
    /// d2 Phi/dt2 less G X'': quadratic in X' = V unless drives add to it.
    double curvature(int r, Instant at, const double* X, const double* V) const;

    /// raw += factor * weight, and factor * loads at the instant; X, V: 12 a body.
    void add_weight(double factor, double* raw) const;
    /// `angles`: a row of `turns`, or nothing where turns are not known.
    void add_loads(Instant at, const double* X, const double* V, double factor, double* raw,
                   std::span<const double> angles = {}) const;
    /// What a load is asked with.
    LoadArguments arguments(int load, Instant at, const double* X, const double* V,
                            std::span<const double> angles = {}) const;
    /// The first load that is not finite there; -1: none.
    int bad_load(Instant at, const double* X, const double* V, std::span<const double> angles = {}) const;
    /// q <- the rows of raw: force, and moment about the centre of mass (not the reference point).
    void twist_rows(const double* X, const double* maps, const double* raw, double* q) const;

    /// The map D of scaled to plain twists at X, 12 numbers a body: K = R L^-T, then R times the centre of
    /// mass.
    void map_twists(const double* X, double* maps) const;
    /// xi = D y: w = K y_2, v = y_1 / sqrt(M) + c x w; also in place.
    void to_twist(const double* maps, const double* y, double* xi) const;
    /// Central rows in scaled twists: y_1 = f / sqrt(M), y_2 = K^T tau.
    void to_scaled_rows(const double* maps, const double* q, double* y) const;
    /// Rows of one body about its reference point to rows about its centre of mass.
    static void to_centre(const double* body_maps, double* q);
    /// The middle part K_A^T (tr(W) 1 - W) K_B, W = R_B E R_A^T, of a body's mass between two configurations.
    void spin_mass(int body, const double* X_A, const double* X_B, double* H) const;
    /// dX <- N(X) xi.
    void rates_of(const double* X, const double* xi, double* dX) const;
    /// out <- Y m, body by body.
    void times_mass(const double* Y, double factor, double* out) const;

private:
    void map_twist(int body, const double* X, double* map) const;
    void plain_wrench(int r, int side, const double* X, const double* g, double* q) const;

    int n_bodies_;   // the size of `bodies`, which every loop would divide for
};

}   // namespace livens
