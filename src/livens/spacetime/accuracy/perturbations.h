// SPDX-License-Identifier: BSD-3-Clause
// States a little beside another one, and how far they are apart.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "livens/diagnostics/acceptance.h"
#include "livens/dynamics/instant/nearest_rates.h"
#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"
#include "livens/solvers/noise.h"

namespace livens::inline spacetime_internal {

/// Perturbations that are carried along.
constexpr int n_perturbations = 2;

/// What one body is moved, turned, pushed and spun by; m, rad, m/s and rad/s in world axes.
struct Kick {
    Vector3 shift{}, turn{}, push{}, spin{};
};
using Kicks = std::vector<Kick>;   // of all bodies

/// The fastest rate that gravity and velocities make, 1/s: how velocities compare with positions.
double fastest_rate(const Model& model, std::span<const Matrix34> velocities);

/// Of size 1 in all that can move, velocities by this rate.
std::vector<Kicks> kicks_everywhere(const Model& model, const State& state, double rate);
/// What rounding does to states of a motion, by the spacing of numbers: to each body by its own place and
/// velocity. Numbers that stay zero all along the motion are not rounded: in a plane that axes span. Of
/// bodies that never move all are, by the rate, as if they had been brought there.
class Roundings {
public:
    Roundings(const Model& model, const Motion& motion, double rate);

    /// Others at each call.
    std::vector<Kicks> of(const State& state);

private:
    struct OfBody {
        bool rests = false;
        std::array<bool, 3> along{}, about{};   // components that round
    };

    double length_, rate_;
    std::vector<OfBody> bodies_;
    Noise noise_;
};
/// In lengths and rad, velocities as they would be after a time of 1 / rate.
double size_of(const Model& model, const Kicks& kicks, double rate);

/// States beside others of one model.
class KickedStates {
public:
    /// `rows`: independent ones, or none. The model must outlive it.
    KickedStates(const Model& model, std::span<const int> rows)
        : model_(model), rows_(rows.begin(), rows.end())
    {}

    /// The state with these kicks times a factor: off the rows, in places and in rates, by no more than what
    /// bends. Without rows as it is. Roundings are of no body more than of others.
    State beside(const State& state, const Kicks& kicks, double factor, bool are_roundings);

private:
    std::vector<Matrix34> allowed(const State& at, const std::vector<Matrix34>& moves, bool are_roundings);

    const Model& model_;
    std::vector<int> rows_;
    std::optional<Model> alike_model_;          // all bodies have one mass
    std::optional<NearestRates> own_, alike_;   // without drives
};

/// A share of the difference of two states.
struct Difference {
    std::vector<Matrix34> X, V;

    Difference() = default;
    Difference(const State& a, const State& b, double share) { set(a, b, share); }
    void set(const State& a, const State& b, double share);   ///< in the memory that it has
    Difference& operator+=(const Difference& other);
    State beside(State s, double factor) const;
    double size(const Model& model, double rate) const { return size(model, rate, size_of_places(model)); }
    double size(const Model& model, double rate, double of_places) const;   ///< which is known
    double size_of_places(const Model& model) const;
    /// The body that it moves or turns most, where it is in X, and along or about what.
    Growing most(const Model& model, std::span<const Matrix34> places) const;
    /// Each body by its size: shifts and turns, pushes and spins at this rate; spins in axes of the body.
    static double of_bodies(const Model& model, const State& one, const State& other, double rate);
};

}   // namespace livens::inline spacetime_internal
