// SPDX-License-Identifier: BSD-3-Clause
// Starts that are stated by coordinates of joints: drives lead the mechanism from where it stands to the
// stated values in small steps, so that it stays on its branch. theory.md, "Starting", By coordinates.
#include "livens/dynamics/start/start_coordinates.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/dynamics/rows/projection.h"
#include "livens/dynamics/rows/rank.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/dynamics/start/free_directions.h"
#include "livens/dynamics/start/laws_at_start.h"
#include "livens/dynamics/start/rate_changes.h"
#include "livens/multibody/body.h"
#include "livens/multibody/joints.h"
#include "livens/multibody/joints/drives.h"
#include "livens/solvers/dense.h"
#include "livens/time/time_laws.h"

namespace livens {

namespace {

constexpr double step = 0.1;   // of a coordinate, rad or lengths of the model
constexpr double farthest = 2000 * std::numbers::pi;   // a thousand turns take some 63,000 steps
constexpr int most_halvings = 12;
constexpr double noticed = 1e-9;   // change of a stated velocity, of the largest

/// One coordinate of one joint, and what becomes of it.
struct Led {
    int joint, coordinate;
    bool has_value, has_rate;   // as wanted
    double from, to;            // as the joint counts
    double rate;
    std::string path{};   // where it is wanted
};

const NamedCoordinate& named(const Model& model, const Led& led)
{
    return model.joints()[led.joint].coordinates[led.coordinate];
}

std::string name_of(const Model& model, const Led& led)
{
    return model.joints()[led.joint].name + "." + named(model, led).name;
}

[[noreturn]] void refuse(const Model& model, const Led& led, const std::string& what,
                         const std::string& value, const std::string& help)
{
    throw InputError({"start-coordinate", led.path, "coordinate '" + name_of(model, led) + "' " + what, value,
                      "", "", help});
}

/// All coordinates of the model: those that are wanted first, in their order.
std::vector<Led> all_coordinates(const Model& model, const std::vector<StartCoordinate>& wanted)
{
    std::vector<Led> all;
    const auto find = [&](int joint, int coordinate) {
        return std::ranges::any_of(
            all, [&](const Led& led) { return led.joint == joint && led.coordinate == coordinate; });
    };
    for (const StartCoordinate& w : wanted) {
        const bool is_joint = w.joint >= 0 && w.joint < static_cast<int>(model.joints().size());
        if (!is_joint || w.coordinate < 0 ||
            w.coordinate >= static_cast<int>(model.joints()[w.joint].coordinates.size()))
            throw InputError({"start-coordinate", w.path, "there is no such coordinate",
                              std::to_string(w.joint), "", "", "only some joints have coordinates"});
        const double now = model.joints()[w.joint].coordinates[w.coordinate].at_stated;
        const Led led{w.joint, w.coordinate,          w.value.has_value(), w.rate.has_value(),
                      now,     w.value.value_or(now), w.rate.value_or(0),  w.path};
        if (find(w.joint, w.coordinate)) refuse(model, led, "is given twice", "", "give it once");
        if (!std::isfinite(led.to) || !std::isfinite(led.rate))
            refuse(model, led, "is not finite", "", "give a finite number");
        const double unit = named(model, led).coordinate.is_angle() ? 1 : model.length();
        if (std::abs(led.to - now) > farthest * unit)
            refuse(model, led, "is too far from where the bodies are placed", to_text(led.to - now, 3),
                   "place the bodies nearer to the start, or give by 'coordinate' of the joint what it is "
                   "there");
        all.push_back(led);
    }
    for (const bool is_numbered : {false, true})
        for (int j = 0; j < static_cast<int>(model.joints().size()); ++j)
            for (int k = 0; k < static_cast<int>(model.joints()[j].coordinates.size()); ++k) {
                const NamedCoordinate& one = model.joints()[j].coordinates[k];
                if (one.is_numbered() == is_numbered && !find(j, k))
                    all.push_back({j, k, false, false, one.at_stated, one.at_stated, 0});
            }
    return all;
}

enum class Law { hold, go, turn };

/// The model with a drive for each coordinate, where X are the bodies' places at `from`: it stays there, goes
/// to its value while time goes from 0 to 1, or has its rate.
Model led_model(const Model& model, const std::vector<Led>& all, std::span<const Matrix34> X, Law law)
{
    Model with = model;
    for (const Led& led : all) {
        const double rate = law == Law::hold ? 0 : law == Law::go ? led.to - led.from : led.rate;
        NamedCoordinate counted = named(model, led);
        counted.at_stated = led.from;
        // A line break in front keeps the name apart from those of other joints.
        with.add_joint(driven_coordinate("\n" + name_of(model, led), model.joints()[led.joint], counted,
                                         ramp(led.from, rate, 0), Configurations(X)));
    }
    return with;
}

/// Rows behind all others that hold bodies as they stand; what they hold moves on as it is stated.
std::vector<int> add_held(Model& led, std::span<const Matrix34> X, const std::vector<StatedVelocity>& stated)
{
    std::vector<int> rows;
    for (const StatedVelocity& one : stated) {
        const Matrix34& here = X[static_cast<std::size_t>(one.body)];
        Joint held;
        held.name = "\nheld " + std::to_string(one.body);
        held.type = "held";
        held.second = one.body;
        if (one.of_place) held.rows = coincidence_rows(world, point(here.column(0)), one.body, point({}), 1);
        if (one.of_turn && !led.bodies()[static_cast<std::size_t>(one.body)].is_point) {
            const Joint weld_here = weld("", world, one.body, {}, world_configuration, here);
            held.rows.insert(held.rows.end(), weld_here.rows.begin() + 3, weld_here.rows.end());
        }
        const int first = led.n_rows();
        if (held.rows.empty()) continue;
        led.add_joint(std::move(held));
        for (int r = first; r < led.n_rows(); ++r) rows.push_back(r);
    }
    return rows;
}

/// Rows of a led model that are independent: of the joints, of what is wanted, and of what can be kept.
struct Chosen {
    std::vector<int> rows;
    std::vector<std::size_t> kept;   // of all coordinates
};

/// Throws for a wanted coordinate that joints or those before it hold.
Chosen choose(const Model& model, const std::vector<Led>& all, std::span<const Matrix34> X, double t,
              bool is_wanted(const Led&), const std::vector<StatedVelocity>& stated = {})
{
    Model with = led_model(model, all, X, Law::hold);
    const std::vector<int> held = add_held(with, X, stated);
    const Model led = frozen(with, {t});
    std::vector<int> joints, coordinates(all.size());   // rows; joints that do not act yet hold nothing
    for (int r = 0; r < model.n_rows(); ++r)
        if (model.joints()[model.row_joint(r)].acts_at(t)) joints.push_back(r);
    std::iota(coordinates.begin(), coordinates.end(), model.n_rows());
    Chosen chosen{row_rank(led, X, joints).independent, {}};
    FreeDirections free(led, X, chosen.rows);
    const TwistRows twists = twist_rows(led, X, coordinates);
    // Stated coordinates first, then bodies: the other coordinates only keep what is left.
    for (const bool wanted : {true, false}) {
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (is_wanted(all[i]) != wanted) continue;
            if (free.take(twists.rows[i])) {
                chosen.rows.push_back(coordinates[i]);
                if (!wanted) chosen.kept.push_back(i);
            } else if (wanted)
                refuse(model, all[i],
                       "cannot be given: joints, or the coordinates given before it, determine it", "",
                       "leave it out, or give the independent ones");
        }
        if (!wanted) break;
        const TwistRows of_bodies = twist_rows(led, X, held);
        for (std::size_t i = 0; i < held.size(); ++i)
            if (free.take(of_bodies.rows[i])) chosen.rows.push_back(held[i]);
    }
    return chosen;
}

int freedoms(const Model& model)
{
    int n = 0;
    for (const Body& body : model.bodies())
        if (!body.holds_states()) n += body.is_point ? 3 : 6;
    return n;
}

/// Where the way ended.
struct Way {
    bool is_whole = false;
    double done = 0;   // of one
    std::vector<Matrix34> X;
    std::vector<double> change;   // of each coordinate, turns counted
    int opened = -1;              // the row that stopped it
};

/// From X along the rows, in steps that none of the coordinates takes by half a radian.
Way lead(const Model& led, const std::vector<Led>& all, const Model& model, const std::vector<int>& rows,
         const std::vector<Matrix34>& from)
{
    Way way{false, 0, from, std::vector<double>(all.size(), 0.0), -1};
    double farthest_to_go = 0;
    for (const Led& one : all) {
        const double unit = named(model, one).coordinate.is_angle() ? 1 : model.length();
        farthest_to_go = std::max(farthest_to_go, std::abs(one.to - one.from) / unit);
    }
    const double whole = 1 / std::max(1.0, std::ceil(farthest_to_go / step));
    double length = whole;
    while (way.done < 1) {
        const double next = std::min(1.0, way.done + length);
        const Model there = frozen(led, {next});
        const Closing closing = close_rows(there, way.X, rows, true);
        std::vector<double> change;
        bool is_near = true;
        for (const Led& one : all) {
            const JointCoordinate& q = named(model, one).coordinate;
            change.push_back(coordinate_change(q, way.X, closing.X));
            // A closing that jumps to another branch moves some coordinate far: such a step is halved like an
            // open one.
            is_near = is_near && std::abs(change.back()) < 5 * step * (q.is_angle() ? 1 : model.length());
        }
        if (closing.closed && is_near) {
            way.done = next;
            way.X = closing.X;
            for (std::size_t i = 0; i < change.size(); ++i) way.change[i] += change[i];
            length = std::min(whole, 2 * length);
            continue;
        }
        length /= 2;
        if (length < std::ldexp(whole, -most_halvings)) {
            way.opened = widest_gap(there, closing.X, rows).row;
            return way;
        }
    }
    way.is_whole = true;
    return way;
}

[[noreturn]] void refuse_unreached(const Model& model, const std::vector<Led>& all, const Way& way)
{
    const auto farthest_led =
        std::ranges::max_element(all, {}, [](const Led& led) { return std::abs(led.to - led.from); });
    const double reached = farthest_led->from + way.done * (farthest_led->to - farthest_led->from);
    const bool is_joint = way.opened >= 0 && way.opened < model.n_rows();
    refuse(model, *farthest_led,
           "cannot be brought to " + to_text(farthest_led->to, 6) + ": the mechanism stops at " +
               to_text(reached, 6) +
               (is_joint ? ", where " + model.row_name(way.opened) + " would open" : ""),
           "", "give a value that the joints admit, or place the bodies nearer to it");
}

/// The model with its bodies in another state; joints are data of the bodies, coordinates count on.
Model restated(const Model& model, const State& state, const std::vector<Led>& all)
{
    Model moved(model.gravity());
    for (int b = 0; b < model.n_bodies(); ++b) {
        Body body = model.bodies()[b];
        body.X = state.X[b];
        body.V = state.V[b];
        moved.add_body(std::move(body));
    }
    std::vector<Joint> joints = model.joints();
    for (const Led& led : all) joints[led.joint].coordinates[led.coordinate].at_stated = led.to;
    const std::vector<Matrix34> before = model.start().X;
    for (Joint& joint : joints) {
        for (NamedCoordinate& read : joint.readings)
            read.at_stated += coordinate_change(read.coordinate, before, state.X);
        moved.add_joint(std::move(joint));
    }
    for (const NamedPoint& point : model.points()) moved.add_point(point);
    return moved;
}

/// Rates of the wanted and the kept coordinates; of bodies those of `held`, and the others nearest to V.
std::vector<Matrix34> fitting_rates(const Model& model, const std::vector<Led>& all, const State& state,
                                    const std::vector<StatedVelocity>& held)
{
    const auto is_wanted = [](const Led& led) { return led.has_rate; };
    const Chosen chosen = choose(model, all, state.X, state.t, is_wanted, held);
    Model led = led_model(model, all, state.X, Law::turn);
    const std::vector<int> rows = add_held(led, state.X, held);
    const Model now = frozen(led, {0});
    std::vector<double> drives = drive_rates(led, {0}, state.X);
    drives.resize(static_cast<std::size_t>(led.n_rows()), 0.0);
    const std::vector<double> stated = joint_rates(now, state.X, state.V);
    for (const int r : rows) drives[r] = -stated[r];
    return nearest_rates(now, state.X, state.V, chosen.rows, drives);
}

void settle_rates(const Model& model, const std::vector<Led>& all, const std::vector<StatedVelocity>& stated,
                  State& state, MovedStart& moved)
{
    std::vector<StatedVelocity> said = stated;
    for (int b = 0; b < model.n_bodies(); ++b)
        if (norm(state.V[b]) > 0 && std::ranges::find(said, b, &StatedVelocity::body) == said.end())
            said.push_back({b});
    const auto changed_bodies = [&](const std::vector<Matrix34>& V) {
        double fastest = 0;
        for (const Matrix34& v : V) fastest = std::max(fastest, norm(v));
        std::vector<int> bodies;
        for (const StatedVelocity& one : said) {
            Matrix34 change = V[one.body] - state.V[one.body];
            if (!one.of_place) change.set_column(0, {});
            if (!one.of_turn) change = configuration(change.column(0), Matrix3{});
            if (norm(change) > noticed * fastest) bodies.push_back(one.body);
        }
        return bodies;
    };
    std::vector<Matrix34> V = fitting_rates(model, all, state, stated);
    // If not all that is stated can be kept, none of it has a claim to be: all move by the least.
    if (!stated.empty() && !changed_bodies(V).empty()) V = fitting_rates(model, all, state, {});
    for (const int b : changed_bodies(V))
        moved.changed.push_back("the given velocities of body '" + model.bodies()[b].name +
                                "' were changed by " +
                                velocity_change(model.bodies()[b], state.X[b], state.V[b], V[b]) +
                                " to fit the coordinates of the start");
    state.V = V;
}

}   // namespace

MovedStart dynamics_internal::move_start_with_laws(const Model& model,
                                                   const std::vector<StartCoordinate>& wanted,
                                                   StartPolicy policy, double t,
                                                   const std::vector<StatedVelocity>& given, bool is_led)
{
    if (model.has_drives() || !model.loads().empty() || !model.sensors().empty())
        throw std::logic_error("a start is moved before drives, loads and sensors are there");
    State stated = model.start();
    stated.t = t;
    const std::vector<Matrix34> V = std::exchange(stated.V, std::vector<Matrix34>(stated.X.size()));
    State begin = stated;   // led bodies close below, where the wanted values hold
    if (!is_led || policy == StartPolicy::check) begin = consistent_start(model, stated, policy).start;
    MovedStart moved{model, {}, 0, {}};
    std::vector<Led> all = all_coordinates(model, wanted);

    const auto is_wanted = [](const Led& led) { return led.has_value || led.has_rate; };
    const Chosen chosen = choose(model, all, begin.X, t, is_wanted);
    for (const std::size_t i : chosen.kept) moved.kept.push_back(name_of(model, all[i]));
    moved.left_free = freedoms(model) - static_cast<int>(chosen.rows.size());
    const Model led = led_model(model, all, begin.X, Law::go);
    Way way = lead(led, all, model, chosen.rows, begin.X);
    if (!way.is_whole && !chosen.kept.empty()) {   // what was to be kept may stand in the way
        std::vector<int> fewer = chosen.rows;
        // Rows of kept coordinates stand last: without them the way is tried a second time.
        fewer.resize(fewer.size() - chosen.kept.size());
        const Way other = lead(led, all, model, fewer, begin.X);
        if (other.is_whole) moved.kept.clear();
        if (other.done > way.done) way = other;
    }
    if (!way.is_whole) refuse_unreached(model, all, way);

    State state{t, way.X, {}};
    for (std::size_t b = 0; b < V.size(); ++b)
        state.V.push_back(model.bodies()[b].is_point
                              ? V[b]
                              : rate(way.X[b], V[b].column(0), angular_velocity(model.bodies()[b].X, V[b])));
    for (std::size_t i = 0; i < all.size(); ++i) {
        Led& one = all[i];
        const NamedCoordinate& q = named(model, one);
        // Rates that nobody wants are those of the stated velocities at the stated place.
        if (!one.has_rate) one.rate = coordinate_rate(q.coordinate, stated.X, V);
        one.from = one.to = one.has_value ? one.to : one.from + way.change[i];
    }
    const Model there = restated(model, state, all);
    const bool is_moving = std::ranges::any_of(all, [](const Led& one) { return one.rate != 0; }) ||
                           std::ranges::any_of(V, [](const Matrix34& v) { return norm(v) > 0; });
    if (is_moving) settle_rates(there, all, given, state, moved);
    moved.model = restated(there, state, all);
    return moved;
}

IndependentCoordinates independent_coordinates(const Model& model, const State& state)
{
    const std::vector<Led> all = all_coordinates(model, {});
    const Chosen chosen = choose(model, all, state.X, state.t, [](const Led&) { return false; });
    IndependentCoordinates found;
    for (const std::size_t i : chosen.kept) found.names.push_back(name_of(model, all[i]));
    found.left_free = freedoms(model) - static_cast<int>(chosen.rows.size());
    return found;
}

Model restated(const Model& model, const State& state, const std::vector<StartCoordinate>& counted)
{
    std::vector<Led> all = all_coordinates(model, {});
    const std::vector<Matrix34> stated = model.start().X;
    for (Led& led : all) {
        const JointCoordinate& q = named(model, led).coordinate;
        led.to = led.from + coordinate_change(q, stated, state.X);
        for (const StartCoordinate& one : counted) {
            const bool is_this = one.joint == led.joint && one.coordinate == led.coordinate;
            if (!is_this || !one.value || !q.counts_turns()) continue;
            const double turned = turned_to(led.to, *one.value);
            if (std::abs(*one.value - turned) <= same_angle) led.to = turned;
        }
    }
    return restated(model, state, all);
}

}   // namespace livens
