// SPDX-License-Identifier: BSD-3-Clause
// livens solve: a scenario in, a solved and checked motion out.
#include <chrono>
#include <ctime>
#include <filesystem>
#include <memory>
#include <new>

#include <fmt/format.h>

#include "commands.h"
#include "console.h"
#include "failure.h"
#include "interrupt.h"
#include "livens/base/version.h"
#include "livens/io/results.h"
#include "memory.h"
#include "places.h"
#include "progress.h"
#include "simd.h"
#include "summary.h"

namespace livens::program {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin)
{
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

struct Places {
    fs::path scenario, output, record, csv;
};

/// Where everything goes; refuses what would destroy something or cannot be written, before anything is
/// solved.
Places places(const SolveArguments& arguments)
{
    Places p;
    p.scenario = arguments.scenario;
    p.output =
        arguments.output.empty() ? fs::path(p.scenario.stem().string() + ".nc") : fs::path(arguments.output);
    p.record = record_of(p.output);
    p.csv = arguments.csv;
    check_differs(p.output, p.scenario, "it is the scenario itself");
    check_place(p.output);
    if (p.csv.empty()) return p;
    check_differs(p.csv, p.scenario, "it is the scenario itself");
    check_export_place(p.csv, export_formats().front(), p.output);
    return p;
}

/// Memory that checks and writing will want, asked for before solving and given back behind it: a motion that
/// was solved must not be lost for want of it. Nothing of it is touched: it costs address space alone.
class Reserve {
public:
    explicit Reserve(const Scenario& scenario)
    {
        const auto size = static_cast<std::size_t>(memory_needed(scenario).checks);
        memory_ = std::make_unique_for_overwrite<char[]>(size);
        *static_cast<volatile char*>(memory_.get()) = 0;   // or a compiler could leave it out
    }
    void give_back() { memory_.reset(); }

private:
    std::unique_ptr<char[]> memory_;
};

struct Solved {
    Run run;
    double solve_seconds = 0;
    double estimate_seconds = 0;
    int signal = 0;   ///< that cancelled the solution
};

Solved solve_scenario(const Scenario& scenario, const Common& common)
{
    Solved solved;
    Solution solution;
    Reserve reserve(scenario);
    const InterruptWatch watch;
    {
        ProgressLine line(error_is_terminal() && !common.quiet);
        SolveOptions options = scenario.options;
        options.judge = false;   // not part of what is timed, nor is the estimate
        options.most_bytes = std::min(options.most_bytes, 0.5 * memory_left());
        options.progress = [&line](const Progress& progress) {
            line.show(progress);
            return InterruptWatch::signal() == 0;
        };
        const Clock::time_point begin = Clock::now();
        solution = solve(scenario.model, {scenario.conditions}, scenario.time, scenario.method, options);
        solved.solve_seconds = seconds_since(begin) - solution.estimate_seconds;
        estimate(scenario.model, {scenario.conditions}, scenario.method, options, solution);
        solved.estimate_seconds = solution.estimate_seconds;
    }
    say_detail(fmt::format("solved in {:.3g} s", solved.solve_seconds));

    const Clock::time_point begin = Clock::now();
    reserve.give_back();
    try {
        judge(scenario.model, solution);
    } catch (const std::bad_alloc&) {
        if (solution.report.converged()) solution.report.status = SolveStatus::suspect;
        solution.report.message = "memory ended before the motion was checked";
    }
    const Method method = solution.method;
    solved.run = make_run(scenario.model, std::move(solution), method);
    solved.run.scenario_text = scenario.text;
    solved.run.title = scenario.title;
    solved.run.resolved = scenario.resolved;
    solved.run.output = scenario.output.empty() ? solved.run.motion.mesh.ends : scenario.output;
    say_detail(fmt::format("checked in {:.3g} s", seconds_since(begin)));
    solved.signal = InterruptWatch::signal();   // also where it came too late to stop anything
    return solved;
}

int exit_code_of(const Solved& solved)
{
    if (solved.signal != 0) return exit_signal + solved.signal;
    const SolveReport& report = solved.run.report;
    return report.converged() ? exit_ok : report.reached_end() ? exit_suspect : exit_not_converged;
}

/// The object that --json prints and that lies beside the result; `date` is empty for the former.
std::string json_of(const Solved& solved, const Places& p, const std::vector<Diagnostic>& warnings,
                    const std::string& date)
{
    const Run& run = solved.run;
    const SolveReport& report = run.report;
    JsonWriter json(2);
    json.begin_object();
    json.member("converged", report.reached_end()).member("status", to_string(report.status));
    json.member("exit_code", exit_code_of(solved));
    json.member("message", report.message).member("title", run.title).member("method", run.method);
    json.member("blocks", report.iterations.size()).member("solve_seconds", solved.solve_seconds);
    json.member("estimate_seconds", solved.estimate_seconds);
    write_figures(json, run);
    json.member("start", run.motion.start()).member("end", run.motion.end());
    json.member("output", p.output.string());
    json.key("csv");
    if (p.csv.empty())
        json.null();
    else
        json.value(p.csv.string());
    json.key("notes").begin_array();
    for (const std::string& note : run.notes) json.value(note);
    json.end_array();
    json.key("warnings");
    write_diagnostics(json, warnings);
    json.key("errors").begin_array().end_array();
    json.member("version", version);
    if (!date.empty()) json.member("date", date);
    json.end_object();
    return json.text() + "\n";
}

std::string now_utc()
{
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    ::gmtime_r(&now, &parts);
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", parts.tm_year + 1900, parts.tm_mon + 1,
                       parts.tm_mday, parts.tm_hour, parts.tm_min, parts.tm_sec);
}

/// What would make the result differ from run to run lies beside it. Its loss is worth a word, not the
/// result.
void write_record(const Solved& solved, const Places& p, const std::vector<Diagnostic>& warnings)
{
    if (!may_record(p.record)) {
        say_detail("'" + p.record.string() +
                   "' is left alone: it was not written by livens, or is standard output");
        return;
    }
    try {
        replace_file(p.record, json_of(solved, p, warnings, now_utc()));
    } catch (const IoError& error) {
        say_warning(error.what());
    }
}

/// What to do with a result of this kind.
std::string next_step(const Run& run, const Places& p)
{
    const std::string file = quoted(p.output.string());
    if (!run.report.reached_end() || run.body_names.empty()) return "next: livens info " + file;
    return fmt::format("next: livens sample {} --body {} --at {:.6g}", file, quoted(run.body_names.front()),
                       run.motion.end());
}

void show(const Solved& solved, const Places& p, bool verbose)
{
    const Run& run = solved.run;
    const SolveReport& report = run.report;
    const int n_elements = run.motion.n_elements();
    const std::size_t n_blocks = report.iterations.size();
    const bool is_blocked = n_blocks != static_cast<std::size_t>(n_elements);
    Summary summary(terminal_of(STDOUT_FILENO));
    add_verdict(summary, run, run.motion.mesh.ends.empty() ? 0 : run.motion.end());
    summary.figure(
        "method",
        fmt::format("{}, {} elements{}, {} unknowns each", run.method, n_elements,
                    is_blocked ? fmt::format(" in {} block{}", n_blocks, n_blocks == 1 ? "" : "s") : "",
                    report.unknowns));
    summary.figure("solved", fmt::format("{:.6g} s to {:.6g} s of motion in {:.3g} s", run.motion.start(),
                                         run.motion.end(), solved.solve_seconds));
    const double mean = static_cast<double>(report.newton_iterations) / static_cast<double>(n_blocks);
    summary.figure(
        "iterations",
        fmt::format("{}{}, {}", report.newton_iterations,
                    n_blocks > 0 ? fmt::format(" ({:.1f} {})", mean, is_blocked ? "a block" : "an element")
                                 : "",
                    report.factorisations > 0 ? fmt::format("{} factorisations", report.factorisations)
                                              : "without a tangent"));
    add_figures(summary, run, verbose);
    add_notes(summary, run);
    summary.figure("written", plain(p.output.string()) + (p.csv.empty() ? "" : ", " + plain(p.csv.string())));
    summary.aside(plain(next_step(run, p)));
    print(summary.text());
}

}   // namespace

int solve_command(const SolveArguments& arguments, const Common& common)
{
    std::vector<Diagnostic> warnings;
    const Clock::time_point begin = Clock::now();
    pin_instructions(arguments.simd);
    const Scenario scenario = load_scenario(arguments.scenario, common, &warnings);
    say_detail(fmt::format("read and checked the scenario in {:.3g} s", seconds_since(begin)));
    const Places p = places(arguments);
    check_memory(scenario);
    const Solved solved = solve_scenario(scenario, common);
    {
        const SignalPause pause;
        const Clock::time_point writing = Clock::now();
        write_run(p.output, scenario.model, solved.run);
        write_record(solved, p, warnings);
        if (!p.csv.empty()) write_csv(p.csv, scenario.model, solved.run);
        say_detail(fmt::format("written in {:.3g} s", seconds_since(writing)));
    }
    const int code = exit_code_of(solved);
    const bool is_shown = !common.json && !common.quiet;
    // A person who sees both streams in one place reads it in the summary.
    if (code != exit_ok && !(is_shown && output_is_terminal() && error_is_terminal())) {
        const SolveReport& report = solved.run.report;
        say_error(report.message.empty() ? std::string("the run is ") + to_string(report.status)
                                         : report.message);
    }
    if (common.json)
        print(json_of(solved, p, warnings, ""));
    else if (is_shown)
        show(solved, p, common.verbose);
    return code;
}

}   // namespace livens::program
