// SPDX-License-Identifier: BSD-3-Clause
// The division of time into elements.
#pragma once

#include <span>
#include <vector>

namespace livens {

/// A side of an instant: loads that jump in time have two values there.
enum class Side { left = -1, middle = 0, right = 1 };

struct Instant {
    double t = 0;
    Side side = Side::middle;
};

/// Element e spans [ends[e], ends[e + 1]]; ends ascend strictly.
struct TimeMesh {
    std::vector<double> ends;

    int n_elements() const { return static_cast<int>(ends.size()) - 1; }
    double start() const { return ends.front(); }
    double end() const { return ends.back(); }
    double length(int element) const { return ends[element + 1] - ends[element]; }
    /// The element that contains t: the one that starts there at an element end, except at the last.
    int element_at(double t) const;
};

/// At least `n_elements` of equal length between `start` and `end`, and every required instant inside an
/// element end.
///
/// Required instants (jumps of loads, output times) outside the interval are left out. Between two of them
/// lie max(1, ceil(length / h)) equal elements with h = (end - start) / n_elements, so a mesh whose required
/// instants fall on its grid has n_elements. Instants closer than 1e-9 (end - start) are one: the first in
/// `required` wins. `start` and `end` win over all. Required instants are element ends to the bit. Throws
/// InputError: end not after start, n_elements < 1 or > 1e8, not finite, elements shorter than the spacing of
/// doubles.
TimeMesh make_time_mesh(double start, double end, int n_elements, std::span<const double> required = {});

}   // namespace livens
