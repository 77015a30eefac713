// SPDX-License-Identifier: BSD-3-Clause
// Points on bodies that were meant as places in the world.
// `points` are in coordinates of each body, which is easily overlooked. A warning needs both signs of the
// mistake: the point lies outside of the shape, and read as a place in the world it lies inside.
#include <algorithm>

#include "livens/base/text.h"
#include "livens/io/scenario/joints/joints.h"

namespace livens::inline io_internal {

namespace {

/// How far a shape goes from its centre of mass, at most.
double reach_of(const Outline& outline)
{
    double reach = 0;
    const auto take = [&](const Vector3& p) {
        Vector3 scaled{};
        for (int i = 0; i < 3; ++i) scaled[i] = outline.stretch[i] * p[i];
        reach = std::max(reach, norm(scaled));
    };
    // The corner of the box about the circle bounds it for any stretch, which may differ along d1 and d2.
    for (const auto& [radius, height] : outline.profile) take({radius, radius, height});
    for (const Vector3& p : outline.points) take(p);
    for (const Outline& part : outline.parts) reach = std::max(reach, norm(part.place) + reach_of(part));
    return reach;
}

}   // namespace

void warn_of_world_points(Builder& builder, const Section& section, const std::array<int, 2>& bodies)
{
    const Value* given = section.find("points");
    if (given == nullptr) return;
    for (int i = 0; i < 2; ++i) {
        const int body = bodies[static_cast<std::size_t>(i)];
        if (body == world || builder.is_point(body)) continue;
        const double reach = reach_of(builder.outlines()[body]);
        const Matrix34& X = builder.start_configuration(body);
        const Matrix4& mass = builder.model().bodies()[body].mass;
        const Vector3 stated = section.row("points", i), p = builder.in_axes(body, stated),
                      // The centre of mass from the mass matrix: its first row is (M, S), see (P7).
            center = (1 / mass(0, 0)) * Vector3{mass(0, 1), mass(0, 2), mass(0, 3)},
                      as_place = transpose(directors(X)) * (p - X.column(0));
        const bool is_reference = stated == Vector3{};   // is meant
        if (is_reference || norm(p - center) <= reach || !(norm(as_place - center) <= reach)) continue;
        const Vector3 lies = X * point(p);
        builder.findings().warning(
            given->node->items()[static_cast<std::size_t>(i)].place, "point-outside",
            "the point of " + section.label() + " on '" + builder.body_name(body) + "' lies " +
                to_text(norm(p - center) - reach, 3) + " m outside of its shape, at (" + to_text(lies[0], 4) +
                ", " + to_text(lies[1], 4) + ", " + to_text(lies[2], 4) + ") in the world",
            {"'points' are in coordinates of each body, from its reference point",
             "of the place (" + to_text(p[0], 4) + ", " + to_text(p[1], 4) + ", " + to_text(p[2], 4) +
                 ") in the world they are [" + to_text(as_place[0], 4) + ", " + to_text(as_place[1], 4) +
                 ", " + to_text(as_place[2], 4) + "]"});
    }
}

}   // namespace livens::inline io_internal
