// SPDX-License-Identifier: BSD-3-Clause
// livens diff: how far two runs are from each other.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <unistd.h>

#include "commands.h"
#include "console.h"
#include "failure.h"
#include "finite_number.h"
#include "livens/base/elementary.h"
#include "livens/diagnostics/sample.h"
#include "livens/io/results.h"
#include "summary.h"

namespace livens::program {

namespace {

struct Quantity {
    const char* name;
    const char* key;
    const char* unit;
};
constexpr std::array quantities{
    Quantity{"position", "position", "m"}, Quantity{"orientation", "orientation", "rad"},
    Quantity{"velocity", "velocity", "m/s"}, Quantity{"angular velocity", "angular_velocity", "rad/s"}};
constexpr std::size_t n_quantities = quantities.size();

/// The largest difference of one quantity of one body.
struct Largest {
    double difference = 0;
    double time = 0;      ///< when, s
    double size = 0;      ///< of the quantity itself in the first run; of an orientation 1 rad
    double allowed = 0;   ///< atol + rtol * size
    bool is_same() const { return difference <= allowed; }   // false for nan
};

struct Comparison {
    std::vector<double> times;                                ///< common output times
    std::vector<std::string> bodies;                          ///< in both runs
    std::vector<std::array<Largest, n_quantities>> largest;   ///< of these
    std::vector<std::string> alone;                           ///< bodies of one run
    bool is_same() const
    {
        return alone.empty() && std::ranges::all_of(largest, [](const auto& body) {
                   return std::ranges::all_of(body, &Largest::is_same);
               });
    }
};

/// Angle between two triads, exact also where it is small: |Q1 - Q2| = 2 sqrt(2) sin(angle / 2) (Frobenius).
double angle_between(const Matrix3& first, const Matrix3& second)
{
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
        const Vector3 difference = first.column(i) - second.column(i);
        sum += dot(difference, difference);
    }
    return 2 * arc_sine(std::min(1.0, std::sqrt(sum / 8)));
}

/// A difference that is not a number is larger than any other, and stays.
void note_difference(Largest& largest, double difference, double size, double t)
{
    largest.size = std::max(largest.size, size);
    if (std::isnan(largest.difference) || difference <= largest.difference) return;
    largest.difference = difference;
    largest.time = t;
}

Matrix3 triad_of(const BodySample& s) { return directors_from_quaternion(s.quaternion); }

void compare(std::array<Largest, n_quantities>& largest, const BodySample& a, const BodySample& b,
             bool is_point, double t)
{
    note_difference(largest[0], norm(a.position - b.position), norm(a.position), t);
    if (!is_point) note_difference(largest[1], angle_between(triad_of(a), triad_of(b)), 1, t);
    note_difference(largest[2], norm(a.velocity - b.velocity), norm(a.velocity), t);
    if (!is_point)
        note_difference(largest[3], norm(a.angular_velocity - b.angular_velocity), norm(a.angular_velocity),
                        t);
}

/// Output times of both, equal to rounding; those beyond the motion that was found are none.
std::vector<double> common_times(const Run& a, const Run& b)
{
    std::vector<double> times;
    std::size_t j = 0;
    const double first = std::max(a.motion.start(), b.motion.start());
    for (const double t : a.output) {
        const double tolerance = 1e-12 * std::max({1.0, std::abs(t), std::abs(a.motion.start())});
        while (j < b.output.size() && b.output[j] < t - tolerance) ++j;
        if (j == b.output.size()) break;
        const double last = std::min(a.motion.end(), b.motion.end()) + tolerance;
        if (b.output[j] <= t + tolerance && t >= first - tolerance && t <= last) times.push_back(t);
    }
    return times;
}

std::size_t place_of(const std::vector<std::string>& names, const std::string& name)
{
    return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
}

Comparison compare(const DiffArguments& arguments, const Run& a, const Run& b)
{
    const double rtol = finite_number(arguments.rtol, "--rtol", "a number");
    const double atol = finite_number(arguments.atol, "--atol", "a number");
    if (rtol < 0 || atol < 0) throw failure(exit_usage, "tolerances must not be negative");
    Comparison c;
    c.times = common_times(a, b);
    if (c.times.empty()) throw failure(exit_usage, "the two runs have no output time in common");
    for (const std::string& name : a.told_bodies())
        (place_of(b.body_names, name) < b.body_names.size() ? c.bodies : c.alone).push_back(name);
    for (const std::string& name : b.told_bodies())
        if (place_of(a.body_names, name) == a.body_names.size()) c.alone.push_back(name);
    const Model first = scenario_of_run(a, arguments.first).model;
    const Model second = scenario_of_run(b, arguments.second).model;
    c.largest.resize(c.bodies.size());
    for (const double t : c.times) {
        const auto within = [&](const Motion& m) { return std::clamp(t, m.start(), m.end()); };
        const std::vector<BodySample> of_a = sample_bodies(first, a.motion, within(a.motion));
        const std::vector<BodySample> of_b = sample_bodies(second, b.motion, within(b.motion));
        for (std::size_t i = 0; i < c.bodies.size(); ++i) {
            const std::size_t in_a = place_of(a.body_names, c.bodies[i]),
                              in_b = place_of(b.body_names, c.bodies[i]);
            compare(c.largest[i], of_a[in_a], of_b[in_b], a.body_is_point[in_a] || b.body_is_point[in_b], t);
        }
    }
    for (auto& body : c.largest)
        for (Largest& l : body) l.allowed = atol + rtol * l.size;
    return c;
}

std::string json_of(const Comparison& c)
{
    JsonWriter json(2);
    json.begin_object();
    json.member("same", c.is_same()).member("exit_code", c.is_same() ? exit_ok : exit_different);
    json.member("output_times", c.times.size());
    json.member("start", c.times.front()).member("end", c.times.back());
    json.key("bodies").begin_array();
    for (std::size_t i = 0; i < c.bodies.size(); ++i) {
        json.begin_object().member("name", c.bodies[i]);
        for (std::size_t q = 0; q < n_quantities; ++q) {
            const Largest& l = c.largest[i][q];
            json.key(quantities[q].key).begin_object();
            json.member("difference", l.difference).member("time", l.time);
            json.member("allowed", l.allowed).member("unit", quantities[q].unit).end_object();
        }
        json.end_object();
    }
    json.end_array();
    json.key("only_in_one").begin_array();
    for (const std::string& name : c.alone) json.value(name);
    json.end_array().end_object();
    return json.text() + "\n";
}

std::string words_of(const std::array<Largest, n_quantities>& body)
{
    std::string text;
    for (std::size_t q = 0; q < n_quantities; ++q) {
        const Largest& l = body[q];
        if (l.difference == 0) continue;
        text += (text.empty() ? "" : "; ") +
                fmt::format("{} {:.1e} {}", quantities[q].name, l.difference, quantities[q].unit);
        text += fmt::format(" at {:.6g} s", l.time);
    }
    return text.empty() ? "equal" : text;
}

void show(const Comparison& c, const Run& a, const Run& b)
{
    Summary summary(terminal_of(STDOUT_FILENO));
    const auto n_differing = std::ranges::count_if(
        c.largest, [](const auto& body) { return !std::ranges::all_of(body, &Largest::is_same); });
    if (c.is_same())
        summary.headline(Ink::good, "Same", "all differences are within the tolerance");
    else if (n_differing == 0)
        summary.headline(Ink::bad, "Different", "the runs do not have the same bodies");
    else
        summary.headline(Ink::bad, "Different",
                         fmt::format("{} of {} bodies beyond the tolerance", n_differing, c.bodies.size()));
    summary.figure("compared",
                   fmt::format("{} output times, {:.6g} s to {:.6g} s, of {} and {}", c.times.size(),
                               c.times.front(), c.times.back(), a.output.size(), b.output.size()));
    for (std::size_t i = 0; i < c.bodies.size(); ++i)
        summary.figure(plain(c.bodies[i]), words_of(c.largest[i]));
    for (const std::string& name : c.alone) summary.figure(plain(name), "is in only one of the runs");
    print(summary.text());
}

}   // namespace

int diff_command(const DiffArguments& arguments, const Common& common)
{
    const Run a = read_run(arguments.first), b = read_run(arguments.second);
    const Comparison c = compare(arguments, a, b);
    if (common.json)
        print(json_of(c));
    else if (!common.quiet)
        show(c, a, b);
    return c.is_same() ? exit_ok : exit_different;
}

}   // namespace livens::program
