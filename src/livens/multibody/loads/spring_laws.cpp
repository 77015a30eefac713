// SPDX-License-Identifier: BSD-3-Clause
// Laws of springs by elongation: force, stiffness and energy, which belong together to rounding, since the
// drift of energy is judged by them (theory.md, "What is diagnosed").
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/multibody/loads.h"
#include "livens/time/time_laws.h"

namespace livens {

namespace {

/// Of a table, piece by piece: two Gauss points are exact for cubics.
double integral(const TimeFunction& f, double from, double until)
{
    const double middle = 0.5 * (from + until), half = 0.5 * (until - from), s = half / std::sqrt(3.0);
    return half * (f({middle - s}).value + f({middle + s}).value);
}

}   // namespace

std::vector<double> bends_of_lines(const std::vector<double>& x, const std::vector<double>& y)
{
    std::vector<double> bends;
    for (std::size_t i = 2; i < std::min(x.size(), y.size()); ++i) {
        const double before = (y[i - 1] - y[i - 2]) / (x[i - 1] - x[i - 2]),
                     after = (y[i] - y[i - 1]) / (x[i] - x[i - 1]);
        // Rows on one straight line are no bend, and no element has to end there.
        if (std::abs(after - before) > 1e-12 * (std::abs(after) + std::abs(before)))
            bends.push_back(x[i - 1]);
    }
    return bends;
}

SpringLaw progressive_spring(double stiffness, double cubic)
{
    for (const auto& [value, key] : {std::pair{stiffness, "stiffness"}, std::pair{cubic, "cubic"}})
        if (!(value >= 0) || !std::isfinite(value))
            throw InputError({"load-negative", key, std::string(key) + " must not be negative",
                              to_text(value), ">= 0", "", ""});
    return {[=](double e) {
        const double e2 = e * e;
        return SpringValue{(stiffness + cubic * e2) * e, stiffness + 3 * cubic * e2,
                           (0.5 * stiffness + 0.25 * cubic * e2) * e2};
    }};
}

SpringLaw tabulated_spring(const std::vector<double>& elongations, const std::vector<double>& forces,
                           bool is_spline)
{
    for (std::size_t i = 1; i < elongations.size(); ++i)
        if (elongations[i] == elongations[i - 1])
            throw InputError({"table-order", "load.table", "a spring's force cannot jump",
                              "two forces at " + to_text(elongations[i]), "ascending elongations", "", ""});
    const TimeFunction inside = (is_spline ? spline_table : linear_table)(elongations, forces);
    const TimeFunction force = straight_on(inside, elongations.front(), elongations.back());
    // Sums at the rows: an energy then takes one integral, and not one for each row.
    std::vector<double> energies{0};   // at the rows, from the first
    for (std::size_t i = 1; i < elongations.size(); ++i)
        energies.push_back(energies.back() + integral(force, elongations[i - 1], elongations[i]));
    const auto energy = [force, elongations, energies](double e) {
        const auto next = std::ranges::upper_bound(elongations, e);
        const std::size_t row = next == elongations.begin() ? 0 : next - elongations.begin() - 1;
        return energies[row] + integral(force, elongations[row], e);
    };
    // Energy counts from elongation zero, wherever the table begins.
    const double at_rest = energy(0);
    return {[force, energy, at_rest](double e) {
                const TimeValue f = force({e});
                return SpringValue{f.value, f.first, energy(e) - at_rest};
            },
            is_spline ? knots_of_spline(elongations) : bends_of_lines(elongations, forces)};
}

}   // namespace livens
