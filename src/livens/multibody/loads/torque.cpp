// SPDX-License-Identifier: BSD-3-Clause
// A torque as F_a = 1/2 mu x d^a with contravariant directors (P21); theory.md, "The law", says why the
// factor is right for skew directors too.
#include "livens/multibody/loads/load_values.h"

namespace livens {

namespace {

/// The contravariant directors d^i = g^ij d_j as columns: the metric's inverse (P21) times D is D^-T.
Matrix3 contravariant_directors(const Matrix34& X) { return transpose(inverse(directors(X))); }

/// World components of the torque: mu itself, or mu = sum_i mu_i d_i.
Vector3 torque_in_world(const Matrix34& X, const Vector3& mu, Frame frame)
{
    return frame == Frame::body_fixed ? directors(X) * mu : mu;
}

}   // namespace

/// The columns are half crosses because sum_i d_i x (mu x d^i) = 3 mu - mu for every nonsingular triad.
Load torque(const std::string& name, int body, const TimeVector& value, Frame frame)
{
    Load load = start_load(name, "torque", {body, world});
    set_load_value(load, value);
    report_load_value(load, value, "N m");
    load.depends_on_X = true;
    load.needs_directors[0] = true;
    load.forces = [value, frame](const LoadArguments& arguments, LoadForces& F) {
        const Matrix3 D = contravariant_directors(arguments.X[0]);
        const Vector3 mu = torque_in_world(arguments.X[0], load_value(value, arguments.at), frame);
        for (int i = 0; i < 3; ++i) F[0].set_column(i + 1, 0.5 * cross(mu, D.column(i)));
    };
    load.forces.record = [value, frame](LoadTape& tape, const TapeNumber& factor) {
        const TapeVector components = tape.of_time(value);
        const TapeVector mu = frame == Frame::body_fixed ? along_directors(components) : components;
        const auto d = [&](int i) { return director_on(tape, i); };
        const TapeVector crossed[3] = {cross(d(1), d(2)), cross(d(2), d(0)), cross(d(0), d(1))};
        const TapeNumber share = factor * (0.5 * (tape.number(1) / dot(d(0), crossed[0])));
        for (int i = 0; i < 3; ++i) {
            Vector3 unit{};
            unit[i] = 1;
            tape.pull(0, direction(unit), share, cross(mu, crossed[i]));
        }
    };
    // From d(D^-T) = -D^-T dD^T D^-T: the derivative of d^i by d_j is -d^j (d^i)^T.
    load.tangent = [value, frame](const LoadArguments& arguments, LoadTangent& tangent) {
        const Matrix3 D = contravariant_directors(arguments.X[0]);
        const Vector3 components = load_value(value, arguments.at);
        const Vector3 mu = torque_in_world(arguments.X[0], components, frame);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                Matrix3 block = -0.5 * outer(cross(mu, D.column(j)), D.column(i));
                if (frame == Frame::body_fixed) block -= 0.5 * components[j] * cross_matrix(D.column(i));
                add_block(tangent.X[0][0], i + 1, j + 1, block);
            }
    };
    return load;
}

}   // namespace livens
