// Figures of a run in words for people.
#pragma once

#include <string>

#include "livens/io/json.h"
#include "livens/io/results.h"

namespace livens::program {

/// Indented lines on constraints, energy and momentum.
std::string figures(const Run& run);

/// One sentence: how good the run is.
std::string verdict(const Run& run);

}   // namespace livens::program
