// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>

#include "properties/basis_kit.h"

namespace livens::basis_kit_test {
namespace {

TEST(BasisKit, EverySpacePasses)
{
    for (const BasisCase& basis : basis_cases()) EXPECT_EQ(joined(check_basis(basis)), "");
}

TEST(BasisKit, EveryFamilyIsInTheRegistryInEveryDegree)
{
    std::ifstream file(std::string(LIVENS_SOURCE_DIR) + "/src/livens/time/time_space.h");
    std::string header{std::istreambuf_iterator<char>(file), {}};
    header.resize(std::min(header.size(), header.find("private:")));
    const std::regex maker(R"(static TimeSpace (\w+)\()");
    int families = 0;
    for (std::sregex_iterator found(header.begin(), header.end(), maker), end; found != end; ++found) {
        ++families;
        const std::string family = (*found)[1];
        for (int degree = 1; degree <= 8; ++degree) {
            EXPECT_TRUE(std::ranges::any_of(basis_cases(),
                                            [&](const BasisCase& basis) {
                                                return basis.family == family &&
                                                       basis.space.degree() == degree;
                                            }))
                << family << " of degree " << degree;
        }
    }
    EXPECT_GE(families, 3);
}

/// A spline of degree 3 whose knots stand once, three times and twice, and its functions changed.
using Change = std::function<void(int element, double s, std::span<double> values, std::span<double> slopes)>;

BasisCase cubic(const Change& change = {})
{
    const TimeSpace space = TimeSpace::bspline(3, {0, 0, 0, 0, 1, 2, 2, 2, 3.5, 3.5, 4, 4, 4, 4});
    BasisCase basis = basis_case("bspline", "control", space, 3, {2, 0, 1});
    if (!change) return basis;
    basis.evaluate = [space, change](int element, double s, std::span<double> values,
                                     std::span<double> slopes) {
        space.evaluate(element, s, values, slopes);
        change(element, s, values, slopes);
    };
    return basis;
}

using Check = Failures (*)(const BasisCase&);

bool fails(Check check, const BasisCase& basis)
{
    return !check(basis).empty() && !check_basis(basis).empty();
}

TEST(BasisKit, TheControlPassesAsLongAsNothingIsChanged) { EXPECT_EQ(joined(check_basis(cubic())), ""); }

TEST(BasisKit, AFunctionThatIsALittleTooLargeFails)
{
    const BasisCase wrong =
        cubic([](int, double, std::span<double> values, std::span<double>) { values[1] *= 1 + 1e-13; });
    EXPECT_TRUE(fails(check_basis_unity, wrong));
}

TEST(BasisKit, ANegativeSplineFails)
{
    const BasisCase wrong = cubic([](int, double, std::span<double> values, std::span<double>) {
        values[0] -= 1e-9;
        values[1] += 1e-9;
    });
    EXPECT_TRUE(fails(check_basis_unity, wrong));
}

TEST(BasisKit, FunctionsInAnotherOrderFailExactness)
{
    const BasisCase wrong =
        cubic([](int element, double, std::span<double> values, std::span<double> slopes) {
            if (element != 1) return;
            std::swap(values[1], values[2]);
            std::swap(slopes[1], slopes[2]);
        });
    EXPECT_EQ(joined(check_basis_unity(wrong)), "");
    EXPECT_TRUE(fails(check_basis_exactness, wrong));
    EXPECT_TRUE(fails(check_basis_smoothness, wrong));
}

TEST(BasisKit, ADerivativeByTheLocalCoordinateFails)
{
    // Elements 2 and 3 are not of length one: without the factor 1 / h the sum is still zero.
    const BasisCase wrong = cubic([](int element, double, std::span<double>, std::span<double> slopes) {
        const double h[4] = {1, 1, 1.5, 0.5};
        for (double& slope : slopes) slope *= h[element];
    });
    EXPECT_EQ(joined(check_basis_unity(wrong)), "");
    EXPECT_TRUE(fails(check_basis_derivatives, wrong));
}

TEST(BasisKit, ADerivativeThatIsWrongAtOneEndFails)
{
    const BasisCase wrong = cubic([](int element, double s, std::span<double>, std::span<double> slopes) {
        if (element == 2 && s == 1) slopes[0] += 1e-7, slopes[3] -= 1e-7;
    });
    EXPECT_TRUE(fails(check_basis_derivatives, wrong));
}

TEST(BasisKit, AnotherExactnessThanStatedFails)
{
    for (const int exactness : {2, 4}) {
        BasisCase wrong = cubic();
        wrong.exactness = exactness;
        EXPECT_TRUE(fails(check_basis_exactness, wrong)) << exactness;
    }
}

TEST(BasisKit, AnotherSmoothnessThanStatedFails)
{
    for (std::size_t i = 0; i < 3; ++i) {
        for (const int off : {-1, 1}) {
            BasisCase wrong = cubic();
            wrong.smoothness[i] += off;
            EXPECT_TRUE(fails(check_basis_smoothness, wrong)) << i << " off by " << off;
        }
    }
}

TEST(BasisKit, APointTooManyTwiceOrOffTheEndFailsInterpolation)
{
    BasisCase wrong = cubic();
    wrong.points.push_back(4);
    EXPECT_TRUE(fails(check_basis_interpolation, wrong));
    wrong = cubic();
    wrong.points[2] = wrong.points[3];
    EXPECT_TRUE(fails(check_basis_interpolation, wrong));
    wrong = cubic();
    wrong.points.back() -= 1e-12;
    EXPECT_TRUE(fails(check_basis_interpolation, wrong));
    // In the support of the first function there must be a point.
    wrong = cubic();
    for (std::size_t i = 1; i < 5; ++i) wrong.points[i] = 2 + 0.01 * static_cast<double>(i);
    EXPECT_TRUE(fails(check_basis_interpolation, wrong));
}

TEST(BasisKit, ALowerSpaceOfOtherKnotsFails)
{
    BasisCase wrong = cubic();
    wrong.lower = TimeSpace::bspline(3, {0, 0, 0, 0, 1, 2, 3.5, 4, 4, 4, 4});   // degree not lower
    EXPECT_TRUE(fails(check_basis_lower, wrong));
    // As many functions as it must have, but smooth where the derivative jumps.
    wrong = cubic();
    wrong.lower = TimeSpace::bspline(2, {0, 0, 0, 1, 1, 2, 2, 3.5, 3.5, 4, 4, 4});
    ASSERT_EQ(wrong.lower->size(), wrong.space.size() - 1);
    EXPECT_TRUE(fails(check_basis_lower, wrong));
}

}   // namespace
}   // namespace livens::basis_kit_test
