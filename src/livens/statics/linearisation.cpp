// SPDX-License-Identifier: BSD-3-Clause
// The linear equations M q'' + C q' + K q = f about a rest, and state matrices with inputs and outputs by
// name: theory.md, "Small motions". States that move or are not balanced are refused, as their K would depend
// on coordinates.
#include "livens/statics/linearisation.h"

#include <algorithm>
#include <cmath>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/multibody/body.h"
#include "livens/multibody/rotors.h"
#include "livens/solvers/factors.h"
#include "livens/solvers/spectral.h"
#include "livens/statics/resting_stops.h"
#include "livens/statics/statics.h"

namespace livens {

namespace {

using Values = std::vector<double>;

constexpr double rest_tolerance = 1e-9;       // lengths of the model a second, rad/s
constexpr double rounding_of_terms = 1e-12;   // of the largest of them, where they cancel

Values by_rows(const DenseMatrix& A) { return transpose(A).a; }

void refuse_motion(const Model& model, const State& state)
{
    for (int b = 0; b < model.n_bodies(); ++b) {
        const Matrix34 &X = state.X[b], &V = state.V[b];
        const double speed = norm(V.column(0));
        const double spin = model.bodies()[b].is_point ? 0 : norm(angular_velocity(X, V));
        if (speed <= rest_tolerance * model.length() && spin <= rest_tolerance) continue;
        throw InputError({"not-at-rest", "body[" + model.body_name(b) + "]",
                          "body '" + model.body_name(b) + "' moves, and only states of rest are linearised",
                          to_text(speed, 3) + " m/s, " + to_text(spin, 3) + " rad/s", "", "",
                          "find the equilibrium first, with drives held, or let the start be at rest"});
    }
}

void refuse_imbalance(const Model& model, const Statics& statics)
{
    if (statics.residual <= equilibrium_tolerance) return;
    const std::string name = model.body_name(std::max(0, statics.body));
    throw InputError({"not-in-equilibrium", "body[" + name + "]",
                      "the forces on body '" + name + "' are not balanced: it would begin to move",
                      to_text(statics.residual, 3) + " of the largest forces", to_text(equilibrium_tolerance),
                      "", "find the equilibrium first, and linearise there"});
}

/// [dphi; w] of all bodies by the free coordinates, six rows a body.
DenseMatrix twists_of(const ModelTables& tables, const InstantState& state, const FreeMotions& free)
{
    DenseMatrix twists(6 * tables.n_bodies(), free.n);
    for (int k = 0; k < free.n; ++k) {
        const std::vector<double> xi = free.twists(tables, state, k);
        for (int b = 0; b < tables.n_bodies(); ++b)
            std::copy_n(xi.data() + tables.bodies[b].first, tables.bodies[b].dofs,
                        twists.column(k).data() + static_cast<std::ptrdiff_t>(6) * b);
    }
    return twists;
}

bool is_symmetric(const DenseMatrix& A, double rounding)
{
    return 2 * largest_size(skew_part(A).a) <= rounding;
}

/// a g g^T of each rotor, g being how its coordinate goes with those of the basis.
void add_rotors(const Model& model, std::span<const Matrix34> X, const DenseMatrix& twists, DenseMatrix& M)
{
    for (const Rotor& rotor : rotors_of(model)) {
        std::vector<double> slope;
        for (int k = 0; k < M.cols; ++k) {
            std::vector<Matrix34> V;
            for (std::size_t b = 0; b < X.size(); ++b) {
                const auto t = twists.column(k).subspan(6 * b, 6);
                V.push_back(rate(X[b], {t[0], t[1], t[2]}, {t[3], t[4], t[5]}));
            }
            slope.push_back(coordinate_rate(rotor.coordinate, X, V));
        }
        for (int k = 0; k < M.cols; ++k)
            for (int i = 0; i < M.rows; ++i) M(i, k) += rotor.inertia * slope[i] * slope[k];
    }
}

}   // namespace

Linearisation linearise(const Model& the_model, const State& state, Side side)
{
    const RestingStops stops(the_model, state.t);
    const Model held = stops.size() == 0 ? the_model : stops.holding(stops_of_rest(stops, state, side)).model;
    refuse_motion(held, consistent_start(held, state, StartPolicy::project).start);
    // Drives are held where they are at the instant: the equations of a rest have no time.
    const Model model = frozen(held, {state.t, side});
    State rest = state;
    for (Matrix34& V : rest.V) V = {};
    const PreparedState at(model, rest, side, true);
    Linearisation linear;
    linear.state = rest;
    for (int b = 0; b < model.n_bodies(); ++b)
        std::copy_n(at.state.X.begin() + 12 * b, 12, linear.state.X[b].data());
    linear.length = model.length();
    if (model.n_bodies() == 0) return linear;

    const Statics statics(at.tables, at.state, side);
    refuse_imbalance(model, statics);
    TwistTerms mass;
    SmallMotions(at.tables, at.state, side).add_mass(mass);
    const FreeMotions& free = statics.free;
    linear.n = free.n;
    const DenseMatrix C = free.reduced(at.tables, statics.damping),
                      K = free.reduced(at.tables, statics.stiffness);
    DenseMatrix M = free.reduced(at.tables, mass);
    add_rotors(model, linear.state.X, twists_of(at.tables, at.state, free), M);
    linear.M = by_rows(symmetric_part(M));
    linear.C = by_rows(C);
    linear.K = by_rows(K);
    linear.twists = by_rows(twists_of(at.tables, at.state, free));
    // What counts as zero: entries of K are sums of terms that may cancel (theory.md, "Small motions").
    linear.rounding = rounding_of_terms * statics.largest_stiffness;
    linear.damping_rounding = rounding_of_terms * statics.largest_damping;
    // Symmetric K and C, and no damper that feeds energy: then stability is a question of the signs of K
    // alone.
    linear.is_conservative = is_symmetric(K, linear.rounding) && is_symmetric(C, linear.damping_rounding);
    if (linear.n > 0 && linear.is_conservative)
        linear.is_conservative = symmetric_values(symmetric_part(C))[0] >= -linear.damping_rounding;
    return linear;
}

// --- ports

namespace {

/// Rates of all bodies when coordinate k goes by one a second.
std::vector<Matrix34> rates_of(const Linearisation& linear, int k)
{
    std::vector<Matrix34> V;
    const auto n = static_cast<std::size_t>(linear.n);
    for (std::size_t b = 0; b < linear.state.X.size(); ++b) {
        double t[6];
        for (std::size_t i = 0; i < 6; ++i)
            t[i] = linear.twists[(6 * b + i) * n + static_cast<std::size_t>(k)];
        V.push_back(rate(linear.state.X[b], {t[0], t[1], t[2]}, {t[3], t[4], t[5]}));
    }
    return V;
}

Values gradient_of(const Linearisation& linear, const JointCoordinate& coordinate)
{
    Values row;
    for (int k = 0; k < linear.n; ++k)
        row.push_back(coordinate_rate(coordinate, linear.state.X, rates_of(linear, k)));
    return row;
}

[[noreturn]] void refuse_port(const std::string& name, const std::string& message)
{
    throw InputError({"no-such-port", "", "'" + name + "' " + message, "", "",
                      "ports are JOINT.angle, JOINT.displacement, BODY.x, BODY.y and BODY.z; outputs also "
                      "their rates, such as JOINT.angle_rate",
                      ""});
}

/// The row c of a quantity c q.
Values row_of(const Model& model, const Linearisation& linear, const std::string& name,
              const std::string& whose, const std::string& what)
{
    static const std::string axes = "xyz";
    if (what.size() == 1 && axes.find(what) != std::string::npos) {
        const int body = model.find_body(whose);
        if (body < 0) refuse_port(name, "names no body");
        const auto row = linear.twists.begin() + linear.n * (6 * body + static_cast<int>(axes.find(what)));
        return {row, row + linear.n};
    }
    if (!what.starts_with("angle") && !what.starts_with("rotation_vector") && what != "displacement")
        refuse_port(name, "is no quantity of a joint or a body");
    const int joint = model.find_joint(whose);
    if (joint < 0) refuse_port(name, "names no joint");
    const NamedCoordinate* coordinate = find_coordinate(model.joints()[joint], what);
    if (coordinate == nullptr) refuse_port(name, "is no coordinate of its joint");
    return gradient_of(linear, coordinate->coordinate);
}

struct Port {
    Values row;
    bool is_rate = false;
};

Port port(const Model& model, const Linearisation& linear, const std::string& name)
{
    static const std::string rate = "_rate";
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos) refuse_port(name, "names no quantity of a joint or a body");
    std::string what = name.substr(dot + 1);
    const bool is_rate = what.ends_with(rate);
    if (is_rate) what.resize(what.size() - rate.size());
    return {row_of(model, linear, name, name.substr(0, dot), what), is_rate};
}

}   // namespace

std::complex<double> amplitude(const Linearisation& linear, const VibrationMode& mode,
                               const JointCoordinate& coordinate)
{
    std::vector<Matrix34> re, im;
    for (std::size_t b = 0; b < mode.bodies.size(); ++b) {
        const auto &d = mode.bodies[b].displacement, &w = mode.bodies[b].rotation;
        const Matrix34& X = linear.state.X[b];
        // Rates are linear in twists, so real and imaginary parts are taken one by one.
        re.push_back(
            rate(X, {d[0].real(), d[1].real(), d[2].real()}, {w[0].real(), w[1].real(), w[2].real()}));
        im.push_back(
            rate(X, {d[0].imag(), d[1].imag(), d[2].imag()}, {w[0].imag(), w[1].imag(), w[2].imag()}));
    }
    return {coordinate_rate(coordinate, linear.state.X, re), coordinate_rate(coordinate, linear.state.X, im)};
}

StateMatrices state_matrices(const Model& model, const Linearisation& linear,
                             const std::vector<std::string>& inputs, const std::vector<std::string>& outputs)
{
    const int n = linear.n, m = static_cast<int>(inputs.size()), p = static_cast<int>(outputs.size());
    const auto square = [n](const Values& by_rows) { return transpose({n, n, by_rows.data()}); };
    const DenseMatrix L = cholesky(square(linear.M)), K = cholesky_solution(L, square(linear.K)),
                      damping = cholesky_solution(L, square(linear.C));
    DenseMatrix A(2 * n, 2 * n), B(2 * n, m), C(p, 2 * n);
    for (int j = 0; j < n; ++j) {
        // The state is (q, q'), with M q'' = f - K q - C q'.
        A(j, n + j) = 1;
        for (int i = 0; i < n; ++i) A(n + i, j) -= K(i, j), A(n + i, n + j) -= damping(i, j);
    }
    for (int j = 0; j < m; ++j) {
        const Port input = port(model, linear, inputs[j]);
        if (input.is_rate) refuse_port(inputs[j], "is a rate, and inputs are forces");
        // A force u along a coordinate c q has the generalised force c^T u; divided by M it is an
        // acceleration.
        const Values accelerations = cholesky_solution(L, input.row);   // virtual work u c dq
        std::ranges::copy(accelerations, B.column(j).subspan(n).begin());
    }
    for (int i = 0; i < p; ++i) {
        const Port output = port(model, linear, outputs[i]);
        for (int k = 0; k < n; ++k) C(i, (output.is_rate ? n : 0) + k) = output.row[k];
    }
    return {2 * n,
            inputs,
            outputs,
            by_rows(A),
            by_rows(B),
            by_rows(C),
            Values(static_cast<std::size_t>(p * m), 0.0)};
}

}   // namespace livens
