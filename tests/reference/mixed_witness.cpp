// SPDX-License-Identifier: BSD-3-Clause
// The paper's elements against another program of them: tests/reference/data/mixed.json.
#include <gtest/gtest.h>

#include <fstream>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "livens/multibody/mass_properties.h"
#include "mixed_problems.h"

namespace livens::tests::mixed_witness_test {
namespace {

using nlohmann::json;

const json& witness()
{
    static const json data = json::parse(std::ifstream(LIVENS_SOURCE_DIR "/tests/reference/data/mixed.json"));
    return data;
}

Model model_of(const std::string& name)
{
    if (name == "free_box") return free_box({5, 5, 5});
    return cubes_on_rods(name == "pendulum_offset" ? 0.1 : 0);
}

Mixed method_of(const json& record)
{
    Mixed method;
    const std::string basis = record["basis"];
    method.basis = basis == "lagrange"  ? Mixed::Basis::lagrange
                   : basis == "bspline" ? Mixed::Basis::bspline
                                        : Mixed::Basis::nurbs;
    method.degree = record["degree"];
    method.start = record["start"] == "natural" ? Mixed::Start::natural : Mixed::Start::strong;
    method.multipliers =
        record["multipliers"] == "equal" ? Mixed::Multipliers::equal : Mixed::Multipliers::lower;
    method.end_multiplier = Mixed::EndMultiplier::zero;   // as there
    method.gauss_points = record["gauss_points"];
    if (record.contains("weights")) method.weights = record["weights"].get<std::vector<double>>();
    return method;
}

State state_of(const Model& model, const json& X, const json& P)
{
    State state = model.start();
    for (int b = 0; b < model.n_bodies(); ++b) {
        Matrix34 momentum{};
        for (int i = 0; i < 12; ++i) {
            state.X[b].a[i] = X[static_cast<std::size_t>(12 * b + i)];
            momentum.a[i] = P[static_cast<std::size_t>(12 * b + i)];
        }
        state.V[b] = momentum * inverse_mass(model.bodies()[b].mass, false);
    }
    return state;
}

Conditions boundary_of(const Model& model, const json& record)
{
    const json& exact = witness()["exact"][record["case"].get<std::string>()];
    Conditions boundary{state_of(model, exact["X0"], exact["P0"]), Known::nothing,
                      state_of(model, exact["XT"], exact["PT"]), Known::nothing};
    for (const std::string what : record["given"]) {
        Known& given = what.back() == '0' ? boundary.at_start : boundary.at_end;
        const Known half = what.front() == 'X' ? Known::positions : Known::momenta;
        given = given == Known::nothing ? half : Known::state;
    }
    return boundary;
}

/// Largest difference between matrices and the numbers of a record.
double distance_to(std::span<const Matrix34> found, const json& numbers)
{
    double worst = 0;
    for (std::size_t b = 0; b < found.size(); ++b)
        for (std::size_t i = 0; i < 12; ++i)
            worst = std::max(worst, std::abs(found[b].a[i] - numbers[12 * b + i].get<double>()));
    return worst;
}

TEST(MixedWitness, FindsTheSameEndStates)
{
    int compared = 0;
    for (const json& record : witness()["solutions"]) {
        if (record.contains("lambda_0") && record["lambda_0"] == "zero") continue;   // not offered
        const Model model = model_of(record["case"]);
        const TimeMesh mesh = make_time_mesh(0, record["duration"], record["elements"]);
        const Mixed method = method_of(record);
        SolveOptions options;
        options.tolerance = 1e-13;
        options.judge = false;   // two elements are enough to compare numbers, and too few for a motion
        const Solution solution = solve(model, {boundary_of(model, record)}, mesh, method, options);
        const std::string name =
            record["case"].get<std::string>() + " " + name_of(method) + " " + record["given"].dump();
        ASSERT_TRUE(solution.report.converged()) << name << ": " << solution.report.message;
        const std::size_t n = static_cast<std::size_t>(model.n_bodies());
        const std::span<const Matrix34> momenta(solution.motion.momenta);
        EXPECT_LT(distance_to(solution.motion.at_end(0).X, record["X0"]), 1e-11) << name;
        EXPECT_LT(distance_to(last(solution).X, record["XT"]), 1e-11) << name;
        EXPECT_LT(distance_to(momenta.first(n), record["P0"]), 1e-9) << name;
        EXPECT_LT(distance_to(momenta.last(n), record["PT"]), 1e-9) << name;
        ++compared;
    }
    EXPECT_GT(compared, 60);
}

TEST(MixedWitness, FindsTheSameConditionNumbers)
{
    for (const json& record : witness()["condition_numbers"]) {
        Mixed method;
        method.degree = 1;
        method.start = record["start"] == "natural" ? Mixed::Start::natural : Mixed::Start::strong;
        method.end_multiplier = Mixed::EndMultiplier::zero;
        SolveOptions options;
        options.condition = true;
        const Model model = free_box({5, 5, 5});
        const Solution solution =
            solve(model, {model.start()}, make_time_mesh(0, 1, record["elements"]), method, options);
        EXPECT_EQ(solution.report.unknowns, record["size"].get<int>());
        EXPECT_NEAR(solution.report.condition_1 / record["norm_1"].get<double>(), 1, 0.01) << record.dump();
        EXPECT_NEAR(solution.report.condition_2 / record["norm_2"].get<double>(), 1, 1e-4) << record.dump();
    }
}

}   // namespace
}   // namespace livens::tests::mixed_witness_test
