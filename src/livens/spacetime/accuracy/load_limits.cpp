// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "livens/base/text.h"
#include "livens/spacetime/accuracy/load_limits.h"

namespace livens::inline spacetime_internal {

namespace {

constexpr int looks_an_element = 16;

/// The readings of a load that are a rotation vector; empty: it has none.
std::optional<std::array<const LoadReading*, 3>> rotation_of(const Load& load)
{
    std::array<const LoadReading*, 3> found{};
    for (const LoadReading& reading : load.readings)
        for (std::size_t k = 0; k < 3; ++k)
            if (reading.name == std::string("rotation_") + "xyz"[k]) found[k] = &reading;
    if (found[0] == nullptr || found[1] == nullptr || found[2] == nullptr) return {};
    return found;
}

/// When; nan: never.
double too_far_at(const Load& load, const std::array<const LoadReading*, 3>& readings, const Motion& motion,
                  double most)
{
    Vector3 before{};
    for (int n = 0; n <= looks_an_element * motion.n_elements(); ++n) {
        const int e = n / looks_an_element;
        const double t =
            n % looks_an_element == 0
                ? motion.mesh.ends[e]
                : motion.mesh.ends[e] + motion.mesh.length(e) * (n % looks_an_element) / looks_an_element;
        const State state = motion.at(t);
        const LoadArguments at = load_arguments(load, {t}, state.X, state.V, {});
        Vector3 now{};
        for (std::size_t k = 0; k < 3; ++k) now[static_cast<int>(k)] = readings[k]->value(at);
        const bool is_far = norm(now) > 0.5 * std::numbers::pi && norm(before) > 0.5 * std::numbers::pi;
        if (norm(now) > most || (is_far && dot(now, before) < 0)) return t;
        before = now;
    }
    return std::numeric_limits<double>::quiet_NaN();
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

}   // namespace livens::inline spacetime_internal
