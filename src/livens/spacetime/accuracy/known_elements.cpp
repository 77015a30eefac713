// SPDX-License-Identifier: BSD-3-Clause
// Where a neighbour's nodes are: the known motion, and how it was beside that goes on as a polynomial
// (docs/theory.md, "The horizon", What it costs).
#include "livens/spacetime/accuracy/known_elements.h"

#include <algorithm>
#include <utility>

#include "livens/multibody/body.h"

namespace livens {

namespace {

constexpr double longest_beside = 3;     // times the element before, which then says nothing
constexpr double sine_in_plane = 1e-8;   // of axes of turning: rounding

}   // namespace

KnownElements::KnownElements(const Motion& motion, const ModelTables& tables, const ElementRule& rule,
                             const lanes::Functions* functions)
    : motion_(motion), tables_(tables)
{
    if (functions == nullptr) return;
    nodes_ = ReferencePredictor(motion, tables, rule, *functions);
    past_ = Extrapolation(rule, *functions);
    layout_.degree = rule.degree;
    layout_.points = rule.points;
    const std::size_t n = 7 * tables.bodies.size() * functions->width;
    for (AlignedDoubles* places : {&place_, &before_, &foreseen_, &other_}) places->assign(n, 0.0);
    change_.assign(static_cast<std::size_t>(tables.n_twists), 0.0);
    spins_.resize(tables.bodies.size());
}

/// Into an element that is much longer than the one before, its polynomial would be followed too far.
void KnownElements::open(int element)
{
    const double start = motion_.mesh.ends[element], end = motion_.mesh.ends[element + 1];
    const bool goes_on = element > 0 && element_ == element - 1;
    is_behind_last_ = goes_on;
    element_ = element;
    if (is_behind_last_) {
        std::swap(place_, before_);
        start_before_ = layout_.times[0];
        is_behind_last_ = end - start <= longest_beside * (start - start_before_);
    }
    layout_.times = {start, end};
    const std::size_t n = motion_.load_angles.size() / motion_.mesh.ends.size();
    const auto angles = motion_.load_angles.begin() + static_cast<std::ptrdiff_t>(n) * element;
    layout_.angles.assign(angles, angles + static_cast<std::ptrdiff_t>(n));
    nodes_.place(layout_, place_.data());
    if (is_behind_last_) {
        past_.remember(before_.data(), tables_.n_bodies(), start_before_, start);
        past_.place(end - start, foreseen_.data());
    }
    look_at_spins(goes_on);
}

void KnownElements::look_at_spins(bool goes_on)
{
    turns_in_space_ = false;
    const int n_bodies = tables_.n_bodies();
    for (int b = 0; b < n_bodies; ++b) {
        const BodyTable& body = tables_.bodies[b];
        if (body.dofs == 3) continue;
        const auto spin = [&](int end) {   // triads are orthonormal to rounding
            const auto place = static_cast<std::ptrdiff_t>(motion_.X.degree * end) * motion_.X.n_values;
            const double *X = motion_.X.values.data() + place + 12 * b,
                         *V = motion_.velocities[static_cast<std::size_t>(end * n_bodies + b)].a;
            Vector3 twice{};
            for (int c = 3; c < 12; c += 3)
                for (int i = 0, j = 1, k = 2; i < 3; ++i, j = (j + 1) % 3, k = (k + 1) % 3)
                    twice[i] += X[c + j] * V[c + k] - X[c + k] * V[c + j];
            return 0.5 * twice;
        };
        const Vector3 w = goes_on ? spins_[static_cast<std::size_t>(b)] : spin(element_),
                      next = spin(element_ + 1), by = next - w;
        spins_[static_cast<std::size_t>(b)] = next;
        turns_in_space_ = turns_in_space_ || norm(cross(w, by)) > sine_in_plane * norm(w) * norm(by);
        for (int i = 0; i < 3; ++i) change_[body.first + 3 + i] = by[i];
    }
}

/// Where the motion is, and what the neighbour's polynomial of the element before says more than the motion's
/// own one: what both miss alike drops out.
void KnownElements::guess(const double* apart, double* place)
{
    const std::size_t n = place_.size();
    if (apart == nullptr) {
        std::ranges::copy(place_, place);
        return;
    }
    for (std::size_t i = 0; i < n; ++i) other_[i] = before_[i] + apart[i];
    past_.remember(other_.data(), tables_.n_bodies(), start_before_, layout_.times[0]);
    past_.place(layout_.h(0), place);
    for (std::size_t i = 0; i < n; ++i) place[i] += place_[i] - foreseen_[i];
}

void KnownElements::guess_mirrored(const double* apart, double* place) const
{
    for (std::size_t i = 0; i < place_.size(); ++i) place[i] = place_[i] - apart[i];
}

}   // namespace livens
