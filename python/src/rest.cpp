// SPDX-License-Identifier: BSD-3-Clause
// States of rest as Python sees them: where a mechanism rests, how it moves about that, its state matrices.
#include <chrono>
#include <complex>
#include <limits>

#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "livens/diagnostics/quantities.h"
#include "livens/io/known_state.h"
#include "livens/multibody/controllers.h"
#include "livens/multibody/motion.h"
#include "livens/statics/equilibrium.h"
#include "result.h"

namespace livens::python {

namespace {

using Shared = std::shared_ptr<const Scenario>;
using Vectors = std::vector<double>;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Runs what takes time without Python's lock; false of `goes_on` means that Python has something to raise.
template <class Work>
auto unlocked(Work work)
{
    using Clock = std::chrono::steady_clock;
    const auto goes_on = [next = Clock::now()]() mutable {
        if (Clock::now() < next) return true;
        next = Clock::now() + std::chrono::milliseconds(50);
        const nb::gil_scoped_acquire lock;
        return PyErr_Occurred() == nullptr && PyErr_CheckSignals() == 0;
    };
    auto result = [&] {
        const nb::gil_scoped_release unlock;
        return work(goes_on);
    }();
    if (PyErr_Occurred() != nullptr) throw nb::python_error();
    return result;
}

Equilibrium equilibrium_of(const Scenario& scenario, const std::function<bool()>& goes_on)
{
    const KnownState known = known_state(scenario);
    EquilibriumOptions options;
    options.initial = known.initial;
    options.goes_on = goes_on;
    return find_equilibrium(scenario.model, known.state, options);
}

void append(Vectors& all, const Vector3& v) { all.insert(all.end(), v.a, v.a + 3); }

/// [(name, type, [coordinate, ..]), ..], as vibrations and equilibria list joints.
nb::list names_of_joints(const Model& model)
{
    nb::list all;
    for (const Joint& joint : model.joints()) {
        nb::list coordinates;
        for (const NamedCoordinate& q : joint.coordinates) coordinates.append(q.name);
        all.append(nb::make_tuple(joint.name, coordinates));
    }
    return all;
}

nb::list names_of_bodies(const Model& model)
{
    nb::list all;
    for (int b = 0; b < model.n_bodies(); ++b)
        if (!model.bodies()[static_cast<std::size_t>(b)].holds_states()) all.append(model.body_name(b));
    return all;
}

nb::dict stability_of(const StabilityReport& report)
{
    nb::dict d;
    d["status"] = to_string(report.stability);
    d["n_unstable"] = report.n_unstable;
    d["n_neutral"] = report.n_neutral;
    return d;
}

nb::dict found(const Model& model, const Equilibrium& at)
{
    nb::dict d = stability_of(at.stability);
    if (!at.is_found) d["status"] = "no equilibrium";
    d["success"] = at.is_found;
    d["message"] = at.message;
    d["t"] = at.state.t;
    d["degrees_of_freedom"] = at.degrees_of_freedom;
    d["iterations"] = at.iterations;
    d["residual"] = at.residual;
    d["notes"] = at.notes;
    Vectors positions, quaternions, coordinates, forces, torques, efforts, tensions;
    nb::dict states;
    for (const NamedState& state : states_in(model, at.state.V)) states[state.name.c_str()] = state.value;
    d["states"] = states;
    for (int b = 0; b < model.n_bodies(); ++b) {
        const Matrix34& X = at.state.X[static_cast<std::size_t>(b)];
        append(positions, X.column(0));
        const bool is_point = model.bodies()[static_cast<std::size_t>(b)].is_point;
        const Vector4 q = is_point ? Vector4{nan, nan, nan, nan} : quaternion_from_directors(directors(X));
        quaternions.insert(quaternions.end(), q.a, q.a + 4);
    }
    const Model now = frozen(model, {at.state.t});
    nb::list unique, turned;
    for (std::size_t j = 0; j < model.joints().size(); ++j) {
        const Joint& joint = model.joints()[j];
        for (std::size_t k = 0; k < joint.coordinates.size(); ++k) {
            const NamedCoordinate& q = joint.coordinates[k];
            const double value = at.coordinates[j][k];
            coordinates.push_back(value);
            if (std::abs(value - q.at_stated - coordinate_change(q.coordinate, model.start().X, at.state.X)) >
                1)
                turned.append(nb::make_tuple(joint.name, q.name, value));   // bodies do not tell its turns
        }
        Reaction reaction{{nan, nan, nan}, {nan, nan, nan}};
        if (at.is_found) reaction = joint_reaction(now, static_cast<int>(j), at.state.X, at.multipliers);
        append(forces, reaction.force);
        append(torques, reaction.torque);
        const auto effort = drive_effort(joint);
        efforts.push_back(effort ? effort->of(joint, at.state.X, reaction) : nan);
        tensions.push_back(joint.over.empty() ? nan : rope_tension(joint, at.state.X, reaction));
        unique.append(at.is_found && at.joint_is_unique[j]);
    }
    const auto n_bodies = static_cast<std::size_t>(model.n_bodies()), n_joints = model.joints().size();
    const std::size_t n_coordinates = coordinates.size();
    d["bodies"] = names_of_bodies(model);
    d["joints"] = names_of_joints(model);
    d["position"] = array(std::move(positions), {n_bodies, 3});
    d["quaternion"] = array(std::move(quaternions), {n_bodies, 4});
    d["coordinate"] = array(std::move(coordinates), {n_coordinates});
    d["force"] = array(std::move(forces), {n_joints, 3});
    d["torque"] = array(std::move(torques), {n_joints, 3});
    d["effort"] = array(std::move(efforts), {n_joints});
    d["tension"] = array(std::move(tensions), {n_joints});
    d["unique"] = unique;
    d["turned"] = turned;
    return d;
}

nb::dict equilibrium(const Shared& given)
{
    const Scenario scenario = as_it_rests(*given);
    const Equilibrium at =
        unlocked([&](const std::function<bool()>& goes_on) { return equilibrium_of(scenario, goes_on); });
    return found(scenario.model, at);
}

/// About a state of rest.
struct Linear {
    std::shared_ptr<const Model> model;
    Linearisation at;

    std::size_t n() const { return static_cast<std::size_t>(at.n); }
};

/// (linear or None, equilibrium or None): None and what was found where there is no equilibrium.
nb::tuple linearised(const Shared& given, bool at_start)
{
    const Scenario scenario = as_it_rests(*given);
    Equilibrium rest;
    const auto linear = unlocked([&](const std::function<bool()>& goes_on) {
        std::shared_ptr<Linear> made;
        if (at_start)
            return std::make_shared<Linear>(std::make_shared<const Model>(scenario.model),
                                            linearise(scenario.model, known_state(scenario).state));
        rest = equilibrium_of(scenario, goes_on);
        if (rest.is_found)
            made = std::make_shared<Linear>(std::make_shared<const Model>(scenario.model),
                                            linearise(frozen(scenario.model, {rest.state.t}), rest.state));
        return made;
    });
    return nb::make_tuple(linear, at_start ? nb::object(nb::none()) : found(scenario.model, rest));
}

/// Complex numbers as pairs.
void append(Vectors& all, std::complex<double> z)
{
    all.push_back(z.real());
    all.push_back(z.imag());
}

nb::dict modes(const Linear& linear)
{
    const std::vector<VibrationMode> found = vibration_modes(linear.at);
    const Model& model = *linear.model;
    Vectors s, displacements, rotations, coordinates;
    std::size_t n_coordinates = 0;
    for (const VibrationMode& mode : found) {
        append(s, mode.s);
        for (const BodyShape& body : mode.bodies) {
            for (const auto z : body.displacement) append(displacements, z);
            for (const auto z : body.rotation) append(rotations, z);
        }
        for (const Joint& joint : model.joints())
            for (const NamedCoordinate& q : joint.coordinates)
                append(coordinates, amplitude(linear.at, mode, q.coordinate));
    }
    for (const Joint& joint : model.joints()) n_coordinates += joint.coordinates.size();
    const std::size_t n = found.size(), n_bodies = static_cast<std::size_t>(model.n_bodies());
    nb::dict d;
    d["bodies"] = names_of_bodies(model);
    d["joints"] = names_of_joints(model);
    d["s"] = array(std::move(s), {n, 2});
    d["displacement"] = array(std::move(displacements), {n, n_bodies, 3, 2});
    d["rotation"] = array(std::move(rotations), {n, n_bodies, 3, 2});
    d["coordinate"] = array(std::move(coordinates), {n, n_coordinates, 2});
    return d;
}

/// A, B, C, D.
nb::tuple matrices(const Linear& linear, const std::vector<std::string>& inputs,
                   const std::vector<std::string>& outputs)
{
    StateMatrices m = state_matrices(*linear.model, linear.at, inputs, outputs);
    const auto n = static_cast<std::size_t>(m.n_states);
    return nb::make_tuple(array(std::move(m.A), {n, n}), array(std::move(m.B), {n, inputs.size()}),
                          array(std::move(m.C), {outputs.size(), n}),
                          array(std::move(m.D), {outputs.size(), inputs.size()}));
}

}   // namespace

void add_rest(nb::module_& m)
{
    m.def("equilibrium", &equilibrium, nb::arg("scenario"));
    m.def("linearised", &linearised, nb::arg("scenario"), nb::arg("at_start"));
    const auto square = [](Vectors Linearisation::*matrix) {
        return [matrix](const Linear& linear) {
            return array(Vectors(linear.at.*matrix), {linear.n(), linear.n()});
        };
    };
    nb::class_<Linear>(m, "Linear")
        .def_prop_ro("n", [](const Linear& linear) { return linear.at.n; })
        .def_prop_ro("t", [](const Linear& linear) { return linear.at.state.t; })
        .def_prop_ro("length", [](const Linear& linear) { return linear.at.length; })
        .def_prop_ro("mass", square(&Linearisation::M))
        .def_prop_ro("damping", square(&Linearisation::C))
        .def_prop_ro("stiffness", square(&Linearisation::K))
        .def_prop_ro("stability", [](const Linear& linear) { return stability_of(stability(linear.at)); })
        .def("modes", &modes)
        .def("matrices", &matrices, nb::arg("inputs"), nb::arg("outputs"));
}

}   // namespace livens::python
