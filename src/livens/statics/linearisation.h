// SPDX-License-Identifier: BSD-3-Clause
// Small motions about a state of rest: matrices on what the joints leave free, modes, stability, and the
// state matrices between chosen inputs and outputs.  (docs/theory.md, "Small motions")
#pragma once

#include <array>
#include <complex>
#include <string>
#include <vector>

#include "livens/dynamics/start/consistent_start.h"
#include "livens/multibody/loads.h"

namespace [[gnu::visibility("default")]] livens {

/// Of states z of controllers, in units s z of their bodies' velocities, s in `scale`:
///     M q'' + C q' + K q + by_states s z = forces along q,
///     s z' + own s z + by_q q + by_rates q' = 0.
struct LinearStates {
    std::vector<std::string> names;
    std::vector<double> values;   ///< at rest
    std::vector<double> scale;
    std::vector<double> by_states;        ///< n x n_states, row by row
    std::vector<double> by_q, by_rates;   ///< n_states x n
    std::vector<double> own;              ///< n_states x n_states

    int n() const { return static_cast<int>(names.size()); }
};

/// M q'' + C q' + K q = forces along q, about a state of rest in equilibrium. The n coordinates q are the
/// amplitudes of small motions that all joints allow, orthonormal in the mass metric (M = 1 unless an inertia
/// is singular). Loads that depend on time and drives are held at the values they have at that instant. K and
/// C need not be symmetric: forces that turn with a body make K unsymmetric.
struct Linearisation {
    State state;   ///< V = 0, but of what holds states
    int n = 0;
    std::vector<double> M, C, K;   ///< n x n, row by row
    /// Of each body the displacement of its reference point (by m) and its rotation vector (world axes) by q:
    /// 6 n_bodies x n, row by row; of a point mass the last three rows are zero.
    std::vector<double> twists;
    double length = 1;             ///< Model::length()
    double rounding = 0;           ///< of K and its eigenvalues: 1e-12 of the largest terms in K, 1/s^2
    double damping_rounding = 0;   ///< likewise of C, 1/s
    /// K is symmetric, and C is symmetric without negative eigenvalues; and there are no states.
    bool is_conservative = true;
    LinearStates states{};
};

/// The largest |F - G^T lambda| of a body, in the mass metric, that a state in equilibrium may have, relative
/// to the largest terms in it.
inline constexpr double equilibrium_tolerance = 1e-8;

/// Closed as by StartPolicy::project. Where drives would move the mechanism it wants to be frozen(), as it is
/// where find_equilibrium() found it. Throws InputError, see consistent_start(), and
///   `not-at-rest`         velocities, of drives too, above 1e-9 lengths of the model a second or 1e-9 rad/s
///   `not-in-equilibrium`  forces that are not balanced to equilibrium_tolerance; the body is named; a stop
///                         that would have to pull
///   `event-method`        a stop that is touched without a force
/// Stops that push are rows.
Linearisation linearise(const Model& model, const State& state, Side side = Side::right);

/// How a body goes in a mode, world axes: complex, since parts may lag behind each other.
struct BodyShape {
    std::array<std::complex<double>, 3> displacement{};   ///< of the reference point, m
    std::array<std::complex<double>, 3> rotation{};       ///< rotation vector, rad
};

/// A motion e^(s t) times a shape, which is scaled so that the largest displacement of a body, over the
/// model's length, or rotation is 1, and turned so that its largest component is real and positive.
struct VibrationMode {
    std::complex<double> s;          ///< 1/s; of a conjugate pair the one with the positive imaginary part
    std::vector<BodyShape> bodies;   ///< of all bodies

    double frequency() const { return std::abs(s); }   ///< rad/s: without damping the frequency itself
    /// -Re s / |s|: 0 undamped, 1 where it dies without a vibration, negative where it grows; 0 for s = 0.
    double damping_ratio() const { return s == 0.0 ? 0 : -s.real() / std::abs(s); }
};

/// By ascending |s|. n modes where nothing damps and K is symmetric: vibrations, and s = sqrt(-k) for what
/// grows; else a mode for each conjugate pair and each real s. |s|^2 below Linearisation::rounding is 0.
std::vector<VibrationMode> vibration_modes(const Linearisation& linear);

/// The amplitude of a joint coordinate in a mode, rad or m.
std::complex<double> amplitude(const Linearisation& linear, const VibrationMode& mode,
                               const JointCoordinate& coordinate);

enum class Stability {
    stable,    ///< every small motion stays small
    neutral,   ///< none grows exponentially, but some directions nothing restores
    unstable
};
const char* to_string(Stability stability);

/// Where it is conservative, by the eigenvalues k of K against M: unstable k < -rounding, neutral |k| <=
/// rounding. Else by the roots s: those with a real part above 1e-10 of the largest |s| grow, and directions
/// are neutral in which K has a singular value below the rounding.
struct StabilityReport {
    Stability stability = Stability::stable;
    int n_unstable = 0;
    int n_neutral = 0;
};
StabilityReport stability(const Linearisation& linear);

/// x' = A x + B u, y = C x + D u with x = (q, q', z), deviations from the state of rest. Matrices row by row.
struct StateMatrices {
    int n_states = 0;   ///< numbers of x
    std::vector<std::string> inputs, outputs;
    std::vector<double> A, B, C, D;
};

/// Names of inputs: "JOINT.angle" and "JOINT.displacement", a generalised force along the coordinate (N m or
/// N), and "BODY.x", "BODY.y", "BODY.z", a force at the body's reference point along a world axis (N). Of
/// outputs: the same, as the coordinate (rad or m) and the position of the reference point (m), and with
/// "_rate" behind them their rates; and "CONTROLLER.state". Throws InputError `no-such-port`.
StateMatrices state_matrices(const Model& model, const Linearisation& linear,
                             const std::vector<std::string>& inputs, const std::vector<std::string>& outputs);

}   // namespace livens
