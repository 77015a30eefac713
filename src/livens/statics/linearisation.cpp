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
#include "livens/multibody/controllers.h"
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
        if (model.bodies()[b].holds_states()) continue;
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

/// An orthonormal basis of the free coordinates without those that move a state's body alone.
DenseMatrix without_states(const StateDirections& states, int n)
{
    DenseMatrix P(n, n);
    for (int i = 0; i < n; ++i) P(i, i) = 1;
    for (const DenseMatrix* E : {&states.held, &states.idle})
        for (int k = 0; k < E->cols; ++k)
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i) P(i, j) -= (*E)(i, k) * (*E)(j, k);
    const SymmetricSpectrum spectrum = symmetric_spectrum(P);   // of a projection: zeros and ones
    DenseMatrix Q(n, n - states.held.cols - states.idle.cols);
    for (int k = 0; k < Q.cols; ++k)
        std::ranges::copy(spectrum.vectors.column(n - Q.cols + k), Q.column(k).begin());
    return Q;
}

/// Z^T A Z with other bases on either side.
DenseMatrix between(const DenseMatrix& left, const DenseMatrix& A, const DenseMatrix& right)
{
    return transposed_product(left, product(A, right));
}

/// What states do, and what is done to them, in the basis without them.
LinearStates states_of(const Model& model, const State& state, const StateDirections& directions,
                       const DenseMatrix& Q, const DenseMatrix& C, const DenseMatrix& K)
{
    LinearStates states;
    for (std::size_t b = 0; b < model.bodies().size(); ++b) {
        const Body& body = model.bodies()[b];
        for (std::size_t k = 0; k < body.states.size(); ++k) {
            states.names.push_back(body.states[k].name);
            states.scale.push_back(std::sqrt(body.mass(0, 0)) * body.states[k].unit);
        }
    }
    for (const NamedState& one : states_in(model, state.V)) states.values.push_back(one.value);
    const DenseMatrix& E = directions.held;
    states.by_states = by_rows(between(Q, C, E));
    states.by_q = by_rows(between(E, K, Q));
    states.by_rates = by_rows(between(E, C, Q));
    states.own = by_rows(between(E, C, E));
    return states;
}

}   // namespace

Linearisation linearise(const Model& the_model, const State& state, Side side)
{
    refuse_sampling(the_model);
    const RestingStops stops(the_model, state.t);
    const Model held = stops.size() == 0 ? the_model : stops.holding(stops_of_rest(stops, state, side)).model;
    refuse_motion(held, consistent_start(held, state, StartPolicy::project).start);
    // Drives are held where they are at the instant: the equations of a rest have no time.
    const Model model = frozen(held, {state.t, side});
    State rest = state;
    for (std::size_t b = 0; b < rest.V.size(); ++b)
        if (!model.bodies()[b].holds_states()) rest.V[b] = {};
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
    DenseMatrix C = free.reduced(at.tables, statics.damping), K = free.reduced(at.tables, statics.stiffness),
                M = free.reduced(at.tables, mass), twists = twists_of(at.tables, at.state, free);
    add_rotors(model, linear.state.X, twists, M);
    const StateDirections directions(at.tables, free);
    if (!directions.is_empty()) {
        const DenseMatrix Q = without_states(directions, free.n);
        linear.states = states_of(model, rest, directions, Q, C, K);
        for (DenseMatrix* A : {&C, &K, &M}) *A = between(Q, *A, Q);
        twists = product(twists, Q);
    }
    linear.n = K.rows;
    linear.M = by_rows(symmetric_part(M));
    linear.C = by_rows(C);
    linear.K = by_rows(K);
    linear.twists = by_rows(twists);
    // What counts as zero: entries of K are sums of terms that may cancel (theory.md, "Small motions").
    linear.rounding = rounding_of_terms * statics.largest_stiffness;
    linear.damping_rounding = rounding_of_terms * statics.largest_damping;
    // Symmetric K and C, and no damper that feeds energy: then stability is a question of the signs of K
    // alone.
    linear.is_conservative = is_symmetric(K, linear.rounding) && is_symmetric(C, linear.damping_rounding);
    if (linear.n > 0 && linear.is_conservative)
        linear.is_conservative = symmetric_values(symmetric_part(C))[0] >= -linear.damping_rounding;
    linear.is_conservative = linear.is_conservative && linear.states.n() == 0;
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
    int state = -1;   ///< instead
};

Port port(const Model& model, const Linearisation& linear, const std::string& name)
{
    static const std::string rate = "_rate";
    const auto state = std::ranges::find(linear.states.names, name);
    if (state != linear.states.names.end())
        return {{}, false, static_cast<int>(state - linear.states.names.begin())};
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

namespace {

/// What states do to accelerations, and their rates: the last rows and columns of A. L: of M.
void add_states(const Linearisation& linear, const DenseMatrix& L, DenseMatrix& A)
{
    const LinearStates& z = linear.states;
    const int n = linear.n, n_z = z.n();
    for (int k = 0; k < n_z; ++k) {
        const auto of = static_cast<std::size_t>(k);
        Values pulls(static_cast<std::size_t>(n));
        for (int i = 0; i < n; ++i)
            pulls[static_cast<std::size_t>(i)] =
                -z.by_states[of + static_cast<std::size_t>(i * n_z)] * z.scale[of];
        if (n > 0) std::ranges::copy(cholesky_solution(L, pulls), A.column(2 * n + k).begin() + n);
        for (int j = 0; j < n; ++j) {
            A(2 * n + k, j) = -z.by_q[static_cast<std::size_t>(k * n + j)] / z.scale[of];
            A(2 * n + k, n + j) = -z.by_rates[static_cast<std::size_t>(k * n + j)] / z.scale[of];
        }
        for (int j = 0; j < n_z; ++j)
            A(2 * n + k, 2 * n + j) = -z.own[static_cast<std::size_t>(k * n_z + j)] *
                                      z.scale[static_cast<std::size_t>(j)] / z.scale[of];
    }
}

}   // namespace

StateMatrices state_matrices(const Model& model, const Linearisation& linear,
                             const std::vector<std::string>& inputs, const std::vector<std::string>& outputs)
{
    const int n = linear.n, m = static_cast<int>(inputs.size()), p = static_cast<int>(outputs.size());
    const int n_z = linear.states.n(), size = 2 * n + n_z;
    const auto square = [n](const Values& by_rows) { return transpose({n, n, by_rows.data()}); };
    const DenseMatrix L = cholesky(square(linear.M)), K = cholesky_solution(L, square(linear.K)),
                      damping = cholesky_solution(L, square(linear.C));
    DenseMatrix A(size, size), B(size, m), C(p, size);
    add_states(linear, L, A);
    for (int j = 0; j < n; ++j) {
        // The state is (q, q'), with M q'' = f - K q - C q'.
        A(j, n + j) = 1;
        for (int i = 0; i < n; ++i) A(n + i, j) -= K(i, j), A(n + i, n + j) -= damping(i, j);
    }
    for (int j = 0; j < m; ++j) {
        const Port input = port(model, linear, inputs[j]);
        if (input.is_rate || input.state >= 0)
            refuse_port(inputs[j], "is a rate or a state, and inputs are forces");
        // A force u along a coordinate c q has the generalised force c^T u; divided by M it is an
        // acceleration.
        const Values accelerations = cholesky_solution(L, input.row);   // virtual work u c dq
        std::ranges::copy(accelerations, B.column(j).begin() + n);
    }
    for (int i = 0; i < p; ++i) {
        const Port output = port(model, linear, outputs[i]);
        if (output.state >= 0) C(i, 2 * n + output.state) = 1;
        for (int k = 0; k < n && output.state < 0; ++k) C(i, (output.is_rate ? n : 0) + k) = output.row[k];
    }
    return {size,
            inputs,
            outputs,
            by_rows(A),
            by_rows(B),
            by_rows(C),
            Values(static_cast<std::size_t>(p * m), 0.0)};
}

}   // namespace livens
