// SPDX-License-Identifier: BSD-3-Clause
// Least and largest values of a motion's quantities, with their instants.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "livens/diagnostics/quantities.h"

namespace [[gnu::visibility("default")]] livens {

/// A series of numbers: a component of a quantity, or the magnitude of a vector.
struct QuantitySeries {
    NamedQuantity quantity;
    int component = -1;   ///< -1: the magnitude, or the number itself where there is but one

    std::string name() const
    {
        const std::string dot = component < 0 ? "" : ".";
        return quantity.name() + dot + (component < 0 ? "" : component_of(quantity, component));
    }
    double of(std::span<const double> numbers) const;
};

struct Extreme {
    double value;
    double t;   ///< s
};

struct Extremes {
    std::string name, unit;
    Extreme least, largest;
    /// What is farther from zero of both, with its sign; the earlier one where rounding alone tells them
    /// apart.
    const Extreme& peak() const
    {
        const double below = -least.value, above = largest.value, rounding = 1e-9 * std::abs(above);
        if (std::abs(below - above) <= rounding) return least.t < largest.t ? least : largest;
        return below > above ? least : largest;
    }
    /// An instant at which it is no number; nan: none was met. Then the others are nan as well.
    double lost_at;
};

/// A state of the motion, and its reactions, better than the polynomials have it: see sample_exactly().
/// Empty: it cannot be had there.
struct BetterSample {
    State state;
    std::vector<JointSample> joints;
};
using BetterState = std::function<std::optional<BetterSample>(double t)>;

/// Of each series over the whole motion. Every element is looked at in 2 p + 4 places or more; each place
/// that is above (below) its neighbours is one to look around at, element ends from their own side. Where the
/// extreme may be the largest, it is found by Brent's minimisation to 1e-7 of the way between the neighbours,
/// in states of `better` where there are any. Of places that are equal within 1e-9 the first is told.
std::vector<Extremes> find_extremes(const Quantities& quantities, const Motion& motion,
                                    std::span<const QuantitySeries> series, const BetterState& better);

}   // namespace gnu::visibility("default")]]livens
