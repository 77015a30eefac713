// SPDX-License-Identifier: BSD-3-Clause
// A model at an instant, and its instants: where joints act for a part of the time, laws break and drives
// move.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "livens/multibody/acting_models.h"

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

std::vector<double> Model::event_times() const
{
    std::vector<double> all;
    const auto add = [&all](const ActingTimes& times) {
        for (const TimeSpan& one : times.spans())
            for (const double t : {one.from, one.until})
                if (std::isfinite(t)) all.push_back(t);
    };
    for (const Joint& joint : joints_) add(joint);
    for (const Load& load : loads_) add(load);
    for (const Sampling& sampling : samplings_) {
        const std::vector<double> instants = sampling.instants();
        all.insert(all.end(), instants.begin(), instants.end());
    }
    return ascending(std::move(all));
}

std::vector<double> Model::load_breaks() const
{
    std::vector<double> all = event_times();
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

/// A load that was made for other times is made anew from the load that it is whenever it acts.
Model as_decided(const Model& model, const DecidedTimes& times)
{
    Model now = model;
    const auto decide = [](ActingTimes& one, const std::vector<std::vector<TimeSpan>>& all, std::size_t k) {
        one.is_from_motion = one.is_decided_by_events() && !all.empty();
        one.decided = one.is_from_motion ? all[k] : std::vector<TimeSpan>{};
    };
    for (std::size_t j = 0; j < now.joints_.size(); ++j) decide(now.joints_[j], times.joints, j);
    for (std::size_t l = 0; l < now.loads_.size(); ++l) {
        Load& load = now.loads_[l];
        if (!load.is_decided_by_events()) continue;
        if (load.by_reactions != nullptr) {   // whose laws know their times
            decide(load, times.loads, l);
            continue;
        }
        load = Load(*load.whenever);
        decide(load, times.loads, l);
        load = for_its_time(load);
    }
    now.changed();
    bind_reaction_laws(now);
    return now;
}

/// Joints are numbered anew, as they act. Loads stay all: whether one acts is part of its functions (see
/// for_its_time()). A reaction of a joint that does not act has the joint -1.
ActingModel acting_at(const Model& model, double t)
{
    ActingModel acting{Model(model.gravity()), {}, {}};
    for (const Body& body : model.bodies()) acting.model.add_body(body);
    for (int j = 0; j < static_cast<int>(model.joints().size()); ++j) {
        Joint joint = model.joints()[j];
        if (!joint.acts_at(t)) continue;
        for (int k = 0; k < static_cast<int>(joint.rows.size()); ++k)
            acting.rows.push_back(model.first_row(j) + k);
        static_cast<ActingTimes&>(joint) = {};
        acting.joints.push_back(j);
        acting.model.add_joint(std::move(joint));
    }
    for (Load load : model.loads()) {
        static_cast<ActingTimes&>(load) = {};
        if (load.by_reactions != nullptr) {
            ReactionLaw law = *load.by_reactions;
            for (ReactionInput& one : law.reactions) {
                const auto at = std::ranges::find(acting.joints, one.joint);
                one.joint = at == acting.joints.end() ? -1 : static_cast<int>(at - acting.joints.begin());
            }
            load.by_reactions = std::make_shared<const ReactionLaw>(std::move(law));
        }
        acting.model.add_load(std::move(load));
    }
    for (const Sensor& sensor : model.sensors()) acting.model.add_sensor(sensor);
    for (const NamedPoint& point : model.points()) acting.model.add_point(point);
    bind_reaction_laws(acting.model);
    return acting;
}

/// Known by the joints that act and not by the instant: phases in which the same joints act share a model.
std::shared_ptr<const ActingModel> ActingModels::at(double t)
{
    std::vector<int> joints;
    for (int j = 0; j < static_cast<int>(model_.joints().size()); ++j)
        if (model_.joints()[j].acts_at(t)) joints.push_back(j);
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const std::shared_ptr<const ActingModel>& one : known_)
        if (one->joints == joints) return one;
    known_.push_back(std::make_shared<const ActingModel>(acting_at(model_, t)));
    return known_.back();
}

}   // namespace livens
