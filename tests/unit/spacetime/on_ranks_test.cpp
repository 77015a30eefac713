// SPDX-License-Identifier: BSD-3-Clause
// One motion by several ranks: states of the serial run, nobody forms elements of others, what is sent is as
// long as it is said to be.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "livens/base/error.h"
#include "livens/multibody/model.h"
#include "livens/spacetime/on_ranks.h"
#include "sanitized.h"
#include <mechanisms.h>   // those of all tests

namespace livens::on_ranks_test {
namespace {

struct Case {
    std::string name;
    Model model;
    Problem problem;
    TimeMesh mesh;
    Method method;
};

struct Part {
    Solution solution;
    RankWork work;
};

std::vector<Part> solved_on(const Case& one, int n_ranks, const SolveOptions& options = {})
{
    std::vector<Part> parts(static_cast<std::size_t>(n_ranks));
    run_as_ranks(n_ranks, [&](Ranks& ranks) {
        Part& part = parts[static_cast<std::size_t>(ranks.rank())];
        part.solution =
            solve_on_ranks(one.model, one.problem, one.mesh, one.method, options, ranks, part.work);
    });
    return parts;
}

State arrival(const Model& model, double end)
{
    SolveOptions options;
    options.judge = false;
    const Solution solution = solve(model, {model.start()}, make_time_mesh(0, end, 40), Lobatto{6}, options);
    return solution.motion.at_end(40);
}

Case make_case(const std::string& name, const Model& model, Conditions conditions, int n,
               const Method& method)
{
    const double end = 0.4;
    conditions.start = model.start();
    conditions.end = arrival(model, end);
    return {name, model, {conditions}, make_time_mesh(0, end, n), method};
}

/// Windows of lobatto.
void add_lobatto(std::vector<Case>& all)
{
    Conditions of_start, of_end, of_places, places_momenta, momenta_places;
    of_end.at_start = Known::nothing;
    of_end.at_end = Known::state;
    of_places.at_start = of_places.at_end = Known::positions;
    places_momenta.at_start = momenta_places.at_end = Known::positions;
    places_momenta.at_end = momenta_places.at_start = Known::momenta;
    const Lobatto linear{1, 0}, cubic{3, 0}, high{6, 0};
    all.push_back(make_case("lobatto", tests::hinged_links(), of_start, 41, cubic));
    all.push_back(make_case("lobatto, linear", tests::cubes_on_rods(0.2), of_start, 66, linear));
    all.push_back(make_case("lobatto, a loop", tests::four_bar(), of_start, 20, high));
    all.push_back(make_case("lobatto, backwards", tests::hinged_links(), of_end, 40, cubic));
    all.push_back(make_case("lobatto, between places", tests::hinged_links(), of_places, 40, cubic));
    all.push_back(
        make_case("lobatto, places, then momenta", tests::cubes_on_rods(0.2), places_momenta, 30, cubic));
    all.push_back(
        make_case("lobatto, momenta, then places", tests::hinged_links(), momenta_places, 30, cubic));
    Case uneven = make_case("lobatto, uneven elements", tests::hinged_links(), of_start, 40, cubic);
    for (std::size_t e = 1; e < 40; ++e) uneven.mesh.ends[e] += 0.004 * std::sin(static_cast<double>(e));
    all.push_back(uneven);
}

std::vector<Case> cases()
{
    Conditions of_start, of_places, mixed_ends, of_end;
    of_places.at_start = of_places.at_end = mixed_ends.at_start = Known::positions;
    mixed_ends.at_end = Known::momenta;
    of_end.at_start = Known::nothing;
    of_end.at_end = Known::state;
    Mixed linear, quadratic, lower, strong;
    linear.degree = 1;
    lower.multipliers = Mixed::Multipliers::lower;
    strong.start = Mixed::Start::strong;
    std::vector<Case> all;
    all.push_back(make_case("linear", tests::cubes_on_rods(0), of_start, 66, linear));
    all.push_back(make_case("quadratic", tests::hinged_links(), of_start, 41, quadratic));
    all.push_back(make_case("lower multipliers", tests::hinged_links(), of_start, 40, lower));
    all.push_back(make_case("strong start", tests::hinged_links(), of_start, 40, strong));
    all.push_back(make_case("a loop", tests::four_bar(), of_start, 40, linear));
    all.push_back(make_case("backwards", tests::hinged_links(), of_end, 40, linear));
    all.push_back(make_case("between places", tests::hinged_links(), of_places, 40, quadratic));
    all.push_back(make_case("places, then momenta", tests::cubes_on_rods(0.2), mixed_ends, 50, linear));
    Case uneven = make_case("uneven elements", tests::hinged_links(), of_start, 40, linear);
    for (std::size_t e = 1; e < 40; ++e) uneven.mesh.ends[e] += 0.004 * std::sin(static_cast<double>(e));
    all.push_back(uneven);
    add_lobatto(all);
    return all;
}

/// Largest difference of states at element ends and inside, by the largest number of the kind.
double distance(const Motion& whole, const Motion& part, int first)
{
    double off = 0, sizes[2] = {1, 0};
    const auto compare = [&](const State& a, const State& b) {
        int kind = 0;
        for (auto [x, y] : {std::pair{&a.X, &b.X}, {&a.V, &b.V}}) {
            for (std::size_t i = 0; i < x->size(); ++i)
                for (int c = 0; c < 12; ++c) {
                    sizes[kind] = std::max(sizes[kind], std::abs((*x)[i].a[c]));
                    off = std::max(off, std::abs((*x)[i].a[c] - (*y)[i].a[c]) / std::max(sizes[kind], 1.0));
                }
            ++kind;
        }
    };
    for (int e = 0; e <= part.n_elements(); ++e) compare(whole.at_end(first + e), part.at_end(e));
    for (int e = 0; e < part.n_elements(); ++e) {
        const double t = 0.3 * part.mesh.ends[e] + 0.7 * part.mesh.ends[e + 1];
        compare(whole.at(t), part.at(t));
    }
    return off;
}

TEST(OnRanks, StatesAreThoseOfTheSerialRun)
{
    for (const Case& one : cases()) {
        const Solution alone = solve(one.model, one.problem, one.mesh, one.method);
        ASSERT_TRUE(alone.report.reached_end()) << one.name << ": " << alone.report.message;
        const std::vector<int> sizes =
            is_sanitized ? std::vector<int>{1, 4} : std::vector<int>{1, 2, 3, 4, 7};
        for (const int n : sizes) {
            int next = 0;
            for (const Part& part : solved_on(one, n)) {
                const SolveReport& report = part.solution.report;
                ASSERT_TRUE(report.reached_end()) << one.name << ", " << n << " ranks: " << report.message;
                EXPECT_EQ(part.work.first, next);
                EXPECT_LT(distance(alone.motion, part.solution.motion, next), 1e-12)
                    << one.name << ", " << n << " ranks";
                EXPECT_EQ(report.unknowns, alone.report.unknowns) << one.name;
                next = part.work.last;
            }
            EXPECT_EQ(next, one.mesh.n_elements());
        }
    }
}

TEST(OnRanks, FiguresAreThoseOfTheSerialRun)
{
    const Case one = cases()[1];
    const Solution alone = solve(one.model, one.problem, one.mesh, one.method);
    for (const Part& part : solved_on(one, 3)) {
        const Verdict &v = part.solution.verdict, &whole = alone.verdict;
        EXPECT_NEAR(v.max_constraint_violation, whole.max_constraint_violation, 1e-12);
        EXPECT_NEAR(v.max_weak_violation, whole.max_weak_violation, 1e-12);
        EXPECT_NEAR(v.energy_drift, whole.energy_drift, 1e-11);
        EXPECT_NEAR(v.balance.largest_kinetic, whole.balance.largest_kinetic, 1e-11);
        EXPECT_NEAR(v.balance.reference_impulse, whole.balance.reference_impulse,
                    1e-11 * whole.balance.reference_impulse);
        EXPECT_NEAR(part.solution.report.guess_distance, alone.report.guess_distance, 1e-9);
    }
}

TEST(OnRanks, NobodyFormsElementsOfOthers)
{
    const Case one = cases()[0];
    for (const int n : {1, 2, 4, 8}) {
        int formed = 0;
        for (const Part& part : solved_on(one, n)) {
            EXPECT_EQ(part.work.n_formed, part.work.last - part.work.first);
            EXPECT_EQ(part.solution.motion.n_elements(), part.work.last - part.work.first);
            formed += part.work.n_formed;
        }
        EXPECT_EQ(formed, one.mesh.n_elements());
    }
}

/// By a tree and along borders: messages of a rank grow as the logarithm of their number, its bytes hardly;
/// the first one, which has the chain here, sends to all. Stretches of thirty elements hand on 4 f numbers:
/// those of the f free motions, and as many of modes that alternate. Both ends of time hold half of them.
TEST(OnRanks, WhatIsSentGrowsAsIsSaid)
{
    Case one = cases()[0];
    one.mesh = make_time_mesh(0, 0.4, 2048);
    const int border = 2 * 24 + 2 + 2 * 6;   // numbers of X, P, rods and rigidity
    const int free = 12 - 2;
    std::vector<long long> bytes, messages;
    for (int n = 4; n <= 64; n *= 2) {
        const std::vector<Part> parts = solved_on(one, n);
        Traffic most;
        long long flops = 0;
        for (std::size_t r = 1; r < parts.size(); ++r) {
            most.bytes = std::max(most.bytes, parts[r].work.of_solution.bytes);
            most.messages = std::max(most.messages, parts[r].work.of_solution.messages);
            flops = std::max(flops, parts[r].work.flops);
        }
        bytes.push_back(most.bytes);
        messages.push_back(most.messages);
        const Traffic first = parts[0].work.of_solution;
        EXPECT_EQ(parts[0].work.n_chain, 4 * free * (n - 2));
        EXPECT_EQ(parts[1].work.n_left, 2 * border);
        EXPECT_EQ(parts[1].work.n_in_chain, 4 * free);
        std::printf("%2d ranks: %lld messages, %lld bytes, %lld flops; of the first %lld, %lld\n", n,
                    most.messages, most.bytes, flops, first.messages, first.bytes);
    }
    EXPECT_LT(50 * bytes.back(), 51 * bytes[1]);   // of four ranks two have a border at an end of time
    for (std::size_t i = 2; i < messages.size(); ++i)
        EXPECT_EQ(messages[i] - messages[i - 1], messages[1] - messages[0]);
}

/// Stretches that are too short for that hand on all their numbers, but where time ends.
TEST(OnRanks, ShortStretchesHaveAllNumbersOfTheirBorders)
{
    Case one = cases()[0];
    one.mesh = make_time_mesh(0, 0.4, 66);
    const int border = 2 * 24 + 2 + 2 * 6;
    for (const Part& part : solved_on(one, 16)) EXPECT_EQ(part.work.n_chain, 2 * border * 14);
}

/// Numbers that are zero to the last bit save work: what ranks solve between them leaves them so.
TEST(OnRanks, PlaneMotionsStayInTheirPlane)
{
    Case one = cases()[0];
    one.mesh = make_time_mesh(0, 0.4, 200);
    for (const Part& part : solved_on(one, 4)) {
        const Motion& motion = part.solution.motion;
        EXPECT_LT(part.work.n_chain, 200) << "what sees one border alone is solved there";
        for (int e = 0; e <= motion.n_elements(); ++e)
            for (const Matrix34& X : motion.at_end(e).X)
                for (int c = 0; c < 4; ++c) EXPECT_TRUE(c == 2 || X(1, c) == 0) << e;
    }
}

TEST(OnRanks, WhatIsNotDividedIsRefused)
{
    const auto code_of = [](const Case& one, int n_ranks, const Method& method, const Time& time,
                            const SolveOptions& options = {}) {
        try {
            check_ranks(one.model, one.problem, time, method, options, n_ranks);
            return std::string();
        } catch (const InputError& error) {
            return error.complaint().code;
        }
    };
    const Case one = cases()[0];
    EXPECT_EQ(code_of(one, 4, one.method, one.mesh), "");
    EXPECT_EQ(code_of(one, 67, one.method, one.mesh), "ranks-elements");
    EXPECT_EQ(code_of(one, 2, Lobatto{4}, one.mesh), "ranks-method") << "a march";
    EXPECT_EQ(code_of(one, 2, Lobatto{4, 0}, one.mesh), "");
    EXPECT_EQ(code_of(one, 2, Radau{4}, one.mesh), "ranks-method");
    Mixed blocks = std::get<Mixed>(one.method), splines = blocks;
    blocks.window = 8;
    splines.basis = Mixed::Basis::bspline;
    EXPECT_EQ(code_of(one, 2, blocks, one.mesh), "ranks-method");
    EXPECT_EQ(code_of(one, 2, splines, one.mesh), "ranks-method");
    SolveOptions options;
    options.condition = true;
    EXPECT_EQ(code_of(one, 2, one.method, one.mesh, options), "ranks-method");
}

TEST(OnRanks, WhatOneCannotDoEndsAll)
{
    const auto work = [](Ranks& ranks) {
        if (ranks.rank() == 2) throw std::runtime_error("out of paper");
        double value = 1;
        ranks.sum({&value, 1});
    };
    try {
        run_as_ranks(4, work);
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "out of paper");
    }
}

}   // namespace
}   // namespace livens::on_ranks_test
