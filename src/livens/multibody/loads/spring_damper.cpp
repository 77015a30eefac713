// SPDX-License-Identifier: BSD-3-Clause
// A spring and damper between two points: F = f (1, theta)^T with the pull f along the line (theory.md, "The
// law"). Where the ends meet, the direction of the pull turns round: that is the centre of theory.md, "Laws
// that bend".
#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/base/elementary.h"
#include "livens/multibody/loads/load_values.h"

namespace livens {

namespace {

/// The line from the first point to the second.
struct Line {
    Vector3 r{};       ///< m
    Vector3 w{};       ///< its rate, m/s
    Vector3 u{};       ///< direction; zero if the points coincide
    double l = 0;      ///< m
    double rate = 0;   ///< dl/dt, m/s
};

struct Spring {
    std::array<Vector4, 2> points;
    SpringDamper law;

    Line line(const LoadArguments& arguments) const
    {
        return line_of(arguments.X[1] * points[1] - arguments.X[0] * points[0],
                       arguments.V[1] * points[1] - arguments.V[0] * points[0]);
    }

    static Line line_of(const Vector3& r, const Vector3& w)
    {
        Line line{r, w, {}, 0, 0};
        line.l = hypotenuse(line.r[0], line.r[1], line.r[2]);
        if (line.l > 0)
            for (int i = 0; i < 3; ++i) line.u[i] = line.r[i] / line.l;
        line.rate = dot(line.u, line.w);
        return line;
    }

    /// The force is stiffness r + tension u: without free length a linear spring is smooth where the points
    /// meet, and with u = 0 there is no force where they coincide. The tension's slope is by l.
    struct Parts {
        double stiffness, tension, slope;
    };
    Parts parts(const Line& line) const
    {
        const double more = law.preload + law.damping * line.rate;
        if (!law.law) return {law.stiffness, more - law.stiffness * law.free_length, 0};
        const SpringValue spring = law.law(line.l - law.free_length);
        return {0, more + spring.force, spring.stiffness};
    }

    /// What pulls the first point towards the second.
    Vector3 pull(const Line& line) const
    {
        const Parts p = parts(line);
        return p.stiffness * line.r + p.tension * line.u;
    }

    void record(LoadTape& tape, TapeNumber factor) const
    {
        // From the second point to the first, which is no place of the world.
        const TapeVector r = tape.arm(0, points[0]) - tape.arm(1, points[1]);
        const auto pull = [&](TapeNumber s) {
            tape.pull(0, points[0], factor * -s, r);
            tape.pull(1, points[1], factor * s, r);
        };
        const bool is_tight = law.law || law.preload != 0 || law.damping != 0 || law.free_length != 0;
        if (!is_tight) return pull(tape.number(law.stiffness));
        const TapeNumber l = root(dot(r, r)), by_l = inverse(l);
        // By its elongation, which has fewer roundings; without free length it is smooth where the ends meet.
        const bool is_free = law.law || law.free_length != 0;
        TapeNumber tension = tape.number(law.preload);
        if (is_free) {
            const TapeNumber e = l - law.free_length;
            tension = tension + (law.law ? recorded(law.law, e) : law.stiffness * e);
            if (!law.law.bends.empty()) tape.watch_guard(e);
        }
        tape.watch_centre({r[0], r[1], r[2]});
        if (law.damping != 0) {
            const TapeVector w = tape.arm(0, points[0], true) - tape.arm(1, points[1], true);
            tension = tension + law.damping * (by_l * dot(r, w));
        }
        pull((is_free ? 0 : law.stiffness) + tension * by_l);
    }

    /// d pull / dr. At coinciding points: k I without tension, else none.
    Matrix3 pull_by_r(const Line& line) const
    {
        const Matrix3 I = identity<3>();
        const Parts p = parts(line);
        if (line.l == 0) return p.tension == 0 ? p.stiffness * I : Matrix3{};
        const Matrix3 along = outer(line.u, line.u), turn = (1 / line.l) * (I - along);   // du/dr
        return p.stiffness * I + p.tension * turn + p.slope * along +
               law.damping * outer(line.u, turn * line.w);
    }

    /// d pull / dw.
    Matrix3 pull_by_w(const Line& line) const { return law.damping * outer(line.u, line.u); }

    void forces(const LoadArguments& arguments, LoadForces& F) const
    {
        const Vector3 f = pull(line(arguments));
        F[0] = outer(f, points[0]);
        F[1] = -outer(f, points[1]);
    }

    void tangent(const LoadArguments& arguments, LoadTangent& tangent) const
    {
        const Line at = line(arguments);
        const Matrix3 by_r = pull_by_r(at), by_w = pull_by_w(at);
        for (int b = 0; b < 2; ++b)
            for (int c = 0; c < 2; ++c) {
                const double sign = b == c ? -1 : 1;   // the pull on b is +-f, r is +-X_c p_c
                for (int i = 0; i < 4; ++i)
                    for (int j = 0; j < 4; ++j) {
                        const double arms = sign * points[b][i] * points[c][j];
                        add_block(tangent.X[b][c], i, j, arms * by_r);
                        add_block(tangent.V[b][c], i, j, arms * by_w);
                    }
            }
    }

    /// The pull in world axes, by r and w.
    LawInside inside() const
    {
        LawInside inside;
        inside.n_numbers = 6;
        inside.n_factors = 3;
        inside.only_at_centre = true;
        inside.numbers = [*this](const LoadArguments& arguments, std::span<double> numbers) {
            const Line at = line(arguments);
            for (int k = 0; k < 3; ++k) {
                numbers[k] = at.r[k];
                numbers[3 + k] = at.w[k];
            }
        };
        inside.factors = [*this](Instant, std::span<const double> numbers, std::span<double> factors) {
            const Vector3 f =
                pull(line_of({numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]}));
            for (int k = 0; k < 3; ++k) factors[k] = f[k];
        };
        inside.unit = [*this](const LoadArguments&, std::size_t k, LoadForces& F) {
            Vector3 one{};
            one[static_cast<int>(k)] = 1;
            F[0] = outer(one, points[0]);
            F[1] = -outer(one, points[1]);
        };
        inside.steepest = [*this](const EnclosedValue&, std::span<const EnclosedValue> numbers,
                                  std::span<double> bounds) { bound_slopes(numbers, bounds); };
        return inside;
    }

    /// With the direction u of r, |d pull_k/ds| <= k |r_k'| + |tension| |u_k'| + |tension'| |u_k| and
    /// |u_k'| <= (|r_k'| + |r'| |u_k|) / |r|.
    void bound_slopes(std::span<const EnclosedValue> numbers, std::span<double> bounds) const
    {
        double least = 0, longest = 0, change = 0, speed = 0, speed_change = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const EnclosedValue &r = numbers[k], &w = numbers[3 + k];
            least += square(r.value).low, longest += square(r.value).high, change += square(r.slope).high;
            speed += square(w.value).high, speed_change += square(w.slope).high;
        }
        least = std::sqrt(least), longest = std::sqrt(longest), change = std::sqrt(change);
        speed = std::sqrt(speed), speed_change = std::sqrt(speed_change);
        // |du/ds| <= |r'| / |r|; where the ends may meet this is infinite, and the piece is halved.
        const double turn = change / least;
        double slope = 0;
        double tension = std::abs(law.preload) + law.damping * speed + law.stiffness * law.free_length;
        for (const double l : {least, 0.5 * (least + longest), longest}) {
            if (!law.law) break;
            const SpringValue at = law.law(l - law.free_length);
            slope = std::max(slope, std::abs(at.stiffness));
            tension = std::max(tension, std::abs(law.preload) + law.damping * speed + std::abs(at.force));
        }
        const double change_of_tension = slope * change + law.damping * (speed_change + speed * turn);
        for (std::size_t k = 0; k < 3; ++k) {
            const double r = numbers[k].value.size(), rate = numbers[k].slope.size();
            const double along = least > 0 ? std::min(1.0, r / least) : 1;
            bounds[k] =
                law.stiffness * rate + tension * (rate / least + turn * along) + change_of_tension * along;
        }
    }

    double potential(const LoadArguments& arguments) const
    {
        const double stretch = line(arguments).l - law.free_length;
        return law.preload * stretch +
               (law.law ? law.law(stretch).energy : 0.5 * law.stiffness * stretch * stretch);
    }

    double damper_power(const LoadArguments& arguments) const
    {
        const double rate = line(arguments).rate;
        return -law.damping * rate * rate;
    }
    TapeNumber recorded_power(LoadTape& tape) const
    {
        if (law.damping == 0) return tape.number(0);
        const TapeVector r = tape.arm(0, points[0]) - tape.arm(1, points[1]);
        const TapeVector w = tape.arm(0, points[0], true) - tape.arm(1, points[1], true);
        const TapeNumber rate = inverse(root(dot(r, r))) * dot(r, w);
        return -law.damping * (rate * rate);
    }
};

}   // namespace

Load spring_damper(const std::string& name, int first, const Vector3& point_first, int second,
                   const Vector3& point_second, const SpringDamper& spring)
{
    Spring law{{point(point_first), point(point_second)}, spring};
    const bool is_swapped = first == world;   // the load's first place is a body's
    if (is_swapped) {
        std::swap(first, second);
        std::swap(law.points[0], law.points[1]);
    }
    Load load = start_load(name, "spring_damper", {first, second});
    load.points = {is_swapped ? point_second : point_first, is_swapped ? point_first : point_second};
    check_load_vector(load, point_first, "the point on the first body");
    check_load_vector(load, point_second, "the point on the second body");
    check_not_negative(load, spring.stiffness, "stiffness");
    check_not_negative(load, spring.damping, "damping");
    check_not_negative(load, spring.free_length, "free_length");
    check_load_vector(load, {spring.preload, 0, 0}, "the preload");
    load.depends_on_X = spring.stiffness > 0 || spring.damping > 0 || spring.preload != 0 || spring.law;
    load.depends_on_V = spring.damping > 0;
    for (int b = 0; b < 2; ++b)
        load.needs_directors[b] = law.points[b] != point({}) && load.bodies[b] != world;
    load.forces = [law](const LoadArguments& arguments, LoadForces& F) { law.forces(arguments, F); };
    load.forces.record = [law](LoadTape& tape, const TapeNumber& factor) { law.record(tape, factor); };
    load.tangent = [law](const LoadArguments& arguments, LoadTangent& tangent) {
        law.tangent(arguments, tangent);
    };
    if (!spring.law.bends.empty()) {
        load.guards = {{spring.law.bends}};
        load.guarded = [law](const LoadArguments& arguments, std::span<double> e) {
            e[0] = law.line(arguments).l - law.law.free_length;
        };
    }
    load.inside = law.inside();
    // the force turns round where the points meet, unless it is linear in the way between them
    if (spring.free_length > 0 || spring.damping > 0 || spring.preload != 0 || spring.law) {
        load.centre = [law](const LoadArguments& arguments) { return law.line(arguments).r; };
        load.is_smooth = false;
        load.bends_at_centre = spring.free_length > 0 || spring.preload != 0 || spring.law;
    }
    load.potential = [law](const LoadArguments& arguments) { return law.potential(arguments); };
    load.power = [law](const LoadArguments& arguments) { return law.damper_power(arguments); };
    load.recorded_power = [law](LoadTape& tape) { return law.recorded_power(tape); };
    load.readings = {
        {"force", "N",
         [law](const LoadArguments& arguments) {
             const Line line = law.line(arguments);
             return dot(law.pull(line), line.u);
         }},
        {"length", "m", [law](const LoadArguments& arguments) { return law.line(arguments).l; }}};
    return load;
}

}   // namespace livens
