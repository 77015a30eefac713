// SPDX-License-Identifier: BSD-3-Clause
// Loads whose size is a law of coordinates and their rates, also of bodies on which they do not act.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "livens/multibody/body.h"
#include "livens/multibody/loads.h"
#include "livens/time/expression.h"

namespace [[gnu::visibility("default")]] livens {

struct Joint;

/// What a law looks at: a displacement, or an angle, and its rate.
struct LawCoordinate {
    JointCoordinate coordinate;
    double at_stated = 0;    ///< what it is called where the bodies are at the start
    bool is_needed = true;   ///< false: the law looks at the rate alone, so that turns need not be known
};

struct LawArguments {
    Instant at;
    std::span<const double> values;   ///< of the coordinates; rad or m
    std::span<const double> rates;    ///< per s
};

/// What units are multiplied by: one number for each into `factors`. Unless `slopes` is empty also their
/// derivatives: for each unit those by all values, then those by all rates.
using LoadLaw = std::function<void(const LawArguments&, std::span<double> factors, std::span<double> slopes)>;
/// The same factors on a tape, of values and rates of the coordinates there.
struct LawOnTape {
    LoadTape& tape;
    std::function<TapeNumber(std::size_t coordinate)> value, rate;
};
using RecordedEnergy = std::function<TapeNumber(const LawOnTape&)>;
using RecordedLaw = std::function<void(const LawOnTape&, std::span<TapeNumber> factors)>;
/// What symbol k of expressions reads: the value of a coordinate, or its rate.
struct LawRead {
    std::size_t coordinate;
    bool is_rate;
};
/// One factor for each expression, 0 where `acts` is. `breaks`: see expression_of_time().
RecordedLaw recorded_law(const std::vector<Expression>& expressions, const std::vector<LawRead>& reads,
                         const std::vector<double>& breaks, const TimeFunction& acts);
/// A number made of these: J, W.
using LawEnergy = std::function<double(const LawArguments&)>;

/// See Load::guards and Load::centre.
struct LawGuards {
    std::vector<Guard> guards{};
    std::function<void(const LawArguments&, std::span<double>)> values = nullptr;
    std::function<Vector3(const LawArguments&)> centre = nullptr;
};

/// Bounds of |df_k/ds| for all factors, on a piece of a way s: of what LawArguments holds, first the values
/// of all coordinates, then their rates.
using LawSteepness = std::function<void(const EnclosedValue& t, std::span<const EnclosedValue> numbers,
                                        std::span<double> bounds)>;

/// What a load reports of itself.
struct LawReading {
    std::string name, unit;   ///< "x", "N"
    LawEnergy value;
};

struct LoadParts {
    std::vector<Load> units;   ///< of size one, on the same bodies: along coordinates, forces, torques
    std::vector<LawCoordinate> coordinates;
    LoadLaw law;
    RecordedLaw recorded_law = nullptr;   ///< empty: `law` is called for each instant
    bool depends_on_rates = false;
    LawEnergy potential = nullptr;   ///< empty: it has none
    LawEnergy power = nullptr;       ///< of the rest; see Load::power
    RecordedEnergy recorded_power = nullptr;
    LawGuards guards{};
    /// The law is linear, or as smooth as the motion for other reasons; see Load::is_smooth.
    bool is_smooth = false;
    LawSteepness steepest = nullptr;     ///< if not
    bool is_smooth_off_centre = false;   ///< but for where guards.centre is zero; see LawInside
    std::vector<double> breaks{};
    std::string domain{};
    std::vector<LawReading> readings{};
};

/// Where a joint ends, softly: one-sided springs that act where a coordinate q is beyond a limit, by d: the
/// force back is stiffness d (1 + damping d'), and none where that would pull [HuntCrossley1975].
struct JointLimits {
    double low = -std::numeric_limits<double>::infinity();   ///< m or rad
    double high = std::numeric_limits<double>::infinity();   ///< above `low`
    double stiffness = 0;                                    ///< N/m or N m/rad
    double damping = 0;                                      ///< s/m or s/rad

    bool acts() const { return stiffness > 0 && (std::isfinite(low) || std::isfinite(high)); }
};
/// joint_spring() with limits beside it. Throws InputError `joint-limits` for limits that are not in order.
Load joint_spring(const std::string& name, const NamedCoordinate& coordinate, const JointSpring& spring,
                  const JointLimits& limits, const Configurations& X);

/// Reports factor k of a law.
LawReading factor_reading(const std::string& name, const std::string& unit, const LoadLaw& law, std::size_t k,
                          std::size_t n_factors);

/// F = sum_k f_k(t, q, q') F_k with units F_k. X is the configuration of all bodies at the start.
/// Throws InputError (`load-empty`) for units that are none, or on different bodies.
Load modulated(const std::string& name, const std::string& type, const LoadParts& parts,
               const Configurations& X);

/// A generalised force of one (N or N m) along a coordinate: a unit.
Load unit_along(const std::string& name, const JointCoordinate& coordinate, const Configurations& X);

/// A place and axes on a body, in its coordinates; orthonormal and right-handed.
struct BodyFrame {
    Vector3 point{};
    Matrix3 axes = identity<3>();
};

/// By u: three displacements in m, three components of a rotation in rad.
struct Bushing {
    Matrix<6, 6> stiffness{};   ///< N/m, N m/rad and mixed; symmetric and not negative
    Matrix<6, 6> damping{};     ///< the same by u'
    Matrix<6, 1> preload{};     ///< N, N m: against u, wherever it is
    /// damping is by the relative angular velocity instead of the rate of the rotation vector.
    bool by_angular_velocity = false;
};

/// An elastic bearing between two frames: u holds the displacement of the second frame's point in axes of the
/// first, and the rotation vector from the first frame to the second in these axes. It does the work
/// -(K u + C u' + preload) . du, so that K and preload have a potential however far it turns, up to 175
/// degrees; or, by angular velocity w in axes of the first frame, C (displacement', w) acts on these. Throws
/// InputError (`bushing-matrix`) for matrices that are not symmetric or negative.
Load bushing(const std::string& name, int first, const BodyFrame& frame_first, int second,
             const BodyFrame& frame_second, const Bushing& law, const Configurations& X);

/// A spring and a damper against all turns of a ball joint: a torque -stiffness times the rotation vector
/// from its first triad to its second, about whatever axis, and -damping times the relative angular velocity.
/// Up to 175 degrees. Throws InputError (`load-negative`).
Load ball_spring(const std::string& name, const Joint& joint, double stiffness, double damping,
                 const Configurations& X);

/// A damper between two bodies by their relative angular velocity: a torque -damping (w2 - w1) on the second,
/// and the opposite one on the first, however far they turn. Throws InputError (`load-negative`).
Load rotational_damper(const std::string& name, int first, int second, double damping,
                       const Configurations& X);

struct Drag {
    double linear = 0;      ///< N s/m
    double quadratic = 0;   ///< N s^2/m^2
    Vector3 medium{};       ///< its velocity, m/s, world axes
};

/// -(linear + quadratic |v|) v at a point of a body, v its velocity against the medium.
Load drag(const std::string& name, int body, const Vector3& point, const Drag& law, const Configurations& X);

struct Attraction {
    Vector3 point{};             ///< m, world
    double mu = 0;               ///< m^3/s^2, positive
    bool has_gradient = false;   ///< also what the body's extent does, to second order [MacCullagh]
};

/// Gravity toward a point of the world: -mu m r / |r|^3 at the centre of mass, and with the gradient the
/// potential -mu (m / r + (tr J - 3 n . J n) / (2 r^3)), n = r / |r|, J about the centre of mass, which turns
/// the body. Throws InputError (`attraction-mu`) unless mu > 0.
Load attraction(const std::string& name, int body, const Body& properties, const Attraction& law,
                const Configurations& X);

}   // namespace gnu::visibility("default")]]livens
