// SPDX-License-Identifier: BSD-3-Clause
// `limits` of a joint and the springs behind them. What nobody states follows from the bodies: a contact is
// as short as it may be without being what elements are made for (docs/joints.md, Along coordinates).
#include <cmath>
#include <numbers>

#include "livens/base/text.h"
#include "livens/io/scenario/loads/load_makers.h"

namespace livens::inline io_internal {

namespace {

constexpr double share_of_contact = 0.03;      // of T below
constexpr double time_without_gravity = 0.3;   // s: that of 0.9 m on earth

/// Of the angle of a rotation.
double ball_limit(const Section& keys, const std::string& path)
{
    constexpr double widest = 170 * std::numbers::pi / 180;   // beyond 175 degrees nothing pushes back
    const double limit = keys.number("limit");
    if (limit <= widest) return limit;
    throw InputError({"joint-limits", path + ".limit", "a ball joint is not limited near half a turn",
                      to_text(limit) + " rad", "at most 170 degrees",
                      "beyond half a turn it is turned less, the other way round", "leave the limit out"});
}

}   // namespace

JointLimits read_limits(const Builder& builder, const Section& keys, const Joint& joint,
                        const NamedCoordinate& coordinate, double inertia, const std::string& path)
{
    JointLimits limits;
    if (const Value* both = keys.find("limits"))
        limits.low = both->numbers[0], limits.high = both->numbers[1];
    else
        limits.high = ball_limit(keys, path);
    limits.stiffness = keys.number("limit_stiffness");
    limits.damping = keys.number("limit_damping");
    const double gravity = norm(builder.model().gravity()), length = builder.model().length();
    const double time = gravity > 0 ? std::sqrt(length / gravity) : time_without_gravity;
    if (!keys.has("limit_damping")) limits.damping = coordinate.coordinate.is_angle() ? time : time / length;
    if (keys.has("limit_stiffness")) return limits;
    // A contact of the inertia J with nothing else on it takes pi sqrt(J / k) (theory.md, "Coordinates of
    // joints", Limits).
    const double frequency = std::numbers::pi / (share_of_contact * time);   // of half a period's contact
    limits.stiffness = inertia * frequency * frequency;
    if (!(limits.stiffness > 0 && std::isfinite(limits.stiffness)))
        throw InputError(
            {"joint-limits", path + (keys.takes("limits") ? ".limits" : ".limit"),
             "the bodies do not tell how stiff the limits of joint '" + joint.name + "' should be", "", "",
             "what the joint moves has no inertia", "give 'limit_stiffness'"});
    return limits;
}

}   // namespace livens::inline io_internal
