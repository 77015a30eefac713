// SPDX-License-Identifier: BSD-3-Clause
// Constraint rows at several nodes side by side against one row at one node.
#include "livens/spacetime/nodal/rows_in_lanes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "unit/dynamics/workshop.h"
#include "unit/spacetime/kernel_comparison.h"

namespace livens::rows_in_lanes_test {
namespace {

/// Rows of a mechanism at some nodes, by both ways.
struct Bench {
    Bench(unsigned seed, int n) : model(driven_workshop(seed)), tables(model, every_other_row(model, seed))
    {
        Random random(seed + 50);
        for (int A = 0; A < n; ++A) {
            places.push_back(random_places(model, random, true));
            maps.emplace_back(places.back().size(), 0.0);
            tables.bodies.map_twists(places.back().data(), maps.back().data());
        }
    }
    static std::vector<int> every_other_row(const Model& model, unsigned seed)
    {
        std::vector<int> rows;
        for (int r = static_cast<int>(seed % 2); r < model.n_rows(); r += 2) rows.push_back(r);
        std::ranges::reverse(rows);
        return rows;
    }

    /// The largest difference of a column or of its scale, over what is known.
    double difference(const RowsInLanes& lanes, const RowsInLanes::Workspace& work, int lane, int A)
    {
        const KnownColumns known = lanes.at(lane, work);
        Numbers one(tables.n_twists), by_lanes(tables.n_twists);
        double g[RowTables::gradient_size], largest = 0;
        for (std::size_t c = 0; c < tables.independent.size(); ++c) {
            const int r = tables.independent[c], column = static_cast<int>(c);
            tables.rows.gradient(r, {0.37}, places[A].data(), g);
            const double square = tables.scaled_gradient(r, places[A].data(), maps[A].data(), g, one.data());
            EXPECT_EQ(known.knows(column), tables.rows[r].is_quadratic && square > 0) << r;
            if (!known.knows(column)) continue;
            ++n_known;
            const double scale = known.take(column, by_lanes.data(), tables.n_twists);
            largest = std::max(largest, std::abs(scale * std::sqrt(square) - 1));
            for (std::size_t i = 0; i < one.size(); ++i)
                largest = std::max(largest, std::abs(one[i] / std::sqrt(square) - by_lanes[i]));
        }
        return largest;
    }

    Model model;
    ModelTables tables;
    std::vector<Numbers> places, maps;
    int n_known = 0;
};

double largest_difference(Bench& bench, double fault)
{
    const auto n = static_cast<int>(bench.places.size());
    RowsInLanes lanes(bench.tables, bench.tables.independent, n);
    RowsInLanes::Workspace work = lanes.workspace();
    double largest = 0;
    for (int first = 0; first < n; first += lanes.width()) {
        const int count = std::min(lanes.width(), n - first);
        for (int l = 0; l < count; ++l) lanes.place(l, bench.places[first + l].data(), work);
        work.numbers[5 * static_cast<std::size_t>(lanes.width())] += fault;   // of one lane
        lanes.evaluate(work);
        for (int l = 0; l < count; ++l)
            largest = std::max(largest, bench.difference(lanes, work, l, first + l));
    }
    return largest;
}

TEST(RowsInLanes, AreThoseOfOneNode)
{
    with_all_instructions([] {
        int n_known = 0;
        for (unsigned seed = 1; seed <= 12; ++seed)
            for (const int n : {1, 3, 8, 11}) {
                Bench bench(seed, n);
                EXPECT_LT(largest_difference(bench, 0), 1e-13) << seed << ' ' << n;
                n_known += bench.n_known;
            }
        EXPECT_GT(n_known, 1000);   // compilers draw random mechanisms in orders of their own
    });
}

TEST(RowsInLanes, AFaultInOneLaneIsSeen)
{
    Bench bench(1, 8);
    EXPECT_GT(largest_difference(bench, 1e-6), 1e-9);
}

}   // namespace
}   // namespace livens::rows_in_lanes_test
