// SPDX-License-Identifier: BSD-3-Clause
// Sums over links, by their first and second moments about the body's origin, and what is done where the sum
// is no body.
#include "livens/io/import/urdf_bodies.h"

#include <algorithm>
#include <cmath>

#include "livens/base/text.h"
#include "livens/multibody/nearest_inertia.h"

namespace livens::inline io_internal {

namespace {

double largest_entry(const Matrix3& m)
{
    double largest = 0;
    for (const double entry : m.a) largest = std::max(largest, std::abs(entry));
    return largest;
}

/// About a point that is `arm` away from the centre of mass.
Matrix3 moved_inertia(const Matrix3& inertia, double mass, const Vector3& arm)
{
    return inertia + mass * (dot(arm, arm) * identity<3>() - outer(arm, arm));
}

/// In the frame of the link from which the body has its name, about the centre of mass of all: moments of
/// links are turned, then moved by Steiner's theorem.
MassProperties sum_of(const UrdfFile& file, const UrdfTree& tree, int body, const std::vector<int>& links)
{
    const Pose& frame = tree.links[tree.frames[body]].pose;
    const Matrix3 back = transpose(frame.axes);
    std::vector<MassProperties> parts;
    MassProperties sum;
    for (const int link : links) {
        const UrdfInertial& of = file.links[link].inertial;
        if (of.mass == 0 && largest_entry(of.inertia) == 0) continue;
        const Pose& pose = tree.links[link].pose;
        if (link == tree.frames[body]) {   // as it is written, without rounding
            parts.push_back({of.mass, of.center, of.inertia});
        } else {
            const Matrix3 axes = back * pose.axes;
            const Vector3 center = back * (pose.origin + pose.axes * of.center - frame.origin);
            parts.push_back({of.mass, center, axes * of.inertia * transpose(axes)});
        }
        sum.mass += of.mass;
        sum.center_of_mass += of.mass * parts.back().center_of_mass;
    }
    // m c / m may differ from c in the last digit.
    if (parts.size() == 1) return parts.front();
    if (sum.mass > 0) sum.center_of_mass *= 1 / sum.mass;
    for (const MassProperties& part : parts)
        sum.inertia += moved_inertia(part.inertia, part.mass, part.center_of_mass - sum.center_of_mass);
    // A J A^T is symmetric but for rounding, and urdf_scenario.cpp writes columns as rows.
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < i; ++j)
            sum.inertia(i, j) = sum.inertia(j, i) = 0.5 * (sum.inertia(i, j) + sum.inertia(j, i));
    return sum;
}

/// Of a body as it is written, where that is no body: by the least change of how its mass is spread.
void mend(MassProperties& body, const UrdfLink& link, Losses& losses)
{
    const Matrix3 mended = nearest_inertia(body.inertia);
    const double change = largest_entry(mended - body.inertia), size = largest_entry(body.inertia);
    const double arms = body.mass * dot(body.center_of_mass, body.center_of_mass);
    constexpr double rounding = 1e-12;   // of the moments about the link's origin
    if (change > rounding * (size + arms))
        losses.add(losses::inertia, link.inertial.place.line > 0 ? link.inertial.place : link.place,
                   "'" + link.name + "' by " + to_text(100 * change / size, 2) + " %");
    if (change > 0) body.inertia = mended;
}

/// Largest square of a radius of gyration, m^2.
double largest_radius(const std::vector<MassProperties>& bodies)
{
    double largest = 0;
    for (const MassProperties& body : bodies)
        if (body.mass > 0) largest = std::max(largest, trace(body.inertia) / body.mass);
    return largest > 0 ? largest : 1;
}

}   // namespace

double smallest_mass(const std::vector<MassProperties>& bodies)
{
    double smallest = 0;
    for (const MassProperties& body : bodies)
        if (body.mass > 0 && (smallest == 0 || body.mass < smallest)) smallest = body.mass;
    return smallest;
}

std::vector<MassProperties> masses_of(const UrdfFile& file, const UrdfTree& tree,
                                      UrdfOptions::Inertias inertias, Losses& losses, Findings& findings)
{
    std::vector<std::vector<int>> links(tree.frames.size());
    for (std::size_t i = 0; i < tree.links.size(); ++i)
        if (tree.links[i].body >= 0) links[tree.links[i].body].push_back(static_cast<int>(i));
    std::vector<MassProperties> bodies;
    for (std::size_t b = 0; b < links.size(); ++b)
        bodies.push_back(sum_of(file, tree, static_cast<int>(b), links[b]));
    const double smallest = smallest_mass(bodies), radius = largest_radius(bodies);
    if (!(smallest > 0)) {
        findings.error(file.links[tree.frames.front()].place, "mass-missing", "no link that moves has a mass",
                       {"a link has a mass in <inertial><mass value=\"..\"/></inertial>", ""});
        return bodies;
    }
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        MassProperties& body = bodies[b];
        const UrdfLink& link = file.links[tree.frames[b]];
        if (inertias == UrdfOptions::Inertias::mend) mend(body, link, losses);
        if (body.mass > 0) continue;
        body.mass = massless * smallest;
        // Spread like the most extended body: nothing tells how large this one is.
        if (trace(body.inertia) == 0) body.inertia = body.mass * radius * identity<3>();
        losses.add(losses::massless, link.place, "'" + link.name + "'");
    }
    return bodies;
}

}   // namespace livens::inline io_internal
