#include "livens/spacetime/mixed/guess.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "livens/multibody/body.h"
#include "livens/spacetime/lobatto/march.h"

namespace livens::mixed {

namespace {

/// The model that runs backwards: t becomes -t, velocities change their sign, forces do not.
Model reversed(const Model& model)
{
    Model back(model.gravity());
    for (const Body& body : model.bodies()) back.add_body(body);
    for (const Joint& joint : model.joints()) back.add_joint(joint);
    for (const Load& load : model.loads()) {
        Load turned = load;
        const auto mirror = [](LoadArguments arguments) {
            arguments.at.t = -arguments.at.t;
            arguments.at.side = static_cast<Side>(-static_cast<int>(arguments.at.side));
            for (Matrix34& V : arguments.V) V = -V;
            return arguments;
        };
        turned.forces = [load, mirror](const LoadArguments& arguments, LoadForces& F) {
            load.forces(mirror(arguments), F);
        };
        if (load.tangent)
            turned.tangent = [load, mirror](const LoadArguments& arguments, LoadTangent& T) {
                load.tangent(mirror(arguments), T);
                for (auto& by : T.V)
                    for (auto& block : by) block = -block;
            };
        turned.potential = {};
        turned.power = {};
        for (double& t : turned.breaks) t = -t;
        std::reverse(turned.breaks.begin(), turned.breaks.end());
        back.add_load(turned);
    }
    return back;
}

State mirrored(State state)
{
    state.t = -state.t;
    for (Matrix34& V : state.V) V = -V;
    return state;
}

/// Turns a triad by a rotation vector: exp(w) d_i.
Matrix34 moved(const Matrix34& X, const Vector3& step, const Vector3& turn)
{
    const Matrix3 R = directors_from_rotation_vector(turn);
    return configuration(X.column(0) + step, R * directors(X));
}

/// The rotation vector from one triad to another, |w| <= pi.
Vector3 turn_between(const Matrix34& from, const Matrix34& to)
{
    const Matrix3 R = directors(to) * transpose(directors(from));
    const Vector4 q = quaternion_from_directors(project_directors(R));
    const Vector3 v{q[1], q[2], q[3]};
    const double s = norm(v);
    return s > 0 ? (2 * std::atan2(s, q[0]) / s) * v : Vector3{};
}

/// Coefficients whose function takes the columns' values at the interpolation points, in place.
void interpolate(const TimeSpace& space, int n_values, std::vector<double>& columns)
{
    const std::vector<double> points = space.interpolation_points();
    const int n = space.size(), local = space.degree() + 1;
    std::vector<std::vector<std::pair<int, double>>> by_column(static_cast<std::size_t>(n));
    std::vector<double> values(static_cast<std::size_t>(local)), rates(values);
    for (int i = 0; i < n; ++i) {
        const TimeSpace::Place place = space.place(points[i]);
        space.evaluate(place.element, place.s, values, rates);
        for (int a = 0; a < local; ++a)
            if (values[a] != 0) by_column[space.first(place.element) + a].push_back({i, values[a]});
    }
    const SparseMatrix A = sparse_from_columns(by_column);
    SparseLU lu(SparseBackend::eigen);
    lu.analyse(A);
    if (!lu.factorise(A)) return;   // values near the coefficients will do for a guess
    std::vector<double> x(static_cast<std::size_t>(n));
    for (int k = 0; k < n_values; ++k) {
        for (int i = 0; i < n; ++i) x[i] = columns[static_cast<std::size_t>(i) * n_values + k];
        lu.solve(x, x);
        for (int i = 0; i < n; ++i) columns[static_cast<std::size_t>(i) * n_values + k] = x[i];
    }
}

}   // namespace

Guess guess_from_state(const Model& model, const State& state, const std::vector<double>& ends)
{
    const bool forwards = state.t <= ends.front();
    const Model turned = forwards ? Model{} : reversed(model);
    const Model& m = forwards ? model : turned;
    TimeMesh mesh{ends};
    if (!forwards) {
        for (double& t : mesh.ends) t = -t;
        std::reverse(mesh.ends.begin(), mesh.ends.end());
    }
    const Assembly assembly = assemble(m, forwards ? state : mirrored(state), StartPolicy::project);
    auto march = std::make_shared<Motion>(march_lobatto(m, assembly, mesh, 2, {}).motion);
    const State start = assembly.start;
    return [march, start, forwards](double t) {
        const double at = forwards ? t : -t;
        State found;
        if (march->n_elements() == 0) {
            found = guess_steady(start)(at);
        } else if (at > march->end()) {
            found = guess_steady(march->at_end(march->n_elements()))(at);
        } else {
            found = march->at(std::max(at, march->start()));
        }
        return forwards ? found : mirrored(found);
    };
}

Guess guess_steady(const State& state)
{
    return [state](double t) {
        State moving = state;
        moving.t = t;
        for (std::size_t b = 0; b < state.X.size(); ++b) {
            const bool is_point = norm(directors(state.X[b])) == 0;
            const Vector3 step = (t - state.t) * state.V[b].column(0);
            if (is_point) {
                moving.X[b].set_column(0, state.X[b].column(0) + step);
                continue;
            }
            const Vector3 w = angular_velocity(state.X[b], state.V[b]);
            moving.X[b] = moved(state.X[b], step, (t - state.t) * w);
            moving.V[b] = rate(moving.X[b], state.V[b].column(0), w);
        }
        return moving;
    };
}

State with_rates(State places, const State& rates)
{
    for (std::size_t b = 0; b < places.X.size(); ++b) {
        const Matrix34 &X = rates.X[b], &V = rates.V[b];
        const bool is_point = norm(directors(X)) == 0;
        places.V[b] = is_point ? V : rate(places.X[b], V.column(0), angular_velocity(X, V));
    }
    return places;
}

Guess guess_between(const State& first, const State& last)
{
    State steady = first;
    const double duration = last.t - first.t;
    for (std::size_t b = 0; b < first.X.size(); ++b) {
        const Vector3 v = (1 / duration) * (last.X[b].column(0) - first.X[b].column(0));
        const bool is_point = norm(directors(first.X[b])) == 0;
        steady.V[b] = {};
        if (is_point)
            steady.V[b].set_column(0, v);
        else
            steady.V[b] = rate(first.X[b], v, (1 / duration) * turn_between(first.X[b], last.X[b]));
    }
    return guess_steady(steady);
}

void take_guess(const Equations& equations, const Guess& guess, Fields& fields)
{
    const TimeSpace& space = equations.setup().space;
    const Mechanism& m = *equations.setup().mechanism;
    const std::size_t n = static_cast<std::size_t>(m.n_coordinates);
    const std::vector<double> points = space.interpolation_points();
    std::vector<State> states;
    for (const double t : points) {
        states.push_back(guess(t));
        states.back().t = t;
    }
    m.stack(states.front().X, fields.X0.data());
    for (std::size_t A = 0; A < points.size(); ++A) {
        std::vector<Matrix34> P = states[A].V;
        for (int b = 0; b < m.n_bodies(); ++b) P[b] = states[A].V[b] * m.model.bodies()[b].mass;
        m.stack(states[A].X, fields.x.data() + A * n);
        m.stack(P, fields.P.data() + A * n);
        for (std::size_t i = 0; i < n; ++i) fields.x[A * n + i] -= fields.X0[i];
    }
    interpolate(space, m.n_coordinates, fields.x);
    interpolate(space, m.n_coordinates, fields.P);

    const TimeSpace& multipliers = equations.setup().multipliers;
    if (multipliers.size() < space.size()) {
        states.clear();
        for (int A = 0; A < multipliers.size(); ++A) states.push_back(guess(equations.centre(A)));
    }
    const std::vector<std::vector<double>> lambda = m.multipliers(states);
    for (int A = 0; A < multipliers.size(); ++A)
        for (int k = 0; k < m.n_rows(); ++k)
            fields.lambda[static_cast<std::size_t>(A) * m.n_rows() + k] =
                std::isfinite(lambda[A][k]) ? lambda[A][k] : 0;
    if (multipliers.size() == space.size()) interpolate(space, m.n_rows(), fields.lambda);
}

}   // namespace livens::mixed
