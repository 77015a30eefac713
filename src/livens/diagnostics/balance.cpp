// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/detail/sampler.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/diagnostics/largest.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/solvers/patience.h"
#include "livens/time/quadrature.h"

namespace livens {
namespace {

/// Of the references: sums of few terms are off by a few units in the last place.
constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();

/// What flows into a mechanism: rates at an instant, or their integrals.
struct Supply {
    double work = 0;   // of loads without potential, and of drives
    Vector3 linear{};
    Vector3 angular{};         // about the world's origin
    double gross = 0;          // sum of |F|, what rounding in `linear` is relative to
    double gross_moment = 0;   // sum of |F| (|x| + length), likewise in `angular` and in energies

    void add_force(const Matrix34& X, const Matrix34& F, double length)
    {
        linear += F.column(0);
        for (int c = 0; c < 4; ++c)   // most forces have one column or two
            if (const Vector3 f = F.column(c); f != Vector3{}) angular += cross(X.column(c), f);
        add_size(X, F, length);
    }

    void add_size(const Matrix34& X, const Matrix34& F, double length)
    {
        gross += norm(F.column(0));
        gross_moment += norm(F.column(0)) * length;
        for (int c = 0; c < 4; ++c)
            if (const double size = norm(F.column(c)); size != 0) gross_moment += norm(X.column(c)) * size;
    }

    void add(double weight, const Supply& other)
    {
        work += weight * other.work;
        linear += weight * other.linear;
        angular += weight * other.angular;
        gross += weight * other.gross;
        gross_moment += weight * other.gross_moment;
    }
};

Quadrature nodal_rule(const Field& field)
{
    return field.points == Points::lobatto ? gauss_lobatto(field.degree + 1) : radau(field.degree);
}

/// Where loads are taken, as by the method: at its Gauss points, where alone its momentum balances are exact.
/// Without such points one multiplier an element marks a stepping rule with one stage: endpoint (order 1)
/// takes forces at the end of the step, midpoint, in old files, in its middle.
Quadrature load_rule(const Motion& motion)
{
    if (motion.gauss_points > 0) return gauss(motion.gauss_points);
    const bool one_stage = motion.X.degree == 1 && motion.multipliers.degree == 0;
    if (!one_stage) return nodal_rule(motion.X);
    return {{motion.order_at_ends == 1 ? 1.0 : 0.5}, {1.0}};
}

/// Where joints are taken: where the method holds them, at its nodes or at the points of its loads.
Quadrature joint_rule(const Motion& motion)
{
    if (motion.constraints_hold == ConstraintsHold::at_nodes) return nodal_rule(motion.X);
    return load_rule(motion);
}

class SupplyIntegral {
public:
    SupplyIntegral(const Model& model, const Motion& motion)
        : SupplyIntegral(model, motion, load_rule(motion), joint_rule(motion))
    {}

    /// Integral over one element.
    Supply over(int element)
    {
        Supply sum;
        const double h = motion_.mesh.length(element);
        for (int k = 0; k < loads_.size(); ++k) {
            Supply now;
            loads_.positions(element, k, X_);
            loads_.velocities(element, k, V_);
            for (std::size_t b = 0; b < X_.size(); ++b) now.add_force(X_[b], weights_of_bodies_[b], length_);
            raise_to(largest_kinetic_, kinetic_energy(model_, X_, V_));
            if (k == 0) angles_ = turns_.at_end(element);
            turns_.turns().follow(X_, angles_);
            add_loads(loads_.instant(element, k), now);
            sum.add(h * load_weights_[k], now);
            raise_to(largest_gross_moment_, now.gross_moment);
        }
        for (int k = 0; multipliers_ && k < joints_.size(); ++k) {
            Supply now;
            joints_.positions(element, k, X_);
            add_joints(element, k, now);
            sum.add(h * joint_weights_[k], now);
            raise_to(largest_gross_moment_, now.gross_moment);
        }
        sum.add(h, stiffness(element, h));
        return sum;
    }
    const LoadTurns& turns() const { return turns_; }
    /// Of all instants so far.
    double largest_gross_moment() const { return largest_gross_moment_; }
    double largest_kinetic() const { return largest_kinetic_; }

private:
    SupplyIntegral(const Model& model, const Motion& motion, Quadrature loads, Quadrature joints)
        : model_(model), tables_(model, all_rows(model)), load_weights_(loads.weights),
          joint_weights_(joints.weights), loads_(motion, loads.points), joints_(motion, joints.points),
          motion_(motion), turns_(model, motion), length_(model.length()),
          X_(static_cast<std::size_t>(motion.n_bodies)), V_(X_.size())
    {
        if (!motion.multipliers.empty()) {
            multipliers_.emplace(motion.multipliers, joints_.points());
            lambda_.resize(static_cast<std::size_t>(motion.n_rows));
        }
        for (const Body& body : model.bodies()) weights_of_bodies_.push_back(weight(body, model.gravity()));
    }

    /// What loads make of positions off by their size, and of velocities off by that in h: as rounding is
    /// relative to the size, stiff loads amplify it. At one point of the element.
    Supply stiffness(int element, double h)
    {
        Supply all;
        loads_.positions(element, 0, X_);
        loads_.velocities(element, 0, V_);
        angles_ = turns_.at_end(element);
        for (int l = 0; l < static_cast<int>(model_.loads().size()); ++l) {
            const Load& load = model_.loads()[l];
            if (!load.depends_on_X && !load.depends_on_V) continue;
            const LoadArguments arguments = arguments_of(l, loads_.instant(element, 0));
            LoadTangent tangent(load.bodies.size());
            load.tangent(arguments, tangent);
            for (int b = 0; b < 2; ++b) {
                Matrix34 dF{};
                for (std::size_t c = 0; c < load.bodies.size(); ++c)
                    for (int j = 0; j < 12; ++j) {
                        const double size = norm(arguments.X[c].column(j / 3)) + (j < 3 ? length_ : 0);
                        for (int i = 0; i < 12; ++i)
                            dF.a[i] += size * (std::abs(tangent.X[b][c](i, j)) +
                                               std::abs(tangent.V[b][c](i, j)) / h);
                    }
                if (load.bodies[b] != world) all.add_size(arguments.X[b], dF, length_);
            }
        }
        return all;
    }

    LoadArguments arguments_of(int load, Instant at) const
    {
        return load_arguments(model_.loads()[load], at, X_, V_, turns_.turns().of(load, angles_));
    }

    void add_loads(Instant at, Supply& now) const
    {
        for (int l = 0; l < static_cast<int>(model_.loads().size()); ++l) {
            const Load& load = model_.loads()[l];
            const LoadArguments arguments = arguments_of(l, at);
            LoadForces F{};
            load.forces(arguments, F);
            for (int b = 0; b < 2; ++b) {
                if (load.bodies[b] != world) now.add_force(arguments.X[b], F[b], length_);
            }
            now.work += power_without_potential(load, arguments);
        }
    }

    /// -G^T lambda on all bodies: between two bodies it adds up to nothing, so what stays is the world's. Its
    /// power is that of drives, -lambda G X' = lambda dPhi/dt at fixed X.
    void add_joints(int element, int k, Supply& now)
    {
        multipliers_->values(element, k, lambda_);
        const Instant at = joints_.instant(element, k);
        for (int r = 0; r < model_.n_rows(); ++r) {
            if (lambda_[r] == 0) continue;
            const Tables::RowTable& table = tables_.rows[r];
            double g[Tables::gradient_size];
            tables_.gradient(r, at, X_.data()->data(), g);
            for (int side = 0; side < table.n_sides; ++side) {
                Matrix34 force{};
                for (const int column : table.columns[side])
                    for (int i = column; i < column + 3; ++i) force.a[i] = -lambda_[r] * g[12 * side + i];
                now.add_force(X_[table.bodies[side]], force, length_);
            }
            if (!table.is_quadratic) now.work += lambda_[r] * constraint_rate(*table.row, at, X_);
        }
    }

    const Model& model_;
    const Tables tables_;
    std::vector<double> load_weights_, joint_weights_;
    ElementSampler loads_, joints_;
    const Motion& motion_;
    const LoadTurns turns_;
    std::vector<double> angles_;   // of loads, where X_ is
    double length_;
    double largest_gross_moment_ = 0, largest_kinetic_ = 0;
    std::optional<FieldTable> multipliers_;   // a field of its own degree, at the joints' points
    std::vector<Matrix34> X_, V_;
    std::vector<double> lambda_;
    std::vector<Matrix34> weights_of_bodies_;
};

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

/// Goes from element end to element end.
class Balancing {
public:
    Balancing(const Model& model, const Motion& motion)
        : model_(model), motion_(motion), supply_(model, motion),
          X_(static_cast<std::size_t>(motion.n_bodies))
    {}

    /// The next `n` ends, or what is left of them. False: nothing is.
    bool next(int n, Balance& piece)
    {
        const int last = n < motion_.n_elements() + 1 - end_ ? end_ + n : motion_.n_elements() + 1;
        if (end_ == last) return false;
        reserve(static_cast<std::size_t>(last - end_), piece);
        for (; end_ < last; ++end_) {
            Patience::ask();
            if (end_ > 0) total_.add(1, supply_.over(end_ - 1));
            append_state(piece);
            append_supply(piece);
        }
        static_cast<BalanceFigures&>(piece) = figures();
        return true;
    }
    BalanceFigures figures() const
    {
        BalanceFigures figures = figures_;
        figures.reference_energy += supply_.largest_gross_moment();
        raise_to(figures.largest_kinetic, supply_.largest_kinetic());   // where all ends are at rest
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
        const std::span<const Matrix34> P =
            std::span<const Matrix34>(motion_.momenta)
                .subspan(static_cast<std::size_t>(end_) * X_.size(), X_.size());
        positions_at_end(motion_, end_, X_);
        const Instant at{motion_.mesh.ends[end_], end_ == motion_.n_elements() ? Side::left : Side::right};
        const double kinetic = kinetic_energy(model_, X_, V),
                     potential = potential_energy(model_, at, X_, V, supply_.turns().at_end(end_));
        piece.t.push_back(at.t);
        piece.kinetic.push_back(kinetic);
        piece.potential.push_back(potential);
        piece.energy.push_back(kinetic + potential);
        piece.linear_momentum.push_back(linear_momentum(P));
        piece.angular_momentum.push_back(angular_momentum(X_, P));
        if (end_ == 0) {
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
    void append_supply(Balance& piece)
    {
        piece.work.push_back(total_.work);
        piece.linear_impulse.push_back(total_.linear);
        piece.angular_impulse.push_back(total_.angular);
        piece.energy_drift.push_back(std::abs(piece.energy.back() - start_.energy - total_.work));
        piece.linear_momentum_drift.push_back(
            norm(piece.linear_momentum.back() - start_.linear_momentum - total_.linear));
        piece.angular_momentum_drift.push_back(
            norm(piece.angular_momentum.back() - start_.angular_momentum - total_.angular));
        raise_to(figures_.largest_impulse, norm(total_.linear));
        raise_to(figures_.largest_energy_drift, piece.energy_drift.back());
        raise_to(figures_.largest_linear_momentum_drift, piece.linear_momentum_drift.back());
        raise_to(figures_.largest_angular_momentum_drift, piece.angular_momentum_drift.back());
        append_rise(piece.energy.back());
    }
    /// From the lowest that it was since the start.
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
    SupplyIntegral supply_;
    Supply total_;
    std::vector<Matrix34> X_;
    BalanceFigures figures_;   // references without what is integrated
    struct {
        double potential, energy;
        Vector3 linear_momentum, angular_momentum;
    } start_{};
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

BalanceFigures balance(const Model& model, const Motion& motion, int n_ends,
                       const std::function<void(Balance&)>& take)
{
    assert(model.n_bodies() == motion.n_bodies && model.n_rows() == motion.n_rows);
    assert(motion.momenta.size() == motion.mesh.ends.size() * static_cast<std::size_t>(motion.n_bodies));
    Balancing balancing(model, motion);
    Balance piece;
    while (balancing.next(n_ends, piece)) take(piece);
    return balancing.figures();
}

Balance balance(const Model& model, const Motion& motion)
{
    Balance whole;
    balance(model, motion, std::numeric_limits<int>::max(),
            [&](Balance& piece) { whole = std::move(piece); });
    return whole;
}

}   // namespace livens
