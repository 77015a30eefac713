// SPDX-License-Identifier: BSD-3-Clause
// The kinds of loads that a scenario knows: one table, from which schema, reader and documentation follow.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "livens/io/scenario/schema/section.h"
#include "livens/multibody/loads/load_laws.h"

namespace livens::inline io_internal {

class Builder;

/// When a load acts.
struct Interval {
    double from = -std::numeric_limits<double>::infinity();
    double until = std::numeric_limits<double>::infinity();
};
Interval read_interval(const Section& load);

/// What a load is made of; `second` is the world for a load on one body.
struct LoadSources {
    const Section& section;
    std::string name;
    int first, second;
    Builder& builder;
    std::vector<BodyPoint> over = {};   ///< of a rope

    std::string path() const { return "load[" + name + "]"; }
};

struct LoadKind : Kind {
    Load (*make)(const LoadSources&);
    /// What may be wrong beyond values. Null: nothing.
    bool (*check)(const Section&) = nullptr;
};

const std::vector<LoadKind>& load_kinds();

/// Reports all it finds.
void read_loads(Builder& builder);
/// Loads that read reactions, once the model is whole.
void bind_loads(Builder& builder);

}   // namespace livens::inline io_internal
