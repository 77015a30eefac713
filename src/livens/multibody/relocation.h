// SPDX-License-Identifier: BSD-3-Clause
// Parts of a model as they are in another one, to which they are added.
#pragma once

#include <functional>
#include <limits>
#include <string>

#include "livens/multibody/displacement.h"
#include "livens/multibody/model.h"

namespace [[gnu::visibility("default")]] livens {

/// Names get a prefix, indices count on, and everything is displaced: bodies with their velocities, and what
/// refers to the axes or places of the world, which then are those of the displacement. Numbers that sensors,
/// coordinates and loads tell of themselves stay what they are.
struct Relocation {
    std::string prefix;
    Displacement by{};
    int first_body = 0, first_load = 0;
    std::function<int(int)> joint = nullptr;   ///< where a joint of the part is in the model
    /// Where bodies of the part that came later than others of the model are: its number n_early and on.
    int n_early = std::numeric_limits<int>::max(), first_late = 0;

    std::string name(const std::string& own) const { return prefix + own; }
    int body(int own) const
    {
        if (own == world) return world;
        return own < n_early ? own + first_body : own - n_early + first_late;
    }
};

/// A part as it is in the other model.  (Model::add)
Body relocated(Body body, const Relocation& to);
NamedPoint relocated(NamedPoint point, const Relocation& to);
Joint relocated(Joint joint, const Relocation& to);
Load relocated(Load load, const Relocation& to);
Sensor relocated(Sensor sensor, const Relocation& to);
Event relocated(Event event, const Relocation& to);
Sampling relocated(Sampling sampling, const Relocation& to);
JointCoordinate relocated(JointCoordinate coordinate, const Relocation& to);
ReactionInput relocated(ReactionInput reaction, const Relocation& to);

}   // namespace gnu::visibility("default")]]livens
