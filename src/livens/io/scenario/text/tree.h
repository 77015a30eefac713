// SPDX-License-Identifier: BSD-3-Clause
// Scenarios from trees that another language made, for which places are what it says they are.
#pragma once

#include <string>

#include "livens/io/scenario.h"
#include "livens/io/scenario/text/document.h"

namespace livens::inline io_internal {

enum class TreePart {
    whole,
    model   ///< bodies, joints, drives, loads and sensors are looked at, and no scenario comes of it
};

/// As parse_scenario() has it, from a tree. `text` is what a file of it would hold; it goes to results.
/// Nothing is thrown.
ScenarioResult read_tree(const Node& root, std::string text, const MeshSource& meshes = {},
                         TreePart part = TreePart::whole);

}   // namespace livens::inline io_internal
