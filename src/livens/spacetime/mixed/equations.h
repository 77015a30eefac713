// SPDX-License-Identifier: BSD-3-Clause
// The equations of one block: rows and whole matrix, formed element by element.
#pragma once

#include <bitset>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "livens/solvers/sparse.h"
#include "livens/spacetime/mixed/end_momentum.h"
#include "livens/spacetime/mixed/coordinates.h"
#include "livens/spacetime/mixed/numbering.h"
#include "livens/time/time_space.h"

namespace livens::mixed {

/// Coefficients of the fields, function after function.
struct Fields {
    std::vector<double> X0;       ///< n_coordinates: X is X0 + sum_A M_A x_A
    std::vector<double> x;        ///< n_functions x n_coordinates
    std::vector<double> P;        ///< likewise
    std::vector<double> lambda;   ///< n_multiplier_functions x n_rows
};

/// A coefficient of the multipliers that is no unknown but a sum of others.
struct Tie {
    int function;                                ///< of the multipliers
    std::vector<std::pair<int, double>> terms;   ///< functions that are unknown, and their factors
};

/// Where a block's residual is worst, in words.
struct Worst {
    double value = 0;
    std::string name;
    double t = 0;
};

/// The system (P23) of one block, its fields X, P and the multipliers on the functions M_A and L_A of time:
///
///     dP_A       int M_A (X' - P m^-1) dt = 0
///     dX_A       natural: int -M_A' P + M_A (G^T lambda - F) dt = P(0) for A = 0, -P(T) for A = n, else 0
///                strong:  int  M_A (P' + G^T lambda - F) dt = 0
///     dlambda_A  int L_A Phi(X) dt = 0
///
/// A row dX of the natural start that is not solved is the definition of the momentum there.
class Equations {
public:
    struct Setup {
        const Coordinates* coordinates;
        TimeSpace space;
        TimeSpace multipliers;
        int gauss_points;
        Mixed::Start start;
        Mixed::EndMultiplier end_multiplier;
        EndMomentum at_start, at_end;
        std::vector<int> tears{};   ///< elements at whose start equal multipliers may jump
    };
    Equations(Setup setup, const Numbering& numbering);

    int size() const { return numbering_.size(); }
    const Setup& setup() const { return setup_; }
    const Numbering& numbering() const { return numbering_; }
    /// Makes the tied multipliers of `fields` what their terms say.
    void tie(Fields& fields) const;
    Fields zero_fields() const;

    /// Rows at `fields`; the solved ones are returned, all are kept for end_momentum(). Tells of a load that
    /// is not finite, empty if all are.
    std::string residual(const Fields& fields, std::vector<double>& r);
    /// Matrix d(residual)/d(unknowns) at `fields`. Returns whether its pattern differs from the last one.
    bool tangent(const Fields& fields, SparseMatrix& J);
    /// fields + factor * increment of the unknowns.
    void add(Fields& fields, std::span<const double> increment, double factor) const;
    /// The momentum that the law gives at an end, from the rows of the last residual(); for the strong start
    /// the value of P.
    std::vector<Matrix34> end_momentum(const Fields& fields, bool at_end) const;

    /// Diagonal scales of rows and columns by mass and element length: X ~ h / sqrt(m), P ~ sqrt(m), lambda ~
    /// 1 / h (docs/theory.md, "Scaling").
    void scales(const Fields& fields, std::vector<double>& of_rows, std::vector<double>& of_columns) const;
    /// Largest increment: |dx| / length of points, |dd| of directors, and what the momenta's would move in
    /// one element.
    double size_of(std::span<const double> increment) const;
    /// The largest scaled residual and its place.
    Worst worst(const std::vector<double>& r, const std::vector<double>& scale_of_rows) const;

    /// X at an end of the block.
    std::vector<Matrix34> end_position(const Fields& fields, bool at_end) const;
    /// Values at the place s of an element: n_coordinates numbers, multipliers n_rows.
    void evaluate_X(const Fields& fields, int element, double s, double* X) const;
    void evaluate_P(const Fields& fields, int element, double s, double* P) const;
    void evaluate_multipliers(const Fields& fields, int element, double s, double* lambda) const;
    /// First trial function of an element's multipliers; test functions are those of setup().multipliers.
    int first_multiplier(int e) const { return setup_.multipliers.first(e) + tables_.n_tears[e]; }
    /// Middle of the elements where function A lives.
    double centre(int A) const { return tables_.centres[A]; }

private:
    /// One Gauss point of an element.
    struct Sample {
        std::vector<double> x, v, p, p_rate;
        std::vector<double> X, V, F;   ///< 12 numbers a body
        std::vector<double> lambda;
    };
    /// What depends on time alone. Tables: element, Gauss point, local function.
    struct TimeTables {
        std::vector<double> gauss_places, gauss_weights;
        std::vector<double> M, D, L;
        std::vector<double> lengths;   ///< mean element length of each function
        std::vector<double> centres;   ///< middle of the elements where it lives
        std::vector<int> n_tears;      ///< up to the start of each element
    };
    /// Rows of all functions, the solved and the others.
    struct RawRows {
        std::vector<double> dP, dX, dlambda;
    };
    using Mask = std::bitset<144>;
    struct LoadBlock {
        int load, by, of;   ///< derivative of the force on body `by` by X of body `of` (0 or 1 of the load)
        Mask emitted, seen;
    };
    /// Sums over the Gauss points of an element, for every pair of local functions.
    struct Local {
        std::vector<double> MM, MD;
        std::vector<double> G;       ///< M_a L_b times the gradient's entries
        std::vector<double> K;       ///< M_a M_b lambda, rows
        std::vector<double> loads;   ///< 144 a block
    };

    const double* M(int e, int g) const { return tables_.M.data() + (e * n_gauss() + g) * n_local(); }
    const double* D(int e, int g) const { return tables_.D.data() + (e * n_gauss() + g) * n_local(); }
    const double* L(int e, int g) const
    {
        return tables_.L.data() + (e * n_gauss() + g) * n_local_multipliers();
    }
    double weight(int e, int g) const { return tables_.gauss_weights[g] * setup_.space.length(e); }
    double time(int e, int g) const
    {
        return setup_.space.ends()[e] + tables_.gauss_places[g] * setup_.space.length(e);
    }
    int n_gauss() const { return setup_.gauss_points; }
    int n_local() const { return setup_.space.degree() + 1; }
    int n_local_multipliers() const { return setup_.multipliers.degree() + 1; }

    void tabulate();
    void make_ties();
    void sample(const Fields& fields, int e, int g);
    void add_rows(int e, int g);
    void add_boundary(const Fields& fields, std::vector<double>& r) const;
    std::vector<Matrix34> given_momentum(const Fields& fields, bool at_end) const;
    void evaluate(const TimeSpace& space, int first, const std::vector<double>& coefficients, int n,
                  int element, double s, double* out) const;

    void make_pattern(SparseMatrix& J);
    void clear(Local& local) const;
    void sum_element(const Fields& fields, int e);
    void sum_loads(int e, int g);
    template <class Sink>
    void visit_all(const Fields* fields, Sink&& sink);
    template <class Sink>
    void visit_momenta(int e, Sink&& sink) const;
    template <class Sink>
    void visit_forces(int e, Sink&& sink) const;
    template <class Sink>
    void visit_constraints(int e, Sink&& sink) const;
    template <class Sink>
    void visit_boundary(const Fields* fields, Sink&& sink) const;

    Setup setup_;
    Numbering numbering_;
    std::vector<Tie> ties_;
    TimeTables tables_;
    RawRows raw_;
    std::vector<LoadBlock> load_blocks_;
    std::vector<int> slots_;   ///< place in the matrix of every entry that visit_all() makes
    Sample sample_;
    Local local_;
    std::vector<double> gradients_;
};

}   // namespace livens::mixed
