// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/nodal/window_blocks.h"

namespace livens {

/// Of each node, or, with `every` = degree, of ends of elements alone. Where momenta are unknown the border
/// has those of both ends along free motions, and numbers; a part of a chain has its own count of closing
/// rows, and unknowns that join them to those of other ranks (docs/theory.md, "Lobatto windows on ranks").
BlockStructure spacetime_internal::structure_of(const WindowLayout& layout, int freedoms, int every)
{
    const int n = (layout.n_nodes() - 1) / every + 1, per_element = layout.degree / every;
    BlockStructure structure;
    structure.n_rows.assign(static_cast<std::size_t>(n), 0);
    for (int i = 0; i < n; ++i) {
        structure.n_unknowns.push_back(layout.is_unknown(i * every) ? freedoms : 0);
        if (layout.is_active(i * every)) structure.n_rows[place_of_row(layout, i)] = freedoms;
    }
    for (int e = 0; e < layout.n_elements(); ++e)
        structure.elements.push_back({e * per_element, (e + 1) * per_element});
    if (layout.are_momenta_unknown)
        structure.n_border = structure.n_closing = 2 * freedoms + layout.n_numbers;
    if (layout.part) {
        structure.is_part = true;
        structure.n_closing = layout.part->n_closing;
        structure.n_border += layout.part->n_joins;
    }
    return structure;
}

}   // namespace livens
