// SPDX-License-Identifier: BSD-3-Clause
// A coordinate q as a load sees it: value with its turns, rate, F_b = Q dq/dX_b and the tangents of both.
// theory.md, "Coordinates of joints", Loads along coordinates, has the formulas.
#include "livens/multibody/loads/load_coordinate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "livens/base/elementary.h"
#include "livens/multibody/loads/load_values.h"

namespace livens {

namespace {

double value_of(const PairForm& form, const Configurations& X)
{
    return form_value(form, form.body_i, form.body_j, X);
}

/// The same angle, zero in X: sine and cosine are turned.
JointCoordinate from(const JointCoordinate& coordinate, const Configurations& X)
{
    if (!coordinate.counts_turns()) return coordinate;
    const std::vector<PairForm>& forms = coordinate.forms;
    const double c = value_of(forms[0], X), s = value_of(forms[1], X), size = hypotenuse(c, s, 0);
    const auto mixed = [&](double a, double b) {
        PairForm sum = forms[0];
        const PairForm& other = forms[1];
        const auto mix = [&](auto& to, const auto& more) { to = a / size * to + b / size * more; };
        mix(sum.c_ii, other.c_ii);
        mix(sum.c_ij, other.c_ij);
        mix(sum.c_jj, other.c_jj);
        mix(sum.b_i, other.b_i);
        mix(sum.b_j, other.b_j);
        sum.c = a / size * forms[0].c + b / size * other.c;
        return sum;
    };
    // Turned so that the angle is zero where the bodies stand: the cut of atan2 then lies half a turn away.
    return {{mixed(c, s), mixed(-s, c)}, coordinate.kind};
}

/// Positions do not tell whole turns: where nobody counts them, an angle nearer than this to half a turn is
/// not a number.
constexpr double widest_angle = widest_rotation;   // as near to half a turn

/// Whether the gradient of a form by X of its body j, or i, has more than a first column.
bool turns(const PairForm& form, bool by_j)
{
    double sum = 0;
    for (int a = 0; a < 4; ++a)
        for (int b = 1; b < 4; ++b)
            sum += std::abs(by_j ? form.c_ij(a, b) : form.c_ij(b, a)) +
                   std::abs(by_j ? form.c_jj(a, b) : form.c_ii(a, b));
    for (int k = 1; k < 4; ++k) sum += norm((by_j ? form.b_j : form.b_i).column(k));
    return sum > 0;
}

}   // namespace

/// Values count from where the bodies stand: an angle is turned to zero there, of others the offset takes off
/// what they are.
LoadCoordinate::LoadCoordinate(const JointCoordinate& coordinate, double at_stated, const Configurations& X)
    : at_start_(at_stated), offset_(at_stated)
{
    coordinate_ = from(coordinate, X);
    const PairForm& first = coordinate_.forms[0];
    bodies_ = {first.body_j, first.body_i};
    n_ = first.body_i == world ? 1 : 2;
    for (const PairForm& form : coordinate_.forms) {
        needs_directors_[0] = needs_directors_[0] || turns(form, true);
        needs_directors_[1] = needs_directors_[1] || (n_ == 2 && turns(form, false));
    }
    if (!coordinate_.counts_turns()) offset_ -= coordinate_value(coordinate_, X);
}

/// Bodies become places in the load's list. A displacement is one form; an angle is a row with one function
/// of its forms.
void LoadCoordinate::place(Load& load, bool counts_turns)
{
    const std::vector<int>& load_bodies = load.bodies;
    if (coordinate_.counts_turns() && counts_turns) {
        angle_ = static_cast<int>(load.angles.size());
        load.angles.push_back(coordinate_);
    }
    if (coordinate_.kind == CoordinateKind::rotation_component) load.rotations.push_back(coordinate_);
    for (std::size_t b = 0; b < n_; ++b)
        places_[b] = static_cast<int>(std::ranges::find(load_bodies, bodies_[b]) - load_bodies.begin());
    placed_ = coordinate_;
    for (PairForm& form : placed_.forms) {
        form.body_j = places_[0];
        form.body_i = n_ == 2 ? places_[1] : world;
    }
    row_ = {};
    if (!coordinate_.is_angle())
        static_cast<PairForm&>(row_) = placed_.forms[0];
    else
        row_ = coupling_row({{1, placed_}}, 0, 1, "angle");
}

CoordinateState LoadCoordinate::look(const LoadArguments& arguments) const
{
    const Configurations X(arguments.X.data()->data());
    const RowGradient gradient = constraint_gradient(row_, X);
    CoordinateState seen{offset_ + constraint_value(row_, X), 0};
    if (angle_ >= 0 && !arguments.angles.empty()) {
        // The family counts turns: of all values of the angle the one next to that of the last node is meant.
        seen.value = turned_to(seen.value, offset_ + arguments.angles[static_cast<std::size_t>(angle_)]);
    } else if (angle_ >= 0 && std::abs(seen.value - at_start_) > widest_angle) {
        seen.value = std::numeric_limits<double>::quiet_NaN();
    }
    if (coordinate_.is_angle() && !is_known(placed_, X))
        seen.value = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t b = 0; b < n_; ++b) seen.rate += dot(gradient.of(places_[b]), arguments.V[places_[b]]);
    return seen;
}

void LoadCoordinate::add_products(const LoadArguments& arguments, double by_value, double by_rate,
                                  ProductSlopes& slopes) const
{
    if (by_value == 0 && by_rate == 0) return;
    const RowGradient gradient = constraint_gradient(row_, Configurations(arguments.X.data()->data()));
    for (std::size_t b = 0; b < n_; ++b) {
        const Matrix34 g = gradient.of(places_[b]);
        slopes.by_X[static_cast<std::size_t>(places_[b])] += by_value * g;
        slopes.by_V[static_cast<std::size_t>(places_[b])] += by_rate * g;
    }
}

void LoadCoordinate::add_forces(const LoadArguments& arguments, double Q, LoadForces& F) const
{
    const RowGradient gradient = constraint_gradient(row_, Configurations(arguments.X.data()->data()));
    for (std::size_t b = 0; b < n_; ++b) F[places_[b]] += Q * gradient.of(places_[b]);
}

/// With q' = sum_c <g_c, V_c>: dq'/dX_b = sum_c H_bc V_c and dq'/dV_b = g_b.
void LoadCoordinate::add_slopes(const LoadArguments& arguments, double by_value, double by_rate,
                                PerBody<Matrix34>& by_X, PerBody<Matrix34>& by_V) const
{
    const Configurations X(arguments.X.data()->data());
    const RowGradient gradient = constraint_gradient(row_, X);
    for (std::size_t b = 0; b < n_; ++b) {
        const Matrix34 g = gradient.of(places_[b]);
        by_X[places_[b]] += by_value * g;
        by_V[places_[b]] += by_rate * g;
        for (std::size_t c = 0; c < n_ && by_rate != 0; ++c) {
            const Matrix<12, 12> H = constraint_hessian(row_, arguments.at, X, places_[b], places_[c]);
            for (int j = 0; j < 12; ++j)
                for (int i = 0; i < 12; ++i)
                    by_X[places_[b]].a[i] += by_rate * H(i, j) * arguments.V[places_[c]].a[j];
        }
    }
}

/// dF_b/dX_c = g_b dQ/dX_c + Q H_bc and dF_b/dV_c = g_b dQ/dV_c.
void LoadCoordinate::add_tangent(const LoadArguments& arguments, const LawValue& Q,
                                 LoadTangent& tangent) const
{
    const Configurations X(arguments.X.data()->data());
    const RowGradient gradient = constraint_gradient(row_, X);
    PerBody<Matrix34> by_X(arguments.X.size()), by_V(arguments.X.size());
    add_slopes(arguments, Q.by_value, Q.by_rate, by_X, by_V);
    for (std::size_t b = 0; b < n_; ++b)
        for (std::size_t c = 0; c < n_; ++c) {
            const int of = places_[b], by = places_[c];
            const Matrix34 g = gradient.of(of);
            add_outer(tangent.X[of][by], g, by_X[by]);
            add_outer(tangent.V[of][by], g, by_V[by]);
            if (Q.force != 0)
                tangent.X[of][by] += Q.force * constraint_hessian(row_, arguments.at, X, of, by);
        }
}

}   // namespace livens
