// SPDX-License-Identifier: BSD-3-Clause
// The distance of a motion and a finer one at element ends, body by body and joint by joint: the estimated
// error of theory.md, "The estimated error". What laws did unseen is added as kicks that go on ("Looks at
// laws").
#include "livens/diagnostics/estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "livens/base/elementary.h"
#include "livens/diagnostics/largest.h"
#include "livens/multibody/model.h"
#include "livens/solvers/patience.h"

namespace livens {

namespace {

/// Of both sides of an instant: [f, t / length] of one joint less a share of another's.
double norm_of(const JointSample& one, const JointSample& other, double share, double length)
{
    double forces = 0, torques = 0;
    const auto add = [&](const Reaction& a, const Reaction& b) {
        for (int i = 0; i < 3; ++i) {
            const double f = a.force[i] - share * b.force[i], t = a.torque[i] - share * b.torque[i];
            forces += f * f, torques += t * t;
        }
    };
    add(one.left, other.left);
    add(one.right, other.right);
    return std::sqrt(0.5 * (forces + torques / (length * length)));
}

double digits_of(double error)
{
    return std::clamp(-logarithm(error) / std::numbers::ln10, 0.0, 16.0);   // nan stays nan
}

}   // namespace

ErrorMeter::ErrorMeter(const Model& model, const Motion& motion) : model_(model), motion_(motion)
{
    estimate_.n_bodies = model.n_bodies();
    estimate_.length = model.length();
    estimate_.largest = 0;
    estimate_.largest_reaction = 0;
}

void ErrorMeter::reach(int end)
{
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    const std::size_t so_far = estimate_.position.size() / static_cast<std::size_t>(estimate_.n_bodies);
    const auto ends = std::max(so_far, static_cast<std::size_t>(end) + 1);
    // Room for all at once: doubled while they grow, they would be what a long motion takes most for.
    const auto all = std::max(ends, static_cast<std::size_t>(motion_.n_elements()) + 1);
    for (auto* errors : {&estimate_.position, &estimate_.orientation, &estimate_.velocity}) {
        errors->reserve(all * static_cast<std::size_t>(estimate_.n_bodies));
        errors->resize(ends * static_cast<std::size_t>(estimate_.n_bodies), unknown);
    }
    estimate_.reaction.reserve(all * static_cast<std::size_t>(estimate_.n_joints));
    estimate_.reaction.resize(ends * static_cast<std::size_t>(estimate_.n_joints), unknown);
}

void ErrorMeter::compare(const Motion& finer, int first, int last)
{
    estimate_.n_joints = motion_.end_multipliers.empty() ? 0 : static_cast<int>(model_.joints().size());
    reach(last);
    std::vector<int> missing;
    const JointSampler joints(model_, motion_), finer_joints(model_, finer);
    State a, b;
    std::vector<JointSample> held, other_held;
    for (int end = first; end <= last; ++end) {
        Patience::ask();
        // Compared at ends that both have; where laws bend each has its own instant, and the error there is
        // that of the neighbours.
        const int there = element_end_at(finer.mesh, motion_.mesh.ends[end]);
        if (there < 0) {
            missing.push_back(end);
            continue;
        }
        motion_.at_end(end, Side::right, a);
        finer.at_end(there, Side::right, b);
        compare_states(end, a, b);
        if (estimate_.n_joints == 0 || finer.end_multipliers.empty()) continue;
        // where a piece begins or ends, the other side is that of another one
        const bool begins = end == first && first > 0, ends = end == last && last < motion_.n_elements();
        joints.forces_at(end, a, held);
        finer_joints.forces_at(there, b, other_held);
        compare_reactions(end, held, other_held, begins ? Side::right : ends ? Side::left : Side::middle);
    }
    for (auto end = missing.rbegin(); end != missing.rend(); ++end) fill(*end);   // the one behind is known
    if (!missing.empty() && missing.back() == last)   // nothing is known of how the other one ends
        estimate_.position[static_cast<std::size_t>(last * estimate_.n_bodies)] =
            std::numeric_limits<double>::infinity();
    estimate_.find_largest(motion_.mesh);
}

/// An end that the other motion has not gets the larger error of its neighbours; fmax() takes the one that is
/// known where one is not.
void ErrorMeter::fill(int end)
{
    if (end == 0 || end + 1 >= static_cast<int>(motion_.mesh.ends.size())) return;
    const auto of = [end](std::vector<double>& errors, int n) {
        for (int k = 0; k < n; ++k) {
            const auto at = static_cast<std::size_t>(end * n + k), step = static_cast<std::size_t>(n);
            if (at + step < errors.size()) errors[at] = std::fmax(errors[at - step], errors[at + step]);
        }
    };
    of(estimate_.position, estimate_.n_bodies);
    of(estimate_.orientation, estimate_.n_bodies);
    of(estimate_.velocity, estimate_.n_bodies);
    of(estimate_.reaction, estimate_.n_joints);
}

/// Where places were given both motions have the same: there, what their velocities differ by moves them over
/// the element before.
void ErrorMeter::compare_states(int end, const State& a, const State& b)
{
    const bool is_given = std::ranges::find(given_places_, end) != given_places_.end();
    const double time = is_given ? motion_.mesh.length(std::max(end - 1, 0)) : 0;
    for (int k = 0; k < estimate_.n_bodies; ++k) {
        const BodyGap gap = gap_between(a, b, model_.bodies()[k], k, estimate_.length);
        const auto at = static_cast<std::size_t>(end * estimate_.n_bodies + k);
        estimate_.position[at] = std::max(gap.position, gap.velocity * time / estimate_.length);
        estimate_.orientation[at] = std::max(gap.orientation, gap.rate * time);
        estimate_.velocity[at] = gap.velocity;
    }
}

void ErrorMeter::compare_reactions(int end, std::vector<JointSample>& a, std::vector<JointSample>& b,
                                   Side side)
{
    for (std::size_t j = 0; j < a.size(); ++j) {
        if (!a[j].is_bounded || !b[j].is_bounded) continue;   // no number stands for it
        for (JointSample* one : {&a[j], &b[j]}) {
            if (side == Side::left) one->right = one->left;
            if (side == Side::right) one->left = one->right;
        }
        double& error = estimate_.reaction[static_cast<std::size_t>(end * estimate_.n_joints) + j];
        const double gap = gap_between(a[j], b[j], estimate_.length);
        // Two pieces meet at one end: the larger error of both sides stays.
        error = side != Side::middle && error > gap ? error : gap;
        raise_to(estimate_.largest_reaction, size_of(a[j], estimate_.length));
    }
}

void ErrorMeter::add(const std::vector<Unseen>& unseen, int first, int last)
{
    const auto n = static_cast<std::size_t>(estimate_.n_bodies);
    shifts_.resize(n);
    turns_.resize(n);
    std::size_t next = 0;
    for (int end = first + 1; end <= last; ++end) {
        const double t = motion_.mesh.ends[static_cast<std::size_t>(end)];
        for (; next < unseen.size() && unseen[next].t <= t; ++next) {
            const Unseen& one = unseen[next];
            const double since = one.t - one.duration, kick = one.error / one.duration;
            for (std::size_t b = 0; b < n; ++b) {
                // A kick moves a body as long as the motion lasts: shift = rate (t - since), kept as two sums
                // so that all kicks cost one pass.
                shifts_[b].rate += one.shift[b], shifts_[b].moment += one.shift[b] * since;
                turns_[b].rate += one.turn[b], turns_[b].moment += one.turn[b] * since;
            }
            if (!(kick > largest_kick_)) continue;
            largest_kick_ = kick;
            estimate_.unseen_load = one.load;
            estimate_.unseen_time = one.t;
        }
        for (std::size_t b = 0; b < n; ++b) {
            const std::size_t at = static_cast<std::size_t>(end) * n + b;
            const double speed = model_.bodies()[b].state_speed;   // of states, which are velocities
            const double shift = speed > 0 ? shifts_[b].rate * estimate_.length / speed
                                           : shifts_[b].rate * t - shifts_[b].moment,
                         turn = turns_[b].rate * t - turns_[b].moment;
            estimate_.position[at] += shift;
            estimate_.orientation[at] += turn;
            estimate_.velocity[at] += shifts_[b].rate * estimate_.length;
            raise_to(estimate_.unseen, std::max(shift, turn));
        }
    }
    estimate_.find_largest(motion_.mesh);
}

ErrorEstimate ErrorMeter::take(int last)
{
    reach(last);
    const double size = estimate_.largest_reaction;
    for (double& error : estimate_.reaction) error = size > 0 ? error / size : 0;
    if (estimate_.n_joints == 0) estimate_.largest_reaction = std::numeric_limits<double>::quiet_NaN();
    return std::move(estimate_);
}

double ErrorEstimate::error(int end) const
{
    double worst = 0;
    const auto n = static_cast<std::size_t>(n_bodies), first = static_cast<std::size_t>(end) * n;
    for (std::size_t i = first; i < first + n; ++i) {
        raise_to(worst, position[i]);
        raise_to(worst, orientation[i]);
    }
    return worst;
}

BodyGap gap_between(const State& a, const State& b, const Body& body, int index, double length)
{
    const double *X = a.X[index].a, *other_X = b.X[index].a, *V = a.V[index].a, *other_V = b.V[index].a;
    // Of states: by their size, and where the body has come to means nothing.
    if (body.holds_states()) {
        const double speed = norm(Vector3{V[0] - other_V[0], V[1] - other_V[1], V[2] - other_V[2]});
        return {speed / body.state_speed, 0, speed, 0};
    }
    Vector3 shift{}, push{};   // of the centre of mass
    double turn = 0, spin = 0;
    for (int c = 0; c < 4; ++c) {
        const double share = c == 0 ? 1 : body.mass(c, 0) / body.mass(0, 0);
        for (int i = 0; i < 3; ++i) {
            const double dx = X[3 * c + i] - other_X[3 * c + i], dv = V[3 * c + i] - other_V[3 * c + i];
            shift[i] += share * dx, push[i] += share * dv;
            if (c > 0) turn += dx * dx, spin += dv * dv;
        }
    }
    // the chord of a turn by phi is 2 sqrt(2) sin(phi / 2)
    // and sum_i |w x d_i|^2 = 2 w^2
    const double chord = std::sqrt(turn / 8);
    return {norm(shift) / length, chord > 1 ? std::numbers::pi : 2 * arc_sine(chord), norm(push),
            std::sqrt(spin / 2)};
}

double gap_between(const JointSample& a, const JointSample& b, double length)
{
    return norm_of(a, b, 1, length);
}

double size_of(const JointSample& joint, double length) { return norm_of(joint, joint, 0, length); }

void ErrorEstimate::find_largest(const TimeMesh& mesh)
{
    std::size_t compared = position.size();   // what a finer motion did not reach says nothing
    while (compared > 0 && std::isnan(position[compared - 1])) --compared;
    largest = compared > 0 ? 0 : std::numeric_limits<double>::quiet_NaN();
    for (std::size_t i = 0; i < compared; ++i)
        for (const double error : {position[i], orientation[i]})
            if (raise_to(largest, error)) {
                time = mesh.ends[i / static_cast<std::size_t>(n_bodies)];
                body = static_cast<int>(i % static_cast<std::size_t>(n_bodies));
            }
}

double ErrorEstimate::digits() const { return digits_of(largest); }

ErrorEstimate::Good ErrorEstimate::good(const TimeMesh& mesh) const
{
    Good best{0, mesh.end()};
    double error = 0;
    for (int end = 0; end < static_cast<int>(mesh.ends.size()); ++end) {
        raise_to(error, this->error(end));
        const Good here{std::floor(digits_of(error)), mesh.ends[end]};
        // Digits times the time for which they hold: the largest product says most in one sentence.
        const double said = here.digits * (here.until - mesh.start());
        if (said > 0 && said >= best.digits * (best.until - mesh.start())) best = here;
    }
    return best;
}

double ErrorEstimate::at(const std::vector<double>& errors, int n, int index, const TimeMesh& mesh, double t)
{
    if (errors.empty()) return std::numeric_limits<double>::quiet_NaN();
    const int end = element_end_at(mesh, t), first = end >= 0 ? end : mesh.element_at(t);
    double error = errors[static_cast<std::size_t>(first * n + index)];
    // Inside an element the larger error of its two ends stands.
    if (end < 0) raise_to(error, errors[static_cast<std::size_t>((first + 1) * n + index)]);
    return error;
}

}   // namespace livens
