// SPDX-License-Identifier: BSD-3-Clause
// The methods and their options.
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
    int degree = 4;   ///< 1..16; 0: as an accuracy has it, see Span
    /// Elements solved together, 0: all. The equations are the same; conditions at both ends take all.
    int window = 1;
};

/// The stiffly accurate sibling: nodes at the start and at the right Radau points, where loads are taken and
/// constraints and equations of motion hold; order 2p - 1 at element ends. It damps what it does not resolve,
/// and takes the state at the start only.
struct Radau {
    int degree = 4;   ///< 1..8
};

/// The elements of the paper: X, P and multipliers are separate fields over one time basis, directors are
/// free and rigidity holds weakly (P10, P11, P23). Order 2 to degree + 1 at the ends of blocks, see
/// docs/theory.md.
struct Mixed {
    /// What each of them is stands in mixed/bases.cpp, in this order.
    enum class Basis { lagrange, bspline, nurbs };
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
        march,   ///< a march of lobatto(degree + 2) over the block's elements
        steady   ///< straight on with the velocities given: good for short blocks only
    };

    Basis basis = Basis::lagrange;
    int degree = 2;   ///< 1..8
    Start start = Start::natural;
    Multipliers multipliers = Multipliers::equal;
    EndMultiplier end_multiplier = EndMultiplier::smooth;
    int gauss_points = 0;   ///< an element; 0: as many as integrate polynomials exactly
    int window = 0;         ///< elements solved together, a block; 0: all
    Interfaces interfaces = Interfaces::carry;
    FirstGuess first_guess = FirstGuess::march;
    /// Clamped knot vector (s) of splines over all of time, whose knots are the ends of the mesh; needs a
    /// single block. Empty: as smooth as possible, but for kinks where a load jumps or bends.
    std::vector<double> knots;
    std::vector<double> weights;   ///< of NURBS, one for each function; needs a single block
    SparseBackend linear_solver = SparseBackend::eigen;

    /// See witness_of(). lobatto of a higher order than these elements have with any basis and pairing: their
    /// guess, too.
    Lobatto witness() const { return {degree + 2}; }
};

// The words of choices in scenarios, results and names of methods, in the order of the enumerators.
constexpr std::array<std::string_view, 2> words_of(Mixed::Start) { return {"natural", "strong"}; }
constexpr std::array<std::string_view, 2> words_of(Mixed::Multipliers) { return {"equal", "lower"}; }
constexpr std::array<std::string_view, 2> words_of(Mixed::EndMultiplier) { return {"smooth", "zero"}; }
constexpr std::array<std::string_view, 2> words_of(Mixed::Interfaces) { return {"carry", "project"}; }
constexpr std::array<std::string_view, 2> words_of(Mixed::FirstGuess) { return {"march", "steady"}; }

/// That of a choice whose words stand beside it like these.
template <class Choice>
constexpr std::string_view word_of(Choice choice)
{
    return words_of(choice)[static_cast<std::size_t>(choice)];
}

/// Energy-momentum midpoint rule of order 2, a step an element: it shares nothing with spacetime elements.
struct Midpoint {
    Lobatto witness() const { return {3}; }   ///< see witness_of()
};

/// Implicit Euler of order 1, likewise. Its witness damps as it does.
struct Endpoint {
    Radau witness() const { return {3}; }   ///< see witness_of()
};

/// Lobatto; Radau where fast decays, or vibrations that do not matter, would rule lobatto's elements. With an
/// accuracy only; Solution::method says what was taken.
struct AutomaticFamily {
    int degree = 0;   ///< 1..16, radau takes 8 of it at most; 0: as the accuracy has it, see Span
};

using Method = std::variant<Lobatto, Radau, Mixed, Midpoint, Endpoint, AutomaticFamily>;

/// Lobatto and Radau: one family on two sets of points, with constraints at the nodes.
inline bool is_nodal(const Method& method)
{
    return std::holds_alternative<Lobatto>(method) || std::holds_alternative<Radau>(method) ||
           std::holds_alternative<AutomaticFamily>(method);
}

/// Not the classical rules.
inline bool is_elements(const Method& method)
{
    return is_nodal(method) || std::holds_alternative<Mixed>(method);
}

/// Nodal elements of a higher order, on whose second solution on the same mesh the error of a method is told;
/// of nodal elements themselves, as they are.
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

/// The elements between the knots of a method that has some. Throws what is wrong with knots and weights.
TimeMesh mesh_of_knots(const Mixed& mixed);

/// "lobatto(6)", "radau(4)", "mixed(bspline, 2, natural, equal)", "midpoint", "endpoint", "auto".
std::string name_of(const Method& method);

}   // namespace gnu::visibility("default")]]livens
