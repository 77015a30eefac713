// SPDX-License-Identifier: BSD-3-Clause
// Samples of a motion at any instant: bodies with orthonormal triads, and momenta. Which orders hold at ends
// and between is said in theory.md, "The element" and "Element ends".
#include "livens/diagnostics/sample.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/diagnostics/detail/sampler.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/multibody/body.h"
#include "livens/multibody/model.h"

namespace livens {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

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
    for (int b = 0; b < motion.n_bodies; ++b)
        if (model.bodies()[b].holds_states()) P[b] = {};
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
    const double M = body.mass(0, 0);   // m (1, 0) = M (1, theta)
    s.center_of_mass = rigid * point({body.mass(1, 0) / M, body.mass(2, 0) / M, body.mass(3, 0) / M});
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
    return sample_bodies(model, motion, sample_state(motion, t));
}

std::vector<BodySample> sample_bodies(const Model& model, const Motion& motion, const State& state)
{
    const std::vector<Matrix34> P = momenta_at(model, motion, state);
    std::vector<BodySample> samples;
    samples.reserve(P.size());
    for (int b = 0; b < motion.n_bodies; ++b)
        samples.push_back(sample_body(model.bodies()[b], state.X[b], state.V[b], P[b]));
    return samples;
}

}   // namespace livens
