// SPDX-License-Identifier: BSD-3-Clause
// What is told of states of rest, by `equilibrium` and by `modes`.
#pragma once

#include <span>
#include <string>

#include "livens/io/scenario.h"
#include "livens/statics/equilibrium.h"
#include "summary.h"

namespace livens::program {

/// From the known state of the scenario, until a signal comes.
Equilibrium equilibrium_of(const Scenario& scenario);

/// The verdict as a headline.
void add_stability(Summary& summary, const StabilityReport& stability, int degrees_of_freedom);

/// For people: six digits, and 0 for what is rounding of `size`.
std::string shown(double x, double size);
std::string shown(const Vector3& v, double size);

template <int N>
std::span<const double> numbers(const Matrix<N, 1>& v)   // to be read before a temporary goes
{
    return {v.a, static_cast<std::size_t>(N)};
}

}   // namespace livens::program
