// SPDX-License-Identifier: BSD-3-Clause
// Inverse kinematics: a point of a body is led to a target, with the least changes of the coordinates that
// bring it there (Levenberg and Marquardt), so that an arm stays as it is bent. theory.md, "States in
// coordinates".
#include <algorithm>
#include <cmath>
#include <string>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/dynamics/coordinates/state_parts.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/solvers/factors.h"

namespace livens {

namespace {

constexpr double pose_step = 0.1;        // of the way: lengths of the model, rad
constexpr double pose_reached = 1e-13;   // likewise
constexpr double pose_missed = 1e-9;     // likewise: what is more is not reached

/// Where the point is, and how far it has to go: position over the model's length, and turn.
struct PoseGap {
    std::vector<double> entries;
    double distance = 0, angle = 0;   // m, rad

    double size() const { return norm(entries); }
};

class PoseLeading {
public:
    PoseLeading(const Mechanism& mechanism, const StateTarget& target) : m_(mechanism), target_(target)
    {
        int rate = 0;
        for (int c = 0; c < static_cast<int>(m_.coordinates.size()); ++c)
            for (int i = 0; i < m_.coordinates[c].n_rates(); ++i, ++rate) units_.push_back(m_.unit_of(c));
    }

    PoseGap gap(const Placed& at, const Vector3& position, const Matrix3& directors_there) const
    {
        const Matrix34& X = at.X[target_.body];
        const Vector3 left = position - X * point(target_.point);
        PoseGap gap;
        gap.distance = norm(left);
        for (int i = 0; i < 3; ++i) gap.entries.push_back(left[i] / m_.length);
        if (!target_.directors) return gap;
        const Vector3 turn = twist::turn_between(X, configuration({}, directors_there));
        gap.angle = norm(turn);
        gap.entries.insert(gap.entries.end(), turn.a, turn.a + 3);
        return gap;
    }

    /// Goes on until the gap is closed or does not shrink any more. Returns what is left.
    /// The damping becomes a tenth where a step gains; ten times as much where it does not, does not close,
    /// or is half a unit long and more.
    PoseGap follow(Placed& at, const Vector3& position, const Matrix3& directors_there, int most) const
    {
        PoseGap left = gap(at, position, directors_there);
        double damping = 1e-10;
        for (int i = 0; i < most && left.size() > pose_reached; ++i) {
            const std::vector<double> way = least_way(at, left, damping);
            const double size = m_.size_of(way);
            std::shared_ptr<Placed> next;
            if (size < 0.5) next = led_nearby(m_, at, m_.gone(at.numbers, way, 1));
            PoseGap after;
            if (next != nullptr) after = gap(*next, position, directors_there);
            if (next != nullptr && after.size() < left.size()) {
                const bool is_last = after.size() > 0.5 * left.size() && left.size() < 1e-11;
                at = std::move(*next);
                left = after;
                damping = std::max(1e-14, 0.1 * damping);
                if (is_last) break;
            } else {
                damping *= 10;
                if (damping > 1e6) break;
            }
        }
        return left;
    }

private:
    /// (J^T J + damping) way = J^T gap, in units of the coordinates.
    std::vector<double> least_way(const Placed& at, const PoseGap& left, double damping) const
    {
        const int rows = static_cast<int>(left.entries.size()), n = m_.n_rates;
        const BodyTable& body = m_.bodies[target_.body];
        const Vector3 arm = directors(at.X[target_.body]) * target_.point;
        DenseMatrix J(rows + n, n);
        for (int k = 0; k < n; ++k) {
            Vector3 v{}, w{};
            for (int i = 0; i < body.dofs; ++i) (i < 3 ? v[i] : w[i - 3]) = at.by_rates(body.first + i, k);
            v += cross(w, arm);
            for (int i = 0; i < 3; ++i) J(i, k) = units_[k] * v[i] / m_.length;
            for (int i = 3; i < rows; ++i) J(i, k) = units_[k] * w[i - 3];
            J(rows + k, k) = std::sqrt(damping);
        }
        std::vector<double> b = left.entries;
        b.resize(static_cast<std::size_t>(rows + n), 0.0);
        std::vector<double> way = PivotedQR(J).solve(b);
        for (int k = 0; k < n; ++k) way[k] *= units_[k];
        return way;
    }

    const Mechanism& m_;
    const StateTarget& target_;
    std::vector<double> units_;
};

[[noreturn]] void refuse_pose(const Mechanism& m, const StateTarget& target, const PoseGap& left)
{
    std::string what = "body '" + m.model.body_name(target.body) +
                       "' cannot be brought there: it comes within " + to_text(left.distance, 4) + " m";
    if (target.directors) what += " and " + to_text(left.angle, 4) + " rad";
    throw InputError(
        {"pose-unreachable", "pose", what, "", "",
         "the way goes straight from where the body is, and the mechanism stays on its branch",
         target.directors
             ? "give a pose within reach, leave the rotation out, or start from a state nearer to it"
             : "give a position within reach, or start from a state nearer to it"});
}

}   // namespace

GeneralisedState GeneralisedState::reaching(const StateTarget& target) const
{
    const Mechanism& m = *parts_->mechanism;
    parts_->table_of(target.body);
    const double size =
        norm(target.position) + norm(target.point) + norm(target.directors.value_or(Matrix3{}));
    if (!std::isfinite(size))
        throw InputError(
            {"coordinate-value", "pose", "the pose is not finite", "", "", "", "give finite numbers"});
    Placed at = parts_->placed;
    const PoseLeading leading(m, target);
    const Matrix34& X = at.X[target.body];
    const Matrix3 from = directors(X), to = target.directors.value_or(from);
    const Vector3 begin = X * point(target.point), way = target.position - begin;
    const Vector3 turn = twist::turn_between(X, configuration({}, to));
    const double far = std::max(norm(way) / m.length, !target.directors ? 0 : norm(turn));
    const int n = static_cast<int>(std::clamp(std::ceil(far / pose_step), 1.0, 1e5));
    for (int i = 1; i < n; ++i) {
        const double part = static_cast<double>(i) / n;
        const Matrix3 turned = directors_from_rotation_vector(part * turn) * from;
        // What cannot follow on the way may still arrive: the last target alone decides.
        if (!(leading.follow(at, begin + part * way, turned, 20).size() <= pose_missed)) break;
    }
    const PoseGap left = leading.follow(at, target.position, to, 300);
    if (!(left.size() <= pose_missed)) refuse_pose(m, target, left);
    const std::vector<double> rest(static_cast<std::size_t>(m.n_rates), 0.0);
    return GeneralisedState(std::make_shared<const StateParts>(parts_->mechanism, std::move(at), rest));
}

}   // namespace livens
