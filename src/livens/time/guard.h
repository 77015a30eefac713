// SPDX-License-Identifier: BSD-3-Clause
// Where laws go on to another of their smooth pieces.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace [[gnu::visibility("default")]] livens {

/// A number of the motion, and the places, ascending, at which a law bends or jumps: elements end there
/// (docs/theory.md, "Laws that bend").
struct Guard {
    std::vector<double> places{0};
    double period = 0;   ///< of a number that begins again, with places in one round; 0: it does not

    /// The number with whole periods added, such that it is nearest to `near`.
    double following(double value, double near) const
    {
        return period > 0 ? value + period * std::round((near - value) / period) : value;
    }

    /// Between two places, or beyond the first or last.
    struct Piece {
        double low = -std::numeric_limits<double>::infinity();
        double high = std::numeric_limits<double>::infinity();

        /// How far a number is inside; negative outside.
        double margin(double value) const { return std::min(value - low, high - value); }
    };
    /// A place itself belongs to the piece below.
    Piece piece_at(double value) const
    {
        if (places.empty()) return {};
        const double round = period > 0 ? period * std::floor((value - places.front()) / period) : 0;
        const auto next = std::lower_bound(places.begin(), places.end(), value - round);
        Piece piece;
        if (next != places.begin())
            piece.low = *(next - 1) + round;
        else if (period > 0)
            piece.low = places.back() + round - period;
        if (next != places.end())
            piece.high = *next + round;
        else if (period > 0)
            piece.high = places.front() + round + period;
        return piece;
    }
};

}   // namespace gnu::visibility("default")]]livens
