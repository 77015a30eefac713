// SPDX-License-Identifier: BSD-3-Clause
// livens export: a run for other programs.
#include <algorithm>

#include "commands.h"
#include "console.h"
#include "failure.h"
#include "livens/io/exports.h"
#include "places.h"

namespace livens::program {

int export_command(const ExportArguments& arguments, const Common& common)
{
    const std::span<const ExportFormat> formats = export_formats();
    std::string options;
    bool is_empty = true;
    for (std::size_t i = 0; i < formats.size(); ++i) {
        options += std::string(i > 0 ? ", --" : "--") + formats[i].word;
        if (arguments.files[i].empty()) continue;
        is_empty = false;
        check_export_place(arguments.files[i], formats[i], arguments.run, arguments.force);
    }
    if (is_empty) throw failure(exit_usage, "export wants one or more of " + options + " with a file");
    const auto words = words_of(Instants{});
    const auto instants = static_cast<Instants>(std::ranges::find(words, arguments.at) - words.begin());
    const Run run = read_run(arguments.run);
    const Scenario scenario = scenario_of_run(run, arguments.run);
    JsonWriter json(2);
    json.begin_object();
    for (std::size_t i = 0; i < formats.size(); ++i) {
        if (arguments.files[i].empty()) continue;
        formats[i].write(arguments.files[i], {arguments.run, scenario, run, arguments.force, instants});
        json.member(formats[i].word, arguments.files[i]);
        if (!common.json) say_note("wrote " + plain(arguments.files[i]));
    }
    json.member("converged", run.report.reached_end()).end_object();
    if (common.json) print(json.text() + "\n");
    return exit_ok;
}

}   // namespace livens::program
