// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/guess_of_components.h"

#include <algorithm>
#include <utility>

#include "livens/multibody/model.h"
#include "livens/spacetime/guess.h"
#include "livens/spacetime/march/components.h"

namespace livens::inline spacetime_internal {

Ends ends_for_guesses(const Model& model, const Ends& ends, std::span<const double> times)
{
    Ends guessed = ends;
    const ModelTables tables(model, ends.independent);
    if (!ends.is_end_guessed) {
        const State arrival = guess_from_state(model, ends.start, times).motion(ends.end.t);
        guessed.end = settled(tables, ends, Condition::At::end, arrival);
        guessed.end.t = ends.end.t;
    }
    for (const auto& [at, known] :
         {std::pair{Condition::At::start, &guessed.at_start}, {Condition::At::end, &guessed.at_end}}) {
        const auto is_place = [at = at](const Condition& one) {
            return one.at == at && !one.quantity.is_rate();
        };
        if (std::ranges::count_if(ends.components, is_place) >= tables.freedoms()) *known = Known::positions;
    }
    if (ends.whole[0] == Known::momenta) guessed.at_start = Known::momenta;
    if (ends.whole[1] == Known::momenta) guessed.at_end = Known::momenta;
    guessed.components.clear();
    return guessed;
}

}   // namespace livens::inline spacetime_internal
