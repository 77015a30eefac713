// SPDX-License-Identifier: BSD-3-Clause
// From one place to another along the coordinates: theory.md, "States in coordinates". In a tree each
// coordinate moves what is behind it along a screw that is fixed before it, so that one step of screws,
// outermost first, goes the whole way; loops are led in small steps, each closed by Newton's iteration.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "livens/base/elementary.h"
#include "livens/base/text.h"
#include "livens/dynamics/coordinates/mechanism.h"
#include "livens/dynamics/rows/rank.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/multibody/body.h"
#include "livens/multibody/displacement.h"
#include "livens/solvers/factors.h"

namespace livens::inline dynamics_internal {

namespace {

using Of = GeneralisedCoordinate::Of;

constexpr double way_step = 0.1;   // of a coordinate, rad or lengths of the model
constexpr int way_halvings = 12;
constexpr double most_turns = 1000;       // which are counted in steps
constexpr double farthest_turned = 1e6;   // of a body, by all coordinates, rad: likewise
constexpr double most_lengths = 1e12;     // at once: more leaves few digits
constexpr double rows_closed = 1e-9;      // |Phi| / scale
constexpr double screws_closed = 1e-6;    // likewise where screws lead: far ways carry rounding along
constexpr double newton_settled = 1e-9;   // a step of Newton's after which the next is below rounding
constexpr double most_corrected = 0.3;    // by Newton's iteration, of a step: more may be another branch
// A way that ends as near as this where rows close to this, is at a dead centre.
constexpr double turning_near = 1e-4, turning = 1e-6;
constexpr double joints_well_held = 1e-4;   // smallest pivot of rows beside which a coordinate is to blame
constexpr double most_moved = 1e6;          // of a body by a coordinate: rad or lengths, by the same

void displace_bodies(const Mechanism& mechanism, std::span<const double> twists, Configuration& X)
{
    for (int b = 0; b < mechanism.model.n_bodies(); ++b) {
        const BodyTable& body = mechanism.bodies[b];
        double moved[6] = {0, 0, 0, 0, 0, 0}, change[12];
        std::copy_n(twists.begin() + body.first, body.dofs, moved);
        twist::displacement(moved, X[b].a, change);
        for (int i = 0; i < (body.dofs == 6 ? 12 : 3); ++i) X[b].a[i] += change[i];
        if (body.dofs == 3) continue;
        const Matrix3 D = directors(X[b]);   // what rounding has added to it is taken off
        X[b] = configuration(X[b].column(0), 0.5 * (D * (3.0 * identity<3>() - transpose(D) * D)));
    }
}

/// Puts bodies onto the rows of joints and the numbers. Returns how far they moved; infinite where it does
/// not close.
double close_at(const Mechanism& mechanism, const std::vector<int>& rows, std::span<const double> numbers,
                Configuration& X)
{
    constexpr double never = std::numeric_limits<double>::infinity();
    constexpr int most = 8;
    double moved = 0;
    for (int i = 0; i < most; ++i) {
        const CoordinateSystem system(mechanism, X, rows);
        if (!system.is_regular()) return never;
        const std::vector<double> values = joint_values(mechanism.model, X);
        std::vector<double> wanted;
        for (const int r : rows) wanted.push_back(-values[r]);
        const std::vector<double> left = mechanism.way_to(X, numbers);
        wanted.insert(wanted.end(), left.begin(), left.end());
        const std::vector<double> twists = system.twists(wanted);
        const double size = mechanism.size_of_twists(twists);
        if (!(size < 10)) return never;
        displace_bodies(mechanism, twists, X);
        moved += size;
        if (size <= newton_settled) return mechanism.open(X) <= rows_closed ? moved : never;
    }
    return never;
}

/// Whether it is one of a ball joint's three angles, two of which are one where the second is 90 degrees.
bool is_of_three_angles(const Mechanism& mechanism, const std::string& name)
{
    for (const Joint& joint : mechanism.model.joints())
        for (const NamedCoordinate& q : joint.coordinates)
            if (joint.name + "." + q.name == name)
                return q.coordinate.kind == CoordinateKind::outer_angle ||
                       q.coordinate.kind == CoordinateKind::arc_sine;
    return false;
}

Complaint why_singular(const Mechanism& mechanism, int coordinate)
{
    const std::string name = coordinate < 0 ? "" : mechanism.coordinates[coordinate].name;
    if (is_of_three_angles(mechanism, name))
        return {"coordinates-singular",
                "q[" + name + "]",
                "'" + name + "' is one of three angles of a ball joint, of which two are one in this state",
                "",
                "",
                "",
                "keep the second angle away from 90 degrees, or take other 'angles' of the joint, such as "
                "\"yxz\""};
    const std::string what =
        coordinate < 0
            ? "the joints hold less in this state than beside it: it is a singular position"
            : "coordinate '" + name +
                  "' does not tell how the mechanism moves on in this state, which is a dead centre "
                  "of it";
    return {"coordinates-singular",
            coordinate < 0 ? "q" : "q[" + name + "]",
            what,
            "",
            "",
            "",
            coordinate < 0
                ? "give a state beside it"
                : "give another coordinate of the same loop instead, such as that of the crank, or a "
                  "state beside it"};
}

/// Twists by rates at a place that is closed, or why there is none.
std::optional<Complaint> settle_at(const Mechanism& mechanism, Placed& at)
{
    std::vector<int> rows = row_rank(mechanism.model, at.X, all_rows(mechanism.model)).independent;
    if (static_cast<int>(rows.size()) != mechanism.rank) return why_singular(mechanism, -1);
    at.system = std::make_shared<const CoordinateSystem>(mechanism, at.X, std::move(rows));
    if (!at.system->is_regular()) return why_singular(mechanism, mechanism.coordinates.empty() ? -1 : 0);
    at.by_rates = at.system->twists_by_rates();
    int rate = 0;
    for (int i = 0; i < static_cast<int>(mechanism.coordinates.size()); ++i)
        for (int k = 0; k < mechanism.coordinates[i].n_rates(); ++k, ++rate)
            if (!(mechanism.size_of_twists(at.by_rates.column(rate)) * mechanism.unit_of(i) < most_moved))
                return why_singular(mechanism, i);
    return {};
}

void settle_or_throw(const Mechanism& mechanism, Placed& at)
{
    if (std::optional<Complaint> why = settle_at(mechanism, at)) throw InputError(std::move(*why));
}

/// What counts its turns goes on to where the bodies are, each angle the shorter way.
void follow_turns(const Mechanism& mechanism, const Configuration& X, Placed& at)
{
    if (!mechanism.loads.turns.empty()) mechanism.loads.turns.follow(X, at.angles);
    for (std::size_t i = 0; i < at.counted.size(); ++i) {
        const JointCoordinate& q = mechanism.counted[i].coordinate;
        const double value = mechanism.counted[i].at_stated + coordinate_change(q, mechanism.stated, X);
        at.counted[i] = q.counts_turns() ? turned_to(value, at.counted[i]) : value;
    }
}

/// The whole way at once, where screws lead there; else nothing.
std::shared_ptr<Placed> led_at_once(const Mechanism& mechanism, const Placed& from,
                                    std::span<const double> way, std::span<const double> numbers)
{
    auto there = std::make_shared<Placed>();
    there->X = along_screws(mechanism, from, way, 1);
    if (!(mechanism.open(there->X) <= screws_closed)) return nullptr;
    if (!(close_at(mechanism, from.system->rows(), numbers, there->X) <= screws_closed)) return nullptr;
    there->numbers.assign(numbers.begin(), numbers.end());
    there->angles = from.angles;
    there->counted = from.counted;
    const double farthest = mechanism.farthest_turn(from.by_rates, way);
    const int n = static_cast<int>(std::ceil(farthest / 2));
    for (int i = 1; i < n; ++i)
        follow_turns(mechanism, along_screws(mechanism, from, way, static_cast<double>(i) / n), *there);
    follow_turns(mechanism, there->X, *there);
    return there;
}

/// One step along the screws, closed; nothing where that fails or leads elsewhere.
std::shared_ptr<Placed> led_a_step(const Mechanism& mechanism, const Placed& from,
                                   std::span<const double> way, std::vector<double> numbers)
{
    auto there = std::make_shared<Placed>();
    there->X = along_screws(mechanism, from, way, 1);
    std::vector<double> twists(static_cast<std::size_t>(mechanism.bodies.n_twists()), 0.0);
    for (int k = 0; k < mechanism.n_rates; ++k) add_scaled(twists, way[k], from.by_rates.column(k));
    const double foretold = mechanism.size_of_twists(twists);
    const double corrected = close_at(mechanism, from.system->rows(), numbers, there->X);
    if (!(foretold < 1 && corrected <= most_corrected * foretold + rows_closed)) return nullptr;
    there->numbers = std::move(numbers);
    there->angles = from.angles;
    there->counted = from.counted;
    follow_turns(mechanism, there->X, *there);
    return there;
}

/// The coordinate by which something moves most.
int farthest_moving(const Mechanism& mechanism, const Placed& at)
{
    int found = -1, rate = 0;
    double largest = 0;
    for (int i = 0; i < static_cast<int>(mechanism.coordinates.size()); ++i)
        for (int k = 0; k < mechanism.coordinates[i].n_rates(); ++k, ++rate) {
            const double size = mechanism.size_of_twists(at.by_rates.column(rate)) * mechanism.unit_of(i);
            if (size > largest) largest = size, found = i;
        }
    return found;
}

/// As near as joints come to closing where the coordinates are as wanted.
Configuration nearly_closed(const Mechanism& mechanism, const Placed& last, std::span<const double> numbers)
{
    constexpr double weight = 1e3;   // of a coordinate beside a row
    Configuration X = last.X;
    const std::vector<int> rows = all_rows(mechanism.model);
    const int n = mechanism.bodies.n_twists(), m = static_cast<int>(rows.size()) + mechanism.n_rates;
    for (int i = 0; i < 60; ++i) {
        const CoordinateSystem system(mechanism, X, rows);
        const std::vector<double> values = joint_values(mechanism.model, X),
                                  left = mechanism.way_to(X, numbers);
        DenseMatrix A = system.entries();
        std::vector<double> b;
        for (const int r : rows) b.push_back(-values[r] * system.scale(r));
        for (int k = 0; k < mechanism.n_rates; ++k) {
            const int row = static_cast<int>(rows.size()) + k;
            b.push_back(weight * left[k] * system.scale(row));
            for (int c = 0; c < n; ++c) A(row, c) *= weight;
        }
        DenseMatrix damped(m + n, n);   // steps of half a radian at most
        damped.set_rows(0, A);
        for (int c = 0; c < n; ++c) damped(m + c, c) = 1e-3;
        b.resize(static_cast<std::size_t>(m + n), 0.0);
        std::vector<double> twists = PivotedQR(damped).solve(b);
        for (const BodyTable& body : mechanism.bodies)
            for (int k = 3; k < body.dofs; ++k) twists[body.first + k] /= mechanism.length;
        const double size = mechanism.size_of_twists(twists);
        if (!std::isfinite(size)) break;
        if (size > 0.2)
            for (double& one : twists) one *= 0.2 / size;
        displace_bodies(mechanism, twists, X);
        if (size < 1e-10) break;
    }
    return X;
}

/// "crank.angle = 1.2, ..": of those that were to move.
std::string where_it_ends(const Mechanism& mechanism, const Placed& last, std::span<const double> way)
{
    std::string where;
    std::size_t number = 0, rate = 0;
    for (const GeneralisedCoordinate& c : mechanism.coordinates) {
        if (c.of != Of::turn && std::abs(way[rate]) > 0)
            where += (where.empty() ? "" : ", ") + c.name + " = " + to_text(last.numbers[number], 6);
        number += static_cast<std::size_t>(c.n_numbers());
        rate += static_cast<std::size_t>(c.n_rates());
    }
    return where.empty() ? "a part of the way" : where;
}

Complaint why_open(const Mechanism& mechanism, const Placed& last, std::span<const double> numbers)
{
    int row = 0;
    const Configuration X = nearly_closed(mechanism, last, numbers);
    const double open = mechanism.open(X, &row);
    const std::vector<double> way = mechanism.way(last.numbers, numbers);
    const std::string where = "the mechanism can be led to " + where_it_ends(mechanism, last, way);
    const std::string help = "give coordinates that the joints admit, or place the bodies nearer to them";
    const int turning_back = farthest_moving(mechanism, last);
    if (open <= turning && mechanism.size_of(way) < turning_near) {
        const RowRank held = row_rank(mechanism.model, X, all_rows(mechanism.model));
        const bool joints_hold = static_cast<int>(held.independent.size()) == mechanism.rank &&
                                 held.smallest_pivot > joints_well_held;
        return why_singular(mechanism, joints_hold ? turning_back : -1);
    }
    if (open <= rows_closed)
        return {"loop-open",
                "q[" + mechanism.coordinates[turning_back].name + "]",
                "no way along the joints leads to this state from where the bodies are placed",
                "",
                "",
                where,
                help};
    return {"loop-open",
            "joint[" + mechanism.model.joints()[mechanism.model.row_joint(row)].name + "]",
            "the loop does not close: " + mechanism.model.row_name(row) + " stays open",
            "violation " + to_text(open * mechanism.model.row(row).scale, 4),
            "",
            where,
            help};
}

}   // namespace

Placed placed_at_start(const Mechanism& mechanism)
{
    Placed placed;
    placed.X = mechanism.placed.X;
    placed.numbers = mechanism.numbers;
    placed.angles = mechanism.loads.turns.begin(mechanism.placed);
    for (const NamedCoordinate& q : mechanism.counted) placed.counted.push_back(q.at_stated);
    follow_turns(mechanism, placed.X, placed);
    settle_or_throw(mechanism, placed);
    return placed;
}

std::shared_ptr<Placed> led_nearby(const Mechanism& mechanism, const Placed& from,
                                   std::span<const double> numbers)
{
    const std::vector<double> way = mechanism.way(from.numbers, numbers);
    std::shared_ptr<Placed> there = led_a_step(mechanism, from, way, {numbers.begin(), numbers.end()});
    if (there != nullptr && settle_at(mechanism, *there)) return nullptr;
    return there;
}

namespace {

/// The numbers of `to` for bodies, of `from` for joints.
std::vector<double> of_bodies(const Mechanism& mechanism, std::span<const double> from,
                              std::span<const double> to)
{
    std::vector<double> numbers(from.begin(), from.end());
    std::size_t k = 0;
    for (const GeneralisedCoordinate& c : mechanism.coordinates)
        for (int i = 0; i < c.n_numbers(); ++i, ++k)
            if (c.of != Of::joint) numbers[k] = to[k];
    return numbers;
}

/// Throws where a coordinate goes farther than by `turns` or `lengths` of the model.
void refuse_far(const Mechanism& mechanism, std::span<const double> way, double turns, double lengths)
{
    int rate = 0;
    for (int i = 0; i < static_cast<int>(mechanism.coordinates.size()); ++i) {
        const std::string& name = mechanism.coordinates[i].name;
        const double most =
            mechanism.is_length(i) ? lengths * mechanism.length : turns * 2 * std::numbers::pi;
        for (int k = 0; k < mechanism.coordinates[i].n_rates(); ++k, ++rate)
            if (!(std::abs(way[rate]) <= most))
                throw InputError({"coordinate-value", "q[" + name + "]",
                                  "coordinate '" + name + "' is too far from where the bodies are placed",
                                  to_text(way[rate], 3), to_text(most, 3), "",
                                  "place the bodies nearer to the state, or leave whole turns out"});
    }
}

/// In steps, each as long as the rows close by it and little is corrected.
Placed led_in_steps(const Mechanism& mechanism, Placed here, std::span<const double> numbers)
{
    const std::vector<double> from = here.numbers, way = mechanism.way(from, numbers);
    refuse_far(mechanism, way, most_turns, most_turns);
    const double whole = 1 / std::max(1.0, std::ceil(mechanism.size_of(way) / way_step));
    double length = whole, done = 0;
    std::optional<Complaint> why;
    while (done < 1) {
        const double next = std::min(1.0, done + length);
        std::vector<double> part(way.size());
        for (std::size_t k = 0; k < way.size(); ++k) part[k] = (next - done) * way[k];
        std::vector<double> there =
            next == 1 ? std::vector<double>(numbers.begin(), numbers.end()) : mechanism.gone(from, way, next);
        std::shared_ptr<Placed> led = led_a_step(mechanism, here, part, std::move(there));
        if (led != nullptr) why = settle_at(mechanism, *led);   // one on the way is stepped over
        if (led != nullptr && !why) {
            here = std::move(*led);
            done = next;
            length = std::min(whole, 2 * length);
            continue;
        }
        length /= 2;
        if (length < std::ldexp(whole, -way_halvings))
            throw InputError(why ? std::move(*why) : why_open(mechanism, here, numbers));
    }
    return here;
}

}   // namespace

Placed lead(const Mechanism& mechanism, const Placed& from, std::span<const double> numbers)
{
    const std::vector<double> way = mechanism.way(from.numbers, numbers);
    if (std::ranges::all_of(way, [](double one) { return one == 0; })) return from;
    mechanism.refuse_half_turns(numbers);
    refuse_far(mechanism, way, most_turns, most_lengths);
    if (!(mechanism.farthest_turn(from.by_rates, way) <= farthest_turned))
        throw InputError({"coordinate-value", "q", "bodies turn too far from where they are placed", "",
                          to_text(farthest_turned, 3) + " rad in all", "", "leave whole turns out"});
    if (std::shared_ptr<Placed> there = led_at_once(mechanism, from, way, numbers)) {
        settle_or_throw(mechanism, *there);
        return *there;
    }
    // Bodies that joints leave free take all that hangs on them along, however far.
    const std::vector<double> first = of_bodies(mechanism, from.numbers, numbers);
    std::shared_ptr<Placed> moved = led_at_once(mechanism, from, mechanism.way(from.numbers, first), first);
    if (moved == nullptr || settle_at(mechanism, *moved)) return led_in_steps(mechanism, from, numbers);
    return led_in_steps(mechanism, std::move(*moved), numbers);
}

}   // namespace livens::inline dynamics_internal
