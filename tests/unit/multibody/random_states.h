// SPDX-License-Identifier: BSD-3-Clause
// Random numbers and configurations for tests; the same on every machine.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "livens/base/error.h"
#include "livens/base/linear.h"
#include "livens/multibody/body.h"

namespace livens {

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}

    /// Uniform in [-1, 1); not std::uniform_real_distribution, whose numbers differ between libraries.
    double number() { return std::ldexp(static_cast<double>(engine_() >> 11), -52) - 1; }

    template <int R, int C>
    Matrix<R, C> matrix()
    {
        Matrix<R, C> m{};
        for (double& entry : m.a) entry = number();
        return m;
    }
    Vector3 vector() { return matrix<3, 1>(); }
    Vector3 unit()
    {
        Vector3 v = vector();
        while (norm(v) < 0.1 || norm(v) > 1) v = vector();
        return (1 / norm(v)) * v;
    }
    Matrix3 rotation() { return directors_from_rotation_vector(std::numbers::pi * number() * unit()); }
    Matrix34 rigid() { return configuration(vector(), rotation()); }
    /// Near a rigid configuration but off it: directors skew and stretched by up to 0.3, never singular.
    Matrix34 skew()
    {
        Matrix34 X = rigid();
        for (int i = 3; i < 12; ++i) X[i] += 0.3 * number();
        return std::abs(determinant(directors(X))) < 0.2 ? skew() : X;
    }

private:
    std::mt19937_64 engine_;
};

template <int R, int C>
double largest(const Matrix<R, C>& m)
{
    double size = 0;
    for (const double entry : m.a) size = std::isnan(entry) ? entry : std::max(size, std::abs(entry));
    return size;
}

/// The action must throw InputError with this code, and with this path unless it is empty.
template <typename Action>
void expect_complaint(Action action, const std::string& code, const std::string& path = "")
{
    try {
        action();
        ADD_FAILURE() << "no InputError where '" << code << "' was due";
    } catch (const InputError& error) {
        EXPECT_EQ(error.complaint().code, code) << error.what();
        EXPECT_FALSE(error.complaint().message.empty());
        if (!path.empty()) {
            EXPECT_EQ(error.complaint().path, path);
        }
    }
}

}   // namespace livens
