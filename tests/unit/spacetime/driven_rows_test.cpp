// SPDX-License-Identifier: BSD-3-Clause
// Rows that follow functions of time and of coordinates, by the march kernel against Newton's iteration.
#include <gtest/gtest.h>

#include <cmath>

#include "livens/multibody/joints.h"
#include "livens/multibody/joints/drives.h"
#include "livens/multibody/joints/spline_curve.h"
#include "livens/time/time_laws.h"
#include "sanitized.h"
#include "unit/spacetime/kernel_comparison.h"

namespace livens::driven_rows_test {
namespace {

/// A drive of a coordinate, a distance or a point, a slot, or a coupling of some coordinates.
void add_function(Random& random, Model& model)
{
    const std::vector<Matrix34> X = model.start().X;
    const int last = static_cast<int>(model.bodies().size()) - 1;
    const Matrix34& X_last = X[static_cast<std::size_t>(last)];
    const int kind = static_cast<int>(2.5 * (1 + random.number()));
    const auto law = [&](double now, double size) {
        return shifted(harmonic(size, 3, random.number()), now);
    };
    std::vector<CoupledJoint> coupled;
    Random own(
        static_cast<unsigned>(7 + model.joints().size()));   // factors leave the mechanisms as they are
    for (const Joint& joint : model.joints())
        for (const NamedCoordinate& q : joint.coordinates) {
            const double factor = own.number();
            if (own.number() > -0.5)
                coupled.push_back({q.name == "angle" ? 0.5 + std::floor(2 * (1 + factor)) : 1 + factor / 2,
                                   &joint, q.name});
            if (kind != 0) continue;
            const TimeFunction motion = law(0, 0.4);
            model.add_joint(
                driven_coordinate("drive", joint, q, shifted(motion, q.at_stated - motion({0}).value), X));
            return;
        }
    if (kind == 1) {
        const Vector3 from = 3.0 * random.unit();
        model.add_joint(
            driven_distance("distance", world, from, last, {}, law(norm(X_last.column(0) - from), 0.1), X));
    } else if (kind == 2) {
        model.add_joint(driven_point("point", last, {}, {law(0, 0.1), law(0, 0.1), law(0, 0.1)}, X));
    } else if (kind == 3) {
        std::vector<Vector3> points;
        const Vector3 e = random.unit(), n = random.unit();
        for (int k = -3; k <= 3; ++k) points.push_back(X_last.column(0) + 0.4 * k * e + 0.1 * k * k * n);
        model.add_joint(
            slot("slot", world, last, spline_curve(points, false), {}, world_configuration, X_last));
    } else if (coupled.size() >= 2) {
        model.add_joint(coupling("coupling", coupled, X, model.length()));
    }
}

struct Found {
    std::vector<double> differences;
    int unsolved = 0, with_functions = 0;
};

/// `fault`: see compare().
Found compare_driven(int n, Points points, double fault = 0)
{
    Random random(5);
    Found found;
    while (std::ssize(found.differences) + found.unsolved < n) {
        Model model = any_mechanism(random);
        try {
            add_function(random, model);
            const int degree = 1 + static_cast<int>(4 * (1 + random.number()));
            const double h = (random.number() > -0.7 ? 1 : -1) * (0.02 + 0.015 * random.number());
            const Comparison comparison = compare(model, degree, h, fault, nullptr, points);
            found.unsolved += comparison.is_solved ? 0 : 1;
            if (comparison.is_solved) found.differences.push_back(comparison.worst());
            bool has_function = false;
            for (int r = 0; r < model.n_rows(); ++r)
                has_function = has_function || !model.row(r).is_quadratic();
            found.with_functions += has_function ? 1 : 0;
        } catch (const InputError&) {   // overdetermined: no start; or no gear of these joints
        }
    }
    std::ranges::sort(found.differences);
    return found;
}

TEST(MarchKernel, AgreesWithNewtonOnRowsThatFollowFunctions)
{
    constexpr int n = is_sanitized ? 40 : 200;
    with_all_instructions([] {
        for (const Points points : {Points::lobatto, Points::radau}) {
            const Found found = compare_driven(n, points);
            EXPECT_GT(found.with_functions, n / 2);
            EXPECT_LT(found.unsolved, n * 3 / 20);
            EXPECT_LT(found.differences[found.differences.size() / 2], 1e-14);
            EXPECT_LT(found.differences.back(), 1e-12);
        }
        const Found faulty = compare_driven(n / 4, Points::lobatto, 1e-9);
        EXPECT_GT(faulty.differences[faulty.differences.size() / 2], 1e-13) << "negative control";
    });
}

}   // namespace
}   // namespace livens::driven_rows_test
