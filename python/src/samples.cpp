// SPDX-License-Identifier: BSD-3-Clause
// A motion at given instants, as arrays: one dict for bodies, joints, coordinates, sensors, loads, energies.
#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>
#include <map>
#include <string>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "livens/base/error.h"
#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/quantities.h"
#include "livens/diagnostics/rigidity.h"
#include "livens/diagnostics/sample.h"
#include "livens/io/peaks.h"
#include "livens/solvers/patience.h"
#include "livens/spacetime/solve.h"
#include "result.h"

namespace livens::python {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Arrays whose first dimension is time, filled instant by instant.
class Columns {
public:
    explicit Columns(std::size_t n_times) : n_times_(n_times) {}

    void declare(const std::string& name, const std::vector<std::size_t>& shape)
    {
        Column& column = columns_[name];
        column.shape = {n_times_};
        std::size_t n = n_times_;
        for (const std::size_t size : shape) column.shape.push_back(size), n *= size;
        column.numbers.reserve(n);
    }
    void add(const std::string& name, double x) { columns_.at(name).numbers.push_back(x); }
    template <int R, int C>
    void add(const std::string& name, const Matrix<R, C>& m)
    {
        std::vector<double>& numbers = columns_.at(name).numbers;
        numbers.insert(numbers.end(), m.data(), m.data() + R * C);
    }

    /// With the lock.
    nb::dict take()
    {
        nb::dict all;
        for (auto& [name, column] : columns_)
            all[name.c_str()] = array(std::move(column.numbers), column.shape);
        return all;
    }

private:
    struct Column {
        std::vector<std::size_t> shape;
        std::vector<double> numbers;
    };
    std::size_t n_times_;
    std::map<std::string, Column> columns_;
};

/// From which side an instant is seen: those of `before` that are not zero are seen from the left; of a
/// single instant or where there is no list, from the right.
Side side_of(const Times& before, std::size_t i)
{
    return before.size() > i && before.data()[i] != 0 ? Side::left : Side::right;
}

/// work(t, i) for all instants, without the lock, which is taken now and then to look for signals.
template <class Work>
void at_all(const Times& times, const Work& work)
{
    using Clock = std::chrono::steady_clock;
    const nb::gil_scoped_release unlock;
    Clock::time_point next = Clock::now() + std::chrono::milliseconds(50);
    for (std::size_t i = 0; i < times.size(); ++i) {
        work(times.data()[i], i);
        if (i % 16 != 15 || Clock::now() < next) continue;
        const nb::gil_scoped_acquire lock;
        if (PyErr_CheckSignals() != 0) throw nb::python_error();
        next = Clock::now() + std::chrono::milliseconds(50);
    }
}

void declare_bodies(Columns& c, std::size_t n)
{
    for (const char* name : {"position", "center_of_mass", "velocity", "angular_velocity",
                             "angular_velocity_body", "linear_momentum", "angular_momentum"})
        c.declare(name, {n, 3});
    for (const char* name : {"directors", "directors_raw"}) c.declare(name, {n, 3, 3});
    c.declare("quaternion", {n, 4});
}

/// Columns of directors are rows of the array: [d1, d2, d3].
void add_bodies(Columns& c, std::vector<BodySample>&& samples, std::vector<Vector4>& previous)
{
    for (std::size_t b = 0; b < samples.size(); ++b) {
        BodySample& s = samples[b];
        previous[b] = s.quaternion = continued(previous[b], s.quaternion);
        c.add("position", s.position);
        c.add("center_of_mass", s.center_of_mass);
        c.add("velocity", s.velocity);
        c.add("angular_velocity", s.angular_velocity);
        c.add("angular_velocity_body", s.angular_velocity_body);
        c.add("linear_momentum", s.linear_momentum);
        c.add("angular_momentum", s.angular_momentum);
        c.add("directors", s.directors);
        c.add("directors_raw", s.directors_raw);
        c.add("quaternion", s.quaternion);
    }
}

void declare_rigidity(Columns& c, std::size_t n)
{
    for (const char* name : {"rigidity", "rigidity_before"}) c.declare(name, {n, 3, 3});
    c.declare("rigidity_unique", {n});
}

void add_rigidity(Columns& c, const std::vector<RigiditySample>& samples)
{
    for (const RigiditySample& s : samples) {
        c.add("rigidity", s.right);
        c.add("rigidity_before", s.left);
        c.add("rigidity_unique", s.is_unique ? 1 : 0);
    }
}

void declare_joints(Columns& c, std::size_t n)
{
    for (const char* name : {"force", "torque", "force_before", "torque_before"}) c.declare(name, {n, 3});
    for (const char* name : {"is_unique", "is_bounded"}) c.declare(name, {n});
}

void add_joints(Columns& c, std::vector<JointSample>&& samples, std::size_t n)
{
    const Reaction none{{unknown, unknown, unknown}, {unknown, unknown, unknown}};
    if (samples.empty()) samples.assign(n, {none, none, false, false, false});
    for (const JointSample& s : samples) {
        c.add("force", s.right.force);
        c.add("torque", s.right.torque);
        c.add("force_before", s.left.force);
        c.add("torque_before", s.left.torque);
        c.add("is_unique", s.is_unique ? 1 : 0);
        c.add("is_bounded", s.is_bounded ? 1 : 0);
    }
}

std::vector<Vector4> upright(const Model& model)
{
    return std::vector<Vector4>(static_cast<std::size_t>(model.n_bodies()), Vector4{1, 0, 0, 0});
}

nb::dict bodies_at(const Result& r, const Times& times)
{
    Columns c(times.size());
    const Model& model = r.scenario->model;
    std::vector<Vector4> previous = upright(model);
    declare_bodies(c, previous.size());
    at_all(times,
           [&](double t, std::size_t) { add_bodies(c, sample_bodies(model, r.run.motion, t), previous); });
    return c.take();
}

nb::dict rigidity_at(const Result& r, const Times& times)
{
    Columns c(times.size());
    const Model& model = r.scenario->model;
    declare_rigidity(c, model.bodies().size());
    const Rigidity rigidity(model, r.run.motion);
    at_all(times, [&](double t, std::size_t) { add_rigidity(c, rigidity.at(t)); });
    return c.take();
}

/// m^3, one a body; nan where no shape tells.
nb::object body_volumes(const Result& r)
{
    std::vector<double> volumes;
    for (const Body& body : r.scenario->model.bodies())
        volumes.push_back(body.volume > 0 ? body.volume : unknown);
    const std::size_t n = volumes.size();
    return array(std::move(volumes), {n});
}

nb::dict joints_at(const Result& r, const Times& times)
{
    Columns c(times.size());
    const Model& model = r.scenario->model;
    const std::size_t n = model.joints().size();
    declare_joints(c, n);
    const JointSampler joints(model, r.run.motion);
    at_all(times, [&](double t, std::size_t) { add_joints(c, joints.at(sample_state(r.run.motion, t)), n); });
    return c.take();
}

std::vector<NamedCoordinate> coordinates_of(const Model& model)
{
    std::vector<NamedCoordinate> all;
    for (const Joint& joint : model.joints())
        all.insert(all.end(), joint.coordinates.begin(), joint.coordinates.end());
    return all;
}

/// The model with a sensor for each of its loads, behind its own.
Model with_load_sensors(const Model& model)
{
    Model all = model;
    for (int i = 0; i < static_cast<int>(model.loads().size()); ++i) {
        if (model.loads()[static_cast<std::size_t>(i)].type == controller_type) continue;
        std::string name = "load " + std::to_string(i);
        while (std::ranges::any_of(model.sensors(), [&](const Sensor& s) { return s.name == name; }))
            name += "'";
        all.add_sensor(load_sensor(name, i, model.loads()[static_cast<std::size_t>(i)]));
    }
    return all;
}

std::size_t n_readings(const Model& model)
{
    std::size_t n = 0;
    for (const Sensor& sensor : model.sensors()) n += sensor.components.size();
    return n;
}

/// What follows from states, whether these are of the polynomials or solved.
class OfStates {
public:
    OfStates(const Result& r, std::size_t n_times)
        : c(n_times), model_(with_load_sensors(r.scenario->model)), readings_(model_, r.run.motion),
          coordinates_(model_, r.run.motion, coordinates_of(model_)), turns_(model_, r.run.motion),
          accelerations_(model_, r.run.motion)
    {
        const std::size_t n = coordinates_of(model_).size();
        c.declare("coordinate", {n});
        c.declare("coordinate_rate", {n});
        c.declare("reading", {n_readings(model_)});
        c.declare("kinetic", {});
        c.declare("potential", {});
    }

    void add(const State& given, Side side)
    {
        const State state = accelerations_.on_joints(given);
        for (const CoordinateValue& q : coordinates_.at(state)) {
            c.add("coordinate", q.value);
            c.add("coordinate_rate", q.rate);
        }
        for (const double x : readings_.at(given, side)) c.add("reading", x);
        c.add("kinetic", kinetic_energy(model_, state.X, state.V));
        c.add("potential", potential_energy(model_, {state.t, side}, state.X, state.V, turns_.at(state)));
    }

    Columns c;

private:
    Model model_;
    SensorReadings readings_;
    FollowedCoordinates coordinates_;
    LoadTurns turns_;
    Accelerations accelerations_;
};

nb::dict scalars_at(const Result& r, const Times& times, const Times& before)
{
    OfStates of_states(r, times.size());
    at_all(times, [&](double t, std::size_t i) {
        of_states.add(sample_state(r.run.motion, t), side_of(before, i));
    });
    return of_states.c.take();
}

bool is_acceleration(const NamedQuantity& q)
{
    return (q.of == QuantityOf::body || q.of == QuantityOf::coordinate) && q.what.ends_with("acceleration");
}

/// Accelerations of bodies and coordinates, and what drives do.
class OfEquations {
public:
    OfEquations(const Result& r, bool (*is_wanted)(const NamedQuantity&))
        : quantities_(r.scenario->model, r.run.motion, r.run.body_names),
          numbers_(static_cast<std::size_t>(quantities_.n_numbers()))
    {
        for (const NamedQuantity& q : quantities_.all())
            if (is_wanted(q)) wanted_.push_back(q);
    }

    void declare(Columns& c) const
    {
        std::map<std::string, std::size_t> sizes;
        for (const NamedQuantity& q : wanted_) sizes[column_of(q)] += static_cast<std::size_t>(q.size);
        for (const auto& [name, size] : sizes)
            c.declare(name, name == "acceleration" || name == "angular_acceleration"
                                ? std::vector<std::size_t>{size / 3, 3}
                                : std::vector<std::size_t>{size});
    }
    void add(Columns& c, const State& state, Side side, std::span<const JointSample> joints = {})
    {
        quantities_.at(state, side, wanted_, numbers_, joints);
        for (const NamedQuantity& q : wanted_)
            for (int i = 0; i < q.size; ++i)
                c.add(column_of(q), numbers_[static_cast<std::size_t>(q.first + i)]);
    }

private:
    static std::string column_of(const NamedQuantity& q)
    {
        if (q.of == QuantityOf::body) return q.what;
        return q.of == QuantityOf::coordinate ? "coordinate_acceleration"
                                              : q.what + " " + std::to_string(q.index);
    }

    Quantities quantities_;
    std::vector<NamedQuantity> wanted_;
    std::vector<double> numbers_;
};

nb::dict of_equations_at(const Result& r, const Times& times, const Times& before,
                         bool (*is_wanted)(const NamedQuantity&))
{
    Columns c(times.size());
    OfEquations of_equations(r, is_wanted);
    of_equations.declare(c);
    at_all(times, [&](double t, std::size_t i) {
        of_equations.add(c, sample_state(r.run.motion, t), side_of(before, i));
    });
    return c.take();
}

nb::dict accelerations_at(const Result& r, const Times& times, const Times& before)
{
    return of_equations_at(r, times, before, &is_acceleration);
}

nb::dict drives_at(const Result& r, const Times& times, const Times& before)
{
    return of_equations_at(r, times, before,
                           [](const NamedQuantity& q) { return q.of == QuantityOf::drive; });
}

/// (t, whether it is seen from before): enough to show the motion as it is.
nb::tuple dense(const Result& r)
{
    std::vector<double> t, before;
    for (const SeenInstant& seen : dense_instants(r.run.motion)) {
        t.push_back(seen.t);
        before.push_back(seen.side == Side::left ? 1 : 0);
    }
    const std::size_t n = t.size();
    return nb::make_tuple(array(std::move(t), {n}), array(std::move(before), {n}));
}

/// (name, unit, least, its instant, largest, its instant, where there is none) of each.
nb::list peaks(const Result& r, const std::vector<std::string>& names)
{
    std::vector<Extremes> found;
    {
        const nb::gil_scoped_release unlock;
        const std::function<bool()> goes_on = [] {
            const nb::gil_scoped_acquire lock;
            return PyErr_CheckSignals() == 0;
        };
        const Patience patience(goes_on);
        try {
            found = find_peaks(r.run, *r.scenario, r.method, names);
        } catch (const Stopped&) {
            const nb::gil_scoped_acquire lock;
            throw nb::python_error();
        }
    }
    nb::list all;
    for (const Extremes& e : found)
        all.append(nb::make_tuple(e.name, e.unit, e.least.value, e.least.t, e.largest.value, e.largest.t,
                                  e.lost_at));
    return all;
}

/// Everything, each instant solved in the full order of the method.
nb::dict exact_at(const Result& r, const Times& times)
{
    const Model& model = r.scenario->model;
    const std::size_t n_joints = model.joints().size();
    OfStates all(r, times.size());
    OfEquations of_equations(
        r, [](const NamedQuantity& q) { return q.of == QuantityOf::drive || is_acceleration(q); });
    of_equations.declare(all.c);
    std::vector<Vector4> previous = upright(model);
    declare_bodies(all.c, previous.size());
    declare_joints(all.c, n_joints);
    declare_rigidity(all.c, model.bodies().size());
    const Rigidity rigidity(model, r.run.motion);
    const ExactSampler exact(model, r.run.motion, r.method, r.scenario->options);
    at_all(times, [&](double t, std::size_t) {
        ExactSample s = exact.at(t);
        if (!s.report.converged())
            throw InputError({"sample-exact-method", "",
                              "the motion cannot be had exactly at this instant: " + s.report.message, "", "",
                              "", "take the polynomials, without exact=True"});
        std::vector<BodySample> bodies;
        for (std::size_t b = 0; b < model.bodies().size(); ++b)
            bodies.push_back(sample_body(model.bodies()[b], s.state.X[b], s.state.V[b],
                                         s.state.V[b] * model.bodies()[b].mass));
        add_bodies(all.c, std::move(bodies), previous);
        const Side side = t == r.run.motion.end() ? Side::left : Side::right;
        of_equations.add(all.c, s.state, side, s.joints);
        add_joints(all.c, std::move(s.joints), n_joints);
        add_rigidity(all.c, rigidity.at(s.state));
        all.add(s.state, side);
    });
    return all.c.take();
}

/// Balances at element ends.
nb::dict balance_at_ends(const Result& r)
{
    Balance made;
    const Balance* b = r.run.verdict.series ? &r.run.verdict.series->balance : &made;
    if (b == &made) {
        const nb::gil_scoped_release unlock;
        made = balance(r.scenario->model, r.run.motion);
    }
    const std::size_t n = b->t.size();
    nb::dict all;
    const auto add = [&](const char* name, std::vector<double> values) {
        all[name] = array(std::move(values), {n});
    };
    add("kinetic", b->kinetic);
    add("potential", b->potential);
    add("energy", b->energy);
    add("work", b->work);
    add("energy_drift", b->energy_drift);
    const auto add_vectors = [&](const char* name, const std::vector<Vector3>& vectors) {
        std::vector<double> values;
        for (const Vector3& v : vectors) values.insert(values.end(), v.a, v.a + 3);
        all[name] = array(std::move(values), {n, 3});
    };
    add_vectors("linear_momentum", b->linear_momentum);
    add_vectors("angular_momentum", b->angular_momentum);
    return all;
}

/// The instants, each element end where it is meant. Throws InputError (`time-outside`).
nb::object snapped(const Result& r, const Times& times)
{
    std::vector<double> all;
    for (std::size_t i = 0; i < times.size(); ++i)
        all.push_back(snap_to_element_end(r.run.motion.mesh, times.data()[i]));
    const std::size_t n = all.size();
    return array(std::move(all), {n});
}

}   // namespace

std::map<std::string, std::string> drive_columns(const Result& r)
{
    std::map<std::string, std::string> names;
    const Model& model = r.scenario->model;
    if (r.run.motion.multipliers.empty() && r.run.motion.end_multipliers.empty()) return names;
    for (std::size_t j = 0; j < model.joints().size(); ++j) {
        const Joint& joint = model.joints()[j];
        if (!joint.over.empty()) names["tension " + std::to_string(j)] = "N";
        if (joint.type != "drive") continue;
        if (const auto effort = drive_effort(joint))
            names["effort " + std::to_string(j)] = effort->coordinate.is_angle() ? "N m" : "N";
        names["power " + std::to_string(j)] = "W";
    }
    return names;
}

void add_samples(nb::class_<Result>& result)
{
    result.def("snapped", &snapped, nb::arg("t"))
        .def("bodies_at", &bodies_at, nb::arg("t"))
        .def("rigidity_at", &rigidity_at, nb::arg("t"))
        .def("body_volumes", &body_volumes)
        .def("joints_at", &joints_at, nb::arg("t"))
        .def("scalars_at", &scalars_at, nb::arg("t"), nb::arg("before"))
        .def("accelerations_at", &accelerations_at, nb::arg("t"), nb::arg("before"))
        .def("drives_at", &drives_at, nb::arg("t"), nb::arg("before"))
        .def("dense", &dense)
        .def("peaks", &peaks, nb::arg("names"))
        .def("exact_at", &exact_at, nb::arg("t"))
        .def("balance", &balance_at_ends);
}

}   // namespace livens::python
