// Numbers and places as the room's error messages spell them.
#pragma once

#include <charconv>
#include <cmath>
#include <string>

#include "livens/base/error.h"
#include "livens/base/linear.h"

namespace livens {

/// The shortest text that reads back as the same double.
inline std::string to_text(double value)
{
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
    return std::string(buffer, end);
}

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

}   // namespace livens
