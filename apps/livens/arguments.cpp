// SPDX-License-Identifier: BSD-3-Clause
// layout allows long-file: all commands and options are one table, from which help and manual follow
#include "arguments.h"

#include <memory>

#include <CLI/CLI.hpp>

#include "exit_code.h"
#include "failure.h"
#include "livens/io/exports.h"

namespace livens::program {

namespace {

/// An option whose values are these words.
void add_choice(CLI::App& command, const std::string& name, std::string& value,
                const std::vector<std::string>& words, const std::string& description)
{
    command.add_option(name, value, description)
        ->check(CLI::IsMember(words).description(""))
        ->type_name(CLI::detail::join(words, "|"));
}

/// A name that is empty is a variable of the shell that was not set.
CLI::Option* add_file(CLI::App& command, const std::string& name, std::string& value,
                      const std::string& description)
{
    const auto is_named = [](const std::string& file) {
        return file.empty() ? std::string("the name of the file is empty") : std::string();
    };
    return command.add_option(name, value, description)->check(CLI::Validator(is_named, ""));
}

void add_units(CLI::App& command, std::vector<std::string>& units, const std::string& where)
{
    command
        .add_option("--unit", units,
                    where + " in this unit instead of SI, where it fits: deg (of rates deg/s), rpm, mm, kN; "
                            "may be repeated")
        ->allow_extra_args(false)
        ->type_name("UNIT");
}

void add_force(CLI::App& command, bool& force)
{
    command.add_flag("--force", force, "also replace files that livens did not write; never inputs");
}

void add_colour(CLI::App& command, Arguments& a)
{
    add_choice(command, "--color", a.colour, {"auto", "always", "never"},
               "colours and non-ASCII signs; auto: on terminals");
}

void add_common(CLI::App& command, Arguments& a)
{
    command.add_flag("--json", a.common.json, "print one JSON object, also on failure");
    command.add_flag("-q,--quiet", a.common.quiet, "no progress, no summary");
    command.add_flag("-v,--verbose", a.common.verbose, "more figures, and the time of each step");
    add_choice(command, "--diagnostics", a.layout, {"human", "json", "gnu"},
               "format of diagnostics on standard error");
}

/// Of what reads scenarios.
void add_set(CLI::App& command, Arguments& a)
{
    const auto keep = [&a](const std::vector<std::string>& given) {
        for (const std::string& one : given) {
            const std::size_t sign = one.find('=');
            const auto trimmed = [](std::string text) { return CLI::detail::trim(text); };
            a.common.parameters.emplace_back(trimmed(one.substr(0, sign)), trimmed(one.substr(sign + 1)));
        }
    };
    const auto has_value = [](const std::string& one) {
        const std::size_t sign = one.find('=');
        const bool is_pair = sign != std::string::npos && sign > 0 &&
                             one.find_first_not_of(" \t", sign + 1) != std::string::npos;
        return is_pair ? std::string()
                       : "'" + one + "' is no NAME=VALUE, as in --set L=0.4 or --set \"L=400 mm\"";
    };
    command
        .add_option_function<std::vector<std::string>>(
            "--set", keep, "value of a parameter of the scenario, a number or an expression; may be repeated")
        ->check(CLI::Validator(has_value, ""))
        ->allow_extra_args(false)
        ->type_name("NAME=VALUE");
}

/// `run` is called once all is parsed, if this is the command that was typed.
CLI::App& add_command(CLI::App& app, Arguments& a, const std::string& name, const std::string& description,
                      const std::function<int(const Common&)>& run)
{
    CLI::App* command = app.add_subcommand(name, description);
    command->callback([&a, run] { a.run = run; });
    add_colour(*command, a);
    return *command;
}

/// The arguments of a command: options are bound to their members, and its `run` keeps them.
template <class Given>
std::shared_ptr<Given> arguments_of()
{
    return std::make_shared<Given>();
}

void add_scenario_commands(CLI::App& app, Arguments& a)
{
    const auto name = arguments_of<std::string>(), file = arguments_of<std::string>();
    CLI::App& init = add_command(app, a, "init", "Write a small scenario to start from",
                                 [name](const Common& common) { return init_command(*name, common); });
    add_file(init, "NAME", *name, "name of the scenario; default: pendulum")->type_name("NAME");
    add_common(init, a);
    CLI::App& check = add_command(app, a, "check", "Check a scenario without solving it",
                                  [file](const Common& common) { return check_command(*file, common); });
    check.add_option("FILE", *file, "scenario (TOML)")->required()->type_name("FILE.toml");
    add_set(check, a);
    add_common(check, a);
}

void add_import_command(CLI::App& app, Arguments& a)
{
    const auto given = arguments_of<ImportArguments>();
    CLI::App& import =
        add_command(app, a, "import", "Make a scenario of a robot's URDF, and list what is not kept",
                    [given](const Common& common) { return import_command(*given, common); });
    import.add_option("FILE", given->file, "robot (URDF)")->required()->type_name("FILE.urdf");
    add_file(import, "-o,--output", given->output, "scenario; default: the file's stem with .toml, here")
        ->type_name("FILE.toml");
    const auto add_pairs = [&](const char* name, std::vector<std::string>& values, const char* description,
                               const char* type) {
        import.add_option(name, values, description)->allow_extra_args(false)->type_name(type);
    };
    add_pairs("--at", given->at, "coordinate of a joint at the start, rad or m; may be repeated",
              "JOINT=VALUE");
    add_pairs("--package", given->packages, "where package://NAME/ is; may be repeated", "NAME=FOLDER");
    add_choice(import, "--base", given->base, {"fixed", "free"}, "first link; default: fixed in the world");
    add_choice(import, "--meshes", given->meshes, {"draw", "none"}, "visuals; default: draw");
    add_choice(import, "--limits", given->limits, {"stop", "ignore"}, "limits of joints; default: stop");
    add_choice(import, "--inertias", given->inertias, {"mend", "strict"},
               "those that belong to no body; default: mend");
    import.add_option("--end", given->end, "end of the motion, s; default: 1")->type_name("T");
    import.add_flag("--strict", given->is_strict, "what is lost and changes the motion is an error");
    add_force(import, given->force);
    add_common(import, a);
}

void add_solve_command(CLI::App& app, Arguments& a)
{
    const auto given = arguments_of<SolveArguments>();
    CLI::App& solve =
        add_command(app, a, "solve", "Solve scenarios and write result files", [given](const Common& common) {
            return given->is_distributed ? distributed_command(*given, common)
                                         : solve_command(*given, common);
        });
    solve.add_option("FILE", given->scenarios, "scenario (TOML), or several")
        ->required()
        ->type_name("FILE.toml");
    add_file(solve, "-o,--output", given->output,
             "result file, or a folder for several scenarios; default: name of the scenario with .nc, in the "
             "current folder")
        ->type_name("RUN.nc");
    add_file(solve, "--csv", given->csv, "also write samples as CSV")->type_name("FILE.csv");
    add_file(solve, "--guess", given->guess,
             "run to begin with, where conditions at both ends are given: a motion of the same bodies")
        ->type_name("RUN.nc");
    solve
        .add_option("--roots", given->roots,
                    "number of motions to look for, where conditions at both ends are given; the others are "
                    "written to NAME.2.nc, ..")
        ->check(CLI::Range(1, 32))
        ->type_name("N");
    add_force(solve, given->force);
    solve
        .add_option("-j,--jobs", given->jobs,
                    "number of scenarios solved concurrently; default: one per processor")
        ->check(CLI::Range(1, 1024))
        ->type_name("N");
    solve
        .add_option("--threads", given->threads,
                    "number of threads that share one motion whose elements are solved together; 0: one per "
                    "processor; default: 1")
        ->check(CLI::Range(0, 256))
        ->type_name("N");
    solve.add_flag("--distributed", given->is_distributed,
                   "one motion by all processes of 'mpirun -n K livens solve ..': see docs/howto/cluster.md");
    add_choice(solve, "--simd", given->simd, {"sse2", "avx2", "avx512"},
               "instruction set to solve with; default: avx2 if the processor has it, else sse2");
    add_set(solve, a);
    add_common(solve, a);
}

void add_mass_command(CLI::App& app, Arguments& a)
{
    const auto given = arguments_of<MassArguments>();
    CLI::App& mass =
        add_command(app, a, "mass", "Mass, centre of mass and inertia of a mesh or of a scenario's bodies",
                    [given](const Common& common) { return mass_command(*given, common); });
    mass.add_option("FILE", given->file, "mesh (STL, OBJ, PLY, MSH) or scenario (TOML)")
        ->required()
        ->type_name("FILE");
    mass.add_option("--unit", given->unit, "length unit of the mesh file; default: m")->type_name("UNIT");
    mass.add_option("--density", given->density, "density of the mesh, kg/m^3; default: 1")->type_name("D");
    mass.add_flag("--turn", given->turn, "flip faces of the mesh that point inwards");
    add_set(mass, a);
    add_common(mass, a);
}

void add_rest_commands(CLI::App& app, Arguments& a)
{
    const auto file = arguments_of<std::string>();
    CLI::App& equilibrium =
        add_command(app, a, "equilibrium", "Find the static equilibrium and its stability",
                    [file](const Common& common) { return equilibrium_command(*file, common); });
    equilibrium.add_option("FILE", *file, "scenario (TOML)")->required()->type_name("FILE.toml");
    add_set(equilibrium, a);
    add_common(equilibrium, a);
    const auto given = arguments_of<ModesArguments>();
    CLI::App& modes =
        add_command(app, a, "modes", "Natural frequencies, damping and mode shapes about an equilibrium",
                    [given](const Common& common) { return modes_command(*given, common); });
    modes.add_option("FILE", given->scenario, "scenario (TOML)")->required()->type_name("FILE.toml");
    add_choice(modes, "--at", given->at, {"equilibrium", "start"},
               "state to linearise about; default: the equilibrium found from the start");
    modes
        .add_option("--input", given->inputs,
                    "input of the state matrices: a force or torque along JOINT.angle, JOINT.displacement or "
                    "BODY.x; may be repeated")
        ->allow_extra_args(false)
        ->type_name("NAME");
    modes
        .add_option("--output", given->outputs,
                    "output of the state matrices: a position named like an input, or with _rate its rate; "
                    "may be repeated")
        ->allow_extra_args(false)
        ->type_name("NAME");
    add_set(modes, a);
    add_common(modes, a);
}

void add_run_commands(CLI::App& app, Arguments& a)
{
    const auto run = arguments_of<std::string>();
    CLI::App& info =
        add_command(app, a, "info", "Show the contents of a result file and the quality of the run",
                    [run](const Common& common) { return info_command(*run, common); });
    info.add_option("RUN", *run, "result file")->required()->type_name("RUN.nc");
    add_common(info, a);
    const auto given = arguments_of<SampleArguments>();
    CLI::App& sample = add_command(
        app, a, "sample", "Print a body, a joint, a sensor, a point or a load of a run at given times",
        [given](const Common& common) { return sample_command(*given, common); });
    sample.add_option("RUN", given->run, "result file")->required()->type_name("RUN.nc");
    auto* body = sample.add_option("--body", given->body, "print pose, velocity and momentum of this body")
                     ->type_name("BODY");
    auto* joint = sample.add_option("--joint", given->joint, "print reactions and coordinates of this joint")
                      ->type_name("JOINT");
    joint->excludes(body);
    sample.add_option("--sensor", given->sensor, "print readings of this sensor, point or load")
        ->type_name("SENSOR")
        ->excludes(body)
        ->excludes(joint);
    sample.add_option("--at", given->at, "time in seconds; may be repeated")->required()->type_name("T");
    sample.add_flag("--exact", given->exact,
                    "between element ends, solve a shortened element instead of evaluating the polynomial: "
                    "full order at any time");
    sample.add_flag("--csv", given->csv, "print CSV");
    add_units(sample, given->units, "text and CSV");
    add_common(sample, a);
}

void add_peaks_command(CLI::App& app, Arguments& a)
{
    const auto given = arguments_of<PeaksArguments>();
    CLI::App& peaks = add_command(
        app, a, "peaks", "Extreme values of a run and their times",
        [given](const Common& common) { return with_runs([&] { return peaks_command(*given, common); }); });
    peaks.add_option("RUN", given->run, "result file")->required()->type_name("RUN.nc");
    peaks
        .add_option("NAME", given->names,
                    "quantity, such as \"pivot.force\" (magnitude of a vector), \"rod.position.z\" or "
                    "\"energy\"; default: all quantities of joints, loads and sensors, and energies")
        ->type_name("NAME");
    peaks.add_flag("--csv", given->csv, "print CSV");
    add_units(peaks, given->units, "values");
    add_common(peaks, a);
}

std::string endings()
{
    std::string all;
    for (const ExportFormat& format : export_formats())
        all += (all.empty() ? "" : " ") + std::string(format.extension);
    return all;
}

void add_picture(CLI::App& command, ExportArguments& given)
{
    PictureOptions& o = given.picture;
    command
        .add_option("--size", given.size, "of pictures; default: 1280x720, of PNG 1920x1080, of GIF 640x400")
        ->type_name("WxH");
    command.add_option("--fps", o.rate, "frames per second; default: 30, of GIF 20")->type_name("N");
    command
        .add_option("--duration", o.duration,
                    "of the video, s; default: that of the motion, 8 s where it is under 2 s or over 40 s")
        ->type_name("S");
    command
        .add_option("--from", o.from, "instant of a still, or the first of a video, s; default: the start")
        ->type_name("T");
    command.add_option("--to", o.to, "last instant of a video, s; default: the end")->type_name("T");
    add_choice(command, "--view", o.view, {"fitted", "front", "side", "top"}, "where pictures are seen from");
    command.add_flag("--dark", o.is_dark, "pictures in dark colours");
    command.add_flag("--names", o.names, "names of bodies in pictures");
    command.add_flag("--clock", o.clock, "the time in pictures");
}

void add_export_commands(CLI::App& app, Arguments& a)
{
    const auto given = arguments_of<ExportArguments>();
    CLI::App& exports = add_command(
        app, a, "export", "Convert a run to one or more formats of other programs",
        [given](const Common& common) { return with_runs([&] { return export_command(*given, common); }); });
    exports.add_option("RUN", given->run, "result file")->required()->type_name("RUN.nc");
    exports
        .add_option("-o,--output", given->outputs,
                    "file in the format of its ending, " + endings() + "; may be repeated")
        ->allow_extra_args(false)
        ->type_name("FILE");
    given->files.resize(export_formats().size());
    for (std::size_t i = 0; const ExportFormat& format : export_formats())
        add_file(exports, std::string("--") + format.word, given->files[i++], format.what)
            ->type_name(std::string("FILE") + format.extension);
    const auto words = words_of(Instants{});
    add_choice(exports, "--at", given->at, {words.begin(), words.end()},
               "times of CSV rows; default: output times if the scenario lists them, else dense");
    add_units(exports, given->units, "CSV");
    add_picture(exports, *given);
    add_force(exports, given->force);
    add_common(exports, a);
    const auto both = arguments_of<DiffArguments>();
    CLI::App& diff = add_command(
        app, a, "diff", "Compare two runs at their common output times",
        [both](const Common& common) { return with_runs([&] { return diff_command(*both, common); }); });
    diff.add_option("A", both->first, "result file")->required()->type_name("RUN.nc");
    diff.add_option("B", both->second, "result file")->required()->type_name("RUN.nc");
    diff.add_option("--rtol", both->rtol, "tolerance relative to the largest value; default: 1e-6")
        ->type_name("R");
    diff.add_option("--atol", both->atol, "absolute tolerance in m, rad, m/s, rad/s; default: 1e-9")
        ->type_name("A");
    add_common(diff, a);
}

void add_report_commands(CLI::App& app, Arguments& a)
{
    const auto given = arguments_of<ReportArguments>();
    CLI::App& report = add_command(
        app, a, "report", "Write an HTML page with 3D view, plots and quality figures",
        [given](const Common& common) { return with_runs([&] { return report_command(*given, common); }); });
    CLI::App& view = add_command(
        app, a, "view", "Show this page in the browser, from a local server",
        [given](const Common& common) { return with_runs([&] { return view_command(*given, common); }); });
    for (CLI::App* command : {&report, &view}) {
        command->add_option("RUN", given->run, "result file")
            ->required(command == &report)
            ->type_name("RUN.nc");
        command->add_option("OTHER", given->other, "second result file to compare with")->type_name("RUN.nc");
        add_common(*command, a);
    }
    add_file(report, "-o,--output", given->output,
             "HTML file; default: name of the run with .html, in the current folder")
        ->type_name("FILE.html");
    add_force(report, given->force);
    view.add_option("--port", given->port, "port on 127.0.0.1; default: any free port")
        ->check(CLI::Range(1, 65535))
        ->type_name("N");
    add_file(view, "--watch", given->watched,
             "solve this scenario, and show it again whenever the file or one of its meshes is saved")
        ->type_name("FILE.toml");
    add_set(view, a);
    view.add_flag("--address", given->address_only, "print the address instead of opening a browser");
}

struct SchemaArguments {
    bool json = false, markdown = false;
    std::string type;
};

void add_other_commands(CLI::App& app, Arguments& a)
{
    const auto form = arguments_of<SchemaArguments>();
    CLI::App& schema = add_command(app, a, "schema", "Print the scenario schema",
                                   [form](const Common&) { return schema_command(!form->json, form->type); });
    auto* as_json = schema.add_flag("--json", form->json, "as JSON Schema, for editors");
    schema.add_flag("--md", form->markdown, "as a reference page (default)")->excludes(as_json);
    schema.add_option("--type", form->type, "only the keys of one type, such as joint.revolute, as a table")
        ->excludes(as_json)
        ->type_name("TYPE");
    const auto code = arguments_of<std::string>();
    CLI::App& explain = add_command(app, a, "explain",
                                    "Explain a diagnostic code with examples; without a code, list all codes",
                                    [code](const Common&) { return explain_command(*code); });
    explain.add_option("CODE", *code, "code, as printed in brackets, such as unknown-key")->type_name("CODE");
    const auto given = arguments_of<CompletionArguments>();
    CLI::App& completion =
        add_command(app, a, "completion", "Print a shell completion script",
                    [given, &app](const Common&) { return completion_command(*given, command_table(app)); });
    add_choice(completion, "SHELL", given->shell, {"bash", "zsh", "fish"},
               "shell for which to print the script");
    completion.add_option("--bodies", given->bodies)->group("");   // for the scripts
    completion.add_option("--joints", given->joints)->group("");
    completion.add_option("--sensors", given->sensors)->group("");
    add_command(app, a, "man", "Print the manual page, for man -l or groff",
                [&app](const Common&) { return man_command(command_table(app)); });
    CLI::App& about = add_command(app, a, "version", "Print the version", version_command);
    about.add_flag("--json", a.common.json, "as one JSON object");
}

std::string footer()
{
    std::string text = "Exit codes:\n";
    for (const auto& [code, meaning] : exit_meanings)
        text += "  " + (std::string(code) + std::string(10, ' ')).substr(0, 10) + meaning + "\n";
    return text + "\nFirst steps: livens init; livens solve pendulum.toml";
}

}   // namespace

void declare(CLI::App& app, Arguments& arguments)
{
    app.require_subcommand(0, 1);                        // a file may be called like a command
    app.set_help_flag("-h,--help", "print this help");   // inherited by the commands
    app.add_flag("--version", arguments.is_version, "print the version");
    add_colour(app, arguments);
    add_scenario_commands(app, arguments);
    add_import_command(app, arguments);
    add_solve_command(app, arguments);
    add_mass_command(app, arguments);
    add_rest_commands(app, arguments);
    add_run_commands(app, arguments);
    add_peaks_command(app, arguments);
    add_export_commands(app, arguments);
    add_report_commands(app, arguments);
    add_other_commands(app, arguments);
    app.footer(footer());
}

}   // namespace livens::program
