// The one entry: model, conditions, time elements and method in; motion and report out.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "livens/multibody/assembly.h"
#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"
#include "livens/solvers/report.h"
#include "livens/solvers/sparse.h"
#include "livens/time/time_mesh.h"

namespace livens {

/// Continuous X of degree p per element, nodes and quadrature at Gauss-Lobatto points; order 2p at element
/// ends.
struct Lobatto {
    int degree = 4;   ///< 1..16
};

/// The elements of the paper: X, P and multipliers are separate fields over one time basis, directors are
/// free and rigidity holds weakly (P10, P11, P23). Order 2 to degree + 1 at the ends of blocks, see
/// docs/theory.md.
struct Mixed {
    enum class Basis {
        lagrange,   ///< continuous, equidistant nodes
        bspline,    ///< as smooth as the knots allow
        nurbs       ///< likewise, with weights
    };
    /// How the momentum at the ends enters.
    enum class Start {
        natural,   ///< as the boundary term of Hamilton's law (P10); momenta balance to rounding
        strong     ///< as a value of the field P (P11, P13, P15)
    };
    /// Test and trial functions of the multipliers (Remark 3.1).
    enum class Multipliers {
        equal,   ///< those of X
        lower    ///< one degree less
    };
    /// The multiplier of the function at an end whose row defines the momentum (natural start, equal
    /// multipliers): it is no unknown.
    enum class EndMultiplier {
        smooth,   ///< such that the multipliers are of one degree less in that element
        zero      ///< as if the trial functions lacked this one; every degree is then held down to order 4
    };
    /// What the next block takes over: end positions and momenta as they are, or brought onto the
    /// constraints.
    enum class Interfaces { carry, project };
    /// Where Newton begins when the state is given at one end.
    enum class FirstGuess {
        march,   ///< a march of lobatto(2) over the block's elements
        steady   ///< straight on with the velocities given: good for short blocks only
    };

    Basis basis = Basis::lagrange;
    int degree = 2;   ///< 1..8
    Start start = Start::natural;
    Multipliers multipliers = Multipliers::equal;
    EndMultiplier end_multiplier = EndMultiplier::smooth;
    int gauss_points = 0;   ///< an element; 0: as many as integrate polynomials exactly
    int block = 0;          ///< elements solved at once; 0: all
    Interfaces interfaces = Interfaces::carry;
    FirstGuess first_guess = FirstGuess::march;
    /// Clamped knot vector (s) of splines over all of time, whose knots are the ends of the mesh; needs a
    /// single block. Empty: as smooth as possible, but for kinks where a load jumps or bends.
    std::vector<double> knots;
    std::vector<double> weights;   ///< of NURBS, one for each function; needs a single block
    SparseBackend linear_solver = SparseBackend::eigen;
};

/// Classical rules, one step per element: independent witnesses.
struct Midpoint {};   ///< energy-momentum midpoint rule, order 2
struct Endpoint {};   ///< implicit Euler, order 1

using Method = std::variant<Lobatto, Mixed, Midpoint, Endpoint>;

/// "lobatto(6)", "mixed(bspline, 2, natural, equal)", "midpoint", "endpoint".
std::string name_of(const Method& method);

/// What is given at one end of time.
enum class Given {
    nothing,
    positions,   ///< X
    momenta,     ///< of each body the linear momentum and the moment of momentum about its reference point,
                 ///< those of the X and V that are stated
    state        ///< X and momenta
};

/// Conditions at the ends of time. In all, positions and momenta must be given once each (the two may be of
/// different ends). lobatto and the classical rules need the whole state at the start in this version.
struct Boundary {
    State start;
    Given at_start = Given::state;
    State end{};
    Given at_end = Given::nothing;
};

struct SolveOptions {
    /// Newton stops when the estimated error of the scaled increment is below this (relative to the motion
    /// inside the element, at least to 1e-6 of the model's length), or at the rounding level of the residual.
    double tolerance = 1e-12;
    int max_iterations = 30;
    StartPolicy initial = StartPolicy::check;
    ProgressCallback progress;
    int threads = 0;   ///< reserved
    /// Condition numbers of the whole matrix, in the report: of the last block (mixed), of all elements
    /// together, reduced to the free motions (lobatto).
    bool condition = false;
};

struct Solution {
    Motion motion;   ///< up to the last good element end
    SolveReport report;
};

/// Throws InputError for wrong input (degree out of range, a start that does not fit, see assemble(),
/// pairings and conditions that make no solvable system, `mass-singular` where the method divides by m).
/// Numerical failure is in the report.
Solution solve(const Model& model, const Boundary& boundary, const TimeMesh& mesh, const Method& method,
               const SolveOptions& options = {});

/// Throws what solve() would throw for this input, without solving.
void check_method(const Model& model, const Boundary& boundary, const TimeMesh& mesh, const Method& method,
                  const SolveOptions& options = {});

/// The state at any instant in the full order of the method: one shortened element is solved from the start
/// of the element that contains t (from the stored end state). Status and message are in the report.
struct ExactSample {
    State state;
    SolveReport report;
};
ExactSample sample_exactly(const Model& model, const Motion& motion, const Method& method, double t,
                           const SolveOptions& options = {});

}   // namespace livens
