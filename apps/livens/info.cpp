// SPDX-License-Identifier: BSD-3-Clause
// livens info: what a result file holds.
#include <fmt/format.h>
#include <unistd.h>

#include "commands.h"
#include "console.h"
#include "failure.h"
#include "livens/io/results.h"
#include "summary.h"

namespace livens::program {

namespace {

void names(JsonWriter& json, const char* key, const std::vector<std::string>& values)
{
    json.key(key).begin_array();
    for (const std::string& s : values) json.value(s);
    json.end_array();
}

std::string json_of(const RunHead& head)
{
    const Run& run = head.run;
    const SolveReport& report = run.report;
    JsonWriter json(2);
    json.begin_object();
    json.member("converged", report.reached_end()).member("status", to_string(report.status));
    json.member("message", report.message).member("title", run.title);
    json.member("version", run.version).member("method", run.method);
    json.member("start", head.start).member("end", head.end);
    write_figures(json, run);
    write_found_errors(json, run);
    write_events(json, run);
    json.member("output_times", head.n_output_times);
    names(json, "bodies", run.told_bodies());
    names(json, "joints", run.joint_names);
    names(json, "notes", run.notes);
    json.key("options").raw(run.resolved.starts_with('{') ? run.resolved : "null");
    json.end_object();
    return json.text() + "\n";
}

std::string list(const std::vector<std::string>& values)
{
    constexpr std::size_t shown = 20;
    std::string text;
    for (std::size_t i = 0; i < values.size() && i < shown; ++i)
        text += (i > 0 ? ", " : "") + plain(values[i]);
    return values.size() > shown ? text + fmt::format(" and {} more", values.size() - shown) : text;
}

}   // namespace

int info_command(const std::string& file, const Common& common)
{
    const RunHead head = read_run_head(file);
    const Run& run = head.run;
    if (common.json) {
        print(json_of(head));
        return exit_ok;
    }
    Summary summary(terminal_of(STDOUT_FILENO));
    add_verdict(summary, run, head.end);
    summary.figure("written by", "livens " + plain(run.version));
    summary.figure("bodies", list(run.told_bodies()));
    if (!run.joint_names.empty()) summary.figure("joints", list(run.joint_names));
    summary.figure("time", fmt::format("{:.6g} s to {:.6g} s, {} output times", head.start, head.end,
                                       head.n_output_times));
    summary.figure("method", fmt::format("{}, {} elements, {} unknowns each", plain(run.method),
                                         run.report.n_elements, run.report.unknowns));
    add_figures(summary, run, common.verbose);
    add_notes(summary, run);
    print(summary.text());
    return exit_ok;
}

}   // namespace livens::program
