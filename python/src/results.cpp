// SPDX-License-Identifier: BSD-3-Clause
// Results as Python sees them: views of the motion, figures, files.
#include <algorithm>
#include <filesystem>
#include <span>
#include <system_error>
#include <tuple>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "livens/io/exports.h"
#include "livens/io/report.h"
#include "livens/io/results/figures.h"
#include "livens/io/results/layout.h"
#include "livens/io/shown_unit.h"
#include "livens/io/solve_scenario.h"
#include "livens/io/verdict_words.h"
#include "livens/solvers/patience.h"
#include "result.h"

namespace livens::python {

namespace {

using Self = nb::handle_t<Result>;

const Result& result_of(Self self) { return nb::cast<const Result&>(self); }

/// Configurations at all nodes: (node, body, 4, 3).
nb::object nodes(Self self)
{
    const Motion& m = result_of(self).run.motion;
    const std::size_t n = static_cast<std::size_t>(m.n_bodies);
    return view(m.X.values.data(), {m.X.values.size() / (12 * n), n, 4, 3}, self);
}

/// Configurations at element ends, or None where X jumps there, so that it has two of them.
nb::object end_configurations(Self self)
{
    const Motion& m = result_of(self).run.motion;
    if (!m.X.continuous || m.X.degree < 1) return nb::none();
    const std::size_t n = static_cast<std::size_t>(m.n_bodies);
    const std::int64_t row = 12 * m.n_bodies;
    return view(m.X.values.data(), {m.mesh.ends.size(), n, 4, 3}, self, {row * m.X.degree, 12, 3, 1});
}

nb::object end_velocities(Self self)
{
    const Motion& m = result_of(self).run.motion;
    const std::size_t n = static_cast<std::size_t>(m.n_bodies);
    const double* data = m.velocities.empty() ? nullptr : m.velocities.front().data();
    return view(data, {m.velocities.size() / n, n, 4, 3}, self);
}

nb::object list_view(Self self, const std::vector<double>& values, std::size_t columns)
{
    if (columns == 0) return view(values.data(), {values.size()}, self);
    return view(values.data(), {values.size() / columns, columns}, self);
}

nb::dict estimates(Self self)
{
    const ErrorEstimate& e = result_of(self).run.estimate;
    nb::dict all;
    const auto add = [&](const char* name, const std::vector<double>& values, int columns) {
        if (!values.empty() && columns > 0)
            all[name] = list_view(self, values, static_cast<std::size_t>(columns));
    };
    add("position", e.position, e.n_bodies);
    add("orientation", e.orientation, e.n_bodies);
    add("velocity", e.velocity, e.n_bodies);
    add("reaction", e.reaction, e.n_joints);
    return all;
}

nb::dict figures(const Result& r)
{
    nb::dict all;
    for (const Figure& figure : run_figures()) {
        const double value = figure_of(r.run, figure);
        const bool is_none = value != value || (figure.zero_is_none && value == 0);
        nb::object number = nb::none();
        if (!is_none)
            number = is_whole(figure) ? nb::object(nb::int_(static_cast<long long>(value)))
                                      : nb::object(nb::float_(value));
        all[figure.name] = number;
    }
    return all;
}

/// name -> (unit, meaning)
nb::dict figure_meanings()
{
    nb::dict all;
    for (const Figure& figure : run_figures()) all[figure.name] = nb::make_tuple(figure.unit, figure.meaning);
    return all;
}

/// Of joints (with drives): name, type, [(coordinate, unit)]; of sensors likewise.
nb::list joints(const Result& r)
{
    nb::list all;
    for (const Joint& joint : r.scenario->model.joints()) {
        nb::list coordinates;
        for (const NamedCoordinate& c : joint.coordinates)
            coordinates.append(nb::make_tuple(c.name, c.coordinate.is_angle() ? "rad" : "m"));
        all.append(nb::make_tuple(joint.name, joint.type, coordinates));
    }
    return all;
}

nb::list sensors(const Result& r)
{
    nb::list all;
    for (const Sensor& sensor : r.scenario->model.sensors()) {
        nb::list components;
        for (const SensorComponent& c : sensor.components) components.append(nb::make_tuple(c.name, c.unit));
        all.append(nb::make_tuple(sensor.name, sensor.type, components));
    }
    return all;
}

/// Of named points: name, body (None: the world) and place in its axes.
nb::list points(const Result& r)
{
    nb::list all;
    const Model& model = r.scenario->model;
    for (const NamedPoint& point : model.points()) {
        const Vector3& p = point.position;
        all.append(nb::make_tuple(
            point.name,
            point.body == world ? nb::none() : nb::object(nb::str(model.body_name(point.body).c_str())),
            nb::make_tuple(p[0], p[1], p[2])));
    }
    return all;
}

nb::list loads(const Result& r)
{
    nb::list all;
    for (const Load& load : r.scenario->model.loads()) {
        if (load.type == controller_type) continue;
        nb::list components;
        for (const LoadReading& c : load.readings) components.append(nb::make_tuple(c.name, c.unit));
        components.append(nb::make_tuple("power", "W"));
        all.append(nb::make_tuple(load.name, load.type, components));
    }
    return all;
}

/// A file's run with the scenario in it.
Result with_scenario(Run run, const std::string& name)
{
    ScenarioResult read = parse_scenario(run.scenario_text, name, {{}, run.meshes});
    if (!read.scenario)
        throw IoError("the scenario in '" + name + "' cannot be read by this version of livens: " +
                          (read.diagnostics.empty() ? "" : read.diagnostics.front().message),
                      "io-damaged");
    take_events(run, *read.scenario);
    check_model(read.scenario->model, run);
    Method method = read.scenario->method;
    return {std::make_shared<Scenario>(std::move(*read.scenario)), std::move(run), std::move(method)};
}

/// One page for a browser.
std::string report(const Result& result, const std::string& name, const Result* other,
                   const std::string& other_name)
{
    const nb::gil_scoped_release unlock;
    const ReportInput here{*result.scenario, result.run, name};
    if (other == nullptr) return report_page(here);
    const ReportInput there{*other->scenario, other->run, other_name};
    return report_page(here, &there);
}

Result load_result(const std::string& file)
{
    const nb::gil_scoped_release unlock;
    return with_scenario(read_run(file), file);
}

bool is_same_file(const std::string& a, const std::string& b)
{
    std::error_code error;
    return std::filesystem::equivalent(a, b, error) && !error;
}

/// Why what stands at `file` is not to be replaced by what is of this kind: of the `inputs` never, of all
/// that is neither empty nor of this kind unless `force`. Empty: it may be.
std::string objection(const std::string& file, const std::string& kind,
                      const std::vector<std::string>& inputs, bool force)
{
    for (const std::string& input : inputs)
        if (is_same_file(file, input)) return "it is what the model was read from";
    const auto is_none = [](std::string_view) { return false; };
    bool (*is_own)(std::string_view) = kind == "run"      ? begins_as_run
                                       : kind == "report" ? begins_as_report
                                                          : +is_none;
    for (const ExportFormat& f : export_formats())
        if (f.word == kind) is_own = f.is_own;
    if (force || !is_occupied(file, is_own)) return "";
    return "the file there was not written by livens as this kind; choose another name, or say "
           "force=True to replace it";
}

std::vector<std::string> inputs(const Result& r)
{
    std::vector<std::string> files{r.scenario->file};
    for (const std::filesystem::path& mesh : r.scenario->mesh_files) files.push_back(mesh.string());
    return files;
}

void write_file(const std::string& file, const nb::bytes& bytes)
{
    const std::string_view view(bytes.c_str(), bytes.size());
    const nb::gil_scoped_release unlock;
    replace_file(file, view);
}

void save(const Result& r, const std::string& file)
{
    const nb::gil_scoped_release unlock;
    check_writable(file);
    write_run(file, r.scenario->model, r.run);
}

nb::bytes to_bytes(const Result& r)
{
    std::string bytes;
    {
        const nb::gil_scoped_release unlock;
        const ByteSink sink = [&](std::uint64_t offset, std::string_view piece) {
            if (bytes.size() < offset + piece.size()) bytes.resize(offset + piece.size());
            bytes.replace(offset, piece.size(), piece);
        };
        write_run_to(sink, r.scenario->model, r.run);
    }
    return nb::bytes(bytes.data(), bytes.size());
}

Result from_bytes(const nb::bytes& bytes)
{
    const std::string_view view(bytes.c_str(), bytes.size());
    const nb::gil_scoped_release unlock;
    const ByteSource source{view.size(), [view](std::uint64_t offset, std::span<char> out) {
                                std::copy_n(view.begin() + static_cast<std::ptrdiff_t>(offset), out.size(),
                                            out.begin());
                            }};
    return with_scenario(read_run_from(source), "pickle");
}

/// What is doubtful of it. Throws what Python's signals throw.
std::string export_to(const Result& r, const std::string& format, const std::string& result,
                      const std::string& file, bool force, int instants,
                      const std::vector<std::string>& units, const nb::dict& picture)
{
    PictureOptions o;
    const auto take = [&](const char* name, auto& member) {
        if (picture.contains(name))
            member = nb::cast<std::remove_reference_t<decltype(member)>>(picture[name]);
    };
    take("width", o.width);
    take("height", o.height);
    take("fps", o.rate);
    take("duration", o.duration);
    take("start", o.from);
    take("end", o.to);
    take("view", o.view);
    take("dark", o.is_dark);
    take("names", o.names);
    take("clock", o.clock);
    const nb::gil_scoped_release unlock;
    const std::function<bool()> goes_on = [] {
        const nb::gil_scoped_acquire lock;
        return PyErr_CheckSignals() == 0;
    };
    const Patience patience(goes_on);
    std::string doubt;
    try {
        const ExportInput input{result, *r.scenario, r.run, force, static_cast<Instants>(instants), units, o};
        for (const ExportFormat& f : export_formats()) {
            if (f.word != format) continue;
            if (f.doubt != nullptr) doubt = f.doubt(input);
            f.write(file, input);
        }
    } catch (const Stopped&) {
        const nb::gil_scoped_acquire lock;
        throw nb::python_error();
    }
    return doubt;
}

}   // namespace

nb::object view(const double* data, std::vector<std::size_t> shape, nb::handle owner,
                std::vector<std::int64_t> strides)
{
    return nb::ndarray<nb::numpy, const double>(data, shape.size(), shape.data(), owner,
                                                strides.empty() ? nullptr : strides.data())
        .cast();
}

nb::object array(std::vector<double>&& numbers, const std::vector<std::size_t>& shape)
{
    auto* kept = new std::vector<double>(std::move(numbers));
    const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
    return view(kept->data(), shape, owner);
}

namespace {

std::map<std::string, double> unknown_errors(const Result& r)
{
    std::map<std::string, double> all;
    const RunNumbers& numbers = r.run.numbers;
    for (std::size_t i = 0; i < numbers.names.size(); ++i) all[numbers.names[i]] = numbers.errors[i];
    return all;
}

using EventNumbers = std::tuple<std::string, double, double, double, double, double>;
std::vector<EventNumbers> events(const Result& r)
{
    std::vector<EventNumbers> all;
    const RunEvents& events = r.run.events;
    for (std::size_t k = 0; k < events.names.size(); ++k)
        all.emplace_back(events.names[k], events.times[k], events.errors[k], events.impulses[k],
                         events.speeds[k], events.rests[k]);
    return all;
}

/// The event that ended the motion; empty: none.
std::string stopped_by(const Result& r)
{
    if (r.run.events.names.empty() || r.run.events.times.back() < r.run.motion.end()) return "";
    for (const Event& event : r.scenario->model.events())
        if (event.name == r.run.events.names.back() && event.action.does == EventAction::Does::end_motion)
            return event.name;
    return "";
}

/// What belongs to no result, or makes one.
void add_functions(nb::module_& m)
{
    m.def("load_result", &load_result, nb::arg("file"));
    m.def("from_bytes", &from_bytes, nb::arg("bytes"));
    m.def("objection", &objection, nb::arg("file"), nb::arg("kind"), nb::arg("inputs"), nb::arg("force"));
    m.def("write_file", &write_file, nb::arg("file"), nb::arg("bytes"));
    m.def("figure_meanings", &figure_meanings);
    m.def(
        "shown_unit",
        [](const std::string& unit, const std::vector<std::string>& wished) {
            const ShownUnit shown = shown_unit(unit, wished);
            return nb::make_tuple(shown.factor, shown.unit);
        },
        nb::arg("unit"), nb::arg("wished"));
    m.def("judged_figures", [] {
        nb::list all;
        for (const JudgedFigure& f : judged_figures())
            all.append(nb::make_tuple(f.figure, f.name, f.meaning));
        return all;
    });
    m.def("export_formats", [] {
        nb::list all;
        for (const ExportFormat& f : export_formats())
            all.append(nb::make_tuple(f.word, f.extension, f.what));
        return all;
    });
}

}   // namespace

void add_results(nb::module_& m)
{
    nb::class_<Result> result(m, "Result");
    result.def_prop_ro("converged", [](const Result& r) { return r.run.report.converged(); })
        .def_prop_ro("roots", [](const Result& r) { return r.roots; })
        .def_prop_ro("reached_end", [](const Result& r) { return r.run.report.reached_end(); })
        .def_prop_ro("status", [](const Result& r) { return to_string(r.run.report.status); })
        .def_prop_ro("message", [](const Result& r) { return r.run.report.message; })
        .def_prop_ro("reasons", [](const Result& r) { return r.run.verdict.reasons; })
        .def_prop_ro("notes", [](const Result& r) { return r.run.notes; })
        .def_prop_ro("headline",
                     [](const Result& r) {
                         const Headline h = headline_of(r.run, r.run.motion.end());
                         return h.word + ": " + h.lead + (h.rest.empty() ? "" : ", " + h.rest);
                     })
        .def_prop_ro("title", [](const Result& r) { return r.run.title; })
        .def_prop_ro("method", [](const Result& r) { return r.run.method; })
        .def_prop_ro("version", [](const Result& r) { return r.run.version; })
        .def_prop_ro("scenario_text", [](const Result& r) { return r.run.scenario_text; })
        .def_prop_ro("unknown_errors", &unknown_errors)
        .def_prop_ro("events", &events)
        .def_prop_ro("stopped_by", &stopped_by)
        .def_prop_ro("resolved", [](const Result& r) { return r.run.resolved; })
        .def_prop_ro("solve_seconds", [](const Result& r) { return r.solve_seconds; })
        .def_prop_ro("estimate_seconds", [](const Result& r) { return r.estimate_seconds; })
        .def_prop_ro("body_names", [](const Result& r) { return r.run.told_bodies(); })
        .def_prop_ro("joints", &joints)
        .def_prop_ro("sensors", &sensors)
        .def_prop_ro("points", &points)
        .def_prop_ro("loads", &loads)
        .def_prop_ro("figures", &figures)
        .def_prop_ro("is_damping", [](const Result& r) { return r.run.motion.damps(); })
        .def_prop_ro("lists_output", [](const Result& r) { return r.scenario->lists_output; })
        .def_prop_ro("drive_columns", &drive_columns)
        .def_prop_ro("has_multipliers", [](const Result& r) {
            return !r.run.motion.end_multipliers.empty() || !r.run.motion.multipliers.empty();
        });
    const auto add_view = [&](const char* name, auto get) { result.def_prop_ro(name, get); };
    add_view("t", [](Self self) { return list_view(self, result_of(self).run.motion.mesh.ends, 0); });
    add_view("output", [](Self self) { return list_view(self, result_of(self).run.output, 0); });
    add_view("growth", [](Self self) { return list_view(self, result_of(self).run.growth, 0); });
    add_view("nodes", &nodes);
    add_view("end_configurations", &end_configurations);
    add_view("end_velocities", &end_velocities);
    add_view("estimates", &estimates);
    add_samples(result);
    result.def("save", &save, nb::arg("file"))
        .def("report", &report, nb::arg("name"), nb::arg("other").none(), nb::arg("other_name"))
        .def("to_bytes", &to_bytes)
        .def("export_to", &export_to, nb::arg("format"), nb::arg("result"), nb::arg("file"), nb::arg("force"),
             nb::arg("instants"), nb::arg("units"), nb::arg("picture"))
        .def("inputs", &inputs);
    add_functions(m);
}

}   // namespace livens::python
