// SPDX-License-Identifier: BSD-3-Clause
// Rows keep the numbers that the model gives them: one that is no quadratic form has no columns here, by
// which the kernels pass it over. Bodies that hold states have no mass here (theory.md, "States").
#include "livens/diagnostics/detail/point_tables.h"

#include <cmath>

#include "livens/multibody/model.h"

namespace livens::inline diagnostics_internal {

/// A row without a form has the gradient B everywhere, of which the numbers that are not zero are enough.
void PointTables::add_row(const RowTable& row)
{
    const bool is_linear = row.is_quadratic && row.form.empty();
    rows_.push_back({static_cast<int>(columns_.size()), static_cast<int>(entries_.size()), is_linear,
                     row.row->c, 1 / row.row->scale});
    if (!row.is_quadratic) return;
    for (int side = 0; side < row.n_sides; ++side)
        for (const int at : row.columns[side]) {
            const double* const B = row.B[side].a + at;
            const int number = 12 * row.bodies[side] + at;
            columns_.push_back({number,
                                static_cast<int>(terms_.size()),
                                {B[0], B[1], B[2]},
                                norm(Vector3{B[0], B[1], B[2]})});
            for (const RowTable::Entry& entry : row.form)
                if (entry.to_side == side && entry.to == at)
                    terms_.push_back({12 * row.bodies[entry.from_side] + entry.from, entry.value});
            for (int i = 0; is_linear && i < 3; ++i)
                if (B[i] != 0) entries_.push_back({number + i, B[i]});
        }
}

PointTables::PointTables(const ModelTables& of)
{
    for (int r = 0; r < of.n_rows(); ++r) {
        add_row(of.rows[r]);
        if (!of.rows[r].is_quadratic) others_.push_back(r);
    }
    rows_.push_back({static_cast<int>(columns_.size()), static_cast<int>(entries_.size()), false, 0, 0});
    columns_.push_back({0, static_cast<int>(terms_.size()), {}, 0});
    for (int b = 0; b < of.n_bodies(); ++b) {
        const Body& body = of.model->bodies()[b];
        const Matrix34 F = weight(body, of.model->gravity());
        for (int c = 0; c < 4; ++c) {
            const Vector3 f = F.column(c);
            if (f != Vector3{}) weights_.push_back({12 * b + 3 * c, {f[0], f[1], f[2]}, norm(f)});
            for (int q = 0; q < 4; ++q)
                if (body.mass(q, c) != 0 && !body.holds_states())
                    mass_.push_back({12 * b + 3 * q, body.mass(q, c)});
            first_mass_.push_back(static_cast<int>(mass_.size()));
        }
        if (!body.is_point) rigid_.push_back(12 * b);
    }
    view_ = {.n_numbers = 12 * of.n_bodies(),
             .n_rows = of.n_rows(),
             .n_weights = static_cast<int>(weights_.size()),
             .n_rigid = static_cast<int>(rigid_.size()),
             .length = of.length,
             .rows = rows_.data(),
             .columns = columns_.data(),
             .terms = terms_.data(),
             .entries = entries_.data(),
             .weights = weights_.data(),
             .mass = mass_.data(),
             .first_mass = first_mass_.data(),
             .rigid = rigid_.data()};
}

}   // namespace livens::inline diagnostics_internal
