// SPDX-License-Identifier: BSD-3-Clause
// Motions through positions in which the joints lose rank stay on their branch, wherever elements end.
#include <cmath>
#include <numbers>

#include "livens/diagnostics/sample.h"
#include "mechanisms.h"
#include "parallelograms.h"

namespace livens::tests::singular_test {
namespace {

struct Turn {
    double angle, rate;
};

/// The angle of parallel links by classical Runge-Kutta steps: a witness that knows no joints.
Turn exact(const Parallelograms& p, double duration)
{
    const int n = 40000;
    const long double h = duration / n, k = p.moment() / p.inertia();
    long double x = p.angle, v = p.rate;
    for (int i = 0; i < n; ++i) {
        const long double a1 = k * std::sin(x), v2 = v + h / 2 * a1, a2 = k * std::sin(x + h / 2 * v);
        const long double v3 = v + h / 2 * a2, a3 = k * std::sin(x + h / 2 * v2);
        const long double v4 = v + h * a3, a4 = k * std::sin(x + h * v3);
        x += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
        v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
    return {static_cast<double>(x), static_cast<double>(v)};
}

/// Largest distance of a link's tip from where parallel links have it, at the end of the motion.
double distance(const Parallelograms& p, const Motion& motion, const Turn& turn)
{
    const State end = motion.at_end(motion.n_elements());
    double worst = 0;
    for (int i = 0; i <= p.n; ++i) {
        const Vector3 there = Vector3{i + std::sin(turn.angle), std::cos(turn.angle), 0};
        worst = std::max(worst, norm(end.X[i] * point({1, 0, 0}) - there));
    }
    return worst;
}

/// Fifteen elements of 0.1 s, one of which ends at 1 s + off: there, without gravity, all links lie flat.
TimeMesh ends_near_flat(double off)
{
    TimeMesh mesh{{0}};
    for (int k = 1; k <= 15; ++k) mesh.ends.push_back(0.1 * k + (k == 10 ? off : 0));
    return mesh;
}

Parallelograms steady(int n = 1) { return {n, 0, std::numbers::pi / 2, 0}; }

SolveOptions unguarded()
{
    SolveOptions options;
    options.divide = false;
    return options;
}

TEST(SingularPositions, NoElementEndsThere)
{
    const Parallelograms p = steady();
    const Model model = p.model();
    const Turn turn{1.5 * p.rate, p.rate};
    for (int degree = 3; degree <= 8; ++degree) {
        for (const double off : {0.0, 1e-12, 1e-9, 1e-7, 1e-5}) {
            SCOPED_TRACE(testing::Message() << "degree " << degree << ", off by " << off);
            const Solution s = solve(model, {model.start()}, ends_near_flat(off), Lobatto{degree});
            EXPECT_TRUE(s.report.converged()) << s.report.message;
            EXPECT_GE(s.report.shifted, 1);
            EXPECT_NEAR(s.report.shifted_at, 1, 0.1);
            EXPECT_LT(distance(p, s.motion, turn), degree == 3 ? 1e-9 : 1e-12);
            EXPECT_LT(s.estimate.largest, degree == 3 ? 1e-9 : 1e-11);
            EXPECT_GT(s.report.smallest_pivot, 1e-5);
        }
        // negative control: an end in the flat position
        const Solution s = solve(model, {model.start()}, ends_near_flat(0), Lobatto{degree}, unguarded());
        EXPECT_FALSE(s.report.converged());
        EXPECT_TRUE(s.motion.end() < 1.5 || distance(p, s.motion, turn) > 1e-2);
    }
}

TEST(SingularPositions, NoInnerNodeLiesThere)
{
    const Parallelograms p = steady();
    const Model model = p.model();
    for (const int degree : {4, 6, 8}) {
        TimeMesh mesh{{0}};
        for (int k = 0; k < 15; ++k) mesh.ends.push_back(0.05 + 0.1 * k);
        const Turn turn{mesh.end() * p.rate, p.rate};
        const Solution s = solve(model, {model.start()}, mesh, Lobatto{degree});
        EXPECT_TRUE(s.report.converged()) << s.report.message;
        EXPECT_LT(distance(p, s.motion, turn), 1e-12) << degree;
        EXPECT_GE(s.report.shifted, 1);
        EXPECT_GT(s.motion.n_elements(), 15) << "one was divided";
        const Solution control = solve(model, {model.start()}, mesh, Lobatto{degree}, unguarded());
        EXPECT_TRUE(!control.report.converged() || distance(p, control.motion, turn) > 1e-9) << degree;
    }
}

TEST(SingularPositions, EndsThatAreAskedForStay)
{
    const Parallelograms p = steady();
    const Model model = p.model();
    const std::vector<double> asked{0.95, 1.05};
    const Solution s = solve(model, {model.start()}, make_time_mesh(0, 1.5, 15, asked), Lobatto{6});
    EXPECT_TRUE(s.report.converged()) << s.report.message;
    for (const double t : asked) EXPECT_GE(element_end_at(s.motion.mesh, t), 0);
    // in the flat position itself: told, and no force that is made of rounding
    const std::vector<double> flat{1.0};
    const Solution there = solve(model, {model.start()}, make_time_mesh(0, 1.5, 15, flat), Lobatto{6});
    EXPECT_GE(element_end_at(there.motion.mesh, 1.0), 0);
    EXPECT_LT(there.report.smallest_pivot, 1e-6);
    EXPECT_FALSE(there.verdict.remarks.empty());
    for (const JointSample& joint : sample_joints(model, there.motion, 1.0)) {
        EXPECT_FALSE(joint.is_bounded);
        EXPECT_TRUE(std::isnan(joint.right.force[0]));
    }
    for (const JointSample& joint : sample_joints(model, there.motion, 0.9)) {
        EXPECT_TRUE(joint.is_bounded);
        EXPECT_LT(norm(joint.right.force), 10);
    }
}

/// An output time at the singular position: positions as accurate as asked for, reactions not stated, and the
/// motion goes on.
TEST(SingularPositions, OutputTimesThereAreInsideOfElements)
{
    for (const Parallelograms& p : {steady(), steady(2), steady(3)}) {
        const Model model = p.model();
        for (const double accuracy : {1e-3, 1e-6, 1e-8, 1e-10}) {
            SCOPED_TRACE(testing::Message() << p.n << " loops to " << accuracy);
            const Span span{0, 1.5, accuracy, {0.5, 1.0, 1.25}};
            const Solution s = solve(model, {model.start()}, span, Lobatto{0});
            ASSERT_TRUE(s.report.converged()) << s.report.message;
            EXPECT_TRUE(s.verdict.reasons.empty());
            EXPECT_EQ(element_end_at(s.motion.mesh, 1.0), -1);
            for (const double t : {0.5, 1.25}) EXPECT_GE(element_end_at(s.motion.mesh, t), 0);
            EXPECT_GT(s.report.smallest_pivot, 1e-5);
            const State flat = s.motion.at(1.0);
            double error = 0;
            for (int i = 0; i <= p.n; ++i)
                error = std::max(error, norm(flat.X[i] * point({1, 0, 0}) - Vector3{i + 1.0, 0, 0}));
            EXPECT_LT(error / model.length(), accuracy);
            const int e = s.motion.mesh.element_at(1.0);
            EXPECT_LT(error / model.length(), 3 * s.estimate.error(e) + 1e-14);
            EXPECT_LE(s.estimate.largest, accuracy);
            EXPECT_LT(distance(p, s.motion, {1.5 * p.rate, p.rate}), accuracy);
            for (const JointSample& joint : sample_joints(model, s.motion, 1.0)) {
                EXPECT_FALSE(joint.is_bounded) << "all joints are in the loops";
                EXPECT_TRUE(std::isnan(joint.left.force[0]) && std::isnan(joint.right.torque[2]));
            }
            // a negative control: beside it they are numbers
            for (const double t : {0.95, 1.02})
                for (const JointSample& joint : sample_joints(model, s.motion, t)) {
                    EXPECT_TRUE(joint.is_bounded);
                    EXPECT_LT(norm(joint.left.force), 20) << t;
                }
        }
    }
}

/// A joint beside the loops keeps its reaction where these lose rank.
TEST(SingularPositions, OnlyReactionsOfTheLoopAreNotStated)
{
    const Parallelograms p = steady();
    Model model = p.model();
    const int bob = model.add_body(point_mass("bob", 1, {-3, 0, 0}));
    JointFrame frame;
    frame.point_first = {-2, 0, 0};
    const int beside = model.add_joint(rod("rod", world, bob, frame, 1));
    const Solution s = solve(model, {model.start()}, Span{0, 1.5, 1e-8, {1.0}}, Lobatto{0});
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    const std::vector<JointSample> joints = sample_joints(model, s.motion, 1.0);
    for (int j = 0; j < static_cast<int>(joints.size()); ++j)
        EXPECT_EQ(joints[j].is_bounded, j == beside) << j;
}

/// Where a load jumps at the singular position an element must end: no result is called good.
TEST(SingularPositions, AJumpThereIsToldByName)
{
    const Parallelograms p = steady();
    Model model = p.model();
    model.add_load(point_force("kick", 0, {1, 0, 0}, {0, window(0.5, 1.0, 1.2), 0}, Frame::inertial));
    const Solution s = solve(model, {model.start()}, Span{0, 1.5, 1e-8, {1.0}}, Lobatto{0});
    EXPECT_FALSE(s.report.converged() && s.verdict.reasons.empty());
    EXPECT_TRUE(s.report.message.find("the joints lose rank at t = 1 s") != std::string::npos ||
                s.report.status == SolveStatus::inaccurate)
        << s.report.message;
}

/// The printed digits of the benchmark, and the same for more links, and with bars that bear force.
TEST(SingularPositions, ChainsStayParallelForTenSeconds)
{
    const Turn printed = exact({2}, 10);
    EXPECT_NEAR(std::sin(printed.angle), 0.3284581115408, 1e-11);
    EXPECT_NEAR(std::cos(printed.angle), 0.9445185381786, 1e-11);
    for (const Parallelograms& p : {Parallelograms{2}, Parallelograms{3}, Parallelograms{2, 0, 1, 9.81, 4}}) {
        const Model model = p.model();
        const Turn turn = exact(p, 10);
        for (int degree = 3; degree <= 8; ++degree) {
            for (const int n : {degree % 2 == 0 ? 60 : 100, 137 - degree}) {
                SCOPED_TRACE(testing::Message()
                             << p.n << " loops, degree " << degree << ", " << n << " elements");
                const Solution s = solve(model, {model.start()}, make_time_mesh(0, 10, n), Lobatto{degree});
                ASSERT_TRUE(s.report.converged()) << s.report.message;
                const double error = distance(p, s.motion, turn);
                EXPECT_LT(error, 10 * s.estimate.largest + 1e-9);
                EXPECT_LT(error, degree == 3 ? 1e-3 : degree < 6 ? 1e-4 : 1e-7);
            }
        }
    }
}

TEST(SingularPositions, FiveLoopsStayParallel)
{
    const Parallelograms p{5};
    const Model model = p.model();
    const Turn turn = exact(p, 10);
    for (const int degree : {4, 7}) {
        const Solution s = solve(model, {model.start()}, make_time_mesh(0, 10, 100), Lobatto{degree});
        ASSERT_TRUE(s.report.converged()) << s.report.message;
        EXPECT_LT(distance(p, s.motion, turn), 10 * s.estimate.largest + 1e-9);
        EXPECT_LT(distance(p, s.motion, turn), degree == 4 ? 1e-4 : 1e-8);
    }
}

/// Every family that has its state at the start, within its estimate.
TEST(SingularPositions, ChainsStayParallelByEveryFamily)
{
    const Parallelograms p{2};
    const Model model = p.model();
    struct Run {
        Method method;
        double end;
        int n_elements;
        double allowed;
    };
    for (const Run& run : {Run{Radau{3}, 10, 400, 1e-3}, Run{Radau{5}, 10, 150, 1e-5},
                           Run{Radau{5}, 10, 137, 1e-5}, Run{Mixed{}, 1, 40, 1e-3}}) {
        SCOPED_TRACE(testing::Message() << run.method.index() << ", " << run.n_elements << " elements");
        const Solution s =
            solve(model, {model.start()}, make_time_mesh(0, run.end, run.n_elements), run.method);
        ASSERT_TRUE(s.report.converged()) << s.report.message;
        EXPECT_TRUE(s.verdict.reasons.empty()) << s.verdict.reasons.front();
        const double error = distance(p, s.motion, exact(p, run.end));
        EXPECT_LT(error, 3 * s.estimate.largest + 1e-9);
        EXPECT_LT(error, run.allowed);
    }
}

/// From the state at the end, which looks like a start with the opposite rate: X(-t) has the opposite angle.
TEST(SingularPositions, ChainsStayParallelBackward)
{
    for (const Parallelograms& p : {Parallelograms{2}, Parallelograms{3}, Parallelograms{2, 0, 1, 9.81, 4}}) {
        const Model model = p.model();
        Turn back = exact(p, 10);
        back.angle = -back.angle;
        for (const int n : {60, 137}) {
            SCOPED_TRACE(testing::Message() << p.n << " loops, " << n << " elements");
            const Conditions from_end{model.start(), Known::nothing, model.start(), Known::state};
            const Solution s = solve(model, {from_end}, make_time_mesh(0, 10, n), Lobatto{6});
            ASSERT_TRUE(s.report.converged()) << s.report.message;
            const State start = s.motion.at_end(0);
            double worst = 0;
            for (int i = 0; i <= p.n; ++i)
                worst = std::max(worst, norm(start.X[i] * point({1, 0, 0}) -
                                             Vector3{i + std::sin(back.angle), std::cos(back.angle), 0}));
            EXPECT_LT(worst, 10 * s.estimate.largest + 1e-9);
            EXPECT_LT(worst, 1e-6);
        }
    }
}

TEST(SingularPositions, AreNoHindranceToAnAccuracy)
{
    for (const Parallelograms& p : {Parallelograms{1}, Parallelograms{2}, Parallelograms{2, 0, 1, 9.81, 4}}) {
        const Model model = p.model();
        for (const double accuracy : {1e-3, 1e-6, 1e-9}) {
            SCOPED_TRACE(testing::Message() << p.n << " loops to " << accuracy);
            const Solution s = solve(model, {model.start()}, Span{0, 10, accuracy}, Lobatto{0});
            ASSERT_TRUE(s.report.converged()) << s.report.message;
            EXPECT_LT(distance(p, s.motion, exact(p, 10)) / model.length(), 3 * accuracy);
        }
    }
}

}   // namespace
}   // namespace livens::tests::singular_test
