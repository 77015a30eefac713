// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "livens/base/text.h"
#include "livens/spacetime/accuracy/load_limits.h"

namespace livens::inline spacetime_internal {

namespace {

constexpr int looks_an_element = 16;

/// The readings of a load that are a rotation vector by which its force ends; empty: it has none.
std::optional<std::array<const LoadReading*, 3>> rotation_of(const Load& load)
{
    std::array<const LoadReading*, 3> found{};
    if (load.domain.empty()) return {};   // its force is a number however far it turns
    for (const LoadReading& reading : load.readings)
        for (std::size_t k = 0; k < 3; ++k)
            if (reading.name == std::string("rotation_") + "xyz"[k]) found[k] = &reading;
    if (found[0] == nullptr || found[1] == nullptr || found[2] == nullptr) return {};
    return found;
}

/// Calls look(t) at some instants of each element, until it says true: that one; nan: it never does.
template <class Look>
double first_instant(const Motion& motion, const Look& look)
{
    for (int n = 0; n <= looks_an_element * motion.n_elements(); ++n) {
        const int e = n / looks_an_element;
        const double t =
            n % looks_an_element == 0
                ? motion.mesh.ends[e]
                : motion.mesh.ends[e] + motion.mesh.length(e) * (n % looks_an_element) / looks_an_element;
        if (look(t)) return t;
    }
    return std::numeric_limits<double>::quiet_NaN();
}

/// When; nan: never.
/// Beyond half a turn a rotation vector goes on at the other side: two looks at vectors of more than a
/// quarter of a turn that point apart have that between them.
double too_far_at(const Load& load, const std::array<const LoadReading*, 3>& readings, const Motion& motion,
                  double most)
{
    Vector3 before{};
    return first_instant(motion, [&](double t) {
        const State state = motion.at(t);
        const LoadArguments at = load_arguments(load, {t}, state.X, state.V, {});
        Vector3 now{};
        for (std::size_t k = 0; k < 3; ++k) now[static_cast<int>(k)] = readings[k]->value(at);
        const bool is_far = norm(now) > 0.5 * std::numbers::pi && norm(before) > 0.5 * std::numbers::pi;
        const bool is_too_far = norm(now) > most || (is_far && dot(now, before) < 0);
        before = now;
        return is_too_far;
    });
}

/// An angle that is not known everywhere, and whose it is.
struct WatchedAngle {
    std::string whose;
    const JointCoordinate* q;
};

/// The angle of one axis has a value all round; those of three axes and rotation vectors have not.
std::vector<WatchedAngle> watched_angles(const Model& model)
{
    std::vector<WatchedAngle> all;
    const auto add = [&](const std::string& whose, const JointCoordinate& q) {
        if (q.is_angle() && q.kind != CoordinateKind::angle) all.push_back({whose, &q});
    };
    for (const Joint& joint : model.joints())
        for (const NamedCoordinate& one : joint.coordinates)
            add("joint '" + joint.name + "'", one.coordinate);
    for (const Load& load : model.loads())
        for (const JointCoordinate& q : load.rotations) add("load '" + load.name + "'", q);
    for (const Sensor& sensor : model.sensors())
        for (const SensorComponent& component : sensor.components)
            if (component.derivative == 0)
                add("sensor '" + sensor.name + "'", component.coordinate.coordinate);
    return all;
}

std::string why_without_value(const WatchedAngle& angle, double t)
{
    const bool is_of_three =
        angle.q->kind == CoordinateKind::outer_angle || angle.q->kind == CoordinateKind::arc_sine;
    return (is_of_three ? "angles of " : "components of the rotation vector of ") + angle.whose +
           " have no value near t = " + to_text(t, 6) + " s: " +
           (is_of_three ? "the second one gets to 90 degrees, where the other two are one; other 'angles' of "
                          "the joint, such as \"yxz\", may stay away from that"
                        : "it is turned by more than 175 degrees, and changes its sign at half a turn");
}

}   // namespace

std::string turned_too_far(const Model& model, const Motion& motion, double most)
{
    if (motion.n_elements() == 0) return "";
    std::string first;
    double earliest = std::numeric_limits<double>::infinity();
    for (const Load& load : model.loads()) {
        const auto readings = rotation_of(load);
        if (!readings) continue;
        const double t = too_far_at(load, *readings, motion, most);
        if (!(t < earliest)) continue;
        earliest = t;
        first = load.type + " '" + load.name + "' reaches half a turn at t = " + to_text(t, 6) +
                " s, where its rotation vector and with it its torque change their sign: it goes up to 175 "
                "degrees; for turns about one axis take a joint and a spring on its angle";
    }
    return first;
}

std::string angle_without_value(const Model& model, const Motion& motion)
{
    const std::vector<WatchedAngle> watched = watched_angles(model);
    if (motion.n_elements() == 0 || watched.empty()) return "";
    constexpr double jump = 0.5 * std::numbers::pi;   // from one look to the next: it has passed there
    const WatchedAngle* found = nullptr;
    std::vector<double> before;
    const double t = first_instant(motion, [&](double at) {
        const std::vector<Matrix34> X = motion.at(at).X;
        std::vector<double> now;
        for (const WatchedAngle& one : watched) {
            now.push_back(coordinate_value(*one.q, X));
            double change = before.empty() ? 0 : now.back() - before[now.size() - 1];
            if (one.q->counts_turns()) change = std::remainder(change, 2 * std::numbers::pi);
            if (is_known(*one.q, X) && std::abs(change) < jump) continue;
            found = &one;
            return true;
        }
        before = std::move(now);
        return false;
    });
    return found == nullptr ? "" : why_without_value(*found, t);
}

}   // namespace livens::inline spacetime_internal
