// SPDX-License-Identifier: BSD-3-Clause
// What laws do inside of elements, by models that no scenario makes: against conservation laws.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "livens/multibody/loads/load_laws.h"
#include "livens/multibody/model.h"
#include "livens/spacetime/solve.h"

namespace livens::tests::inside_test {
namespace {

/// A point of 1 kg flies along x through a needle of force, F(x) = strength exp(-((x - place) / width)^2).
struct Needle {
    double place = 1.7, width = 0.002, strength = 500, speed = 1;

    Model model(bool is_bounded = true) const
    {
        Model model({0, 0, 0});
        const int bob = model.add_body(point_mass("bob", 1, {0, 0, 0}, {speed, 0, 0}));
        const JointCoordinate x = displacement_along(world, direction({1, 0, 0}), point({}), bob, point({}));
        const State start = model.start();
        LoadParts parts;
        parts.units = {unit_along("needle", x, Configurations(start.X))};
        parts.coordinates = {{x, 0}};
        const Needle needle = *this;
        parts.law = [needle](const LawArguments& at, std::span<double> factors, std::span<double> slopes) {
            const double u = (at.values[0] - needle.place) / needle.width;
            factors[0] = needle.strength * std::exp(-u * u);
            if (slopes.empty()) return;
            slopes[0] = -2 * u / needle.width * factors[0];
            slopes[1] = 0;
        };
        if (is_bounded)
            parts.steepest = [needle](const EnclosedValue&, std::span<const EnclosedValue> numbers,
                                      std::span<double> bounds) {
                const Enclosure u =
                    (numbers[0].value - Enclosure::of(needle.place)) * Enclosure::of(1 / needle.width);
                const double most = needle.strength * std::exp(-u.least() * u.least());
                bounds[0] = 2 * u.size() * most * numbers[0].slope.size() / needle.width;
            };
        model.add_load(modulated("needle", "needle", parts, Configurations(start.X)));
        return model;
    }
    /// Behind it, by the work of the needle.
    double speed_behind() const
    {
        return std::sqrt(speed * speed + 2 * strength * width * std::sqrt(std::numbers::pi));
    }
};

Solution flown(const Model& model, const Time& time, SolveOptions options = {})
{
    return solve(model, {{model.start()}}, time, Lobatto{7}, options);
}

double speed_at_end(const Solution& s) { return s.motion.at_end(s.motion.n_elements()).V[0](0, 0); }

TEST(InsideLaws, ANeedleIsFoundWhateverItsWidth)
{
    for (const double width : {0.1, 0.01, 1e-3, 1e-4}) {
        const Needle needle{1.7, width, 1 / width, 1};
        const Solution s = flown(needle.model(), Span{0, 4, 1e-6});
        EXPECT_TRUE(s.report.converged()) << width << " " << s.report.message;
        EXPECT_NEAR(speed_at_end(s), needle.speed_behind(), 1e-5) << width;
    }
}

/// The control: where nobody looks it is flown through as if it were not there, and told to be right.
TEST(InsideLaws, WithoutLooksANeedleIsFlownThrough)
{
    const Needle needle;
    SolveOptions blind;
    blind.look_at_laws = false;
    const Solution s = flown(needle.model(), Span{0, 4, 1e-6}, blind);
    EXPECT_TRUE(s.report.converged());
    EXPECT_LT(s.estimate.largest, 1e-6);
    EXPECT_NEAR(speed_at_end(s), needle.speed, 1e-6);
}

/// Stated elements step over it, as the second solution does: the kick is in the estimate, and the load
/// named.
TEST(InsideLaws, WhatNeitherSolutionSeesIsInTheEstimate)
{
    Needle needle;
    needle.strength = 0.5;   // a kick that divides no element
    const Model model = needle.model();
    const double missed = needle.speed_behind() - needle.speed;
    for (const int n : {3, 7, 11}) {
        const Solution s = flown(model, make_time_mesh(0, 4, n));
        const double off = (4 - 1.7) * missed / model.length();
        EXPECT_NEAR(speed_at_end(s), needle.speed, 1e-6) << "stepped over";
        EXPECT_GT(s.estimate.largest, 0.5 * off) << n;
        EXPECT_LT(s.estimate.largest, 4 * off) << n;
        EXPECT_EQ(s.estimate.unseen_load, 0) << n;
    }
}

/// A layer at the start, exp(-x / width), so wide that its slope is seen and so narrow that Gauss's points
/// have little of it; load points of radau have none in it.
TEST(InsideLaws, WhatIsSeenIsIntegratedToo)
{
    for (const double width : {0.0045, 0.006, 0.02}) {
        Model model({0, 0, 0});
        const int bob = model.add_body(point_mass("bob", 1, {0, 0, 0}, {1, 0, 0}));
        const JointCoordinate x = displacement_along(world, direction({1, 0, 0}), point({}), bob, point({}));
        const State start = model.start();
        LoadParts parts;
        parts.units = {unit_along("layer", x, Configurations(start.X))};
        parts.coordinates = {{x, 0}};
        parts.law = [width](const LawArguments& at, std::span<double> factors, std::span<double> slopes) {
            factors[0] = 0.1 * std::exp(-at.values[0] / width);
            if (!slopes.empty()) slopes[0] = -factors[0] / width, slopes[1] = 0;
        };
        parts.steepest = [width](const EnclosedValue&, std::span<const EnclosedValue> numbers,
                                 std::span<double> bounds) {
            bounds[0] = 0.1 * std::exp(-numbers[0].value.low / width) * numbers[0].slope.size() / width;
        };
        model.add_load(modulated("layer", "layer", parts, Configurations(start.X)));
        const Solution s = solve(model, {model.start()}, make_time_mesh(0, 4, 4), Radau{5}, {});
        const double truth = std::sqrt(1 + 2 * 0.1 * width), off = (4 - width) * (truth - 1) / model.length();
        EXPECT_GT(s.estimate.largest, 0.5 * off) << width;
        EXPECT_LT(s.estimate.largest, 3 * off) << width;
    }
}

/// Forces that nobody bounds are sampled, nearer and nearer to the ends of elements: a layer at the start.
TEST(InsideLaws, ALayerAtTheStartIsSeenOfForcesThatAreOpaque)
{
    Model model({0, 0, 0});
    model.add_body(point_mass("bob", 1, {0, 0, 0}, {0, 0, 0}));
    const auto friction = [](double v) { return 20 - 5 * std::tanh(30000 * v); };
    Load load;
    load.name = "opaque";
    load.type = "function";
    load.bodies = {0, world};
    load.depends_on_V = true;
    load.forces = [=](const LoadArguments& at, LoadForces& F) { F[0](0, 0) = friction(at.V[0](0, 0)); };
    load.tangent = [](const LoadArguments& at, LoadTangent& tangent) {
        const double t = std::tanh(30000 * at.V[0](0, 0));
        tangent.V[0][0](0, 0) = -150000 * (1 - t * t);
    };
    model.add_load(load);
    // v' = 20 - 5 tanh(30000 v): x by quadrature of v dv / v'
    const Solution s = flown(model, Span{0, 0.5, 1e-7});
    const double v = speed_at_end(s);
    double time = 0;   // to reach v, by Simpson's rule in the layer and 1/15 behind it
    const int n = 20000;
    const double layer = 0.001, step = layer / n;
    for (int i = 0; i < n; ++i)
        time += step / 6 *
                (1 / friction(i * step) + 4 / friction((i + 0.5) * step) + 1 / friction((i + 1) * step));
    time += (v - layer) / 15;
    EXPECT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_NEAR(time, 0.5, 1e-7);
}

}   // namespace
}   // namespace livens::tests::inside_test
