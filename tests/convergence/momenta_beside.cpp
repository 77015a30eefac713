// SPDX-License-Identifier: BSD-3-Clause
// Momenta of all bodies at one end of time beside conditions by component at the other, against the motions
// that made the conditions.
#include <algorithm>
#include <string>
#include <vector>

#include "convergence/studies.h"
#include "livens/base/error.h"
#include "livens/multibody/state_quantities.h"
#include "newton_euler.h"

namespace livens::tests::momenta_beside_test {
namespace {

using At = Condition::At;
using Names = std::vector<std::string>;

struct Made {
    std::string name;
    Model model;
    double end;
    Names places, rates;
    Motion motion{};
};

Made made(std::string name, Model model, double before, double end, Names places, Names rates)
{
    State start = last(solve_evenly(model, before, 40, 8));
    start.t = 0;
    const Solution s = solve(model, {start}, make_time_mesh(0, end, 40), Lobatto{10});
    EXPECT_TRUE(s.report.converged()) << name << ": " << s.report.message;
    return {std::move(name), std::move(model), end, std::move(places), std::move(rates), s.motion};
}

std::vector<Made> all_made()
{
    return {made("links", hinged_links(), 0.2, 0.5, {"shoulder.angle", "elbow.angle"},
                 {"shoulder.angle_rate", "elbow.angle_rate"}),
            made("four-bar", four_bar(), 0.2, 0.4, {"crank shaft.angle"}, {"crank shaft.angle_rate"}),
            made("bricks", two_bricks(), 0.2, 0.3, {"upper.rotation", "lower.rotation"},
                 {"upper.angular_velocity", "lower.angular_velocity"}),
            made("box", free_box({0.3, 0.2, -0.1}), 0.5, 1, {"box.position", "box.rotation"},
                 {"box.velocity", "box.angular_velocity"})};
}

State faster(State state, double factor)
{
    for (Matrix34& V : state.V) V *= factor;
    return state;
}

/// Components at one end, momenta at the other; rates that are guesses are a share of the true ones.
livens::Problem problem_of(const Made& run, const Names& names, At at, double share = 0.9)
{
    const int n = run.motion.n_elements();
    const bool is_at_start = at == At::start;
    const State there = run.motion.at_end(is_at_start ? 0 : n),
                other = run.motion.at_end(is_at_start ? n : 0);
    livens::Problem problem;
    Conditions& c = problem.conditions;
    (is_at_start ? c.start : c.end) = faster(there, share);
    (is_at_start ? c.end : c.start) = other;
    c.at_start = is_at_start ? Known::nothing : Known::momenta;
    c.at_end = is_at_start ? Known::momenta : Known::nothing;
    std::vector<Matrix34> stated;
    for (const Body& body : run.model.bodies()) stated.push_back(body.X);
    for (const std::string& name : names)
        for (const StateQuantity& q : state_quantities(run.model, name))
            c.components.push_back({q, value_of(q, stated, there.X, there.V), at});
    return problem;
}

double off(const Made& run, const Solution& s)
{
    double worst = 0;
    for (int e = 0; e <= s.motion.n_elements(); ++e)
        worst = std::max(worst, distance(s.motion.at_end(e), run.motion.at(s.motion.mesh.ends[e])).X);
    return worst;
}

TEST(MomentaBesideComponents, GiveTheMotionThatHasThem)
{
    for (const Made& run : all_made())
        for (const At at : {At::start, At::end}) {
            const Solution s = solve(run.model, problem_of(run, run.places, at),
                                     make_time_mesh(0, run.end, 10), Lobatto{8, 0});
            ASSERT_TRUE(s.report.converged()) << run.name << ": " << s.report.message;
            EXPECT_LE(off(run, s), 1e-8) << run.name;
            tell(run.name + ": off by", off(run, s));
            const Solution from_rest = solve(run.model, problem_of(run, run.places, at, 0),
                                             make_time_mesh(0, run.end, 10), Lobatto{8, 0});
            ASSERT_TRUE(from_rest.report.converged()) << run.name << ": " << from_rest.report.message;
            EXPECT_LE(off(run, from_rest), 1e-8) << run.name;
        }
}

/// Rates at the start, and momenta that gravity has changed by the end: no place is known anywhere.
TEST(MomentaBesideComponents, MayStandBesideRates)
{
    for (const Made& run : all_made()) {
        if (run.name == "box") continue;   // which may be anywhere
        const Solution s = solve(run.model, problem_of(run, run.rates, At::start),
                                 make_time_mesh(0, run.end, 10), Lobatto{8, 0});
        ASSERT_TRUE(s.report.converged()) << run.name << ": " << s.report.message;
        EXPECT_LE(off(run, s), 1e-7) << run.name;
    }
}

TEST(MomentaBesideComponents, AreSolvedToAnAccuracy)
{
    for (const Made& run : all_made())
        for (const double accuracy : {1e-5, 1e-9}) {
            const Solution s = solve(run.model, problem_of(run, run.places, At::start),
                                     Span{0, run.end, accuracy}, Lobatto{0});
            ASSERT_TRUE(s.report.converged()) << run.name << ": " << s.report.message;
            EXPECT_LE(off(run, s), 3 * run.model.length() * accuracy) << run.name;
        }
}

/// One motion has the momenta of Newton and Euler, by an integrator that shares nothing with the engine.
TEST(MomentaBesideComponents, HoldAgainstAnotherIntegrator)
{
    const Model model = two_bricks();
    const NewtonEuler witness(model, [](double, Movers&) {}, {{world, {}, 0, {}}, {0, {1, 0, 0}, 1, {}}});
    Made run{"bricks", model, 0.3, {"upper.rotation", "lower.rotation"}, {}, {}};
    const State start = witness.run(0, 0.2, 60), end = witness.run(0, 0.5, 150);
    livens::Problem problem;
    problem.conditions.start = faster(start, 0.9);
    problem.conditions.end = end;
    problem.conditions.at_start = Known::nothing;
    problem.conditions.at_end = Known::momenta;
    std::vector<Matrix34> stated;
    for (const Body& body : model.bodies()) stated.push_back(body.X);
    for (const std::string& name : run.places)
        for (const StateQuantity& q : state_quantities(model, name))
            problem.conditions.components.push_back({q, value_of(q, stated, start.X, start.V), At::start});
    const Solution s = solve(model, problem, make_time_mesh(0, 0.3, 10), Lobatto{8, 0});
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_LE(distance(s.motion.at_end(0), start).V, 1e-8);
    EXPECT_LE(distance(s.motion.at_end(10), end).X, 1e-8);
}

/// Six numbers a body are stated, and all are compared: what joints do not let be is told.
TEST(MomentaBesideComponents, ThatAreNotMetAreTold)
{
    const Made run = all_made()[0];
    livens::Problem problem = problem_of(run, run.places, At::start);
    // at another place than the motion ends, so that joints hold other numbers
    State& end = problem.conditions.end;
    end = run.motion.at(0.6 * run.end);
    end.V = run.motion.at_end(run.motion.n_elements()).V;
    SolveOptions options;
    options.initial = StartPolicy::project;
    const Solution s = solve(run.model, problem, make_time_mesh(0, run.end, 10), Lobatto{8, 0}, options);
    EXPECT_EQ(s.report.status, SolveStatus::suspect) << s.report.message;
    EXPECT_NE(s.report.message.find("what is given at the end is not met: body '"), std::string::npos)
        << s.report.message;
    EXPECT_NE(s.report.message.find("moment"), std::string::npos) << s.report.message;
}

std::string code_of(const Model& model, const livens::Problem& problem)
{
    try {
        return std::string(
            to_string(solve(model, problem, make_time_mesh(0, 0.5, 10), Lobatto{8, 0}).report.status));
    } catch (const InputError& error) {
        return error.complaint().code + " at " + error.complaint().path;
    }
}

TEST(MomentaBesideComponents, ThatAreTooManyOrTooFewAreRefused)
{
    const Made run = all_made()[0];
    const livens::Problem right = problem_of(run, run.places, At::start);
    EXPECT_EQ(code_of(run.model, right), "converged");
    livens::Problem few = right, many = right, same = right, periodic = right, unknown = right;
    few.conditions.components.pop_back();
    EXPECT_EQ(code_of(run.model, few).substr(0, 18), "conditions-too-few");
    const StateQuantity rate = state_quantities(run.model, "elbow.angle_rate").at(0);
    many.conditions.components.push_back({rate, 0, At::start});
    EXPECT_EQ(code_of(run.model, many), "conditions-too-many at end.given");
    same.conditions.components.back() = {rate, 0, At::end};
    EXPECT_EQ(code_of(run.model, same), "boundary-conditions at end.known");
    periodic.conditions.is_periodic = true;
    EXPECT_EQ(code_of(run.model, periodic), "boundary-conditions at end.given");
    unknown.unknowns = {{{"length", 1}}, [](std::span<const double>) { return Rebuilt{}; }};
    EXPECT_EQ(code_of(run.model, unknown), "conditions-method at start.given");
    // a box in free flight may be anywhere with its rates
    const Made box = all_made()[3];
    const Solution anywhere = solve(box.model, problem_of(box, box.rates, At::start),
                                    make_time_mesh(0, box.end, 10), Lobatto{8, 0});
    EXPECT_NE(anywhere.report.status, SolveStatus::converged) << anywhere.report.message;
}

}   // namespace
}   // namespace livens::tests::momenta_beside_test
