// SPDX-License-Identifier: BSD-3-Clause
// Loads: generalised forces as functions of time, configuration and velocity.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "livens/base/linear.h"
#include "livens/multibody/joint_coordinates.h"
#include "livens/time/enclosure.h"
#include "livens/time/guard.h"
#include "livens/time/time_function.h"

namespace [[gnu::visibility("default")]] livens {

inline namespace multibody_internal {
class LoadTape;
struct TapeNumber;
}   // namespace multibody_internal

/// One value per body of a load; up to two are stored in place.
template <class T>
class PerBody {
public:
    explicit PerBody(std::size_t n = 2, const T& value = {}) : n_(n)
    {
        if (n > 2)
            many_.assign(n, value);
        else
            pair_.fill(value);
    }

    std::size_t size() const { return n_; }
    T& operator[](std::size_t i) { return n_ > 2 ? many_[i] : pair_[i]; }
    const T& operator[](std::size_t i) const { return n_ > 2 ? many_[i] : pair_[i]; }
    const T* data() const { return n_ > 2 ? many_.data() : pair_.data(); }
    T* begin() { return n_ > 2 ? many_.data() : pair_.data(); }
    T* end() { return begin() + n_; }

private:
    std::size_t n_;
    std::array<T, 2> pair_{};
    std::vector<T> many_;
};

/// Arguments of a load: time, and X and dX/dt of its bodies (those of the world if there is none).
struct LoadArguments {
    explicit LoadArguments(std::size_t n_bodies = 2) : X(n_bodies, world_configuration), V(n_bodies) {}

    Instant at;
    PerBody<Matrix34> X;
    PerBody<Matrix34> V;
    /// Approximate values of Load::angles, to within half a turn. Empty: full turns are not known.
    std::span<const double> angles{};
};

/// F_b for the one or two bodies that a load acts on, by virtual work tr(F_b^T dX_b); N in the first column,
/// N m in the others.
using LoadForces = std::array<Matrix34, 2>;

/// Derivatives of the stacked columns of F_b by the stacked columns of X_c and of V_c: X[b][c] is 12 x 12,
/// for the two b that it acts on and all c of Load::bodies.
struct LoadTangent {
    explicit LoadTangent(std::size_t n_bodies = 2)
    {
        X.fill(PerBody<Matrix<12, 12>>(n_bodies));
        V = X;
    }

    std::array<PerBody<Matrix<12, 12>>, 2> X;
    std::array<PerBody<Matrix<12, 12>>, 2> V;
};

/// A quantity that a load can report.
struct LoadReading {
    std::string name;   ///< "force", "length"
    std::string unit;   ///< "N"
    std::function<double(const LoadArguments&)> value;
};

/// F = sum_k f_k(t, numbers) times unit k, to inspect f between the points at which F is evaluated
/// (docs/theory.md, "Looks at laws").
struct LawInside {
    std::size_t n_numbers = 0, n_factors = 0;
    /// Arguments of f.
    std::function<void(const LoadArguments&, std::span<double> numbers)> numbers;
    std::function<void(Instant at, std::span<const double> numbers, std::span<double> factors)> factors;
    /// Adds a unit.
    std::function<void(const LoadArguments&, std::size_t k, LoadForces&)> unit;
    /// Bounds of |df_k/ds| on an interval of a path s; empty: not known.
    std::function<void(const EnclosedValue& t, std::span<const EnclosedValue> numbers,
                       std::span<double> bounds)>
        steepest = nullptr;
    /// Smooth except near zeros of Load::centre.
    bool only_at_centre = false;
};

/// Where the force of a load is not smooth, and what has to be inspected inside elements.
struct LoadSmoothness {
    std::vector<double> breaks;   ///< times at which F has a jump or kink; they become element ends
    /// Switching functions whose signs select the smooth branch of F; none: F has one branch, apart from
    /// breaks.
    std::vector<Guard> guards{};
    std::function<void(const LoadArguments&, std::span<double>)> guarded{};
    /// F is as smooth as the motion, except at its guards, and need not be inspected inside elements.
    bool is_smooth = false;
    /// Otherwise, what to inspect; none: F itself.
    std::optional<LawInside> inside{};
    /// A vector at whose zeros F is not smooth: the velocity for drag, the line of a spring.
    std::function<Vector3(const LoadArguments&)> centre{};
    bool bends_at_centre = false;   ///< F is not smooth even along paths that pass straight through it
};

/// Energy and power of a load.
struct LoadEnergy {
    /// Potential energy in J of the conservative part; empty if the load has none.
    std::function<double(const LoadArguments&)> potential;
    /// Power in W of the part without potential. If empty: tr(F^T V) for a load without potential, else 0.
    std::function<double(const LoadArguments&)> power;
    /// `power` recorded on a tape; if this is empty and `power` is not, `power` is called at each time.
    std::function<TapeNumber(LoadTape&)> recorded_power = nullptr;
};

/// F of a load, added to forces that are zero on entry. Any function is possible; assigning another one
/// removes the recording.
struct LoadFunction {
    LoadFunction() = default;
    LoadFunction(std::nullptr_t) {}   // NOLINT
    template <std::invocable<const LoadArguments&, LoadForces&> Function>
    LoadFunction(Function function) : evaluate(std::move(function))   // NOLINT: a function is one
    {}

    void operator()(const LoadArguments& arguments, LoadForces& F) const { evaluate(arguments, F); }
    explicit operator bool() const { return static_cast<bool>(evaluate); }

    std::function<void(const LoadArguments&, LoadForces&)> evaluate;
    /// The same times a factor, recorded as operations that run at many times side by side
    /// (multibody/loads/load_tape.h). Empty: `evaluate` is called at each time.
    std::function<void(LoadTape&, const TapeNumber& factor)> record = nullptr;
};

/// For a force F_b = f u_b at one time: u of the bodies that it acts on, and the derivatives of f by X and X'
/// of all bodies of the load.
struct ProductSlopes {
    explicit ProductSlopes(std::size_t n_bodies) : by_X(n_bodies), by_V(n_bodies) {}

    LoadForces direction{};
    PerBody<Matrix34> by_X, by_V;
};

/// A load: data and functions. A new type of load is a new function that makes one.
struct Load : LoadSmoothness, LoadEnergy {
    std::string name;
    std::string type;
    /// The two bodies that it acts on (the second may be the world), then those that it only reads.
    std::vector<int> bodies{world, world};
    bool depends_on_X = false;   ///< dF/dX may differ from zero
    bool depends_on_V = false;   ///< dF/dV may differ from zero
    std::array<bool, 2>
        needs_directors{};   ///< F has parts outside the first column, which is an error on a point mass
    /// Its distance to an attracting point defines the length of a model without any other length.
    bool sets_length_scale = false;
    std::string domain;   ///< domain of F, for error messages; empty: everywhere
    /// Angles that F uses with full turns, zero in the configuration of the model; see LoadArguments::angles.
    std::vector<JointCoordinate> angles{};

    LoadFunction forces;   ///< F; required
    /// dF/dX and dF/dV; required if one of the flags is set. The tangent is zero on entry.
    std::function<void(const LoadArguments&, LoadTangent&)> tangent;
    /// The same for a force along coordinates, F = sum f_k u_k, without derivatives of u_k; empty: not such
    /// a force.
    std::function<std::vector<ProductSlopes>(const LoadArguments&)> products = nullptr;
    /// Readings for sensors and output.
    std::vector<LoadReading> readings;
    /// For drawing: points of application on its two bodies, in body coordinates; empty: not along a line.
    std::vector<Vector3> points{};
};

enum class Frame { inertial, body_fixed };
/// In scenarios, in this order.
constexpr std::array<std::string_view, 2> words_of(Frame) { return {"world", "body"}; }

/// Components of a load as functions of time.
using TimeVector = std::array<TimeFunction, 3>;
TimeVector window(const TimeVector& value, double from, double until);

/// Force (N) at a material point of a body, in world axes or rotating with the body:
/// F = f (1, theta)^T with f or f = sum_i f_i d_i.
Load point_force(const std::string& name, int body, const Vector3& point, const TimeVector& value,
                 Frame frame);

/// Torque (N m) on a body, F_i = 1/2 mu x d^i with contravariant directors  (P21); the metric is inverted.
Load torque(const std::string& name, int body, const TimeVector& value, Frame frame);

/// Force of a spring at an elongation e, with its derivative and integral.
struct SpringValue {
    double force = 0;       ///< N, or N m for e in rad; positive if it pulls back
    double stiffness = 0;   ///< per m or rad
    double energy = 0;      ///< J, 0 for e = 0
};
/// Nonlinear spring law; continuous, but stiffness or its derivatives may jump at `bends`.
struct SpringLaw {
    std::function<SpringValue(double e)> at = nullptr;
    std::vector<double> bends{};   ///< ascending

    explicit operator bool() const { return at != nullptr; }
    SpringValue operator()(double e) const { return at(e); }
};

/// stiffness e + cubic e^3. Throws InputError (`load-negative`).
SpringLaw progressive_spring(double stiffness, double cubic);
/// Points at which a piecewise linear curve through these points has a kink.
std::vector<double> bends_of_lines(const std::vector<double>& x, const std::vector<double>& y);
/// Interpolates forces at ascending elongations: piecewise linear, or a cubic spline; linear outside. Throws
/// InputError like linear_table().
SpringLaw tabulated_spring(const std::vector<double>& elongations, const std::vector<double>& forces,
                           bool is_spline);

struct SpringDamper {
    double stiffness = 0;     ///< N/m
    double damping = 0;       ///< N s/m
    double free_length = 0;   ///< m
    double preload = 0;       ///< N, constant tension
    SpringLaw law{};          ///< instead of `stiffness`, of length - free_length
};

/// Spring and damper between a point of one body and a point of another or of the world; the force acts along
/// the line between the points. Throws InputError for negative stiffness, damping or free length. If the
/// points coincide, the force has no direction and is set to zero.
Load spring_damper(const std::string& name, int first, const Vector3& point_first, int second,
                   const Vector3& point_second, const SpringDamper& spring);

struct JointSpring {
    double stiffness = 0;   ///< N/m or N m/rad
    double damping = 0;     ///< N s/m or N m s/rad
    double rest = 0;        ///< m or rad: unloaded coordinate, apart from the preload
    double preload = 0;     ///< N or N m, constant, against the coordinate
    SpringLaw law{};        ///< instead of `stiffness`, of q - rest
};

// Loads along a joint coordinate: a force that does the work Q dq, between the two bodies of the joint. X is
// the initial configuration of all bodies.

/// Q = -stiffness (q - rest) - damping dq/dt - preload. Full turns of an angle are counted if the caller
/// supplies them (LoadArguments::angles). Otherwise the angle is known up to 3.05 rad from its value in X;
/// beyond, the load is not a number.
Load joint_spring(const std::string& name, const NamedCoordinate& coordinate, const JointSpring& spring,
                  const Configurations& X);
/// Q = value(t), N or N m.
Load actuator(const std::string& name, const NamedCoordinate& coordinate, const TimeFunction& value,
              const Configurations& X);

/// Error message for a load whose force is not finite.
std::string not_finite(const Load& load);

/// Arguments of a load, from X and V of all bodies.
LoadArguments load_arguments(const Load& load, Instant at, std::span<const Matrix34> X,
                             std::span<const Matrix34> V, std::span<const double> angles = {});

/// tr(F^T V) over both bodies.
double load_power(const Load& load, const LoadArguments& arguments);
/// Power that changes the energy of the mechanism, see LoadEnergy::power.
double power_without_potential(const Load& load, const LoadArguments& arguments);

}   // namespace gnu::visibility("default")]]livens
