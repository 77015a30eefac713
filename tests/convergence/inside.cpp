// SPDX-License-Identifier: BSD-3-Clause
// Inside elements: inner nodes, between nodes, the polynomial's derivative, and sampling at full order.
#include "convergence/studies.h"
#include "livens/time/basis.h"

namespace livens::tests::inside_test {
namespace {

/// Two bricks to 0.5 s, and a fine motion whose polynomials are good to 1e-12 everywhere: its degree is 12.
struct Bricks {
    Model model = two_bricks();
    double end = 0.5;
    Motion fine = solve_evenly(model, end, 50, 12).motion;

    Motion solved(int n, int degree) const { return solve_evenly(model, end, n, degree).motion; }
};

/// Largest distance from the fine motion at the local coordinates `s` of all elements.
Distance largest(const Bricks& bricks, const Motion& motion, const std::vector<double>& s)
{
    Distance worst;
    for (int e = 0; e < motion.n_elements(); ++e) {
        for (double local : s) {
            const double t = motion.mesh.ends[e] + local * motion.mesh.length(e);
            const Distance d = distance(motion.at(t), bricks.fine.at(t));
            worst.X = std::max(worst.X, d.X);
            worst.V = std::max(worst.V, d.V);
        }
    }
    return worst;
}

constexpr double floor_X = 1e-11, floor_V = 1e-9;

TEST(Lobatto, ConvergesAtInnerNodesWithOrderPPlus2)
{
    const Bricks bricks;
    for (auto [p, n] : {std::pair{2, std::vector{64, 80, 100, 125}},
                        {3, {38, 47, 58, 72}},
                        {4, {18, 22, 27, 33}},
                        {5, {10, 12, 15, 18}}}) {
        const std::vector<double> nodes = lobatto_basis(p).nodes();
        const std::vector<double> inner(nodes.begin() + 1, nodes.end() - 1);
        const Study s =
            study(n, [&, degree = p](int m) { return largest(bricks, bricks.solved(m, degree), inner); });
        EXPECT_EQ(n_above(s, &Distance::X, floor_X), n.size());
        EXPECT_GE(slope(s, &Distance::X, floor_X), p + 2 - 0.3) << "lobatto(" << p << ")";
    }
}

TEST(Lobatto, ConvergesBetweenNodesWithOrderPPlus1AndItsDerivativeWithP)
{
    const Bricks bricks;
    const std::vector<double> between{0.05, 0.11, 0.23, 0.31, 0.42, 0.57, 0.64, 0.78, 0.87, 0.96};
    for (auto [p, n] : {std::pair{1, std::vector{256, 320, 400, 500}},
                        {2, {64, 80, 100, 125}},
                        {3, {32, 40, 50, 62}},
                        {4, {16, 20, 25, 31}}}) {
        const Study s =
            study(n, [&, degree = p](int m) { return largest(bricks, bricks.solved(m, degree), between); });
        EXPECT_GE(slope(s, &Distance::X, floor_X), p + 1 - 0.3) << "lobatto(" << p << ")";
        EXPECT_GE(slope(s, &Distance::V, floor_V), p - 0.3) << "lobatto(" << p << ")";
        const Motion m = bricks.solved(n.front(), p);
        EXPECT_EQ(m.order_at_ends, 2 * p);
        EXPECT_EQ(m.dense_order_X, p + 1);
        EXPECT_EQ(m.dense_order_V, p);
    }
}

// Where polynomials have order p + 1, a shortened element from the element's start has 2p.
TEST(Lobatto, SamplesExactlyWithOrder2P)
{
    const Bricks bricks;
    const double t = 0.377;   // 1 - t / end is no fraction of a mesh below
    const State there = last(solve_evenly(bricks.model, t, 20, 12));
    for (auto [p, n] : {std::pair{2, std::vector{64, 80, 100, 125}}, {3, {25, 31, 38, 47}}}) {
        const Study s = study(n, [&, degree = p](int m) {
            SolveOptions options;
            options.tolerance = 1e-14;
            const ExactSample sample =
                sample_exactly(bricks.model, bricks.solved(m, degree), Lobatto{degree}, t, options);
            EXPECT_TRUE(sample.report.converged()) << sample.report.message;
            EXPECT_EQ(sample.state.t, t);
            return distance(sample.state, there);
        });
        EXPECT_GE(slope(s, &Distance::X, 1e-11), 2 * p - 0.7) << "lobatto(" << p << ")";
        EXPECT_GE(slope(s, &Distance::V, 1e-10), 2 * p - 0.7) << "lobatto(" << p << ")";
    }
}

// Reactions too: those of the polynomials have order p.
TEST(Lobatto, SamplesReactionsExactlyWithOrder2P)
{
    const Bricks bricks;
    const double t = 0.377;
    const Motion fine = solve_evenly(bricks.model, t, 20, 12).motion;
    const std::vector<JointSample> there = sample_joints(bricks.model, fine, t);
    ASSERT_EQ(there.size(), bricks.model.joints().size());
    const auto off = [&](const std::vector<JointSample>& here) {
        double largest = 0;
        for (std::size_t j = 0; j < there.size(); ++j)
            largest = std::max(largest, gap_between(here[j], there[j], 1) / size_of(there[j], 1));
        return largest;
    };
    for (auto [p, n] : {std::pair{2, std::vector{64, 80, 100, 125}}, {3, {25, 31, 38, 47}}}) {
        const Study s = study(n, [&, degree = p](int m) {
            const Motion motion = bricks.solved(m, degree);
            const ExactSample sample = sample_exactly(bricks.model, motion, Lobatto{degree}, t);
            EXPECT_TRUE(sample.report.converged()) << sample.report.message;
            EXPECT_TRUE(sample.joints.at(0).is_acceleration_level);
            return Distance{off(sample.joints), off(sample_joints(bricks.model, motion, t))};
        });
        EXPECT_GE(slope(s, &Distance::X, 1e-11), 2 * p - 0.7) << "lobatto(" << p << ")";
        EXPECT_LE(slope(s, &Distance::V, 1e-11), p + 0.7) << "the polynomials, lobatto(" << p << ")";
        EXPECT_LT(100 * s.error.back().X, s.error.back().V);
    }
}

}   // namespace
}   // namespace livens::tests::inside_test
