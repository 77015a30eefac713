// SPDX-License-Identifier: BSD-3-Clause
// Unwrapped angles of loads: whole turns, which X does not tell, are counted along the motion (theory.md,
// "Coordinates of joints", Loads along coordinates). The count is right while no angle turns by half a turn
// between two calls.
#include "livens/multibody/unwrapped_angles.h"

#include "livens/base/elementary.h"
#include "livens/multibody/model.h"

namespace livens {

/// A form by numbers of X, 12 a body, without what is zero: it is asked all along a motion.
UnwrappedAngles::Terms::Terms(const PairForm& form) : constant(form.c)
{
    const auto add = [this](int x, int y, double factor) {
        if (factor != 0) products.push_back({x, y, factor});
    };
    const auto add_entries = [this](const Matrix34& b, int first) {
        for (int i = 0; i < 12; ++i)
            if (b.a[i] != 0) entries.push_back({first + i, b.a[i]});
    };
    const bool has_i = form.body_i != world;
    const int i = 12 * form.body_i, j = 12 * form.body_j;
    for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b) {
            add(j + 3 * a, j + 3 * b, 0.5 * form.c_jj(a, b));
            if (!has_i) continue;
            add(i + 3 * a, i + 3 * b, 0.5 * form.c_ii(a, b));
            add(i + 3 * a, j + 3 * b, form.c_ij(a, b));
        }
    add_entries(form.b_j, j);
    if (has_i) add_entries(form.b_i, i);
}

double UnwrappedAngles::Terms::value(const double* X) const
{
    double sum = constant;
    for (const auto& [place, factor] : entries) sum += factor * X[place];
    for (const auto& [x, y, factor] : products)
        sum += factor * (X[x] * X[y] + X[x + 1] * X[y + 1] + X[x + 2] * X[y + 2]);
    return sum;
}

UnwrappedAngles::UnwrappedAngles(const Model& model) : first_{0}
{
    for (const Load& load : model.loads()) {
        for (const JointCoordinate& angle : load.angles)
            angles_.push_back({Terms(angle.forms[0]), Terms(angle.forms[1])});
        first_.push_back(static_cast<int>(angles_.size()));
    }
}

std::vector<double> UnwrappedAngles::begin(const State& state) const
{
    return state.angles.empty() ? begin() : state.angles;
}

void UnwrappedAngles::follow(const Configurations& X, std::span<double> row) const
{
    follow_some(X, row, 0, static_cast<int>(row.size()));
}

void UnwrappedAngles::follow_of(int load, const Configurations& X, std::span<double> row) const
{
    if (!row.empty()) follow_some(X, row, first_[load], first_[load + 1]);
}

void UnwrappedAngles::follow_some(const Configurations& X, std::span<double> row, int from, int until) const
{
    for (int i = from; i < until; ++i) {
        const auto& [cosine, sine] = angles_[i];
        row[i] = turned_to(arc_tangent(sine.value(X.data()), cosine.value(X.data())), row[i]);
    }
}

}   // namespace livens
