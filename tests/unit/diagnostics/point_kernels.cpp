// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cstring>

#include "livens/diagnostics/detail/point_tables.h"
#include "livens/dynamics/lanes/aligned_doubles.h"
#include "livens/dynamics/rows/rows.h"
#include "unit/diagnostics/hand_made.h"
#include "unit/multibody/random_states.h"

namespace livens::point_kernels_test {
namespace {

constexpr int W = OfPoints::width;

/// All that kernels write, one after the other.
std::vector<double> everything(const PointKernels& kernels, const PointLists& lists, const AlignedDoubles& X,
                               const AlignedDoubles& V, const AlignedDoubles& lambda)
{
    AlignedDoubles violations(lists.n_rows * W), sizes(lists.n_numbers / 3 * W), forces(lists.n_numbers * W);
    const PointArrays at{X.data(), V.data(), lambda.data(), violations.data(), sizes.data(), forces.data()};
    std::vector<double> all;
    const auto append = [&](const auto& values) {
        const auto* first = reinterpret_cast<const double*>(&values);
        constexpr std::size_t size = sizeof(double), n_bytes = sizeof(values);
        all.insert(all.end(), first, first + n_bytes / size);
    };
    const auto append_rows = [&] { all.insert(all.end(), violations.begin(), violations.end()); };
    SupplyOfPoints supply;
    OfPoints energy, moment[3];
    LargestOfPoints largest;
    kernels.sizes(lists, at);
    all.insert(all.end(), sizes.begin(), sizes.end());
    kernels.weights(lists, at, supply), append(supply);
    kernels.potential(lists, at, energy), append(energy);
    kernels.kinetic(lists, at, energy), append(energy);
    kernels.moments(lists, at, moment), append(moment);
    kernels.joints(lists, at, supply), append(supply), append_rows();
    kernels.violations(lists, at), append_rows();
    kernels.largest_violation(lists, at, largest), append(largest);
    kernels.largest_of_rigidity(lists, at, largest), append(largest);
    kernels.rates(lists, at), append_rows();
    for (const int n : {1, 2, 5, 12, 27, 40}) {
        const int n_columns = 8, n_rows = 7;
        std::vector<double> d(X.begin(), X.begin() + n_columns * n),
            out(static_cast<std::size_t>(n_rows * n));
        kernels.multiply(V.data(), n_rows, n_columns, 9, d.data(), n, out.data());
        all.insert(all.end(), out.begin(), out.end());
        double exact = 0;
        for (int A = 0; A < n_columns; ++A) exact += V[9 * 3 + A] * d[A * n + n - 1];
        EXPECT_NEAR(out[static_cast<std::size_t>(3 * n + n - 1)], exact, 1e-14);
    }
    return all;
}

TEST(PointKernels, HaveTheSameBitsOnEverySetOfInstructions)
{
    Random random(5);
    Model model(random.vector());
    for (int b = 0; b < 8; ++b) {
        Placement place;
        place.position = random.vector();
        place.directors = random.rotation();
        model.add_body(rigid_body("b" + std::to_string(b), hand_made::skew_properties(), place));
        const Matrix34 before = b == 0 ? world_configuration : model.bodies()[b - 1].X;
        const JointFrame frame = joint_frame(before, model.bodies()[b].X, random.vector(), random.unit());
        const std::string name = "j" + std::to_string(b);
        model.add_joint(b % 2 == 0 ? revolute(name, b - 1, b, frame) : rod(name, b - 1, b, frame, 0.7));
    }
    const ModelTables of_model(model, all_rows(model));
    const PointTables tables(of_model);
    AlignedDoubles X(tables.view().n_numbers * W), V(X), lambda(tables.view().n_rows * W);
    for (AlignedDoubles* numbers : {&X, &V, &lambda})
        for (double& x : *numbers) x = random.number();
    const auto of = [&](const PointKernels& kernels) {
        return everything(kernels, tables.view(), X, V, lambda);
    };
    const std::vector<double> portable = of(portable_point_kernels()), best = of(point_kernels());
    ASSERT_EQ(portable.size(), best.size());
    EXPECT_EQ(std::memcmp(portable.data(), best.data(), best.size() * sizeof(double)), 0);
    X[17] += 1e-15 * X[17];
    const std::vector<double> other = of(point_kernels());
    EXPECT_NE(std::memcmp(portable.data(), other.data(), other.size() * sizeof(double)), 0);
}

}   // namespace
}   // namespace livens::point_kernels_test
