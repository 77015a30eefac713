// SPDX-License-Identifier: BSD-3-Clause
// What the arrival of motions between both ends is to their start, against marches from changed starts.
#include <cmath>
#include <random>

#include "convergence/studies.h"
#include "livens/dynamics/start/consistent_start.h"
#include "livens/multibody/model.h"

namespace livens::tests::arrival_test {
namespace {

struct Between {
    std::string name;
    Model model;
    double end;
    Solution solution{};
};

/// Between the places of a march from where the model is after a while.
Between between(const std::string& name, const Model& model, double before, double end)
{
    Between run{name, model, end};
    State start = last(solve_evenly(model, before, 20, 8));
    start.t = 0;
    const Motion march = solve(model, {{start}}, make_time_mesh(0, end, 40), Lobatto{8}).motion;
    const livens::Problem problem{{march.at_end(0), Known::positions, march.at_end(40), Known::positions}};
    run.solution = solve(model, problem, make_time_mesh(0, end, 40), Lobatto{8});
    EXPECT_TRUE(run.solution.report.converged()) << name << ": " << run.solution.report.message;
    return run;
}

/// Shifts of centres of mass by the model's length and turns, the larger; of velocities likewise.
double motion_between(const Model& model, const State& a, const State& b)
{
    double largest = 0;
    for (int i = 0; i < model.n_bodies(); ++i) {
        const BodyGap gap = gap_between(a, b, model.bodies()[i], i, model.length());
        largest = std::max({largest, gap.position, gap.orientation});
    }
    return largest;
}

double rate_between(const Model& model, const State& a, const State& b)
{
    double largest = 0;
    for (std::size_t i = 0; i < a.X.size(); ++i) {
        const Body& body = model.bodies()[i];
        const Vector3 centre = body.is_point ? Vector3{} : mass_properties(body.mass).center_of_mass;
        const Matrix34 gap = b.V[i] - a.V[i];
        const Vector3 v =
            gap.column(0) + centre[0] * gap.column(1) + centre[1] * gap.column(2) + centre[2] * gap.column(3);
        largest = std::max(largest, norm(v) / model.length());
        if (!body.is_point)
            largest =
                std::max(largest, norm(angular_velocity(a.X[i], b.V[i]) - angular_velocity(a.X[i], a.V[i])));
    }
    return largest;
}

/// By what marches from starts with other rates arrive elsewhere: the most of so many directions.
double arrival_of_marches(const Between& run, int n_directions)
{
    std::mt19937 chance(7);
    std::normal_distribution<double> any;
    const auto march = [&](const State& start) {
        SolveOptions options;
        options.initial = StartPolicy::project;
        options.estimate = SolveOptions::Estimate::none;
        return solve(run.model, {{start}}, make_time_mesh(0, run.end, 40), Lobatto{8}, options).motion;
    };
    const Motion straight = march(run.solution.motion.at_end(0));
    double most = 0;
    for (int i = 0; i < n_directions; ++i) {
        State start = straight.at_end(0);
        for (std::size_t b = 0; b < start.X.size(); ++b) {
            const Vector3 v{any(chance), any(chance), any(chance)}, w{any(chance), any(chance), any(chance)};
            start.V[b] += run.model.bodies()[b].is_point ? configuration(1e-6 * v, Matrix3{})
                                                         : rate(start.X[b], 1e-6 * v, 1e-6 * w);
        }
        const Motion moved = march(start);
        most = std::max(most, motion_between(run.model, straight.at_end(40), moved.at_end(40)) /
                                  rate_between(run.model, straight.at_end(0), moved.at_end(0)));
    }
    return most;
}

TEST(Arrival, IsWhatMarchesFromChangedStartsSay)
{
    Model thrown({0, 0, -9.81});
    thrown.add_body(point_mass("ball", 1, {}, {3, 0, 4}));
    Model hinged({0, -9.81, 0});
    const int bar = hinged.add_body(rigid_body("bar", brick({})));
    hinged.add_joint(revolute("hinge", world, bar, {}));
    const Between ball = between("ball", thrown, 0.1, 0.7);
    // nothing but the time that it flies, by factors that are not refined
    EXPECT_NEAR(ball.solution.report.arrival, 0.7, 1e-11);
    // one freedom has one direction
    for (const Between& run :
         {between("pendulum", hinged, 0.2, 0.4), between("four-bar", four_bar(), 0.2, 1)}) {
        const double found = run.solution.report.arrival, expected = arrival_of_marches(run, 1);
        tell(run.name + ", s", found);
        EXPECT_NEAR(found, expected, 1e-4 * expected) << run.name;
    }
    // of more the one that moves most, by sums of squares
    for (const Between& run : {between("double pendulum", cubes_on_rods(0.1), 0.3, 2),
                               between("two bricks", two_bricks(), 0.2, 0.5)}) {
        const double found = run.solution.report.arrival, most = arrival_of_marches(run, 60);
        tell(run.name + ", s", found);
        tell(run.name + ", marches, s", most);
        EXPECT_LE(most, 1.5 * found) << run.name;
        EXPECT_GE(most, 0.4 * found) << run.name;
    }
}

TEST(Arrival, IsNotAskedOfMarches)
{
    const Solution s = solve(two_bricks(), {{two_bricks().start()}}, make_time_mesh(0, 0.2, 4), Lobatto{4});
    EXPECT_EQ(s.report.arrival, 0);
}

}   // namespace
}   // namespace livens::tests::arrival_test
