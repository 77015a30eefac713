// SPDX-License-Identifier: BSD-3-Clause
#include "livens/multibody/row_pattern.h"

#include <algorithm>
#include <map>
#include <set>

namespace livens {

/// A linear function of the numbers of a configuration.
struct RowPattern::Sum {
    double constant = 0;
    std::map<int, double> factors;

    void add(int number, double factor)
    {
        if (factor != 0) factors[number] += factor;
    }
};

void RowPattern::SumTable::add(const Sum& sum)
{
    for (const auto& [number, factor] : sum.factors)
        if (factor != 0) terms.push_back({number, factor});
    begin.push_back(static_cast<int>(terms.size()));
    constants.push_back(sum.constant);
}

/// 1/2 sum K_pq x_p . x_q + sum B_p . x_p + c over the columns p of both sides, four a side, the first of
/// them the centre of mass.
struct RowPattern::Form {
    static constexpr int size = 8;
    double K[size][size] = {}, B[size][3] = {}, c = 0;
    int place[size] = {};   // of each column among the numbers
    int n = 0;

    Form(const Tables& tables, const Tables::RowTable& row) : c(row.row->c), n(4 * row.n_sides)
    {
        for (int p = 0; p < n; ++p) {
            place[p] = 12 * row.bodies[p / 4] + 3 * (p % 4);
            for (int i = 0; i < 3; ++i) B[p][i] = row.B[p / 4](i, p % 4);
            for (int q = 0; q < n; ++q) K[p][q] = row.K[p / 4][q / 4](p % 4, q % 4);
        }
        for (int side = 0; side < n; side += 4) {   // x_0 is the reference point no more
            const double* center = tables.bodies[row.bodies[side / 4]].center;
            for (int a = 0; a < 3; ++a) {
                const double shift = center[a];
                for (int i = 0; i < 3; ++i) B[side + 1 + a][i] -= shift * B[side][i];
                for (int q = 0; q < n; ++q) K[side + 1 + a][q] -= shift * K[side][q];
                for (int q = 0; q < n; ++q) K[q][side + 1 + a] -= shift * K[q][side];
            }
        }
    }
    bool are_directors_of_one(int p, int q) const { return p / 4 == q / 4 && p % 4 != 0 && q % 4 != 0; }
};

RowPattern::RowPattern(const Tables& tables, const std::vector<int>& rows) : chosen_(rows)
{
    for (int b = 0; b < tables.n_bodies(); ++b) add_body(tables, b);
    std::vector<std::vector<int>> twists;
    rows_ = rows;
    for (const int row : rows) {   // once to see which twists each has
        clear_rows();
        add_row(tables, row);
        twists.emplace_back(twist_.begin(), twist_.end());
    }
    order_rows(twists);
    clear_rows();
    for (const int row : rows_) add_row(tables, row);
    add_factor();
    view_ = {tables.n_bodies(),
             tables.n_twists,
             static_cast<int>(products_.size()),
             static_cast<int>(rows_.size()),
             static_cast<int>(twist_.size()),
             bodies_.data(),
             products_.data(),
             row_begin_.data(),
             twist_.data(),
             entries_.view(),
             violations_.view(),
             factor_.view()};
}

void RowPattern::clear_rows()
{
    row_begin_.assign(1, 0);
    twist_.clear();
    products_.clear();
    entries_ = violations_ = {};
}

void RowPattern::add_body(const Tables& tables, int b)
{
    const Tables::BodyTable& table = tables.bodies[b];
    lanes::Body body;
    body.first = table.first;
    body.dofs = table.dofs;
    body.principal = table.principal;
    for (const Load& load : tables.model->loads())
        body.loaded = body.loaded || std::ranges::find(load.bodies, b) != load.bodies.end();
    body.inverse_root_mass = table.inverse_root_mass;
    body.root_mass = 1 / table.inverse_root_mass;
    for (int i = 0; i < 3; ++i) body.weight[i] = table.inverse_root_mass * table.weight[i];
    std::copy_n(table.euler, 9, body.euler);
    std::copy_n(table.spin, 9, body.spin);
    if (body.dofs == 6) {
        Matrix3 spin{};
        std::copy_n(table.spin, 9, spin.a);
        const Matrix3 L = transpose(inverse(spin));
        std::copy_n(L.a, 9, body.root_spin);
    }
    bodies_.push_back(body);
}

/// The number of the inner product of two columns.
int RowPattern::product(int x, int y)
{
    if (x > y) std::swap(x, y);
    const auto is_it = [=](const lanes::Columns& of) { return of.x == x && of.y == y; };
    // one of those that the last rows have, or new
    const auto recent = products_.end() - std::min<std::ptrdiff_t>(32, std::ssize(products_));
    auto found = std::find_if(recent, products_.end(), is_it);
    if (found == products_.end()) found = products_.insert(found, {x, y});
    return 12 * static_cast<int>(bodies_.size()) + static_cast<int>(found - products_.begin());
}

void RowPattern::add_row(const Tables& tables, int row)
{
    const Form form(tables, tables.rows[row]);
    for (int side = 0; side < form.n; side += 4) add_gradient(form, side);
    row_begin_.push_back(static_cast<int>(twist_.size()));
    add_violation(form);
}

/// sum += factor * d_at . g_p, the gradient by column p being g_p = sum_q K_pq x_q + B_p.
void RowPattern::add_moment(const Form& form, int at, int p, double factor, Sum& sum)
{
    for (int i = 0; i < 3; ++i) sum.add(form.place[at] + i, factor * form.B[p][i]);
    for (int q = 0; q < form.n; ++q) {
        if (form.K[p][q] == 0) continue;
        if (form.are_directors_of_one(at, q))
            sum.constant += at == q ? factor * form.K[p][q] : 0;
        else
            sum.add(product(form.place[at], form.place[q]), factor * form.K[p][q]);
    }
}

/// A side's gradient by scaled twists: g_0 / sqrt(M), and L^-1 t with the torque in body axes
/// t_a = d_c . g_b - d_b . g_c.
void RowPattern::add_gradient(const Form& form, int side)
{
    const auto add_entry = [this](const Sum& sum, int twist) {
        const bool has_terms = std::any_of(sum.factors.begin(), sum.factors.end(),
                                           [](const auto& term) { return term.second != 0; });
        if (!has_terms && sum.constant == 0) return;
        entries_.add(sum);
        twist_.push_back(twist);
    };
    const lanes::Body& body = bodies_[form.place[side] / 12];
    for (int i = 0; i < 3; ++i) {
        Sum sum{body.inverse_root_mass * form.B[side][i], {}};
        for (int q = 0; q < form.n; ++q) sum.add(form.place[q] + i, body.inverse_root_mass * form.K[side][q]);
        add_entry(sum, body.first + i);
    }
    for (int a = 0; body.dofs == 6 && a < 3; ++a) {
        Sum sum;
        for (int e = 0; e < 3; ++e) {
            const int b = side + 1 + (e + 1) % 3, c = side + 1 + (e + 2) % 3;
            const double s = body.spin[3 * a + e];
            if (s == 0) continue;
            add_moment(form, c, b, s, sum);
            add_moment(form, b, c, -s, sum);
        }
        add_entry(sum, body.first + 3 + a);
    }
}

void RowPattern::add_violation(const Form& form)
{
    Sum phi{form.c, {}};
    for (int p = 0; p < form.n; ++p) {
        for (int i = 0; i < 3; ++i) phi.add(form.place[p] + i, form.B[p][i]);
        for (int q = 0; q <= p; ++q) {
            const double k = p == q ? 0.5 * form.K[p][q] : form.K[p][q];
            if (k == 0) continue;
            if (form.are_directors_of_one(p, q))
                phi.constant += p == q ? k : 0;
            else
                phi.add(product(form.place[p], form.place[q]), k);
        }
    }
    violations_.add(phi);
}

/// An order of least degree on the graph of rows that share a twist; the earlier row where degrees are equal.
void RowPattern::order_rows(const std::vector<std::vector<int>>& twists)
{
    const int n = static_cast<int>(twists.size());
    std::map<int, std::vector<int>> rows_at;
    for (int r = 0; r < n; ++r)
        for (const int twist : twists[r]) rows_at[twist].push_back(r);
    std::vector<std::set<int>> beside(n);
    for (const auto& [twist, rows] : rows_at)
        for (const int r : rows) beside[r].insert(rows.begin(), rows.end());
    std::set<std::pair<std::size_t, int>> waiting;
    for (int r = 0; r < n; ++r) {
        beside[r].erase(r);
        waiting.insert({beside[r].size(), r});
    }
    std::vector<int> order;
    while (!waiting.empty()) {
        const int r = waiting.begin()->second;
        waiting.erase(waiting.begin());
        order.push_back(rows_[r]);
        for (const int s : beside[r]) {
            waiting.erase({beside[s].size(), s});
            beside[s].insert(beside[r].begin(), beside[r].end());
            beside[s].erase(r);
            beside[s].erase(s);
            waiting.insert({beside[s].size(), s});
        }
    }
    rows_ = order;
}

/// Row by row: L_ij = (G_i . G_j - sum_k L_ik L_jk) / L_jj over the columns j < i that rows below share.
void RowPattern::add_factor()
{
    const int n = static_cast<int>(rows_.size());
    std::vector<std::map<int, int>> entries(n);   // of each row: column, place among all
    std::vector<std::vector<int>> below(n);       // rows that have an entry in a column
    std::map<int, std::vector<int>> rows_at;
    const auto pair_gradients = [this](int i, int j, auto&& act) {
        for (int a = row_begin_[i]; a < row_begin_[i + 1]; ++a)
            for (int b = row_begin_[j]; b < row_begin_[j + 1]; ++b)
                if (twist_[a] == twist_[b]) act(a, b);
    };
    for (int i = 0; i < n; ++i) {
        std::set<int> columns{i};
        for (int e = row_begin_[i]; e < row_begin_[i + 1]; ++e) {
            std::vector<int>& others = rows_at[twist_[e]];
            columns.insert(others.begin(), others.end());
            others.push_back(i);
        }
        for (auto j = columns.begin(); j != columns.end(); ++j) {   // grows ahead of j
            for (const int k : below[*j])
                if (k < i) columns.insert(k);
            if (*j == i) break;
        }
        for (const int j : columns) {
            entries[i][j] = static_cast<int>(factor_.entries.size());
            pair_gradients(i, j, [this](int a, int b) { factor_.gradients.push_back({a, b}); });
            for (const auto& [k, at] : entries[j]) {
                const auto other = entries[i].find(k);
                if (k < j && other != entries[i].end()) factor_.products.push_back({other->second, at});
            }
            const int pivot = j == i ? -1 : factor_.begin[j + 1] - 1;
            factor_.entries.push_back({static_cast<int>(factor_.gradients.size()),
                                       static_cast<int>(factor_.products.size()), pivot});
            factor_.column.push_back(j);
            if (j < i) below[j].push_back(i);
        }
        factor_.begin.push_back(static_cast<int>(factor_.entries.size()));
    }
}

}   // namespace livens
