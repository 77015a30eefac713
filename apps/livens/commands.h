// SPDX-License-Identifier: BSD-3-Clause
// The subcommands: each takes its arguments, prints and returns the exit code; failures are thrown (see
// failure.h).
#pragma once

#include <string>
#include <vector>

#include "livens/io/diagnostic.h"
#include "livens/io/exports.h"
#include "livens/io/results.h"
#include "livens/io/scenario.h"

namespace livens::program {

struct CommandInfo;

struct Common {
    bool json = false;
    bool quiet = false;
    bool verbose = false;
    DiagnosticFormat diagnostics = DiagnosticFormat::human;
    ParameterValues parameters = {};   ///< of scenarios, by --set
};

struct SolveArguments {
    std::vector<std::string> scenarios;   ///< one or several
    std::string output;   ///< empty: the scenario's stem with .nc in the current folder; a folder for several
    std::string csv;      ///< empty: none
    int roots = 0;        ///< motions to look for; 0: as the scenario says
    std::string guess;    ///< run that motions between both ends begin with; empty: none
    bool force = false;   ///< whatever stands where files go
    int jobs = 0;         ///< scenarios at a time; 0: one for each processor
    int threads = -1;     ///< of each motion; -1: as the scenario says
    bool is_distributed = false;   ///< by all processes that mpirun has started
    std::string simd;   ///< set of instructions; empty: what LIVENS_SIMD says, else AVX2 if it is there
};
int solve_command(const SolveArguments& arguments, const Common& common);
/// The same of one scenario by several processes.
int distributed_command(const SolveArguments& arguments, const Common& common);

int check_command(const std::string& scenario, const Common& common);

struct ImportArguments {
    std::string file;              ///< URDF
    std::string output;            ///< scenario; empty: the file's stem with .toml in the current folder
    std::vector<std::string> at;   ///< JOINT=VALUE, rad or m
    std::vector<std::string> packages;   ///< NAME=FOLDER
    std::string base = "fixed", meshes = "draw", limits = "stop", inertias = "mend";
    std::string end = "1";   ///< as typed, s
    bool is_strict = false;
    bool force = false;
};
int import_command(const ImportArguments& arguments, const Common& common);

struct MassArguments {
    std::string file;            ///< a mesh, or a scenario (.toml)
    std::string unit = "m";      ///< of a mesh's numbers
    std::string density = "1";   ///< as typed, kg/m^3
    bool turn = false;
};
int mass_command(const MassArguments& arguments, const Common& common);

int equilibrium_command(const std::string& scenario, const Common& common);

struct ModesArguments {
    std::string scenario;
    std::string at = "equilibrium";             ///< or "start"
    std::vector<std::string> inputs, outputs;   ///< of the state matrices, see state_matrices()
};
int modes_command(const ModesArguments& arguments, const Common& common);

int info_command(const std::string& run, const Common& common);

struct SampleArguments {
    std::string run;
    std::string body;   ///< one of body, joint and sensor is given
    std::string joint;
    std::string sensor;
    std::vector<std::string> at;   ///< instants as typed, s
    bool exact = false;
    bool csv = false;
    std::vector<std::string> units;   ///< of text and CSV; none: SI
};
int sample_command(const SampleArguments& arguments, const Common& common);
/// What is printed of a sensor.
std::string sample_sensor(const SampleArguments& arguments, const Common& common, const Run& run,
                          const Scenario& scenario, const std::vector<double>& times);

struct PeaksArguments {
    std::string run;
    std::vector<std::string> names;   ///< of find_peaks()
    std::vector<std::string> units;   ///< none: SI
    bool csv = false;
};
int peaks_command(const PeaksArguments& arguments, const Common& common);

struct ExportArguments {
    std::string run;
    std::vector<std::string> files;     ///< one a format of export_formats(); empty: not asked for
    std::vector<std::string> outputs;   ///< whose formats their endings tell
    std::string at = "auto";            ///< a word of Instants
    std::vector<std::string> units;     ///< of CSV; none: SI
    PictureOptions picture;
    std::string size;   ///< of pictures, "1280x720"; empty: as usual
    bool force = false;
};
int export_command(const ExportArguments& arguments, const Common& common);

struct ReportArguments {
    std::string run;
    std::string other;           ///< that it is compared with; empty: none
    std::string output;          ///< HTML file; of `report` alone
    bool force = false;          ///< of `report` alone
    int port = 0;                ///< of `view` alone; 0: one that is free
    bool address_only = false;   ///< of `view`: no browser
    std::string watched;         ///< of `view`: a scenario instead of a run; empty: none
};
int report_command(const ReportArguments& arguments, const Common& common);
int view_command(const ReportArguments& arguments, const Common& common);
/// The page of a run, or of two.
std::string report_of(const ReportArguments& arguments);

struct DiffArguments {
    std::string first, second;   ///< result files
    std::string rtol = "1e-6";   ///< as typed
    std::string atol = "1e-9";
};
int diff_command(const DiffArguments& arguments, const Common& common);

/// `name` may be empty.
int init_command(const std::string& name, const Common& common);

/// `type` is one of schema_types(), or empty for the whole schema.
int schema_command(bool markdown, const std::string& type);
int explain_command(const std::string& code);
int version_command(const Common& common);

struct CompletionArguments {
    std::string shell;
    std::string bodies;   ///< a result file: its bodies, one a line, for the scripts
    std::string joints;   ///< likewise
    std::string sensors;
};
int completion_command(const CompletionArguments& arguments, const std::vector<CommandInfo>& commands);
int man_command(const std::vector<CommandInfo>& commands);

}   // namespace livens::program
