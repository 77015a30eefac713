// SPDX-License-Identifier: BSD-3-Clause
// What rounding of a state does to numbers that are made of it (docs/theory.md, "Rest").
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace livens::inline diagnostics_internal {

/// How much numbers change for each unit that the numbers of a state change by, as parts of their sizes:
/// those go up or down by 1e-9 of them, far above rounding, in three patterns of signs. Not finite: taken as
/// none.
///
/// here    the numbers of the state as it is
/// beside  (shift) -> the numbers of the state with shift(its size) added to each number of it, in one order
template <class Beside>
std::vector<double> changes_by_rounding(const std::vector<double>& here, const Beside& beside)
{
    constexpr double apart = 1e-9;
    constexpr std::uint32_t patterns = 3;
    std::vector<double> change(here.size());
    for (std::uint32_t pattern = 1; pattern <= patterns; ++pattern) {
        std::uint32_t bits = 0x9e3779b9u * pattern;
        const std::vector<double> there = beside([&bits](double size) {
            bits = bits * 1664525u + 1013904223u;   // a linear congruential generator, by its highest bit
            return (bits >> 31 != 0 ? apart : -apart) * size;
        });
        for (std::size_t k = 0; k < here.size(); ++k) {
            const double now = std::abs(there[k] - here[k]) / apart;
            if (std::isfinite(now)) change[k] = std::max(change[k], now);
        }
    }
    return change;
}

}   // namespace livens::inline diagnostics_internal
