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

/// The columns are half crosses because sum_i d_i x (mu x d^i) = 3 mu - mu for every nonsingular triad.
void add_torque(const Matrix34& X, const Vector3& mu, Matrix34& F)
{
    const Matrix3 D = contravariant_directors(X);
    for (int i = 0; i < 3; ++i) F.set_column(i + 1, 0.5 * cross(mu, D.column(i)));
}

/// On tapes: `factor` mu on the body of a side.
void record_torque(LoadTape& tape, int side, const TapeVector& mu, const TapeNumber& factor)
{
    Vector3 unit[3] = {};
    for (int i = 0; i < 3; ++i) unit[i][i] = 1;
    const TapeVector d[3] = {tape.arm(side, direction(unit[0])), tape.arm(side, direction(unit[1])),
                             tape.arm(side, direction(unit[2]))};
    const TapeVector crossed[3] = {cross(d[1], d[2]), cross(d[2], d[0]), cross(d[0], d[1])};
    const TapeNumber share = factor * (0.5 * (tape.number(1) / dot(d[0], crossed[0])));
    for (int i = 0; i < 3; ++i) tape.pull(side, direction(unit[i]), share, cross(mu, crossed[i]));
}

}   // namespace

Load torque(const std::string& name, int body, const TimeVector& value, Frame frame, int reaction)
{
    Load load = start_load(name, "torque", {body, reaction});
    const bool has_reaction = reaction != world;
    set_load_value(load, value);
    report_load_value(load, value, "N m");
    load.depends_on_X = true;
    load.needs_directors[0] = true;
    load.needs_directors[1] = has_reaction;
    load.forces = [value, frame, has_reaction](const LoadArguments& arguments, LoadForces& F) {
        const Vector3 mu = torque_in_world(arguments.X[0], load_value(value, arguments.at), frame);
        add_torque(arguments.X[0], mu, F[0]);
        if (has_reaction) add_torque(arguments.X[1], -1. * mu, F[1]);
    };
    load.forces.record = [value, frame, has_reaction](LoadTape& tape, const TapeNumber& factor) {
        const TapeVector components = tape.of_time(value);
        const TapeVector mu = frame == Frame::body_fixed ? along_directors(components) : components;
        record_torque(tape, 0, mu, factor);
        if (has_reaction) record_torque(tape, 1, mu, -factor);
    };
    // From d(D^-T) = -D^-T dD^T D^-T: the derivative of d^i by d_j is -d^j (d^i)^T.
    load.tangent = [value, frame, has_reaction](const LoadArguments& arguments, LoadTangent& tangent) {
        const Vector3 components = load_value(value, arguments.at);
        const Vector3 mu = torque_in_world(arguments.X[0], components, frame);
        for (int side = 0; side <= (has_reaction ? 1 : 0); ++side) {
            const double half = side == 0 ? 0.5 : -0.5;
            const Matrix3 D = contravariant_directors(arguments.X[side]);
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) {
                    const Matrix3 by_own = -half * outer(cross(mu, D.column(j)), D.column(i));
                    add_block(tangent.X[side][side], i + 1, j + 1, by_own);
                    if (frame != Frame::body_fixed) continue;
                    const Matrix3 by_axes = -half * components[j] * cross_matrix(D.column(i));
                    add_block(tangent.X[side][0], i + 1, j + 1, by_axes);
                }
        }
    };
    return load;
}

}   // namespace livens
