// SPDX-License-Identifier: BSD-3-Clause
// The motion of solved elements: nodes and one-sided multipliers, and at ends of elements velocity, momentum,
// and accelerations and reactions on both sides of a jump (docs/theory.md, "Element ends"). X'' has the
// centripetal part w x (w x d_a) beside that of the twist's derivative.
#include "livens/spacetime/nodal/record.h"

#include <algorithm>
#include <array>
#include <limits>

#include "livens/dynamics/instant/instant.h"
#include "livens/multibody/model.h"

namespace livens {

Record::Record(const ModelTables& tables, const TimeMesh& mesh, const ElementRule& rule)
    : tables_(tables), mesh_(mesh), degree_(rule.degree), first_(std::numeric_limits<int>::max()), last_(-1)
{
    Motion& m = motion_;
    m.n_bodies = tables.n_bodies();
    m.n_rows = tables.model->n_rows();
    m.X = {12 * m.n_bodies, degree_, true, {}, {}, rule.points};
    m.multipliers = {m.n_rows, degree_, false, {}, {}, rule.points};
    m.order_at_ends = rule.points == Points::lobatto ? 2 * degree_ : 2 * degree_ - 1;
    m.dense_order_X = degree_ + 1;
    m.dense_order_V = degree_;
    m.constraints_hold = ConstraintsHold::at_nodes;
    if (rule.points == Points::lobatto) m.gauss_points = degree_;
    for_arrays([e = static_cast<std::size_t>(mesh.n_elements())](
                   auto& values, std::size_t n, std::size_t more) { values.reserve(e * n + more); });
}

/// Every array of the motion, with how many numbers (or columns) an element has in it, and an end more.
template <class Action>
void Record::for_arrays(Action&& action)
{
    Motion& m = motion_;
    const std::size_t p = degree_, bodies = m.n_bodies, rows = m.n_rows, angles = tables_.loads.turns.size();
    action(m.X.values, p * 12 * bodies, 12 * bodies);
    action(m.multipliers.values, (p + 1) * rows, 0);
    action(m.velocities, bodies, bodies);
    action(m.momenta, bodies, bodies);
    action(m.accelerations, 2 * bodies, 2 * bodies);
    action(m.end_multipliers, 2 * rows, 2 * rows);
    action(m.load_angles, angles, angles);
}

namespace {

/// Zeros up to so many entries: copied, since a loop that writes them takes ten times the instructions.
template <class T>
void extend(std::vector<T>& values, std::size_t n)
{
    static constexpr std::array<T, (std::size_t{1} << 12) / sizeof(T)> zeros{};
    while (values.size() < n)
        values.insert(values.end(), zeros.begin(), zeros.begin() + std::min(n - values.size(), zeros.size()));
}

/// Room for `n` entries at `first`. A march forwards writes one behind the other and touches its memory as it
/// goes: much is not written twice, and little is made room for ahead, since arrays may be longer than what
/// was written; some pages of it are, which are still near when they are written. What is small grows fast.
template <class T>
[[gnu::noinline]] void make_room(std::vector<T>& values, std::size_t first, std::size_t n)
{
    constexpr std::size_t near = std::size_t{1} << 14, small = std::size_t{1} << 16;   // bytes
    const std::size_t few = 8 * n, times = first * sizeof(T) < small ? 4 : 2,
                      ahead = std::max(times * first, first + few);
    if (values.capacity() < first + n) values.reserve(ahead);
    extend(values, std::min({ahead, first + std::max(few, near / sizeof(T)), values.capacity()}));
}

void put(std::vector<double>& values, int place, std::size_t n, const double* from)
{
    constexpr std::size_t much = 64;
    const std::size_t first = static_cast<std::size_t>(place) * n;
    if (n >= much && first == values.size()) {
        values.insert(values.end(), from, from + n);
        return;
    }
    if (values.size() < first + n) make_room(values, first, n);
    std::copy_n(from, n, values.data() + first);
}

/// 12 numbers a body.
void put(std::vector<Matrix34>& values, int place, std::size_t bodies, const double* from)
{
    const std::size_t first = static_cast<std::size_t>(place) * bodies;
    if (values.size() < first + bodies) make_room(values, first, bodies);
    std::copy_n(from, 12 * bodies, values[first].a);
}

}   // namespace

void Record::divided(int element)
{
    if (last_ <= element) return;   // in a march forwards nothing is behind it
    for_arrays([e = static_cast<std::size_t>(element)](auto& values, std::size_t n, std::size_t more) {
        const std::size_t at = e * n + more;
        values.resize(std::max(values.size(), at));   // against time some are empty up to here
        values.insert(values.begin() + static_cast<std::ptrdiff_t>(at), n, {});
    });
    ++first_, ++last_;
}

void Record::begin_anew()
{
    for_arrays([](auto& values, std::size_t, std::size_t) { values.clear(); });
    first_ = std::numeric_limits<int>::max();
    last_ = -1;
}

void Record::make_room(int first, int last)
{
    for_arrays([e = static_cast<std::size_t>(last)](auto& values, std::size_t n, std::size_t more) {
        if (values.size() < e * n + more) values.resize(e * n + more);
    });
    first_ = std::min(first_, first);
    last_ = std::max(last_, last);
}

void Record::node(int element, int A, const double* X)
{
    put(motion_.X.values, motion_.X.index(element, A), static_cast<std::size_t>(motion_.X.n_values), X);
}

void Record::multipliers(int element, int A, const double* lambda)
{
    put(motion_.multipliers.values, motion_.multipliers.index(element, A),
        static_cast<std::size_t>(motion_.n_rows), lambda);
}

void Record::end(int place, const InstantState& state, const InstantSystem& system, bool two_sided,
                 std::span<double> work)
{
    Motion& m = motion_;
    const auto bodies = static_cast<std::size_t>(m.n_bodies), rows = static_cast<std::size_t>(m.n_rows);
    if (place < first_) first_ = place;   // not where there is room, and others write as well
    if (place > last_) last_ = place;
    node(std::min(place, mesh_.n_elements() - 1), place < mesh_.n_elements() ? 0 : degree_, state.X.data());
    if (!state.angles.empty()) put(m.load_angles, place, state.angles.size(), state.angles.data());
    const double *V = system.rates(), *turn = system.centripetal();
    tables_.bodies.times_mass(V, 1.0, work.data());
    put(m.velocities, place, bodies, V);
    put(m.momenta, place, bodies, work.data());
    for (int side = 0; side < 2; ++side) {
        if (side == 0 || two_sided) {
            // X'' = [a, alpha x d + w x (w x d)]
            tables_.bodies.rates_of(state.X.data(), state.acceleration[side].data(), work.data());
            double* __restrict A = work.data();
            for (std::size_t i = 0; i < work.size(); ++i) A[i] += turn[i];
        }
        put(m.accelerations, 2 * place + side, bodies, work.data());
        put(m.end_multipliers, 2 * place + side, rows, state.multipliers[side].data());
    }
}

void Record::forget_reactions(int place, std::span<const int> rows)
{
    for (int side = 0; side < 2; ++side)
        for (const int row : rows)
            motion_.end_multipliers[(2 * place + side) * motion_.n_rows + row] =
                std::numeric_limits<double>::quiet_NaN();
}

const Motion& Record::so_far()
{
    motion_.mesh.ends.assign(mesh_.ends.begin(), mesh_.ends.begin() + last_ + 1);
    motion_.mesh.bends = mesh_.bends;
    // sizes tell how many there are
    for_arrays([e = static_cast<std::size_t>(std::max(last_, 0))](
                   auto& values, std::size_t n, std::size_t more) { values.resize(e * n + more); });
    return motion_;
}

/// Nothing was solved: the start alone, without what only a solved element would tell.
void Record::only(const State& start)
{
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    Motion& m = motion_;
    for_arrays([](auto& values, std::size_t, std::size_t more) { values.assign(more, {}); });
    first_ = last_ = 0;
    std::copy_n(start.X.front().a, m.X.n_values, m.X.values.begin());
    m.velocities = start.V;
    tables_.bodies.times_mass(start.V.front().a, 1.0, m.momenta.front().a);
    std::ranges::fill(m.end_multipliers, unknown);
}

Motion Record::take(const State& start)
{
    if (last_ < first_) only(start);
    motion_.mesh.ends.assign(mesh_.ends.begin() + first_, mesh_.ends.begin() + last_ + 1);
    motion_.mesh.bends = mesh_.bends;
    for_arrays([this](auto& values, std::size_t n, std::size_t more) {
        values.resize(last_ * n + more);
        values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(first_ * n));
    });
    return std::move(motion_);
}

}   // namespace livens
