// SPDX-License-Identifier: BSD-3-Clause
// The paper's elements with halves of the state at both ends of time.
#include "convergence/studies.h"
#include "livens/base/error.h"
#include "mixed_problems.h"

namespace livens::tests::mixed_ends_test {
namespace {

State at_rest(State state)
{
    for (Matrix34& V : state.V) V = {};
    return state;
}

/// The largest error of X at element ends of a motion with these conditions, whose start is stated at rest.
double recovered(const Model& model, const Motion& exact, Known at_start, Known at_end, const Method& method,
                 int n)
{
    SolveOptions options;
    options.judge = false;
    State start = exact.at_end(0);
    if (!knows_momenta(at_start)) start = at_rest(start);
    const Solution s = solve(model, {{start, at_start, exact.at_end(exact.n_elements()), at_end}},
                             make_time_mesh(0, exact.end(), n), method, options);
    EXPECT_TRUE(s.report.converged()) << name_of(method) << ": " << s.report.message;
    if (!s.report.converged()) return 1e300;
    double error = 0;
    for (int end = 0; end <= n; ++end)
        error = std::max(error, distance(s.motion.at_end(end), exact.at(s.motion.mesh.ends[end])).X);
    return error;
}

TEST(MixedEnds, PositionsAtTheStartAndMomentaAtTheEndAreFoundFromRest)
{
    const Model model = cubes_on_rods(0.1);
    const Motion exact = solve_evenly(model, 1, 80, 8).motion;
    for (const auto multipliers : {equal, lower})
        for (const int p : {2, 3, 4}) {
            const double error = recovered(model, exact, Known::positions, Known::momenta,
                                           mixed({lagrange, p, natural, multipliers}), 40);
            EXPECT_LT(error, p == 2 ? 5e-3 : 1e-4) << p;
        }
}

TEST(MixedEnds, MomentaAtBothEndsFindTheMotionOfWhatIsHeld)
{
    const struct {
        Model model;
        double end;
        std::vector<int> n;
    } cases[] = {{hinged_links(), 0.5, {8, 16, 32}}, {four_bar(), 1, {32}}};
    for (const auto& [model, end, meshes] : cases) {
        State start = last(solve_evenly(model, 0.2, 20, 8));
        start.t = 0;
        const Motion exact = solve(model, {start}, make_time_mesh(0, end, 80), Lobatto{8}).motion;
        for (const auto multipliers : {equal, lower}) {
            const Mixed method = mixed({lagrange, 3, natural, multipliers});
            Study s{meshes, {}};
            for (const int n : s.n)
                s.error.push_back({recovered(model, exact, Known::momenta, Known::momenta, method, n), 0});
            if (meshes.size() > 2) {
                EXPECT_NEAR(slope(s, &Distance::X, 0), 4, 0.2) << name_of(method);
            }
            EXPECT_LT(s.error.back().X, 1e-3) << name_of(method);
        }
    }
}

TEST(MixedEnds, MomentaAtBothEndsOfWhatIsFreeAreRefusedWithItsMotion)
{
    const Model model = free_box({1, 0, 0});
    const State state = model.start();
    try {
        solve(model, {{state, Known::momenta, state, Known::momenta}}, make_time_mesh(0, 1, 10), Mixed{});
        FAIL() << "the box may be anywhere";
    } catch (const InputError& error) {
        EXPECT_EQ(error.complaint().code, "boundary-conditions");
        EXPECT_NE(error.complaint().message.find("'box'"), std::string::npos);
        EXPECT_NE(error.complaint().note.find("displaced in any direction"), std::string::npos);
    }
}

}   // namespace
}   // namespace livens::tests::mixed_ends_test
