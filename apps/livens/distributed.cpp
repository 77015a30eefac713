// SPDX-License-Identifier: BSD-3-Clause
// livens solve --distributed: one scenario by all processes of a job of MPI (docs/howto/cluster.md).
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <filesystem>

#include <fmt/format.h>
#include <unistd.h>

#include "commands.h"
#include "console.h"
#include "failure.h"
#include "interrupt.h"
#include "livens/io/parts.h"
#include "livens/spacetime/on_ranks.h"
#include "memory.h"
#include "places.h"
#include "simd.h"
#include "summary.h"

namespace livens::program {

namespace {

namespace fs = std::filesystem;

/// Libraries beneath would start threads of their own in every process, and MUMPS would wait for these. They
/// read this as they are loaded, so that the program begins once more.
void pin_libraries()
{
    constexpr const char* names[] = {"OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS",
                                     "GOTO_NUM_THREADS", "BLIS_NUM_THREADS"};
    const auto is_one = [](const char* name) {
        const char* const value = std::getenv(name);
        return value != nullptr && std::string_view(value) == "1";
    };
    if (std::ranges::all_of(names, is_one)) return;
    for (const char* name : names) ::setenv(name, "1", 1);
    std::vector<std::string> words;
    std::FILE* const file = std::fopen("/proc/self/cmdline", "rb");
    if (file == nullptr) return;
    std::string line;
    for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) line += static_cast<char>(c);
    std::fclose(file);
    for (std::size_t at = 0; at < line.size(); at += words.back().size() + 1)
        words.emplace_back(line.c_str() + at);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    ::execv("/proc/self/exe", arguments.data());   // returns where it cannot: then they are as they are
}

/// What starters of jobs tell their processes.
bool is_started_by_mpirun()
{
    constexpr const char* names[] = {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK", "PMI_SIZE",
                                     "MPI_LOCALNRANKS"};
    return std::ranges::any_of(names, [](const char* name) { return std::getenv(name) != nullptr; });
}

int processes_here(const Ranks& ranks)
{
    const char* const value = std::getenv("OMPI_COMM_WORLD_LOCAL_SIZE");
    const int n = value != nullptr ? std::atoi(value) : ranks.size();
    return std::clamp(n, 1, ranks.size());
}

void check_arguments(const SolveArguments& arguments)
{
    const std::string how = "; docs/howto/cluster.md says how";
    if (!has_mpi())
        throw failure(exit_usage, "'--distributed' needs a build with PETSc, and this is one without "
                                  "(-DLIVENS_PETSC=ON)" +
                                      how);
    if (!is_started_by_mpirun())
        throw failure(exit_usage,
                      "'--distributed' is for processes that mpirun has started: mpirun -n 4 livens "
                      "solve .. --distributed" +
                          how);
    if (arguments.scenarios.size() > 1)
        throw failure(exit_usage, "'--distributed' solves one scenario, and several are given");
    if (!arguments.csv.empty() || !arguments.guess.empty() || arguments.roots > 1)
        throw failure(exit_usage, "'--csv', '--guess' and '--roots' do not go with '--distributed'");
}

/// A scenario that all processes have read.
struct Read {
    Scenario scenario;
    std::vector<Diagnostic> warnings{};
    fs::path output{};
};

Read read(const SolveArguments& arguments, const Common& common, const Ranks& ranks)
{
    Read one{load_scenario(arguments.scenarios.front(), common)};
    Scenario& scenario = one.scenario;
    if (arguments.threads >= 0) scenario.options.threads = arguments.threads;
    one.output = arguments.output.empty() ? fs::path(fs::path(scenario.file).stem().string() + ".nc")
                                          : fs::path(arguments.output);
    in_file_of(scenario, [&] {
        Problem problem{scenario.conditions, {}, nullptr, scenario.prepared};
        problem.unknowns = scenario.unknowns;
        check_ranks(scenario.model, problem, scenario.time, scenario.method, scenario.options, ranks.size());
    });
    if (ranks.is_first()) {
        check_inputs(one.output, scenario);
        check_place(one.output, begins_as_run, arguments.force);
    }
    const double needed = memory_needed(scenario).most() * processes_here(ranks) / ranks.size();
    if (needed > memory_left())
        throw failure(exit_resources,
                      fmt::format("the processes on this machine would take at least {} of memory, and {} is "
                                  "available; more processes on other machines need less on each",
                                  bytes_in_words(needed), bytes_in_words(memory_left())));
    return one;
}

/// What all ranks have done, in words.
std::string work_in_words(const RankWork& work, Ranks& ranks)
{
    double most[] = {static_cast<double>(work.n_formed), static_cast<double>(work.of_solution.messages),
                     static_cast<double>(work.of_solution.bytes), static_cast<double>(work.flops)};
    double all[] = {most[0], most[2]};
    ranks.largest(most);
    ranks.sum(all);
    return fmt::format(
        "{} processes; a process has {:.0f} of {:.0f} elements at most, sends {:.0f} messages and "
        "{:.3g} MB, and takes {:.3g} Gflop to eliminate its own; {:.3g} MB are sent in all; the "
        "chain has {} unknowns",
        ranks.size(), most[0], all[0], most[1], 1e-6 * most[2], 1e-9 * most[3], 1e-6 * all[1], work.n_chain);
}

std::string json_of(const Run& run, const std::string& output, const std::string& words, int exit_code)
{
    JsonWriter json(2);
    json.begin_object();
    json.member("converged", run.report.reached_end()).member("status", to_string(run.report.status));
    json.member("exit_code", exit_code).member("message", run.report.message);
    json.member("title", run.title).member("method", run.method);
    write_figures(json, run);
    json.member("output", output).member("distributed", words);
    json.end_object();
    return json.text() + "\n";
}

std::string summary_of(const Run& run, const TimeMesh& mesh, const std::string& output,
                       const std::string& words, double seconds)
{
    Summary summary(Terminal{});
    add_verdict(summary, run, mesh.end());
    summary.figure("method", fmt::format("{}, {} elements in 1 block, {} unknowns", run.method,
                                         mesh.n_elements(), run.report.unknowns));
    summary.figure("solved", fmt::format("{:.6g} s to {:.6g} s of motion in {:.3g} s", mesh.start(),
                                         mesh.end(), seconds));
    summary.figure("iterations", fmt::format("{}, {} factorisations", run.report.newton_iterations,
                                             run.report.factorisations));
    summary.figure("distributed", words);
    add_figures(summary, run, false);
    add_notes(summary, run);
    summary.figure("written", plain(output));
    return summary.text();
}

int solve_together(const Read& one, const SolveArguments& arguments, const Common& common, Ranks& ranks)
{
    using Clock = std::chrono::steady_clock;
    const Scenario& scenario = one.scenario;
    const InterruptWatch watch;
    SolveOptions options = scenario.options;
    options.progress = [](const Progress&) { return InterruptWatch::signal() == 0; };
    const Clock::time_point begin = Clock::now();
    Problem problem{scenario.conditions, {}, nullptr, scenario.prepared};
    problem.unknowns = scenario.unknowns;
    RankWork work;
    Solution part = in_file_of(scenario, [&] {
        return solve_on_ranks(scenario.model, problem, scenario.time, scenario.method, options, ranks, work);
    });
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    const int signal = static_cast<int>(ranks.largest(static_cast<double>(InterruptWatch::signal())));
    if (part.cannot_begin) {   // all know it, and one says it
        double code = exit_internal;
        if (ranks.is_first())
            code = guarded(common, [&]() -> int {
                return in_file_of(scenario, [&]() -> int { throw InputError(*part.cannot_begin); });
            });
        ranks.broadcast(0, {&code, 1});
        return static_cast<int>(code);
    }
    if (part.motion.mesh.ends.empty()) {   // nothing may replace an older result
        const int code = signal != 0 ? exit_signal + signal : exit_not_converged;
        if (ranks.is_first()) say_error(part.report.message + "; nothing is written");
        return code;
    }
    std::shared_ptr<const Scenario> found;   // of unknown numbers
    if (part.numbers.rebuilt.model != nullptr) found = with_guesses(scenario, part.numbers.values);
    const Scenario& now = found != nullptr ? *found : scenario;
    const Run run = part_of_run(now, std::move(part), work);
    {
        const SignalPause pause;
        write_parts(one.output, now, run, ranks, !arguments.force);
    }
    const std::string words = work_in_words(work, ranks);
    const int code = signal != 0 ? exit_signal + signal : run.report.converged() ? exit_ok : exit_suspect;
    if (!ranks.is_first()) return code;
    if (code != exit_ok) say_error(run.report.message);
    if (common.json)
        print(json_of(run, one.output.string(), words, code));
    else if (!common.quiet)
        print(summary_of(run, work.mesh, one.output.string(), words, seconds));
    return code;
}

}   // namespace

int distributed_command(const SolveArguments& arguments, const Common& common)
{
    pin_instructions(arguments.simd);
    check_arguments(arguments);
    pin_libraries();
    const std::unique_ptr<Ranks> ranks = make_mpi_ranks();
    std::optional<Read> one;
    std::exception_ptr failed;
    try {
        one = read(arguments, common, *ranks);
    } catch (...) {
        failed = std::current_exception();
    }
    // The first that has failed says why, the others end with it.
    const double first = -ranks->largest(failed ? -ranks->rank() : -1e9);
    if (first < ranks->size()) {
        const int speaker = static_cast<int>(first);
        double code = exit_internal;
        if (ranks->rank() == speaker)
            code = guarded(common, [&]() -> int { std::rethrow_exception(failed); });
        ranks->broadcast(speaker, {&code, 1});
        return static_cast<int>(code);
    }
    try {
        return solve_together(*one, arguments, common, *ranks);
    } catch (...) {   // others wait for this one
        const int code = guarded(common, []() -> int { throw; });
        abort_mpi(code);
        return code;
    }
}

}   // namespace livens::program
