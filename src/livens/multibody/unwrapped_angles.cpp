// SPDX-License-Identifier: BSD-3-Clause
// Unwrapped angles of loads: whole turns, which X does not tell, are counted along the motion (theory.md,
// "Coordinates of joints", Loads along coordinates). The count is right while no angle turns by half a turn
// between two calls.
#include "livens/multibody/unwrapped_angles.h"

#include "livens/base/elementary.h"
#include "livens/multibody/model.h"

namespace livens {

UnwrappedAngles::UnwrappedAngles(const Model& model) : first_{0}
{
    for (const Load& load : model.loads()) {
        angles_.insert(angles_.end(), load.angles.begin(), load.angles.end());
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
        const PairForm &c = angles_[i].forms[0], &s = angles_[i].forms[1];
        const double angle =
            arc_tangent(form_value(s, s.body_i, s.body_j, X), form_value(c, c.body_i, c.body_j, X));
        row[i] = turned_to(angle, row[i]);
    }
}

}   // namespace livens
