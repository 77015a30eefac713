// SPDX-License-Identifier: BSD-3-Clause
// A model at an instant, and its instants: where joints act for a part of the time, laws break and drives
// move.
#include <algorithm>
#include <cmath>
#include <limits>

#include "livens/multibody/model.h"

namespace livens {

namespace {

std::vector<double> ascending(std::vector<double> all)
{
    std::ranges::sort(all);
    const auto repeated = std::unique(all.begin(), all.end());
    all.erase(repeated, all.end());
    return all;
}

}   // namespace

std::vector<double> Model::events() const
{
    std::vector<double> all;
    for (const Joint& joint : joints_)
        for (const double t : {joint.from, joint.until})
            if (std::isfinite(t)) all.push_back(t);
    return ascending(std::move(all));
}

std::vector<double> Model::load_breaks() const
{
    std::vector<double> all = events();
    const auto add = [&all](const std::vector<double>& more) {
        all.insert(all.end(), more.begin(), more.end());
    };
    for (const Load& load : loads_) add(load.breaks);
    for (const Joint& joint : joints_)
        for (const ConstraintRow& row : joint.rows)
            for (const Drive& drive : row.drives) add(drive.factor.breaks());
    return ascending(std::move(all));
}

Model frozen(const Model& model, Instant at)
{
    Model now = model;
    now.has_.drives = false;
    for (Joint& joint : now.joints_)
        for (auto* rows : {&joint.rows, &joint.branches})
            for (ConstraintRow& row : *rows) row = frozen(row, at);
    now.changed();
    return now;
}

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
