// Result files: NetCDF-4, written whole or not at all.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "livens/diagnostics/diagnostics.h"
#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"
#include "livens/solvers/report.h"
#include "livens/spacetime/solve.h"

namespace livens {

inline constexpr int format_major = 1;   ///< an unknown one is refused
inline constexpr int format_minor = 1;   ///< additions only

/// The figures by which a run is judged; the program's --json prints them.
struct RunSummary {
    bool converged = false;
    std::string status;   ///< "converged", "not converged", "cancelled", "suspect", ...
    std::string method;   ///< name_of() the method
    int elements = 0;
    int unknowns = 0;
    long newton_iterations = 0;
    long factorisations = 0;
    double residual_norm = 0;
    double max_constraint_violation = 0;   ///< at element nodes, each row by its scale; rigidity included
    double max_velocity_violation = 0;     ///< |dPhi/dt| / scale at element ends, 1/s
    double energy_drift = 0;               ///< relative, see Balance
    double angular_momentum_drift = 0;     ///< relative, see Balance
    std::vector<std::string> notes;
    std::string message;
    double max_weak_violation = 0;   ///< where constraints hold weakly: largest mean over an element; else 0
    double zigzag_positions = 0;     ///< 0 smooth to 1 pure zig-zag, see Zigzag; nan without a motion
    double zigzag_momenta = 0;
    double zigzag_time = 0;         ///< of the worst of both, s
    double condition_1 = 0;         ///< of the last block's matrix in the 1-norm; 0 if nobody asked
    double condition_2 = 0;         ///< and in the 2-norm
    double scaled_condition = 0;    ///< in the 1-norm, as it is factorised
};

/// A run as it stands in the file: everything but the model, which is made again from the scenario text.
struct Run {
    std::string scenario_text;
    std::string title;
    std::string resolved;   ///< options after defaults, JSON
    std::vector<std::string> body_names;
    std::vector<bool> body_is_point;
    std::vector<Vector3> centers_of_mass;   ///< body coordinates
    std::vector<std::string> joint_names;
    std::vector<std::string> row_labels;   ///< "elbow: x"
    std::vector<double> output;            ///< output times
    Motion motion;
    SolveReport report;
    RunSummary summary;
    Balance balance;
    std::string version;   ///< of the livens that wrote it
};

/// Acceptance and figures of a solution. `suspect` when it converged but
///   |Phi| / scale at nodes > 1e-6, where constraints hold at points;
///   its mean over an element > 1e-3, or |Phi| / scale at nodes > 0.05, where they hold weakly (the latter
///   are errors of the discretisation, not of the solution, and fall with the elements);
///   Zigzag of positions or momenta > 0.5 for the family mixed, which can converge to motions that no
///   mechanism makes (the others cannot, so theirs is only stated);
///   the motion farther than 0.05 of the model's length from the march it was guessed by, if it was;
///   an energy or momentum balance is off by more than 5 percent.
RunSummary summarise(const Model& model, const Solution& solution, const Method& method,
                     const Balance& balance);

/// A run with everything that follows from these three: names, balance, summary, version; `output` holds all
/// element ends. Scenario text, title and resolved options are left to the caller.
Run make_run(const Model& model, Solution solution, const Method& method);

/// Writes to a temporary name in the same folder, reads it back, syncs, renames. Same run, same bytes.
/// Throws IoError; the old file is untouched then.
void write_run(const std::filesystem::path& file, const Model& model, const Run& run);
Run read_run(const std::filesystem::path& file);

/// CSV of the samples at the output times: t, then per body position, quaternion (w, x, y, z), velocity,
/// angular velocity; then energies. Written as atomically as the run.
void write_csv(const std::filesystem::path& file, const Model& model, const Run& run);

/// Throws IoError now if `file` could not be written: the folder is missing, it is a directory, no
/// permission. Call before solving, so that nothing is computed in vain.
void check_writable(const std::filesystem::path& file);

/// Replaces `file` by `bytes`: a temporary name in the same folder is written, read back and compared, synced
/// and renamed. Whatever happens, at any instant, `file` is the old one or the new one; a failure removes the
/// temporary. A symbolic link stays and its target is replaced; the access rights of an older file are kept.
/// Throws IoError.
void replace_file(const std::filesystem::path& file, std::string_view bytes);

/// A file that cannot be read or written, or is not what it should be. The message names it.
class IoError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}   // namespace livens
