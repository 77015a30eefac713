// SPDX-License-Identifier: BSD-3-Clause
// What is known of a mechanism and its constraint rows before the numbers: the tables of lanes.h.
#pragma once

#include <vector>

#include "livens/multibody/lanes.h"
#include "livens/multibody/tables.h"

namespace livens {

/// Gradients and violations of the chosen rows as sums over numbers of the configuration, and the factor of
/// G G^T. Rows are eliminated in an order of least degree, so that trees have no fill and loops little.
class RowPattern {
public:
    /// `rows`: of the tables; all quadratic.
    RowPattern(const Tables& tables, const std::vector<int>& rows);

    const lanes::Pattern& view() const { return view_; }
    /// The rows as they were given.
    const std::vector<int>& chosen() const { return chosen_; }
    /// Row of the tables at each place of the elimination.
    const std::vector<int>& rows() const { return rows_; }
    int n_factor() const { return static_cast<int>(factor_.entries.size()); }
    int n_numbers() const { return view_.n_bodies * 12 + view_.n_products; }

private:
    struct Form;   // a row in the columns of the kernel
    struct Sum;
    struct SumTable {
        std::vector<std::int32_t> begin{0};
        std::vector<lanes::Term> terms;
        std::vector<double> constants;
        void add(const Sum& sum);
        lanes::Sums view() const { return {begin.data(), terms.data(), constants.data()}; }
    };
    struct TriangleTable {
        std::vector<std::int32_t> begin{0}, column;
        std::vector<lanes::Entry> entries;
        std::vector<lanes::Pair> gradients, products;
        lanes::Triangle view() const
        {
            return {begin.data(), column.data(), entries.data(), gradients.data(), products.data()};
        }
    };

    void add_body(const Tables& tables, int body);
    int product(int x, int y);
    void add_row(const Tables& tables, int row);
    void add_moment(const Form& form, int at, int p, double factor, Sum& sum);
    void add_gradient(const Form& form, int side);
    void add_violation(const Form& form);
    void clear_rows();
    void order_rows(const std::vector<std::vector<int>>& twists);
    void add_factor();

    std::vector<lanes::Body> bodies_;
    std::vector<lanes::Columns> products_;
    std::vector<std::int32_t> row_begin_, twist_;
    SumTable entries_, violations_;
    TriangleTable factor_;
    std::vector<int> chosen_, rows_;
    lanes::Pattern view_{};
};

}   // namespace livens
