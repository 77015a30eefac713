// SPDX-License-Identifier: BSD-3-Clause
// livens equilibrium: where a mechanism rests.
#include "livens/statics/equilibrium.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <unistd.h>

#include "commands.h"
#include "console.h"
#include "failure.h"
#include "interrupt.h"
#include "livens/base/elementary.h"
#include "livens/io/known_state.h"
#include "livens/multibody/controllers.h"
#include "livens/multibody/motion.h"
#include "rest.h"
#include "summary.h"

namespace livens::program {

namespace {

/// The rotation vector of the turn between two triads, at most pi long.
Vector3 turn_between(const Matrix34& from, const Matrix34& to)
{
    const Vector4 q = quaternion_from_directors(directors(to) * transpose(directors(from)));
    const Vector3 v{q[1], q[2], q[3]};
    const double sine = norm(v);
    return sine > 0 ? (2 * arc_tangent(sine, q[0]) / sine) * v : Vector3{};
}

struct Found {
    const Scenario& scenario;
    const Equilibrium& at;
    Model now;   ///< without drives
    int exit_code;

    const Model& model() const { return scenario.model; }
    Vector3 turn(int b) const   // from where the scenario has the body
    {
        return model().bodies()[b].is_point ? Vector3{} : turn_between(model().bodies()[b].X, at.state.X[b]);
    }
    bool is_stop(int j) const
    {
        const Joint& joint = model().joints()[static_cast<std::size_t>(j)];
        return joint.impact && joint.impact->open_side != 0;
    }
    bool is_closed(int j) const { return std::ranges::find(at.closed_stops, j) != at.closed_stops.end(); }
    Reaction reaction(int j) const { return joint_reaction(now, j, at.state.X, at.multipliers); }
};

void add_bodies(JsonWriter& json, const Found& found)
{
    json.key("bodies").begin_array();
    for (int b = 0; b < found.model().n_bodies(); ++b) {
        if (found.model().bodies()[b].holds_states()) continue;
        const Matrix34& X = found.at.state.X[b];
        json.begin_object().member("name", found.model().body_name(b));
        json.key("position").value(numbers(X.column(0)));
        if (!found.model().bodies()[b].is_point) {
            json.key("quaternion").value(numbers(quaternion_from_directors(directors(X))));
            json.key("rotation_vector").value(numbers(found.turn(b)));
        }
        json.end_object();
    }
    json.end_array();
    json.key("states").begin_object();
    for (const NamedState& state : states_in(found.model(), found.at.state.V))
        json.member(state.name, state.value);
    json.end_object();
}

void add_joints(JsonWriter& json, const Found& found)
{
    json.key("joints").begin_array();
    for (int j = 0; j < static_cast<int>(found.model().joints().size()); ++j) {
        const Joint& joint = found.model().joints()[j];
        const Reaction reaction = found.reaction(j);
        json.begin_object().member("name", joint.name);
        for (std::size_t k = 0; k < joint.coordinates.size(); ++k)
            json.member(joint.coordinates[k].name, found.at.coordinates[j][k]);
        json.key("force").value(numbers(reaction.force));
        json.key("torque").value(numbers(reaction.torque));
        if (found.is_stop(j)) json.member("closed", found.is_closed(j));
        json.member("unique", static_cast<bool>(found.at.joint_is_unique[j]));
        json.member("shared", in_words(found.at.shared[j])).end_object();
    }
    json.end_array();
}

std::string json_of(const Found& found, const std::vector<Diagnostic>& warnings)
{
    const Equilibrium& at = found.at;
    JsonWriter json(2);
    json.begin_object();
    json.member("converged", at.is_found);
    json.member("status", at.is_found ? to_string(at.stability.stability) : "no equilibrium");
    json.member("exit_code", found.exit_code).member("message", at.message);
    json.member("title", found.scenario.title).member("t", at.state.t);
    json.member("degrees_of_freedom", at.degrees_of_freedom).member("iterations", at.iterations);
    json.member("residual", at.residual);
    for (const auto& [key, n] : {std::pair{"unstable_directions", at.stability.n_unstable},
                                 {"neutral_directions", at.stability.n_neutral}})
        at.is_found ? json.member(key, n) : json.key(key).null();
    add_bodies(json, found);
    add_joints(json, found);
    json.key("notes").begin_array();
    for (const std::string& note : at.notes) json.value(note);
    json.end_array();
    json.key("warnings");
    write_diagnostics(json, warnings);
    json.key("errors").begin_array().end_array().end_object();
    return json.text() + "\n";
}

std::string words_of_body(const Found& found, int b)
{
    const double length = found.model().length();
    std::string text = "at " + shown(found.at.state.X[b].column(0), length) + " m";
    if (!found.model().bodies()[b].is_point) text += ", turned by " + shown(found.turn(b), 1) + " rad";
    return text;
}

std::string words_of_joint(const Found& found, int j)
{
    const Joint& joint = found.model().joints()[j];
    std::string text;
    for (std::size_t k = 0; k < joint.coordinates.size(); ++k) {
        const bool is_angle = joint.coordinates[k].coordinate.is_angle();
        text += fmt::format("{} {} {}, ", joint.coordinates[k].name,
                            shown(found.at.coordinates[j][k], is_angle ? 1 : found.model().length()),
                            is_angle ? "rad" : "m");
    }
    if (found.is_stop(j)) {
        if (!found.is_closed(j)) return "open";
        text = "closed, ";
    }
    const Reaction reaction = found.reaction(j);
    const double force = norm(reaction.force), torque = norm(reaction.torque),
                 size = std::max(force, torque / found.model().length());
    return text + "force " + shown(reaction.force, size) + " N, torque " +
           shown(reaction.torque, size * found.model().length()) + " N m" +
           (found.at.joint_is_unique[j] ? "" : " (not unique: " + in_words(found.at.shared[j]) + ")");
}

std::string text_of(const Found& found, const std::string& file)
{
    const Equilibrium& at = found.at;
    Summary summary(terminal_of(STDOUT_FILENO));
    if (at.is_found)
        add_stability(summary, at.stability, at.degrees_of_freedom);
    else
        summary.headline(Ink::bad, "No equilibrium", plain(at.message));
    summary.figure("title", plain(found.scenario.title));
    summary.figure("search", fmt::format("{} iterations, {} degree{} of freedom", at.iterations,
                                         at.degrees_of_freedom, at.degrees_of_freedom == 1 ? "" : "s"));
    const bool is_rounding = at.residual <= 1e-14;
    summary.figure("residual",
                   is_rounding ? "rounding" : fmt::format("{:.1e} of the largest forces", at.residual));
    for (int b = 0; b < found.model().n_bodies(); ++b)
        if (!found.model().bodies()[b].holds_states())
            summary.figure(plain(found.model().body_name(b)), words_of_body(found, b));
    for (const NamedState& state : states_in(found.model(), at.state.V))
        summary.figure(plain(state.name),
                       fmt::format("{:.9g}", std::abs(state.value) <= 1e-14 * state.size ? 0 : state.value));
    for (int j = 0; at.is_found && j < static_cast<int>(found.model().joints().size()); ++j)
        summary.figure(plain(found.model().joints()[j].name), words_of_joint(found, j));
    for (const std::string& note : at.notes) summary.figure("note", plain(note));
    if (at.is_found && at.stability.stability == Stability::unstable && at.iterations == 0)
        summary.aside("the start itself is in equilibrium: start slightly off it to find where it falls");
    if (at.is_found && at.degrees_of_freedom > 0) summary.aside("next: livens modes " + quoted(file));
    return summary.text();
}

}   // namespace

int equilibrium_command(const std::string& file, const Common& common)
{
    std::vector<Diagnostic> warnings;
    const Scenario scenario = as_it_rests(load_scenario(file, common, &warnings));
    const InterruptWatch watch;
    const Equilibrium at = equilibrium_of(scenario);
    const int signal = InterruptWatch::signal();
    const int exit_code = signal != 0 ? exit_signal + signal : at.is_found ? exit_ok : exit_not_converged;
    const Found found{scenario, at, frozen(scenario.model, {at.state.t}), exit_code};
    if (common.json)
        print(json_of(found, warnings));
    else if (!common.quiet)
        print(text_of(found, file));
    return exit_code;
}

}   // namespace livens::program
