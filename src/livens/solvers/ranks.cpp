// SPDX-License-Identifier: BSD-3-Clause
// What ranks do together, made of messages from one to another; and the chain that the first of them solves.
#include "livens/solvers/ranks.h"

#include <algorithm>
#include <cmath>

#include "livens/solvers/sparse.h"
#include "livens/solvers/staircase.h"

namespace livens {

void Ranks::send(int to, std::span<const double> values)
{
    ++traffic_.messages;
    traffic_.bytes += static_cast<long long>(values.size_bytes());
    put(to, values);
}

void Ranks::receive_from_before(std::span<double> values)
{
    if (!is_first()) receive(rank() - 1, values);
}

void Ranks::pass_on(std::span<const double> values)
{
    if (!is_last()) send(rank() + 1, values);
}

/// Along a binary tree: in each round whoever has the numbers sends them to one more.
void Ranks::broadcast(int from, std::span<double> values)
{
    const int n = size(), place = (rank() - from + n) % n;   // as if it came from the first
    int step = 1;
    while (step < n) step *= 2;
    for (step /= 2; step > 0; step /= 2) {
        if (place % (2 * step) == 0 && place + step < n) send((place + step + from) % n, values);
        if (place % (2 * step) == step) receive((place - step + from) % n, values);
    }
}

/// Along a binary tree to the first rank, which sends the outcome to all: everyone has the same bits.
void Ranks::reduce(std::span<double> values, double (*join)(double, double))
{
    std::vector<double> others(values.size());
    for (int step = 1; step < size(); step *= 2) {
        if (rank() % (2 * step) == step) {
            send(rank() - step, values);
            break;
        }
        if (rank() + step >= size()) continue;
        receive(rank() + step, others);
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = join(values[i], others[i]);
    }
    broadcast(0, values);
}

/// A nan on the left stays, as no comparison with it is true; one on the right is asked for.
void Ranks::largest(std::span<double> values)
{
    reduce(values, [](double a, double b) { return b > a || std::isnan(b) ? b : a; });
}

void Ranks::sum(std::span<double> values)
{
    reduce(values, [](double a, double b) { return a + b; });
}

std::vector<double> Ranks::sum_before(std::span<const double> values)
{
    std::vector<double> before(values.size(), 0.0), next;
    receive_from_before(before);
    next = before;
    for (std::size_t i = 0; i < next.size(); ++i) next[i] += values[i];
    pass_on(next);
    return before;
}

std::unique_ptr<RankChain> Ranks::make_chain() { return std::make_unique<GatheredChain>(*this); }

/// Of the first rank: the matrix, and which of its unknowns each rank wants.
/// It is solved as one stretch along time, and by the general LU where pivots of that are too small.
struct GatheredChain::Whole {
    std::vector<std::vector<int>> columns;
    std::vector<int> n_rows;
    SparseMatrix A;
    StaircaseLU along_time;
    SparseLU general{SparseBackend::eigen};
    bool is_general = false;
    std::vector<double> b, x;

    bool factorise()
    {
        along_time.analyse(A, std::vector<int>{0, A.size});
        is_general = !along_time.factorise(A);
        if (is_general) general.analyse(A);
        return !is_general || general.factorise(A);
    }
    void solve() { is_general ? general.solve(b, x) : along_time.solve(b, x); }
};

GatheredChain::GatheredChain(Ranks& ranks) : ranks_(ranks)
{
    if (ranks.is_first()) whole_ = std::make_unique<Whole>();
}

GatheredChain::~GatheredChain() = default;

/// Sizes and numbers of columns travel as doubles, which hold them exactly. Ranks have their rows one after
/// the other. All learn whether it is done, also where rows and unknowns are not as many.
bool GatheredChain::factorise(const ChainRows& own)
{
    n_own_ = static_cast<std::size_t>(own.n_rows());
    if (!ranks_.is_first()) {
        const double sizes[] = {static_cast<double>(own.columns.size()), static_cast<double>(n_own_)};
        ranks_.send(0, sizes);
        ranks_.send(0, std::vector<double>(own.columns.begin(), own.columns.end()));
        ranks_.send(0, own.values);
        double is_done = 0;
        ranks_.broadcast(0, {&is_done, 1});
        return is_done != 0;
    }
    whole_->columns.clear();
    whole_->n_rows.clear();
    std::vector<std::vector<std::pair<int, double>>> entries(static_cast<std::size_t>(own.n_unknowns));
    int row = 0;
    const auto add = [&](std::vector<int> columns, int n_rows, const std::vector<double>& values) {
        for (int i = 0; i < n_rows; ++i, ++row)
            for (std::size_t j = 0; j < columns.size(); ++j)
                if (const double value = values[static_cast<std::size_t>(i) * columns.size() + j]; value != 0)
                    entries[static_cast<std::size_t>(columns[j])].emplace_back(row, value);
        whole_->columns.push_back(std::move(columns));
        whole_->n_rows.push_back(n_rows);
    };
    add(own.columns, own.n_rows(), own.values);
    for (int r = 1; r < ranks_.size(); ++r) {
        double sizes[2];
        ranks_.receive(r, sizes);
        std::vector<double> columns(static_cast<std::size_t>(sizes[0])),
            values(columns.size() * static_cast<std::size_t>(sizes[1]));
        ranks_.receive(r, columns);
        ranks_.receive(r, values);
        add({columns.begin(), columns.end()}, static_cast<int>(sizes[1]), values);
    }
    double is_done = row == own.n_unknowns ? 1 : 0;
    if (is_done != 0) {
        whole_->A = sparse_from_columns(entries);
        whole_->b.resize(static_cast<std::size_t>(row));
        whole_->x.resize(whole_->b.size());
        is_done = whole_->factorise() ? 1 : 0;
    }
    ranks_.broadcast(0, {&is_done, 1});
    return is_done != 0;
}

void GatheredChain::solve(std::span<const double> b, std::span<double> x)
{
    if (!ranks_.is_first()) {
        ranks_.send(0, b);
        ranks_.receive(0, x);
        return;
    }
    std::ranges::copy(b, whole_->b.begin());
    std::size_t at = b.size();
    for (int r = 1; r < ranks_.size(); ++r) {
        const auto n = static_cast<std::size_t>(whole_->n_rows[static_cast<std::size_t>(r)]);
        ranks_.receive(r, std::span(whole_->b).subspan(at, n));
        at += n;
    }
    whole_->solve();
    std::vector<double> wanted;
    for (int r = ranks_.size() - 1; r >= 0; --r) {
        wanted.clear();
        for (const int c : whole_->columns[static_cast<std::size_t>(r)])
            wanted.push_back(whole_->x[static_cast<std::size_t>(c)]);
        if (r > 0)
            ranks_.send(r, wanted);
        else
            std::ranges::copy(wanted, x.begin());
    }
}

}   // namespace livens
