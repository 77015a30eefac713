// One time element: its rows, its tangent, and Newton's iteration.
#pragma once

#include <memory>
#include <vector>

#include "livens/solvers/report.h"
#include "livens/spacetime/lobatto/elimination.h"
#include "livens/multibody/instant.h"
#include "livens/multibody/tables.h"
#include "livens/spacetime/lobatto/rule.h"
#include "livens/multibody/twist.h"

namespace livens {

struct NewtonOptions {
    double tolerance = 1e-12;
    int max_iterations = 30;
    bool rescue = true;   ///< try a guess from small elements where the iteration fails
};

struct ElementReport {
    SolveStatus status = SolveStatus::converged;
    int iterations = 0;
    int factorisations = 0;
    int guess_factorisations = 0;   ///< of smaller tangents, for the first guess
    bool rescued = false;           ///< the guess came from small elements
    double residual = 0;            ///< largest row relative to its own terms
    double smallest_pivot = 1;      ///< of the scaled constraint Jacobians
    int worst_row = -1;             ///< constraint row violated most, of the model; -1: none
    int worst_body = -1;            ///< body with the largest residual
};

/// The equations of one element in twists and joint multipliers, for given state at its start:
///
///     rows A = 0..p-1    N^T [ h^-1 sum_B k_AB (X_B - X_0) m + F_A + (A = 0) P_0 - h w_A G^T lambda_A ] = 0
///     nodes B = 1..p     Phi(X_B) = 0,      F_A = h sum_c w_c M_A(s_c) F(X(s_c), X'(s_c))
///
/// (docs/theory.md, "The element".) Multipliers are eliminated node by node with an orthogonal basis of the
/// constraint directions, so only the null-space unknowns of nodes 1..p are solved for.
class Element {
public:
    Element(const Tables& tables, const LobattoRule& rule);

    /// Solves from `start` over [start.t, start.t + h]. On success nodes, multipliers and the final momentum
    /// are readable below; on failure they are undefined and `start` is untouched.
    ElementReport solve(const InstantState& start, double t_end, const NewtonOptions& options);

    /// X at local node A: 12 numbers a body.
    const double* X(int A) const { return X_.data() + node(A); }
    /// X less the start, which holds more digits.
    const double* dX(int A) const { return dX_.data() + node(A); }
    /// Joint multipliers at nodes 0..p-1, all rows of the model.
    void multipliers(int A, double* lambda) const;
    /// Momentum and spin (about the centre of mass) handed on, before their tangent projection.
    const double* final_momentum() const { return q_.data() + twist_node(rule_.degree); }

    /// The constraint basis of the last node, if it fits the node's final place to rounding; for taking away.
    ConstraintBasis* final_basis() { return correction_ < 1e-15 ? &bases_.back() : nullptr; }

    int unknowns() const { return elimination_.unknowns(); }
    int n_nodes() const { return rule_.degree + 1; }

    // The equations themselves, for tests of the tangent.

    /// Makes `start` and the element's interval current and predicts the nodes.
    void begin(const InstantState& start, double t_end);
    /// Moves node B (1..p) by a twist (n_twists numbers).
    void move(int B, const double* xi);
    /// Configurations, constraints and rows of all nodes. False if something is not finite.
    bool evaluate();
    /// Rows at node A for fixed multipliers `lambda` (all rows of the model) and fixed maps: for
    /// differences.
    std::vector<double> rows_with(int A, const std::vector<double>& lambda, const double* maps) const;
    /// d(rows at nodes 0..p-1)/d(twists of nodes 1..p) at fixed multipliers, row by row, with rows and twists
    /// scaled by the maps of their nodes (which are not differentiated).
    std::vector<double> tangent();
    const double* maps(int A) const { return maps_.data() + node(A); }

private:
    struct Step {
        double size = 0;      // largest scaled increment
        double motion = 0;    // largest scaled motion inside the element
        double impulse = 0;   // largest mass times motion over h, in scaled rows
    };

    std::size_t node(int A) const { return static_cast<std::size_t>(A) * X0_.size(); }
    std::size_t twist_node(int A) const { return static_cast<std::size_t>(A) * static_cast<std::size_t>(n_); }
    double bend() const;
    double guess_error() const;
    void predict();
    void guess(ElementReport& report);
    bool guess_from_coarse(ElementReport& report);
    bool guess_from_march(int pieces);
    void place(int A, const InstantState& state);
    ElementReport iterate(ElementReport report, const NewtonOptions& options);
    void configure(int B);
    bool evaluate_constraints();
    void evaluate_row(int A);
    ElementReport finish(const ElementReport& report);
    void eliminate_multipliers(int A);
    void evaluate_forces();
    void interpolate(int c, double* X, double* V) const;
    void subtract_reactions(int A, double* raw) const;
    double size_of(const double* xi) const;
    void scale_block(int A, int i, int B, int j, const double* block, double* out) const;
    template <class Sink>
    void form_tangent(Sink&& sink);
    template <class Sink>
    void node_terms(int A, Sink&& sink);
    template <class Sink>
    void load_terms(int A, int B, Sink&& sink);
    void evaluate_load_tangents();
    double rounding_of(const Load& load, const LoadArguments& at, const LoadTangent& tangent) const;
    bool factorise();
    Step solve_step();
    void measure(int B, Step& step) const;
    void attach(const InstantState& start, double t_end);
    void correct_constraints();
    bool finish_evaluation(bool correct);
    bool settle();
    ElementReport fail(SolveStatus status, ElementReport report) const;

    const Tables& tables_;
    LobattoRule rule_;
    std::unique_ptr<Element> coarse_;   // half the degree, for guesses
    std::vector<double> to_fine_;       // values of its basis at the nodes here, node after node
    Elimination elimination_;
    int n_;   // twists a node
    double t0_ = 0, t1_ = 0, h_ = 0;
    const InstantState* start_ = nullptr;

    std::vector<twist::Increment> increments_;   // (p + 1) x bodies
    std::vector<double> X0_;                     // 12 a body
    std::vector<double> dX_, X_;                 // (p + 1) x 12 a body
    std::vector<double> raw_;                    // (p + 1) x 12 a body: the bracket without multipliers
    std::vector<double> forces_;                 // (p + 1) x 12 a body: F_A
    std::vector<double> X_c_, V_c_;              // 12 a body, X and X' at one Gauss point
    std::vector<double> maps_;                 // (p + 1) x 12 a body: maps of the scaled twists
    std::vector<double> q_;                      // (p + 1) x n: N^T raw
    std::vector<ConstraintBasis> bases_;         // nodes 1..p; node 0 uses the start's
    std::vector<const OrthogonalBasis*> orthogonal_;
    std::vector<double> phi_;      // (p + 1) x rank, scaled rows
    std::vector<double> phi0_;     // rank
    double correction_ = 0;        // largest move back to the constraints
    std::vector<double> lambda_;   // (p + 1) x rank
    std::vector<double> rho_;      // p x f reduced rows, negative: the right-hand side
    std::vector<double> work_, twist_, scratch_;
    std::vector<double> blocks_;               // 36 a body
    std::vector<LoadTangent> load_tangents_;   // of all loads with tangents, Gauss point after Gauss point
    double largest_k_ = 0;
    double terms_ = 0;         // size of the terms in the rows, for the rounding level
    double rows_size_ = 0;     // largest reduced row
    double start_terms_ = 0;   // of the momentum at the start
    double load_rounding_ = 0;   // of the loads in the rows: what they make of the rounding of X and X'
    double smallest_pivot_ = 1;
    bool near_ = true;            // violations are small enough for one linear step
    bool pending_ = false;        // and are left to the next one
    bool keep_choices_ = false;   // null spaces vary smoothly while a tangent is in use
};

}   // namespace livens
