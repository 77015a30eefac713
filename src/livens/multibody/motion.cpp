// SPDX-License-Identifier: BSD-3-Clause
// A motion: fields X, P and multipliers over time elements, evaluable at any instant. Element ends have
// velocities of their own, from the momentum, because the slope of the polynomial is of a lower order there
// (theory.md, "The element", Order).
#include "livens/multibody/motion.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <memory>

#include "livens/base/error.h"
#include "livens/multibody/model.h"
#include "livens/multibody/wording.h"
#include "livens/time/basis.h"

namespace livens {

namespace {

constexpr int max_degree = 32;

/// Lagrange bases, each built at its first use: all of them would cost more than a short motion.
const LagrangeBasis& known_basis(Points points, int degree)
{
    // No std::call_once: the C library ends the program where memory ends inside of it.
    struct Known {
        std::atomic<const LagrangeBasis*> basis{nullptr};
        ~Known() { delete basis.load(); }
    };
    static std::array<Known, 2 * max_degree> all;
    assert(degree >= 1 && degree <= max_degree);
    Known& known = all[static_cast<std::size_t>((points == Points::lobatto ? 0 : max_degree) + degree - 1)];
    if (const LagrangeBasis* const basis = known.basis.load(std::memory_order_acquire)) return *basis;
    auto made = std::make_unique<const LagrangeBasis>(basis_on(points, degree));
    const LagrangeBasis* first = nullptr;   // of several threads
    if (!known.basis.compare_exchange_strong(first, made.get(), std::memory_order_acq_rel)) return *first;
    return *made.release();
}

Matrix34 body_of(std::span<const double> stacked, int body)
{
    Matrix34 X{};
    std::copy_n(stacked.data() + 12 * body, 12, X.data());
    return X;
}

}   // namespace

std::span<const double> Field::coefficient(int element, int a) const
{
    return std::span<const double>(values).subspan(static_cast<std::size_t>(index(element, a)) * n_values,
                                                   n_values);
}

std::span<double> Field::coefficient(int element, int a)
{
    return std::span<double>(values).subspan(static_cast<std::size_t>(index(element, a)) * n_values,
                                             n_values);
}

LagrangeBasis Field::basis() const
{
    return degree == 0 ? LagrangeBasis({0.5}) : known_basis(points, degree);
}

void Field::evaluate(int element, double s, int derivative, std::span<double> out) const
{
    assert(derivative == 0 || derivative == 1);
    assert(static_cast<int>(out.size()) == n_values);
    const std::span<const double> first = coefficient(element, 0);
    if (derivative == 0)
        std::ranges::copy(first, out.begin());
    else
        std::ranges::fill(out, 0.0);
    if (degree == 0) return;

    const std::size_t n = static_cast<std::size_t>(degree) + 1;
    std::array<double, max_degree + 1> M{}, D{};
    const LagrangeBasis& basis = known_basis(points, degree);
    if (derivative == 0 || !denominators.empty()) basis.values(s, std::span(M.data(), n));
    if (derivative == 1) basis.derivatives(s, std::span(D.data(), n));
    make_rational(element, std::span(M.data(), n), std::span(D.data(), derivative == 1 ? n : 0));
    const std::array<double, max_degree + 1>& weights = derivative == 0 ? M : D;
    // In differences from the first coefficient, as the basis adds up to one: rounding is that of the change.
    for (int a = 1; a <= degree; ++a) {
        const std::span<const double> c = coefficient(element, a);
        for (int i = 0; i < n_values; ++i) out[i] += weights[a] * (c[i] - first[i]);
    }
}

void Field::make_rational(int element, std::span<double> M, std::span<double> derivatives) const
{
    if (denominators.empty()) return;
    assert(denominators.size() * static_cast<std::size_t>(n_values) == values.size());
    assert(static_cast<int>(M.size()) == degree + 1);
    const double* W = denominators.data() + index(element, 0);
    double sum = 0, rate = 0;   // the denominator at this point, and its derivative
    for (std::size_t a = 0; a < M.size(); ++a) sum += W[a] * M[a];
    for (std::size_t a = 0; a < M.size(); ++a) M[a] *= W[a] / sum;
    for (std::size_t a = 0; a < derivatives.size(); ++a) rate += W[a] * derivatives[a];
    // (W_a M_a / W)' = (W_a M_a' - W' W_a M_a / W) / W
    for (std::size_t a = 0; a < derivatives.size(); ++a)
        derivatives[a] = (W[a] * derivatives[a] - rate * M[a]) / sum;
}

const char* to_string(ConstraintsHold where)
{
    constexpr const char* words[] = {"", "element nodes", "element ends", "weakly"};
    return words[static_cast<int>(where)];
}

std::size_t Motion::n_bytes() const
{
    std::size_t numbers = mesh.ends.capacity() + end_multipliers.capacity() + load_angles.capacity();
    for (const Field* field : {&X, &P, &multipliers, &rigidity})
        numbers += field->values.capacity() + field->denominators.capacity();
    for (const auto* columns : {&momenta, &velocities, &accelerations}) numbers += 12 * columns->capacity();
    for (const auto* columns : {&impacts.momenta, &impacts.velocities}) numbers += 12 * columns->capacity();
    return numbers * sizeof(double);
}

std::span<const double> Motion::angles_at(int end) const
{
    const std::size_t n = load_angles.size() / mesh.ends.size();
    return std::span(load_angles).subspan(n * static_cast<std::size_t>(end), n);
}

State Motion::at(double t) const
{
    if (!(t >= start() && t <= end()))
        throw InputError({"time-outside", "", "the motion is not known at this instant", to_text(t),
                          to_text(start()) + " <= t <= " + to_text(end()), "", ""});
    const int element = mesh.element_at(t);
    // Velocities at element ends are of order 2p; those of the polynomials on either side are of order p.
    if (t == mesh.ends[element]) return at_end(element);
    if (t == mesh.ends[element + 1]) return at_end(element + 1);

    const double h = mesh.length(element);
    const double s = (t - mesh.ends[element]) / h;
    std::vector<double> x(X.n_values), rates(X.n_values);
    X.evaluate(element, s, 0, x);
    X.evaluate(element, s, 1, rates);
    State state;
    state.is_of_motion = true;
    state.t = t;
    state.X.reserve(static_cast<std::size_t>(n_bodies));
    state.V.reserve(static_cast<std::size_t>(n_bodies));
    for (int b = 0; b < n_bodies; ++b) {
        state.X.push_back(body_of(x, b));
        state.V.push_back((1 / h) * body_of(rates, b));
    }
    const std::span<const double> angles = angles_at(element);
    state.angles.assign(angles.begin(), angles.end());
    return state;
}

int Impacts::at(int end) const
{
    const auto found = std::ranges::lower_bound(ends, end);
    return found != ends.end() && *found == end ? static_cast<int>(found - ends.begin()) : -1;
}

State Motion::at_end(int end, Side side) const
{
    State state;
    at_end(end, side, state);
    return state;
}

void Motion::at_end(int end, Side side, State& state) const
{
    assert(end >= 0 && end <= n_elements());
    assert(static_cast<int>(velocities.size()) == (n_elements() + 1) * n_bodies);
    state.is_of_motion = true;
    state.t = mesh.ends[end];
    state.X.resize(static_cast<std::size_t>(n_bodies));
    const std::span<const double> x =
        end < n_elements() ? X.coefficient(end, 0) : X.coefficient(end - 1, X.degree);
    for (int b = 0; b < n_bodies; ++b) state.X[b] = body_of(x, b);
    const auto v = velocities.begin() + static_cast<std::ptrdiff_t>(end) * n_bodies;
    state.V.assign(v, v + n_bodies);
    const int impact = side == Side::left ? impacts.at(end) : -1;
    if (impact >= 0) std::copy_n(impacts.velocities.begin() + impact * n_bodies, n_bodies, state.V.begin());
    const std::span<const double> angles = angles_at(end);
    state.angles.assign(angles.begin(), angles.end());
}

Reaction joint_reaction(const Model& model, int joint, std::span<const Matrix34> X,
                        std::span<const double> multipliers)
{
    const Joint& j = model.joints()[joint];
    Matrix34 F{};
    for (int k = 0; k < static_cast<int>(j.rows.size()); ++k) {
        const double multiplier = multipliers[model.first_row(joint) + k];
        // Multipliers enter the law as forces -G^T lambda; on the second body that is the joint's reaction.
        if (multiplier != 0) F -= multiplier * constraint_gradient(j.rows[k], X).of(j.second);
    }
    return joint_reaction(j, X[j.second], F);
}

Reaction joint_reaction(const Joint& joint, const Matrix34& X_second, const Matrix34& F)
{
    Reaction reaction;
    reaction.force = F.column(0);
    // Forces on directors do work under a turn like the moment sum d_i x F_i.
    for (int i = 1; i < 4; ++i) reaction.torque += cross(X_second.column(i), F.column(i));
    // The moment of F about the reference point, moved to the joint point.
    const Vector3 arm = X_second * point(joint.point_second) - X_second.column(0);
    reaction.torque -= cross(arm, reaction.force);
    return reaction;
}

double number_of(const Reaction& reaction, const ReactionInput& input)
{
    const Vector3& v = input.is_torque ? reaction.torque : reaction.force;
    return input.along == Vector3{} ? norm(v) : dot(input.along, v);
}

}   // namespace livens
