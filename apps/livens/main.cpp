// livens, the program: arguments in, a command's exit code out.
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <unistd.h>

#include "commands.h"
#include "console.h"
#include "failure.h"
#include "interrupt.h"
#include "livens/base/version.h"

namespace livens::program {

namespace {

struct Arguments {
    Common common;
    std::string layout = "human";   ///< of diagnostics
    SolveArguments solve;
    std::string scenario;
    std::string run;
    SampleArguments sample;
    ExportArguments exports;
    bool schema_json = false;
    bool schema_markdown = false;
    std::string code;
    bool is_version = false;
};

/// A standard stream that the caller closed would give its number to the next file that is opened.
void fill_standard_streams()
{
    for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(number, F_GETFD) == -1) {
            // The lowest free number is this one; read-only, so that writing still fails as it should.
            [[maybe_unused]] const int opened = ::open("/dev/null", O_RDONLY);
        }
}

void add_common(CLI::App& command, Common& common, std::string& layout)
{
    command.add_flag("--json", common.json, "print one JSON object, also on failure");
    command.add_flag("-q,--quiet", common.quiet, "no progress, no summary");
    command.add_flag("-v,--verbose", common.verbose, "say what is done and how long it takes");
    command.add_option("--diagnostics", layout, "how errors are laid out on standard error")
        ->check(CLI::IsMember({"human", "json", "gnu"}).description(""))
        ->type_name("human|json|gnu");
}

void add_file_commands(CLI::App& app, Arguments& a)
{
    CLI::App* solve = app.add_subcommand("solve", "Solve a scenario and write the motion");
    solve->add_option("FILE", a.solve.scenario, "scenario (TOML)")->required();
    solve
        ->add_option("-o,--output", a.solve.output,
                     "result file; default: the scenario's stem with .nc, here")
        ->type_name("RUN.nc");
    solve->add_option("--csv", a.solve.csv, "write the samples as CSV too")->type_name("FILE");
    CLI::App* check = app.add_subcommand("check", "Check a scenario without solving it");
    check->add_option("FILE", a.scenario, "scenario (TOML)")->required();
    CLI::App* info = app.add_subcommand("info", "Say what a result file holds");
    info->add_option("RUN", a.run, "result file")->required();
    CLI::App* sample = app.add_subcommand("sample", "A body or a joint of a run at given instants");
    sample->add_option("RUN", a.sample.run, "result file")->required();
    auto* body = sample->add_option("--body", a.sample.body, "pose, velocity and momentum of this body")
                     ->type_name("NAME");
    auto* joint = sample->add_option("--joint", a.sample.joint, "reactions of this joint")->type_name("NAME");
    joint->excludes(body);
    sample->add_option("--at", a.sample.at, "instant in seconds; may be repeated")
        ->required()
        ->type_name("T");
    sample->add_flag("--exact", a.sample.exact,
                     "between element ends solve a shortened element: full order anywhere");
    sample->add_flag("--csv", a.sample.csv, "print CSV");
    CLI::App* exports = app.add_subcommand("export", "Write a run's samples for other programs");
    exports->add_option("RUN", a.exports.run, "result file")->required();
    exports->add_option("--csv", a.exports.csv, "CSV file to write")->required()->type_name("FILE");
    for (CLI::App* command : {solve, check, info, sample, exports}) add_common(*command, a.common, a.layout);
}

void add_other_commands(CLI::App& app, Arguments& a)
{
    CLI::App* schema = app.add_subcommand("schema", "Print the schema of scenarios");
    auto* as_json = schema->add_flag("--json", a.schema_json, "as JSON Schema, for editors");
    schema->add_flag("--md", a.schema_markdown, "as a reference page (default)")->excludes(as_json);
    CLI::App* explain = app.add_subcommand("explain", "Explain a diagnostic code; without one, list them");
    explain->add_option("CODE", a.code, "as printed in brackets, like unknown-key");
    CLI::App* about = app.add_subcommand("version", "Print the version");
    about->add_flag("--json", a.common.json, "as one JSON object");
}

int run(const CLI::App& app, const Arguments& a)
{
    const Common& common = a.common;
    set_verbosity(common.quiet ? Verbosity::quiet : common.verbose ? Verbosity::verbose : Verbosity::normal);
    if (app.got_subcommand("solve")) return solve_command(a.solve, common);
    if (app.got_subcommand("check")) return check_command(a.scenario, common);
    if (app.got_subcommand("info")) return info_command(a.run, common);
    if (app.got_subcommand("sample")) return sample_command(a.sample, common);
    if (app.got_subcommand("export")) return export_command(a.exports, common);
    if (app.got_subcommand("schema")) return schema_command(!a.schema_json);
    if (app.got_subcommand("explain")) return explain_command(a.code);
    return version_command(common);
}

/// What CLI11 objects to, or its help.
int parse_failed(const CLI::App& app, const CLI::ParseError& error, Common common, int n, char** arguments)
{
    if (error.get_exit_code() == 0)
        return guarded(common, [&] {
            const bool is_top = app.get_subcommands().empty();
            print(is_top ? app.help() : app.get_subcommands().front()->help("livens"));
            return static_cast<int>(exit_ok);
        });
    for (int i = 1; i < n; ++i)
        common.json |= std::string_view(arguments[i]) == "--json";   // parsing stopped early
    return guarded(common, [&]() -> int {
        throw failure(exit_usage, std::string(error.what()) + "; 'livens --help' lists commands and options");
    });
}

}   // namespace

int main(int n, char** arguments)
{
    ignore_write_signals();
    Arguments a;
    CLI::App app("livens " + std::string(version) + ": rigid multibody dynamics with elements in time",
                 "livens");
    app.add_flag("--version", a.is_version, "print the version");
    app.footer("Exit codes: 0 converged, 2 usage, 3 scenario invalid, 4 not converged, 5 resource limit,\n"
               "6 input or output, 7 suspect, 70 internal error, 130 and 143 stopped by a signal.");
    add_file_commands(app, a);
    add_other_commands(app, a);
    try {
        app.parse(n, arguments);
        a.common.diagnostics = a.layout == "json"  ? DiagnosticFormat::json
                               : a.layout == "gnu" ? DiagnosticFormat::gnu
                                                   : DiagnosticFormat::human;
    } catch (const CLI::ParseError& error) {
        return parse_failed(app, error, a.common, n, arguments);
    }
    return guarded(a.common, [&]() -> int {
        if (app.get_subcommands().empty() && !a.is_version)
            throw failure(exit_usage, "a command is missing; 'livens --help' lists them");
        return run(app, a);
    });
}

}   // namespace livens::program

int main(int n, char** arguments)
{
    livens::program::fill_standard_streams();
    return livens::program::guarded({}, [&] { return livens::program::main(n, arguments); });
}
