// SPDX-License-Identifier: BSD-3-Clause
// Loads by reactions on their way through models: their laws are data, which are made into loads where the
// whole is known.
#include "livens/multibody/loads/reaction_law.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "livens/base/error.h"
#include "livens/multibody/model.h"

namespace livens {

/// A place in the list of loads until the model is known as a whole: no force, and readings that are no
/// numbers.
Load waiting(ReactionLaw law, int look_from)
{
    Load load;
    load.name = law.name;
    load.type = law.type;
    load.bodies = {look_from, world};
    for (const Load& unit : law.units) {
        if (unit.bodies != law.units[0].bodies || unit.bodies.size() != 2)
            throw InputError({"load-empty", "load[" + law.name + "]",
                              "units of a load act on the same two bodies", "", "", "", ""});
        load.bodies = unit.bodies;
        for (std::size_t b = 0; b < 2; ++b)
            load.needs_directors[b] = load.needs_directors[b] || unit.needs_directors[b];
    }
    load.breaks = law.breaks;
    load.forces = [](const LoadArguments&, LoadForces&) {};
    for (const ReactionLaw::Reading& reading : law.readings)
        load.readings.push_back({reading.name, reading.unit, [](const LoadArguments&) {
                                     return std::numeric_limits<double>::quiet_NaN();
                                 }});
    load.by_reactions = std::make_shared<const ReactionLaw>(std::move(law));
    return load;
}

bool reads_reactions(const Model& model)
{
    return std::ranges::any_of(model.loads(), [](const Load& load) { return load.by_reactions != nullptr; });
}

/// Laws get the model without loads by reactions, which they solve together among themselves, and without
/// what only looks at a motion.
void bind_reaction_laws(Model& model)
{
    if (!reads_reactions(model)) return;
    Model rest = model;
    rest.sensors_.clear();
    rest.events_.clear();
    rest.samplings_.clear();
    std::erase_if(rest.loads_, [](const Load& load) { return load.by_reactions != nullptr; });
    rest.changed();
    std::vector<ReactionLaw> laws;
    std::vector<Load*> loads;
    for (Load& load : model.loads_) {
        if (load.by_reactions == nullptr) continue;
        loads.push_back(&load);
        laws.push_back(*load.by_reactions);
        if (load.is_partial()) laws.back().times = load;
    }
    std::vector<Load> made = laws[0].make(rest, laws);
    for (std::size_t k = 0; k < made.size(); ++k) {
        static_cast<ActingTimes&>(made[k]) = *loads[k];
        made[k].by_reactions = std::make_shared<const ReactionLaw>(laws[k]);
        model.has_.pieces = model.has_.pieces || !made[k].guards.empty();
        *loads[k] = std::move(made[k]);
    }
    model.changed();
}

}   // namespace livens
