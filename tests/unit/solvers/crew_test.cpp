// SPDX-License-Identifier: BSD-3-Clause
// Threads that share loops: all is done once, nothing depends on their number, and all of them can be
// stopped.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <ctime>
#include <functional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "livens/solvers/crew.h"
#include "livens/solvers/patience.h"

namespace livens::crew_test {
namespace {

TEST(Crew, HasAllItemsOnceInSharesThatFollowEachOther)
{
    for (const int threads : {0, 1, 2, 3, 7}) {
        const Crew crew(threads);
        for (const int n : {0, 1, 5, 16, 1000}) {
            std::vector<int> times(static_cast<std::size_t>(n), 0), slots(times);
            in_shares(n, 1, [&](int slot, int begin, int end) {
                for (int i = begin; i < end; ++i) {
                    ++times[static_cast<std::size_t>(i)];
                    slots[static_cast<std::size_t>(i)] = slot;
                }
            });
            EXPECT_EQ(times, std::vector<int>(static_cast<std::size_t>(n), 1));
            EXPECT_TRUE(std::is_sorted(slots.begin(), slots.end()));
            if (n == 1000) {
                EXPECT_EQ(slots.back(), std::max(threads, 1) - 1) << "not all threads had a share";
            }
        }
    }
}

TEST(Crew, LeavesShortLoopsToTheOneWhoAsks)
{
    const Crew crew(3);
    in_shares(15, 8, [&](int slot, int begin, int end) {
        EXPECT_EQ(slot, 0);
        EXPECT_EQ(end - begin, 15);
    });
    int n_shares = 0;
    in_shares(3, 1, [&](int, int, int) { EXPECT_EQ(Crew::size(), 1) << "a crew inside of shares"; });
    in_shares(1, 1, [&](int, int, int) { ++n_shares; });
    EXPECT_EQ(n_shares, 1);
    EXPECT_EQ(Crew::size(), 3);
}

TEST(Crew, ThrowsWhatOneThreadWouldHaveThrown)
{
    for (const int threads : {1, 2, 3, 7}) {
        const Crew crew(threads);
        std::string thrown;
        try {
            for_each_item(100, 1, [](int i) {
                if (i == 12 || i == 60 || i == 95) throw std::runtime_error(std::to_string(i));
            });
        } catch (const std::runtime_error& error) {
            thrown = error.what();
        }
        EXPECT_EQ(thrown, "12") << threads << " threads";
        int n = 0;   // and goes on
        in_shares(100, 100, [&](int, int begin, int end) { n += end - begin; });
        EXPECT_EQ(n, 100);
    }
}

/// Number of threads, and what a loop's part in order is said to cost of the other one.
class LoopsInOrder : public testing::TestWithParam<std::tuple<int, double>> {
protected:
    LoopInOrder loop(int n) const { return {n, 1, std::get<1>(GetParam())}; }

    const Crew crew{std::get<0>(GetParam())};
};

INSTANTIATE_TEST_SUITE_P(Crew, LoopsInOrder,
                         testing::Combine(testing::Values(1, 2, 3, 7), testing::Values(0.0, 0.3, 5.0)));

constexpr int n_items = 500;

/// Work that takes longer for some items.
double value_of(int i)
{
    double value = 0;
    for (int k = 0; k <= 100 * (i % 7); ++k) value += 1.0 / (1 + i + k);
    return value;
}

/// What follows comes in order, once and behind the work of its item, whoever does it; its sum, whose order
/// counts, has the same bits for any number of threads.
TEST_P(LoopsInOrder, WhatFollowsComesBehindItsWork)
{
    std::vector<double> made(n_items, -1);
    std::vector<std::atomic<int>> times(n_items);
    int next = 0;
    double sum = 0, alone = 0;
    EXPECT_TRUE(in_order_behind(
        loop(n_items),
        [&](int slot, int i) {
            EXPECT_LT(slot, std::get<0>(GetParam()));
            made[i] = value_of(i);
            ++times[i];
        },
        [&](int i) {
            EXPECT_EQ(i, next++);
            sum = 0.9 * sum + made[i];
            return true;
        }));
    EXPECT_EQ(next, n_items);
    for (int i = 0; i < n_items; ++i) {
        EXPECT_EQ(times[i], 1);
        alone = 0.9 * alone + value_of(i);
    }
    EXPECT_EQ(sum, alone);
}

TEST_P(LoopsInOrder, WhatComesFirstComesAheadOfItsWork)
{
    std::vector<double> led(n_items, -1), made(n_items, -1);
    std::vector<std::atomic<int>> times(n_items);
    int next = 0;
    in_order_ahead(
        loop(n_items),
        [&](int i) {
            EXPECT_EQ(i, next++);
            led[i] = (i > 0 ? 0.5 * led[i - 1] : 1) + value_of(i);
        },
        [&](int slot, int i) {
            EXPECT_LT(slot, std::get<0>(GetParam()));
            made[i] = 2 * led[i];
            ++times[i];
        });
    EXPECT_EQ(next, n_items);
    double alone = 0;
    for (int i = 0; i < n_items; ++i) {
        EXPECT_EQ(times[i], 1);
        alone = (i > 0 ? 0.5 * alone : 1) + value_of(i);
        EXPECT_EQ(made[i], 2 * alone);
    }
}

TEST_P(LoopsInOrder, EndWhereTheyAreTold)
{
    int last = -1;
    const auto nothing = [](int, int) {};
    const auto up_to = [&](int i) {
        last = i;
        return i < 37;
    };
    EXPECT_FALSE(in_order_behind(loop(n_items), nothing, up_to));
    EXPECT_EQ(last, 37);
}

TEST_P(LoopsInOrder, ThrowWhatIsThrown)
{
    int last = -1;
    const auto refuse = [](int i) {
        if (i == 12) throw std::runtime_error("12");
        return true;
    };
    const auto see = [&](int i) {
        last = i;
        return true;
    };
    const auto nothing = [](int, int) {};
    EXPECT_THROW(in_order_behind(loop(n_items), [&](int, int i) { refuse(i); }, see), std::runtime_error);
    EXPECT_LT(last, 12) << "what follows came before its work";
    EXPECT_THROW(in_order_behind(loop(n_items), nothing, refuse), std::runtime_error);
    EXPECT_THROW(in_order_ahead(loop(n_items), [&](int i) { refuse(i); }, nothing), std::runtime_error);
    EXPECT_THROW(
        in_order_ahead(loop(n_items), [](int) {}, [&](int, int i) { refuse(i); }), std::runtime_error);
    int n = 0;   // and the crew goes on
    in_shares(100, 100, [&](int, int begin, int end) { n += end - begin; });
    EXPECT_EQ(n, 100);
}

/// Sums of 1 / i over items, and of the shares: the order of the one does not depend on the threads, that of
/// the other does.
std::pair<double, double> sums(int threads)
{
    const Crew crew(threads);
    constexpr int n = 10'000;
    std::vector<double> items(n), shares(static_cast<std::size_t>(std::max(threads, 1)), 0.0);
    in_shares(n, 1, [&](int slot, int begin, int end) {
        for (int i = begin; i < end; ++i)
            shares[static_cast<std::size_t>(slot)] += items[static_cast<std::size_t>(i)] = 1.0 / (1 + i);
    });
    std::pair<double, double> result{0, 0};
    for (const double item : items) result.first += item;
    for (const double share : shares) result.second += share;
    return result;
}

TEST(Crew, KeepsBitsWhereSumsAreThoseOfItems)
{
    const auto alone = sums(1);
    bool differs = false;
    for (const int threads : {2, 3, 7}) {
        EXPECT_EQ(sums(threads).first, alone.first);
        differs = differs || sums(threads).second != alone.second;
    }
    EXPECT_TRUE(differs) << "the control: sums by threads have the same bits, and equal bits prove nothing";
}

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

TEST(Crew, StopsInAllThreadsWhereNobodyWaitsAnyMore)
{
    for (const bool is_long_here : {true, false}) {   // which of the threads has the work
        const Crew crew(3);
        std::atomic<bool> is_wanted = true;
        std::atomic<int> n_stopped = 0;
        const std::function<bool()> goes_on = [&] { return is_wanted.exchange(false); };   // once
        const Patience patience(goes_on);
        const double begin = cpu_seconds();
        const auto work = [&](int slot, int, int) {
            if ((slot == 0) != is_long_here) return;
            try {
                while (cpu_seconds() - begin < 20) Patience::ask();
            } catch (const Stopped&) {
                ++n_stopped;
                throw;
            }
        };
        EXPECT_THROW(in_shares(3, 1, work), Stopped);
        EXPECT_EQ(n_stopped, is_long_here ? 1 : 2);
        EXPECT_LT(cpu_seconds() - begin, 2);
    }
}

}   // namespace
}   // namespace livens::crew_test
