// SPDX-License-Identifier: BSD-3-Clause
#include "properties/joint_kit.h"

#include <cmath>
#include <set>

namespace livens {

namespace {

constexpr int repetitions = 25;

/// A joint between body 0 (or the world) and the last body, closed where the bodies stand.
struct Mechanism {
    Joint joint;
    JointFrame frame;
    std::vector<Matrix34> X;   ///< of the bodies; the world is none

    const Matrix34& place(int body) const { return body == world ? world_configuration : X[body]; }
};

Mechanism closed_mechanism(const JointCase& joint, Random& random, bool on_world)
{
    Mechanism m;
    const int first = on_world ? world : 0, second = on_world ? 0 : 1;
    for (int b = 0; b <= second; ++b) m.X.push_back(random.rigid());
    m.frame = joint.place(random, m.place(first), m.place(second));
    m.joint = joint.make(first, second, m.frame, m.place(first), m.place(second));
    return m;
}

double value(const ConstraintRow& row, const Mechanism& m)
{
    return constraint_value(row, kit_instant, m.X);
}

double norm_of_rows(const Joint& joint, const Mechanism& m)
{
    double sum = 0;
    for (const ConstraintRow& row : joint.rows) sum += std::pow(value(row, m), 2);
    return std::sqrt(sum);
}

/// Derivative of a row by the twist (v, w) of each body, in world axes.
std::vector<double> twist_row(const ConstraintRow& row, const Mechanism& m)
{
    std::vector<double> result(6 * m.X.size());
    const RowGradient g = constraint_gradient(row, kit_instant, m.X);
    for (const int body : g.bodies)
        for (int k = 0; k < 6; ++k) {
            Vector3 v{}, w{};
            (k < 3 ? v : w)[k % 3] = 1;
            result[6 * body + k] += dot(g.of(body), rate(m.X[body], v, w));
        }
    return result;
}

using Bodies = std::vector<Matrix34>;

Bodies anything(Random& random, const Mechanism& m)
{
    Bodies X;
    for (std::size_t b = 0; b < m.X.size(); ++b) X.push_back(random.matrix<3, 4>());
    return X;
}

/// X + s V.
Bodies moved(Bodies X, double s, const Bodies& V)
{
    for (std::size_t b = 0; b < X.size(); ++b) X[b] += s * V[b];
    return X;
}

/// <gradient, V>.
double along(const ConstraintRow& row, const Bodies& X, const Bodies& V)
{
    const RowGradient g = constraint_gradient(row, kit_instant, X);
    double sum = 0;
    for (const int body : g.bodies) sum += dot(g.of(body), V[static_cast<std::size_t>(body)]);
    return sum;
}

double inner(const std::vector<double>& a, const std::vector<double>& b)
{
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

/// Orthonormalises rows in place (twice, for safety); returns the smallest length left, and the triangle in
/// `R`.
double orthonormalise(std::vector<std::vector<double>>& rows, std::vector<std::vector<double>>& R)
{
    double smallest = 1e300;
    R.assign(rows.size(), std::vector<double>(rows.size()));
    for (std::size_t r = 0; r < rows.size(); ++r) {
        for (int pass = 0; pass < 2; ++pass)
            for (std::size_t s = 0; s < r; ++s) {
                const double part = inner(rows[r], rows[s]);
                R[r][s] += part;
                for (std::size_t i = 0; i < rows[r].size(); ++i) rows[r][i] -= part * rows[s][i];
            }
        R[r][r] = std::sqrt(inner(rows[r], rows[r]));
        smallest = std::min(smallest, R[r][r]);
        for (double& entry : rows[r]) entry /= R[r][r];
    }
    return smallest;
}

void move(Matrix34& X, const double* twist)
{
    const Matrix3 R = directors_from_rotation_vector({twist[3], twist[4], twist[5]});
    X = configuration(X.column(0) + Vector3{twist[0], twist[1], twist[2]}, R * directors(X));
}

/// Moves the bodies to a configuration that the joint allows, by Newton's method with the shortest steps.
void close(const Joint& joint, Mechanism& m)
{
    for (int iteration = 0; iteration < 30; ++iteration) {
        std::vector<std::vector<double>> Q, R;
        for (const ConstraintRow& row : joint.rows) Q.push_back(twist_row(row, m));
        orthonormalise(Q, R);
        std::vector<double> step(6 * m.X.size()), y(Q.size());
        for (std::size_t r = 0; r < Q.size(); ++r) {   // R y = -Phi, step = Q^T y
            y[r] = -value(joint.rows[r], m);
            for (std::size_t s = 0; s < r; ++s) y[r] -= R[r][s] * y[s];
            y[r] /= R[r][r];
            for (std::size_t i = 0; i < step.size(); ++i) step[i] += y[r] * Q[r][i];
        }
        for (std::size_t b = 0; b < m.X.size(); ++b) move(m.X[b], &step[6 * b]);
    }
}

JointFrame exchanged(const JointFrame& frame)
{
    return {frame.point_second, frame.point_first, frame.axis_second, frame.axis_first};
}

}   // namespace

Failures check_joint_labels(const JointCase& joint)
{
    Random random(1);
    const Mechanism m = closed_mechanism(joint, random, false);
    Failures failures;
    if (m.joint.type != joint.type) failures.push_back("its type is '" + m.joint.type + "'");
    if (static_cast<int>(m.joint.rows.size()) != joint.n_rows)
        failures.push_back("the number of rows is another");
    std::set<std::string> labels;
    for (const ConstraintRow& row : m.joint.rows) {
        if (row.label.empty() || !labels.insert(row.label).second)
            failures.push_back("label '" + row.label + "' repeats");
        if (!(row.scale > 0)) failures.push_back("the scale of '" + row.label + "' is not positive");
    }
    return failures;
}

Failures check_joint_closure(const JointCase& joint)
{
    Random random(2);
    Failures failures;
    for (int n = 0; n < repetitions; ++n) {
        const Mechanism m = closed_mechanism(joint, random, n % 2);
        for (const ConstraintRow& row : m.joint.rows)
            if (!(std::abs(value(row, m)) < 1e-14))
                failures.push_back("row '" + row.label +
                                   "' is not zero at assembly: " + number(value(row, m)));
    }
    return failures;
}

Failures check_joint_gradient(const JointCase& joint)
{
    Random random(3);
    Failures failures;
    for (int n = 0; n < repetitions; ++n) {
        const Mechanism m = closed_mechanism(joint, random, n % 2);
        for (const ConstraintRow& row : m.joint.rows) {
            if (!row.functions.empty()) continue;   // check_joint_rates() looks at them
            const Bodies X = anything(random, m), U = anything(random, m);
            const double here = constraint_value(row, kit_instant, X),
                         ahead = constraint_value(row, kit_instant, moved(X, 1, U)),
                         behind = constraint_value(row, kit_instant, moved(X, -1, U));
            // Quadratic forms: differences are exact for any step, and the second one does not depend on X.
            const double first = along(row, X, U) - 0.5 * (ahead - behind);
            const double second =
                constraint_curvature(frozen(row, kit_instant), {}, X, U) - (ahead - 2 * here + behind);
            if (!(std::abs(first) < 1e-12))
                failures.push_back("gradient of '" + row.label + "' off by " + number(first));
            if (!(std::abs(second) < 1e-12))
                failures.push_back("Hessian of '" + row.label + "' off by " + number(second));
        }
    }
    return failures;
}

Failures check_joint_rates(const JointCase& joint)
{
    Random random(8);
    Failures failures;
    for (int n = 0; n < repetitions; ++n) {
        const Mechanism m = closed_mechanism(joint, random, n % 2);
        for (const ConstraintRow& row : m.joint.rows) {
            // Functions need not be smooth far from where the joint is closed.
            const bool is_quadratic = row.functions.empty();
            const double h = is_quadratic ? 0.01 : 0.002;
            const Bodies V = anything(random, m),
                         X = is_quadratic ? anything(random, m) : moved(m.X, 0.05, anything(random, m));
            const auto at = [&](double s) {
                return constraint_value(row, {kit_instant.t + s}, moved(X, s, V));
            };
            const auto odd = [&](int k) { return at(k * h) - at(-k * h); };
            const auto even = [&](int k) { return at(k * h) + at(-k * h); };
            const double rate = constraint_rate(row, kit_instant, X) + along(row, X, V);
            const double first = (45 * odd(1) - 9 * odd(2) + odd(3)) / (60 * h) - rate;
            const double second = (270 * even(1) - 27 * even(2) + 2 * even(3) - 490 * at(0)) / (180 * h * h) -
                                  constraint_curvature(row, kit_instant, X, V);
            if (!(std::abs(first) < 1e-9))
                failures.push_back("rate of '" + row.label + "' off by " + number(first));
            if (!(std::abs(second) < 1e-8))
                failures.push_back("second rate of '" + row.label + "' off by " + number(second));
        }
    }
    return failures;
}

Failures check_joint_rank(const JointCase& joint)
{
    Random random(4);
    Failures failures;
    for (int n = 0; n < repetitions; ++n) {
        const Mechanism m = closed_mechanism(joint, random, n % 2);
        std::vector<std::vector<double>> Q, R;
        for (const ConstraintRow& row : m.joint.rows) Q.push_back(twist_row(row, m));
        const double smallest = orthonormalise(Q, R);
        if (!(smallest > 1e-6))
            failures.push_back("a row is implied by the others: pivot " + number(smallest));
    }
    return failures;
}

Failures check_joint_objectivity(const JointCase& joint)
{
    Random random(5);
    Failures failures;
    for (int n = 0; n < repetitions; ++n) {
        Mechanism m = closed_mechanism(joint, random, false);
        for (Matrix34& X : m.X) X += 0.3 * random.matrix<3, 4>();   // off the constraints, and skew
        const double before = norm_of_rows(m.joint, m);
        const Matrix3 R = random.rotation();
        const Vector3 shift = random.vector();
        for (Matrix34& X : m.X) X = configuration(R * X.column(0) + shift, R * directors(X));
        const double change = norm_of_rows(m.joint, m) - before;
        if (!(std::abs(change) < 1e-13))
            failures.push_back("a motion of both bodies changes |Phi| by " + number(change));
    }
    return failures;
}

Failures check_joint_world(const JointCase& joint)
{
    Random random(6);
    Failures failures;
    for (int n = 0; n < repetitions; ++n) {
        const Mechanism fixed = closed_mechanism(joint, random, true);
        const Joint floating = joint.make(0, 1, fixed.frame, world_configuration, fixed.X[0]);
        const Matrix34 X = fixed.X[0] + 0.1 * random.matrix<3, 4>();
        for (std::size_t r = 0; r < floating.rows.size(); ++r) {
            const ConstraintRow &a = fixed.joint.rows[r], &b = floating.rows[r];
            const Bodies alone{X}, both{world_configuration, X};
            const Matrix34 ga = constraint_gradient(a, kit_instant, alone).of(0),
                           gb = constraint_gradient(b, kit_instant, both).of(1);
            const double gap =
                constraint_value(a, kit_instant, alone) - constraint_value(b, kit_instant, both);
            if (a.body_i != world || a.body_j != 0)
                failures.push_back("row '" + a.label + "' is not on the body");
            if (!(std::abs(gap) < 1e-13) || !(largest(ga - gb) < 1e-13))
                failures.push_back("row '" + a.label + "' differs for the world by " + number(gap));
        }
    }
    return failures;
}

Failures check_joint_order(const JointCase& joint)
{
    if (!joint.is_symmetric) return {};
    Random random(7);
    Failures failures;
    for (int n = 0; n < repetitions; ++n) {
        Mechanism m = closed_mechanism(joint, random, n % 2);
        const int first = m.joint.first, second = m.joint.second;
        const Joint other = joint.make(second, first, exchanged(m.frame), m.place(second), m.place(first));
        // Near assembly, where both sets of rows stand for one joint: allowed by one, allowed by the other.
        for (Matrix34& X : m.X) {
            const Matrix<6, 1> twist = 0.2 * random.matrix<6, 1>();
            move(X, twist.data());
        }
        const Joint* both[2] = {&m.joint, &other};
        for (int k = 0; k < 2; ++k) {
            close(*both[k], m);
            const double own = norm_of_rows(*both[k], m), others = norm_of_rows(*both[1 - k], m);
            if (!(own < 1e-12)) failures.push_back("no allowed configuration found nearby");
            if (!(others < 1e-11))
                failures.push_back("bodies exchanged, another motion is allowed: " + number(others));
        }
    }
    return failures;
}

Failures check_joint(const JointCase& joint)
{
    Failures all;
    for (const auto check : {check_joint_labels, check_joint_closure, check_joint_gradient, check_joint_rates,
                             check_joint_rank, check_joint_objectivity, check_joint_world, check_joint_order})
        for (const std::string& failure : check(joint)) all.push_back(joint.type + ": " + failure);
    return all;
}

}   // namespace livens
