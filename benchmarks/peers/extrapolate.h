// SPDX-License-Identifier: BSD-3-Clause
// References: the modified midpoint rule extrapolated to order 18 in equal steps, in 64 bits of mantissa.
#pragma once

#include <vector>

namespace peers {

template <class F>
void extrapolate(const F& f, std::vector<long double>& y, long double end, int steps)
{
    using Numbers = std::vector<long double>;
    constexpr int columns = 9;
    const std::size_t n = y.size();
    const long double H = end / steps;
    std::vector<Numbers> table(columns, Numbers(n));
    Numbers a(n), b(n), d(n), at(n);
    // What is extrapolated is the way from y, so that rounding is of its size.
    const auto rates = [&](const Numbers& from_y) {
        for (std::size_t i = 0; i < n; ++i) at[i] = y[i] + from_y[i];
        f(at.data(), d.data());
    };
    for (int step = 0; step < steps; ++step) {
        for (int k = 0; k < columns; ++k) {
            const long double h = H / (2 * (k + 1));
            a.assign(n, 0);
            rates(a);
            for (std::size_t i = 0; i < n; ++i) b[i] = h * d[i];
            for (int j = 1; j < 2 * (k + 1); ++j) {
                rates(b);
                for (std::size_t i = 0; i < n; ++i) {
                    a[i] += 2 * h * d[i];
                    std::swap(a[i], b[i]);
                }
            }
            rates(b);
            for (std::size_t i = 0; i < n; ++i) table[k][i] = (a[i] + b[i] + h * d[i]) / 2;
        }
        for (int j = 1; j < columns; ++j) {
            for (int k = columns - 1; k >= j; --k) {
                const long double q = static_cast<long double>(k + 1) / (k + 1 - j);
                for (std::size_t i = 0; i < n; ++i)
                    table[k][i] += (table[k][i] - table[k - 1][i]) / (q * q - 1);
            }
        }
        for (std::size_t i = 0; i < n; ++i) y[i] += table[columns - 1][i];
    }
}

}   // namespace peers
