// SPDX-License-Identifier: BSD-3-Clause
// Positions that joints allow where the way from the start as it is stated leads to none, or to others than
// were meant.  (docs/theory.md, "Closing the mechanism")
#pragma once

#include <optional>
#include <span>
#include <string>

#include "livens/base/error.h"
#include "livens/dynamics/rows/projection.h"

namespace livens::inline dynamics_internal {

// All of models without drives, or frozen() at an instant.

/// Whether no axis is end for end, and no angle off by half a turn.
bool is_in_its_branch(const Model& model, std::span<const Matrix34> X);
/// Of drives alone, whose rows hold there as well.
bool drives_are_turned(const Model& model, std::span<const Matrix34> X);
/// `joint-branch`, where a start is in one: rows a . b = 0 hold for an axis turned end for end as well; a
/// start in that branch was not meant.
std::optional<Complaint> why_in_other_branch(const Model& model, std::span<const Matrix34> X);

struct Reach {
    Closing closing;   ///< closed: in its branch
    int n_tries = 0;   ///< disturbed starts that it took
    std::string how;   ///< for the notes; empty: from the start itself
};

/// Begins at X with driven angles as angles, not as their sines, and then at starts that are disturbed more
/// and more, always the same; from what closes, the nearest to X.
Reach reach(const Model& model, std::span<const Matrix34> X);

/// What to say where nothing closed: `joint-contradiction` if the other rows can be fulfilled, else
/// `start-position`. `open`: as near as the rows came from X.
Complaint why_open(const Model& model, const Closing& open, std::span<const Matrix34> X, int n_tries);

/// Of a row that is open at X: by how much the law of a drive is off, and what its writer can do. Empty for
/// other joints.
std::string drive_words(const Model& model, int row, std::span<const Matrix34> X);
std::string drive_help(const Model& model, int row, std::span<const Matrix34> X);

}   // namespace livens::inline dynamics_internal
