// SPDX-License-Identifier: BSD-3-Clause
// livens report: a run as a page for browsers.
#include <fmt/format.h>

#include "commands.h"
#include "console.h"
#include "failure.h"
#include "livens/io/report.h"
#include "places.h"

namespace livens::program {

namespace {

namespace fs = std::filesystem;

/// The page's place, checked before anything is read.
fs::path place_of(const ReportArguments& arguments)
{
    fs::path file = arguments.output;
    if (file.empty()) file = fs::path(arguments.run).stem() += ".html";
    const ExportFormat format{"output", ".html", "", begins_as_report, nullptr};
    for (const std::string& run : {arguments.run, arguments.other})
        if (!run.empty()) check_export_place(file, format, run, arguments.force);
    return file;
}

}   // namespace

std::string report_of(const ReportArguments& arguments)
{
    std::vector<std::string> files{arguments.run};
    if (!arguments.other.empty()) files.push_back(arguments.other);
    std::vector<Run> runs;
    std::vector<Scenario> scenarios;
    for (const std::string& file : files) {
        runs.push_back(read_run(file));
        scenarios.push_back(scenario_of_run(runs.back(), file));
    }
    std::vector<ReportInput> inputs;
    for (std::size_t i = 0; i < files.size(); ++i)
        inputs.push_back({scenarios[i], runs[i], fs::path(files[i]).stem().string()});
    return report_page(inputs[0], inputs.size() > 1 ? &inputs[1] : nullptr);
}

int report_command(const ReportArguments& arguments, const Common& common)
{
    const fs::path file = place_of(arguments);
    const std::string page = report_of(arguments);
    replace_file(file, page);
    if (common.json) {
        JsonWriter json(2);
        json.begin_object().member("report", file.string()).member("bytes", page.size()).end_object();
        print(json.text() + "\n");
    } else {
        say_note(fmt::format("wrote {} ({:.1f} MB); any browser opens it", plain(file.string()),
                             1e-6 * static_cast<double>(page.size())));
    }
    return exit_ok;
}

}   // namespace livens::program
