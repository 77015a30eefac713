// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/nodal/record.h"

#include <algorithm>
#include <limits>

#include "livens/dynamics/instant/instant.h"

namespace livens {

Record::Record(const Tables& tables, const TimeMesh& mesh, const ElementRule& rule)
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
    m.constraints_hold = "element nodes";
    if (rule.points == Points::lobatto) m.gauss_points = degree_;
    for_sizes(mesh.n_elements(), [](auto& values, std::size_t size) { values.reserve(size); });
    work_.assign(12 * static_cast<std::size_t>(m.n_bodies), 0.0);
}

/// Every array with its size up to an element end.
template <class Action>
void Record::for_sizes(int place, Action&& action)
{
    Motion& m = motion_;
    const auto n = static_cast<std::size_t>(place), p = static_cast<std::size_t>(degree_);
    const auto bodies = static_cast<std::size_t>(m.n_bodies), rows = static_cast<std::size_t>(m.n_rows);
    action(m.X.values, (n * p + 1) * 12 * bodies);
    action(m.multipliers.values, n * (p + 1) * rows);
    action(m.velocities, (n + 1) * bodies);
    action(m.momenta, (n + 1) * bodies);
    action(m.accelerations, 2 * (n + 1) * bodies);
    action(m.end_multipliers, 2 * (n + 1) * rows);
    action(m.load_angles, (n + 1) * tables_.loads.turns.size());
}

namespace {

/// Room for `n` entries at `first`. A march forwards writes one behind the other and touches its memory as it
/// goes: much is not written twice, and little is made room for ahead, since arrays may be longer than what
/// was written.
template <class T>
[[gnu::noinline]] void make_room(std::vector<T>& values, std::size_t first, std::size_t n)
{
    const std::size_t ahead = std::max(2 * first, first + 8 * n);
    values.resize(values.capacity() < first + n ? ahead : std::min(ahead, values.capacity()));
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
    Motion& m = motion_;
    const auto e = static_cast<std::size_t>(element), p = static_cast<std::size_t>(degree_);
    const auto bodies = static_cast<std::size_t>(m.n_bodies), rows = static_cast<std::size_t>(m.n_rows);
    const auto insert = [](auto& values, std::size_t at, std::size_t count) {
        values.resize(std::max(values.size(), at));   // against time some are empty up to here
        values.insert(values.begin() + static_cast<std::ptrdiff_t>(at), count, {});
    };
    insert(m.X.values, (e * p + 1) * 12 * bodies, p * 12 * bodies);
    insert(m.multipliers.values, e * (p + 1) * rows, (p + 1) * rows);
    insert(m.velocities, (e + 1) * bodies, bodies);
    insert(m.momenta, (e + 1) * bodies, bodies);
    insert(m.accelerations, 2 * (e + 1) * bodies, 2 * bodies);
    insert(m.end_multipliers, 2 * (e + 1) * rows, 2 * rows);
    insert(m.load_angles, (e + 1) * tables_.loads.turns.size(), tables_.loads.turns.size());
    ++first_, ++last_;
}

void Record::begin_anew()
{
    for_sizes(0, [](auto& values, std::size_t) { values.clear(); });
    first_ = std::numeric_limits<int>::max();
    last_ = -1;
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

void Record::end(int place, const InstantState& state, const InstantSystem& system, bool two_sided)
{
    Motion& m = motion_;
    const auto bodies = static_cast<std::size_t>(m.n_bodies), rows = static_cast<std::size_t>(m.n_rows);
    first_ = std::min(first_, place);
    last_ = std::max(last_, place);
    node(std::min(place, mesh_.n_elements() - 1), place < mesh_.n_elements() ? 0 : degree_, state.X.data());
    put(m.load_angles, place, state.angles.size(), state.angles.data());
    const double *V = system.rates(), *turn = system.centripetal();
    tables_.bodies.times_mass(V, 1.0, work_.data());
    put(m.velocities, place, bodies, V);
    put(m.momenta, place, bodies, work_.data());
    for (int side = 0; side < 2; ++side) {
        if (side == 0 || two_sided) {
            // X'' = [a, alpha x d + w x (w x d)]
            tables_.bodies.rates_of(state.X.data(), state.acceleration[side].data(), work_.data());
            double* __restrict A = work_.data();
            for (std::size_t i = 0; i < work_.size(); ++i) A[i] += turn[i];
        }
        put(m.accelerations, 2 * place + side, bodies, work_.data());
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

/// Keeps entries first..last - 1 of `stride` values each.
template <class T>
void Record::cut(std::vector<T>& values, std::size_t first, std::size_t last, std::size_t stride) const
{
    values.resize(last * stride);
    values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(first * stride));
}

const Motion& Record::so_far()
{
    motion_.mesh.ends.assign(mesh_.ends.begin(), mesh_.ends.begin() + last_ + 1);
    motion_.mesh.bends = mesh_.bends;
    // sizes tell how many there are
    for_sizes(std::max(last_, 0), [](auto& values, std::size_t size) { values.resize(size); });
    return motion_;
}

/// Nothing was solved: the start alone, without what only a solved element would tell.
void Record::only(const State& start)
{
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    Motion& m = motion_;
    for_sizes(0, [](auto& values, std::size_t size) { values.assign(size, {}); });
    first_ = last_ = 0;
    std::copy_n(start.X.front().a, m.X.n_values, m.X.values.begin());
    m.velocities = start.V;
    tables_.bodies.times_mass(start.V.front().a, 1.0, work_.data());
    std::copy_n(work_.data(), work_.size(), m.momenta.front().a);
    std::ranges::fill(m.end_multipliers, unknown);
}

Motion Record::take(const State& start)
{
    if (last_ < first_) only(start);
    Motion& m = motion_;
    const auto first = static_cast<std::size_t>(first_), last = static_cast<std::size_t>(last_);
    const auto p = static_cast<std::size_t>(degree_), bodies = static_cast<std::size_t>(m.n_bodies);
    const auto rows = static_cast<std::size_t>(m.n_rows);
    m.mesh.ends.assign(mesh_.ends.begin() + first_, mesh_.ends.begin() + last_ + 1);
    m.mesh.bends = mesh_.bends;
    cut(m.X.values, first * p, last * p + 1, 12 * bodies);
    cut(m.multipliers.values, first * (p + 1), last * (p + 1), rows);
    cut(m.velocities, first, last + 1, bodies);
    cut(m.momenta, first, last + 1, bodies);
    cut(m.accelerations, first, last + 1, 2 * bodies);
    cut(m.end_multipliers, first, last + 1, 2 * rows);
    cut(m.load_angles, first, last + 1, tables_.loads.turns.size());
    return std::move(motion_);
}

}   // namespace livens
