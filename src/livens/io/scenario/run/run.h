// SPDX-License-Identifier: BSD-3-Clause
// [time], [method], [start], [end]: everything of the scenario but the model.
#pragma once

#include <string>

#include "livens/dynamics/start/start_coordinates.h"
#include "livens/io/scenario/builder.h"
#include "livens/spacetime/problem.h"

namespace livens {
class JsonWriter;
}   // namespace livens

namespace livens::inline io_internal {

/// X and V of a body at the "start" or "end" of time; at the start what is left out is as in `state`.
void read_pose_of(Builder& builder, const std::string& name, const Section& pose, const std::string& when,
                  State& state);

/// What bodies and joints say of the start.
struct StatedStart {
    std::vector<StartCoordinate> rates;         ///< of joints
    State state;                                ///< bodies where [body.start] has them
    bool is_other = false;                      ///< it has some
    std::vector<StatedVelocity> velocities{};   ///< of bodies, be they zero
};
/// Where nothing was wrong so far.
StatedStart stated_start(Builder& builder);
/// Whether this file gives a velocity at the start to a body or a joint, be it zero.
bool states_velocity(const Builder& builder);
/// Leads the bodies there, and to what [start] says of coordinates: after the joints, before all others.
void move_bodies(Builder& builder, const StatedStart& stated);
/// What is given at both ends, but for the state at the end. The state at the start is the model's.
void read_boundary(Builder& builder, Conditions& boundary);
/// [start.known] and [end.known]: numbers by the names of quantities.
Key known_key(const std::string& where);
/// Conditions by component that a table states.
void read_known(Builder& builder, const Section& table, Condition::At at, Conditions& boundary);
/// Bodies at the end of time, of which something is given or not.
void read_body_ends(Builder& builder, bool is_given, State& end);
/// Lets a start without any velocity be projected, with a warning, where drives ask for some and nothing else
/// is wrong with it; [start] may say otherwise.
void start_as_driven(Builder& builder, Scenario& scenario);
/// Closes the mechanism where something is given, as solve() will.
void check_ends(Builder& builder, const Conditions& boundary, StartPolicy policy, Prepared& prepared);
Method read_method(const Section* section, Findings& findings);
void write_method(JsonWriter& json, const Method& method);
/// The keys of [method] that are options, as far as the file has them.
void read_options(const Section& section, SolveOptions& options);
void write_options(JsonWriter& json, const SolveOptions& options);
/// Time, method, conditions: everything of the scenario but the model.
void read_run(Builder& builder, Scenario& scenario);
/// The same as JSON, with all defaults filled in.
std::string resolved_run(const Builder& builder, const Scenario& scenario);

/// Elements and output times. False after an error.
bool read_time(Builder& builder, const Section& time, const Section* method, Scenario& scenario);
/// Whether elements are to be found: an accuracy is stated, or no elements are.
bool follows_accuracy(const Section& time, const Method& method);

/// Knots make the mesh.
bool has_knots(const Method& method);

/// What motion and equations will take at least; a scenario of a few lines must not fill the memory of a
/// machine. The motion has at most 8 GiB, the factors of one block's matrix (mixed) too: 150 entries of
/// 16 bytes for each of 30 unknowns a rigid body and node (6 a point mass, 1 a row). That leaves 100,000
/// linear elements of a single body. False after an error at `place`.
bool check_size(const Model& model, const Method& method, double n_elements, const SourceLocation& place,
                Findings& findings);

}   // namespace livens::inline io_internal
