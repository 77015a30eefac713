// SPDX-License-Identifier: BSD-3-Clause
// A rigid displacement of everything there is.
#pragma once

#include "livens/base/linear.h"

namespace [[gnu::visibility("default")]] livens {

/// x -> position + rotation x.
struct Displacement {
    Vector3 position{};                 ///< m
    Matrix3 rotation = identity<3>();   ///< orthonormal and right-handed

    bool is_none() const { return position == Vector3{} && rotation == identity<3>(); }
    Vector3 of_point(const Vector3& x) const { return position + rotation * x; }
    /// Of X; of its rate it is `rotation` times that.
    Matrix34 of_configuration(const Matrix34& X) const
    {
        Matrix34 moved = rotation * X;
        moved.set_column(0, moved.column(0) + position);
        return moved;
    }
    /// The way back.
    Displacement inverse() const { return {-(transpose(rotation) * position), transpose(rotation)}; }
    /// First `inner`, then this one.
    Displacement after(const Displacement& inner) const
    {
        return {of_point(inner.position), rotation * inner.rotation};
    }
};

}   // namespace gnu::visibility("default")]]livens
