// SPDX-License-Identifier: BSD-3-Clause
// Runs for other programs: one table of formats.
#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "livens/diagnostics/quantities.h"
#include "livens/io/results.h"
#include "livens/io/scenario.h"

namespace [[gnu::visibility("default")]] livens {

/// At which instants a table shows a motion. automatic: at the output times where the scenario lists them,
/// else dense.
enum class Instants {
    automatic,
    dense,   ///< see dense_instants()
    output,
    ends   ///< of elements
};
/// In options, in this order.
constexpr std::array<std::string_view, 4> words_of(Instants) { return {"auto", "dense", "output", "ends"}; }
std::vector<SeenInstant> instants_of(const Scenario& scenario, const Run& run, Instants which);

/// Of stills and videos. 0 or nan: as usual for the format, or the whole motion.
struct PictureOptions {
    int width = 0, height = 0;                                ///< px
    double rate = 0;                                          ///< frames a second
    double duration = 0;                                      ///< of the video, s
    double from = std::numeric_limits<double>::quiet_NaN();   ///< s of the motion; of a still the instant
    double to = std::numeric_limits<double>::quiet_NaN();
    std::string view = "fitted";   ///< or "front", "side", "top"
    bool is_dark = false;
    bool names = false;   ///< of bodies
    bool clock = false;
};

/// What an export is made of.
struct ExportInput {
    std::filesystem::path result;   ///< the file that `run` was read from
    const Scenario& scenario;       ///< that of its text
    const Run& run;
    bool force = false;   ///< whatever stands where further files go, beside the one that is named
    Instants instants = Instants::automatic;   ///< of tables
    std::vector<std::string> units = {};       ///< of tables, see shown_unit(); none: SI
    PictureOptions picture = {};
};

struct ExportFormat {
    const char* word;        ///< of the option: "gltf" is --gltf
    const char* extension;   ///< by which readers know the file: ".glb"
    const char* what;
    /// Whether a file that begins so is an older export, which may be replaced; see is_occupied().
    bool (*is_own)(std::string_view head);
    /// Written whole or not at all, as replace_file() does. Throws IoError; of pictures also InputError
    /// (`picture`) and Stopped.
    void (*write)(const std::filesystem::path& file, const ExportInput& input);
    bool is_drawn = false;   ///< by a browser: it takes its time, and asks Patience
    /// What the file will show wrongly, to be told as a warning; empty: nothing. Null: never anything.
    std::string (*doubt)(const ExportInput& input) = nullptr;
};

/// docs/results.md has the same table.
std::span<const ExportFormat> export_formats();

/// CSV: t, then per body position, quaternion (w, x, y, z), velocity, angular velocity, acceleration, angular
/// acceleration; energies; coordinates of joints, reactions, drives, sensors. An instant with two sides has
/// two rows. Names that spreadsheets would take for formulas begin with an apostrophe. No instants: the
/// output times. `units`: of numbers, see shown_unit(); the head names them. Throws InputError (`unit`).
void write_csv(const std::filesystem::path& file, const Model& model, const Run& run,
               std::vector<SeenInstant> instants = {}, std::span<const std::string> units = {});

}   // namespace gnu::visibility("default")]]livens
