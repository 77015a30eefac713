// SPDX-License-Identifier: BSD-3-Clause
// [[include]]: what is included is read as if it stood alone, with its own names and coordinates. A part that
// was read joins the model around it by what Model::add() is made of, stage by stage, because drives and
// loads begin where the start has led the bodies of the whole.
#include "livens/io/scenario/assembly.h"

#include <algorithm>

#include "livens/base/error.h"
#include "livens/io/scenario/bodies/bodies.h"
#include "livens/io/scenario/bodies/named_points.h"
#include "livens/io/scenario/controllers/controllers.h"
#include "livens/io/scenario/events/events.h"
#include "livens/io/scenario/joints/joints.h"
#include "livens/io/scenario/loads/load_kinds.h"
#include "livens/io/scenario/run/run.h"

namespace livens::inline io_internal {

/// One error for a part whose names collide with others, and nothing more of it.
void Assembly::refuse(Assembly& part, const InputError& error)
{
    const Complaint& c = error.complaint();
    const std::size_t open = c.path.find('['), close = c.path.rfind(']');
    const bool has_name = open != std::string::npos && close != std::string::npos && open < close;
    const std::string what =
        has_name ? c.path.substr(0, open) + " '" + c.path.substr(open + 1, close - open - 1) + "'" : c.path;
    const bool is_taken = c.code == "name-duplicate";
    part.is_refused_ = true;
    builder_.excuse("");   // whatever is not found may have been meant to be there
    part.include_->error(part.include_->has("prefix") ? "prefix" : "", c.code,
                         part.top_.label() + " brings " + what +
                             (is_taken ? ", which exists already" : ": " + c.message),
                         {is_taken ? "names of what is included begin with its prefix" : c.note,
                          is_taken ? "give it another 'prefix'" : c.help});
}

/// Reads what is included and takes what it has then, all but what was refused.
template <class Read, class Take>
void Assembly::each_part(const Read& read, const Take& take)
{
    for (const std::unique_ptr<Assembly>& part : parts_) {
        if (part->is_refused_) continue;
        const int before = sources_.findings.n_errors();
        read(*part);
        if (sources_.findings.n_errors() > before) builder_.excuse(part->to_.prefix);
        try {
            take(*part);
        } catch (const InputError& error) {
            refuse(*part, error);
        }
    }
}

/// Surfaces of bodies cost a quadrature, and are wanted where a load of this file or of one around it may
/// name one. Files below cannot name bodies of this one.
void Assembly::read_all_bodies(bool with_surfaces)
{
    with_surfaces = with_surfaces || has_surface_loads(top_);
    sources_.meshes.enter(folder_);
    read_bodies(builder_, with_surfaces);
    each_part([&](Assembly& part) { part.read_all_bodies(with_surfaces); },
              [&](Assembly& part) { take_bodies(part); });
    // Parts have entered their own folders.
    sources_.meshes.enter(folder_);
    read_world(builder_);
    for (const std::unique_ptr<Assembly>& part : parts_)
        for (Outline visual : part->builder_.outlines().back().visuals) {
            visual.place = part->to_.by.of_point(visual.place);
            visual.axes = part->to_.by.rotation * visual.axes;
            builder_.outlines().back().visuals.push_back(std::move(visual));
        }
}

void Assembly::take_bodies(Assembly& part)
{
    Builder& own = part.builder_;
    for (const auto& [name, body] : own.bodies())
        if (builder_.bodies().count(part.to_.name(name)) > 0)
            throw InputError({"name-duplicate", "body[" + part.to_.name(name) + "]", "", "", "", "", ""});
    part.to_.first_body = builder_.model().n_bodies();
    for (const Body& body : own.model().bodies()) builder_.model().add_body(relocated(body, part.to_));
    for (const auto& [name, body] : own.bodies())
        builder_.bodies()[part.to_.name(name)] = {part.to_.body(body.index), body.is_usable};
    // As many as there are bodies: the outline of the part's world, which stands behind them, is taken by
    // read_all_bodies().
    const auto join = [](auto& all, const auto& more, std::size_t n) {
        all.insert(all.end(), more.begin(), more.begin() + static_cast<std::ptrdiff_t>(n));
    };
    const std::size_t n = own.model().bodies().size();
    join(builder_.outlines(), own.outlines(), n);
    join(builder_.parts(), own.parts(), n);
    join(builder_.surfaces(), own.surfaces(), n);
}

void Assembly::set_length(double length)
{
    builder_.set_length(length);
    for (const std::unique_ptr<Assembly>& part : parts_) part->set_length(length);
}

void Assembly::read_all_points()
{
    each_part([](Assembly& part) { part.read_all_points(); },
              [&](Assembly& part) {
                  for (const NamedPoint& point : part.builder_.model().points())
                      builder_.model().add_point(relocated(point, part.to_));
              });
    read_points(builder_);
    tell_points(builder_);
}

void Assembly::read_all_joints()
{
    each_part([](Assembly& part) { part.read_all_joints(); },
              [&](Assembly& part) {
                  part.first_joint_ = static_cast<int>(builder_.model().joints().size());
                  for (const Joint& joint : part.builder_.model().joints())
                      builder_.model().add_joint(relocated(joint, part.to_));
              });
    read_joints(builder_);
}

/// What all say of the start, in coordinates of this file.
StatedStart Assembly::all_stated()
{
    StatedStart all = stated_start(builder_);
    for (const std::unique_ptr<Assembly>& part : parts_) {
        StatedStart of_part = part->all_stated();
        // joint[knee].rate of the part is joint[left.knee].rate here, with the prefix "left.".
        for (StartCoordinate& rate : of_part.rates) {
            rate.joint += part->first_joint_;
            rate.path.insert(rate.path.find('[') + 1, part->to_.prefix);
            all.rates.push_back(std::move(rate));
        }
        for (StatedVelocity& one : of_part.velocities) {
            one.body = part->to_.body(one.body);
            all.velocities.push_back(one);
        }
        for (std::size_t b = 0; of_part.is_other && b < of_part.state.X.size(); ++b) {
            const std::size_t at = static_cast<std::size_t>(part->to_.first_body) + b;
            // V are rates of the columns of X, which turn with the part and do not shift.
            all.state.X[at] = part->to_.by.of_configuration(of_part.state.X[b]);
            all.state.V[at] = part->to_.by.rotation * of_part.state.V[b];
        }
        all.is_other = all.is_other || of_part.is_other;
    }
    return all;
}

/// What is included stands where the start has led it, for what is read next.
void Assembly::settle()
{
    for (const std::unique_ptr<Assembly>& part : parts_) {
        const Displacement back = part->to_.by.inverse();
        Model& own = part->builder_.model();
        Model there(own.gravity());
        for (int b = 0; b < own.n_bodies(); ++b) {
            Body body = own.bodies()[static_cast<std::size_t>(b)];
            const Body& in_whole = builder_.model().bodies()[static_cast<std::size_t>(part->to_.body(b))];
            body.X = back.of_configuration(in_whole.X);
            body.V = back.rotation * in_whole.V;
            there.add_body(std::move(body));
        }
        for (std::size_t j = 0; j < own.joints().size(); ++j) {
            Joint joint = own.joints()[j];
            const Joint& in_whole =
                builder_.model().joints()[static_cast<std::size_t>(part->first_joint_) + j];
            for (std::size_t q = 0; q < joint.coordinates.size(); ++q)
                // What coordinates are said to be where the bodies are by then: only the whole was led there.
                joint.coordinates[q].at_stated = in_whole.coordinates[q].at_stated;
            for (std::size_t q = 0; q < joint.readings.size(); ++q)
                joint.readings[q].at_stated = in_whole.readings[q].at_stated;
            there.add_joint(std::move(joint));
        }
        for (const NamedPoint& point : own.points()) there.add_point(point);
        own = std::move(there);
        part->settle();
    }
}

void Assembly::read_all_drives()
{
    std::size_t n_joints = 0;   // of the part, that are there already
    each_part(
        [&](Assembly& part) {
            n_joints = part.builder_.model().joints().size();
            part.read_all_drives();
        },
        [&](Assembly& part) {
            const std::vector<Joint>& all = part.builder_.model().joints();
            for (std::size_t j = n_joints; j < all.size(); ++j)
                builder_.model().add_joint(relocated(all[j], part.to_));
            part.to_.joint = [&part, this](int j) {   // drives and stops stand behind all joints
                return builder_.model().find_joint(part.to_.name(part.builder_.model().joints()[j].name));
            };
        });
    read_drives(builder_);
    read_stops(builder_);
}

void Assembly::read_all_sensors(bool of_loads)
{
    std::size_t n_sensors = 0;
    each_part(
        [&](Assembly& part) {
            n_sensors = part.builder_.model().sensors().size();
            part.read_all_sensors(of_loads);
        },
        [&](Assembly& part) {
            const std::vector<Sensor>& all = part.builder_.model().sensors();
            for (std::size_t s = n_sensors; s < all.size(); ++s)
                builder_.model().add_sensor(relocated(all[s], part.to_));
        });
    read_sensors(builder_, of_loads);
    if (of_loads && sources_.findings.n_errors() == 0) add_controller_sensors(builder_);
}

/// Bodies that hold states come behind all others, of the part as of the whole: its bodies are two runs of
/// numbers, which Relocation::body() tells apart by `n_early`.
void Assembly::read_all_controllers()
{
    each_part(
        [](Assembly& part) {
            part.to_.n_early = part.builder_.model().n_bodies();
            part.read_all_controllers();
        },
        [&](Assembly& part) {
            const std::vector<Body>& all = part.builder_.model().bodies();
            part.to_.first_late = builder_.model().n_bodies();
            for (auto b = static_cast<std::size_t>(part.to_.n_early); b < all.size(); ++b)
                builder_.model().add_body(relocated(all[b], part.to_));
            take_controllers(part.builder_, part.to_, builder_);
        });
    read_controllers(builder_);
}

void Assembly::read_all_loads()
{
    each_part([](Assembly& part) { part.read_all_loads(); },
              [&](Assembly& part) {
                  part.to_.first_load = static_cast<int>(builder_.model().loads().size());
                  for (const Load& load : part.builder_.model().loads())
                      builder_.model().add_load(relocated(load, part.to_));
                  for (const Sampling& sampling : part.builder_.model().samplings())
                      builder_.model().add_sampling(relocated(sampling, part.to_));
              });
    read_loads(builder_);
    read_changes(builder_);
}

void Assembly::read_all_events(bool is_run)
{
    each_part([](Assembly& part) { part.read_all_events(false); },
              [&](Assembly& part) {
                  for (const Event& event : part.builder_.model().events())
                      builder_.model().add_event(relocated(event, part.to_));
              });
    read_events(builder_, is_run);
}

bool Assembly::check_count(std::size_t n, const std::string& what) const
{
    return n <= max_bodies || sources_.findings.error({}, "resource-limit",
                                                      "there are " + std::to_string(n) + " " + what +
                                                          " with those that are included, more than " +
                                                          std::to_string(max_bodies));
}

void Assembly::read_model()
{
    Findings& findings = sources_.findings;
    read_all_bodies(false);
    if (!check_count(builder_.model().bodies().size(), "bodies")) return;
    if (builder_.model().n_bodies() == 0 && findings.n_errors() == 0)
        top_.error("include", "no-bodies",
                   "a scenario needs at least one body, its own or one that is included");
    set_length(builder_.model().n_bodies() > 0 ? builder_.model().length() : 0);
    read_all_points();
    read_all_joints();
    if (findings.n_errors() == 0) {
        // A model that nothing has changed keeps its version, and parts then stand where they are stated.
        const std::uint64_t stated = builder_.model().version();
        move_bodies(builder_, all_stated());
        if (builder_.model().version() != stated) settle();
    }
    if (!check_count(builder_.model().joints().size(), "joints")) return;
    read_all_drives();
    read_all_sensors(false);
    read_all_controllers();
    read_all_loads();
    bind_loads(builder_);
    read_all_sensors(true);
    read_all_events(true);
    complete_looks();
    check_count(builder_.model().loads().size(), "loads");
}

/// What holds states of controllers is not to be seen; the world stands last.
void Assembly::complete_looks()
{
    const auto n = static_cast<std::size_t>(builder_.model().n_bodies());
    std::vector<Outline>& outlines = builder_.outlines();
    while (!outlines.empty() && outlines.size() < n + 1) outlines.insert(outlines.end() - 1, Outline{});
    if (!builder_.parts().empty()) builder_.parts().resize(std::max(builder_.parts().size(), n));
}

bool Assembly::states_velocity() const
{
    return io_internal::states_velocity(builder_) ||
           std::ranges::any_of(parts_, [](const auto& part) { return part->states_velocity(); });
}

void Assembly::read_ends(bool is_given, State& end)
{
    read_body_ends(builder_, is_given, end);
    for (const std::unique_ptr<Assembly>& part : parts_) {
        const std::size_t n = part->builder_.model().bodies().size();
        State own{0, std::vector<Matrix34>(n), std::vector<Matrix34>(n)};
        part->read_ends(is_given, own);
        for (std::size_t b = 0; is_given && !part->is_refused_ && b < n; ++b) {
            const auto at = static_cast<std::size_t>(part->to_.body(static_cast<int>(b)));
            end.X[at] = part->to_.by.of_configuration(own.X[b]);
            end.V[at] = part->to_.by.rotation * own.V[b];
        }
    }
}

void Assembly::remember_places()
{
    for (const std::unique_ptr<Assembly>& part : parts_) {
        part->remember_places();
        builder_.remember(part->builder_, part->to_.prefix);
    }
}

}   // namespace livens::inline io_internal
