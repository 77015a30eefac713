// SPDX-License-Identifier: BSD-3-Clause
// Published problems as examples/benchmarks has them, and how far a motion is from their tables.
#pragma once

#include <functional>

#include "reference/shipped.h"

namespace livens::tests {

/// Largest error at an instant of the table: of places in lengths of the model, of turns in rad.
using ErrorAt = std::function<double(const Model&, const State&, std::size_t)>;

struct Published {
    const char* name;
    Scenario scenario;
    std::vector<double> times;
    ErrorAt error;
    double digits = 1e-12;    ///< of the table
    double finest = 0;        ///< below this accuracy rounding decides, and the run is to say so
    double reached = 1e-11;   ///< error that the scenario as it stands stays below
};

inline Scenario scenario_of(const std::string& benchmark)
{
    const ScenarioResult read = read_scenario(root / "examples/benchmarks" / (benchmark + ".toml"));
    EXPECT_TRUE(read.scenario.has_value()) << benchmark;
    return read.scenario.value();
}

/// Between the orientations of two unit quaternions of either sign.
inline double angle_of(const Vector4& l, const Vector4& r)
{
    return 2 * 2 * std::asin(std::min(1.0, 0.5 * std::min(norm(l - r), norm(l + r))));
}

inline Vector4 quaternion_at(const nlohmann::json& j) { return {j.at(0), j.at(1), j.at(2), j.at(3)}; }

inline Published simple_pendulum(const nlohmann::json& table)
{
    return {"P01", scenario_of("p01_simple_pendulum"), table.at("times"),
            [rows = table.at("position")](const Model& model, const State& state, std::size_t i) {
                return largest_difference(state.X[0].column(0), vector3(rows.at(i))) / model.length();
            }};
}

inline Published parallelograms(const char* name, const char* benchmark, const nlohmann::json& table)
{
    return {name, scenario_of(benchmark), table.at("times"),
            [rows = table.at("B0")](const Model&, const State& state, std::size_t i) {
                const Vector3 tip = vector3(rows.at(i)), along = state.X[0].column(1);
                return norm(along - tip);   // of a link of length 1: its angle
            }};
}

inline Published lagrange_top(const nlohmann::json& table)
{
    return {"P07", scenario_of("p07_lagrange_top"), table.at("times"),
            [rows = table.at("axis_3")](const Model&, const State& state, std::size_t i) {
                return norm(state.X[0].column(3) - vector3(rows.at(i)));
            }};
}

/// Quaternions at three of its times; angular momentum in body axes, whose length is 10, at all.
inline Published dzhanibekov(const nlohmann::json& table)
{
    return {"P08",
            scenario_of("p08_dzhanibekov"),
            table.at("times"),
            [table](const Model&, const State& state, std::size_t i) {
                const auto momentum = [](const Vector3& w) { return Vector3{w[0], 2 * w[1], 3 * w[2]}; };
                const Vector3 w = body_spin(state, 0),
                              exact = vector3(table.at("angular_velocity_body").at(i));
                double error = norm(momentum(w - exact)) / norm(momentum(exact));
                const auto& times = table.at("quaternion_times");
                for (std::size_t k = 0; k < times.size(); ++k) {
                    if (times.at(k) != table.at("times").at(i)) continue;
                    const Vector4 q = quaternion_from_directors(directors(state.X[0]));
                    error = std::max(error, angle_of(q, quaternion_at(table.at("quaternion").at(k))));
                }
                return error;
            },
            4e-12,
            1e-9};
}

inline Published free_body(const nlohmann::json& table)
{
    return {"P09", scenario_of("p09_free_body"), table.at("times"),
            [table](const Model& of, const State& state, std::size_t i) {
                const Vector4 q = quaternion_from_directors(directors(state.X[0]));
                const double place =
                    largest_difference(state.X[0].column(0), vector3(table.at("position").at(i)));
                return std::max(place / of.length(),
                                angle_of(q, quaternion_at(table.at("quaternion").at(i))));
            },
            4e-12};
}

inline Published revolute_double_pendulum(const nlohmann::json& table)
{
    return {"P14", scenario_of("p14_revolute_double_pendulum"), table.at("times"),
            [rows = table.at("center_of_mass_2")](const Model& of, const State& state, std::size_t i) {
                return norm(state.X[1] * point({0.5, 0, 0}) - vector3(rows.at(i))) / of.length();
            }};
}

inline Published two_bricks(const nlohmann::json& table)
{
    return {"P16", scenario_of("p16_two_bricks"), table.at("times"),
            [table](const Model& of, const State& state, std::size_t i) {
                const Vector3 P1 = state.X[0] * point({1, 0, 0}) - vector3(table.at("P1").at(i)),
                              P2 = state.X[1] * point({1, 0, 0}) - vector3(table.at("P2").at(i));
                return std::max(norm(P1), norm(P2)) / of.length();
            },
            3e-12};
}

inline std::vector<Published> published_problems()
{
    const nlohmann::json all = data("benchmarks");
    std::vector<Published> problems{
        simple_pendulum(all.at("P01")),
        parallelograms("P02", "p02_four_bars_2", all.at("P02")),
        lagrange_top(all.at("P07")),
        dzhanibekov(all.at("P08")),
        free_body(all.at("P09")),
        revolute_double_pendulum(all.at("P14")),
        two_bricks(all.at("P16")),
        parallelograms("P02, 40", "p02_four_bars_40", all.at("P02 with 40 links"))};
    problems[1].reached = 5e-11;   // half of what it asks for
    problems[3].reached = 5e-9;    // rounding of its start has grown a thousandfold by 50 s
    problems[4].reached = 5e-11;   // 426 m from where it began
    problems[6].reached = 5e-10;   // what it asks for; rounding alone is up to 3e-10 rad by then
    return problems;
}

}   // namespace livens::tests
