// SPDX-License-Identifier: BSD-3-Clause
// Models that are added to a model: all of their parts, displaced and renamed, or none of them.
#include <algorithm>

#include "livens/base/error.h"
#include "livens/multibody/directors.h"
#include "livens/multibody/relocation.h"
#include "livens/multibody/wording.h"

namespace livens {

namespace {

template <typename T>
void refuse_taken_names(const std::vector<T>& own, const std::vector<T>& others, const std::string& prefix,
                        const std::string& kind)
{
    for (const T& one : others) {
        const std::string name = prefix + one.name;
        if (std::ranges::none_of(own, [&](const T& other) { return other.name == name; })) continue;
        throw InputError({"name-duplicate", kind + "[" + name + "]",
                          "there is a " + kind + " of this name, and the model that is added brings another",
                          name, "", "names of what is added begin with its prefix", "give another prefix"});
    }
}

void refuse_other_gravity(const Vector3& own, const Vector3& other)
{
    if (other == Vector3{} || other == own) return;
    const auto shown = [](const Vector3& g) {
        return "[" + to_text(g[0]) + ", " + to_text(g[1]) + ", " + to_text(g[2]) + "]";
    };
    throw InputError({"gravity-differs", "gravity", "a model that is added has another gravity",
                      shown(other) + " m/s^2", shown(own) + " m/s^2, or zero",
                      "gravity is the world's: it does not turn with what is added", ""});
}

}   // namespace

AddedParts Model::add(const Model& other, const std::string& prefix, const Displacement& by)
{
    require_finite(by.position, "position", "the place of a model that is added");
    require_finite(by.rotation, "rotation", "the rotation of a model that is added");
    check_directors(by.rotation, "rotation");
    refuse_other_gravity(gravity_, other.gravity_);
    refuse_taken_names(bodies_, other.bodies_, prefix, "body");
    refuse_taken_names(joints_, other.joints_, prefix, "joint");
    refuse_taken_names(loads_, other.loads_, prefix, "load");
    refuse_taken_names(sensors_, other.sensors_, prefix, "sensor");
    refuse_taken_names(points_, other.points_, prefix, "point");

    Model all = *this;   // what fails half-way leaves this one as it was; `other` may be this one
    const AddedParts first{n_bodies(), static_cast<int>(joints_.size()), static_cast<int>(loads_.size()),
                           static_cast<int>(sensors_.size()), static_cast<int>(points_.size())};
    const Relocation to{
        prefix, {by.position, project_directors(by.rotation)}, first.body, first.load, [&](int j) {
            return j + first.joint;
        }};
    // each of these kinds refers to parts of those before it
    for (const Body& body : other.bodies_) all.add_body(relocated(body, to));
    for (const NamedPoint& point : other.points_) all.add_point(relocated(point, to));
    for (const Joint& joint : other.joints_) all.add_joint(relocated(joint, to));
    for (const Load& load : other.loads_) all.add_load(relocated(load, to));
    for (const Sensor& sensor : other.sensors_) all.add_sensor(relocated(sensor, to));
    for (const Event& event : other.events_) all.add_event(relocated(event, to));
    for (const Sampling& sampling : other.samplings_) all.add_sampling(relocated(sampling, to));
    bind_reaction_laws(all);
    *this = std::move(all);
    return first;
}

}   // namespace livens
