// SPDX-License-Identifier: BSD-3-Clause
// Energy and momenta at element ends, against what loads, weights and joints to the world supply up to there:
// theory.md, "What is diagnosed". Supplies come element by element from the pass over the motion.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "livens/diagnostics/detail/passed_balance.h"
#include "livens/diagnostics/detail/sampler.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/diagnostics/largest.h"
#include "livens/multibody/rotors.h"
#include "livens/solvers/patience.h"
#include "livens/time/quadrature.h"

namespace livens {
namespace {

/// Of the references: sums of few terms are off by a few units in the last place.
constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();

double moment_of_momentum(std::span<const Matrix34> X, std::span<const Matrix34> P)
{
    double sum = 0;
    for (std::size_t b = 0; b < X.size(); ++b) {
        for (int c = 0; c < 4; ++c) sum += norm(X[b].column(c)) * norm(P[b].column(c));
    }
    return sum;
}

/// What the largest drift is over; `level` is what rounding is relative to.
double relative(double drift, double moving, double level)
{
    return drift <= rounding * level ? 0 : drift / std::max(moving, rounding * level);
}

struct StartOfBalance {
    double potential = 0, energy = 0;
    Vector3 linear_momentum{}, angular_momentum{};
};

/// Momenta of rotors on the world, which holds them.
struct RotorSupport {
    std::vector<Rotor> all;
    bool do_turn = false;   ///< see turn_their_axes()
    RotorMomentum now, at_start;
    Vector3 turned{};   ///< since the start

    /// At Gauss points, where velocities inside an element are most exact.
    void pass(const Model& model, const Motion& motion, int element)
    {
        if (!do_turn) return;
        const Quadrature points = gauss(std::max(motion.X.degree, 1));
        const double begin = motion.mesh.ends[element], length = motion.mesh.length(element);
        for (std::size_t g = 0; g < points.points.size(); ++g) {
            const State state = motion.at(begin + length * points.points[g]);
            turned += length * points.weights[g] * rotor_turning(model, all, state.X, state.V);
        }
    }
};

/// Goes from element end to element end.
class Balancing {
public:
    Balancing(const Model& model, const Motion& motion, MotionPass& pass)
        : model_(model), motion_(motion), pass_(pass), potential_(model),
          X_(static_cast<std::size_t>(motion.n_bodies))
    {
        rotors_.all = rotors_of(model);
        rotors_.do_turn = turn_their_axes(model, rotors_.all);
    }

    /// The next `n` ends, or what is left of them. False: nothing is.
    bool next(int n, Balance& piece)
    {
        const int last = n < motion_.n_elements() + 1 - end_ ? end_ + n : motion_.n_elements() + 1;
        if (end_ == last) return false;
        reserve(static_cast<std::size_t>(last - end_), piece);
        for (; end_ < last; ++end_) {
            Patience::ask();
            if (end_ > 0) total_.add(1, pass_.supply(end_ - 1));
            if (end_ > 0) rotors_.pass(model_, motion_, end_ - 1);
            append_state(piece);
            append_supply(piece);
        }
        static_cast<BalanceFigures&>(piece) = figures();
        return true;
    }
    BalanceFigures figures() const
    {
        BalanceFigures figures = figures_;
        figures.reference_energy += pass_.figures().largest_gross_moment;
        raise_to(figures.largest_kinetic, pass_.figures().largest_kinetic);   // where all ends are at rest
        figures.reference_impulse = total_.gross;
        figures.reference_moment = total_.gross_moment;
        return figures;
    }

private:
    static void reserve(std::size_t n, Balance& piece)
    {
        piece = {};
        for (auto* list : {&piece.t, &piece.kinetic, &piece.potential, &piece.energy, &piece.work,
                           &piece.energy_drift, &piece.linear_momentum_drift, &piece.angular_momentum_drift})
            list->reserve(n);
        for (auto* list :
             {&piece.linear_momentum, &piece.angular_momentum, &piece.linear_impulse, &piece.angular_impulse})
            list->reserve(n);
    }
    void append_state(Balance& piece)
    {
        const std::span<const Matrix34> V = velocities_at_end(motion_, end_);
        const std::vector<Matrix34> P = momenta_of_matter(motion_.momenta, end_);
        positions_at_end(motion_, end_, X_);
        if (const int impact = motion_.impacts.at(end_); impact >= 0) add_impact(impact, V, P);
        const Instant at{motion_.mesh.ends[end_], end_ == motion_.n_elements() ? Side::left : Side::right};
        const double kinetic = kinetic_energy(model_, X_, V),
                     potential = potential_.at(at, X_, V, pass_.turns().at_end(end_));
        piece.t.push_back(at.t);
        piece.kinetic.push_back(kinetic);
        piece.potential.push_back(potential);
        piece.energy.push_back(kinetic + potential);
        piece.linear_momentum.push_back(linear_momentum(P));
        piece.angular_momentum.push_back(angular_momentum(X_, P));
        if (!rotors_.all.empty()) rotors_.now = rotor_momentum(model_, rotors_.all, X_, V);
        if (end_ == 0) {
            rotors_.at_start = rotors_.now;
            last_energy_ = kinetic + potential;
            start_ = {potential, last_energy_, piece.linear_momentum[0], piece.angular_momentum[0]};
        }
        raise_to(figures_.largest_kinetic, kinetic);
        raise_to(figures_.largest_change, std::abs(potential - start_.potential));
        raise_to(figures_.reference_energy, std::abs(potential));
        raise_to(figures_.largest_moment, moment_of_momentum(X_, P));
        double momentum = 0;
        for (const Matrix34& p : P) momentum += norm(p.column(0));
        raise_to(figures_.largest_momentum, momentum);
    }
    /// Bodies that hold states are no matter: what they have counts as no momentum.
    std::vector<Matrix34> momenta_of_matter(const std::vector<Matrix34>& all, int end) const
    {
        const auto first =
            all.begin() + static_cast<std::ptrdiff_t>(end) * static_cast<std::ptrdiff_t>(X_.size());
        std::vector<Matrix34> P(first, first + static_cast<std::ptrdiff_t>(X_.size()));
        for (std::size_t b = 0; b < P.size(); ++b)
            if (model_.bodies()[b].holds_states()) P[b] = {};
        return P;
    }
    /// What an impact takes is no error of the motion, and what it gives comes from joints.
    void add_impact(int impact, std::span<const Matrix34> V, std::span<const Matrix34> P)
    {
        const auto before = [&](const std::vector<Matrix34>& all) {
            return std::span<const Matrix34>(all).subspan(static_cast<std::size_t>(impact) * X_.size(),
                                                          X_.size());
        };
        const std::vector<Matrix34> P_before = momenta_of_matter(motion_.impacts.momenta, impact);
        total_.work +=
            kinetic_energy(model_, X_, V) - kinetic_energy(model_, X_, before(motion_.impacts.velocities));
        total_.linear += linear_momentum(P) - linear_momentum(P_before);
        total_.angular += angular_momentum(X_, P) - angular_momentum(X_, P_before);
    }
    void append_supply(Balance& piece)
    {
        piece.work.push_back(total_.work);
        // What turns rotors of joints to the world is theirs, and no momentum of bodies.
        const Vector3 linear = total_.linear - (rotors_.now.linear - rotors_.at_start.linear),
                      angular =
                          total_.angular + rotors_.turned - (rotors_.now.angular - rotors_.at_start.angular);
        piece.linear_impulse.push_back(linear);
        piece.angular_impulse.push_back(angular);
        piece.energy_drift.push_back(std::abs(piece.energy.back() - start_.energy - total_.work));
        piece.linear_momentum_drift.push_back(
            norm(piece.linear_momentum.back() - start_.linear_momentum - linear));
        piece.angular_momentum_drift.push_back(
            norm(piece.angular_momentum.back() - start_.angular_momentum - angular));
        raise_to(figures_.largest_impulse, norm(linear));
        raise_to(figures_.largest_energy_drift, piece.energy_drift.back());
        raise_to(figures_.largest_linear_momentum_drift, piece.linear_momentum_drift.back());
        raise_to(figures_.largest_angular_momentum_drift, piece.angular_momentum_drift.back());
        append_rise(piece.energy.back());
    }
    /// From the lowest that it was since the start.
    /// Only what is supplied is taken off a rise; what loads take out is not credited to it.
    void append_rise(double energy)
    {
        const double supplied = std::max(total_.work - last_work_, 0.0);
        const double sum = risen_ + (energy - last_energy_) - supplied;
        risen_ = sum < 0 ? 0 : sum;
        raise_to(figures_.largest_energy_rise, risen_);
        figures_.energy_loss = start_.energy - (energy - total_.work);
        last_energy_ = energy;
        last_work_ = total_.work;
    }

    const Model& model_;
    const Motion& motion_;
    MotionPass& pass_;
    PotentialEnergy potential_;
    RotorSupport rotors_;
    Supply total_;
    std::vector<Matrix34> X_;
    BalanceFigures figures_;   // references without what is integrated
    StartOfBalance start_;
    double last_energy_ = 0, last_work_ = 0, risen_ = 0;   // at the end before
    int end_ = 0;
};

}   // namespace

double BalanceFigures::relative_energy_drift() const
{
    return relative(largest_energy_drift, moving_energy(), reference_energy);
}

double BalanceFigures::relative_energy_rise() const
{
    return relative(largest_energy_rise, moving_energy(), reference_energy);
}

double BalanceFigures::relative_energy_loss() const
{
    return relative(std::max(energy_loss, 0.0), moving_energy(), reference_energy);
}

double BalanceFigures::hidden_energy_loss() const
{
    return std::max(largest_energy_rise, rounding * reference_energy);
}

double BalanceFigures::moving_energy() const
{
    double moving = largest_kinetic;
    raise_to(moving, largest_change);
    return moving;
}

double BalanceFigures::relative_linear_momentum_drift() const
{
    double moving = largest_momentum;
    raise_to(moving, largest_impulse);
    return relative(largest_linear_momentum_drift, moving, reference_impulse + moving);
}

double BalanceFigures::relative_angular_momentum_drift() const
{
    return relative(largest_angular_momentum_drift, largest_moment, reference_moment + largest_moment);
}

BalanceFigures diagnostics_internal::passed_balance(const Model& model, const Motion& motion, int n_ends,
                                                    const std::function<void(Balance&)>& take,
                                                    MotionPass& pass)
{
    assert(motion.momenta.size() == motion.mesh.ends.size() * static_cast<std::size_t>(motion.n_bodies));
    Balancing balancing(model, motion, pass);
    Balance piece;
    while (balancing.next(n_ends, piece)) take(piece);
    pass.finish();
    return balancing.figures();
}

BalanceFigures balance(const Model& model, const Motion& motion, int n_ends,
                       const std::function<void(Balance&)>& take)
{
    MotionPass pass(model, motion, {.supplies = true});
    return passed_balance(model, motion, n_ends, take, pass);
}

Balance balance(const Model& model, const Motion& motion)
{
    Balance whole;
    balance(model, motion, std::numeric_limits<int>::max(),
            [&](Balance& piece) { whole = std::move(piece); });
    return whole;
}

}   // namespace livens
