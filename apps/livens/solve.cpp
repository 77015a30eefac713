// SPDX-License-Identifier: BSD-3-Clause
// livens solve: scenarios in, solved and checked motions out.
#include <algorithm>
#include <chrono>
#include <ctime>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <new>

#include <fmt/format.h>

#include "commands.h"
#include "console.h"
#include "failure.h"
#include "interrupt.h"
#include "livens/base/version.h"
#include "livens/io/guess.h"
#include "livens/io/results.h"
#include "livens/io/solve_scenario.h"
#include "livens/spacetime/ensemble.h"
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

/// A result's name: as it is given, or in the folder that is, or here.
fs::path output_of(const fs::path& scenario, const SolveArguments& arguments)
{
    const fs::path name = scenario.stem().string() + ".nc";
    if (arguments.output.empty()) return name;
    return arguments.scenarios.size() > 1 ? arguments.output / name : fs::path(arguments.output);
}

/// Where everything goes; refuses what would destroy something or cannot be written, before anything is
/// solved.
Places places(const Scenario& scenario, const SolveArguments& arguments)
{
    Places p;
    p.scenario = scenario.file;
    p.output = output_of(p.scenario, arguments);
    p.record = record_of(p.output);
    p.csv = arguments.csv;
    check_inputs(p.output, scenario);
    check_place(p.output, begins_as_run, arguments.force);
    if (p.csv.empty()) return p;
    check_inputs(p.csv, scenario);
    check_export_place(p.csv, export_formats().front(), p.output, arguments.force);
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
    std::vector<Run> roots;   ///< the others that were found
    double solve_seconds = 0;
    double estimate_seconds = 0;
    int signal = 0;                            ///< that cancelled the solution
    std::shared_ptr<const Scenario> found{};   ///< see SolvedScenario
};

/// One scenario of those that are solved, and what there is to say when it is its turn.
struct Job {
    Scenario scenario;
    Places places;
    std::vector<Diagnostic> warnings{};
    std::shared_ptr<const Run> guess{};   // null: none
    bool is_alone = true;                 // on the main thread, which may speak at once
    bool force = false;                   // what stands in the way is replaced
    std::exception_ptr failure{};
    std::vector<std::string> details{}, complaints{};
    std::string text{}, error{};   // on standard output, and standard error
    int exit_code = exit_ok;

    void detail(const std::string& what)
    {
        if (is_alone) return say_detail(what);
        details.push_back(what);
    }
};

/// `share` of the memory, and perhaps a line of progress.
Solved solve_job(Job& job, double share, ProgressLine& line)
{
    const Scenario& scenario = job.scenario;
    Reserve reserve(scenario);
    SolveOptions options = scenario.options;
    options.most_bytes = std::min(options.most_bytes, 0.5 * share * memory_left());
    options.progress = [&line](const Progress& progress) {
        line.show(progress);
        return InterruptWatch::signal() == 0;
    };
    std::function<State(double)> guess;
    if (job.guess) guess = guess_of(scenario, *job.guess);
    SolvedScenario motion = in_file_of(
        scenario, [&] { return solve_scenario(scenario, options, scenario.prepared, std::move(guess)); });
    if (motion.solution.motion.mesh.ends.empty())   // nothing may replace an older result
        throw failure(exit_signal + InterruptWatch::signal(), motion.solution.report.message);
    Solved solved;
    solved.solve_seconds = motion.solve_seconds;
    solved.estimate_seconds = motion.solution.estimate_seconds;
    line.clear();
    job.detail(fmt::format("solved in {:.3g} s", solved.solve_seconds));

    const Clock::time_point begin = Clock::now();
    reserve.give_back();
    solved.found = motion.found;
    if (solved.found != nullptr) job.scenario = *solved.found;   // its model is that of the run
    const auto goes_on = [] { return InterruptWatch::signal() == 0; };
    solved.roots = judged_roots(scenario, motion, goes_on);
    solved.run = judged_run(scenario, std::move(motion), goes_on);
    job.detail(fmt::format("checked in {:.3g} s", seconds_since(begin)));
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
    if (solved.found != nullptr) write_found(json, *solved.found);
    write_found_errors(json, run);
    write_events(json, run);
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
void write_record(const std::string& record, Job& job)
{
    const Places& p = job.places;
    try {
        if (may_record(p.record))
            replace_file(p.record, record);
        else
            job.detail("'" + p.record.string() +
                       "' is left alone: it was not written by livens, or is standard output");
    } catch (const IoError& error) {
        job.complaints.push_back(error.what());
    } catch (const std::bad_alloc&) {
        job.complaints.push_back("no memory is left to write the record");
    }
}

std::string summary_of(const Solved& solved, const Places& p, bool verbose)
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
                    n_blocks > 0 ? fmt::format(" ({:.1f} {})", mean, is_blocked ? "per block" : "per element")
                                 : "",
                    report.factorisations > 0 ? fmt::format("{} factorisation{}", report.factorisations,
                                                            report.factorisations == 1 ? "" : "s")
                                              : "no factorisation"));
    add_figures(summary, run, verbose);
    add_notes(summary, run);
    std::string written = plain(p.output.string()) + (p.csv.empty() ? "" : ", " + plain(p.csv.string()));
    for (std::size_t i = 0; i < solved.roots.size(); ++i)
        written += ", " + plain(root_place(p.output, i).string());
    summary.figure("written", written);
    if (run.report.reached_end() && !run.body_names.empty())
        summary.aside("see it: livens view " + plain(quoted(p.output.string())));
    summary.aside(plain(next_step(run, p.output.string())));
    return summary.text();
}

/// All of them are read, and all places looked at, before the first is solved.
std::vector<Job> read_jobs(const SolveArguments& arguments, const Common& common)
{
    if (arguments.scenarios.size() > 1) check_several(arguments);
    std::vector<Job> jobs;
    const auto guess =
        arguments.guess.empty() ? nullptr : std::make_shared<const Run>(read_run(arguments.guess));
    for (const std::string& file : arguments.scenarios) {
        const Clock::time_point begin = Clock::now();
        std::vector<Diagnostic> warnings;
        Scenario scenario = load_scenario(file, common, &warnings);
        if (arguments.roots > 0) scenario.options.roots = arguments.roots;
        if (arguments.threads >= 0) scenario.options.threads = arguments.threads;
        Places p = places(scenario, arguments);
        for (int i = 0; i + 1 < scenario.options.roots; ++i)
            check_place(root_place(p.output, static_cast<std::size_t>(i)), begins_as_run, arguments.force);
        if (guess) {   // what is wrong with it is told before anything is solved
            check_differs(p.output, arguments.guess, "it is the guess of the motion");
            guess_of(scenario, *guess);
        }
        say_detail(fmt::format("read and checked the scenario in {:.3g} s", seconds_since(begin)));
        for (const Job& job : jobs) {
            check_inputs(p.output, job.scenario);
            check_inputs(job.places.output, scenario);
            if (same_file(job.places.output, p.output))
                throw failure(exit_usage, "'" + plain(job.places.scenario.string()) + "' and '" +
                                              plain(file) + "' would be written to one file, '" +
                                              plain(p.output.string()) +
                                              "'; solve them one by one, with '--output'");
        }
        jobs.push_back({std::move(scenario), std::move(p), std::move(warnings), guess,
                        arguments.scenarios.size() == 1, arguments.force});
    }
    return jobs;
}

/// A search between both ends that finds no motion leaves an older run that has one where it is.
Places places_of(const Solved& solved, Job& job)
{
    Places p = job.places;
    if (job.scenario.conditions.has_state() || solved.run.report.reached_end() || job.force ||
        !is_converged_run(p.output))
        return p;
    job.complaints.push_back("the older run in '" + p.output.string() + "' has a motion and is kept");
    p.record = record_of(p.output.replace_extension(".failed.nc"));
    return p;
}

/// Solves, writes, and keeps what there is to say, which is found before: where memory ends over it, an older
/// result stays.
void do_job(Job& job, const Common& common, double share, ProgressLine& line)
{
    const Solved solved = solve_job(job, share, line);
    const Places p = places_of(solved, job);
    job.exit_code = exit_code_of(solved);
    const SolveReport& report = solved.run.report;
    if (job.exit_code != exit_ok)
        job.error =
            report.message.empty() ? std::string("the run is ") + to_string(report.status) : report.message;
    const std::string record = json_of(solved, p, job.warnings, now_utc());
    if (common.json)
        job.text = json_of(solved, p, job.warnings, "");
    else if (!common.quiet)
        job.text = summary_of(solved, p, common.verbose);
    const SignalPause pause;
    const Clock::time_point writing = Clock::now();
    write_result(p.output, job.scenario.model, solved.run, job.force);
    write_record(record, job);
    for (std::size_t i = 0; i < solved.roots.size(); ++i)
        write_result(root_place(p.output, i), job.scenario.model, solved.roots[i], job.force);
    if (!p.csv.empty()) {
        check_export_place(p.csv, export_formats().front(), p.output, job.force);
        write_csv(p.csv, job.scenario.model, solved.run,
                  instants_of(job.scenario, solved.run, Instants::automatic));
    }
    job.detail(fmt::format("written in {:.3g} s", seconds_since(writing)));
}

/// Returns its exit code.
int report_job(const Job& job, const Common& common)
{
    for (const std::string& detail : job.details) say_detail(detail);
    for (const std::string& complaint : job.complaints) say_warning(complaint);
    if (job.failure) std::rethrow_exception(job.failure);
    const bool is_shown = !common.json && !common.quiet;
    // A person who sees both streams in one place reads it in the summary.
    if (!job.error.empty() && !(is_shown && output_is_terminal() && error_is_terminal()))
        say_error(job.error);
    if (!job.text.empty()) print(job.text);
    return job.exit_code;
}

}   // namespace

int solve_command(const SolveArguments& arguments, const Common& common)
{
    pin_instructions(arguments.simd);
    std::vector<Job> jobs = read_jobs(arguments, common);
    const int n = static_cast<int>(jobs.size()), at_a_time = std::min(n, threads_for(arguments.jobs));
    std::vector<const Scenario*> scenarios;
    for (const Job& job : jobs) scenarios.push_back(&job.scenario);
    check_memory(scenarios, at_a_time);
    const InterruptWatch watch;
    ProgressLine line(n == 1 && error_is_terminal() && !common.quiet);
    int code = exit_ok;
    const auto work = [&](int i) {
        Job& job = jobs[i];
        try {
            if (n > 1 && InterruptWatch::signal() != 0) {
                job.exit_code = exit_signal + InterruptWatch::signal();
                job.failure = std::make_exception_ptr(failure(job.exit_code, "stopped before it was begun"));
            } else {
                do_job(job, common, 1.0 / at_a_time, line);
            }
        } catch (...) {
            line.clear();
            job.failure = std::current_exception();
        }
    };
    const auto say = [&](const std::function<int()>& words) {
        code = std::max(code, guarded(common, words));
    };
    const auto done = [&](int i) {   // a pipe that is closed ends none of the others
        say([&] {
            if (n > 1 && common.json) print(i == 0 ? "[\n" : ",\n");
            if (n > 1 && !common.json && !common.quiet)
                print((i == 0 ? "" : "\n") + plain(jobs[i].places.scenario.string()) + "\n");
            const Job& job = jobs[i];
            const bool is_unnamed = n > 1 && (common.json || common.quiet);
            if (is_unnamed && (job.failure || !job.error.empty()))
                say_error("'" + plain(job.places.scenario.string()) + "':");
            return report_job(job, common);
        });
    };
    run_in_order(n, at_a_time, work, done);
    if (n > 1 && common.json)
        say([] {
            print("]\n");
            return static_cast<int>(exit_ok);
        });
    const int signal = InterruptWatch::signal();   // also where it came when all was solved
    return signal == 0 ? code : std::max(code, exit_signal + signal);
}

}   // namespace livens::program
