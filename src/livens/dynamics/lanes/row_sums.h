// SPDX-License-Identifier: BSD-3-Clause
// Constraint rows as sums over the numbers of a configuration.
#pragma once

#include <cstdint>
#include <vector>

#include "livens/dynamics/lanes/row_forms.h"
#include "livens/dynamics/lanes/row_pattern.h"
#include "livens/dynamics/rows/tables.h"

namespace livens::inline dynamics_internal {

class CentredForm;
struct LinearSum;

/// Gradients and violations of rows, in the order in which they are given. Of what is not one quadratic form
/// the weighted forms stand apart.
class RowSums {
public:
    RowSums(const ModelTables& tables, const std::vector<int>& rows);

    int first_product() const { return 12 * static_cast<int>(bodies.size()); }

    std::vector<lanes::Body> bodies;
    std::vector<lanes::Columns> products;   ///< numbers behind those of the bodies
    std::vector<std::int32_t> begin{0};     ///< of each row among the entries
    std::vector<std::int32_t> twist;        ///< of each entry
    SumTable entries, violations;
    RowForms forms;
    std::vector<int> with_forms;            ///< places among the rows
    SumTable form_values, form_gradients;   ///< of forms, and of weighted entries
    std::vector<lanes::WeightedEntry> weighted;

private:
    void add_body(const ModelTables& tables, int body);
    int product(int x, int y);
    void add_moment(const CentredForm& form, int at, int p, double factor, LinearSum& sum);
    template <class Take>
    void add_gradient(const CentredForm& form, int side, LinearSum& sum, const Take& take);
    void add_value(const CentredForm& form, LinearSum& phi, SumTable& to);
    void add_form(const CentredForm& form, int first_entry, LinearSum& room);
};

}   // namespace livens::inline dynamics_internal
