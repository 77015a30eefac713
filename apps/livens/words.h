// Figures of a run in words for people.
#pragma once

#include <string>

#include "livens/io/json.h"
#include "livens/io/results.h"

namespace livens::program {

/// Indented lines on constraints, energy and momentum.
std::string figures(const RunSummary& summary);

/// One sentence: how good the run is.
std::string verdict(const RunSummary& summary);

/// The figures as members of an object: residual, violations, drifts, zig-zag and, where it was asked for
/// (else null), condition numbers.
void write_figures(JsonWriter& json, const RunSummary& s);

}   // namespace livens::program
