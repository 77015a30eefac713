// SPDX-License-Identifier: BSD-3-Clause
#include "livens/time/time_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "livens/base/error.h"

namespace livens::time_mesh_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool has_end(const TimeMesh& mesh, double t)
{
    return std::find(mesh.ends.begin(), mesh.ends.end(), t) != mesh.ends.end();
}

std::string path_of_error(double start, double end, int n, const std::vector<double>& required = {})
{
    try {
        make_time_mesh(start, end, n, required);
    } catch (const InputError& error) {
        return error.complaint().path;
    }
    return "none";
}

TEST(TimeMesh, IsUniformWithoutRequiredInstants)
{
    const TimeMesh mesh = make_time_mesh(0, 1, 10);
    ASSERT_EQ(mesh.n_elements(), 10);
    EXPECT_EQ(mesh.start(), 0);
    EXPECT_EQ(mesh.end(), 1);
    EXPECT_EQ(mesh.ends[3], 0.3);   // the decimal, not 3 x 0.1
    for (int e = 0; e < 10; ++e) EXPECT_NEAR(mesh.length(e), 0.1, 1e-16);
}

TEST(TimeMesh, KeepsTheCountIfRequiredInstantsLieOnTheGrid)
{
    for (const int n : {10, 100, 7000}) {
        std::vector<double> required;
        for (int k = 1; k < 10; ++k) required.push_back(0.1 * k);   // off the grid by rounding
        const TimeMesh mesh = make_time_mesh(0, 1, n, required);
        EXPECT_EQ(mesh.n_elements(), n);
        for (const double t : required) EXPECT_TRUE(has_end(mesh, t)) << t;
    }
}

TEST(TimeMesh, PutsRequiredInstantsAtEndsToTheBit)
{
    const double odd = 0.123456789012345678, late = std::nextafter(2.0, 0.0) - 0.7;
    const std::vector<double> required{late, odd};   // in any order
    const TimeMesh mesh = make_time_mesh(-1, 2, 4, required);
    EXPECT_TRUE(has_end(mesh, odd));
    EXPECT_TRUE(has_end(mesh, late));
    EXPECT_TRUE(std::is_sorted(mesh.ends.begin(), mesh.ends.end()));
    // h = 0.75: [-1, 0.12] takes 2 elements, [0.12, 1.3] takes 2, [1.3, 2] takes 1.
    EXPECT_EQ(mesh.n_elements(), 5);
    for (int e = 0; e < mesh.n_elements(); ++e) EXPECT_LE(mesh.length(e), 0.75);
}

TEST(TimeMesh, HasElementsBetweenDenseInstantsShorterThanH)
{
    const std::vector<double> required{0.1, 0.2, 0.3};
    EXPECT_EQ(make_time_mesh(0, 1, 1, required).n_elements(), 4);
    EXPECT_EQ(make_time_mesh(0, 1, 2, required).n_elements(), 5);   // the rest of 0.7 takes two
}

TEST(TimeMesh, MergesInstantsThatAreNearlyOne)
{
    const std::vector<double> required{0.5 + 1e-12, 0.5, 1e-11, 1 - 1e-11, 0.5 - 1e-12};
    const TimeMesh mesh = make_time_mesh(0, 1, 2, required);
    EXPECT_EQ(mesh.ends,
              (std::vector<double>{0, 0.5 + 1e-12, 1}));   // the first wins, and start and end over all
    const std::vector<double> apart{0.5, 0.5 + 2e-9};
    EXPECT_EQ(make_time_mesh(0, 1, 2, apart).n_elements(), 3);
}

TEST(TimeMesh, LeavesOutInstantsOutside)
{
    const std::vector<double> required{-1, 0, 1, 1.5, 1e300};
    EXPECT_EQ(make_time_mesh(0, 1, 3, required).ends, make_time_mesh(0, 1, 3).ends);
}

TEST(TimeMesh, FindsTheElementOfAnInstant)
{
    const TimeMesh mesh{{0, 1, 3, 4}};
    EXPECT_EQ(mesh.element_at(0), 0);
    EXPECT_EQ(mesh.element_at(0.999), 0);
    EXPECT_EQ(mesh.element_at(1), 1);
    EXPECT_EQ(mesh.element_at(std::nextafter(3.0, 0.0)), 1);
    EXPECT_EQ(mesh.element_at(3), 2);
    EXPECT_EQ(mesh.element_at(4), 2);
    EXPECT_EQ(mesh.element_at(-5), 0);
    EXPECT_EQ(mesh.element_at(9), 2);
}

TEST(TimeMesh, NamesWhatIsWrong)
{
    EXPECT_EQ(path_of_error(0, 1, 1), "none");
    EXPECT_EQ(path_of_error(0, 0, 1), "time.end");
    EXPECT_EQ(path_of_error(1, 0, 1), "time.end");
    EXPECT_EQ(path_of_error(0, infinity, 1), "time.end");
    EXPECT_EQ(path_of_error(0, NAN, 1), "time.end");
    EXPECT_EQ(path_of_error(-1e308, 1e308, 1), "time.end");
    EXPECT_EQ(path_of_error(NAN, 1, 1), "time.start");
    EXPECT_EQ(path_of_error(0, 1, 0), "time.elements");
    EXPECT_EQ(path_of_error(0, 1, -7), "time.elements");
    EXPECT_EQ(path_of_error(0, 1, 2'000'000'000), "time.elements");
    EXPECT_EQ(path_of_error(1e16, 1e16 + 4, 10), "time.elements");
    EXPECT_EQ(path_of_error(0, 1, 1, {0.5, NAN}), "time.output");
    EXPECT_EQ(path_of_error(0, 1, 1, {infinity}), "time.output");
}

}   // namespace
}   // namespace livens::time_mesh_test
