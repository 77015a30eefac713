// Figures of a run in words for people.
#pragma once

#include <string>

#include "livens/io/results.h"

namespace livens::program {

/// Indented lines on constraints, energy and momentum.
std::string figures(const RunSummary& summary);

/// One sentence: how good the run is.
std::string verdict(const RunSummary& summary);

}   // namespace livens::program
