// SPDX-License-Identifier: BSD-3-Clause
// Constraint rows as sums over the numbers of a configuration.
#pragma once

#include <cstdint>
#include <vector>

#include "livens/dynamics/lanes/row_pattern.h"
#include "livens/dynamics/rows/tables.h"

namespace livens::inline dynamics_internal {

class CentredForm;
struct LinearSum;

/// Gradients and violations of rows, in the order in which they are given; all quadratic.
class RowSums {
public:
    RowSums(const ModelTables& tables, const std::vector<int>& rows);

    int first_product() const { return 12 * static_cast<int>(bodies.size()); }

    std::vector<lanes::Body> bodies;
    std::vector<lanes::Columns> products;   ///< numbers behind those of the bodies
    std::vector<std::int32_t> begin{0};     ///< of each row among the entries
    std::vector<std::int32_t> twist;        ///< of each entry
    SumTable entries, violations;

private:
    void add_body(const ModelTables& tables, int body);
    int product(int x, int y);
    void add_moment(const CentredForm& form, int at, int p, double factor, LinearSum& sum);
    void add_gradient(const CentredForm& form, int side, LinearSum& sum);
    void add_violation(const CentredForm& form, LinearSum& phi);
};

}   // namespace livens::inline dynamics_internal
