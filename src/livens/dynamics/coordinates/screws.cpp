// SPDX-License-Identifier: BSD-3-Clause
// Bodies along the screws that coordinates cause: theory.md, "States in coordinates".
#include <algorithm>
#include <cmath>
#include <functional>

#include "livens/base/elementary.h"
#include "livens/dynamics/coordinates/mechanism.h"
#include "livens/multibody/body.h"
#include "livens/multibody/displacement.h"

namespace livens::inline dynamics_internal {

namespace {

/// A body that goes along a screw: the twist of its reference point at `at`, times one.
Displacement along_screw(const Vector3& at, const Vector3& velocity, const Vector3& turn)
{
    const double angle = norm(turn);
    double first = 0.5, second = 1.0 / 6;   // (1 - cos a) / a^2, (a - sin a) / a^3
    // For small angles differences would lose digits: series to the sixth power of the angle.
    if (angle > 1e-2) {
        const SineCosine half = sine_cosine(0.5 * angle), whole = sine_cosine(angle);
        first = 2 * half.sine * half.sine / (angle * angle);
        second = (angle - whole.sine) / (angle * angle * angle);
    } else {
        const double a = angle * angle;
        first -= a * (1.0 / 24 - a * (1.0 / 720 - a / 40320));
        second -= a * (1.0 / 120 - a * (1.0 / 5040 - a / 362880));
    }
    const Vector3 across = cross(turn, velocity);
    const Vector3 shift = velocity + first * across + second * cross(turn, across);
    const Matrix3 rotation = directors_from_rotation_vector(turn);
    return {at + shift - rotation * at, rotation};
}

/// Coordinates with what moves most bodies first: outwards along a tree.
struct Screw {
    int rate = 0, n_rates = 1, n_moved = 0;
};
std::vector<Screw> screws_outwards(const Mechanism& mechanism, const DenseMatrix& by_rates)
{
    std::vector<Screw> screws;
    int rate = 0;
    for (const GeneralisedCoordinate& c : mechanism.coordinates) {
        Screw screw{rate, c.n_rates(), 0};
        rate += c.n_rates();
        for (const BodyTable& body : mechanism.bodies) {
            double size = 0;
            for (int k = 0; k < screw.n_rates; ++k)
                for (int i = 0; i < body.dofs; ++i)
                    size = std::max(size, std::abs(by_rates(body.first + i, screw.rate + k)));
            screw.n_moved += size > 1e-9 ? 1 : 0;
        }
        screws.push_back(screw);
    }
    std::ranges::stable_sort(screws, std::ranges::greater(), &Screw::n_moved);
    return screws;
}

}   // namespace

Configuration along_screws(const Mechanism& mechanism, const Placed& from, std::span<const double> way,
                           double part)
{
    Configuration X = from.X;
    const std::vector<Screw> screws = screws_outwards(mechanism, from.by_rates);
    for (int b = 0; b < mechanism.model.n_bodies(); ++b) {
        const BodyTable& body = mechanism.bodies[b];
        const Vector3 at = from.X[b].column(0);
        // exp(xi_1 q_1) exp(xi_2 q_2) X: what moves least goes first, while its screw is where it was.
        for (auto screw = screws.rbegin(); screw != screws.rend(); ++screw) {
            Vector3 velocity{}, turn{};
            for (int k = screw->rate; k < screw->rate + screw->n_rates; ++k)
                for (int i = 0; i < body.dofs; ++i)
                    (i < 3 ? velocity[i] : turn[i - 3]) += part * way[k] * from.by_rates(body.first + i, k);
            if (velocity == Vector3{} && turn == Vector3{}) continue;
            X[b] = along_screw(at, velocity, turn).of_configuration(X[b]);
            // A point has no directors that could turn.
            if (body.dofs == 3) X[b] = configuration(X[b].column(0), Matrix3{});
        }
    }
    return X;
}

}   // namespace livens::inline dynamics_internal
