// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

#include "livens/base/largest.h"
#include "livens/diagnostics/detail/sampler.h"
#include "livens/diagnostics/diagnostics.h"
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
        for (int c = 0; c < 4; ++c) angular += cross(X.column(c), F.column(c));
        add_size(X, F, length);
    }

    void add_size(const Matrix34& X, const Matrix34& F, double length)
    {
        gross += norm(F.column(0));
        gross_moment += norm(F.column(0)) * length;
        for (int c = 0; c < 4; ++c) gross_moment += norm(X.column(c)) * norm(F.column(c));
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
    if (motion.constraints_hold == "element nodes") return nodal_rule(motion.X);
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
    /// Of all instants so far.
    double largest_gross_moment() const { return largest_gross_moment_; }
    double largest_kinetic() const { return largest_kinetic_; }

private:
    SupplyIntegral(const Model& model, const Motion& motion, Quadrature loads, Quadrature joints)
        : model_(model), load_weights_(loads.weights), joint_weights_(joints.weights),
          loads_(motion, loads.points), joints_(motion, joints.points), motion_(motion),
          length_(model.length()), X_(static_cast<std::size_t>(motion.n_bodies)), V_(X_.size())
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
        for (const Load& load : model_.loads()) {
            if (!load.depends_on_X && !load.depends_on_V) continue;
            const LoadArguments arguments = load_arguments(load, loads_.instant(element, 0), X_, V_);
            LoadTangent tangent{};
            load.tangent(arguments, tangent);
            for (int b = 0; b < 2; ++b) {
                Matrix34 dF{};
                for (int c = 0; c < 2; ++c)
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

    void add_loads(Instant at, Supply& now) const
    {
        for (const Load& load : model_.loads()) {
            const LoadArguments arguments = load_arguments(load, at, X_, V_);
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
            const ConstraintRow& row = model_.row(r);
            const RowGradient g = constraint_gradient(row, at, X_);
            for (const int body : g.bodies) now.add_force(X_[body], -lambda_[r] * g.of(body), length_);
            now.work += lambda_[r] * constraint_rate(row, at, X_);
        }
    }

    const Model& model_;
    std::vector<double> load_weights_, joint_weights_;
    ElementSampler loads_, joints_;
    const Motion& motion_;
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

/// Energies and momenta at one element end.
void append_state(const Model& model, const Motion& motion, int end, std::span<Matrix34> X, Balance& balance)
{
    const std::span<const Matrix34> V = velocities_at_end(motion, end);
    const std::span<const Matrix34> P =
        std::span<const Matrix34>(motion.momenta).subspan(static_cast<std::size_t>(end) * X.size(), X.size());
    positions_at_end(motion, end, X);
    const Instant at{motion.mesh.ends[end], end == motion.n_elements() ? Side::left : Side::right};

    balance.t.push_back(at.t);
    balance.kinetic.push_back(kinetic_energy(model, X, V));
    balance.potential.push_back(potential_energy(model, at, X, V));
    balance.energy.push_back(balance.kinetic.back() + balance.potential.back());
    balance.linear_momentum.push_back(linear_momentum(P));
    balance.angular_momentum.push_back(angular_momentum(X, P));
    raise_to(balance.largest_kinetic, balance.kinetic.back());
    raise_to(balance.largest_moment, moment_of_momentum(X, P));
    double momentum = 0;
    for (const Matrix34& p : P) momentum += norm(p.column(0));
    raise_to(balance.largest_momentum, momentum);
}

void append_supply(const Supply& total, Balance& balance)
{
    const std::size_t end = balance.work.size();
    balance.work.push_back(total.work);
    balance.linear_impulse.push_back(total.linear);
    balance.angular_impulse.push_back(total.angular);
    balance.energy_drift.push_back(std::abs(balance.energy[end] - balance.energy[0] - total.work));
    balance.linear_momentum_drift.push_back(
        norm(balance.linear_momentum[end] - balance.linear_momentum[0] - total.linear));
    balance.angular_momentum_drift.push_back(
        norm(balance.angular_momentum[end] - balance.angular_momentum[0] - total.angular));
}

/// See Balance; `moving` is what is in motion, `level` what rounding is relative to.
double relative(const std::vector<double>& drift, double moving, double level)
{
    double worst = 0;
    for (const double d : drift) raise_to(worst, d);
    return worst <= rounding * level ? 0 : worst / std::max(moving, rounding * level);
}

/// The largest kinetic energy or change of potential energy.
double moving_energy(const Balance& balance)
{
    double moving = balance.largest_kinetic;
    for (const double v : balance.potential) raise_to(moving, std::abs(v - balance.potential.front()));
    return moving;
}

}   // namespace

double Balance::relative_energy_drift() const
{
    return relative(energy_drift, moving_energy(*this), reference_energy);
}

double Balance::relative_energy_rise() const
{
    std::vector<double> risen(energy.size(), 0.0);
    for (std::size_t end = 1; end < energy.size(); ++end) {
        const double supplied = std::max(work[end] - work[end - 1], 0.0);
        const double sum = risen[end - 1] + (energy[end] - energy[end - 1]) - supplied;
        risen[end] = sum < 0 ? 0 : sum;
    }
    return relative(risen, moving_energy(*this), reference_energy);
}

double Balance::relative_energy_loss() const
{
    if (energy.empty()) return 0;
    const double lost = energy.front() - (energy.back() - work.back());
    return relative({std::max(lost, 0.0)}, moving_energy(*this), reference_energy);
}

double Balance::relative_linear_momentum_drift() const
{
    double moving = largest_momentum;
    for (const Vector3& impulse : linear_impulse) raise_to(moving, norm(impulse));
    return relative(linear_momentum_drift, moving, reference_impulse + moving);
}

double Balance::relative_angular_momentum_drift() const
{
    return relative(angular_momentum_drift, largest_moment, reference_moment + largest_moment);
}

Balance balance(const Model& model, const Motion& motion)
{
    assert(model.n_bodies() == motion.n_bodies && model.n_rows() == motion.n_rows);
    assert(motion.momenta.size() == motion.mesh.ends.size() * static_cast<std::size_t>(motion.n_bodies));
    Balance result;
    if (motion.mesh.ends.empty()) return result;
    std::vector<Matrix34> X(static_cast<std::size_t>(motion.n_bodies));
    SupplyIntegral supply(model, motion);
    Supply total;
    append_state(model, motion, 0, X, result);
    append_supply(total, result);
    for (int e = 0; e < motion.n_elements(); ++e) {
        append_state(model, motion, e + 1, X, result);
        total.add(1, supply.over(e));
        append_supply(total, result);
    }
    for (const double v : result.potential) raise_to(result.reference_energy, std::abs(v));
    result.reference_energy += supply.largest_gross_moment();
    raise_to(result.largest_kinetic, supply.largest_kinetic());   // where all ends are at rest
    result.reference_impulse = total.gross;
    result.reference_moment = total.gross_moment;
    return result;
}

}   // namespace livens
