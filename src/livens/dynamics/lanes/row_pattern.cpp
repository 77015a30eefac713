// SPDX-License-Identifier: BSD-3-Clause
#include "livens/dynamics/lanes/row_pattern.h"

#include <algorithm>
#include <utility>

#include "livens/dynamics/lanes/elimination_order.h"
#include "livens/dynamics/lanes/row_sums.h"
#include "livens/multibody/model.h"

namespace livens {

namespace {

using Graph = std::vector<std::vector<int>>;

/// Of rows that follow each other, those of one joint.
/// At most five at a time; four are two and two, six three and three (docs/theory.md, "Without a tangent",
/// Elimination).
std::vector<std::vector<int>> groups_of(const ModelTables& tables, const std::vector<int>& rows)
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

/// Sums go over with products numbered as they come.
struct NumberedProducts {
    const RowSums& sums;
    std::vector<lanes::Columns>& products;
    std::vector<int> number;   // of those of `sums`
    std::vector<lanes::Term> sum;

    void move(const SumTable& from, int i, SumTable& to)
    {
        const int first = sums.first_product();
        sum.assign(from.terms.begin() + from.begin[i], from.terms.begin() + from.begin[i + 1]);
        for (lanes::Term& term : sum) {
            if (term.number < first) continue;
            const auto m = static_cast<std::size_t>(term.number - first);
            if (number[m] < 0) {
                number[m] = first + static_cast<int>(products.size());
                products.push_back(sums.products[m]);
            }
            term.number = number[m];
        }
        to.add(from.constants[i], sum);
    }
};

void sort_unique(std::vector<int>& numbers)
{
    std::ranges::sort(numbers);
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

}   // namespace

RowPattern::RowPattern(const ModelTables& tables, const std::vector<int>& rows) : chosen_(rows)
{
    RowSums sums(tables, rows);
    const Graph groups = groups_of(tables, rows);
    Graph twists(groups.size()), arranged;
    std::vector<int> sizes;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        for (const int r : groups[g])
            twists[g].insert(twists[g].end(), sums.twist.begin() + sums.begin[r],
                             sums.twist.begin() + sums.begin[r + 1]);
        sort_unique(twists[g]);
        sizes.push_back(static_cast<int>(groups[g].size()));
    }
    const std::vector<int> order = order_of_least_degree(twists, tables.n_twists, sizes);
    arrange(sums, groups, order, tables.n_twists);
    bodies_ = std::move(sums.bodies);
    std::vector<int> at(static_cast<std::size_t>(tables.n_rows()));
    for (std::size_t i = 0; i < rows_.size(); ++i) at[rows_[i]] = static_cast<int>(i);
    for (const int row : chosen_) places_.push_back(at[row]);
    std::vector<std::int32_t> of_forms;
    for (const int r : sums.with_forms) of_forms.push_back(places_[static_cast<std::size_t>(r)]);
    forms_ = std::move(sums.forms);
    forms_.place(std::move(of_forms));
    for (const int g : order) arranged.push_back(std::move(twists[g]));
    factor_.add(arranged, tables.n_twists, groups_);
    view_ = {.n_bodies = tables.n_bodies(),
             .n_twists = tables.n_twists,
             .n_products = static_cast<int>(products_.size()),
             .n_rows = static_cast<int>(rows_.size()),
             .n_groups = static_cast<int>(order.size()),
             .n_entries = static_cast<int>(gradients_.entries.constants.size()),
             .bodies = bodies_.data(),
             .products = products_.data(),
             .groups = groups_.data(),
             .gradients = gradients_.view(),
             .factor = factor_.view(),
             .violations = violations_.view(),
             .forms = {.n_forms = forms_.n_forms(),
                       .n_rows = forms_.n_rows(),
                       .n_entries = static_cast<int>(weighted_.size()),
                       .values = form_values_.view(),
                       .entries = weighted_.data(),
                       .gradients = form_gradients_.view(),
                       .rows = forms_.places(),
                       .weigh = RowForms::weigh,
                       .caller = &forms_}};
}

/// Groups in this order, a column for each twist that varies; products are numbered as they then come.
void RowPattern::arrange(const RowSums& sums, const Graph& groups, const std::vector<int>& order,
                         int n_twists)
{
    std::vector<bool> varies(n_twists, false);   // some entry by this twist
    for (int e = 0; e < std::ssize(sums.twist); ++e)
        if (!sums.entries.is_constant(e)) varies[sums.twist[e]] = true;
    for (const lanes::WeightedEntry& of : sums.weighted) varies[sums.twist[of.entry]] = true;
    std::vector<int> moved(sums.twist.size(), -1);   // entries
    std::vector<int> twists;
    NumberedProducts numbered{sums, products_, std::vector<int>(sums.products.size(), -1), {}};
    for (const int g : order) {
        groups_.push_back({static_cast<int>(rows_.size()), static_cast<int>(groups[g].size()),
                           static_cast<int>(gradients_.columns.size()), 0, 0});
        twists.clear();
        for (const int r : groups[g]) {
            rows_.push_back(chosen_[r]);
            for (int e = sums.begin[r]; e < sums.begin[r + 1]; ++e)
                if (varies[sums.twist[e]])
                    twists.push_back(sums.twist[e]);
                else
                    gradients_.units.push_back({sums.entries.constants[e], sums.twist[e]});
            gradients_.unit_begin.push_back(static_cast<int>(gradients_.units.size()));
            numbered.move(sums.violations, r, violations_);
        }
        sort_unique(twists);
        for (const int twist : twists) {
            gradients_.columns.push_back({twist, static_cast<int>(gradients_.entries.constants.size())});
            for (const int r : groups[g]) {
                const auto first = sums.twist.begin() + sums.begin[r];
                const auto last = sums.twist.begin() + sums.begin[r + 1];
                const auto found = std::find(first, last, twist);
                if (found == last)
                    gradients_.entries.add(0, {});
                else {
                    const auto e = found - sums.twist.begin();
                    moved[static_cast<std::size_t>(e)] =
                        static_cast<int>(gradients_.entries.constants.size());
                    numbered.move(sums.entries, static_cast<int>(e), gradients_.entries);
                }
            }
        }
    }
    for (std::size_t i = 0; i < sums.weighted.size(); ++i) {
        weighted_.push_back(sums.weighted[i]);
        weighted_.back().entry = moved[static_cast<std::size_t>(sums.weighted[i].entry)];
        numbered.move(sums.form_gradients, static_cast<int>(i), form_gradients_);
    }
    for (int k = 0; k < sums.forms.n_forms(); ++k) numbered.move(sums.form_values, k, form_values_);
    groups_.push_back({static_cast<int>(rows_.size()), 0, static_cast<int>(gradients_.columns.size()), 0, 0});
}

/// Group by group. It has blocks at the groups on the ways from those that share a twist with it up the tree
/// of elimination, in which the parent of a group is the first that has a block there.
void FactorTables::add(const Graph& twists, int n_twists, std::vector<lanes::Group>& groups)
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
        groups[i].blocks = static_cast<int>(blocks_.size());
        for (const int j : before) add_block(groups[i], groups[j]);
        groups[i].diagonal = size();
        constants_.resize(constants_.size() + static_cast<std::size_t>(groups[i].n * (groups[i].n + 1) / 2));
        add_constants(groups[i], groups[i], [&](int r, int c) {
            return c <= r ? &constants_[groups[i].diagonal + r * (r + 1) / 2 + c] : nullptr;
        });
    }
    groups[n].blocks = static_cast<int>(blocks_.size());
    blocks_.push_back({0, 0, 0, 0, static_cast<int>(pairs_.size()), static_cast<int>(products_.size())});
}

/// Twists of both groups, and groups before both, by one pass each over two ascending lists.
void FactorTables::add_block(const lanes::Group& group, const lanes::Group& before)
{
    const lanes::Group &behind = (&group)[1], &behind_before = (&before)[1];
    const std::vector<lanes::Column>& columns = gradients_.columns;
    const lanes::Block block{before.first,
                             before.n,
                             before.diagonal,
                             size(),
                             static_cast<int>(pairs_.size()),
                             static_cast<int>(products_.size())};
    constants_.resize(constants_.size() + static_cast<std::size_t>(group.n * before.n));
    add_constants(group, before, [&](int r, int c) { return &constants_[block.entry + c * group.n + r]; });
    for (int a = group.columns, b = before.columns; a < behind.columns && b < behind_before.columns;) {
        const int k = columns[a].twist, l = columns[b].twist;
        if (k == l) pairs_.push_back({columns[a].entry, columns[b].entry});
        a += k <= l ? 1 : 0;
        b += l <= k ? 1 : 0;
    }
    for (int a = group.blocks, b = before.blocks; a < std::ssize(blocks_) && b < behind_before.blocks;) {
        const int k = blocks_[a].first, l = blocks_[b].first;
        if (k == l) products_.push_back({blocks_[a].entry, blocks_[b].entry, blocks_[a].n});
        a += k <= l ? 1 : 0;
        b += l <= k ? 1 : 0;
    }
    blocks_.push_back(block);
}

/// Products of units of the rows r and c of two groups: what their entry of the factor always has.
template <class Place>
void FactorTables::add_constants(const lanes::Group& group, const lanes::Group& before, const Place& place)
{
    const std::vector<std::int32_t>& begin = gradients_.unit_begin;
    const std::vector<lanes::Unit>& units = gradients_.units;
    for (int r = 0; r < group.n; ++r)
        for (int c = 0; c < before.n; ++c) {
            double* const sum = place(r, c);
            for (int a = begin[group.first + r]; sum != nullptr && a < begin[group.first + r + 1]; ++a)
                for (int b = begin[before.first + c]; b < begin[before.first + c + 1]; ++b)
                    if (units[a].twist == units[b].twist) *sum += units[a].value * units[b].value;
        }
}

}   // namespace livens
