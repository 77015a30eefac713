// SPDX-License-Identifier: BSD-3-Clause
// Joints that act for a part of the time between conditions: instants that are unknown, starts that are not
// known. References: the double pendulum in two angles by SciPy's DOP853 (1e-13), ballistic from the release,
// and brentq or fsolve for the instants.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "convergence/studies.h"
#include "livens/base/error.h"
#include "livens/multibody/loads.h"
#include "livens/multibody/state_quantities.h"

namespace livens::tests::released_test {
namespace {

using At = Condition::At;

constexpr double from_state =
    0.258339210755255;   // s, of the release that brings the stone to x = 9 m at 1 s
constexpr double at_ease = 0.14382781740600956, arrival = 0.8078316610450802;   // s, to x = 8 m, z = 1 m

/// An arm of 1 m with 2 kg at its tip, and a stone of 0.5 kg on a sling of 0.8 m, in the plane y = 0: both
/// are thrown over the top, and the sling lets go.
struct Sling {
    double release = 0.25, end = 1;
    double wind_until = 0;          ///< 1.5 N along x on the stone; 0: there is none
    double latch = 0;               ///< from then on a rod holds the arm's tip where it is; 0: none
    double arm = -9, sling = -12;   ///< rad/s
    Vector3 away{};                 ///< of the stone from where the sling holds it
};

std::shared_ptr<const Model> model_of(const Sling& s)
{
    const double b = std::numbers::pi - 0.5;
    Model model({0, 0, -9.81});
    const Vector3 x1{-1, 0, 0}, x2 = x1 + 0.8 * Vector3{std::cos(b), 0, std::sin(b)},
                                v1 = s.arm * Vector3{0, 0, -1},
                                v2 = v1 + 0.8 * s.sling * Vector3{-std::sin(b), 0, std::cos(b)};
    Body arm = point_mass("arm", 2, x1), stone = point_mass("stone", 0.5, x2 + s.away);
    arm.V.set_column(0, v1);
    stone.V.set_column(0, v2);
    const int first = model.add_body(arm), second = model.add_body(stone);
    model.add_joint(rod("axle", world, first, {}, 1));
    Joint sling = rod("sling", first, second, {}, 0.8);
    sling.until = s.release;
    model.add_joint(sling);
    for (const int body : {first, second})
        model.add_joint(point_in_plane(body == first ? "arm's plane" : "stone's plane", world, body,
                                       JointFrame{{}, {}, {0, 1, 0}, {0, 1, 0}}));
    if (s.latch > 0) {
        Joint latch = rod("latch", world, second, {}, 3);
        latch.from = s.latch;
        model.add_joint(latch);
    }
    if (s.wind_until > 0)
        model.add_load(
            point_force("wind", second, {}, window({1.5, 0, 0}, 0, s.wind_until), Frame::inertial));
    return std::make_shared<const Model>(std::move(model));
}

struct Stated {
    const char* name;
    double value;
    At at = At::end;
};

using Made = std::function<Sling(std::span<const double>)>;

Rebuilt rebuilt(const Sling& s, const std::vector<Stated>& stated)
{
    Rebuilt all{model_of(s), {}, 0, s.end, {}};
    for (const Stated& one : stated)
        all.components.push_back({state_quantities(*all.model, one.name).at(0), one.value, one.at});
    all.state = all.model->start();
    return all;
}

Problem problem_of(const std::vector<UnknownNumber>& numbers, const Made& made,
                   const std::vector<Stated>& stated, Known at_start = Known::state)
{
    std::vector<double> guesses;
    for (const UnknownNumber& number : numbers) guesses.push_back(number.guess);
    const Rebuilt first = rebuilt(made(guesses), stated);
    Problem problem{{first.state, at_start, {}, Known::nothing, first.components}};
    if (!numbers.empty())
        problem.unknowns = {numbers,
                            [=](std::span<const double> values) { return rebuilt(made(values), stated); }};
    return problem;
}

Solution solved(const Problem& problem, const Made& made, const Method& method = Lobatto{8, 0})
{
    std::vector<double> guesses;
    for (const UnknownNumber& number : problem.unknowns.numbers) guesses.push_back(number.guess);
    const Sling s = made(guesses);
    const auto model = model_of(s);
    SolveOptions options;
    options.tolerance = 1e-13;
    return solve(*model, problem, make_time_mesh(0, s.end, 30, model->load_breaks()), method, options);
}

/// The march through all phases with what was found, from the start that was found: it shares nothing with
/// the window but elements.
void expect_march_arrives(const Solution& s, const Model& model)
{
    SolveOptions options;
    options.tolerance = 1e-14;
    const Solution march = solve(model, {{s.motion.at_end(0)}}, s.motion.mesh, Lobatto{8}, options);
    ASSERT_TRUE(march.report.converged()) << march.report.message;
    ASSERT_EQ(march.motion.n_elements(), s.motion.n_elements());
    for (int e = 0; e <= s.motion.n_elements(); ++e)
        EXPECT_LE(distance(march.motion.at_end(e), s.motion.at_end(e)).X, 1e-9);
}

Sling released(std::span<const double> v) { return {v[0]}; }
Sling released_for(std::span<const double> v) { return {v[0], v[1]}; }

TEST(Releases, InstantThatHitsATargetIsFound)
{
    const Problem problem = problem_of({{"until", 0.2, 0.02, 0.6}}, released, {{"stone.x", 9}});
    const Solution s = solved(problem, released);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    tell("release off by, iterations " + std::to_string(s.report.newton_iterations),
         s.numbers.values[0] - from_state);
    EXPECT_NEAR(s.numbers.values[0], from_state, 1e-11);
    EXPECT_EQ(std::ranges::count(s.motion.mesh.ends, s.numbers.values[0]), 1);
    EXPECT_FALSE(s.estimate.empty());
    EXPECT_LE(s.estimate.largest, 1e-9);
    expect_march_arrives(s, *s.numbers.rebuilt.model);
    // control: a hundredth of a second later it misses by far
    const Problem late{{model_of({from_state + 0.01})->start()}};
    const auto model = model_of({from_state + 0.01});
    const Solution other = solve(*model, late, make_time_mesh(0, 1, 30, model->load_breaks()), Lobatto{8});
    EXPECT_GT(std::abs(other.motion.at_end(other.motion.n_elements()).X[1](0, 0) - 9), 0.1);
}

TEST(Releases, InstantAndArrivalAreFoundTogether)
{
    const Problem problem = problem_of({{"until", 0.15, 0.02, 0.6}, {"end", 0.9, 0.3, 2}}, released_for,
                                       {{"stone.x", 8}, {"stone.z", 1}});
    const Solution s = solved(problem, released_for);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_NEAR(s.numbers.values[0], at_ease, 1e-10);
    EXPECT_NEAR(s.numbers.values[1], arrival, 1e-10);
    EXPECT_EQ(s.motion.end(), s.numbers.values[1]);
    expect_march_arrives(s, *s.numbers.rebuilt.model);
}

TEST(Releases, ReactionsAndNotesAreThoseOfTheMarch)
{
    const Problem problem = problem_of({{"until", 0.2, 0.02, 0.6}}, released, {{"stone.x", 9}});
    const Solution s = solved(problem, released);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    const Solution march = solve(*s.numbers.rebuilt.model, {{s.motion.at_end(0)}}, s.motion.mesh, Lobatto{8});
    const auto note = [](const Solution& of) {
        for (const std::string& one : of.report.notes)
            if (one.find("'sling' is released at") != std::string::npos) return one;
        return std::string();
    };
    EXPECT_NE(note(s), "");
    EXPECT_EQ(note(s), note(march));
}

/// The load's end stays where it is while the release moves on the same side of it.
TEST(Releases, LoadsThatSwitchBesideThemKeepTheirInstant)
{
    const Made made = [](std::span<const double> v) {
        Sling s{v[0]};
        s.wind_until = 0.4;
        return s;
    };
    const Problem problem = problem_of({{"until", 0.2, 0.02, 0.6}}, made, {{"stone.x", 9}});
    const Solution s = solved(problem, made);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_NEAR(s.numbers.values[0], 0.266637635923708, 1e-10);   // DOP853 and brentq
    EXPECT_EQ(std::ranges::count(s.motion.mesh.ends, 0.4), 1);
    expect_march_arrives(s, *s.numbers.rebuilt.model);
}

TEST(Releases, ThatWouldPassAnotherSwitchStopThere)
{
    const Made made = [](std::span<const double> v) {
        Sling s{v[0]};
        s.wind_until = 0.23;
        return s;
    };
    const Problem problem = problem_of({{"until", 0.2, 0.02, 0.6}}, made, {{"stone.x", 9}});
    const Solution s = solved(problem, made);
    EXPECT_FALSE(s.report.converged());
    EXPECT_NE(s.report.message.find("a load or a joint switches"), std::string::npos) << s.report.message;
}

TEST(Releases, AtABoundThatDoesNotSufficeAreNamed)
{
    const Problem problem = problem_of({{"until", 0.2, 0.02, 0.22}}, released, {{"stone.x", 9}});
    const Solution s = solved(problem, released);
    EXPECT_FALSE(s.report.converged());
    EXPECT_NE(s.report.message.find("'until' has come to its upper bound 0.22"), std::string::npos)
        << s.report.message;
}

/// From a state that is known other numbers are found as well, of a model without events.
TEST(Releases, NumbersFromAKnownStateNeedNone)
{
    const Made made = [](std::span<const double> v) {
        Sling s{std::numeric_limits<double>::infinity(), v[0]};
        return s;
    };
    // where it is after 0.2 s, by DOP853
    const Problem problem = problem_of({{"end", 0.17, 0.05, 0.4}}, made, {{"stone.x", 0.45817115427702715}});
    const Solution s = solved(problem, made);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_NEAR(s.numbers.values[0], 0.2, 1e-11);
}

/// Positions at the start, and where the stone is after a second: 2 + 2 conditions, whatever acts later.
std::vector<Stated> aimed() { return {{"stone.x", 9.253988529940061}, {"stone.z", -8.104083275955484}}; }

Sling thrown_about(double share, double release = 0.25)
{
    Sling s{release};
    s.arm *= share;
    s.sling *= share;
    return s;
}

TEST(PhasesBetweenEnds, RatesThatThrowToATargetAreFound)
{
    for (const double share : {1.0, 0.9, 0.75}) {
        const Made made = [=](std::span<const double>) { return thrown_about(share); };
        const Solution s = solved(problem_of({}, made, aimed(), Known::positions), made);
        ASSERT_TRUE(s.report.converged()) << s.report.message;
        const State start = s.motion.at_end(0);
        EXPECT_NEAR(start.V[0](2, 0), 9, 1e-9) << share;
        EXPECT_NEAR(start.V[1](0, 0), 4.602485170600351, 1e-9) << share;
        EXPECT_NEAR(start.V[1](2, 0), 17.424792594147576, 1e-9) << share;
        expect_march_arrives(s, *model_of(thrown_about(share)));
    }
}

/// One more condition decides the release as well.
TEST(PhasesBetweenEnds, RatesAndAReleaseAreFoundTogether)
{
    const Made made = [](std::span<const double> v) { return thrown_about(0.95, v[0]); };
    std::vector<Stated> all = aimed();
    for (const Stated& one :
         {Stated{"arm.z", 0, At::start}, Stated{"stone.x", -1.7020660495122981, At::start},
          Stated{"arm.vz", 9, At::start}})
        all.push_back(one);
    const Solution s = solved(problem_of({{"until", 0.24, 0.1, 0.4}}, made, all, Known::nothing), made);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_NEAR(s.numbers.values[0], 0.25, 1e-9);
    expect_march_arrives(s, *s.numbers.rebuilt.model);
}

Solution to_accuracy(const Problem& problem, const Made& made, double accuracy)
{
    std::vector<double> guesses;
    for (const UnknownNumber& number : problem.unknowns.numbers) guesses.push_back(number.guess);
    const Sling s = made(guesses);
    return solve(*model_of(s), problem, Span{0, s.end, accuracy}, Lobatto{0});
}

/// As it is asked for, and told neither too small nor much too large.
void expect_told(const Solution& s, const std::vector<double>& truth, double accuracy)
{
    ASSERT_TRUE(s.report.converged()) << accuracy << ": " << s.report.message;
    EXPECT_LE(s.estimate.largest, accuracy);
    ASSERT_EQ(s.numbers.errors.size(), truth.size());
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const double error = std::abs(s.numbers.values[i] - truth[i]), told = s.numbers.errors[i];
        EXPECT_LE(error, accuracy);
        EXPECT_GE(told + 1e-13, 0.3 * error) << accuracy;
        EXPECT_LE(told, 30 * std::max(error, 1e-13)) << accuracy;
    }
}

TEST(Releases, AreFoundToAnAccuracy)
{
    const Problem one = problem_of({{"until", 0.2, 0.02, 0.6}}, released, {{"stone.x", 9}}),
                  two = problem_of({{"until", 0.15, 0.02, 0.6}, {"end", 0.9, 0.3, 2}}, released_for,
                                   {{"stone.x", 8}, {"stone.z", 1}});
    for (const double accuracy : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11}) {
        expect_told(to_accuracy(one, released, accuracy), {from_state}, accuracy);
        expect_told(to_accuracy(two, released_for, accuracy), {at_ease, arrival}, accuracy);
    }
    // wind that ends stays where it is
    const Made windy = [](std::span<const double> v) {
        Sling s{v[0]};
        s.wind_until = 0.4;
        return s;
    };
    const Solution s =
        to_accuracy(problem_of({{"until", 0.2, 0.02, 0.6}}, windy, {{"stone.x", 9}}), windy, 1e-9);
    expect_told(s, {0.266637635923708}, 1e-9);
    EXPECT_EQ(std::ranges::count(s.motion.mesh.ends, 0.4), 1);
    EXPECT_EQ(std::ranges::count(s.motion.mesh.ends, s.numbers.values[0]), 1);
}

/// Rates at the start against those that DOP853 threw with.
TEST(PhasesBetweenEnds, AreSolvedToAnAccuracy)
{
    for (const double accuracy : {1e-4, 1e-7, 1e-10}) {
        const Made made = [=](std::span<const double>) { return thrown_about(0.9); };
        const Solution s = to_accuracy(problem_of({}, made, aimed(), Known::positions), made, accuracy);
        expect_told(s, {}, accuracy);
        const Solution march = solve(*model_of(thrown_about(1)), {model_of(thrown_about(1))->start()},
                                     s.motion.mesh, Lobatto{14});
        ASSERT_EQ(march.motion.n_elements(), s.motion.n_elements());
        const double length = model_of(thrown_about(1))->length();
        double error = 0;
        for (int e = 0; e <= s.motion.n_elements(); ++e)
            error = std::max(error, distance(s.motion.at_end(e), march.motion.at_end(e)).X / length);
        EXPECT_LE(error, accuracy);
        EXPECT_LE(0.3 * error, s.estimate.largest + 1e-12) << accuracy;
        EXPECT_NEAR(s.motion.at_end(0).V[0](2, 0), 9, 1e2 * accuracy + 1e-9);
    }
}

std::string refused(const Problem& problem, const Made& made, const Method& method = Lobatto{8, 0})
{
    try {
        const Solution s = solved(problem, made, method);
        return std::string(s.report.converged() ? "solved" : "failed: ") + s.report.message;
    } catch (const InputError& error) {
        return error.complaint().code;
    }
}

TEST(PhasesBetweenEnds, AJointThatBeginsMustFindItsBodies)
{
    const Made made = [](std::span<const double>) {
        Sling s{0.25};
        s.latch = 0.5;
        return s;
    };
    const std::string what =
        refused(problem_of({}, made, {{"stone.z", -1}, {"arm.vz", 1}}, Known::positions), made);
    EXPECT_NE(what.find("begins to act at 0.5 s"), std::string::npos) << what;
    const Made moved = [](std::span<const double> v) {
        Sling s{0.25};
        s.latch = v[0];
        return s;
    };
    const std::string latch = refused(problem_of({{"from", 0.5, 0.3, 0.9}}, moved, {{"stone.x", 3}}), moved);
    EXPECT_NE(latch.find("'latch' begins to act at"), std::string::npos) << latch;
}

/// Two bodies fly side by side, a rod takes hold of them and lets go: wind on the first one moves the second
/// as long as it holds.
std::shared_ptr<const Model> towed(double until)
{
    Model model({0, 0, 0});
    for (const double x : {0.0, 1.0}) {
        Body body = point_mass(x == 0 ? "first" : "second", 1, {x, 0, 0});
        body.V.set_column(0, {0, 3, 0});
        model.add_body(body);
    }
    Joint tow = rod("tow", 0, 1, {}, 1);
    tow.from = 0.2;
    tow.until = until;
    model.add_joint(tow);
    model.add_load(point_force("wind", 0, {}, window({2, 0, 0}, 0.3, 1), Frame::inertial));
    return std::make_shared<const Model>(std::move(model));
}

TEST(PhasesBetweenEnds, AJointThatFindsItsBodiesTakesHoldOfThem)
{
    const auto made = [](std::span<const double> v) {
        Rebuilt all{towed(v[0]), {}, 0, 1, {}};
        // 1 m/s^2 for 0.4 s, and the rest of the second with what that gave
        all.components.push_back({state_quantities(*all.model, "second.x").at(0), 1.2, At::end});
        all.state = all.model->start();
        return all;
    };
    const Rebuilt first = made(std::vector{0.5});
    Problem problem{{first.state, Known::state, {}, Known::nothing, first.components}};
    problem.unknowns = {{{"until", 0.5, 0.31, 0.95}}, made};
    const Solution s =
        solve(*first.model, problem, make_time_mesh(0, 1, 10, first.model->load_breaks()), Lobatto{4, 0});
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_NEAR(s.numbers.values[0], 0.7, 1e-13);
    const Solution found = solve(*first.model, problem, Span{0, 1, 1e-9}, Lobatto{0});
    ASSERT_TRUE(found.report.converged()) << found.report.message;
    EXPECT_NEAR(found.numbers.values[0], 0.7, 1e-9);
}

/// What the rod takes at its beginning, a rate along it, can be anything before: no end tells it.
TEST(PhasesBetweenEnds, RatesThatAJointTakesAtItsBeginningAreNotDetermined)
{
    const auto model = towed(0.7);
    Problem problem{{model->start(), Known::positions, model->start(), Known::positions}};
    const double x[] = {0.29, 1.2};
    for (int b = 0; b < 2; ++b) problem.conditions.end.X[b].set_column(0, {x[b], 3, 0});
    const Solution s = solve(*model, problem, make_time_mesh(0, 1, 10, model->load_breaks()), Lobatto{4, 0});
    EXPECT_FALSE(s.report.converged());
    EXPECT_EQ(s.report.status, SolveStatus::singular) << s.report.message;
}

TEST(PhasesBetweenEnds, WhatIsNotSolvedIsRefusedByName)
{
    const Made made = [](std::span<const double>) { return Sling{}; };
    EXPECT_EQ(refused(problem_of({}, made, aimed(), Known::positions), made, Radau{6}), "joint-time-method");
    EXPECT_EQ(refused(problem_of({}, made, aimed(), Known::positions), made, Midpoint{}),
              "joint-time-method");
    Problem periodic = problem_of({}, made, {}, Known::nothing);
    periodic.conditions.is_periodic = true;
    EXPECT_EQ(refused(periodic, made), "joint-time-method");
    Problem momenta = problem_of({}, made, {}, Known::positions);
    momenta.conditions.end = momenta.conditions.start;
    momenta.conditions.at_end = Known::momenta;
    EXPECT_EQ(refused(momenta, made), "joint-time-method");
    // the stone's free flight has more places than the start has rates
    Problem places = momenta;
    places.conditions.at_end = Known::positions;
    EXPECT_EQ(refused(places, made), "conditions-too-many");
    EXPECT_EQ(refused(problem_of({}, made, {{"stone.x", 9}}, Known::positions), made), "conditions-too-few");
    EXPECT_EQ(refused(problem_of({{"until", 0.2}}, released, {{"stone.x", 9}, {"stone.z", 1}}), released),
              "conditions-too-many");
    EXPECT_EQ(refused(problem_of({{"until", 0.2}}, released, {}), released), "unknown-march");
    // behind the end of time
    EXPECT_EQ(refused(problem_of({{"until", 2}}, released, {{"stone.x", 9}}), released), "unknown-unseen");
}

}   // namespace
}   // namespace livens::tests::released_test
