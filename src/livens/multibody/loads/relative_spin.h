// SPDX-License-Identifier: BSD-3-Clause
// The angular velocity of one body against another as loads look at it.
#pragma once

#include <span>
#include <vector>

#include "livens/multibody/loads/load_laws.h"
#include "livens/multibody/loads/load_tape.h"

namespace livens::inline multibody_internal {

/// Three displacements, unless there are none, and R = A^T B of two triads, whose column m is b_m in axes of
/// the first: R_lm = a_l . b_m stands at 3 m + l behind the displacements. With w = 1/2 sum_m b_m x b_m',
/// which is (w2 - w1) in these axes, a damping f = -C (displacement', w) gives R_lm the factor 1/2 (f_w x
/// b_m)_l: its power is f . (displacement', w), and none of a motion that both bodies share, whatever R is.
struct SpinDamping {
    Matrix<6, 6> damping{};   ///< N s/m, N m s/rad and mixed
    bool has_displacements = false;

    std::size_t n() const { return has_displacements ? 12 : 9; }
    std::size_t first() const { return n() - 9; }   ///< of R
    /// displacement' (or zeros) and w.
    Matrix<6, 1> rates(const LawArguments& at) const;
    /// -C (displacement', w).
    Matrix<6, 1> force(const LawArguments& at) const { return -1. * (damping * rates(at)); }

    void operator()(const LawArguments& at, std::span<double> factors, std::span<double> slopes) const;
    void record(const LawOnTape& at, std::span<TapeNumber> factors) const;
    double power(const LawArguments& at) const { return dot(rates(at), force(at)); }
    TapeNumber recorded_power(const LawOnTape& at) const;

private:
    struct OnTape {
        TapeNumber rates[6];   ///< the first three without place where there are none
        TapeNumber force[6];
    };
    OnTape on_tape(const LawOnTape& at) const;
};

/// The nine coordinates R_lm of two frames.
std::vector<LawCoordinate> turned_axes(int first, const Matrix3& axes_first, int second,
                                       const Matrix3& axes_second, const Configurations& X);

}   // namespace livens::inline multibody_internal
