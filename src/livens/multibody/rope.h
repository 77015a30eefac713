// SPDX-License-Identifier: BSD-3-Clause
// Ropes: lines over points of bodies, along which they run freely. The joint is in joints.h, the spring in
// loads/load_laws.h.
#pragma once

#include <string>
#include <vector>

#include "livens/multibody/constraint.h"

namespace [[gnu::visibility("default")]] livens {

/// A point that moves with a body, in its coordinates, or is one of the world.
struct BodyPoint {
    int body = world;
    Vector3 point{};
};

/// The sum of all spans in a configuration of all bodies.
double rope_length(const std::vector<BodyPoint>& over, const Configurations& X);

/// What spans between points on one body add to the length, which is constant.
double constant_length(const std::vector<BodyPoint>& over);

/// Throws InputError at path: `rope-points` for less than two points, points that are not finite, or none
/// that moves against another one; `rope-span` for neighbours that are in one place in X.
void check_rope(const std::string& path, const std::vector<BodyPoint>& over, const Configurations& X);

}   // namespace gnu::visibility("default")]]livens
