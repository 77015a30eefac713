// SPDX-License-Identifier: BSD-3-Clause
// How a command ends without doing its work.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "commands.h"
#include "exit_code.h"
#include "livens/io/diagnostic.h"
#include "livens/io/json.h"
#include "livens/io/results.h"
#include "livens/io/scenario.h"

namespace livens::program {

/// Thrown by commands; everything else that is thrown is turned into one.
struct Failure {
    int exit_code = exit_internal;
    std::string status;                    ///< "usage", "scenario invalid", "input or output failed", ...
    std::vector<Diagnostic> diagnostics;   ///< at least one; the first error is the message
    std::string source = {};               ///< text that the diagnostics' lines refer to
};

Failure failure(int exit_code, const std::string& message);

/// Of a scenario that cannot be read.
Failure failure_of(ScenarioResult&& result);
Failure failure_in(const Scenario& scenario, const InputError& error);
/// Of what is complained of while a scenario is solved: at its place in the file.
template <class Solve>
auto in_file_of(const Scenario& scenario, Solve solve)
{
    try {
        return solve();
    } catch (const InputError& error) {
        throw failure_in(scenario, error);
    }
}
/// Of what is being handled.
Failure current_failure();

/// On standard error: findings about a file as render() has them, all else in lines with the program's name.
void show(const Failure& f, const Common& common);
/// The same for a page: without colours, lines of any length.
std::string text_of(const Failure& f);

/// Sets memory aside that guarded() gives back before it tells of a failure, so that exhausted memory is told
/// in full. Once, before all else.
void keep_memory_for_report();

/// Runs a command. A failure is printed: diagnostics on standard error and, with --json, one object on
/// standard output.
int guarded(const Common& common, const std::function<int()>& command);

/// Likewise of a command that reads runs: what the core complains of is a fault of theirs.
int with_runs(const std::function<int()>& command);

/// What the core complains of is a fault of the command line.
void as_usage(const std::function<void()>& check);

/// Reads a scenario; warnings are shown, errors thrown.
Scenario load_scenario(const std::string& file, const Common& common,
                       std::vector<Diagnostic>* warnings = nullptr);

/// Of what was read by other means, likewise.
Scenario accepted(ScenarioResult result, const Common& common, std::vector<Diagnostic>* warnings = nullptr);

/// The model of a run, made again from the text in its file; throws if it is not the motion's. `run_file`
/// serves for messages.
Scenario scenario_of_run(const Run& run, const std::string& run_file);

/// `diagnostics` as a JSON array.
void write_diagnostics(JsonWriter& json, const std::vector<Diagnostic>& diagnostics);

}   // namespace livens::program
