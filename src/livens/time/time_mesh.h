// SPDX-License-Identifier: BSD-3-Clause
// The division of time into elements.
#pragma once

#include <span>
#include <variant>
#include <vector>

namespace [[gnu::visibility("default")]] livens {

/// A side of an instant: loads that jump in time have two values there.
enum class Side { left = -1, middle = 0, right = 1 };

struct Instant {
    double t = 0;
    Side side = Side::middle;
};

/// Of the whole time: instants that are closer are one.
inline constexpr double nearest_ends = 1e-9;
/// Takes 0.8 GB of element ends; more is a slip of the pen.
inline constexpr double most_elements = 100'000'000;

/// Element e spans [ends[e], ends[e + 1]]; ends ascend strictly.
struct TimeMesh {
    std::vector<double> ends;
    /// Of these, the ones that must stay where they are beside the first and the last; ascending.
    std::vector<double> required{};
    /// Of these, where a law bends or jumps (docs/theory.md, "Laws that bend"); ascending.
    std::vector<double> bends{};

    int n_elements() const { return static_cast<int>(ends.size()) - 1; }
    double start() const { return ends.front(); }
    double end() const { return ends.back(); }
    double length(int element) const { return ends[element + 1] - ends[element]; }
    /// The element that contains t: the one that starts there at an element end, except at the last.
    int element_at(double t) const;
};

/// A time whose elements are found while it is solved, such that the motion is as accurate as is asked for.
struct Span {
    double start = 0, end = 1;   ///< s
    /// Largest error of the positions of centres of mass, in lengths of the model, and of orientations, in
    /// rad, at element ends; 0 < accuracy <= 0.1.
    double accuracy = 1e-6;
    std::vector<double> output{};   ///< s; they become element ends
    double first_length = 0;        ///< s, of elements like those before; 0: there were none
};

/// Elements that are given, or an accuracy from which they follow.
using Time = std::variant<TimeMesh, Span>;

double start_of(const Time& time);
double end_of(const Time& time);

/// Those of the instants inside the time of a mesh that no element end is near, within 1e-9 of the whole
/// time.
std::vector<double> missed(const TimeMesh& mesh, std::span<const double> instants);

/// At least `n_elements` of equal length between `start` and `end`, and every required instant inside an
/// element end.
///
/// Required instants (jumps of loads, output times) outside the interval are left out. Between two of them
/// lie max(1, ceil(length / h)) equal elements with h = (end - start) / n_elements, so a mesh whose required
/// instants fall on its grid has n_elements. Instants closer than 1e-9 (end - start) are one: the first in
/// `required` wins. `start` and `end` win over all. Required instants are element ends to the bit, and those
/// of the mesh that must stay. Throws
/// InputError: end not after start, n_elements < 1 or > 1e8, not finite, elements shorter than the spacing of
/// doubles.
TimeMesh make_time_mesh(double start, double end, int n_elements, std::span<const double> required = {});

}   // namespace gnu::visibility("default")]]livens
