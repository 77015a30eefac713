// SPDX-License-Identifier: BSD-3-Clause
#include "livens/dynamics/lanes/row_pattern.h"

#include <algorithm>
#include <utility>

#include "livens/dynamics/lanes/elimination_order.h"

namespace livens {

/// A linear function of the numbers of a configuration.
struct RowPattern::Sum {
    double constant = 0;
    std::vector<lanes::Term> terms{};   // few: a search is all that is needed

    void clear(double with)
    {
        constant = with;
        terms.clear();
    }
    void add(int number, double factor)
    {
        if (factor == 0) return;
        for (lanes::Term& term : terms)
            if (term.number == number) return void(term.factor += factor);
        terms.push_back({number, factor});
    }
};

void RowPattern::SumTable::add(double constant, std::span<const lanes::Term> sum)
{
    const auto first = std::ssize(terms);
    for (const lanes::Term& term : sum)
        if (term.factor != 0) terms.push_back(term);
    std::sort(terms.begin() + first, terms.end(),
              [](const lanes::Term& a, const lanes::Term& b) { return a.number < b.number; });
    begin.push_back(static_cast<int>(terms.size()));
    constants.push_back(constant);
}

/// 1/2 sum K_pq x_p . x_q + sum B_p . x_p + c over the columns p of both sides, four a side, the first of
/// them the centre of mass.
struct RowPattern::Form {
    static constexpr int size = 8;
    double K[size][size] = {}, B[size][3] = {}, c = 0;
    int place[size] = {};                      // of each column among the numbers
    bool has_B[size] = {}, has_K[size] = {};   // a joint's row knows few columns
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
                if (shift == 0) continue;
                for (int i = 0; i < 3; ++i) B[side + 1 + a][i] -= shift * B[side][i];
                for (int q = 0; q < n; ++q) K[side + 1 + a][q] -= shift * K[side][q];
                for (int q = 0; q < n; ++q) K[q][side + 1 + a] -= shift * K[q][side];
            }
        }
        for (int p = 0; p < n; ++p) {
            has_B[p] = B[p][0] != 0 || B[p][1] != 0 || B[p][2] != 0;
            has_K[p] = std::any_of(K[p], K[p] + n, [](double k) { return k != 0; });
        }
    }
    bool are_directors_of_one(int p, int q) const { return p / 4 == q / 4 && p % 4 != 0 && q % 4 != 0; }
};

namespace {

/// Of rows that follow each other, those of one joint.
std::vector<std::vector<int>> groups_of(const Tables& tables, const std::vector<int>& rows)
{
    std::vector<std::vector<int>> groups;
    for (int first = 0, last = 0; first < std::ssize(rows); first = last) {
        const int joint = tables.model->row_joint(rows[first]);
        while (last < std::ssize(rows) && tables.model->row_joint(rows[last]) == joint) ++last;
        for (int left = last - first; left > 0;) {
            const int n = left == 4 ? 2 : left == 6 ? 3 : std::min(left, lanes::Group::most);
            groups.emplace_back();
            for (int r = last - left; n > std::ssize(groups.back()); ++r) groups.back().push_back(r);
            left -= n;
        }
    }
    return groups;
}

}   // namespace

RowPattern::RowPattern(const Tables& tables, const std::vector<int>& rows) : chosen_(rows)
{
    for (int b = 0; b < tables.n_bodies(); ++b) add_body(tables, b);
    RowTable table;
    Sum room;
    for (const int row : rows) add_row(tables, row, table, room);
    std::vector<bool> varies(tables.n_twists, false);   // some entry by this twist
    for (int e = 0; e < std::ssize(table.twist); ++e)
        if (!table.entries.is_constant(e)) varies[table.twist[e]] = true;
    const Graph groups = groups_of(tables, rows);
    Graph twists(groups.size()), arranged;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        for (const int r : groups[g])
            twists[g].insert(twists[g].end(), table.twist.begin() + table.begin[r],
                             table.twist.begin() + table.begin[r + 1]);
        std::ranges::sort(twists[g]);
        twists[g].erase(std::unique(twists[g].begin(), twists[g].end()), twists[g].end());
    }
    std::vector<int> sizes;
    for (const std::vector<int>& group : groups) sizes.push_back(static_cast<int>(group.size()));
    const std::vector<int> order = order_of_least_degree(twists, tables.n_twists, sizes);
    arrange(groups, order, table, varies);
    for (const int g : order) arranged.push_back(std::move(twists[g]));
    add_factor(arranged, tables.n_twists);
    view_ = {tables.n_bodies(),
             tables.n_twists,
             static_cast<int>(products_.size()),
             static_cast<int>(rows_.size()),
             static_cast<int>(order.size()),
             static_cast<int>(entries_.constants.size()),
             bodies_.data(),
             products_.data(),
             groups_.data(),
             unit_begin_.data(),
             units_.data(),
             columns_.data(),
             blocks_.data(),
             pairs_.data(),
             block_products_.data(),
             constants_.data(),
             entries_.view(),
             violations_.view()};
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
        Matrix3 E{};
        std::copy_n(table.euler, 9, E.a);
        const Matrix3 still = -determinant(spin) * (transpose(L) * E);   // of norm one but for rounding
        if (norm(still) < 2) std::copy_n(still.a, 9, body.still);
    }
    bodies_.push_back(body);
}

/// The number of the inner product of two columns.
int RowPattern::product(int x, int y)
{
    if (x > y) std::swap(x, y);
    // one of those that the last rows have, or new
    const auto recent = products_.rbegin() + std::min<std::ptrdiff_t>(32, std::ssize(products_));
    const auto found = std::find_if(products_.rbegin(), recent,
                                    [=](const lanes::Columns& of) { return of.x == x && of.y == y; });
    if (found == recent) {
        products_.push_back({x, y});
        return first_product() + static_cast<int>(products_.size()) - 1;
    }
    return first_product() + static_cast<int>(products_.rend() - found) - 1;
}

void RowPattern::add_row(const Tables& tables, int row, RowTable& table, Sum& room)
{
    const Form form(tables, tables.rows[row]);
    for (int side = 0; side < form.n; side += 4) add_gradient(form, side, table, room);
    table.begin.push_back(static_cast<int>(table.twist.size()));
    add_violation(form, table, room);
}

/// sum += factor * d_at . g_p, the gradient by column p being g_p = sum_q K_pq x_q + B_p.
void RowPattern::add_moment(const Form& form, int at, int p, double factor, Sum& sum)
{
    for (int i = 0; form.has_B[p] && i < 3; ++i) sum.add(form.place[at] + i, factor * form.B[p][i]);
    for (int q = 0; form.has_K[p] && q < form.n; ++q) {
        if (form.K[p][q] == 0) continue;
        if (form.are_directors_of_one(at, q))
            sum.constant += at == q ? factor * form.K[p][q] : 0;
        else
            sum.add(product(form.place[at], form.place[q]), factor * form.K[p][q]);
    }
}

/// A side's gradient by scaled twists: g_0 / sqrt(M), and L^-1 t with the torque in body axes
/// t_a = d_c . g_b - d_b . g_c.
void RowPattern::add_gradient(const Form& form, int side, RowTable& table, Sum& sum)
{
    const auto add_entry = [&](int twist) {
        const bool has_terms =
            std::ranges::any_of(sum.terms, [](const auto& term) { return term.factor != 0; });
        if (!has_terms && sum.constant == 0) return;
        table.entries.add(sum.constant, sum.terms);
        table.twist.push_back(twist);
    };
    const lanes::Body& body = bodies_[form.place[side] / 12];
    for (int i = 0; i < 3; ++i) {
        sum.clear(body.inverse_root_mass * form.B[side][i]);
        for (int q = 0; form.has_K[side] && q < form.n; ++q)
            sum.add(form.place[q] + i, body.inverse_root_mass * form.K[side][q]);
        add_entry(body.first + i);
    }
    for (int a = 0; body.dofs == 6 && a < 3; ++a) {
        sum.clear(0);
        for (int e = 0; e < 3; ++e) {
            const int b = side + 1 + (e + 1) % 3, c = side + 1 + (e + 2) % 3;
            const double s = body.spin[3 * a + e];
            if (s == 0) continue;
            add_moment(form, c, b, s, sum);
            add_moment(form, b, c, -s, sum);
        }
        add_entry(body.first + 3 + a);
    }
}

void RowPattern::add_violation(const Form& form, RowTable& table, Sum& phi)
{
    phi.clear(form.c);
    for (int p = 0; p < form.n; ++p) {
        for (int i = 0; form.has_B[p] && i < 3; ++i) phi.add(form.place[p] + i, form.B[p][i]);
        for (int q = 0; form.has_K[p] && q <= p; ++q) {
            const double k = p == q ? 0.5 * form.K[p][q] : form.K[p][q];
            if (k == 0) continue;
            if (form.are_directors_of_one(p, q))
                phi.constant += p == q ? k : 0;
            else
                phi.add(product(form.place[p], form.place[q]), k);
        }
    }
    table.violations.add(phi.constant, phi.terms);
}

/// Groups in this order, a column for each twist that varies; products are numbered as they then come.
void RowPattern::arrange(const Graph& groups, const std::vector<int>& order, const RowTable& table,
                         const std::vector<bool>& varies)
{
    const std::vector<lanes::Columns> products = std::exchange(products_, {});
    std::vector<int> number(products.size(), -1), twists;
    std::vector<lanes::Term> sum;
    const auto move = [&](const SumTable& from, int i, SumTable& to) {
        sum.assign(from.terms.begin() + from.begin[i], from.terms.begin() + from.begin[i + 1]);
        for (lanes::Term& term : sum) {
            if (term.number < first_product()) continue;
            const auto m = static_cast<std::size_t>(term.number - first_product());
            if (number[m] < 0) {
                number[m] = first_product() + static_cast<int>(products_.size());
                products_.push_back(products[m]);
            }
            term.number = number[m];
        }
        to.add(from.constants[i], sum);
    };
    for (const int g : order) {
        groups_.push_back({static_cast<int>(rows_.size()), static_cast<int>(groups[g].size()),
                           static_cast<int>(columns_.size()), 0, 0});
        twists.clear();
        for (const int r : groups[g]) {
            rows_.push_back(chosen_[r]);
            for (int e = table.begin[r]; e < table.begin[r + 1]; ++e)
                if (varies[table.twist[e]])
                    twists.push_back(table.twist[e]);
                else
                    units_.push_back({table.entries.constants[e], table.twist[e]});
            unit_begin_.push_back(static_cast<int>(units_.size()));
            move(table.violations, r, violations_);
        }
        std::ranges::sort(twists);
        twists.erase(std::unique(twists.begin(), twists.end()), twists.end());
        for (const int twist : twists) {
            columns_.push_back({twist, static_cast<int>(entries_.constants.size())});
            for (const int r : groups[g]) {
                const auto first = table.twist.begin() + table.begin[r];
                const auto last = table.twist.begin() + table.begin[r + 1];
                const auto found = std::find(first, last, twist);
                if (found == last)
                    entries_.add(0, {});
                else
                    move(table.entries, static_cast<int>(found - table.twist.begin()), entries_);
            }
        }
    }
    groups_.push_back({static_cast<int>(rows_.size()), 0, static_cast<int>(columns_.size()), 0, 0});
}

/// Group by group. It has blocks at the groups on the ways from those that share a twist with it up the tree
/// of elimination, in which the parent of a group is the first that has a block there.
void RowPattern::add_factor(const Graph& twists, int n_twists)
{
    const int n = static_cast<int>(twists.size());
    Graph groups_at(n_twists);
    std::vector<int> parent(n, n), seen(n, -1), before;
    for (int i = 0; i < n; ++i) {
        before.clear();
        seen[i] = i;
        for (const int twist : twists[i]) {
            for (int j : groups_at[twist])
                for (; std::exchange(seen[j], i) != i; j = parent[j]) {
                    before.push_back(j);
                    parent[j] = std::min(parent[j], i);
                }
            groups_at[twist].push_back(i);
        }
        std::ranges::sort(before);
        groups_[i].blocks = static_cast<int>(blocks_.size());
        for (const int j : before) add_block(groups_[i], j);
        groups_[i].diagonal = n_factor();
        constants_.resize(constants_.size() +
                          static_cast<std::size_t>(groups_[i].n * (groups_[i].n + 1) / 2));
        add_constants(groups_[i], groups_[i], [&](int r, int c) {
            return c <= r ? &constants_[groups_[i].diagonal + r * (r + 1) / 2 + c] : nullptr;
        });
    }
    groups_[n].blocks = static_cast<int>(blocks_.size());
    blocks_.push_back(
        {0, 0, 0, 0, static_cast<int>(pairs_.size()), static_cast<int>(block_products_.size())});
}

void RowPattern::add_block(const lanes::Group& group, int j)
{
    const lanes::Group &before = groups_[j], &behind_before = groups_[j + 1];
    const lanes::Block block{before.first,
                             before.n,
                             before.diagonal,
                             n_factor(),
                             static_cast<int>(pairs_.size()),
                             static_cast<int>(block_products_.size())};
    constants_.resize(constants_.size() + static_cast<std::size_t>(group.n * before.n));
    add_constants(group, before, [&](int r, int c) { return &constants_[block.entry + c * group.n + r]; });
    const lanes::Group& behind = (&group)[1];
    for (int a = group.columns, b = before.columns; a < behind.columns && b < behind_before.columns;) {
        const int k = columns_[a].twist, l = columns_[b].twist;
        if (k == l) pairs_.push_back({columns_[a].entry, columns_[b].entry});
        a += k <= l ? 1 : 0;
        b += l <= k ? 1 : 0;
    }
    for (int a = group.blocks, b = before.blocks; a < std::ssize(blocks_) && b < behind_before.blocks;) {
        const int k = blocks_[a].first, l = blocks_[b].first;
        if (k == l) block_products_.push_back({blocks_[a].entry, blocks_[b].entry, blocks_[a].n});
        a += k <= l ? 1 : 0;
        b += l <= k ? 1 : 0;
    }
    blocks_.push_back(block);
}

/// Products of units of the rows r and c of two groups: what their entry of the factor always has.
template <class Place>
void RowPattern::add_constants(const lanes::Group& group, const lanes::Group& before, const Place& place)
{
    for (int r = 0; r < group.n; ++r)
        for (int c = 0; c < before.n; ++c) {
            double* const sum = place(r, c);
            for (int a = unit_begin_[group.first + r]; sum != nullptr && a < unit_begin_[group.first + r + 1];
                 ++a)
                for (int b = unit_begin_[before.first + c]; b < unit_begin_[before.first + c + 1]; ++b)
                    if (units_[a].twist == units_[b].twist) *sum += units_[a].value * units_[b].value;
        }
}

}   // namespace livens
