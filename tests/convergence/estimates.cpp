// SPDX-License-Identifier: BSD-3-Clause
// The estimated error of a run against its true one, and elements that are refused.
#include <numbers>

#include "convergence/studies.h"
#include "livens/base/error.h"

namespace livens::tests::estimates_test {
namespace {

Solution solved(const Model& model, double end, int n, const Method& method)
{
    return solve(model, {model.start()}, make_time_mesh(0, end, n), method);
}

/// Largest error of centres of mass by the model's length, and of directors' turns, at the end.
double true_error(const Model& model, const State& a, const State& exact)
{
    double error = 0;
    for (int b = 0; b < model.n_bodies(); ++b) {
        const Matrix34 d = a.X[b] - exact.X[b];
        error = std::max(error, norm(d * point(mass_properties(model.bodies()[b].mass).center_of_mass)) /
                                    model.length());
        error = std::max(error, 2 * std::asin(std::min(norm(directors(d)) / std::sqrt(8.0), 1.0)));
    }
    return error;
}

double last_estimate(const Solution& s)
{
    double error = 0;
    const auto n = static_cast<std::size_t>(s.estimate.n_bodies);
    for (std::size_t i = s.estimate.position.size() - n; i < s.estimate.position.size(); ++i)
        error = std::max({error, s.estimate.position[i], s.estimate.orientation[i]});
    return error;
}

TEST(Estimates, AreTheTrueErrorWithinAFactorOfThree)
{
    const Model model = two_bricks();
    const State exact = fine(model, 1, 50).end;
    const struct {
        Method method;
        std::vector<int> n;
    } cases[] = {{Lobatto{1}, {100, 200}}, {Lobatto{2}, {30, 60}},   {Lobatto{4}, {15, 22}},
                 {Lobatto{7}, {10, 14}},   {Midpoint{}, {200, 500}}, {Endpoint{}, {1000, 2000}}};
    for (const auto& [method, meshes] : cases)
        for (const int n : meshes) {
            const Solution s = solved(model, 1, n, method);
            ASSERT_FALSE(s.estimate.empty()) << name_of(method) << ", " << n << ": " << s.report.message;
            const double error = true_error(model, last(s), exact), told = last_estimate(s);
            EXPECT_LE(told, 3 * error) << name_of(method) << ", " << n;
            EXPECT_GE(told, error / 3) << name_of(method) << ", " << n;
            EXPECT_GE(s.verdict.estimated_error, told);
        }
}

TEST(Estimates, OfReactionsDoNotDependOnTheUnitOfLength)
{
    const auto estimate = [](double unit) {   // units a metre
        Model model({0, 3 * unit, -9.81 * unit});
        const double size = 0.5 * unit;
        Placement place;
        place.position = {size, 0, 0};
        place.velocity = {0, 0, -2 * size};
        place.angular_velocity = {0, 2, 0};
        model.add_body(
            rigid_body("door", box(1000 / (unit * unit * unit), {2 * size, 0.1 * size, size}), place));
        JointFrame hinge;
        hinge.axis_first = hinge.axis_second = {0, 1, 0};
        hinge.point_second = {-size, 0, 0};
        model.add_joint(revolute("hinge", world, 0, hinge));
        const Solution s = solved(model, 0.5, 10, Lobatto{2});
        return s.estimate.reaction.empty() ? 0 : s.estimate.reaction.back();
    };
    EXPECT_GT(estimate(1), 1e-8);
    EXPECT_NEAR(estimate(1000), estimate(1), 1e-4 * estimate(1));
}

TEST(Estimates, DoNotTakeErrorsThatAreAlikeForNone)
{
    // errors of degrees 13 and 14 are 2.79e-8 and 2.64e-8, of 15 1.4e-9: elements too long for their degree
    const Model model = cubes_on_rods(0.1);
    const State exact = fine(model, 5, 200).end;
    const Solution s = solved(model, 5, 19, Lobatto{13}), next = solved(model, 5, 19, Lobatto{14});
    const double error = true_error(model, last(s), exact), of_next = true_error(model, last(next), exact);
    EXPECT_GT(of_next, 0.9 * error);
    EXPECT_LT(of_next, 1.1 * error);
    EXPECT_GE(last_estimate(s), error / 3);
    EXPECT_LE(last_estimate(s), 3 * error);
}

TEST(Estimates, ThatTheSecondSolutionIsTooCoarseForAreSuspect)
{
    // below 1e-2, but with a jump of 0.2, or with more energy off than the error would make
    Model pendulum({0, -9.81, 0});
    pendulum.add_body(point_mass("bob", 1, {-1, 0, 0}));
    pendulum.add_joint(rod("rod", world, 0, {}, 1));
    const Solution long_elements =
        solve(pendulum, {pendulum.start()}, make_time_mesh(0, 23.6784194757623745, 9), Lobatto{9});
    const Model bricks = two_bricks();
    const Solution lossy = solve(bricks, {bricks.start()}, make_time_mesh(0, 2, 12), Lobatto{7});
    EXPECT_GT(long_elements.verdict.velocity_jump, 0.1);
    EXPECT_GT(lossy.verdict.energy_drift, lossy.estimate.largest);
    for (const Solution* s : {&long_elements, &lossy}) {
        EXPECT_LT(s->estimate.largest, 1e-2);
        EXPECT_EQ(s->report.status, SolveStatus::suspect);
        EXPECT_NE(s->report.message.find("may be too small"), std::string::npos) << s->report.message;
    }
}

TEST(Estimates, OfAMarchInPiecesIsThatOfTheWhole)
{
    // more elements than are kept of the second solution at once, from either end
    Model model({0, 0, -9.81});
    model.add_body(point_mass("bob", 1, {1, 0, 0}));
    model.add_joint(rod("rod", world, 0, {}, 1));
    const Solution s = solved(model, 2, 9000, Lobatto{1});
    const Solution finer = solved(model, 2, 9000, Lobatto{2});
    ErrorMeter meter(model, s.motion);
    meter.compare(finer.motion, 0, s.motion.n_elements());
    const ErrorEstimate whole = meter.take(s.motion.n_elements());
    ASSERT_EQ(s.estimate.position.size(), whole.position.size());
    for (std::size_t i = 0; i < whole.position.size(); i += 100)
        EXPECT_NEAR(s.estimate.position[i], whole.position[i], 1e-11) << i;
    EXPECT_NEAR(s.estimate.reaction.back(), whole.reaction.back(), 1e-9);

    Conditions back;
    back.at_start = Known::nothing;
    back.at_end = Known::state;
    back.end = last(finer);
    const Solution backwards = solve(model, {back}, make_time_mesh(0, 2, 9000), Lobatto{1});
    ASSERT_FALSE(backwards.estimate.empty());
    EXPECT_LE(backwards.estimate.position.back(), 1e-14) << "the end is given";
    EXPECT_GT(backwards.estimate.position.front(), 1e-9);
}

/// Errors of elements alone say nothing once they grow: the estimate by them does.
TEST(Estimates, OfElementsGrowAsTheMotionDoes)
{
    SolveOptions local;
    local.estimate = SolveOptions::Estimate::local;
    const Model chaotic = cubes_on_rods(0);
    double apart = 0;
    for (const auto& [end, n, method] : {std::tuple<double, int, Method>{2, 60, Lobatto{4}},
                                         {20, 600, Lobatto{5}},
                                         {2, 60, Radau{4}},
                                         {12, 400, Radau{5}}}) {
        const TimeMesh mesh = make_time_mesh(0, end, n);
        const Solution s = solve(chaotic, {chaotic.start()}, mesh, method, local);
        const Solution fine = solve(chaotic, {chaotic.start()}, mesh, Lobatto{10});
        ASSERT_TRUE(s.report.converged() && fine.report.converged()) << s.report.message;
        ErrorMeter meter(chaotic, s.motion);
        meter.compare(fine.motion, 0, n);
        const double truth = meter.so_far().largest;
        EXPECT_GE(s.estimate.largest, truth / 5) << name_of(method) << ' ' << end;
        EXPECT_LE(s.estimate.largest, truth * 50) << name_of(method) << ' ' << end;
        EXPECT_TRUE(std::isnan(s.estimate.velocity.front()) && s.estimate.reaction.empty());
        double sum = 0;   // a control: what is lost, without what it becomes
        for (const double jump : velocity_jumps(chaotic, s.motion))
            sum += local_error(s.motion.X.points, s.motion.X.degree, jump);
        apart = std::max(apart, truth / sum);
    }
    EXPECT_GT(apart, 100);
}

TEST(Estimates, OfElementsAreForMarchesOfNodalElements)
{
    const Model model = cubes_on_rods(0);
    SolveOptions local;
    local.estimate = SolveOptions::Estimate::local;
    const TimeMesh mesh = make_time_mesh(0, 0.1, 4);
    Model sprung = model;   // the force of a spring depends on the motion, and so do dampers'
    sprung.add_load(spring_damper("spring", 0, {0, 0, 0}, world, {0, 0, 1}, {.stiffness = 100}));
    const auto code_of = [&](const Problem& problem, const Time& time, const Method& method,
                             const Model* other = nullptr) {
        try {
            solve(other != nullptr ? *other : model, problem, time, method, local);
        } catch (const InputError& error) {
            return error.complaint().code;
        }
        return std::string();
    };
    const Problem march{{model.start()}}, back{{model.start(), Known::nothing, model.start(), Known::state}};
    for (const Method& method : {Method(Mixed{}), Method(Midpoint{}), Method(Endpoint{})})
        EXPECT_EQ(code_of(march, mesh, method), "estimate-method");
    EXPECT_EQ(code_of(back, mesh, Lobatto{4}), "estimate-method");
    EXPECT_EQ(code_of(march, Span{0, 0.1, 1e-6}, Lobatto{4}), "accuracy-elements");
    EXPECT_EQ(code_of(march, mesh, Lobatto{4}), "");
    EXPECT_EQ(code_of(march, mesh, Lobatto{4}, &sprung), "estimate-method");
}

TEST(Estimates, AreNotSoldWhereThereIsNone)
{
    const Model model = two_bricks();
    SolveOptions options;
    options.estimate = SolveOptions::Estimate::none;
    const Solution s = solve(model, {model.start()}, make_time_mesh(0, 1, 20), Lobatto{4}, options);
    EXPECT_TRUE(s.estimate.empty());
    EXPECT_TRUE(std::isnan(s.verdict.estimated_error));
    EXPECT_TRUE(s.report.converged());
}

TEST(Estimates, AMotionThatIsRadiansOffIsSuspect)
{
    const Model model = two_bricks();
    const Solution coarse = solved(model, 10, 60, Lobatto{2});
    EXPECT_EQ(coarse.report.status, SolveStatus::suspect);
    EXPECT_GT(coarse.verdict.estimated_error, 1e-2);
}

/// Without refusal 10 elements of degree 16 meet a root that is none, 2 rad off (docs/theory.md).
TEST(Refusals, DivideElementsThatMeetARootThatIsNone)
{
    Model model;
    Placement placement;
    placement.angular_velocity = {0.1, 15, 0.1};
    model.add_body(rigid_body("top", box(1000, {0.1, 0.2, 0.3}), placement));
    SolveOptions raw;
    raw.judge = raw.divide = false;
    const State exact = last(solve(model, {model.start()}, make_time_mesh(0, 4, 200), Lobatto{12}, raw));
    int divided = 0, wrong = 0;
    for (int n = 4; n <= 24; ++n)
        for (const int degree : {4, 8, 12, 16}) {
            const Solution s = solved(model, 4, n, Lobatto{degree});
            divided += s.report.divided > 0;
            const Solution as_it_comes =
                solve(model, {model.start()}, make_time_mesh(0, 4, n), Lobatto{degree}, raw);
            wrong += !as_it_comes.report.converged() || true_error(model, last(as_it_comes), exact) > 0.1;
            if (!s.report.converged()) continue;
            EXPECT_LE(true_error(model, last(s), exact), 10 * last_estimate(s) + 1e-9) << n << ", " << degree;
        }
    EXPECT_GE(divided, 5);
    EXPECT_GE(wrong, 5) << "negative control: nothing was there to be refused";
}

/// A ball about its own axis, 5 rad an element: whoever takes the elements that are given does not see it, or
/// has to say so.
TEST(Estimate, OfABallThatSpinsFiveRadiansAnElementIsNeverGoodAndWrong)
{
    Model model;
    Placement placement;
    placement.angular_velocity = {0, 0, 50};
    model.add_body(rigid_body("ball", {1, {}, 0.004 * identity<3>()}, placement));
    std::vector<Method> methods{Midpoint{}, Endpoint{}};
    for (int degree = 1; degree <= 16; ++degree) methods.emplace_back(Lobatto{degree});
    for (int degree = 1; degree <= 8; ++degree) methods.emplace_back(Radau{degree});
    int n_good = 0;
    for (const Method& method : methods)
        for (const bool divide : {true, false}) {
            SolveOptions options;
            options.divide = divide;
            const Solution s = solve(model, {model.start()}, make_time_mesh(0, 2, 20), method, options);
            if (!s.report.converged()) continue;
            ++n_good;
            const double c = std::cos(100.0), d = std::sin(100.0);
            const double off =
                norm(directors(s.motion.at(2).X[0]) - Matrix3{c, d, 0, -d, c, 0, 0, 0, 1}) / std::sqrt(2.0);
            EXPECT_LE(off, 10 * s.estimate.largest + 1e-9) << n_good;
            EXPECT_LE(off, 2e-2) << n_good;
        }
    tell("methods that were called good, and were, of 52", n_good);
    EXPECT_GT(n_good, 0);
    EXPECT_LT(n_good, 52);
}

}   // namespace
}   // namespace livens::tests::estimates_test
