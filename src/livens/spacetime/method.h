// SPDX-License-Identifier: BSD-3-Clause
// Integration methods and their options.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "livens/solvers/sparse.h"
#include "livens/time/time_mesh.h"

namespace [[gnu::visibility("default")]] livens {

/// Continuous X of degree p per element, nodes and quadrature at Gauss-Lobatto points; order 2p at element
/// ends.
struct Lobatto {
    int degree = 4;   ///< 1..16; 0: chosen for an accuracy, see Span
    /// Number of elements solved together, 0: all; with conditions at both ends always all.
    int window = 1;
};

/// The stiffly accurate counterpart: nodes at the start and at the right Radau points, where loads are
/// evaluated and constraints and equations of motion hold; order 2p - 1 at element ends. It damps vibrations
/// that are not resolved, and needs a given initial state.
struct Radau {
    int degree = 4;   ///< 1..8
};

/// The elements of Hesch, Glas and Schuss: X, P and multipliers are independent fields over one time basis,
/// directors are free and rigidity holds weakly (P10, P11, P23). Order 2 to degree + 1 at block ends, see
/// docs/theory.md.
struct Mixed {
    /// Defined in mixed/bases.cpp, in this order.
    enum class Basis { lagrange, bspline, nurbs };
    /// How the momentum enters at the ends.
    enum class Start {
        natural,   ///< as boundary term of Hamilton's law (P10); momenta balance to rounding
        strong     ///< as a value of the field P (P11, P13, P15)
    };
    /// Test and trial functions of the multipliers (Remark 3.1).
    enum class Multipliers {
        equal,   ///< those of X
        lower    ///< one degree less
    };
    /// The multiplier at an end where the momentum is defined (natural start, equal multipliers), which
    /// the equations do not determine.
    enum class EndMultiplier {
        smooth,   ///< the multipliers have one degree less in that element
        zero      ///< its function is left out; this limits the order to 4 for any degree
    };
    /// Initial values of the next block: end positions and momenta unchanged, or projected onto the
    /// constraints.
    enum class Interfaces { carry, project };
    /// First guess of Newton's iteration if the state is given at one end.
    enum class FirstGuess {
        march,   ///< a solution by lobatto(degree + 2) on the elements of the block
        steady   ///< constant velocities: for short blocks only
    };

    Basis basis = Basis::lagrange;
    int degree = 2;   ///< 1..8
    Start start = Start::natural;
    Multipliers multipliers = Multipliers::equal;
    EndMultiplier end_multiplier = EndMultiplier::smooth;
    int gauss_points = 0;   ///< per element; 0: enough to integrate polynomials exactly
    int window = 0;         ///< number of elements solved together, a block; 0: all
    Interfaces interfaces = Interfaces::carry;
    FirstGuess first_guess = FirstGuess::march;
    /// Clamped knot vector (s) of the splines, whose knots are the element ends of the mesh; needs a single
    /// block. Empty: as smooth as possible, with kinks at jumps and kinks of loads.
    std::vector<double> knots;
    std::vector<double> weights;   ///< of NURBS, one per basis function; needs a single block
    SparseBackend linear_solver = SparseBackend::eigen;

    /// See witness_of(). lobatto of a higher order than these elements with any basis and pairing; also
    /// the first guess.
    Lobatto witness() const { return {degree + 2}; }
};

// Words of these choices in scenarios, results and method names, in the order of the enumerators.
constexpr std::array<std::string_view, 2> words_of(Mixed::Start) { return {"natural", "strong"}; }
constexpr std::array<std::string_view, 2> words_of(Mixed::Multipliers) { return {"equal", "lower"}; }
constexpr std::array<std::string_view, 2> words_of(Mixed::EndMultiplier) { return {"smooth", "zero"}; }
constexpr std::array<std::string_view, 2> words_of(Mixed::Interfaces) { return {"carry", "project"}; }
constexpr std::array<std::string_view, 2> words_of(Mixed::FirstGuess) { return {"march", "steady"}; }

/// The word of a choice that has words_of().
template <class Choice>
constexpr std::string_view word_of(Choice choice)
{
    return words_of(choice)[static_cast<std::size_t>(choice)];
}

/// Energy-momentum midpoint rule of order 2, one step per element; shares no code with spacetime elements.
struct Midpoint {
    Lobatto witness() const { return {3}; }   ///< see witness_of()
};

/// Implicit Euler of order 1, likewise. Its witness damps as it does.
struct Endpoint {
    Radau witness() const { return {3}; }   ///< see witness_of()
};

/// Lobatto, or Radau if fast decay or irrelevant vibrations would dictate the element length of lobatto. With
/// an accuracy only; Solution::method is the method used.
struct AutomaticFamily {
    int degree = 0;   ///< 1..16, radau uses at most 8; 0: chosen for the accuracy, see Span
};

using Method = std::variant<Lobatto, Radau, Mixed, Midpoint, Endpoint, AutomaticFamily>;

/// Lobatto and Radau: one family on two sets of points, with constraints at the nodes.
inline bool is_nodal(const Method& method)
{
    return std::holds_alternative<Lobatto>(method) || std::holds_alternative<Radau>(method) ||
           std::holds_alternative<AutomaticFamily>(method);
}

/// Whether the method has time elements, unlike the classical rules.
inline bool is_elements(const Method& method)
{
    return is_nodal(method) || std::holds_alternative<Mixed>(method);
}

/// The method of the second solution, from which the error is estimated: nodal elements of a higher order on
/// the same mesh; nodal elements themselves unchanged.
inline Method witness_of(const Method& method)
{
    return std::visit(
        [](const auto& one) -> Method {
            if constexpr (requires { one.witness(); })
                return one.witness();
            else
                return one;
        },
        method);
}

/// The elements between the knots of a method with knots. Throws InputError for invalid knots or weights.
TimeMesh mesh_of_knots(const Mixed& mixed);

/// "lobatto(6)", "radau(4)", "mixed(bspline, 2, natural, equal)", "midpoint", "endpoint", "auto".
std::string name_of(const Method& method);

}   // namespace livens
