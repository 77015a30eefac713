// SPDX-License-Identifier: BSD-3-Clause
// Examples as shipped, solved and compared with numbers from elsewhere.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "livens/io/scenario.h"
#include "livens/spacetime/solve.h"

namespace livens::tests {

inline const std::filesystem::path root = LIVENS_SOURCE_DIR;

/// tests/reference/data/<name>.json
inline nlohmann::json data(const std::string& name)
{
    std::ifstream file(root / "tests/reference/data" / (name + ".json"));
    EXPECT_TRUE(file.good()) << name;
    return nlohmann::json::parse(file);
}

inline Vector3 vector3(const nlohmann::json& j) { return {j.at(0), j.at(1), j.at(2)}; }

/// Rows of the file are directors.
inline Matrix3 triad(const nlohmann::json& j)
{
    Matrix3 d{};
    for (int i = 0; i < 3; ++i) d.set_column(i, vector3(j.at(i)));
    return d;
}

inline double largest(const Vector3& v) { return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])}); }
template <int R, int C>
double largest_difference(const Matrix<R, C>& l, const Matrix<R, C>& r)
{
    double worst = 0;
    for (int i = 0; i < R * C; ++i) worst = std::max(worst, std::abs(l.a[i] - r.a[i]));
    return worst;
}

/// One example after solving; nothing in it is adjusted.
struct Shipped {
    Model model;
    Solution solution;

    int body(const std::string& name) const { return model.find_body(name); }

    /// The element end at time t; the test fails if there is none.
    int end_at(double t) const
    {
        const auto& ends = solution.motion.mesh.ends;
        const auto near = std::min_element(
            ends.begin(), ends.end(), [&](double l, double r) { return std::abs(l - t) < std::abs(r - t); });
        EXPECT_NEAR(*near, t, 1e-12) << "not an element end";
        return static_cast<int>(near - ends.begin());
    }
    State at(double t) const { return solution.motion.at_end(end_at(t)); }
};

inline Shipped solve_example(const std::string& name)
{
    const ScenarioResult read = read_scenario(root / "examples" / (name + ".toml"));
    if (!read.scenario) {
        ADD_FAILURE() << render(read.diagnostics, read.text, DiagnosticFormat::human);
        throw std::runtime_error("examples/" + name + ".toml cannot be read");
    }
    const Scenario& s = *read.scenario;
    Shipped shipped{s.model, solve(s.model, {s.model.start()}, s.time, s.method, s.options)};
    EXPECT_TRUE(shipped.solution.report.converged()) << shipped.solution.report.message;
    return shipped;
}

/// Angular velocity in body axes.
inline Vector3 body_spin(const State& state, int body)
{
    return transpose(directors(state.X[body])) * angular_velocity(state.X[body], state.V[body]);
}

}   // namespace livens::tests
