// SPDX-License-Identifier: BSD-3-Clause
// livens export: a run for other programs.
#include <algorithm>
#include <charconv>
#include <optional>

#include "commands.h"
#include "console.h"
#include "failure.h"
#include "interrupt.h"
#include "livens/base/error.h"
#include "livens/io/exports.h"
#include "livens/solvers/patience.h"
#include "places.h"

namespace livens::program {

namespace {

/// A file for each format, those whose endings tell it among them.
std::vector<std::string> files_of(const ExportArguments& arguments)
{
    const std::span<const ExportFormat> formats = export_formats();
    std::vector<std::string> files = arguments.files;
    std::string known;
    for (const ExportFormat& format : formats)
        known += (known.empty() ? "" : ", ") + std::string(format.extension);
    for (const std::string& file : arguments.outputs) {
        const auto has_it = [&](const ExportFormat& format) { return file.ends_with(format.extension); };
        const auto found = std::ranges::find_if(formats, has_it);
        if (found == formats.end())
            throw failure(exit_usage, "'" + plain(file) + "' has no ending of a format: " + known);
        std::string& place = files[static_cast<std::size_t>(found - formats.begin())];
        if (!place.empty())
            throw failure(exit_usage,
                          "two files for one format: '" + plain(place) + "' and '" + plain(file) + "'");
        place = file;
    }
    return files;
}

/// "1280x720"
PictureOptions picture_of(const ExportArguments& arguments)
{
    PictureOptions picture = arguments.picture;
    if (arguments.size.empty()) return picture;
    const char *const begin = arguments.size.data(), *const end = begin + arguments.size.size();
    const std::from_chars_result width = std::from_chars(begin, end, picture.width);
    const bool is_two =
        width.ec == std::errc() && width.ptr != end && (*width.ptr == 'x' || *width.ptr == 'X');
    const std::from_chars_result height =
        is_two ? std::from_chars(width.ptr + 1, end, picture.height) : width;
    if (!is_two || height.ec != std::errc() || height.ptr != end || picture.width < 1 || picture.height < 1)
        throw failure(exit_usage, "--size takes two numbers of pixels, such as 1280x720, not '" +
                                      plain(arguments.size) + "'");
    return picture;
}

void write_export(const ExportFormat& format, const std::string& file, const ExportInput& input)
{
    try {
        if (const std::string doubt = format.doubt != nullptr ? format.doubt(input) : ""; !doubt.empty())
            say_warning(plain(file) + ": " + doubt);
        format.write(file, input);
    } catch (const Stopped&) {
        throw failure(exit_signal + InterruptWatch::signal(), "stopped before it was written");
    } catch (const InputError& error) {
        const std::string& code = error.complaint().code;
        if (code != "unit" && code != "picture") throw;   // a fault of the run
        throw failure(exit_usage, error.what());
    }
}

}   // namespace

int export_command(const ExportArguments& arguments, const Common& common)
{
    const std::span<const ExportFormat> formats = export_formats();
    const std::vector<std::string> files = files_of(arguments);
    const PictureOptions picture = picture_of(arguments);
    std::string options;
    bool is_empty = true;
    for (std::size_t i = 0; i < formats.size(); ++i) {
        options += std::string(", --") + formats[i].word;
        if (files[i].empty()) continue;
        is_empty = false;
        check_export_place(files[i], formats[i], arguments.run, arguments.force);
    }
    if (is_empty) throw failure(exit_usage, "export needs one or more of -o" + options + " with a file");
    const auto words = words_of(Instants{});
    const auto instants = static_cast<Instants>(std::ranges::find(words, arguments.at) - words.begin());
    const Run run = read_run(arguments.run);
    const Scenario scenario = scenario_of_run(run, arguments.run);
    std::optional<InterruptWatch> watch;
    const std::function<bool()> goes_on = [] { return InterruptWatch::signal() == 0; };
    const Patience patience(goes_on);
    JsonWriter json(2);
    json.begin_object();
    for (std::size_t i = 0; i < formats.size(); ++i) {
        if (files[i].empty()) continue;
        if (formats[i].is_drawn && !watch) watch.emplace();   // a browser must not be left behind
        write_export(formats[i], files[i],
                     {arguments.run, scenario, run, arguments.force, instants, arguments.units, picture});
        json.member(formats[i].word, files[i]);
        if (!common.json) say_note("wrote " + plain(files[i]));
    }
    json.member("converged", run.report.reached_end()).end_object();
    if (common.json) print(json.text() + "\n");
    return exit_ok;
}

}   // namespace livens::program
