// SPDX-License-Identifier: BSD-3-Clause
#include "python_load.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

#include "livens/base/error.h"

namespace livens::python {

namespace {

namespace nb = nanobind;

/// Loads are copied and freed on any thread: the lock goes with the last of them.
std::shared_ptr<nb::object> held(nb::object function)
{
    return {new nb::object(std::move(function)), [](nb::object* p) {
                const nb::gil_scoped_acquire lock;
                delete p;
            }};
}

nb::tuple tuple_of(const Vector3& v) { return nb::make_tuple(v[0], v[1], v[2]); }

using Wrench = std::array<double, 6>;

Wrench call(const nb::object& function, const LoadArguments& at)
{
    const nb::gil_scoped_acquire lock;
    // What it raised before has not been looked at yet: solve() is on its way out.
    if (PyErr_Occurred() != nullptr) return {std::nan(""), 0, 0, 0, 0, 0};
    const Matrix34 &X = at.X[0], &V = at.V[0];
    const Vector3 w = angular_velocity(X, V);
    try {
        const nb::tuple directors =
            nb::make_tuple(tuple_of(X.column(1)), tuple_of(X.column(2)), tuple_of(X.column(3)));
        const nb::object given =
            function(at.at.t, tuple_of(X.column(0)), directors, tuple_of(V.column(0)), tuple_of(w));
        Wrench wrench{};
        for (std::size_t i = 0; i < 6; ++i) wrench[i] = nb::cast<double>(given[i]);
        return wrench;
    } catch (nb::python_error& error) {
        error.restore();
    }
    return {std::nan(""), 0, 0, 0, 0, 0};
}

/// nan where it raises.
double ask(const nb::object& function, double t, std::span<const double> inputs)
{
    const nb::gil_scoped_acquire lock;
    if (PyErr_Occurred() != nullptr) return std::nan("");
    try {
        nb::list given;
        given.append(t);
        for (const double x : inputs) given.append(x);
        return nb::cast<double>(nb::float_(function(*given)));
    } catch (nb::python_error& error) {
        error.restore();
    }
    return std::nan("");
}

/// F of a force at the reference point and, but for point masses, a torque  (P21).
Matrix34 forces_of(const Wrench& w, const Matrix34& X, bool is_point)
{
    Matrix34 F{};
    F.set_column(0, {w[0], w[1], w[2]});
    if (is_point) return F;
    const Matrix3 dual = transpose(inverse(directors(X)));
    for (int i = 0; i < 3; ++i) F.set_column(i + 1, 0.5 * cross(Vector3{w[3], w[4], w[5]}, dual.column(i)));
    return F;
}

/// Slopes of F along each number of `moved`, which is X or V of `at`.
template <class Forces>
Matrix<12, 12> slopes(const Forces& forces, LoadArguments& at, Matrix34& moved, double step, int n)
{
    Matrix<12, 12> tangent{};
    for (int k = 0; k < n; ++k) {
        const double middle = moved[k];
        moved[k] = middle + step;
        const Matrix34 after = forces(at);
        moved[k] = middle - step;
        const Matrix34 slope = (0.5 / step) * (after - forces(at));
        moved[k] = middle;
        for (int i = 0; i < 12; ++i) tangent(i, k) = slope[i];
    }
    return tangent;
}

}   // namespace

void add_python_load(Model& model, const std::string& name, const std::string& body, nb::object function)
{
    const int index = model.find_body(body);
    if (index < 0)
        throw InputError({"body-unknown", "load[" + name + "].body",
                          "load '" + name + "' refers to '" + body + "', but there is no such body", "", "",
                          "", ""});
    const bool is_point = model.bodies()[static_cast<std::size_t>(index)].is_point;
    const double step = 1e-6 * model.length();   // the best for central differences of what is smooth
    const auto kept = held(std::move(function));
    const auto forces = [kept, is_point](const LoadArguments& at) {
        return forces_of(call(*kept, at), at.X[0], is_point);
    };
    Load load;
    load.name = name;
    load.type = "python";
    load.bodies = {index, world};
    load.depends_on_X = load.depends_on_V = true;
    load.needs_directors[0] = !is_point;
    load.forces = [forces](const LoadArguments& at, LoadForces& F) { F[0] = forces(at); };
    load.tangent = [forces, step, is_point](const LoadArguments& given, LoadTangent& tangent) {
        LoadArguments at = given;
        const int n = is_point ? 3 : 12;
        tangent.X[0][0] = slopes(forces, at, at.X[0], step, n);
        tangent.V[0][0] = slopes(forces, at, at.V[0], step, n);
    };
    model.add_load(std::move(load));
}

void add_python_guard(Model& model, const std::string& event, nb::object function)
{
    const auto at = std::ranges::find(model.events(), event, &Event::name);
    if (at == model.events().end())
        throw InputError(
            {"event-condition", "event[" + event + "]", "there is no event '" + event + "'", "", "", "", ""});
    EventTerms terms = at->terms;
    const auto kept = held(std::move(function));
    terms.values = [kept, inputs = at->terms](const LawArguments& given, std::span<const double> reactions,
                                              std::span<double> out) {
        std::vector<double> values(static_cast<std::size_t>(inputs.n_terms));
        inputs.values(given, reactions, values);
        out[0] = ask(*kept, given.at.t, values);
    };
    terms.n_terms = 1;
    terms.when = {{0}};
    Model now(model.gravity());
    for (const Body& body : model.bodies()) now.add_body(body);
    for (const Joint& joint : model.joints()) now.add_joint(joint);
    for (const Load& load : model.loads()) now.add_load(load);
    for (const Sensor& sensor : model.sensors()) now.add_sensor(sensor);
    for (const NamedPoint& point : model.points()) now.add_point(point);
    for (Event one : model.events()) {
        if (one.name == event) one.terms = terms;
        now.add_event(std::move(one));
    }
    model = std::move(now);
}

}   // namespace livens::python
