// SPDX-License-Identifier: BSD-3-Clause
// Result files: classic NetCDF, written whole or not at all.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "livens/diagnostics/acceptance.h"
#include "livens/multibody/motion.h"
#include "livens/solvers/report.h"
#include "livens/spacetime/method.h"

namespace [[gnu::visibility("default")]] livens {

struct Solution;

class JsonWriter;

inline constexpr int format_major = 2;   ///< an unknown one is refused
extern const int format_minor;           ///< additions only; grows with the newest figure

/// What the parts of a model are called, and what a reader needs of them beside their motion.
struct PartNames {
    std::vector<std::string> body_names;
    std::vector<bool> body_is_point;
    /// Those that stand for states of controllers, and are nothing to be told of; empty: there are none.
    std::vector<bool> body_holds_states;
    std::vector<Vector3> centers_of_mass;   ///< body coordinates
    std::vector<std::string> joint_names;
    std::vector<std::string> row_labels;   ///< "elbow: x"

    /// The first of them are to be told of: what holds states comes last.
    std::size_t n_told_bodies() const
    {
        std::size_t n = body_names.size();
        while (n > 0 && n <= body_holds_states.size() && body_holds_states[n - 1]) --n;
        return n;
    }
    std::vector<std::string> told_bodies() const
    {
        return {body_names.begin(), body_names.begin() + static_cast<std::ptrdiff_t>(n_told_bodies())};
    }
};

/// What was found of unknown numbers, in SI units.
struct RunNumbers {
    std::vector<std::string> names;
    std::vector<double> values, errors;   ///< estimated; nan: not known
};

/// What the motion decided, in its order.
struct RunEvents {
    std::vector<std::string> names;      ///< of the scenario's events
    std::vector<double> times, errors;   ///< s; estimated, nan: not known
    /// Of impacts, N s or N m s, and m/s or rad/s, else 0; and when a stop that closes would be at rest, s,
    /// nan: bodies bounce, or it is none.
    std::vector<double> impulses, speeds, rests;
};

/// A run as it stands in the file: everything but the model, which is made again from the scenario text.
struct Run : PartNames {
    std::string scenario_text;
    std::string meshes;   ///< Scenario::meshes
    std::string title;
    std::string resolved;         ///< options after defaults, JSON
    std::vector<double> output;   ///< output times
    std::string method;           ///< name_of() the method
    Motion motion;
    SolveReport report;
    RunEvents events;
    RunNumbers numbers;
    Verdict verdict;   ///< from a file without reasons, remarks and violations
    ErrorEstimate estimate;
    std::vector<double> growth;       ///< Solution::growth, nan where the neighbouring motion did not come
    std::vector<std::string> notes;   ///< of the report and of the verdict
    std::string version;              ///< of the livens that wrote it
};

/// A run with everything that follows from these three: names, notes, version; `output` holds all element
/// ends. Scenario text, title and resolved options are left to the caller.
Run make_run(const Model& model, Solution solution, const Method& method);

/// Writes to a temporary name in the same folder, syncs, renames: see replace_file(). Same run, same bytes.
/// Takes next to no memory of its own: 40 bytes an element for integrals, 8 a node for times, a buffer.
/// `spares_others`: throws OccupiedError where what stands there by then is_occupied() by no run.
void write_run(const std::filesystem::path& file, const Model& model, const Run& run,
               bool spares_others = false);
Run read_run(const std::filesystem::path& file);

/// What can be had without reading the motion, however large: figures, names, notes and options.
struct RunHead {
    Run run;   ///< of the motion only what is a figure; no scenario text, labels, output times and balances
    double start = 0;   ///< s, of the motion
    double end = 0;
    long long n_output_times = 0;
};
RunHead read_run_head(const std::filesystem::path& file);

/// Throws IoError unless the run is one of this model, so that both can be used together: the scenario in a
/// file is a stranger to its motion, whatever the checksums say.
void check_model(const Model& model, const Run& run);

/// The figures of report, verdict and motion as members of an object, named as in the file; null: not known.
void write_figures(JsonWriter& json, const Run& run);

/// Estimated errors of its unknown numbers, if it has some, as "found_errors"; null: not known.
void write_found_errors(JsonWriter& json, const Run& run);
/// What the motion decided, if anything, as "events": a list of {name, t, error}.
void write_events(JsonWriter& json, const Run& run);

/// Throws IoError now if `file` could not be written: the folder is missing, it is a directory, no
/// permission, a device or a pipe. A temporary file is made there and removed again, to be sure. Call before
/// solving, so that nothing is computed in vain.
void check_writable(const std::filesystem::path& file);

/// Replaces `file` by `bytes`: a temporary name in the same folder is written, synced and renamed. Whatever
/// happens, at any instant, `file` is the old one or the new one; a failure removes the temporary, and those
/// that killed processes left in this folder go as well. A symbolic link stays and its target is replaced;
/// the access rights of an older file are kept, but for set-user-ID and set-group-ID. Throws IoError.
void replace_file(const std::filesystem::path& file, std::string_view bytes);

/// How much of a file tells what it is.
inline constexpr std::size_t telling_bytes = 8192;
/// Whether a file that begins so is a run that livens wrote, whole or damaged.
bool begins_as_run(std::string_view head);
/// Whether something is lost if `file` is replaced: it is there, holds something, and does not begin as
/// `is_own` has it (with telling_bytes of it, or all). What cannot be read counts; what is no regular file
/// does not: check_writable() refuses it.
bool is_occupied(const std::filesystem::path& file, bool (*is_own)(std::string_view head));

/// A file that cannot be read or written, or is not what it should be. The message names it.
class IoError : public std::runtime_error {
public:
    explicit IoError(const std::string& message, std::string code = "io")
        : std::runtime_error(message), code_(std::move(code))
    {}
    /// "io", or one that explain() has a page of.
    const std::string& code() const { return code_; }

private:
    std::string code_;
};

/// Nothing was written, since something stands there that is not to be replaced.
class OccupiedError : public IoError {
public:
    using IoError::IoError;
};

}   // namespace livens
