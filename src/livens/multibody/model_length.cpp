// SPDX-License-Identifier: BSD-3-Clause
// The model's length L, by which shifts are measured beside angles: spread of bodies and joints, radius of
// gyration, or the distance of an attracting point. Tolerances of theory.md are stated in this length.
#include <algorithm>
#include <cmath>

#include "livens/multibody/model.h"

namespace livens {

namespace {

Vector3 center_of_mass(const Body& body) { return (1 / body.mass(0, 0)) * (body.X * body.mass.column(0)); }

/// The distance of two points, unless it is the rounding of their places.
double told_distance(const Vector3& a, const Vector3& b)
{
    const double distance = norm(a - b);
    return distance > 1e-13 * (norm(a) + norm(b)) ? distance : 0;
}

double length_of(const Model& model)
{
    double length = 0, radius = 0;   // of gyration, the largest
    Vector3 middle{};
    const std::vector<Body>& bodies = model.bodies();
    const auto n = std::ranges::count(bodies, true, &Body::is_matter);
    for (const Body& body : bodies) {
        if (!body.is_matter()) continue;
        double square = 0;
        for (int i = 1; i < 4; ++i) {
            const double offset = body.mass(i, 0) / body.mass(0, 0);
            // Second moment less the square of the offset: about the centre of mass, so the reference point
            // has no say.
            square += body.mass(i, i) / body.mass(0, 0) - offset * offset;
        }
        radius = std::max(radius, std::sqrt(std::max(square, 0.0)));
        middle += (1.0 / static_cast<double>(n)) * center_of_mass(body);
    }
    for (const Body& body : bodies)
        if (body.is_matter()) length = std::max(length, 2 * told_distance(center_of_mass(body), middle));
    const auto of_rope = [&](const std::vector<BodyPoint>& over) {
        const auto place = [&](const BodyPoint& at) {
            return (at.body == world ? world_configuration : bodies[at.body].X) * point(at.point);
        };
        for (std::size_t k = 1; k < over.size(); ++k)
            length = std::max(length, told_distance(place(over[k - 1]), place(over[k])));
    };
    for (const Joint& joint : model.joints()) {
        const Body& second = bodies[joint.second];
        if (second.is_rotor) continue;
        const Vector3 place = second.X * point(joint.point_second);
        const Matrix34& X_first = joint.first == world ? world_configuration : bodies[joint.first].X;
        const Vector3 other = X_first * point(joint.point_first);
        length =
            std::max({length, told_distance(place, center_of_mass(second)), told_distance(place, other)});
        if (joint.first != world)
            length = std::max(length, told_distance(other, center_of_mass(bodies[joint.first])));
        of_rope(joint.over);
    }
    for (const Load& load : model.loads()) of_rope(load.over);
    if (length > 0) return std::max(length, radius);
    for (const Load& load : model.loads()) {   // what attracts tells an orbit, but not a mechanism in one
        if (!load.sets_length_scale) continue;
        const auto place = [&](std::size_t i) {
            const int body = load.bodies[i];
            return body == world ? load.points[i] : bodies[body].X * point(load.points[i]);
        };
        length = std::max(length, told_distance(place(0), place(1)));
    }
    length = std::max(length, radius);
    return length > 0 ? length : 1;
}

}   // namespace

double Model::length() const
{
    // Threads may compute it twice; they get the same number, so no order between them is needed.
    double length = length_.value.load(std::memory_order_relaxed);
    if (length == 0) {
        length = length_of(*this);
        length_.value.store(length, std::memory_order_relaxed);
    }
    return length;
}

}   // namespace livens
