// SPDX-License-Identifier: BSD-3-Clause
// A model as lists of numbers, for points of a motion that are looked at side by side.
#pragma once

#include <vector>

#include "livens/diagnostics/detail/point_kernels.h"
#include "livens/dynamics/rows/tables.h"

namespace livens::inline diagnostics_internal {

/// What PointLists points to.
class PointTables {
public:
    explicit PointTables(const ModelTables& tables);
    PointTables(const PointTables&) = delete;
    PointTables& operator=(const PointTables&) = delete;

    const PointLists& view() const { return view_; }
    /// Rows that are no quadratic forms.
    const std::vector<int>& others() const { return others_; }

private:
    void add_row(const RowTable& row);

    std::vector<PointRow> rows_;
    std::vector<PointColumn> columns_;
    std::vector<PointTerm> terms_, entries_, mass_;
    std::vector<PointWeight> weights_;
    std::vector<int> others_, first_mass_{0}, rigid_;
    PointLists view_{};
};

}   // namespace livens::inline diagnostics_internal
