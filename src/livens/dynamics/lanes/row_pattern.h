// SPDX-License-Identifier: BSD-3-Clause
// What is known of a mechanism and its constraint rows before the numbers: the tables of lanes.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "livens/dynamics/lanes/lanes.h"
#include "livens/dynamics/lanes/row_forms.h"

namespace livens::inline dynamics_internal {

class RowSums;
struct ModelTables;

/// What lanes::Sums points to.
struct SumTable {
    std::vector<std::int32_t> begin{0};
    std::vector<lanes::Term> terms;
    std::vector<double> constants;

    void add(double constant, std::span<const lanes::Term> sum);
    bool is_constant(int i) const { return begin[i] == begin[i + 1]; }
    lanes::Sums view() const { return {begin.data(), terms.data(), constants.data()}; }
};

/// What lanes::GradientPattern points to.
struct GradientTables {
    std::vector<std::int32_t> unit_begin{0};
    std::vector<lanes::Unit> units;
    std::vector<lanes::Column> columns;
    SumTable entries;

    lanes::GradientPattern view() const
    {
        return {unit_begin.data(), units.data(), columns.data(), entries.view()};
    }
};

/// What lanes::FactorPattern points to, group by group.
class FactorTables {
public:
    explicit FactorTables(const GradientTables& gradients) : gradients_(gradients) {}

    /// `twists`: of each group, ascending. Sets blocks and diagonals of the groups.
    void add(const std::vector<std::vector<int>>& twists, int n_twists, std::vector<lanes::Group>& groups);
    int size() const { return static_cast<int>(constants_.size()); }
    lanes::FactorPattern view() const
    {
        return {blocks_.data(), pairs_.data(), products_.data(), constants_.data()};
    }

private:
    void add_block(const lanes::Group& group, const lanes::Group& before);
    template <class Place>
    void add_constants(const lanes::Group& group, const lanes::Group& before, const Place& place);

    const GradientTables& gradients_;
    std::vector<lanes::Block> blocks_;
    std::vector<lanes::Pair> pairs_;
    std::vector<lanes::Product> products_;
    std::vector<double> constants_;
};

/// Gradients and violations of the chosen rows as sums over numbers of the configuration, and the factor of
/// G G^T. The rows of a joint are a group, dense in itself; groups are eliminated in an order of least
/// degree, so that trees have no fill and loops little.
class RowPattern {
public:
    /// `rows`: of the tables.
    RowPattern(const ModelTables& tables, const std::vector<int>& rows);
    RowPattern(const RowPattern&) = delete;
    RowPattern& operator=(const RowPattern&) = delete;

    const lanes::Pattern& view() const { return view_; }
    /// The rows as they were given.
    const std::vector<int>& chosen() const { return chosen_; }
    /// Row of the tables at each place of the elimination.
    const std::vector<int>& rows() const { return rows_; }
    /// The place of each row as they were given.
    const std::vector<int>& places() const { return places_; }
    int n_factor() const { return factor_.size(); }
    int n_numbers() const { return view_.n_bodies * 12 + view_.n_products; }
    const RowForms& forms() const { return forms_; }

private:
    void arrange(const RowSums& sums, const std::vector<std::vector<int>>& groups,
                 const std::vector<int>& order, int n_twists);

    std::vector<lanes::Body> bodies_;
    std::vector<lanes::Columns> products_;
    std::vector<lanes::Group> groups_;
    GradientTables gradients_;
    FactorTables factor_{gradients_};
    SumTable violations_, form_values_, form_gradients_;
    RowForms forms_;
    std::vector<lanes::WeightedEntry> weighted_;
    std::vector<int> chosen_, rows_, places_;
    lanes::Pattern view_{};
};

}   // namespace livens::inline dynamics_internal
