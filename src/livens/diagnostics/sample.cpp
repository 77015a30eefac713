// SPDX-License-Identifier: BSD-3-Clause
// Samples of a motion at any instant: bodies with orthonormal triads, momenta, reactions of joints on both
// sides. Which orders hold at ends and between is said in theory.md, "The element" and "Element ends".
#include "livens/diagnostics/sample.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/dynamics/instant/reactions.h"
#include "livens/dynamics/rows/rank.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/multibody/body.h"

namespace livens {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::vector<double> field_at(const Field& field, const TimeMesh& mesh, double t)
{
    const int element = mesh.element_at(t);
    std::vector<double> values(static_cast<std::size_t>(field.n_values));
    field.evaluate(element, (t - mesh.ends[element]) / mesh.length(element), 0, values);
    return values;
}

std::vector<Matrix34> momenta_at(const Model& model, const Motion& motion, const State& state)
{
    std::vector<Matrix34> P(static_cast<std::size_t>(motion.n_bodies));
    const int end = element_end_at(motion.mesh, state.t);
    if (end >= 0) {
        std::copy_n(motion.momenta.begin() + end * motion.n_bodies, motion.n_bodies, P.begin());
    } else if (!motion.P.empty()) {
        const std::vector<double> values = field_at(motion.P, motion.mesh, state.t);
        for (int b = 0; b < motion.n_bodies; ++b) std::copy_n(values.begin() + 12 * b, 12, P[b].data());
    } else {
        for (int b = 0; b < motion.n_bodies; ++b) P[b] = state.V[b] * model.bodies()[b].mass;
    }
    return P;
}

}   // namespace

double snap_to_element_end(const TimeMesh& mesh, double t)
{
    const double spread = std::max(std::abs(mesh.start()), std::abs(mesh.end()));
    // An instant that was computed from an element end may be off it by rounding; the end itself has the
    // better state.
    const double rounding = 8 * std::numeric_limits<double>::epsilon() * spread;
    if (!(t >= mesh.start() - rounding && t <= mesh.end() + rounding))
        throw InputError({"time-outside", "", "the motion is not known at this instant", to_text(t),
                          to_text(mesh.start()) + " to " + to_text(mesh.end()), "", ""});
    const auto after = std::ranges::lower_bound(mesh.ends, t);
    double nearest = after == mesh.ends.end() ? mesh.ends.back() : *after;
    if (after != mesh.ends.begin() && std::abs(*std::prev(after) - t) < std::abs(nearest - t))
        nearest = *std::prev(after);
    return std::abs(nearest - t) <= rounding ? nearest : t;
}

int element_end_at(const TimeMesh& mesh, double t)
{
    const auto end = std::ranges::lower_bound(mesh.ends, t);
    return end != mesh.ends.end() && *end == t ? static_cast<int>(end - mesh.ends.begin()) : -1;
}

BodySample sample_body(const Body& body, const Matrix34& X, const Matrix34& V, const Matrix34& P)
{
    BodySample s;
    s.position = X.column(0);
    s.velocity = V.column(0);
    s.linear_momentum = P.column(0);
    if (body.is_point) {
        s.center_of_mass = s.position;
        s.angular_momentum = cross(s.position, s.linear_momentum);
        for (Matrix3* triad : {&s.directors, &s.directors_raw}) std::fill_n(triad->data(), 9, nan);
        s.quaternion = {nan, nan, nan, nan};
        s.angular_velocity = s.angular_velocity_body = {nan, nan, nan};
        return s;
    }
    // Between nodes directors are rigid to O(h^(p+1)) only; what is told as an orientation is a rotation.
    const Matrix3 triad = project_directors(directors(X));
    s.quaternion = quaternion_from_directors(triad);
    const Matrix34 rigid = configuration(s.position, triad);
    s.center_of_mass = rigid * point(mass_properties(body.mass).center_of_mass);
    s.angular_velocity = angular_velocity(rigid, V);
    s.angular_velocity_body = transpose(triad) * s.angular_velocity;
    s.directors_raw = directors(X);
    s.directors = triad;
    if (is_skew(body)) {
        s.directors_raw = s.directors_raw * body.stretch;
        s.directors = triad * body.stretch;
        s.angular_velocity_body = inverse(body.stretch) * s.angular_velocity_body;
    }
    // With the directors of the motion, not the projected ones: the balance is that of the motion.
    s.angular_momentum = angular_momentum(std::span(&X, 1), std::span(&P, 1));
    return s;
}

std::vector<double> node_times(const Field& field, const TimeMesh& mesh)
{
    const std::vector<double> s = field.basis().nodes();
    std::vector<double> times;
    for (int e = 0; e < mesh.n_elements(); ++e)
        for (std::size_t a = field.continuous && e > 0 ? 1 : 0; a < s.size(); ++a)
            times.push_back(s[a] == 1 ? mesh.ends[e + 1] : mesh.ends[e] + s[a] * mesh.length(e));
    if (times.empty()) times.push_back(mesh.start());   // a motion that has only its start
    return times;
}

State sample_state(const Motion& motion, double t)
{
    t = snap_to_element_end(motion.mesh, t);
    if (motion.n_elements() > 0) return motion.at(t);
    State state;
    state.t = motion.start();
    for (int b = 0; b < motion.n_bodies; ++b) {
        Matrix34 X{};
        std::copy_n(motion.X.values.begin() + 12 * b, 12, X.data());
        state.X.push_back(X);
        state.V.push_back(motion.velocities[b]);
    }
    return state;
}

std::vector<BodySample> sample_bodies(const Model& model, const Motion& motion, double t)
{
    const State state = sample_state(motion, t);
    const std::vector<Matrix34> P = momenta_at(model, motion, state);
    std::vector<BodySample> samples;
    samples.reserve(P.size());
    for (int b = 0; b < motion.n_bodies; ++b)
        samples.push_back(sample_body(model.bodies()[b], state.X[b], state.V[b], P[b]));
    return samples;
}

namespace {

constexpr Reaction unknown{{nan, nan, nan}, {nan, nan, nan}};

/// Joints all of whose multipliers are numbers.
std::vector<bool> bounded_joints(const Model& model, std::span<const double> left,
                                 std::span<const double> right)
{
    std::vector<bool> is_bounded(model.joints().size(), true);
    for (int r = 0; r < model.n_rows(); ++r)
        if (std::isnan(left[r]) || std::isnan(right[r])) is_bounded[model.row_joint(r)] = false;
    return is_bounded;
}

/// One after the other, without what is no number, which would spread to all joints of a loop.
std::vector<double> numbers_of(std::span<const double> left, std::span<const double> right)
{
    std::vector<double> numbers;
    numbers.reserve(left.size() + right.size());
    for (const std::span<const double> side : {left, right})
        for (const double value : side) numbers.push_back(std::isnan(value) ? 0 : value);
    return numbers;
}

/// Of multipliers on both sides of an instant; rows that are not independent make reactions that are not
/// unique.
std::vector<JointSample> reactions_of(const Model& model, const State& state, std::span<const double> left,
                                      std::span<const double> right, std::span<const int> independent)
{
    std::optional<Model> frozen_now;
    if (model.has_drives()) frozen_now = frozen(model, {state.t});
    const Model& now = frozen_now ? *frozen_now : model;
    const std::vector<bool> is_bounded = bounded_joints(model, left, right);
    std::vector<double> both = numbers_of(left, right);
    std::vector<bool> is_unique(model.joints().size(), true);
    std::vector<SharedComponents> shared(model.joints().size(), SharedComponents{});
    if (static_cast<int>(independent.size()) < model.n_rows()) {
        UniqueReactions least = least_reactions(now, state.X, both, independent);
        both = std::move(least.multipliers);
        is_unique = std::move(least.joint_is_unique);
        shared = std::move(least.shared);
    }
    const std::span<const double> before(both.data(), left.size()),
        after(both.data() + left.size(), right.size());
    const bool jumps = !std::ranges::equal(before, after);
    std::vector<JointSample> samples;
    samples.reserve(model.joints().size());
    for (int j = 0; j < static_cast<int>(model.joints().size()); ++j) {
        JointSample& sample = samples.emplace_back();
        sample.is_unique = is_unique[j];
        sample.shared = shared[j];
        sample.is_bounded = is_bounded[j];
        sample.left = sample.right = unknown;
        if (!sample.is_bounded) continue;
        sample.left = joint_reaction(now, j, state.X, before);
        sample.right = jumps ? joint_reaction(now, j, state.X, after) : sample.left;
    }
    return samples;
}

/// Those that nobody dropped.
std::vector<int> kept_rows(const Model& model, const Motion& motion)
{
    std::vector<int> independent = all_rows(model);
    std::erase_if(independent, [&](int row) {
        return std::ranges::find(motion.redundant_rows, row) != motion.redundant_rows.end();
    });
    return independent;
}

/// The same of the joints alone that act around `beside`; others do nothing.
std::vector<JointSample> reactions_beside(const Model& model, const Motion& motion, const State& state,
                                          std::span<const double> multipliers, double beside)
{
    const ActingModel acting = acting_at(model, beside);
    std::vector<double> lambda;
    for (const int row : acting.rows) lambda.push_back(multipliers[row]);
    std::vector<int> independent = all_rows(acting.model);
    if (!motion.redundant_rows.empty())
        independent = row_rank(frozen(acting.model, {state.t}), state.X, independent).independent;
    const std::vector<JointSample> found = reactions_of(acting.model, state, lambda, lambda, independent);
    JointSample nothing;
    nothing.is_unique = nothing.is_bounded = true;
    std::vector<JointSample> samples(model.joints().size(), nothing);
    for (std::size_t i = 0; i < found.size(); ++i) samples[acting.joints[i]] = found[i];
    return samples;
}

/// Marks joints without a reaction inside an element: where rows lose rank that are independent at its start,
/// those that take part, without which fewer are lost.
void forget_unbounded(const Model& model, const Motion& motion, const State& state,
                      std::vector<JointSample>& samples)
{
    constexpr double lost = 1e-4;   // docs/theory.md, "Singular positions"
    const ActingModel acting = acting_at(model, state.t);
    const State start = motion.at_end(motion.mesh.element_at(state.t));
    const std::vector<int> rows =
        row_rank(frozen(acting.model, {start.t}), start.X, all_rows(acting.model)).independent;
    const Model now = frozen(acting.model, {state.t});
    const auto n_lost = [&](const State& at, const std::vector<int>& some) {
        return row_rank(now, at.X, some, lost).dependent.size();
    };
    const std::size_t n = n_lost(state, rows);
    // Rows that are dependent at the start of the element as well are redundant, not lost.
    if (n <= n_lost(start, rows)) return;
    for (int j = 0; j < static_cast<int>(acting.model.joints().size()); ++j) {
        std::vector<int> others = rows;
        std::erase_if(others, [&](int row) { return acting.model.row_joint(row) == j; });
        if (n_lost(state, others) == n) continue;
        JointSample& sample = samples[acting.joints[j]];
        sample.is_bounded = false;
        sample.left = sample.right = unknown;
    }
}

/// Inside the element before or after an element end, or around another instant.
double beside(const Motion& motion, double t, int end, Side side)
{
    if (end < 0) return t;
    const int element = std::clamp(side == Side::left ? end - 1 : end, 0, motion.n_elements() - 1);
    // Events are element ends, so the middle of an element has the joints that act all over it.
    return motion.mesh.ends[element] + 0.5 * motion.mesh.length(element);
}

}   // namespace

std::vector<JointSample> sample_joints(const Model& model, const Motion& motion, double t)
{
    const State state = sample_state(motion, t);
    const int end = element_end_at(motion.mesh, state.t);
    // Ends have multipliers of order 2p from the equations of motion; inside, those of the nodes are
    // interpolated, of order p.
    const bool is_acceleration_level = end >= 0 && !motion.end_multipliers.empty();
    if (!is_acceleration_level && (motion.multipliers.empty() || motion.n_elements() == 0)) return {};

    std::vector<double> interpolated;
    std::span<const double> left, right;
    if (is_acceleration_level) {
        const std::span<const double> all(motion.end_multipliers);
        const std::size_t n = static_cast<std::size_t>(motion.n_rows);
        left = all.subspan(2 * static_cast<std::size_t>(end) * n, n);
        right = all.subspan((2 * static_cast<std::size_t>(end) + 1) * n, n);
    } else {
        interpolated = field_at(motion.multipliers, motion.mesh, state.t);
        left = right = interpolated;
    }
    std::vector<JointSample> samples;
    if (!model.has_events())
        samples = reactions_of(model, state, left, right, kept_rows(model, motion));
    else {
        samples = reactions_beside(model, motion, state, left, beside(motion, state.t, end, Side::left));
        const std::vector<JointSample> after =
            reactions_beside(model, motion, state, right, beside(motion, state.t, end, Side::right));
        for (std::size_t j = 0; j < samples.size(); ++j) {
            samples[j].right = after[j].right;
            samples[j].is_unique = samples[j].is_unique && after[j].is_unique;
            for (std::size_t i = 0; i < 6; ++i) samples[j].shared[i] |= after[j].shared[i];
            samples[j].is_bounded = samples[j].is_bounded && after[j].is_bounded;
        }
    }
    if (end < 0) forget_unbounded(model, motion, state, samples);
    for (JointSample& sample : samples) sample.is_acceleration_level = is_acceleration_level;
    return samples;
}

}   // namespace livens
