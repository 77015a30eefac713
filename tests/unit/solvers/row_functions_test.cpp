// SPDX-License-Identifier: BSD-3-Clause
// Sums over rows in registers of any width are those over their numbers one by one.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "block_systems.h"
#include "livens/solvers/instructions.h"
#include "livens/solvers/row_functions.h"

namespace livens::row_functions_test {
namespace {

struct Sums {
    double inner = 0;
    std::vector<double> scaled, pair;
};

Sums by_numbers(const std::vector<double>& x, const std::vector<double>& y)
{
    Sums sums{0, y, y};
    for (std::size_t i = 0; i < x.size(); ++i) {
        sums.inner += x[i] * y[i];
        sums.scaled[i] -= 0.3 * x[i];
        sums.pair[i] -= 0.3 * x[i] - 0.7 * y[i];
    }
    return sums;
}

void expect_as_numbers(const RowFunctions& rows)
{
    for (int n = 0; n <= 41; ++n) {
        const std::vector<double> x = Random(3).values(n + 1), y = Random(4).values(n + 1);
        const std::vector<double> x_used(x.begin(), x.end() - 1), y_used(y.begin(), y.end() - 1);
        const Sums expected = by_numbers(x_used, y_used);
        EXPECT_NEAR(rows.inner(x.data(), y.data(), n), expected.inner, 1e-14) << n;
        std::vector<double> scaled = y, pair = y;
        rows.subtract_scaled(scaled.data(), 0.3, x.data(), n);
        rows.subtract_pair(pair.data(), 0.3, x.data(), -0.7, y.data(), n);
        for (int i = 0; i < n; ++i) {
            EXPECT_NEAR(scaled[i], expected.scaled[i], 1e-15) << n;
            EXPECT_NEAR(pair[i], expected.pair[i], 1e-15) << n;
        }
        // I - beta w w^T, w = [1; x], of [0.5; y]
        double head = 0.5;
        std::vector<double> reflected = y;
        rows.reflect(&head, reflected.data(), 0.2, x.data(), n);
        const double t = 0.2 * (0.5 + expected.inner);
        EXPECT_NEAR(head, 0.5 - t, 1e-14) << n;
        for (int i = 0; i < n; ++i) EXPECT_NEAR(reflected[i], y[i] - t * x[i], 1e-14) << n;
        EXPECT_EQ(reflected[n], y[n]);
        EXPECT_EQ(scaled[n], y[n]) << "what is behind is left alone";
        EXPECT_EQ(pair[n], y[n]);
    }
}

void expect_fours_as_one_by_one(const RowFunctions& rows)
{
    constexpr int apart = 50, n_rows = 3;
    const std::vector<double> x = Random(5).values(4 * apart);
    std::vector<double> a = Random(8).values(n_rows * apart);
    std::fill_n(a.begin() + apart, 4, 0.0);
    for (int n = 0; n <= 41; ++n) {
        const std::vector<double> y = Random(6).values(n_rows * apart);
        std::vector<double> fours = y;
        rows.subtract_fours(fours.data(), a.data(), x.data(), apart, n_rows, n);
        for (int i = 0; i < n_rows * apart; ++i) {
            const int row = i / apart, column = i % apart;
            double expected = y[i];
            for (int k = 0; k < 4 && column < n; ++k) expected -= a[row * apart + k] * x[k * apart + column];
            EXPECT_NEAR(fours[i], expected, column < n && row != 1 ? 1e-15 : 0) << n << ", " << i;
        }
    }
}

void expect_products(const RowFunctions& rows)
{
    constexpr int apart = 80;
    const std::vector<double> a = Random(9).values(5 * apart), x = Random(10).values(5 * apart);
    for (const int terms : {0, 1, 5})
        for (int n = 0; n + register_room < apart; ++n) {
            std::vector<double> y(apart, 9.0);
            rows.product(y.data(), {a.data() + 2, 7, x.data(), apart, terms}, n);
            for (int i = 0; i < apart; ++i) {
                double expected = i < n ? 0 : 9;
                for (int k = 0; k < terms && i < n; ++k) expected += a[7 * k + 2] * x[k * apart + i];
                if (i < n || i >= n + register_room) {
                    EXPECT_NEAR(y[i], expected, 1e-14) << terms << ", " << n;
                }
            }
        }
}

void expect_reflected_rows(const RowFunctions& rows)
{
    constexpr int below = 4;
    const std::vector<double> v = Random(11).values(below);
    for (int n = 1; n <= 13; ++n) {
        std::vector<double> z = Random(12).values((below + 1) * n + 1), reflected = z;
        std::fill_n(reflected.begin(), n, 0.0);
        rows.reflect_rows(reflected.data(), n, 0.3, v.data(), below);
        for (int c = 0; c < n; ++c) {
            double sum = 0;
            for (int i = 0; i < below; ++i) sum += 0.3 * v[i] * z[(i + 1) * n + c];
            EXPECT_NEAR(reflected[c], -sum, 1e-15) << n;
            for (int i = 0; i < below; ++i)
                EXPECT_NEAR(reflected[(i + 1) * n + c], z[(i + 1) * n + c] - v[i] * sum, 1e-15) << n;
        }
        EXPECT_EQ(reflected.back(), z.back()) << "what is behind is left alone";
    }
}

void expect_largest(const RowFunctions& rows)
{
    EXPECT_EQ(rows.largest(nullptr, 0), 0);
    for (int n = 1; n <= 21; ++n)
        for (int place = 0; place < n; ++place) {
            std::vector<double> x = Random(7).values(n + 1);
            x[n] = 9;   // behind
            for (const double most : {3.0, -3.0}) {
                x[place] = most;
                EXPECT_EQ(rows.largest(x.data(), n), 3) << n;
            }
            for (const double none : {HUGE_VAL, -HUGE_VAL, std::nan("")}) {
                x[place] = none;
                EXPECT_EQ(rows.largest(x.data(), n), HUGE_VAL) << n << ", " << none;
            }
        }
}

TEST(RowFunctions, AreSumsOverNumbers)
{
    expect_as_numbers(rows_sse2());
    expect_fours_as_one_by_one(rows_sse2());
    expect_products(rows_sse2());
    expect_reflected_rows(rows_sse2());
    expect_largest(rows_sse2());
    if (!has(Instructions::avx2)) return;
    expect_as_numbers(rows_avx2());
    expect_fours_as_one_by_one(rows_avx2());
    expect_products(rows_avx2());
    expect_reflected_rows(rows_avx2());
    expect_largest(rows_avx2());
}

TEST(RowFunctions, AreThoseOfTheInstructionsInUse)
{
    const Instructions before = instructions();
    ASSERT_TRUE(use_instructions(Instructions::sse2));
    EXPECT_EQ(&row_functions(), &rows_sse2());
    if (use_instructions(Instructions::avx2)) {
        EXPECT_EQ(&row_functions(), &rows_avx2());
    }
    use_instructions(before);
}

}   // namespace
}   // namespace livens::row_functions_test
