// SPDX-License-Identifier: BSD-3-Clause
// A run as a NetCDF classic file (docs/results.md). Variables are declared first, since the header of such a
// file holds all sizes and offsets; their numbers follow in the same order, some at a time, so that samples
// need not be in memory as a whole.
#include <algorithm>
#include <cassert>
#include <limits>

#include "livens/base/version.h"
#include "livens/io/results/atomic_file.h"
#include "livens/io/results/figures.h"
#include "livens/io/results/writing.h"
#include "livens/multibody/model.h"
#include "livens/multibody/unwrapped_angles.h"
#include "livens/spacetime/solve.h"

namespace livens {

namespace {

/// Dimensions that every run has alike.
std::uint64_t length_of(const std::string& dimension)
{
    constexpr std::pair<const char*, std::uint64_t> lengths[] = {
        {"xyz", 3},          {"column", 4},   {"mass_column", 4},    {"side", 2},
        {"rigidity_row", 6}, {"director", 3}, {"quaternion_part", 4}};
    const auto found = std::ranges::find(lengths, dimension, [](const auto& pair) { return pair.first; });
    assert(found != std::end(lengths));
    return found->second;
}

std::string text_dimension(const std::string& name) { return name + "_length"; }

}   // namespace

void check_model(const Model& model, const Run& run)
{
    bool fits = model.n_bodies() == run.motion.n_bodies && model.n_rows() == run.motion.n_rows &&
                model.joints().size() == run.joint_names.size();
    for (int b = 0; fits && b < model.n_bodies(); ++b)
        fits =
            model.bodies()[b].name == run.body_names[b] && model.bodies()[b].is_point == run.body_is_point[b];
    const std::vector<double>& angles = run.motion.load_angles;
    fits &= angles.empty() || angles.size() == run.motion.mesh.ends.size() * UnwrappedAngles(model).size();
    if (!fits) throw IoError("the motion is one of another model than the scenario's", "io-damaged");
}

int RunWriter::declare(const VariableInfo& info, NumberType type, std::size_t n_values)
{
    std::uint64_t n_in_one = 1;
    for (std::size_t i = 1; i < info.dimensions.size(); ++i) {
        const std::string& name = info.dimensions[i];
        if (file_.dimension(name) == 0) file_.dimension(name, length_of(name));
        n_in_one *= file_.dimension(name);
    }
    const std::string& front = info.dimensions.front();
    if (file_.dimension(front) == 0) file_.dimension(front, n_values / n_in_one);
    // The first dimension has the length that the values give it; all others are known before. Variables that
    // share a dimension must agree, else the file would be read wrongly.
    assert(n_values == file_.dimension(front) * n_in_one);
    ClassicVariable variable{info.name,
                             info.dimensions,
                             type,
                             {{"units", info.units}, {"frame", info.frame}, {"long_name", info.long_name}}};
    variable.attributes.insert(variable.attributes.end(), info.attributes.begin(), info.attributes.end());
    return file_.variable(std::move(variable));
}

void RunWriter::write(const ByteSink& sink)
{
    file_.begin(sink);
    for (const std::function<void()>& work : work_) work();
    file_.finish();
}

void RunWriter::figures(const Run& run)
{
    for (const Figure& figure : run_figures()) {
        const double value = figure_of(run, figure);
        if (is_whole(figure) && std::abs(value) <= std::numeric_limits<int>::max())
            // Attributes of whole figures are integers where they fit: a reader shows 12, not 12.0.
            file_.attribute(figure.name, static_cast<int>(value));
        else
            file_.attribute(figure.name, value);
    }
}

void RunWriter::bytes(const VariableInfo& info, NumberType type, std::string values)
{
    const int variable = declare(info, type, values.size());
    later([this, variable, values = std::move(values)] { file_.append(variable, std::string_view(values)); });
}

void RunWriter::text(const std::string& name, const char* meaning, const std::string& value)
{
    if (value.empty()) return;
    VariableInfo info{name, {text_dimension(name)}, "1", "none", meaning, {{"_Encoding", "utf-8"}}};
    bytes(info, NumberType::text, value);
}

/// One row of characters each, filled up with zeros.
void RunWriter::names(const std::string& name, const char* meaning, const std::vector<std::string>& values,
                      const std::string& dimension)
{
    if (values.empty()) return;
    std::size_t width = 1;
    for (const std::string& s : values) width = std::max(width, s.size());
    file_.dimension(text_dimension(name), width);
    // NetCDF classic knows no strings: a list of names is a matrix of bytes of UTF-8.
    std::string rows(width * values.size(), '\0');
    for (std::size_t i = 0; i < values.size(); ++i) values[i].copy(rows.data() + i * width, width);
    const std::string& along = dimension.empty() ? name : dimension;
    VariableInfo info{name, {along, text_dimension(name)}, "1", "none", meaning, {{"_Encoding", "utf-8"}}};
    bytes(info, NumberType::text, std::move(rows));
}

void RunWriter::flags(const VariableInfo& info, const std::vector<bool>& values)
{
    if (!values.empty()) bytes(info, NumberType::byte, std::string(values.begin(), values.end()));
}

void RunWriter::field(VariableInfo info, const Field& field)
{
    info.attributes.push_back({"degree", field.degree});
    info.attributes.push_back({"continuous", field.continuous ? 1 : 0});
    info.attributes.push_back({"nodes", std::string(words_for(field.points))});
    list(info, field.values);
}

Run make_run(const Model& model, Solution solution, const Method& method)
{
    Run run;
    if (std::ranges::any_of(model.bodies(), &Body::holds_states))
        for (const Body& body : model.bodies()) run.body_holds_states.push_back(body.holds_states());
    for (const Body& body : model.bodies()) {
        run.body_names.push_back(body.name);
        run.body_is_point.push_back(body.is_point);
        run.centers_of_mass.push_back(
            body.is_point ? Vector3{} : inverse(body.stretch) * mass_properties(body.mass).center_of_mass);
    }
    for (const Joint& joint : model.joints()) run.joint_names.push_back(joint.name);
    for (int r = 0; r < model.n_rows(); ++r)
        run.row_labels.push_back(model.joints()[model.row_joint(r)].name + ": " + model.row(r).label);
    run.method = name_of(method);
    run.notes = solution.report.notes;
    for (const auto* of_verdict : {&solution.verdict.remarks, &solution.verdict.reasons})
        run.notes.insert(run.notes.end(), of_verdict->begin(), of_verdict->end());
    run.output = solution.motion.mesh.ends;
    run.motion = std::move(solution.motion);
    run.report = std::move(solution.report);
    run.verdict = std::move(solution.verdict);
    run.estimate = std::move(solution.estimate);
    run.growth = std::move(solution.growth);
    if (!run.growth.empty())
        // Growth that was computed for a part of the time only is unknown for the other: nan, not zero.
        run.growth.resize(run.motion.mesh.ends.size(), std::numeric_limits<double>::quiet_NaN());
    run.version = version;
    return run;
}

void io_internal::write_run_to(const ByteSink& sink, const Model& model, const Run& run,
                               std::uint64_t largest_in_cdf2)
{
    check_run(run);
    check_model(model, run);
    ClassicWriter file(largest_in_cdf2);
    RunWriter archive(file);
    file.attribute("livens_format", format_major);
    file.attribute("livens_format_minor", format_minor);
    file.attribute("converged", run.report.reached_end() ? 1 : 0);
    file.attribute("start", run.motion.start());
    file.attribute("end", run.motion.end());
    visit_run(archive, run);
    write_derived(archive, model, run);
    archive.write(sink);
}

void write_run(const std::filesystem::path& file, const Model& model, const Run& run, bool spares_others)
{
    // The file appears under its name when it is complete; a crash leaves the old one (docs/program.md, What
    // is replaced).
    AtomicFile out(file, spares_others ? begins_as_run : nullptr);
    write_run_to([&](std::uint64_t offset, std::string_view bytes) { out.write(offset, bytes); }, model, run);
    out.commit();
}

}   // namespace livens
