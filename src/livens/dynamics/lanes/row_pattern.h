// SPDX-License-Identifier: BSD-3-Clause
// What is known of a mechanism and its constraint rows before the numbers: the tables of lanes.h.
#pragma once

#include <span>
#include <vector>

#include "livens/dynamics/lanes/lanes.h"
#include "livens/dynamics/rows/tables.h"

namespace livens {

/// Gradients and violations of the chosen rows as sums over numbers of the configuration, and the factor of
/// G G^T. The rows of a joint are a group, dense in itself; groups are eliminated in an order of least
/// degree, so that trees have no fill and loops little.
class RowPattern {
public:
    /// `rows`: of the tables; all quadratic.
    RowPattern(const Tables& tables, const std::vector<int>& rows);

    const lanes::Pattern& view() const { return view_; }
    /// The rows as they were given.
    const std::vector<int>& chosen() const { return chosen_; }
    /// Row of the tables at each place of the elimination.
    const std::vector<int>& rows() const { return rows_; }
    int n_factor() const { return static_cast<int>(constants_.size()); }
    int n_numbers() const { return view_.n_bodies * 12 + view_.n_products; }

private:
    struct Form;   // a row in the columns of the kernel
    struct Sum;
    struct SumTable {
        std::vector<std::int32_t> begin{0};
        std::vector<lanes::Term> terms;
        std::vector<double> constants;
        void add(double constant, std::span<const lanes::Term> sum);
        bool is_constant(int i) const { return begin[i] == begin[i + 1]; }
        lanes::Sums view() const { return {begin.data(), terms.data(), constants.data()}; }
    };
    /// Rows as they were given: entries of their gradients, with the twist of each, and violations.
    struct RowTable {
        std::vector<std::int32_t> begin{0}, twist;
        SumTable entries, violations;
    };
    using Graph = std::vector<std::vector<int>>;

    void add_body(const Tables& tables, int body);
    int first_product() const { return 12 * static_cast<int>(bodies_.size()); }
    int product(int x, int y);
    void add_row(const Tables& tables, int row, RowTable& table, Sum& room);
    void add_moment(const Form& form, int at, int p, double factor, Sum& sum);
    void add_gradient(const Form& form, int side, RowTable& table, Sum& sum);
    void add_violation(const Form& form, RowTable& table, Sum& phi);
    void arrange(const Graph& groups, const std::vector<int>& order, const RowTable& table,
                 const std::vector<bool>& varies);
    void add_factor(const Graph& twists, int n_twists);
    void add_block(const lanes::Group& group, int before);
    template <class Place>
    void add_constants(const lanes::Group& group, const lanes::Group& before, const Place& place);

    std::vector<lanes::Body> bodies_;
    std::vector<lanes::Columns> products_;
    std::vector<lanes::Group> groups_;
    std::vector<std::int32_t> unit_begin_{0};
    std::vector<lanes::Unit> units_;
    std::vector<lanes::Column> columns_;
    std::vector<lanes::Block> blocks_;
    std::vector<lanes::Pair> pairs_;
    std::vector<lanes::Product> block_products_;
    std::vector<double> constants_;
    SumTable entries_, violations_;
    std::vector<int> chosen_, rows_;
    lanes::Pattern view_{};
};

}   // namespace livens
