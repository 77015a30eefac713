// SPDX-License-Identifier: BSD-3-Clause
// A run as one page for a browser: picture in space, plots, quality. Nothing is loaded from anywhere.
#pragma once

#include <string>
#include <string_view>

#include "livens/io/results.h"
#include "livens/io/scenario.h"

namespace [[gnu::visibility("default")]] livens {

struct ReportInput {
    const Scenario& scenario;   ///< that of the run's text
    const Run& run;
    std::string name;   ///< how the page calls the run, such as the stem of its file
};

struct ReportOptions {
    /// What the poses of a run take on the page, bytes, roughly: those of all nodes in double precision if
    /// they fit, else rounded to a ten-millionth of their range, else those of fewer, longer elements. The
    /// page says which, and by how much it is off. Series over time may take half as much.
    double most_bytes = 1.5e6;
    int level = 9;   ///< of compression: 1 is quick, 9 small
};

/// HTML of one run, or of two that are compared (the poses of each may take `most_bytes`): `other` may be
/// null. One file that needs no network; its policy admits its own script and style by their hashes and
/// nothing else, and all names and texts of a run are shown as text.
///
/// Poses are polynomials in time elements as in the run itself. Same runs, same bytes (with one version of
/// zlib).
std::string report_page(const ReportInput& run, const ReportInput* other = nullptr,
                        const ReportOptions& options = {});

/// A run as pages hold it.
struct ReportedRun {
    std::string title;
    std::string meta;      ///< JSON on one line
    std::string numbers;   ///< base64
};
ReportedRun reported(const ReportInput& run, const ReportOptions& options = {});

/// The page of a scenario that is solved again and again: its policy lets it listen to where it was loaded
/// from. There "events?N" sends what is newer than number N, the page's own: `run` null is a page that waits
/// for the first. docs/program.md, "Watching a file".
std::string live_page(const std::string& title, const ReportedRun* run, long number);

/// Whether a file that begins so is such a page; see is_occupied().
bool begins_as_report(std::string_view head);

}   // namespace gnu::visibility("default")]]livens
