// SPDX-License-Identifier: BSD-3-Clause
// How right a run is, in words: the same in the program's summary, in Python and on pages.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "livens/io/results.h"

namespace [[gnu::visibility("default")]] livens {

enum class Grade { good, doubtful, bad };

/// What is said of a run first: "Converged", "good to 7 digits through 31 s, then 2", "constraints hold to
/// rounding".
struct Headline {
    Grade grade = Grade::bad;
    std::string word;
    std::string lead;
    std::string rest;   ///< may be empty
};

/// `end`: of its motion, s.
Headline headline_of(const Run& run, double end);

/// "7 digits through 31 s"
std::string digits_through(double digits, double t);

/// Why a run is not "converged", a sentence each; none of one that is.
std::vector<std::string> reasons_of(const Run& run);

/// A figure of the file by which a motion is judged, and what people call it.
struct JudgedFigure {
    const char* figure;    ///< "energy_drift"
    const char* name;      ///< "energy"
    const char* meaning;   ///< of its number: "relative to peak kinetic or stored energy"
};
/// In the order in which they are told.
std::span<const JudgedFigure> judged_figures();

/// Of one of them; the figure must be there.
const JudgedFigure& judged_figure(std::string_view figure);

}   // namespace gnu::visibility("default")]]livens
