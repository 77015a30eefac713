// SPDX-License-Identifier: BSD-3-Clause
// livens import: a scenario out of another program's file.
#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <set>

#include "commands.h"
#include "console.h"
#include "failure.h"
#include "finite_number.h"
#include "livens/io/import.h"
#include "places.h"
#include "summary.h"

namespace livens::program {

namespace {

/// NAME=VALUE as typed; names may hold '=' no more than values may.
std::pair<std::string, std::string> pair_of(const std::string& text, const char* option)
{
    const std::size_t at = text.rfind('=');
    if (at == std::string::npos || at == 0 || at + 1 == text.size())
        throw failure(exit_usage, std::string(option) + " takes NAME=VALUE, not '" + text + "'");
    return {text.substr(0, at), text.substr(at + 1)};
}

UrdfOptions options_of(const ImportArguments& arguments, const std::filesystem::path& output)
{
    UrdfOptions options;
    for (const std::string& text : arguments.at) {
        const auto [name, value] = pair_of(text, "--at");
        options.at[name] = finite_number(value, "--at", "a number");
    }
    for (const std::string& text : arguments.packages) {
        const auto [name, folder] = pair_of(text, "--package");
        options.packages[name] = folder;
    }
    if (arguments.base == "free") options.base = UrdfOptions::Base::free;
    if (arguments.meshes == "none") options.meshes = UrdfOptions::Meshes::none;
    if (arguments.limits == "ignore") options.limits = UrdfOptions::Limits::ignore;
    if (arguments.inertias == "strict") options.inertias = UrdfOptions::Inertias::strict;
    options.is_strict = arguments.is_strict;
    options.end = finite_number(arguments.end, "--end", "a number");
    options.folder = output.parent_path();
    return options;
}

/// Made by this command before.
bool is_imported(std::string_view head)
{
    return head.starts_with("# From ") && head.substr(0, head.find('\n')).ends_with(", by livens import.");
}

std::string content_of(const std::filesystem::path& file)
{
    std::ifstream in(file, std::ios::binary);
    std::string content((std::istreambuf_iterator<char>(in)), {});
    if (!in) throw failure(exit_input_output, "cannot read '" + file.string() + "'");
    return content;
}

/// Meshes that are not below the scenario's folder are put there by the same paths.
void put_meshes(const std::filesystem::path& output, const std::filesystem::path& folder,
                const std::vector<std::filesystem::path>& meshes, bool force)
{
    namespace fs = std::filesystem;
    std::set<fs::path> done;
    for (const fs::path& mesh : meshes) {
        std::error_code error;
        const fs::path source = fs::weakly_canonical(mesh, error);
        const fs::path target = output.parent_path() / source.lexically_relative(folder);
        if (!done.insert(source).second || same_file(source, target)) continue;
        fs::create_directories(target.parent_path(), error);
        const bool is_there = fs::exists(fs::symlink_status(target, error));
        if (is_there && fs::is_regular_file(target, error) && content_of(source) == content_of(target))
            continue;
        for (const fs::path& other : meshes) check_differs(target, other, "it is a mesh of the robot");
        if (is_there && !force)
            throw failure(exit_input_output,
                          "cannot write '" + target.string() +
                              "': a file of other content is there; choose another folder, "
                              "or add '--force' to replace it");
        replace_file(target, content_of(source));
    }
}

std::string json_of(const std::filesystem::path& output, const Scenario& scenario,
                    const std::vector<Diagnostic>& imported)
{
    JsonWriter json(2);
    json.begin_object().member("scenario", output.string()).member("title", scenario.title);
    json.member("bodies", scenario.model.n_bodies()).member("joints", scenario.model.joints().size());
    json.member("loads", scenario.model.loads().size()).key("warnings");
    write_diagnostics(json, imported);
    json.key("errors").begin_array().end_array().end_object();
    return json.text() + "\n";
}

}   // namespace

int import_command(const ImportArguments& arguments, const Common& common)
{
    std::filesystem::path output = arguments.output;
    if (output.empty()) output = std::filesystem::path(arguments.file).stem().string() + ".toml";
    check_differs(output, arguments.file, "it is the file that is imported");
    check_place(output, is_imported, arguments.force);
    UrdfResult result = read_urdf(arguments.file, options_of(arguments, output));
    const std::string toml = std::move(result.toml);
    std::vector<Diagnostic> imported;
    const Scenario scenario = accepted(std::move(result), common, &imported);
    check_inputs(output, scenario);
    put_meshes(output, result.folder, scenario.mesh_files, arguments.force);
    replace_file(output, toml);
    if (common.json) {
        print(json_of(output, scenario, imported));
        return exit_ok;
    }
    if (common.quiet) return exit_ok;
    Summary summary(terminal_of(STDOUT_FILENO));
    const auto counted = [](std::size_t n, const char* one, const char* many) {
        return fmt::format("{} {}", n, n == 1 ? one : many);
    };
    summary.headline(Ink::good, "Written",
                     fmt::format("{}, {}, {} and {}", plain(output.string()),
                                 counted(scenario.model.bodies().size(), "body", "bodies"),
                                 counted(scenario.model.joints().size(), "joint", "joints"),
                                 counted(scenario.model.loads().size(), "load", "loads")));
    summary.aside("next: livens solve " + plain(quoted(output.string())));
    print(summary.text());
    return exit_ok;
}

}   // namespace livens::program
