// SPDX-License-Identifier: BSD-3-Clause
// The figures of a run: the one table that files, JSON and docs/results.md are made from.
#pragma once

#include <span>
#include <variant>

#include "livens/io/results.h"

namespace livens::inline io_internal {

/// Where the number stands in a Run.
using FigureMember =
    std::variant<int SolveReport::*, long SolveReport::*, long long SolveReport::*, double SolveReport::*,
                 double Verdict::*, double BalanceFigures::*, int Motion::*, double ErrorEstimate::*>;

struct Figure {
    const char* name;   ///< of the attribute, and the key in JSON
    const char* unit;
    const char* meaning;
    FigureMember member;
    bool zero_is_none = false;   ///< null in JSON then
    /// Minor version of the format; files of older ones lack it. Of a new one: one more than `livens version
    /// --json` of the last release says.
    int since = 0;
};

std::span<const Figure> run_figures();

double figure_of(const Run& run, const Figure& figure);
bool is_whole(const Figure& figure);
/// False if the member cannot hold this number.
bool set_figure(Run& run, const Figure& figure, double value);

}   // namespace livens::inline io_internal
