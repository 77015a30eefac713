// SPDX-License-Identifier: BSD-3-Clause
// Loads: generalised forces as functions of time, configuration and velocity.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "livens/base/linear.h"
#include "livens/multibody/acting_times.h"
#include "livens/multibody/joint_coordinates.h"
#include "livens/multibody/rope.h"
#include "livens/time/enclosure.h"
#include "livens/time/guard.h"
#include "livens/time/time_function.h"

namespace [[gnu::visibility("default")]] livens {

inline namespace multibody_internal {
class LoadTape;
struct TapeNumber;
}   // namespace multibody_internal

/// One value for each body of a load; two are held in place.
template <class T>
class PerBody {
public:
    PerBody() : PerBody(2) {}
    explicit PerBody(std::size_t n, const T& value = {}) : n_(n)
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
    const T* begin() const { return data(); }
    const T* end() const { return data() + n_; }

private:
    std::size_t n_;
    std::array<T, 2> pair_{};
    std::vector<T> many_;
};

/// What a load may look at: the instant, and X and dX/dt of its bodies (the world's where there is none).
struct LoadArguments {
    explicit LoadArguments(std::size_t n_bodies = 2) : X(n_bodies, world_configuration), V(n_bodies) {}

    Instant at;
    PerBody<Matrix34> X;
    PerBody<Matrix34> V;
    /// About what each of Load::angles is, within half a turn. Empty: turns are not known.
    std::span<const double> angles{};
};

/// F_b for the bodies that a load acts on, by virtual work tr(F_b^T dX_b); N in the first column, N m in the
/// others.
using LoadForces = PerBody<Matrix34>;

/// Derivatives of the stacked columns of F_b by the stacked columns of X_c and of V_c: X[b][c] is 12 x 12,
/// for the b that it acts on and all c of Load::bodies.
struct LoadTangent {
    explicit LoadTangent(std::size_t n_bodies = 2, std::size_t n_acted = 2)
        : X(n_acted, PerBody<Matrix<12, 12>>(n_bodies)), V(X)
    {}

    PerBody<PerBody<Matrix<12, 12>>> X, V;
};

/// A number that a load reports of itself.
struct LoadReading {
    std::string name;   ///< "force", "length"
    std::string unit;   ///< "N"
    std::function<double(const LoadArguments&)> value;
};

/// F = sum_k f_k(t, numbers) times unit k, for who looks at f between the points where F is evaluated
/// (docs/theory.md, "Looks at laws").
struct LawInside {
    std::size_t n_numbers = 0, n_factors = 0;
    /// What f looks at.
    std::function<void(const LoadArguments&, std::span<double> numbers)> numbers;
    std::function<void(Instant at, std::span<const double> numbers, std::span<double> factors)> factors;
    /// Adds a unit.
    std::function<void(const LoadArguments&, std::size_t k, LoadForces&)> unit;
    /// Bounds of |df_k/ds| on a piece of a way s; empty: nobody knows.
    std::function<void(const EnclosedValue& t, std::span<const EnclosedValue> numbers,
                       std::span<double> bounds)>
        steepest = nullptr;
    /// Smooth but where Load::centre comes near zero.
    bool only_at_centre = false;
};

/// Where the force of a load is not smooth, and what is to be looked at inside of elements.
struct LoadSmoothness {
    std::vector<double> breaks;   ///< instants where F jumps or bends; they become element ends
    /// What decides on which of its smooth pieces F is, a number for each guard; none: it has but one, breaks
    /// apart.
    std::vector<Guard> guards{};
    std::function<void(const LoadArguments&, std::span<double>)> guarded{};
    /// F is as smooth as the motion, but at its guards: nobody needs to look at it inside of elements.
    bool is_smooth = false;
    /// Else, what to look at; none: F itself.
    std::optional<LawInside> inside{};
    /// A vector at whose zero F is not smooth: the velocity of what drags, the line of a spring.
    std::function<Vector3(const LoadArguments&)> centre{};
    bool bends_at_centre = false;   ///< F is not smooth along ways that lead straight through it either
};

/// What a load does to the energy of a mechanism.
struct LoadEnergy {
    /// Potential energy in J of the conservative part; empty if the load has none.
    std::function<double(const LoadArguments&)> potential;
    /// Power in W of the part without potential. If empty: tr(F^T V) for a load without potential, else 0.
    std::function<double(const LoadArguments&)> power;
    /// The same number on a tape; empty where `power` is not: it is called at each instant.
    std::function<TapeNumber(LoadTape&)> recorded_power = nullptr;
};

/// F of a load, added to forces that arrive as zero. Any function will do; one that replaces it forgets what
/// was recorded.
struct LoadFunction {
    LoadFunction() = default;
    LoadFunction(std::nullptr_t) {}   // NOLINT
    template <std::invocable<const LoadArguments&, LoadForces&> Function>
    LoadFunction(Function function) : evaluate(std::move(function))   // NOLINT: a function is one
    {}

    void operator()(const LoadArguments& arguments, LoadForces& F) const { evaluate(arguments, F); }
    explicit operator bool() const { return static_cast<bool>(evaluate); }

    std::function<void(const LoadArguments&, LoadForces&)> evaluate;
    /// The same times a number, as operations that are run at many instants side by side
    /// (multibody/loads/load_tape.h). Empty: `evaluate` is called at each.
    std::function<void(LoadTape&, const TapeNumber& factor)> record = nullptr;
};

/// Of a force F_b = f u_b, at an instant: u of the bodies that it acts on, and the slopes of f by X and X' of
/// all bodies of the load.
struct ProductSlopes {
    explicit ProductSlopes(std::size_t n_bodies) : by_X(n_bodies), by_V(n_bodies) {}

    LoadForces direction{};
    PerBody<Matrix34> by_X, by_V;
};

/// Where a load acts along, for people.
struct LoadLine {
    /// Where it acts on its two bodies, in their coordinates; empty: not along a line.
    std::vector<Vector3> points{};
    /// Of a rope: the points that it runs over.
    std::vector<BodyPoint> over{};
};

struct Load;
struct ReactionLaw;
/// When it acts: instants that are stated stand among its breaks. And what it was made of.
struct LoadTimes : ActingTimes {
    std::shared_ptr<const Load> whenever{};              ///< by for_its_time(): the load that acts always
    std::shared_ptr<const ReactionLaw> by_reactions{};   ///< by bind_reaction_laws()
};

/// A load is data and functions; a new one is a new maker.
struct Load : LoadSmoothness, LoadEnergy, LoadLine, LoadTimes {
    std::string name;
    std::string type;
    /// Those that it acts on, two of them or more, the second the world for a load on one body; then those
    /// that it only looks at.
    std::vector<int> bodies{world, world};
    std::size_t n_acted = 2;     ///< that it acts on
    bool depends_on_X = false;   ///< dF/dX may differ from zero
    bool depends_on_V = false;   ///< dF/dV may differ from zero
    /// F is not zero outside the first column: refused on a point mass.
    PerBody<char> needs_directors{};
    /// What it pulls towards tells the length of a model that has no other: the radius of an orbit.
    bool sets_length_scale = false;
    std::string domain;   ///< where F is a number, for the message if it is not; empty: everywhere
    /// Angles that F counts with their turns, zero where the bodies are stated; see LoadArguments::angles.
    std::vector<JointCoordinate> angles{};
    /// Rotation vectors' components that F acts along or is of: a motion beyond their range is suspect.
    std::vector<JointCoordinate> rotations{};

    LoadFunction forces;   ///< F; required
    /// dF/dX and dF/dV; required if one of the flags is set. The tangent arrives as zero.
    std::function<void(const LoadArguments&, LoadTangent&)> tangent;
    /// The same of a force along coordinates, F = sum f_k u_k, but for what turning of u_k adds; empty: it is
    /// none.
    std::function<std::vector<ProductSlopes>(const LoadArguments&)> products = nullptr;
    /// For sensors and people.
    std::vector<LoadReading> readings;
};

enum class Frame { inertial, body_fixed };   // in scenarios, in this order:
constexpr std::array<std::string_view, 2> words_of(Frame) { return {"world", "body"}; }

/// Three functions of time, the components of a load.
using TimeVector = std::array<TimeFunction, 3>;
TimeVector window(const TimeVector& value, double from, double until);

/// Force (N) at a material point of a body, in world axes or turning with the body:
/// F = f (1, theta)^T with f or f = sum_i f_i d_i.
Load point_force(const std::string& name, int body, const Vector3& point, const TimeVector& value,
                 Frame frame);

/// Torque (N m) on a body, F_i = 1/2 mu x d^i with contravariant directors  (P21); the metric is inverted.
/// `reaction`: a body that takes the opposite torque, about the same axes.
Load torque(const std::string& name, int body, const TimeVector& value, Frame frame, int reaction = world);

/// What a spring does at an elongation e: its force, and the slope and the integral of that.
struct SpringValue {
    double force = 0;       ///< N, or N m for e in rad; positive where it pulls back
    double stiffness = 0;   ///< by m or rad
    double energy = 0;      ///< J, 0 for e = 0
};
/// Forces of springs that are not linear; continuous, but stiffness or its slopes may jump at `bends`.
struct SpringLaw {
    std::function<SpringValue(double e)> at = nullptr;
    std::vector<double> bends{};   ///< ascending

    explicit operator bool() const { return at != nullptr; }
    SpringValue operator()(double e) const { return at(e); }
};

/// stiffness e + cubic e^3. Throws InputError (`load-negative`).
SpringLaw progressive_spring(double stiffness, double cubic);
/// Where straight lines through these points meet at an angle.
std::vector<double> bends_of_lines(const std::vector<double>& x, const std::vector<double>& y);
/// Through forces at ascending elongations: straight lines, or a cubic spline; straight on outside. Throws
/// InputError as linear_table() does.
SpringLaw tabulated_spring(const std::vector<double>& elongations, const std::vector<double>& forces,
                           bool is_spline);

struct SpringDamper {
    double stiffness = 0;     ///< N/m
    double damping = 0;       ///< N s/m
    double free_length = 0;   ///< m
    double preload = 0;       ///< N, pulls wherever the ends are
    SpringLaw law{};          ///< instead of `stiffness`, of length - free_length
};

/// Spring and damper between a point of one body and a point of another or of the world; the force acts along
/// the line between the points. Throws InputError for negative stiffness, damping or free length. Points that
/// coincide: the force is zero for a linear spring of free_length 0 and along no direction (zero) otherwise.
Load spring_damper(const std::string& name, int first, const Vector3& point_first, int second,
                   const Vector3& point_second, const SpringDamper& spring);
/// The same along a rope over two or more points, in this order, along which it runs freely: one tension in
/// all spans, by the sum of their lengths. X: of all bodies as they stand. Also throws what check_rope()
/// does.
Load rope_spring(const std::string& name, const std::vector<BodyPoint>& over, const SpringDamper& spring,
                 const Configurations& X);

struct JointSpring {
    double stiffness = 0;   ///< N/m or N m/rad
    double damping = 0;     ///< N s/m or N m s/rad
    double rest = 0;        ///< m or rad: the coordinate without force but the preload
    double preload = 0;     ///< N or N m, against the coordinate, wherever it is
    SpringLaw law{};        ///< instead of `stiffness`, of q - rest
};

// Loads along a coordinate of a joint: a force that does the work Q dq, between its two bodies. X is the
// configuration of all bodies at the start.

/// Q = -stiffness (q - rest) - damping dq/dt - preload. Turns of an angle are counted where the caller knows
/// them (LoadArguments::angles); else it is known up to 3.05 rad from where it is in X, and beyond that the
/// load is not a number.
Load joint_spring(const std::string& name, const NamedCoordinate& coordinate, const JointSpring& spring,
                  const Configurations& X);
/// Q = value(t), N or N m.
Load actuator(const std::string& name, const NamedCoordinate& coordinate, const TimeFunction& value,
              const Configurations& X);

/// What is told of a load whose force is not finite.
std::string not_finite(const Load& load);

/// What a load is asked with, from X and V of all bodies.
LoadArguments load_arguments(const Load& load, Instant at, std::span<const Matrix34> X,
                             std::span<const Matrix34> V, std::span<const double> angles = {});

/// tr(F^T V) over both bodies.
double load_power(const Load& load, const LoadArguments& arguments);
/// What changes the mechanism's energy: `power` by the rule stated there.
double power_without_potential(const Load& load, const LoadArguments& arguments);

}   // namespace gnu::visibility("default")]]livens
