// SPDX-License-Identifier: BSD-3-Clause
// Where results go, and what must not be destroyed by them.
#pragma once

#include <filesystem>
#include <string_view>

#include "commands.h"
#include "livens/io/exports.h"

namespace livens::program {

/// Same file by any path; missing ones are compared by their folders.
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// The record of a run lies beside it, under its whole name and ".json".
std::filesystem::path record_of(const std::filesystem::path& run);

/// Whether standard output goes into this very file: a rename would take it away.
bool is_standard_output(const std::filesystem::path& file);

/// Whether the record may take this name: nothing is there, or an older record.
bool may_record(const std::filesystem::path& file);

/// Throws what happens now if `file` cannot be written or must not: if it is the record of a run, or standard
/// output, or, unless `force`, a file that is not empty and does not begin as `is_own` has it. Call before
/// solving, so that nothing is computed in vain.
void check_place(const std::filesystem::path& file, bool (*is_own)(std::string_view head), bool force);
/// Likewise for an export of `run`, which overwrites no result at all and ends as its readers expect.
void check_export_place(const std::filesystem::path& file, const ExportFormat& format,
                        const std::filesystem::path& run, bool force);
/// Writes a result. A file of somebody else that came since the place was looked at stays, unless `force`,
/// and so does the motion, beside it; then it throws what ends in exit code 6.
void write_result(const std::filesystem::path& output, const Model& model, const Run& run, bool force);
/// Throws if `file` is what a scenario was read from, whatever is forced.
void check_inputs(const std::filesystem::path& file, const Scenario& scenario);
/// Throws if `file` is `other`, which `why` names.
void check_differs(const std::filesystem::path& file, const std::filesystem::path& other, const char* why);
/// What the arguments say of one scenario alone, or of a folder.
void check_several(const SolveArguments& arguments);
/// NAME.2.nc and so on, beside NAME.nc.
std::filesystem::path root_place(std::filesystem::path output, std::size_t i);
/// Whether a run stands there that came to its end.
bool is_converged_run(const std::filesystem::path& file);

}   // namespace livens::program
