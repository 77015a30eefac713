// SPDX-License-Identifier: BSD-3-Clause
// Result files that several processes write together.
#pragma once

#include <filesystem>

#include "livens/io/results.h"
#include "livens/io/scenario.h"
#include "livens/solvers/ranks.h"
#include "livens/spacetime/on_ranks.h"
#include "livens/spacetime/solve.h"

namespace [[gnu::visibility("default")]] livens {

/// The run of which this process has a part: solve_on_ranks() of the scenario, or of the one that begins with
/// the unknown numbers that were found. Everything but motion and series is that of the whole.
Run part_of_run(const Scenario& scenario, Solution part, const RankWork& work);

/// Each rank writes its part of the motion into the same file, the first one all else, and puts it in place
/// when all have. There are no samples at output times in it: `livens sample` and `livens export` make these.
/// See write_run(); called by all ranks. All must see the folder.
void write_parts(const std::filesystem::path& file, const Scenario& scenario, const Run& part, Ranks& ranks,
                 bool spares_others);

}   // namespace gnu::visibility("default")]]livens
