// SPDX-License-Identifier: BSD-3-Clause
// A motion: what every method returns and every diagnosis reads.
#pragma once

#include <span>
#include <vector>

#include "livens/base/linear.h"
#include "livens/multibody/state.h"
#include "livens/time/basis.h"
#include "livens/time/time_mesh.h"

namespace [[gnu::visibility("default")]] livens {

struct Joint;
struct ReactionInput;

/// A function of time that is a polynomial in every element, or a quotient of two, by its values at that
/// element's local nodes.
///
/// Local nodes are the `points` of `degree` (degree 0: one value an element). If continuous,
/// neighbours share the value at their common end: coefficient (e, a) is entry e * degree + a; else e *
/// (degree + 1) + a. With denominators W_a (NURBS, one for each coefficient) the function is
/// sum_a M_a W_a x_a / sum_a M_a W_a with the Lagrange polynomials M_a of these nodes.
struct Field {
    int n_values = 0;   ///< numbers a coefficient
    int degree = 0;
    bool continuous = true;
    std::vector<double> values;           ///< coefficient after coefficient
    std::vector<double> denominators{};   ///< positive, one a coefficient; empty: polynomials
    Points points = Points::lobatto;

    bool empty() const { return values.empty(); }
    /// Place of coefficient (element, a) among all.
    int index(int element, int a) const { return element * (continuous ? degree : degree + 1) + a; }
    /// The basis on the local nodes in [0, 1]; the node of degree 0 is 1/2.
    LagrangeBasis basis() const;
    std::span<const double> coefficient(int element, int a) const;
    std::span<double> coefficient(int element, int a);
    /// Value (derivative = 0) or derivative by the local coordinate s in [0, 1] (divide by the element's
    /// length).
    void evaluate(int element, double s, int derivative, std::span<double> out) const;
    /// Makes of the values M_a (and derivatives M_a', or none) of the Lagrange polynomials at a point of the
    /// element those of the functions M_a W_a / sum_b M_b W_b, which also add up to one (and to zero).
    /// Nothing to do without denominators.
    void make_rational(int element, std::span<double> M, std::span<double> derivatives) const;
};

/// Where a method holds constraints to rounding; weakly: as integrals over elements.
enum class ConstraintsHold { unknown, at_nodes, at_element_ends, weakly };
/// "", "element nodes", "element ends", "weakly"
const char* to_string(ConstraintsHold where);

/// Element ends with an impact, ascending, and how momenta and velocities were before it: entry (impact *
/// n_bodies + body), as EndValues has them behind it.
struct Impacts {
    std::vector<int> ends{};
    std::vector<Matrix34> momenta{}, velocities{};

    /// -1: there is none at this element end.
    int at(int end) const;
};

/// At element ends, entry (end * n_bodies + body), or (2 * end + side) with side 0 = left, 1 = right.
struct EndValues {
    std::vector<Matrix34> momenta;         ///< tangent momentum P = X' m
    std::vector<Matrix34> velocities;      ///< X' = [v, w x d_i], from the momentum
    std::vector<Matrix34> accelerations;   ///< X'', entry ((2 * end + side) * n_bodies + body); may be empty
    std::vector<double> load_angles;       ///< rows of Turns; empty: nobody counted
    std::vector<double> end_multipliers;   ///< acceleration level, (2 * end + side) * n_rows + row; or empty
    Impacts impacts{};                     ///< behind which momenta and velocities above are
};

/// The method that made a motion, and what may be believed of it.
struct Discretisation {
    int order_at_ends = 0;   ///< of X and momenta at element ends; 0: none is known
    int dense_order_X = 0;   ///< of X between nodes
    int dense_order_V = 0;   ///< of its derivative between nodes
    ConstraintsHold constraints_hold = ConstraintsHold::unknown;
    int gauss_points = 0;          ///< of the method's quadrature in an element; 0: its own nodes
    std::vector<int> block_ends;   ///< element ends where a block of elements solved together begins or ends,
                                   ///< ascending; empty: every element is a block
};

/// The whole motion of a model.
///
/// Bodies are stacked in the order of the model, 12 numbers each (columns of X); joint multipliers in the
/// order of its rows. At element ends EndValues win over the polynomials: they are of the full order of the
/// method.
struct Motion : EndValues, Discretisation {
    int n_bodies = 0;
    int n_rows = 0;
    TimeMesh mesh;

    Field X;             ///< m | 1
    Field P;             ///< momentum X' m inside elements; empty: it is the derivative of X times m
    Field multipliers;   ///< of joint rows at the local nodes, one-sided at element ends; dropped rows are 0
    Field rigidity;   ///< multipliers of rigidity_rows(), six a body (0 for points), where bodies are rigid
                      ///< only by them; empty: see rigidity_multipliers()
    std::vector<int> redundant_rows;   ///< of joints: their multipliers are not unique

    int n_elements() const { return mesh.n_elements(); }
    double start() const { return mesh.start(); }
    double end() const { return mesh.end(); }
    /// The method takes energy by construction: what is lost is not held against the motion.
    bool damps() const { return X.points == Points::radau; }

    /// What its arrays take in memory.
    std::size_t n_bytes() const;

    /// X and V at any instant: at element ends the end values, else the polynomial and its derivative.
    State at(double t) const;
    /// On one side of an impact.
    State at_end(int end, Side side = Side::right) const;
    void at_end(int end, Side side, State& state) const;   ///< in the memory of this one

private:
    std::span<const double> angles_at(int end) const;
};

/// What the joint exerts on its second body.
struct Reaction {
    Vector3 force{};    ///< N, world axes
    Vector3 torque{};   ///< N m about the joint point on the second body, world axes
};

/// Force and torque of -G^T lambda on the joint's second body, in state X and with all multipliers of the
/// model; a model with drives wants to be frozen() first.
Reaction joint_reaction(const Model& model, int joint, std::span<const Matrix34> X,
                        std::span<const double> multipliers);
/// The same from what the joint does to X of its second body: F of -G^T lambda.
Reaction joint_reaction(const Joint& joint, const Matrix34& X_second, const Matrix34& F);
/// What an input reads of it.
double number_of(const Reaction& reaction, const ReactionInput& input);

}   // namespace livens
