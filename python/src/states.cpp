// SPDX-License-Identifier: BSD-3-Clause
// States in joint coordinates as Python sees them; names and units are made in the package around.
#include <algorithm>
#include <limits>
#include <optional>

#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "livens/dynamics/coordinates/generalised_state.h"
#include "livens/io/known_state.h"
#include "result.h"

namespace livens::python {

namespace {

using Shared = std::shared_ptr<const Scenario>;
using Numbers = std::vector<double>;
using Of = GeneralisedCoordinate::Of;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

GeneralisedCoordinates coordinates(const Shared& scenario, const std::vector<std::string>& wanted,
                                   std::optional<double> t)
{
    KnownState known = known_state(*scenario);
    known.state.t = t.value_or(known.state.t);
    const nb::gil_scoped_release unlock;
    return {scenario->model, known.state, known.initial, wanted};
}

/// All that may be coordinates.
std::vector<std::string> coordinate_names(const Shared& scenario)
{
    std::vector<std::string> names;
    for (const Joint& joint : scenario->model.joints())
        for (const NamedCoordinate& q : joint.coordinates) names.push_back(joint.name + "." + q.name);
    for (const Body& body : scenario->model.bodies()) {
        for (const char axis : {'x', 'y', 'z'}) names.push_back(body.name + "." + axis);
        if (!body.is_point) names.push_back(body.name + ".quaternion");
    }
    return names;
}

/// Of a rotation vector (3 numbers), or of directors one after the other (9).
Numbers quaternion_of(const Numbers& given)
{
    Matrix3 triad{};
    if (given.size() == 9)
        std::copy(given.begin(), given.end(), triad.a);
    else
        triad = directors_from_rotation_vector({given[0], given[1], given[2]});
    const Vector4 q = quaternion_from_directors(project_directors(triad));
    return {q.a, q.a + 4};
}

Numbers directors_of(const Numbers& q)
{
    const Matrix3 triad = directors_from_quaternion({q[0], q[1], q[2], q[3]});
    return {triad.a, triad.a + 9};
}

/// [(name, what it is, numbers, rates), ..]
nb::list list_of(const GeneralisedCoordinates& coordinates)
{
    nb::list all;
    for (const GeneralisedCoordinate& c : coordinates.list())
        all.append(nb::make_tuple(c.name,
                                  c.of == Of::joint   ? "joint"
                                  : c.of == Of::place ? "place"
                                                      : "turn",
                                  c.n_numbers(), c.n_rates()));
    return all;
}

nb::object vector_of(Numbers&& numbers)
{
    const std::size_t n = numbers.size();
    return array(std::move(numbers), {n});
}

void append(Numbers& all, const Vector3& v) { all.insert(all.end(), v.a, v.a + 3); }

/// Bodies: position, quaternion, velocity, angular velocity, 13 numbers each.
nb::object bodies_of(const GeneralisedState& at)
{
    Numbers all;
    for (std::size_t b = 0; b < at.state().X.size(); ++b) {
        const Matrix34 &X = at.state().X[b], &V = at.state().V[b];
        const bool is_point = at.model().bodies()[b].is_point;
        const Vector4 q = is_point ? Vector4{nan, nan, nan, nan} : quaternion_from_directors(directors(X));
        append(all, X.column(0));
        all.insert(all.end(), q.a, q.a + 4);
        append(all, V.column(0));
        append(all, is_point ? Vector3{nan, nan, nan} : angular_velocity(X, V));
    }
    return array(std::move(all), {at.state().X.size(), 13});
}

/// [(point, position, velocity), ..] of named points, world axes.
nb::list points_of(const GeneralisedState& at)
{
    const auto numbers = [](const Vector3& v) { return array(Numbers(v.a, v.a + 3), {3}); };
    nb::list all;
    for (const NamedPoint& point : at.model().points()) {
        Vector3 position = point.position, velocity{};
        if (point.body != world) {
            const auto b = static_cast<std::size_t>(point.body);
            const Matrix34 &X = at.state().X[b], &V = at.state().V[b];
            position = X.column(0) + directors(X) * point.position;
            velocity = V.column(0) + directors(V) * point.position;
        }
        all.append(nb::make_tuple(point.name, numbers(position), numbers(velocity)));
    }
    return all;
}

/// [(joint, [(coordinate, value, rate, as it is placed), ..]), ..], angles with their turns.
nb::list joints_of(const GeneralisedState& at)
{
    const Model& model = at.model();
    const std::vector<std::vector<double>> counted = at.coordinates();
    nb::list all;
    for (std::size_t j = 0; j < counted.size(); ++j) {
        nb::list values;
        for (std::size_t k = 0; k < counted[j].size(); ++k) {
            const NamedCoordinate& q = model.joints()[j].coordinates[k];
            values.append(nb::make_tuple(q.name, counted[j][k],
                                         coordinate_rate(q.coordinate, at.state().X, at.state().V),
                                         q.at_stated));
        }
        all.append(nb::make_tuple(model.joints()[j].name, values));
    }
    return all;
}

/// A point in the coordinates that its user counts, which are skew where directors are.
Vector3 point_of(const GeneralisedState& at, int body, const Numbers& point)
{
    return at.model().bodies()[static_cast<std::size_t>(body)].stretch *
           Vector3{point[0], point[1], point[2]};
}

template <auto method>
nb::object vector_by(const GeneralisedState& at)
{
    return vector_of((at.*method)());
}

nb::tuple slopes(const GeneralisedState& at)
{
    StateSlopes slopes = [&] {
        const nb::gil_scoped_release unlock;
        return at.slopes();
    }();
    const auto n = static_cast<std::size_t>(slopes.n);
    return nb::make_tuple(array(std::move(slopes.A), {2 * n, 2 * n}), array(std::move(slopes.B), {2 * n, n}));
}

/// `directors`: nine numbers, d1, d2, d3 one after the other; none: however it is turned.
GeneralisedState reaching(const GeneralisedState& at, int body, const Numbers& point, const Numbers& position,
                          const std::optional<Numbers>& turned)
{
    StateTarget target{body, point_of(at, body, point), {position[0], position[1], position[2]}};
    if (turned) {
        Matrix3 triad{};
        std::copy(turned->begin(), turned->end(), triad.a);
        target.directors = project_directors(triad);
    }
    const nb::gil_scoped_release unlock;
    return at.reaching(target);
}

}   // namespace

void add_states(nb::module_& m)
{
    nb::class_<GeneralisedCoordinates>(m, "GeneralisedCoordinates")
        .def_prop_ro("entries", &list_of)
        .def_prop_ro("names_of_numbers", &GeneralisedCoordinates::names_of_numbers)
        .def_prop_ro("names_of_rates", &GeneralisedCoordinates::names_of_rates)
        .def_prop_ro("placed", [](const GeneralisedCoordinates& c) { return vector_of(Numbers(c.placed())); })
        .def(
            "at",
            [](const GeneralisedCoordinates& c, const Numbers& q, const Numbers& v) {
                const nb::gil_scoped_release unlock;
                return c.at(q, v);
            },
            nb::arg("q"), nb::arg("v"));
    nb::class_<GeneralisedState>(m, "GeneralisedState")
        .def_prop_ro("q", [](const GeneralisedState& at) { return vector_of(Numbers(at.numbers())); })
        .def_prop_ro("v", [](const GeneralisedState& at) { return vector_of(Numbers(at.rates())); })
        .def_prop_ro("t", [](const GeneralisedState& at) { return at.state().t; })
        .def_prop_ro("bodies", &bodies_of)
        .def_prop_ro("joints", &joints_of)
        .def_prop_ro("points", &points_of)
        .def_prop_ro("mass_matrix",
                     [](const GeneralisedState& at) {
                         const std::size_t n = at.rates().size();
                         return array(at.mass_matrix(), {n, n});
                     })
        .def_prop_ro("bias_forces", &vector_by<&GeneralisedState::bias_forces>)
        .def_prop_ro("gravity_forces", &vector_by<&GeneralisedState::gravity_forces>)
        .def_prop_ro("load_forces", &vector_by<&GeneralisedState::load_forces>)
        .def_prop_ro("kinetic", &GeneralisedState::kinetic_energy)
        .def_prop_ro("potential", &GeneralisedState::potential_energy)
        .def(
            "inverse_dynamics",
            [](const GeneralisedState& at, const Numbers& a) { return vector_of(at.inverse_dynamics(a)); },
            nb::arg("accelerations"))
        .def(
            "accelerations",
            [](const GeneralisedState& at, const Numbers& f) { return vector_of(at.accelerations(f)); },
            nb::arg("forces"))
        .def(
            "jacobian",
            [](const GeneralisedState& at, int body, const Numbers& point) {
                return array(at.jacobian(body, point_of(at, body, point)), {6, at.rates().size()});
            },
            nb::arg("body"), nb::arg("point"))
        .def(
            "drift",
            [](const GeneralisedState& at, int body, const Numbers& point) {
                return vector_of(at.drift(body, point_of(at, body, point)));
            },
            nb::arg("body"), nb::arg("point"))
        .def("slopes", &slopes)
        .def("reaching", &reaching, nb::arg("body"), nb::arg("point"), nb::arg("position"),
             nb::arg("directors").none());
    m.def("coordinate_names", &coordinate_names, nb::arg("scenario"));
    m.def("quaternion", &quaternion_of, nb::arg("turn"));
    m.def("directors", &directors_of, nb::arg("quaternion"));
    m.def("coordinates", &coordinates, nb::arg("scenario"), nb::arg("wanted"), nb::arg("t").none());
}

}   // namespace livens::python
