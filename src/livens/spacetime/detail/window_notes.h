// SPDX-License-Identifier: BSD-3-Clause
// What deserves a word after all windows were solved.
#pragma once

#include <string>

#include "livens/solvers/report.h"

namespace livens {

/// What the report itself does not hold.
struct WindowCounts {
    double tolerance = 0;
    int rounded = 0;   ///< windows that ended by rounding, short of the tolerance
    int splits = 0;    ///< windows that were solved in halves
};
void add_notes(SolveReport& report, const WindowCounts& counts);

/// "1 element", "2 elements".
std::string count(int n, const char* what);

}   // namespace livens
