// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/detail/window_notes.h"

#include "livens/base/text.h"

namespace livens {

namespace {

/// Below, a tolerance that rounding did not let be met deserves a word; down to here it asks for all digits
/// that there are, as an accuracy of many digits does.
constexpr double finest_tolerance = 1e-15;

}   // namespace

std::string count(int n, const char* what) { return std::to_string(n) + " " + what + (n == 1 ? "" : "s"); }

void add_notes(SolveReport& report, const WindowCounts& counts)
{
    if (counts.rounded > 0 && counts.tolerance < finest_tolerance)
        report.notes.push_back("the tolerance " + to_text(counts.tolerance, 6) +
                               " is below rounding: " + count(counts.rounded, "window") + " of " +
                               std::to_string(report.iterations.size()) +
                               " ended where rounding left nothing to gain");
    if (counts.splits > 0)
        report.notes.push_back(count(counts.splits, "window") +
                               " failed as a whole and were solved in halves");
    if (report.divided > 0)
        report.notes.push_back(
            count(report.divided, "element") +
            " were too long for the motion and were divided into two, the first near t = " +
            to_text(report.divided_at, 6) + " s");
    if (report.shifted > 0)
        report.notes.push_back(
            count(report.shifted, "element end") +
            " fell elsewhere than asked for, to keep nodes off singular positions of the joints, the "
            "first near t = " +
            to_text(report.shifted_at, 6) + " s");
    if (report.rescued > 0)
        report.notes.push_back(count(report.rescued, "window") + " of " +
                               std::to_string(report.iterations.size()) +
                               " needed a guess from many small elements; more elements would be cheaper");
}

}   // namespace livens
