// SPDX-License-Identifier: BSD-3-Clause
// [start], [end] and [body.end]: what is known at the ends of time.
// Hamilton's law of theory.md, The law, holds with positions or momenta stated once each, at either end.
// Which ones are stated says `given`; the values stand at the bodies.
#include <algorithm>

#include "livens/base/text.h"
#include "livens/dynamics/start/prepared.h"
#include "livens/dynamics/start/singular.h"
#include "livens/io/scenario/bodies/bodies.h"
#include "livens/io/scenario/joints/joints.h"
#include "livens/io/scenario/run/run.h"

namespace livens::inline io_internal {

namespace {

Key given(std::string_view otherwise, const std::string& doc)
{
    Key key = choice<Known>("given", doc);
    key.fallback = otherwise;
    return key;
}

bool check_pose_of(const Section& pose, bool is_point)
{
    if (!pose.is_valid() || !check_pose(pose)) return false;
    return !is_point || pose.refuse({"directors", "quaternion", "rotation_vector", "angular_velocity",
                                     "angular_velocity_body"},
                                    "point-mass", "a point mass has no orientation");
}

/// The core knows one state of a body: what it says of `body[a].directors` is meant for `when`.
InputError at_the(const std::string& when, const InputError& error)
{
    Complaint complaint = error.complaint();
    const std::size_t close = complaint.path.find(']');
    if (complaint.path.starts_with("body[") && close != std::string::npos)
        complaint.path.insert(close + 1, "." + when);
    const std::string start = "at the start", there = "at the " + when + " of time";
    const std::size_t at = complaint.message.find(start);
    if (at != std::string::npos)
        complaint.message.replace(at, start.size(), there);
    else
        complaint.message += ", " + there;
    return InputError(std::move(complaint));
}

/// What it says of the end of time: of joints that are open there it is the end of a body that is wrong.
InputError at_the_end(const Model& model, const InputError& error)
{
    Complaint complaint = at_the("end", error).complaint();
    const bool is_place = complaint.code == "start-position";
    if (!is_place && complaint.code != "start-velocity") return InputError(std::move(complaint));
    complaint.code = is_place ? "end-position" : "end-velocity";
    for (const Joint& joint : model.joints())
        if (complaint.path.starts_with("joint[" + joint.name + "]"))
            complaint.path = "body[" + model.body_name(joint.second) + "].end";
    complaint.help =
        is_place ? "give positions there that the joints allow, or let them be projected onto the joints"
                 : "give velocities that fit, or let them be projected onto the joints";
    return InputError(std::move(complaint));
}

/// The orthonormal triad of directors that are those of the start, turned.
Matrix3 straightened(const Matrix3& directors, const Matrix3& stretch, const std::string& name)
{
    const Matrix3 triad = directors * inverse(stretch);
    // Rigidity keeps lengths and angles of directors, so that an end with others could never be reached.
    if (skewness(triad) > 1e-10)
        throw InputError({"directors-metric", "body[" + name + "].directors",
                          "skew directors must keep their lengths and angles",
                          "they differ by " + to_text(skewness(triad), 3) + ", relative to those given first",
                          "<= 1e-10", "a rigid body turns, no more", "a quaternion says by how much"});
    return triad;
}

/// What a pose leaves out is as it is in the state.
Placement completed(Placement given, const Section& pose, const Matrix34& X, const Matrix34& V)
{
    if (!pose.has("position")) given.position = X.column(0);
    if (!pose.has("velocity")) given.velocity = V.column(0);
    if (!pose.has("directors") && !pose.has("quaternion") && !pose.has("rotation_vector"))
        given.directors = directors(X);
    if (pose.has("angular_velocity_body"))
        given.angular_velocity = given.directors * pose.vector("angular_velocity_body");
    else if (!pose.has("angular_velocity"))
        given.angular_velocity = angular_velocity(X, V);
    return given;
}

}   // namespace

void read_pose_of(Builder& builder, const std::string& name, const Section& pose, const std::string& when,
                  State& state)
{
    const int index = builder.bodies()[name].index;
    const Matrix3& stretch = builder.stretch(index);
    const bool is_point = builder.is_point(index);
    if (!check_pose_of(pose, is_point)) return;
    const std::string path = "body[" + name + "]." + when;
    builder.remember(path, pose);
    builder.guard(path, [&] {
        try {
            Matrix34 &X = state.X[static_cast<std::size_t>(index)],
                     &V = state.V[static_cast<std::size_t>(index)];
            Placement placement = read_placement(pose, stretch);
            if (!(stretch == identity<3>()))
                placement.directors = straightened(placement.directors, stretch, name);
            if (when == "start") placement = completed(placement, pose, X, V);
            // Masses do not matter here, so any that are possible will do.
            const Body body = is_point ? point_mass(name, 1, placement.position, placement.velocity)
                                       : rigid_body(name, {1, {}, identity<3>()}, placement);
            X = body.X;
            V = body.V;
        } catch (const InputError& error) {
            throw at_the(when, error);
        }
    });
}

Table start_table()
{
    return {
        "[start]",
        "Which quantities are prescribed at the initial time, and how to treat initial values that violate "
        "the joints. Quantities that are not prescribed serve as a first guess. Positions in `[[body]]` are "
        "needed in any case, since joints placed by `at` refer to them.",
        {given("state", "state: positions and velocities; positions, or momenta: only these; nothing: "
                        "neither. The rest is a first guess."),
         choice<StartPolicy>(
             "initial",
             "Treatment of initial values that violate a joint. check: an error that names "
             "the joint; project: positions and velocities are moved to the nearest "
             "admissible ones, where distances are weighted by mass (the mass metric). Default: check; "
             "velocities alone are projected, with a warning, if the scenario gives none "
             "and a drive moves at the initial time."),
         choice("joints", {"fixed", "fit"},
                "Treatment of rounded joint dimensions. fixed: joints are used as given; fit: points and "
                "axes on the second body of a joint are moved by the least amount that closes it where the "
                "bodies are placed, at most 1e-6 of the model length; each change is reported."),
         Key{"coordinates", types::tables,
             "Initial values and rates of joint coordinates. The bodies are moved there along the joints. "
             "Independent coordinates that are not listed keep the values that follow from `[[body]]`; "
             "anything that no coordinate determines moves as little as possible, in the mass metric."}
             .holding({"[[start.coordinates]]",
                       "Initial value and rate of one joint coordinate.",
                       {Key{"joint", types::text, "Name of the joint."}.needed(), coordinate_key(),
                        Key{"value", types::number,
                            "Value, as the joint counts it. Default: the value that follows from `[[body]]`.",
                            "rad"}
                            .or_in("m"),
                        Key{"rate", types::number,
                            "Rate. Default: the rate that follows from the bodies' velocities.", "rad/s"}
                            .or_in("m/s")}}),
         known_key("start")}};
}

Table end_table()
{
    return {"[end]",
            "Which quantities are prescribed at the final time, by `[body.end]` of every body. `[start]` and "
            "`[end]` together must prescribe two of these four: positions and momenta at the start, "
            "positions and momenta at the end. With the state at the end alone, livens finds where the "
            "motion came from; with positions at both ends, how to get from one to the other. Conditions at "
            "the end need the family lobatto or mixed.",
            {given("nothing", "As in `[start]`, for the values in `[body.end]`."), known_key("end")}};
}

namespace {

void read_periodic(Builder& builder, const Section& time, Conditions& boundary)
{
    builder.remember("time.periodic", time.place("periodic"));
    const Section* const turned = only_section(time, "periodic");
    boundary.is_periodic = turned != nullptr || (time.has("periodic") && time.truth("periodic"));
    if (turned == nullptr) return;
    boundary.turn = AxisTurn{turned->number("turn"), turned->vector("axis"), turned->vector("at")};
}

}   // namespace

void read_boundary(Builder& builder, Conditions& boundary)
{
    const Section* const start = only_section(builder.run(), "start");
    const Section* const end = only_section(builder.run(), "end");
    const Section* const time = only_section(builder.run(), "time");
    if (time != nullptr) read_periodic(builder, *time, boundary);
    boundary.at_start = start != nullptr ? start->pick<Known>("given") : Known::state;
    boundary.at_end = end != nullptr ? end->pick<Known>("given") : Known::nothing;
    if (start != nullptr) read_known(builder, *start, Condition::At::start, boundary);
    if (end != nullptr) read_known(builder, *end, Condition::At::end, boundary);
    const bool has_components = boundary.is_periodic || (start != nullptr && start->has("known")) ||
                                (end != nullptr && end->has("known"));
    // the state at the start is known unless something else is said to be
    if (has_components && (start == nullptr || !start->has("given"))) boundary.at_start = Known::nothing;
    if (boundary.at_end == Known::nothing) return;
    boundary.end.X.resize(builder.model().bodies().size());
    boundary.end.V.resize(builder.model().bodies().size());
}

void read_body_ends(Builder& builder, bool is_given, State& end)
{
    for (const Section& body : builder.top().sections("body")) {
        if (!is_given) {
            body.refuse({"end"}, "boundary-conditions", "[end] does not say that anything is given there");
            continue;
        }
        if (!body.has("end")) {
            body.error("", "missing-key", body.label() + " lacks 'end'",
                       {"[end] says that something is given at the end of time, which then concerns every "
                        "body",
                        "add a table [body.end] below it"});
            continue;
        }
        const Value* name = body.find("name");
        if (name == nullptr || !builder.bodies()[name->text].is_usable) continue;   // told already
        for (const Section& at_end : body.sections("end"))
            read_pose_of(builder, name->text, at_end, "end", end);
    }
}

namespace {

/// Joints that have let go by then, or begin later, need not be closed at this end.
Model acting_then(const Model& model, const State& state)
{
    return model.has_events() ? acting_at(model, state.t).model : model;
}

/// Nobody stands beyond a limit: its spring would throw the joint back.
void refuse_beyond_limits(const Model& model, const State& state)
{
    constexpr double slack = 1e-9;   // m or rad, for limits that are where the joint stands
    for (const Load& load : model.loads()) {
        const auto beyond = std::ranges::find(load.readings, "penetration", &LoadReading::name);
        if (beyond == load.readings.end()) continue;
        const double d = beyond->value(load_arguments(load, {state.t, Side::right}, state.X, state.V));
        if (d > slack)
            throw InputError({"joint-limits", "load[" + load.name + "].limits",
                              "'" + load.name + "' begins beyond its limits",
                              "by " + to_text(d, 4) + " " + beyond->unit, "", "",
                              "place its bodies between them, or state by 'coordinate' what is meant"});
    }
}

}   // namespace

void start_as_driven(Builder& builder, Scenario& scenario)
{
    const Section* const start = only_section(builder.run(), "start");
    if (!builder.model().has_drives() || scenario.conditions.at_start != Known::state) return;
    if (start != nullptr && start->has("initial")) return;
    const State& at_rest = scenario.conditions.start;
    const Model model = acting_then(builder.model(), at_rest);
    const TriedStart tried = scenario.prepared->try_close(model, at_rest, StartPolicy::check);
    if (tried.closed || tried.why.code != "start-velocity") return;
    scenario.options.initial = StartPolicy::project;
    if (!scenario.prepared->try_close(model, at_rest, StartPolicy::project).closed) return;
    const std::string name = tried.why.path.substr(tried.why.path.find('['));   // "[motor]"
    builder.findings().warning(
        builder.find_place(tried.why.path, ""), "start-driven",
        "no initial velocities are given, and the drive '" + name.substr(1, name.size() - 2) +
            "' is moving at the start: the bodies start with velocities that fit it",
        {"of all that fit, those of least kinetic energy, as initial = \"project\" in [start] takes them",
         "write initial = \"project\", or give velocities (\"rate\" of a joint moves all that hangs on it)"});
}

void check_ends(Builder& builder, const Conditions& boundary, StartPolicy policy, Prepared& prepared)
{
    const auto close = [&](State state, Known given) {
        if (given == Known::nothing) return;
        // Velocities that are not stated are guesses of Newton's iteration, which joints must not refuse.
        if (given == Known::positions)
            for (Matrix34& V : state.V) V = {};   // a guess, which need not fit
        const Model model = acting_then(builder.model(), state);
        const ConsistentStart closed = prepared.close(model, state, policy);
        // A state at a singular position is judged besides (theory.md, Singular positions).
        if (given == Known::state) refuse_singular_start(model, closed);
        refuse_beyond_limits(model, closed.start);
    };
    builder.guard("start", [&] { close(boundary.start, boundary.at_start); });
    builder.guard("end", [&] {
        try {
            close(boundary.end, boundary.at_end);
        } catch (const InputError& error) {
            throw at_the_end(builder.model(), error);
        }
    });
}

}   // namespace livens::inline io_internal
