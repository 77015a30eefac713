// SPDX-License-Identifier: BSD-3-Clause
// Numbers and places as the room's error messages spell them.
#pragma once

#include <cmath>
#include <string>

#include "livens/base/error.h"
#include "livens/base/linear.h"
#include "livens/base/text.h"

namespace livens::inline multibody_internal {

using ::livens::to_text;   // of numbers: the one of vectors hides no others

inline std::string to_text(const Vector3& v)
{
    return "[" + to_text(v[0]) + ", " + to_text(v[1]) + ", " + to_text(v[2]) + "]";
}

template <int R, int C>
bool all_finite(const Matrix<R, C>& m)
{
    for (const double entry : m.a)
        if (!std::isfinite(entry)) return false;
    return true;
}

/// Throws InputError `not-finite` unless every entry is a number.
template <int R, int C>
void require_finite(const Matrix<R, C>& m, const std::string& path, const std::string& what)
{
    for (const double entry : m.a)
        if (!std::isfinite(entry))
            throw InputError(
                {"not-finite", path, what + " must be finite", to_text(entry), "finite numbers", "", ""});
}

}   // namespace livens::inline multibody_internal
