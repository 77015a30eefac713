// SPDX-License-Identifier: BSD-3-Clause
// From text to scenario (docs/scenario.md): bounds on the text, the parser of TOML, the tables by the schema,
// then the model table by table. All findings of a stage are gathered; later stages that need what is wrong
// are not tried, so that one mistake is told once.
#include "livens/io/scenario.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/dynamics/start/prepared.h"
#include "livens/io/scenario/assembly.h"
#include "livens/io/scenario/run/run.h"
#include "livens/io/scenario/text/reading.h"
#include "livens/io/scenario/text/tree.h"
#include "livens/io/scenario/text/unknown_nodes.h"
#include "livens/spacetime/solve.h"

namespace livens {

namespace {

/// Bounds on the tables of this file, its copies of repeats among them, before anything of the model is made.
/// What is included counts with them in read_model().
bool check_counts(const Section& top, Findings& findings)
{
    const int before = findings.n_errors();
    for (const std::string kind : {"body", "joint", "load", "point"}) {
        const std::span<const Section> sections = top.sections(kind);
        if (sections.size() > max_bodies)
            sections[max_bodies].error("", "resource-limit",
                                       "there are " + std::to_string(sections.size()) + " tables [[" + kind +
                                           "]], more than " + std::to_string(max_bodies));
    }
    if (top.find("body") != nullptr && top.sections("body").empty())
        top.error("body", "no-bodies", "a scenario needs at least one body");
    return findings.n_errors() == before;
}

/// The version decides how everything else is read: it comes first, and another one is not read at all.
bool check_format(const Node& root, Findings& findings)
{
    const Node* format = root.find("format");
    if (format == nullptr) return true;   // a missing key, found with the others
    if (format->kind == Node::Kind::integer && format->number != 1)
        return findings.error(format->place, "format-version",
                              "this file has another format than 1, the only one known",
                              {"", "a newer livens may read it"});
    if (root.entries().front().key != "format")
        findings.warning(format->place, "format-first", "'format' should be the first key of the file",
                         {"it decides how the rest is read", ""});
    return true;
}

/// Weight in other units than SI: it is the Earth's, and yet a thousand times as large.
void warn_of_gravity(const Section& top, Findings& findings)
{
    struct Habit {
        double weight;
        std::string_view unit, doubt;
    };
    static constexpr Habit habits[] = {{9806.65, "mm/s^2", "lengths in mm, too?"},
                                       {980.665, "cm/s^2", "lengths in cm, too?"},
                                       {386.0886, "in/s^2", "lengths in inches, too?"},
                                       {32.17405, "ft/s^2", "lengths in feet, too?"}};
    const Value* gravity = top.find("gravity");
    if (gravity == nullptr || gravity->has_unit) return;
    const double size = norm(top.vector("gravity"));
    for (const Habit& habit : habits) {
        // From the equator to the poles, and as people round.
        if (std::abs(size - habit.weight) > 4e-3 * habit.weight) continue;
        const std::string unit(habit.unit);
        findings.warning(gravity->node->place, "gravity-unit",
                         "'gravity' is " + to_text(size) + " m/s^2, the Earth's in " + unit + ": are " +
                             std::string(habit.doubt),
                         {"plain numbers are in SI units: m, kg, s, N",
                          "write 9.81, or strings with units here and for lengths: \"" + to_text(size) + " " +
                              unit + "\", \"120 mm\""});
        return;
    }
}

std::vector<Override> overrides_of(const ParameterValues& values)
{
    std::vector<Override> all;
    for (const auto& [name, value] : values)
        all.push_back({.name = name, .text = value, .said_by = "set: " + name + " = " + value});
    return all;
}

/// The problem of a tree with other numbers, as often as it is asked for.
class Rebuilding {
public:
    Rebuilding(NumberedTree tree, const MeshSource& files, const std::vector<Override>& overrides)
        : tree_(std::move(tree)), files_(files)
    {
        for (const Override& one : overrides)   // of an unknown parameter: its guess
            if (std::ranges::find(tree_.unknowns, one.name, &StatedUnknown::name) == tree_.unknowns.end())
                overrides_.push_back(one);
    }

    const std::vector<StatedUnknown>& unknowns() const { return tree_.unknowns; }

    /// Throws InputError with the first finding.
    Rebuilt operator()(std::span<const double> values) const
    {
        Findings findings;
        const Node root = with_numbers(tree_, values);
        AssemblySources sources(files_, findings);
        Assembly assembly(root, "", overrides_, sources);
        Scenario scenario;
        if (assembly.is_readable()) {
            assembly.read_model();
            assembly.remember_places();
            read_run(assembly.builder(), scenario);
        }
        if (findings.n_errors() > 0) {
            const Diagnostic first = findings.take("").front();
            throw InputError({first.code, "", first.message, "", "", first.note, first.help});
        }
        State start = assembly.builder().model().start();
        return {std::make_shared<const Model>(std::move(assembly.builder().model())),
                scenario.conditions.components,
                start_of(scenario.time),
                end_of(scenario.time),
                std::move(start),
                scenario.conditions.turn ? scenario.conditions.turn->angle : 0,
                scenario.lists_output ? std::move(scenario.output) : std::vector<double>()};
    }

private:
    NumberedTree tree_;
    MeshSource files_;
    std::vector<Override> overrides_;
};

/// The tree is read anew for each set of values: numbers of the file may decide about anything that is made
/// of it, such as placements, masses and the lengths of rods.
UnknownNumbers unknown_numbers(NumberedTree tree, const MeshSource& files,
                               const std::vector<Override>& overrides)
{
    const auto rebuilding = std::make_shared<const Rebuilding>(std::move(tree), files, overrides);
    UnknownNumbers unknowns;
    for (const StatedUnknown& one : rebuilding->unknowns()) {
        UnknownNumber number{.name = one.name, .guess = one.guess};
        if (one.low) number.low = *one.low;
        if (one.high) number.high = *one.high;
        number.unit = one.unit.empty() && one.name.starts_with("time.") ? "s" : one.unit;
        unknowns.numbers.push_back(std::move(number));
    }
    unknowns.rebuild = [rebuilding](std::span<const double> values) {
        Rebuilt refused;
        try {
            return (*rebuilding)(values);
        } catch (const InputError& error) {
            refused.refused = error.complaint();
        }
        return refused;
    };
    return unknowns;
}

void remember_unknowns(const NumberedTree& tree, Builder& builder)
{
    for (const StatedUnknown& one : tree.unknowns) builder.remember("unknown[" + one.name + "]", one.place);
}

/// Everything behind the parser. The scenario counts if there is no error.
/// In this order: format, guesses of unknown numbers, includes and copies, the model, what [time] to [end]
/// say; then what needs both, the method held against the model and the ends of time closed.
void build(const Node& stated, TreePart part, const MeshSource& files, const ParameterValues& values,
           Scenario& scenario, Findings& findings)
{
    if (!check_format(stated, findings)) return;
    const int before = findings.n_errors();
    std::optional<NumberedTree> numbered = with_guesses(stated, overrides_of(values), findings);
    if (findings.n_errors() > before) return;
    const Node& root = numbered ? numbered->root : stated;
    AssemblySources sources(files, findings);
    const bool has_file = files.folder && !scenario.file.empty();
    Assembly assembly(root, has_file ? std::filesystem::path(scenario.file).filename().generic_string() : "",
                      overrides_of(values), sources);
    if (!assembly.is_readable() || !check_counts(assembly.top(), findings)) return;
    warn_of_gravity(assembly.top(), findings);
    assembly.read_model();
    scenario.mesh_files = sources.meshes.files();   // also where there are errors
    scenario.mesh_files.insert(scenario.mesh_files.end(), sources.texts.files().begin(),
                               sources.texts.files().end());
    if (part == TreePart::model) return;
    assembly.remember_places();
    Builder& builder = assembly.builder();
    read_run(builder, scenario);
    const Section* end = only_section(assembly.top(), "end");
    // Where [end] is faulty, bodies cannot be judged.
    if (end == nullptr || end->is_valid())
        assembly.read_ends(scenario.conditions.at_end != Known::nothing, scenario.conditions.end);
    if (findings.n_errors() > 0) return;
    assembly.warn_of_unused_parameters();
    scenario.text = with_set_values(std::move(scenario.text), assembly.top().parameters());
    scenario.conditions.start = builder.model().start();
    scenario.conditions.start.t = start_of(scenario.time);
    scenario.conditions.end.t = end_of(scenario.time);
    if (numbered) {
        remember_unknowns(*numbered, builder);
        NumberedTree own{with_numbers(*numbered, {}), numbered->unknowns};   // this one is still in use
        scenario.unknowns = unknown_numbers(std::move(own), files, overrides_of(values));
    }
    const bool fits = builder.guard("method", [&] {
        Problem problem{scenario.conditions};
        problem.unknowns = scenario.unknowns;
        check_method(builder.model(), problem, scenario.time, scenario.method, scenario.options);
    });
    // The ends of time are closed once here, for the complaint; the solution takes them from there.
    scenario.prepared = std::make_shared<Prepared>();
    if (fits && !assembly.states_velocity()) start_as_driven(builder, scenario);
    if (fits) check_ends(builder, scenario.conditions, scenario.options.initial, *scenario.prepared);
    scenario.resolved = resolved_run(builder, scenario);
    scenario.model = std::move(builder.model());
    scenario.outlines = std::move(builder.outlines());
    scenario.parts = std::move(builder.parts());
    scenario.meshes = sources.meshes.kept() + sources.texts.kept();
}

void parse(Scenario& scenario, const MeshSource& meshes, const ParameterValues& values, Findings& findings)
{
    const std::string_view text = scenario.text;
    if (text.size() > max_scenario_bytes) {
        findings.error({}, "resource-limit",
                       "the scenario has more than " + std::to_string(max_scenario_bytes) + " bytes");
        return;
    }
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) {
        findings.error({1, 1, 1}, "empty-file", "the file is empty",
                       {"", "the folder examples holds scenarios to begin with"});
        return;
    }
    if (!scan(text, findings)) return;
    const std::optional<Node> root = parse_toml(text, findings);
    if (root) build(*root, TreePart::whole, meshes, values, scenario, findings);
}

}   // namespace

ScenarioResult parse_scenario(std::string text, const std::string& file_name, const MeshSource& meshes,
                              const ParameterValues& values)
{
    Findings findings;
    ScenarioResult result;
    Scenario scenario;
    scenario.file = file_name;
    scenario.text = std::move(text);
    result.text = scenario.text;
    shield(findings, [&] { parse(scenario, meshes, values, findings); });
    result.mesh_files = scenario.mesh_files;
    if (findings.n_errors() == 0) result.scenario = std::move(scenario);
    result.diagnostics = findings.take(file_name);
    return result;
}

ScenarioResult io_internal::read_tree(const Node& root, std::string text, const MeshSource& meshes,
                                      TreePart part)
{
    Findings findings;
    ScenarioResult result;
    Scenario scenario;
    scenario.text = std::move(text);
    shield(findings, [&] { build(root, part, meshes, {}, scenario, findings); });
    if (findings.n_errors() == 0 && part == TreePart::whole) result.scenario = std::move(scenario);
    result.diagnostics = findings.take("");
    return result;
}

/// By the text, in which the values take the place of guesses: it is what a result keeps, and so the motion
/// is that of its own scenario.
std::shared_ptr<const Scenario> with_guesses(const Scenario& scenario, std::span<const double> values)
{
    std::vector<std::string> names;
    for (const UnknownNumber& one : scenario.unknowns.numbers) names.push_back(one.name);
    MeshSource kept;
    kept.kept = scenario.meshes;
    ScenarioResult read =
        parse_scenario(with_found_guesses(scenario.text, names, values), scenario.file, kept);
    return read.scenario ? std::make_shared<const Scenario>(std::move(*read.scenario)) : nullptr;
}

/// A scenario keeps no places, so that its text is read once more, with the meshes and includes that it has
/// kept. It was read without errors: the only one here is the complaint.
Diagnostic diagnostic_of(const Scenario& scenario, const Complaint& complaint)
{
    Findings findings;
    MeshSource kept;
    kept.kept = scenario.meshes;
    AssemblySources sources(kept, findings);
    const Node stated = parse_toml(scenario.text, findings).value();
    const std::optional<NumberedTree> numbered = with_guesses(stated, {}, findings);
    Assembly assembly(numbered ? numbered->root : stated, "", {}, sources);
    assembly.read_model();
    assembly.remember_places();
    Scenario run;
    read_run(assembly.builder(), run);
    if (numbered) remember_unknowns(*numbered, assembly.builder());
    assembly.builder().guard("", [&] { throw InputError(complaint); });
    const std::vector<Diagnostic> found = findings.take(scenario.file);   // warnings were told before
    return *std::ranges::find(found, Severity::error, &Diagnostic::severity);
}

ScenarioResult read_scenario(const std::filesystem::path& file, const ParameterValues& values)
{
    Findings findings;
    ScenarioResult result;
    std::string text;
    bool is_read = false;
    shield(findings, [&] { is_read = read_text(file, text, findings); });
    if (is_read) return parse_scenario(std::move(text), file.string(), {file.parent_path()}, values);
    result.diagnostics = findings.take(file.string());
    return result;
}

}   // namespace livens
