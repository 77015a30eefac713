// SPDX-License-Identifier: BSD-3-Clause
// A model at an instant, where joints act for a part of the time: for who looks at one instant alone.
#include <limits>

#include "livens/multibody/model.h"

namespace livens {

ActingModel acting_at(const Model& model, double t)
{
    ActingModel acting{Model(model.gravity()), {}, {}};
    for (const Body& body : model.bodies()) acting.model.add_body(body);
    for (int j = 0; j < static_cast<int>(model.joints().size()); ++j) {
        Joint joint = model.joints()[j];
        if (!joint.acts_at(t)) continue;
        for (int k = 0; k < static_cast<int>(joint.rows.size()); ++k)
            acting.rows.push_back(model.first_row(j) + k);
        joint.from = -std::numeric_limits<double>::infinity();
        joint.until = std::numeric_limits<double>::infinity();
        acting.joints.push_back(j);
        acting.model.add_joint(std::move(joint));
    }
    for (const Load& load : model.loads()) acting.model.add_load(load);
    for (const Sensor& sensor : model.sensors()) acting.model.add_sensor(sensor);
    for (const NamedPoint& point : model.points()) acting.model.add_point(point);
    return acting;
}

}   // namespace livens
