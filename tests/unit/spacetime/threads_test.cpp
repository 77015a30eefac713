// SPDX-License-Identifier: BSD-3-Clause
// One motion by several threads: the same bits, the same errors, and an end when it is asked for.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

#include "livens/base/error.h"
#include "livens/multibody/loads.h"
#include "livens/multibody/model.h"
#include "livens/spacetime/solve.h"
#include "sanitized.h"
#include <mechanisms.h>   // those of all tests

namespace livens::threads_test {
namespace {

struct Case {
    std::string name;
    Model model;
    Problem problem;
    TimeMesh mesh;
    Method method;
};

/// All that a motion holds, and what was told of it.
std::vector<double> numbers_of(const Solution& solution)
{
    std::vector<double> numbers;
    const Motion& motion = solution.motion;
    for (int e = 0; e <= motion.n_elements(); ++e)
        for (const State& state : {motion.at_end(e), motion.at(motion.mesh.ends[e] * 0.999)})
            for (const auto* matrices : {&state.X, &state.V})
                for (const Matrix34& x : *matrices) numbers.insert(numbers.end(), x.a, x.a + 12);
    for (const auto* matrices : {&motion.momenta, &motion.accelerations})
        for (const Matrix34& x : *matrices) numbers.insert(numbers.end(), x.a, x.a + 12);
    for (const auto* values : {&motion.multipliers.values, &motion.end_multipliers, &motion.load_angles})
        numbers.insert(numbers.end(), values->begin(), values->end());
    const SolveReport& report = solution.report;
    numbers.insert(numbers.end(), {static_cast<double>(report.newton_iterations), report.residual_norm,
                                   report.moved_by_rounding, report.arrival, solution.estimate.largest,
                                   report.smallest_pivot});
    return numbers;
}

Solution solved(const Case& one, int threads, const SolveOptions& given = {})
{
    SolveOptions options = given;
    options.threads = threads;
    return solve(one.model, one.problem, one.mesh, one.method, options);
}

/// The state that the motion from the start comes to.
State arrival(const Model& model, double end)
{
    SolveOptions options;
    options.judge = false;
    const Solution solution = solve(model, {model.start()}, make_time_mesh(0, end, 40), Lobatto{6}, options);
    return solution.motion.at_end(40);
}

/// A crank that turns against a spring which counts its turns, in a loop.
Model wound_up()
{
    Model model = tests::four_bar();
    const Joint& shaft = model.joints().front();
    model.add_load(joint_spring("spring", shaft.coordinates[0], {0.02, 0.001, 0.3}, model.start().X));
    return model;
}

std::vector<Case> cases()
{
    std::vector<Case> all;
    const auto add = [&](const std::string& name, const Model& model, Conditions conditions, int n,
                         const Method& method) {
        const double end = 0.4;
        conditions.start = model.start();
        conditions.end = arrival(model, end);
        all.push_back({name, model, {conditions}, make_time_mesh(0, end, n), method});
    };
    Conditions of_start, of_places, mixed_ends;
    of_places.at_start = of_places.at_end = mixed_ends.at_start = Known::positions;
    mixed_ends.at_end = Known::momenta;
    add("window from a state", tests::two_bricks(), of_start, 60, Lobatto{3, 0});
    add("window of a loop with redundant rows and a spring", wound_up(), of_start, 90, Lobatto{4, 0});
    add("windows of some elements", tests::cubes_on_rods(0.2), of_start, 90, Lobatto{4, 32});
    add("places at both ends", tests::hinged_links(), of_places, 60, Lobatto{4});
    add("places, then momenta, of cubes", tests::cubes_on_rods(0.2), mixed_ends, 50, Lobatto{5});
    add("eight bricks, along their joints", tests::hanging_bricks(8), of_places, 12, Lobatto{6});
    add("eight bricks from a state", tests::hanging_bricks(8), of_start, 40, Lobatto{4, 0});
    add("a loop between places", tests::four_bar(), of_places, 40, Lobatto{3});
    Mixed linear;
    linear.degree = 1;
    add("elements of the paper", tests::cubes_on_rods(0), of_start, 64, linear);
    Mixed cubic;
    cubic.degree = 3;
    cubic.basis = Mixed::Basis::bspline;
    cubic.window = 40;
    add("splines, in blocks", tests::two_bricks(), of_start, 80, cubic);
    Mixed between;
    add("elements of the paper between places", tests::hinged_links(), of_places, 40, between);
    return all;
}

TEST(Threads, LeaveNoTraceInTheBitsOfMotions)
{
    for (const Case& one : cases()) {
        const Solution alone = solved(one, 1);
        ASSERT_TRUE(alone.report.reached_end()) << one.name << ": " << alone.report.message;
        const std::vector<double> expected = numbers_of(alone);
        for (const int threads : {2, 3, 7}) {
            const std::vector<double> found = numbers_of(solved(one, threads));
            ASSERT_EQ(found.size(), expected.size());
            EXPECT_EQ(std::memcmp(found.data(), expected.data(), found.size() * sizeof(double)), 0)
                << one.name << ", " << threads << " threads";
        }
    }
}

/// Elements that are too long for the motion: some in the middle are not believed, and what is left is told
/// as one thread tells it.
TEST(Threads, LeaveNoTraceWhereElementsAreRefused)
{
    const Model model = tests::two_bricks();
    Conditions of_start;
    of_start.start = model.start();
    const Case one{"coarse", model, {of_start}, make_time_mesh(0, 24, 48), Lobatto{3, 0}};
    const Solution alone = solved(one, 1);
    const std::vector<double> expected = numbers_of(alone);
    for (const int threads : is_sanitized ? std::vector<int>{3} : std::vector<int>{2, 3}) {
        const Solution shared = solved(one, threads);
        EXPECT_EQ(shared.report.message, alone.report.message);
        EXPECT_EQ(shared.motion.n_elements(), alone.motion.n_elements());
        const std::vector<double> found = numbers_of(shared);
        ASSERT_EQ(found.size(), expected.size());
        EXPECT_EQ(std::memcmp(found.data(), expected.data(), found.size() * sizeof(double)), 0) << threads;
    }
}

TEST(Threads, AreStoppedInTime)
{
    Case one = cases()[1];
    one.mesh = make_time_mesh(0, 0.4, 4000);
    for (const int threads : {1, 2, 3}) {
        SolveOptions options;
        int n = 0;
        std::clock_t asked = 0;
        options.progress = [&](const Progress&) {
            if (++n < 5) return true;
            if (asked == 0) asked = std::clock();
            return false;
        };
        const Solution stopped = solved(one, threads, options);
        EXPECT_EQ(stopped.report.status, SolveStatus::cancelled);
        EXPECT_LT(static_cast<double>(std::clock() - asked) / CLOCKS_PER_SEC, 2);
    }
}

TEST(Threads, ThatCannotBeAreRefused)
{
    const Case one = cases()[0];
    for (const int threads : {-1, 100'000}) {
        try {
            solved(one, threads);
            FAIL() << threads;
        } catch (const InputError& error) {
            EXPECT_EQ(error.complaint().code, "threads-out-of-range");
            EXPECT_EQ(error.complaint().path, "method.threads");
        }
    }
}

}   // namespace
}   // namespace livens::threads_test
