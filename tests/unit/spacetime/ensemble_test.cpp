// SPDX-License-Identifier: BSD-3-Clause
// Many motions at a time are those of one at a time.
#include "livens/multibody/model.h"
#include "livens/spacetime/ensemble.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numeric>
#include <stdexcept>
#include <thread>

#include "livens/base/error.h"
#include "livens/multibody/joints.h"

namespace livens::ensemble_test {
namespace {

Model pendulum(double angle)
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("bob", 1, {std::sin(angle), 0, -std::cos(angle)}));
    model.add_joint(rod("rod", world, 0, {}, 1));
    return model;
}

std::vector<Variation> variations(const Model& model, int n)
{
    std::vector<Variation> all;
    for (int i = 0; i < n; ++i) {
        Variation& one = all.emplace_back();   // in place: GCC 12 warns of a temporary's members
        one.model = &model;
        one.problem.conditions.start = model.start();
        one.time = make_time_mesh(0, 1, 5 + i);
        one.problem.conditions.start.V[0] = (0.1 * i) * configuration({0, 1, 0}, Matrix3{});
        if (i % 3 == 1) one.method = Radau{3};
        if (i % 3 == 2) one.time = Span{0, 1, 1e-7};
        if (i % 3 == 2) one.method = Lobatto{0};
    }
    return all;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

TEST(Ensemble, SolutionsDoNotDependOnTheNumberOfThreads)
{
    const Model model = pendulum(1);
    const std::vector<Variation> all = variations(model, 17);
    const std::vector<Solution> alone = solve_all(all, 1);
    for (const int n_threads : {0, 2, 3, 16}) {
        const std::vector<Solution> together = solve_all(all, n_threads);
        ASSERT_EQ(together.size(), all.size());
        for (std::size_t i = 0; i < all.size(); ++i) {
            EXPECT_TRUE(together[i].report.converged()) << together[i].report.message;
            EXPECT_TRUE(same_bits(together[i].motion.X.values, alone[i].motion.X.values)) << i;
            EXPECT_TRUE(same_bits(together[i].motion.end_multipliers, alone[i].motion.end_multipliers)) << i;
            EXPECT_EQ(together[i].estimate.largest, alone[i].estimate.largest);
        }
    }
    EXPECT_FALSE(same_bits(alone[3].motion.X.values, alone[6].motion.X.values)) << "they differ at all";
    EXPECT_TRUE(solve_all({}, 4).empty());
}

TEST(Ensemble, ThrowsWhatTheFirstByItsPlaceThrows)
{
    const Model model = pendulum(1);
    std::vector<Variation> all = variations(model, 9);
    all[4].method = Lobatto{99};
    all[7].method = Radau{77};
    for (const int n_threads : {1, 2, 5}) {
        try {
            solve_all(all, n_threads);
            ADD_FAILURE() << "nothing was thrown";
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find("99"), std::string::npos) << error.what();
        }
    }
}

TEST(RunInOrder, DoesAllAndIsDoneInOrderOnTheCallingThread)
{
    for (const int n_threads : {1, 2, 7, 100}) {
        std::vector<std::atomic<int>> worked(50);
        std::vector<int> done;
        const std::thread::id here = std::this_thread::get_id();
        run_in_order(
            50, n_threads,
            [&](int i) {
                if (i % 10 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(3));
                ++worked[i];
            },
            [&](int i) {
                EXPECT_EQ(std::this_thread::get_id(), here);
                EXPECT_EQ(worked[i], 1);
                done.push_back(i);
            });
        std::vector<int> expected(50);
        std::iota(expected.begin(), expected.end(), 0);
        EXPECT_EQ(done, expected);
    }
}

TEST(RunInOrder, WorksOnSeveralThreadsAtOnce)
{
    std::atomic<int> here{0};
    run_in_order(
        2, 2,
        [&](int) {   // ends only if both are there
            ++here;
            for (int i = 0; i < 10000 && here < 2; ++i)
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
        },
        [](int) {});
    EXPECT_EQ(here, 2);
}

TEST(RunInOrder, BeginsNothingMoreBehindWhatIsThrown)
{
    for (const int n_threads : {1, 3}) {
        std::atomic<int> begun{0};
        int done = 0;
        const auto work = [&](int i) {
            ++begun;
            if (i == 2) throw std::runtime_error("two");
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        };
        EXPECT_THROW(run_in_order(100000, n_threads, work, [&](int) { ++done; }), std::runtime_error);
        EXPECT_EQ(done, 2);
        EXPECT_LT(begun, 100000);
        begun = done = 0;
        const auto refuse = [&](int) {
            if (++done == 3) throw std::logic_error("enough");
        };
        EXPECT_THROW(run_in_order(
                         100000, n_threads, [&](int) { ++begun; }, refuse),
                     std::logic_error);
        EXPECT_EQ(done, 3);
    }
}

TEST(RunInOrder, AsManyThreadsAsProcessorsByDefault)
{
    EXPECT_EQ(threads_for(3), 3);
    EXPECT_GE(threads_for(0), 1);
}

}   // namespace
}   // namespace livens::ensemble_test
