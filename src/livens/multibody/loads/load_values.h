// SPDX-License-Identifier: BSD-3-Clause
// What the makers of loads share.
#pragma once

#include <string>

#include "livens/multibody/loads.h"
#include "livens/multibody/loads/load_tape.h"

namespace livens::inline multibody_internal {

/// A load without functions, its bodies checked.
Load start_load(const std::string& name, const char* type, const std::array<int, 2>& bodies);

/// Each throws InputError (path `load[name]`).
void check_load_vector(const Load& load, const Vector3& value, const std::string& what);
void check_not_negative(const Load& load, double value, const std::string& key);

/// Checks what can be checked of a time vector and takes over its breaks.
void set_load_value(Load& load, const TimeVector& value);

/// Reports its components.
void report_load_value(Load& load, const TimeVector& value, const char* unit);

/// F = t w^T with a vector t in world axes, or t = sum_i t_i d_i: a force at a point, or one that is the same
/// all over a body or a surface. `unit`: of t.
Load uniform_load(const std::string& name, const char* type, int body, const Vector4& w,
                  const TimeVector& value, Frame frame, const char* unit);

inline Vector3 load_value(const TimeVector& value, Instant at)
{
    return {value[0](at).value, value[1](at).value, value[2](at).value};
}

/// The force of a spring's law, on a tape.
inline TapeNumber recorded(const SpringLaw& law, TapeNumber e)
{
    const auto force = [law](Instant, std::span<const double> in, std::span<double> out) {
        out[0] = law(in[0]).force;
    };
    return e.tape->outer(force, {e}, 1)[0];
}

/// Director i of the first body, and t_1 d_1 + t_2 d_2 + t_3 d_3.
inline TapeVector director_on(LoadTape& tape, int i)
{
    Vector3 unit{};
    unit[i] = 1;
    return tape.arm(0, direction(unit));
}
inline TapeVector along_directors(TapeVector t)
{
    LoadTape& tape = *t.tape;
    return t[0] * director_on(tape, 0) + t[1] * director_on(tape, 1) + t[2] * director_on(tape, 2);
}

/// Adds the derivative of column i of F by column j of X (or V) to its place among the stacked columns.
inline void add_block(Matrix<12, 12>& tangent, int i, int j, const Matrix3& block)
{
    for (int col = 0; col < 3; ++col)
        for (int row = 0; row < 3; ++row) tangent(3 * i + row, 3 * j + col) += block(row, col);
}

/// Adds the derivative of stacked columns a s by a number s with the slopes b.
inline void add_outer(Matrix<12, 12>& tangent, const Matrix34& a, const Matrix34& b)
{
    for (int j = 0; j < 12; ++j) {
        if (b.a[j] == 0) continue;   // as of most places
        for (int i = 0; i < 12; ++i) tangent(i, j) += a.a[i] * b.a[j];
    }
}

}   // namespace livens::inline multibody_internal
