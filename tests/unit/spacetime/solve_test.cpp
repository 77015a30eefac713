// SPDX-License-Identifier: BSD-3-Clause
// What the one entry refuses, and how it says so.
#include <gtest/gtest.h>

#include <string>

#include "livens/base/error.h"
#include "livens/spacetime/solve.h"

namespace livens {
namespace {

Model stone()
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("stone", 1, {0, 0, 2}));
    return model;
}

/// The complaint about a call, or an empty one.
template <class Call>
Complaint complaint_of(Call call)
{
    try {
        call();
    } catch (const InputError& error) {
        return error.complaint();
    }
    return {};
}

TEST(Solve, NamesSmallNumbersToTheLastDigit)
{
    const Model model = stone();
    SolveOptions options;
    options.tolerance = -1e-9;
    const Complaint refused = complaint_of(
        [&] { solve(model, {model.start()}, make_time_mesh(0, 1, 2), Lobatto{1}, options); });
    EXPECT_EQ(refused.code, "tolerance-out-of-range");
    EXPECT_EQ(refused.value, "-1e-09");

    const Solution fall = solve(model, {model.start()}, make_time_mesh(0, 1e-7, 2), Lobatto{1});
    const Complaint outside = complaint_of([&] { sample_exactly(model, fall.motion, Lobatto{1}, 2e-7); });
    EXPECT_EQ(outside.value + " of " + outside.bound, "2e-07 of 0 to 1e-07");
}

TEST(Solve, ASampleIsNoProgressOfARun)
{
    const Model model = stone();
    const Solution fall = solve(model, {model.start()}, make_time_mesh(0, 1, 2), Lobatto{1});
    SolveOptions options;
    int told = 0;
    options.progress = [&](const Progress&) { return ++told < 0; };   // which would stop a run
    EXPECT_TRUE(sample_exactly(model, fall.motion, Lobatto{1}, 0.3, options).report.converged());
    EXPECT_EQ(told, 0);
}

TEST(Solve, NamesRadauAndRefusesWhatItCannotDo)
{
    EXPECT_EQ(name_of(Radau{3}), "radau(3)");
    Model model;
    model.add_body(point_mass("mass", 1, {}, {1, 0, 0}));
    const TimeMesh mesh = make_time_mesh(0, 1, 4);
    const auto code = [&](const Conditions& conditions, int degree) -> std::string {
        try {
            solve(model, {conditions}, mesh, Radau{degree});
        } catch (const InputError& error) {
            return error.complaint().code + " " + error.complaint().path;
        }
        return "";
    };
    State end = model.start();
    end.t = 1;
    end.X[0].set_column(0, {1, 0, 0});
    EXPECT_EQ(code({model.start()}, 8), "");
    EXPECT_EQ(code({model.start()}, 0), "degree-out-of-range method.degree");
    EXPECT_EQ(code({model.start()}, 10), "degree-out-of-range method.degree");
    EXPECT_EQ(code({model.start(), Known::nothing, end, Known::state}, 4), "boundary-method start.given");
    EXPECT_EQ(code({model.start(), Known::positions, end, Known::positions}, 4),
              "boundary-method start.given");
}

TEST(Solve, AdvisesInConceptsAndNotInTheKeysOfFiles)
{
    const Model model = stone();
    const Problem problem{{model.start(), Known::positions, model.start(), Known::momenta}};
    const Complaint refused = complaint_of(
        [&] { solve(model, problem, make_time_mesh(0, 1, 2), Midpoint{}); });
    EXPECT_EQ(refused.code, "boundary-method");
    for (const std::string& text : {refused.message, refused.bound, refused.note, refused.help})
        EXPECT_EQ(text.find(" = "), std::string::npos) << text;
}

}   // namespace
}   // namespace livens
