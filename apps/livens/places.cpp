// SPDX-License-Identifier: BSD-3-Clause
#include "places.h"

#include <fstream>
#include <string>

#include <sys/stat.h>
#include <unistd.h>

#include "console.h"
#include "failure.h"
#include "livens/io/results.h"

namespace livens::program {

namespace {

namespace fs = std::filesystem;

bool begins_with(const fs::path& file, std::string_view head)
{
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return false;
    std::string found(head.size(), '\0');
    std::ifstream in(file, std::ios::binary);
    in.read(found.data(), static_cast<std::streamsize>(found.size()));
    return found == head;
}

/// How every record begins, and nothing else that is likely.
bool is_record(const fs::path& file) { return begins_with(file, "{\n  \"converged\""); }

[[noreturn]] void refuse(const fs::path& file, const char* why)
{
    throw failure(exit_input_output, "cannot write '" + file.string() + "': " + why);
}

void check_not_occupied(const fs::path& file, bool (*is_own)(std::string_view head))
{
    if (is_occupied(file, is_own))
        refuse(file, "the file there was not written by livens as this kind; choose another "
                     "name, or add '--force' to replace it");
}

}   // namespace

bool same_file(const fs::path& a, const fs::path& b)
{
    std::error_code error;
    if (fs::equivalent(a, b, error) && !error) return true;
    const fs::path full_a = fs::weakly_canonical(a, error), full_b = fs::weakly_canonical(b, error);
    return !full_a.empty() && full_a == full_b;
}

fs::path record_of(const fs::path& run) { return fs::path(run) += ".json"; }

bool is_standard_output(const fs::path& file)
{
    struct stat there {
    }, output{};
    return ::stat(file.c_str(), &there) == 0 && ::fstat(STDOUT_FILENO, &output) == 0 &&
           output.st_dev == there.st_dev && output.st_ino == there.st_ino;
}

bool may_record(const fs::path& file)
{
    std::error_code error;
    return !fs::exists(fs::symlink_status(file, error)) || (is_record(file) && !is_standard_output(file));
}

void check_place(const fs::path& file, bool (*is_own)(std::string_view head), bool force)
{
    check_writable(file);
    if (is_standard_output(file)) refuse(file, "standard output goes there");
    if (is_record(file)) refuse(file, "it is the record of a run");
    if (!force) check_not_occupied(file, is_own);
}

void check_inputs(const fs::path& file, const Scenario& scenario)
{
    check_differs(file, scenario.file, "it is the scenario itself");
    for (const fs::path& mesh : scenario.mesh_files)
        check_differs(file, mesh, "it is a mesh of the scenario");
}

void check_export_place(const fs::path& file, const ExportFormat& format, const fs::path& run, bool force)
{
    check_differs(file, run, "it is the run itself");
    check_differs(file, record_of(run), "it is the record beside the run");
    check_place(file, format.is_own, true);
    if (begins_with(file, "CDF")) refuse(file, "it is a result file");
    if (file.extension() != format.extension)
        throw failure(exit_usage, std::string("--") + format.word + " writes files that end in '" +
                                      format.extension + "', not '" + file.filename().string() + "'");
    if (!force) check_not_occupied(file, format.is_own);
}

void write_result(const fs::path& output, const Model& model, const Run& run, bool force)
{
    try {
        write_run(output, model, run, !force);
    } catch (const OccupiedError& error) {
        fs::path beside;
        for (int n = 1; beside.empty() || fs::exists(fs::symlink_status(beside)); ++n)
            beside = output.parent_path() / (output.stem().string() + "-" + std::to_string(n) + ".nc");
        write_run(beside, model, run, true);
        throw failure(exit_input_output,
                      std::string(error.what()) + "; the motion is in '" + beside.string() + "'");
    }
}

void check_differs(const fs::path& file, const fs::path& other, const char* why)
{
    if (same_file(file, other)) refuse(file, why);
}

void check_several(const SolveArguments& arguments)
{
    if (!arguments.csv.empty())
        throw failure(exit_usage,
                      "'--csv' takes the samples of one scenario; 'livens export' makes them of any result");
    std::error_code unknown;   // what cannot be looked at is no folder to write to
    if (!arguments.output.empty() && !fs::is_directory(arguments.output, unknown))
        throw failure(exit_usage, "'--output' has to be a folder where several scenarios are solved; '" +
                                      plain(arguments.output) + "' is none");
}

fs::path root_place(fs::path output, std::size_t i)
{
    return output.replace_extension("." + std::to_string(i + 2) + ".nc");
}

bool is_converged_run(const fs::path& file)
{
    std::error_code unknown;
    if (!fs::is_regular_file(file, unknown)) return false;
    try {
        return read_run_head(file).run.report.reached_end();
    } catch (const IoError&) {
        return false;
    }
}

}   // namespace livens::program
