// SPDX-License-Identifier: BSD-3-Clause
// Components of the rotation vector of a ball joint as coordinates: driven, acted along, and as coordinates
// of states. Against turns in closed form, bushings, and Lagrange's equations by differences.
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "livens/diagnostics/accelerations.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/diagnostics/sample.h"
#include "livens/dynamics/coordinates/generalised_state.h"
#include "livens/io/solve_scenario.h"
#include "livens/multibody/body.h"
#include "unit/io/scenario_text.h"

namespace livens::rotation_vector_test {

namespace {

using test::read;
using test::shown;

Scenario scenario_of(const std::string& text)
{
    ScenarioResult result = read("format = 1\n" + text);
    if (!result.scenario) throw std::logic_error(shown(result));
    return std::move(*result.scenario);
}

struct Solved {
    Scenario scenario;
    Solution solution;

    State last() const { return solution.motion.at_end(solution.motion.n_elements()); }
};

Solved solved(const std::string& text)
{
    Solved all{scenario_of(text), {}};
    const Scenario& s = all.scenario;
    all.solution = solve(s.model, {s.conditions}, s.time, s.method, s.options);
    return all;
}

constexpr double inertia[3] = {0.3, 0.4, 0.5};

/// A body that turns about its own centre of mass in the world, or on an arm that a hinge holds.
std::string top(const std::string& more, const std::string& body_keys = "")
{
    return "gravity = [0, 0, -9.81]\n[[body]]\nname = \"top\"\nmass = 2\ninertia = [0.3, 0.4, 0.5]\n"
           "position = [0, 0, 0]\n" +
           body_keys +
           "\n[[joint]]\nname = \"ball\"\ntype = \"spherical\"\nbetween = [\"world\", \"top\"]\n"
           "at = [0, 0, 0]\n" +
           more;
}

std::string component(int k) { return std::string("rotation_vector_") + "xyz"[k]; }

std::string in_time(double end, int elements, const std::string& more = "family = \"lobatto\"\ndegree = 6")
{
    return "\n[time]\nend = " + std::to_string(end) + "\nelements = " + std::to_string(elements) +
           "\n[method]\n" + more + "\n";
}

std::string drive(int k, const std::string& law, const std::string& more = "")
{
    return "[[drive]]\nname = \"d" + std::to_string(k) +
           "\"\ntype = \"joint\"\njoint = \"ball\"\ncoordinate = \"" + component(k) + "\"\n" + law + "\n" +
           more;
}

/// The laws of the driven tests: up to 2.2 rad about a changing axis, from rest.
Vector3 law(double t) { return {t * t, -0.7 * t * t * t, 1.2 * std::sin(t * t)}; }
const std::string driven = drive(0, "expression = \"t^2\"") + drive(1, "expression = \"-0.7*t^3\"") +
                           drive(2, "expression = \"1.2*sin(t^2)\"");

Vector3 angular_velocity(double t)
{
    // of the turn from a little before to a little after, by Richardson
    const auto by = [&](double h) {
        const Matrix3 R = directors_from_rotation_vector(law(t + h)) *
                          transpose(directors_from_rotation_vector(law(t - h)));
        return 0.5 / h * 0.5 * Vector3{R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1)};
    };
    const double h = 2e-3;
    return (1.0 / 45) * (64 * by(h / 2) - 20 * by(h) + by(2 * h));
}

TEST(RotationVector, IsDrivenAlongThreeLaws)
{
    const Solved s = solved(top(driven + in_time(1, 20)));
    ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
    EXPECT_TRUE(s.solution.verdict.reasons.empty()) << s.solution.verdict.reasons.front();
    for (const double t : {0.25, 0.6, 1.0}) {
        const State state = sample_state(s.solution.motion, t);
        EXPECT_LT(norm(directors(state.X[0]) - directors_from_rotation_vector(law(t))), 1e-11) << t;
    }
    // What the drives do is what turns it: d(J w)/dt along the slopes of r, J in world axes.
    const double t = 1, h = 1e-3;
    const auto momentum = [](double at) {
        const Matrix3 R = directors_from_rotation_vector(law(at));
        const Vector3 w = transpose(R) * angular_velocity(at);
        return R * Vector3{inertia[0] * w[0], inertia[1] * w[1], inertia[2] * w[2]};
    };
    const Vector3 torque = (1 / (12 * h)) * (momentum(t - 2 * h) - momentum(t + 2 * h) +
                                             8.0 * (momentum(t + h) - momentum(t - h)));
    const Accelerations accelerations(s.scenario.model, s.solution.motion);
    const std::vector<JointSample> told =
        JointSampler(s.scenario.model, s.solution.motion, accelerations).at(s.last());
    Vector3 sum{};
    for (std::size_t j = 1; j < told.size(); ++j) sum += told[j].left.torque;
    EXPECT_LT(norm(sum - torque), 1e-6 * norm(torque));
    EXPECT_GT(norm(torque), 0.5);
}

TEST(RotationVector, OneDrivenComponentLeavesTheOthersFree)
{
    // The drive does all the work that the kinetic energy shows.
    const Solved s = solved(top(drive(2, "expression = \"0.8*sin(2*t)^3\"") + in_time(2, 80),
                                "angular_velocity = [0.5, 0.2, 0]"));
    ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
    EXPECT_TRUE(s.solution.verdict.reasons.empty()) << s.solution.verdict.reasons.front();
    EXPECT_LT(balance(s.scenario.model, s.solution.motion).relative_energy_drift(), 1e-10);
    const NamedCoordinate* z = find_coordinate(s.scenario.model.joints()[0], component(2));
    ASSERT_NE(z, nullptr);
    for (const double t : {0.3, 1.1, 2.0}) {
        const State state = sample_state(s.solution.motion, t);
        EXPECT_NEAR(coordinate_value(z->coordinate, state.X), 0.8 * std::pow(std::sin(2 * t), 3), 1e-11) << t;
        EXPECT_GT(std::abs(coordinate_value(s.scenario.model.joints()[0].readings[0].coordinate, state.X)),
                  0.01);
    }
}

/// Distance of two states of one body.
double gap(const State& a, const State& b) { return std::max(norm(a.X[0] - b.X[0]), norm(a.V[0] - b.V[0])); }

const std::string bushing = "[[load]]\ntype = \"bushing\"\nname = \"b\"\nbetween = [\"world\", \"top\"]\n"
                            "at = [0, 0, 0]\n";
const std::string spin = "angular_velocity = [0.6, -0.4, 0.9]";

TEST(RotationVector, ActuatorsDoTheWorkOfAPreload)
{
    std::string along;
    const double torques[3] = {0.31, -0.22, 0.17};
    for (int k = 0; k < 3; ++k)
        along += "[[load]]\ntype = \"actuator\"\nname = \"m" + std::to_string(k) +
                 "\"\njoint = \"ball\"\ncoordinate = \"" + component(k) +
                 "\"\nvalue = " + std::to_string(torques[k]) + "\n";
    const Solved a = solved(top(along + in_time(1.5, 30), spin)),
                 b = solved(top(
                     bushing + "stiffness = [0, 0, 0, 0, 0, 0]\npreload = [0, 0, 0, -0.31, 0.22, -0.17]\n" +
                         in_time(1.5, 30),
                     spin)),
                 none = solved(top(in_time(1.5, 30), spin));
    ASSERT_TRUE(a.solution.report.converged() && b.solution.report.converged());
    EXPECT_TRUE(a.solution.verdict.reasons.empty()) << a.solution.verdict.reasons.front();
    EXPECT_LT(gap(a.last(), b.last()), 1e-11);
    EXPECT_GT(gap(a.last(), none.last()), 0.1) << "negative control";
}

TEST(RotationVector, SpringsDampersAndFormulasFollowIt)
{
    std::string along;
    const double stiffness[3] = {3, 5, 2}, damping[3] = {0.1, 0.05, 0.2};
    for (int k = 0; k < 3; ++k)
        along += "[[load]]\ntype = \"spring\"\nname = \"s" + std::to_string(k) +
                 "\"\njoint = \"ball\"\ncoordinate = \"" + component(k) +
                 "\"\nstiffness = " + std::to_string(stiffness[k]) +
                 "\ndamping = " + std::to_string(damping[k]) + "\n";
    const std::string by_formula =
        "[[load]]\ntype = \"actuator\"\nname = \"x\"\njoint = \"ball\"\ncoordinate = \"rotation_vector_x\"\n"
        "expression = \"-3*r - 0.1*v\"\ninputs = { r = \"ball.rotation_vector_x\", v = "
        "\"ball.rotation_vector_x_rate\" }\n" +
        along.substr(along.find("[[load]]", 1));
    const Solved a = solved(top(along + in_time(1.5, 30), spin)),
                 b = solved(top(bushing +
                                    "stiffness = [0, 0, 0, 3, 5, 2]\ndamping = [0, 0, 0, 0.1, 0.05, "
                                    "0.2]\n" +
                                    in_time(1.5, 30),
                                spin)),
                 c = solved(top(by_formula + in_time(1.5, 30), spin));
    for (const Solved* one : {&a, &b, &c}) {
        ASSERT_TRUE(one->solution.report.converged()) << one->solution.report.message;
        EXPECT_TRUE(one->solution.verdict.reasons.empty()) << one->solution.verdict.reasons.front();
    }
    EXPECT_LT(gap(a.last(), b.last()), 1e-11);
    EXPECT_LT(gap(a.last(), c.last()), 1e-11);
}

TEST(RotationVector, BeyondWhereItEndsIsRefusedOrTold)
{
    const auto code_of = [](const std::string& more, const char* code) {
        const ScenarioResult result = read("format = 1\n" + top(more + in_time(1, 10)));
        EXPECT_FALSE(result.scenario.has_value());
        EXPECT_NE(test::find(result, code), nullptr) << code << shown(result);
    };
    code_of(drive(0, "expression = \"3.2*t^2\""), "drive-angle");
    code_of(
        "[start]\ncoordinates = [{ joint = \"ball\", coordinate = \"rotation_vector_x\", value = 1.0 }]\n",
        "start-coordinate");
    // The others turn on while one is held: it ends at 175 degrees, by name.
    const Solved held =
        solved(top(drive(2, "expression = \"0.1*t^2\"") + in_time(4, 80), "angular_velocity = [1.2, 0, 0]"));
    EXPECT_FALSE(held.solution.report.converged());
    EXPECT_NE(held.solution.report.message.find("175 degrees"), std::string::npos)
        << held.solution.report.message;
    EXPECT_NE(held.solution.report.message.find("'ball'"), std::string::npos);
    // What acts along it is suspect there.
    const Solved turned = solved(top("[[load]]\ntype = \"actuator\"\nname = \"m\"\njoint = \"ball\"\n"
                                     "coordinate = \"rotation_vector_y\"\nvalue = 0.1\n" +
                                         in_time(4, 80),
                                     "angular_velocity = [1.2, 0, 0]"));
    ASSERT_FALSE(turned.solution.verdict.reasons.empty());
    EXPECT_NE(turned.solution.verdict.reasons.front().find("load 'm'"), std::string::npos)
        << turned.solution.verdict.reasons.front();
    const Solved free = solved(top(in_time(4, 80), "angular_velocity = [1.2, 0, 0]"));
    EXPECT_TRUE(free.solution.verdict.reasons.empty()) << "negative control: nothing is asked of it";
}

/// On an arm that a hinge turns, so that both bodies of the ball move.
const std::string on_arm =
    "gravity = [0.5, 0, -9.81]\n[[body]]\nname = \"arm\"\nmass = 1\ninertia = [0.2, 0.1, 0.2]\n"
    "position = [0.5, 0, 0]\n[[body]]\nname = \"top\"\nmass = 2\ninertia = [0.3, 0.4, 0.5]\n"
    "position = [1.2, 0.3, 0]\n[[joint]]\nname = \"hinge\"\ntype = \"revolute\"\nbetween = [\"world\", "
    "\"arm\"]\nat = [0, 0, 0]\naxis = [0, 1, 0.2]\n[[joint]]\nname = \"ball\"\ntype = \"spherical\"\n"
    "between = [\"arm\", \"top\"]\nat = [1, 0, 0]\n" +
    in_time(1, 10);

GeneralisedCoordinates coordinates_of(const Scenario& s)
{
    // One is named, the other two follow.
    return {s.model, s.model.start(), StartPolicy::check, {"ball.rotation_vector_y"}};
}

TEST(RotationVector, IsACoordinateOfStates)
{
    const Scenario s = scenario_of(on_arm);
    const GeneralisedCoordinates all = coordinates_of(s);
    ASSERT_EQ(all.n_numbers(), 4);
    EXPECT_EQ(all.names_of_numbers()[3], "ball.rotation_vector_z");
    EXPECT_EQ(all.names_of_rates()[1], "ball.rotation_vector_x_rate");
    for (const Vector3& r : {Vector3{0, 0, 0}, {0.4, -1, 0.3}, {2, 1.5, -1}, {-2.9, 0.3, 0.2}}) {
        const GeneralisedState at = all.at(std::vector{0.7, r[0], r[1], r[2]});
        const Matrix3 arm = directors(at.state().X[0]), turned = directors(at.state().X[1]);
        EXPECT_LT(norm(transpose(arm) * turned - directors_from_rotation_vector(r)), 1e-11);
    }
    EXPECT_THROW(all.at(std::vector{0.7, 2.5, 2.5, 0.0}), InputError);
}

/// Lagrange's equations by differences of what tells energies alone.
TEST(RotationVector, AccelerationsAreLagranges)
{
    const Scenario s = scenario_of(on_arm);
    const GeneralisedCoordinates all = coordinates_of(s);
    const std::vector<double> q{0.7, 0.9, -0.6, 0.5}, v{0.8, -0.5, 1.1, 0.4};
    constexpr double h = 2e-3;
    const auto moved = [&](std::vector<double> x, std::size_t k, double by) {
        x[k] += by;
        return x;
    };
    const auto slope = [&](const auto& f) {   // to h^4
        return (8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h);
    };
    const GeneralisedState at = all.at(q, v);
    const std::vector<double> a = at.accelerations();
    for (std::size_t k = 0; k < 4; ++k) {
        // p_k = dT/dq'_k is linear in q', so that plain differences of T by rates are exact.
        const auto momentum = [&](double t) {
            std::vector<double> there = q, rates = v;
            for (std::size_t i = 0; i < 4; ++i) {
                there[i] += t * v[i] + 0.5 * t * t * a[i];
                rates[i] += t * a[i];
            }
            return 0.5 * (all.at(there, moved(rates, k, 1)).kinetic_energy() -
                          all.at(there, moved(rates, k, -1)).kinetic_energy());
        };
        const auto lagrangian = [&](double by) {
            const GeneralisedState there = all.at(moved(q, k, by), v);
            return there.kinetic_energy() - there.potential_energy();
        };
        EXPECT_NEAR(slope(momentum), slope(lagrangian), 1e-8 * 30) << k;
    }
    double energy = 0;
    const std::vector<double> M = at.mass_matrix();
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) energy += 0.5 * v[i] * M[4 * i + j] * v[j];
    EXPECT_NEAR(energy, at.kinetic_energy(), 1e-12);
}

}   // namespace

}   // namespace livens::rotation_vector_test
