// SPDX-License-Identifier: BSD-3-Clause
#include "failure.h"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <memory>
#include <new>
#include <stdexcept>
#include <string_view>

#include <unistd.h>

#include "console.h"
#include "livens/base/error.h"
#include "livens/io/results.h"
#include "livens/io/solve_scenario.h"
#include "terminal.h"

namespace livens::program {

namespace {

const char* status_of(int exit_code)
{
    switch (exit_code) {
    case exit_usage:
        return "usage";
    case exit_scenario:
        return "scenario invalid";
    case exit_not_converged:
        return "not converged";
    case exit_resources:
        return "resource limit";
    case exit_input_output:
        return "input or output failed";
    default:
        return exit_code > exit_signal ? "cancelled" : "internal error";
    }
}

Diagnostic plain_error(const std::string& code, const std::string& message)
{
    Diagnostic d;
    d.code = code;
    d.message = message;
    return d;
}

/// A complaint of the core that no reader has placed in a file.
Diagnostic from_complaint(const Complaint& c)
{
    Diagnostic d = plain_error(c.code, c.path.empty() ? c.message : c.path + ": " + c.message);
    if (!c.value.empty()) d.message += " (given: " + c.value + ")";
    if (!c.bound.empty()) d.message += " (allowed: " + c.bound + ")";
    d.note = c.note;
    d.help = c.help;
    return d;
}

/// Address space in which a failure can be told when nothing else is left. More than the mebibyte that the
/// C library asks for at least once it can no longer extend its heap.
constexpr std::size_t report_bytes = std::size_t{1} << 21;
std::unique_ptr<char[]> kept_for_report;

bool is_error(const Diagnostic& d) { return d.severity == Severity::error; }

int exit_code_of(const std::vector<Diagnostic>& diagnostics)
{
    const auto first = std::ranges::find_if(diagnostics, is_error);
    if (first->code.starts_with("io-")) return exit_input_output;
    return first->code == "resource-limit" ? exit_resources : exit_scenario;
}

std::string counted(std::ptrdiff_t n, const char* what)
{
    return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

/// How many there are, and where to read on. A reader that found more than it shows says so in its last note.
std::string last_line(const std::vector<Diagnostic>& diagnostics)
{
    const std::ptrdiff_t n_errors = std::ranges::count_if(diagnostics, is_error);
    const std::ptrdiff_t n_warnings = std::ssize(diagnostics) - n_errors;
    std::string text = plain(diagnostics.front().file) + ": ";
    if (diagnostics.back().note.ends_with("more are not shown")) text += "more than ";
    text += counted(n_errors, "error");
    if (n_warnings > 0) text += ", " + counted(n_warnings, "warning");
    const auto first = std::ranges::find_if(
        diagnostics, [](const Diagnostic& d) { return is_error(d) && !explain(d.code).empty(); });
    return first == diagnostics.end() ? text : text + "; for more: livens explain " + first->code;
}

bool concerns_file(const Failure& f)
{
    return std::ranges::any_of(f.diagnostics, [](const Diagnostic& d) { return !d.file.empty(); });
}

std::string rendered(const Failure& f, DiagnosticFormat format, const Terminal& terminal)
{
    std::string text = render(f.diagnostics, f.source, format, terminal.colour, terminal.columns);
    if (!text.ends_with('\n')) text += '\n';
    return format == DiagnosticFormat::human ? text + "\n" + last_line(f.diagnostics) + "\n" : text;
}

std::string json_of(const Failure& f)
{
    const auto first = std::ranges::find_if(f.diagnostics, is_error);
    std::vector<Diagnostic> errors, warnings;
    for (const Diagnostic& d : f.diagnostics) (is_error(d) ? errors : warnings).push_back(d);
    JsonWriter json(2);
    json.begin_object();
    json.member("converged", false).member("status", f.status).member("exit_code", f.exit_code);
    json.member("message", first == f.diagnostics.end() ? f.status : first->message);
    json.key("output").null();
    json.key("errors");
    write_diagnostics(json, errors);
    json.key("warnings");
    write_diagnostics(json, warnings);
    json.end_object();
    return json.text() + "\n";
}

/// Ends the command; nothing may be thrown here.
int finish(const Failure& f, const Common& common)
{
    try {
        show(f, common);
        if (common.json) print(json_of(f));
    } catch (const OutputError& e) {
        say_error(e.message);
        return exit_input_output;
    } catch (...) {
        say_raw("livens: error: the failure could not be reported in full\n");
    }
    return f.exit_code;
}

}   // namespace

Failure current_failure()
{
    kept_for_report.reset();
    try {
        throw;
    } catch (const Failure& f) {
        return f;
    } catch (const OutputError& e) {
        return failure(exit_input_output, e.message);
    } catch (const InputError& e) {
        return {exit_scenario, status_of(exit_scenario), {from_complaint(e.complaint())}};
    } catch (const IoError& e) {
        return {exit_input_output, status_of(exit_input_output), {plain_error(e.code(), e.what())}};
    } catch (const std::bad_alloc&) {
        return failure(exit_resources,
                       "memory is exhausted; fewer elements, output times or bodies need less");
    } catch (const std::length_error&) {
        return failure(exit_resources, "the problem is larger than memory can ever be");
    } catch (const std::exception& e) {
        return failure(exit_internal, std::string("internal error, please report it: ") + e.what());
    } catch (...) {
        return failure(exit_internal, "internal error of unknown kind, please report it");
    }
}

Failure failure_of(ScenarioResult&& result)
{
    const int code = exit_code_of(result.diagnostics);
    return {code, status_of(code), std::move(result.diagnostics), std::move(result.text)};
}

Failure failure_in(const Scenario& scenario, const InputError& error)
{
    return {
        exit_scenario, status_of(exit_scenario), {diagnostic_of(scenario, error.complaint())}, scenario.text};
}

void show(const Failure& f, const Common& common)
{
    if (concerns_file(f) || common.diagnostics != DiagnosticFormat::human)
        return say_raw(rendered(f, common.diagnostics, terminal_of(STDERR_FILENO)));
    for (const Diagnostic& d : f.diagnostics) {
        say_error(d.message);
        if (!d.note.empty()) say_error("note: " + d.note);
        if (!d.help.empty()) say_error("help: " + d.help);
    }
}

std::string text_of(const Failure& f)
{
    if (concerns_file(f)) return rendered(f, DiagnosticFormat::human, {});
    std::string text;
    for (const Diagnostic& d : f.diagnostics) {
        text += d.message + "\n";
        for (const auto& [word, more] : {std::pair{"note", &d.note}, std::pair{"help", &d.help}})
            if (!more->empty()) text += std::string(word) + ": " + *more + "\n";
    }
    return text;
}

Failure failure(int exit_code, const std::string& message)
{
    const std::string code = exit_code == exit_usage                                      ? "usage"
                             : exit_code == exit_not_converged || exit_code > exit_signal ? "not-converged"
                             : exit_code == exit_input_output                             ? "io"
                             : exit_code == exit_resources                                ? "resource-limit"
                                                                                          : "internal";
    return {exit_code, status_of(exit_code), {plain_error(code, message)}};
}

namespace {

/// Memory that ends where nothing may be thrown (before main(), in a function that promises so, while an
/// exception is made) is a failure with an exit code as well. Nothing here allocates.
[[noreturn]] void end_without_memory() noexcept
{
    const bool is_other = [] {
        if (!std::current_exception()) return false;   // not even that could be made
        try {
            throw;
        } catch (const std::bad_alloc&) {
            return false;
        } catch (...) {
            return true;
        }
    }();
    const std::string_view text = is_other ? "livens: error: internal error, please report it\n"
                                           : "livens: error: memory is exhausted\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
    ::_exit(is_other ? exit_internal : exit_resources);
}

/// Before the tables of libraries are made, which are made before main().
struct FirstOfAll {
    FirstOfAll() { std::set_terminate(end_without_memory); }
};
[[gnu::init_priority(101)]] const FirstOfAll first_of_all;

}   // namespace

void keep_memory_for_report() { kept_for_report = std::make_unique_for_overwrite<char[]>(report_bytes); }

int guarded(const Common& common, const std::function<int()>& command)
{
    try {
        return command();
    } catch (const OutputError& e) {   // a second attempt at standard output would fail as well
        say_error(e.message);
        return exit_input_output;
    } catch (...) {
        return finish(current_failure(), common);
    }
}

int with_runs(const std::function<int()>& command)
{
    try {
        return command();
    } catch (const InputError& e) {
        throw Failure{exit_input_output, status_of(exit_input_output), {from_complaint(e.complaint())}};
    }
}

void as_usage(const std::function<void()>& check)
{
    try {
        check();
    } catch (const InputError& error) {
        throw failure(exit_usage, error.what());
    }
}

Scenario load_scenario(const std::string& file, const Common& common, std::vector<Diagnostic>* warnings)
{
    return accepted(read_scenario(file, common.parameters), common, warnings);
}

Scenario accepted(ScenarioResult result, const Common& common, std::vector<Diagnostic>* warnings)
{
    if (!result.scenario) throw failure_of(std::move(result));
    if (!result.diagnostics.empty() && !common.quiet) {
        const Terminal terminal = terminal_of(STDERR_FILENO);
        std::string text =
            render(result.diagnostics, result.text, common.diagnostics, terminal.colour, terminal.columns);
        if (!text.ends_with('\n')) text += '\n';
        say_raw(text);
    }
    if (warnings != nullptr) *warnings = std::move(result.diagnostics);
    return std::move(*result.scenario);
}

Scenario scenario_of_run(const Run& run, const std::string& run_file)
{
    ScenarioResult result = parse_scenario(run.scenario_text, "scenario in " + run_file, {{}, run.meshes});
    if (!result.scenario && exit_code_of(result.diagnostics) == exit_resources)
        throw Failure{exit_resources, status_of(exit_resources), std::move(result.diagnostics),
                      std::move(result.text)};
    if (!result.scenario)
        throw Failure{exit_input_output, "the run's scenario cannot be read by this version",
                      std::move(result.diagnostics), std::move(result.text)};
    try {
        take_events(run, *result.scenario);
        check_model(result.scenario->model, run);
    } catch (const IoError& error) {
        throw IoError("cannot read '" + run_file + "': " + error.what(), error.code());
    }
    return std::move(*result.scenario);
}

void write_diagnostics(JsonWriter& json, const std::vector<Diagnostic>& diagnostics)
{
    json.begin_array();
    for (const Diagnostic& d : diagnostics) {
        json.begin_object();
        json.member("severity", is_error(d) ? "error" : "warning");
        json.member("code", d.code).member("message", d.message).member("file", d.file);
        json.member("line", d.line).member("column", d.column);
        json.member("note", d.note).member("help", d.help);
        json.end_object();
    }
    json.end_array();
}

}   // namespace livens::program
