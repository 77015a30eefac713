// SPDX-License-Identifier: BSD-3-Clause
#include "arguments.h"

#include <CLI/CLI.hpp>

#include "exit_code.h"
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

void add_force(CLI::App& command, bool& force)
{
    command.add_flag("--force", force, "replace files that livens did not write, too; never inputs");
}

void add_colour(CLI::App& command, Arguments& a)
{
    add_choice(command, "--color", a.colour, {"auto", "always", "never"},
               "colours and signs; auto: on terminals");
}

void add_common(CLI::App& command, Arguments& a)
{
    command.add_flag("--json", a.common.json, "print one JSON object, also on failure");
    command.add_flag("-q,--quiet", a.common.quiet, "no progress, no summary");
    command.add_flag("-v,--verbose", a.common.verbose, "more figures; what is done and how long it takes");
    add_choice(command, "--diagnostics", a.layout, {"human", "json", "gnu"},
               "how errors are laid out on standard error");
}

CLI::App& add_command(CLI::App& app, Arguments& a, const std::string& name, const std::string& description)
{
    CLI::App* command = app.add_subcommand(name, description);
    add_colour(*command, a);
    return *command;
}

void add_scenario_commands(CLI::App& app, Arguments& a)
{
    CLI::App& init = add_command(app, a, "init", "Write a small scenario to begin with");
    add_file(init, "NAME", a.name, "of the scenario; default: pendulum")->type_name("NAME");
    add_common(init, a);
    CLI::App& check = add_command(app, a, "check", "Check a scenario without solving it");
    check.add_option("FILE", a.scenario, "scenario (TOML)")->required()->type_name("FILE.toml");
    add_common(check, a);
    CLI::App& solve = add_command(app, a, "solve", "Solve scenarios and write their motions");
    solve.add_option("FILE", a.solve.scenarios, "scenario (TOML), or several")
        ->required()
        ->type_name("FILE.toml");
    add_file(solve, "-o,--output", a.solve.output,
             "result file, or a folder for several; default: the scenario's stem with .nc, here")
        ->type_name("RUN.nc");
    add_file(solve, "--csv", a.solve.csv, "write the samples as CSV too")->type_name("FILE.csv");
    add_force(solve, a.solve.force);
    solve
        .add_option("-j,--jobs", a.solve.jobs,
                    "scenarios that are solved at a time; default: one a processor")
        ->check(CLI::Range(1, 1024))
        ->type_name("N");
    add_choice(solve, "--simd", a.solve.simd, {"sse2", "avx2", "avx512"},
               "instructions to solve with; default: avx2 where the processor has it");
    add_common(solve, a);
}

void add_mass_command(CLI::App& app, Arguments& a)
{
    CLI::App& mass =
        add_command(app, a, "mass", "Mass, centre and inertia of a mesh, or of a scenario's bodies");
    mass.add_option("FILE", a.mass.file, "mesh (STL, OBJ, PLY, MSH) or scenario (TOML)")
        ->required()
        ->type_name("FILE");
    mass.add_option("--unit", a.mass.unit, "of the mesh's numbers; default: m")->type_name("UNIT");
    mass.add_option("--density", a.mass.density, "of the mesh, kg/m^3; default: 1")->type_name("D");
    mass.add_flag("--turn", a.mass.turn, "turn faces of the mesh that look inwards");
    add_common(mass, a);
}

void add_rest_commands(CLI::App& app, Arguments& a)
{
    CLI::App& equilibrium =
        add_command(app, a, "equilibrium", "Find where a mechanism rests, and say whether it is stable");
    equilibrium.add_option("FILE", a.scenario, "scenario (TOML)")->required()->type_name("FILE.toml");
    add_common(equilibrium, a);
    CLI::App& modes =
        add_command(app, a, "modes", "Frequencies, damping and shapes of small motions about a rest");
    modes.add_option("FILE", a.modes.scenario, "scenario (TOML)")->required()->type_name("FILE.toml");
    add_choice(modes, "--at", a.modes.at, {"equilibrium", "start"},
               "where; default: the equilibrium that the start leads to");
    modes
        .add_option("--input", a.modes.inputs,
                    "of the state matrices: a force on JOINT.angle, JOINT.displacement or BODY.x")
        ->allow_extra_args(false)
        ->type_name("NAME");
    modes
        .add_option("--output", a.modes.outputs,
                    "of the state matrices: likewise, as a position; with _rate its rate")
        ->allow_extra_args(false)
        ->type_name("NAME");
    add_common(modes, a);
}

void add_run_commands(CLI::App& app, Arguments& a)
{
    CLI::App& info = add_command(app, a, "info", "Say what a result file holds");
    info.add_option("RUN", a.run, "result file")->required()->type_name("RUN.nc");
    add_common(info, a);
    CLI::App& sample =
        add_command(app, a, "sample", "A body, a joint or a sensor of a run at given instants");
    sample.add_option("RUN", a.sample.run, "result file")->required()->type_name("RUN.nc");
    auto* body = sample.add_option("--body", a.sample.body, "pose, velocity and momentum of this body")
                     ->type_name("BODY");
    auto* joint = sample.add_option("--joint", a.sample.joint, "reactions of this joint")->type_name("JOINT");
    joint->excludes(body);
    sample.add_option("--sensor", a.sample.sensor, "what this sensor reads")
        ->type_name("SENSOR")
        ->excludes(body)
        ->excludes(joint);
    sample.add_option("--at", a.sample.at, "instant in seconds; may be repeated")->required()->type_name("T");
    sample.add_flag("--exact", a.sample.exact,
                    "between element ends solve a shortened element: full order anywhere");
    sample.add_flag("--csv", a.sample.csv, "print CSV");
    add_common(sample, a);
    CLI::App& exports =
        add_command(app, a, "export", "Write a run for other programs, in one format or more");
    exports.add_option("RUN", a.exports.run, "result file")->required()->type_name("RUN.nc");
    a.exports.files.resize(export_formats().size());
    for (std::size_t i = 0; const ExportFormat& format : export_formats())
        add_file(exports, std::string("--") + format.word, a.exports.files[i++], format.what)
            ->type_name(std::string("FILE") + format.extension);
    add_force(exports, a.exports.force);
    add_common(exports, a);
    CLI::App& diff = add_command(app, a, "diff", "Compare two runs at their common output times");
    diff.add_option("A", a.diff.first, "result file")->required()->type_name("RUN.nc");
    diff.add_option("B", a.diff.second, "result file")->required()->type_name("RUN.nc");
    diff.add_option("--rtol", a.diff.rtol, "tolerance relative to the largest value; default 1e-6")
        ->type_name("R");
    diff.add_option("--atol", a.diff.atol, "and in m, rad, m/s, rad/s; default 1e-9")->type_name("A");
    add_common(diff, a);
}

void add_report_commands(CLI::App& app, Arguments& a)
{
    CLI::App& report = add_command(app, a, "report", "Write a page for browsers: picture, plots, quality");
    CLI::App& view = add_command(app, a, "view", "Show that page in the browser, served from here alone");
    for (CLI::App* command : {&report, &view}) {
        command->add_option("RUN", a.report.run, "result file")->required()->type_name("RUN.nc");
        command->add_option("OTHER", a.report.other, "result file to compare it with")->type_name("RUN.nc");
        add_common(*command, a);
    }
    add_file(report, "-o,--output", a.report.output, "page; default: the run's stem with .html, here")
        ->type_name("FILE.html");
    add_force(report, a.report.force);
    view.add_option("--port", a.report.port, "on 127.0.0.1; default: any that is free")
        ->check(CLI::Range(1, 65535))
        ->type_name("N");
    view.add_flag("--address", a.report.address_only, "print the address and open no browser");
}

void add_other_commands(CLI::App& app, Arguments& a)
{
    CLI::App& schema = add_command(app, a, "schema", "Print the schema of scenarios");
    auto* as_json = schema.add_flag("--json", a.schema_json, "as JSON Schema, for editors");
    schema.add_flag("--md", a.schema_markdown, "as a reference page (default)")->excludes(as_json);
    CLI::App& explain =
        add_command(app, a, "explain", "Explain a diagnostic code by examples; without one, list them");
    explain.add_option("CODE", a.code, "as printed in brackets, like unknown-key")->type_name("CODE");
    CLI::App& completion =
        add_command(app, a, "completion", "Print a script that completes commands in a shell");
    const std::vector<std::string> shells{"bash", "zsh", "fish"};
    add_choice(completion, "SHELL", a.completion.shell, shells, "to be read by this shell");
    completion.add_option("--bodies", a.completion.bodies)->group("");   // for the scripts
    completion.add_option("--joints", a.completion.joints)->group("");
    completion.add_option("--sensors", a.completion.sensors)->group("");
    add_command(app, a, "man", "Print the manual page, for man -l or groff");
    CLI::App& about = add_command(app, a, "version", "Print the version");
    about.add_flag("--json", a.common.json, "as one JSON object");
}

std::string footer()
{
    std::string text = "Exit codes:\n";
    for (const ExitMeaning& e : exit_meanings)
        text += "  " + std::string(e.code) + std::string(10 - std::string_view(e.code).size(), ' ') +
                e.meaning + "\n";
    return text + "\nFirst steps: livens init; livens solve pendulum.toml";
}

std::vector<OptionInfo> options_of(const CLI::App& app)
{
    std::vector<OptionInfo> options;
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_group().empty()) continue;   // hidden
        OptionInfo info;
        for (const std::string& name : option->get_snames()) info.names.push_back("-" + name);
        for (const std::string& name : option->get_lnames()) info.names.push_back("--" + name);
        if (option->get_items_expected_max() > 0) info.value = option->get_type_name();
        info.description = option->get_description();
        info.is_required = option->get_required();
        options.push_back(info);
    }
    return options;
}

}   // namespace

void declare(CLI::App& app, Arguments& arguments)
{
    app.require_subcommand(0, 1);                        // a file may be called like a command
    app.set_help_flag("-h,--help", "print this help");   // inherited by the commands
    app.add_flag("--version", arguments.is_version, "print the version");
    add_colour(app, arguments);
    add_scenario_commands(app, arguments);
    add_mass_command(app, arguments);
    add_rest_commands(app, arguments);
    add_run_commands(app, arguments);
    add_report_commands(app, arguments);
    add_other_commands(app, arguments);
    app.footer(footer());
}

std::vector<CommandInfo> command_table(const CLI::App& app)
{
    std::vector<CommandInfo> commands{{"", app.get_description(), options_of(app)}};
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        commands.push_back({command->get_name(), command->get_description(), options_of(*command)});
    return commands;
}

}   // namespace livens::program
