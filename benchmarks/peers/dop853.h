// SPDX-License-Identifier: BSD-3-Clause
// DOP853 with adaptive steps, the sums of its stages written out by the compiler without the zeros.
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "dop853_table.h"

namespace peers {

/// y' = f(y) by f(const double* y, double* dy). A step is taken if the weighted mean square of its estimated
/// error, as in dop853.f, is below tolerance * (1 + |y|).
class Dop853 {
public:
    template <class F>
    void integrate(const F& f, std::vector<double>& y, double end, double tolerance)
    {
        n_ = y.size();
        tolerance_ = tolerance;
        k_.assign(12 * n_, 0);
        z_.resize(n_);
        f(y.data(), k_.data());
        double t = 0, h = first_step(f, y, end);
        for (bool refused = false; t < end;) {
            const bool last = t + h >= end * (1 - 1e-15);
            if (last) h = end - t;
            if (!(t + h > t)) throw std::runtime_error("the steps of DOP853 vanish");
            stages(f, y.data(), h, std::make_index_sequence<11>{});
            sum<12>(dop853::B, y.data(), h);
            const double error = estimate(y, h);
            double factor = error == 0 ? 10 : 0.9 * std::pow(error, -1.0 / 8);
            if (error < 1) {
                t = last ? end : t + h;
                y = z_;
                if (!last) f(y.data(), k_.data());
                factor = std::min(factor, refused ? 1.0 : 10.0);
            } else {   // or not a number
                factor = std::max(std::isfinite(factor) ? factor : 0, 0.2);
            }
            refused = !(error < 1);
            h *= factor;
        }
    }

private:
    template <class F, std::size_t... S>
    void stages(const F& f, const double* y, double h, std::index_sequence<S...>)
    {
        ((sum<S + 1>(dop853::A[S + 1], y, h), f(z_.data(), k_.data() + (S + 1) * n_)), ...);
    }

    /// z = y + h sum_j a_j k_j over the first J stages.
    template <std::size_t J>
    void sum(const double (&a)[12], const double* y, double h)
    {
        const double* k = k_.data();
        double* z = z_.data();
        double ha[J];
        for (std::size_t j = 0; j < J; ++j) ha[j] = h * a[j];
        for (std::size_t i = 0; i < n_; ++i) z[i] = y[i];
        for (std::size_t j = 0; j < J; ++j) {
            if (ha[j] == 0) continue;
            const double* kj = k + j * n_;
            for (std::size_t i = 0; i < n_; ++i) z[i] += ha[j] * kj[i];
        }
    }

    double estimate(const std::vector<double>& y, double h) const
    {
        double e5 = 0, e3 = 0;
        for (std::size_t i = 0; i < n_; ++i) {
            double a5 = 0, a3 = 0;
            for (std::size_t j = 0; j < 12; ++j) {
                a5 += dop853::E5[j] * k_[j * n_ + i];
                a3 += dop853::E3[j] * k_[j * n_ + i];
            }
            const double scale = tolerance_ * (1 + std::max(std::abs(y[i]), std::abs(z_[i])));
            e5 += a5 / scale * (a5 / scale);
            e3 += a3 / scale * (a3 / scale);
        }
        const double denominator = e5 + 0.01 * e3;
        return denominator == 0 ? 0 : h * e5 / std::sqrt(denominator * static_cast<double>(n_));
    }

    double norm(const std::vector<double>& y, const double* v) const
    {
        double sum = 0;
        for (std::size_t i = 0; i < n_; ++i) {
            const double scaled = v[i] / (tolerance_ * (1 + std::abs(y[i])));
            sum += scaled * scaled;
        }
        return std::sqrt(sum / static_cast<double>(n_));
    }

    template <class F>
    double first_step(const F& f, const std::vector<double>& y, double end)
    {
        const double* k0 = k_.data();
        double* k1 = k_.data() + n_;
        const double d0 = norm(y, y.data()), d1 = norm(y, k0);
        const double h0 = std::min(end, d0 < 1e-5 || d1 < 1e-5 ? 1e-6 : 0.01 * d0 / d1);
        for (std::size_t i = 0; i < n_; ++i) z_[i] = y[i] + h0 * k0[i];
        f(z_.data(), k1);
        for (std::size_t i = 0; i < n_; ++i) z_[i] = k1[i] - k0[i];
        const double largest = std::max(d1, norm(y, z_.data()) / h0);
        const double h1 = largest <= 1e-15 ? std::max(1e-6, h0 * 1e-3) : std::pow(0.01 / largest, 1.0 / 8);
        return std::min({100 * h0, h1, end});
    }

    std::size_t n_ = 0;
    double tolerance_ = 0;
    std::vector<double> k_, z_;   // stages one after the other; the point that is evaluated
};

}   // namespace peers
