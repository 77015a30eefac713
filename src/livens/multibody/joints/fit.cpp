// SPDX-License-Identifier: BSD-3-Clause
// Joints that miss their bodies by a little, as after rounding in a file: the frame on the second body is
// moved by the least shift and turn with which all rows are zero. Gauss-Newton steps with differences by the
// six numbers.
#include "livens/multibody/joints/fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "livens/multibody/body.h"

namespace livens {

namespace {

/// Three numbers shift the point, in lengths, three turn the axes.
using Move = std::array<double, 6>;

JointFrame moved(JointFrame frame, const Move& move, double length)
{
    frame.point_second += length * Vector3{move[0], move[1], move[2]};
    const Matrix3 R = directors_from_rotation_vector({move[3], move[4], move[5]});
    frame.axis_second = R * frame.axis_second;
    frame.across_second = R * frame.across_second;
    return frame;
}

std::vector<double> violations(const Joint& joint, Instant at, const Configurations& X)
{
    std::vector<double> all;
    for (const ConstraintRow& row : joint.rows) all.push_back(constraint_value(row, at, X) / row.scale);
    return all;
}

double product(std::span<const double> a, std::span<const double> b)
{
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

/// The smallest y with J y = -r, by conjugate gradients on J J^T: at most six steps, and rows that say
/// something twice do no harm.
Move least_move(const std::vector<Move>& J, std::vector<double> r)
{
    Move y{};
    std::vector<double> p = r;
    const double first = product(r, r);
    double now = first;
    for (int step = 0; step < 2 * static_cast<int>(y.size()) && now > 1e-30 * first; ++step) {
        Move w{};   // J^T p
        for (std::size_t i = 0; i < p.size(); ++i)
            for (std::size_t k = 0; k < w.size(); ++k) w[k] += J[i][k] * p[i];
        const double size = product(w, w);
        if (!(size > 1e-24 * product(p, p))) break;   // no move changes what is left
        const double a = now / size;
        for (std::size_t k = 0; k < w.size(); ++k) y[k] -= a * w[k];
        for (std::size_t i = 0; i < r.size(); ++i) r[i] -= a * product(J[i], w);
        const double next = product(r, r);
        for (std::size_t i = 0; i < p.size(); ++i) p[i] = r[i] + next / now * p[i];
        now = next;
    }
    return y;
}

}   // namespace

FittedJoint fit_joint(const std::function<Joint(const JointFrame&)>& make, const JointFrame& frame,
                      Instant at, const Configurations& X, double length)
{
    constexpr double difference = 1e-4;   // rows are quadratic at most: central ones are exact to rounding
    FittedJoint fitted{make(frame), frame};
    Move sum{};
    for (int round = 0; round < 3; ++round) {
        const std::vector<double> open = violations(fitted.joint, at, X);
        if (std::ranges::all_of(open, [](double v) { return std::abs(v) < 1e-15; })) break;
        std::vector<Move> J(open.size());
        for (std::size_t k = 0; k < sum.size(); ++k) {
            Move step{};
            step[k] = difference;
            const std::vector<double> ahead = violations(make(moved(fitted.frame, step, length)), at, X);
            step[k] = -difference;
            const std::vector<double> behind = violations(make(moved(fitted.frame, step, length)), at, X);
            for (std::size_t i = 0; i < J.size(); ++i) J[i][k] = (ahead[i] - behind[i]) / (2 * difference);
        }
        const Move move = least_move(J, open);
        for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += move[k];
        fitted.frame = moved(fitted.frame, move, length);
        fitted.joint = make(fitted.frame);
    }
    fitted.shift = length * std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    fitted.turn = std::sqrt(sum[3] * sum[3] + sum[4] * sum[4] + sum[5] * sum[5]);
    return fitted;
}

}   // namespace livens
