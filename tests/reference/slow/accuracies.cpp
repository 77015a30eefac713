// SPDX-License-Identifier: BSD-3-Clause
// Every published problem to every accuracy, by its end and its output times alone: no mesh, no degree, no
// method.
#include <functional>

#include "parallelograms.h"
#include "reference/shipped.h"

namespace livens::tests {
namespace {

/// Largest error at an instant of the table: of places in lengths of the model, of turns in rad.
using ErrorAt = std::function<double(const Model&, const State&, std::size_t)>;

struct Published {
    const char* name;
    Model model;
    std::vector<double> times;
    ErrorAt error;
    double digits = 1e-12;   ///< of the table
    double finest = 0;       ///< below this accuracy rounding decides, and the run is to say so
};

Model model_of(const std::string& example)
{
    const ScenarioResult read = read_scenario(root / "examples" / (example + ".toml"));
    EXPECT_TRUE(read.scenario.has_value()) << example;
    return read.scenario.value().model;
}

/// Between the orientations of two unit quaternions of either sign.
double angle_between(const Vector4& l, const Vector4& r)
{
    return 2 * 2 * std::asin(std::min(1.0, 0.5 * std::min(norm(l - r), norm(l + r))));
}

Vector4 quaternion_at(const nlohmann::json& j) { return {j.at(0), j.at(1), j.at(2), j.at(3)}; }

Published simple_pendulum(const nlohmann::json& table)
{
    return {"P01", model_of("simple_pendulum"), table.at("times"),
            [rows = table.at("position")](const Model& model, const State& state, std::size_t i) {
                return largest_difference(state.X[0].column(0), vector3(rows.at(i))) / model.length();
            }};
}

Published parallelograms(const char* name, int links, const nlohmann::json& table)
{
    return {name, Parallelograms{links}.model(), table.at("times"),
            [rows = table.at("B0")](const Model&, const State& state, std::size_t i) {
                const Vector3 tip = vector3(rows.at(i)), along = state.X[0].column(1);
                return norm(along - tip);   // of a link of length 1: its angle
            }};
}

Published lagrange_top(const nlohmann::json& table)
{
    return {"P07", model_of("lagrange_top"), table.at("times"),
            [rows = table.at("axis_3")](const Model&, const State& state, std::size_t i) {
                return norm(state.X[0].column(3) - vector3(rows.at(i)));
            }};
}

/// Quaternions at three of its times; angular momentum in body axes, whose length is 10, at all.
Published dzhanibekov(const nlohmann::json& table)
{
    return {"P08",
            model_of("dzhanibekov"),
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
                    error = std::max(error, angle_between(q, quaternion_at(table.at("quaternion").at(k))));
                }
                return error;
            },
            4e-12,
            1e-9};
}

Published free_body(const nlohmann::json& table)
{
    Placement placement;
    placement.position = {1, 2, 3};
    placement.velocity = {-4.2, 5.5, 6.1};
    placement.angular_velocity = {2, 4, 6};
    Model model({0, 0, -9.81});
    model.add_body(rigid_body("body", {1, {}, {0.04, 0, 0, 0, 0.04, 0, 0, 0, 0.02}}, placement));
    return {"P09", model, table.at("times"),
            [table](const Model& of, const State& state, std::size_t i) {
                const Vector4 q = quaternion_from_directors(directors(state.X[0]));
                const double place =
                    largest_difference(state.X[0].column(0), vector3(table.at("position").at(i)));
                return std::max(place / of.length(),
                                angle_between(q, quaternion_at(table.at("quaternion").at(i))));
            },
            4e-12};
}

Published revolute_double_pendulum(const nlohmann::json& table)
{
    const Model model = model_of("revolute_double_pendulum");
    return {"P14", model, table.at("times"),
            [rows = table.at("center_of_mass_2"),
             lower = model.find_body("lower")](const Model& of, const State& state, std::size_t i) {
                return norm(state.X[lower] * point({0.5, 0, 0}) - vector3(rows.at(i))) / of.length();
            }};
}

Published two_bricks(const nlohmann::json& table)
{
    const Model model = model_of("ball_pendulum_two");
    return {"P16", model, table.at("times"),
            [table, upper = model.find_body("upper"),
             lower = model.find_body("lower")](const Model& of, const State& state, std::size_t i) {
                const Vector3 P1 = state.X[upper] * point({1, 0, 0}) - vector3(table.at("P1").at(i)),
                              P2 = state.X[lower] * point({1, 0, 0}) - vector3(table.at("P2").at(i));
                return std::max(norm(P1), norm(P2)) / of.length();
            },
            3e-12};
}

class EveryAccuracy : public ::testing::TestWithParam<double> {};

/// True error at most three times the accuracy, by defaults.
void expect_reached(const Published& p, double accuracy)
{
    const Span span{0, p.times.back(), accuracy, p.times};
    const Solution s = solve(p.model, {p.model.start()}, span, Auto{});
    if (accuracy < p.finest) {
        EXPECT_EQ(s.report.status, SolveStatus::inaccurate) << p.name;
        EXPECT_NE(s.report.message.find("rounding"), std::string::npos) << s.report.message;
        return;
    }
    ASSERT_TRUE(s.report.converged()) << p.name << ": " << s.report.message;
    EXPECT_TRUE(s.verdict.reasons.empty()) << p.name << ": " << s.verdict.reasons.front();
    EXPECT_LE(s.verdict.estimated_error, accuracy) << p.name;
    double worst = 0;
    for (std::size_t i = 0; i < p.times.size(); ++i)
        worst = std::max(worst, p.error(p.model, s.motion.at(p.times[i]), i));
    EXPECT_LE(worst, 3 * accuracy + p.digits) << p.name;
    std::printf("%s  accuracy %.0e  estimated %.1e  true at %zu instants %.1e  %d elements\n", p.name,
                accuracy, s.verdict.estimated_error, p.times.size(), worst, s.motion.n_elements());
}

TEST_P(EveryAccuracy, IsReachedOnPublishedProblems)
{
    const nlohmann::json all = data("benchmarks");
    const Published problems[] = {simple_pendulum(all.at("P01")), parallelograms("P02", 2, all.at("P02")),
                                  lagrange_top(all.at("P07")),    dzhanibekov(all.at("P08")),
                                  free_body(all.at("P09")),       revolute_double_pendulum(all.at("P14")),
                                  two_bricks(all.at("P16"))};
    for (const Published& problem : problems) expect_reached(problem, GetParam());
}

TEST_P(EveryAccuracy, IsReachedByFortyFourBarLinkages)
{
    const nlohmann::json all = data("benchmarks");
    expect_reached(parallelograms("P02, 40", 40, all.at("P02 with 40 links")), GetParam());
}

INSTANTIATE_TEST_SUITE_P(From, EveryAccuracy,
                         ::testing::Values(1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10));

}   // namespace
}   // namespace livens::tests
