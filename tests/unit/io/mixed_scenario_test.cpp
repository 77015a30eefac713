// SPDX-License-Identifier: BSD-3-Clause
// The family mixed and conditions at both ends: what arrives, and what is told where.
#include <filesystem>

#include "livens/io/results.h"
#include "livens/io/scenario/builder.h"
#include "livens/solvers/sparse.h"
#include "unit/io/scenario_text.h"

namespace livens::mixed_scenario_test {

namespace {

using test::expect_error;
using test::find;
using test::read;
using test::replaced;
using test::shown;

Scenario good(const std::string& text)
{
    ScenarioResult result = read(text);
    EXPECT_TRUE(result.scenario.has_value()) << shown(result);
    return result.scenario ? std::move(*result.scenario) : Scenario();
}

/// The valid scenario with this [method] and [time].
std::string solved_by(const std::string& method, const std::string& time = "end = 1\nelements = 10")
{
    return replaced(replaced(test::valid_scenario, "[method]\ndegree = 4\n", "[method]\n" + method + "\n"),
                    "end = 1\nelements = 10", time);
}

std::string mixed(const std::string& lines, const std::string& time = "end = 1\nelements = 10")
{
    return solved_by("family = \"mixed\"\n" + lines, time);
}

std::string splines(const std::string& knots, const std::string& lines = "",
                    const std::string& time = "end = 1")
{
    return mixed("basis = \"bspline\"\nknots = " + knots + "\n" + lines, time);
}

std::string nurbs(const std::string& weights)
{
    return mixed("basis = \"nurbs\"\nknots = [0, 0, 0, 0.5, 1, 1, 1]\nweights = " + weights, "end = 1");
}

Mixed method_of(const std::string& text) { return std::get<Mixed>(good(text).method); }

/// A free body, and what is known of it at the end of time.
std::string one_body(const std::string& end, const std::string& rest, const std::string& body = "")
{
    return "format = 1\n[[body]]\nname = \"b\"\nmass = 2\ninertia = [1, 2, 2]\n" + body + end +
           "\n[time]\nend = 3\nelements = 4\n[method]\nfamily = \"mixed\"\n" + rest;
}
const std::string at_the_end = "[body.end]\n";
const std::string state_at_end = "[start]\ngiven = \"nothing\"\n[end]\ngiven = \"state\"\n";

// --- [method]

TEST(MixedScenario, DefaultsAreThoseOfTheLibrary)
{
    const Mixed read = method_of(mixed("")), library;
    EXPECT_EQ(read.basis, library.basis);
    EXPECT_EQ(read.degree, library.degree);
    EXPECT_EQ(read.start, library.start);
    EXPECT_EQ(read.multipliers, library.multipliers);
    EXPECT_EQ(read.gauss_points, library.gauss_points);
    EXPECT_EQ(read.window, library.window);
    EXPECT_EQ(read.interfaces, library.interfaces);
    EXPECT_EQ(read.first_guess, library.first_guess);
    EXPECT_EQ(read.end_multiplier, library.end_multiplier);
    EXPECT_EQ(read.linear_solver, library.linear_solver);
    EXPECT_TRUE(read.knots.empty() && read.weights.empty());
}

TEST(MixedScenario, ChoicesArrive)
{
    const Mixed m = method_of(mixed("basis = \"bspline\"\ndegree = 3\nmomentum = \"strong\"\n"
                                    "multipliers = \"lower\"\ngauss_points = 7\nwindow = 5\n"
                                    "interfaces = \"project\"\nfirst_guess = \"steady\""));
    EXPECT_EQ(m.first_guess, Mixed::FirstGuess::steady);
    EXPECT_EQ(m.basis, Mixed::Basis::bspline);
    EXPECT_EQ(m.degree, 3);
    EXPECT_EQ(m.start, Mixed::Start::strong);
    EXPECT_EQ(m.multipliers, Mixed::Multipliers::lower);
    EXPECT_EQ(m.gauss_points, 7);
    EXPECT_EQ(m.window, 5);
    EXPECT_EQ(m.interfaces, Mixed::Interfaces::project);
    EXPECT_EQ(method_of(mixed("window = \"all\"")).window, 0);
    EXPECT_EQ(method_of(nurbs("[1, 2, 1, 1]")).weights, (std::vector<double>{1, 2, 1, 1}));
}

TEST(MixedScenario, EndMultipliersBelongToTheNaturalEqualPairing)
{
    EXPECT_EQ(method_of(mixed("end_multiplier = \"zero\"")).end_multiplier, Mixed::EndMultiplier::zero);
    for (const char* other : {"momentum = \"strong\"", "multipliers = \"lower\""})
        expect_error(mixed("end_multiplier = \"zero\"\n" + std::string(other)), "misplaced-key", "\"zero\"");
}

TEST(RadauScenario, HasADegreeAndTheStateAtTheStart)
{
    const std::string radau = "family = \"radau\"\n";
    EXPECT_EQ(std::get<Radau>(good(solved_by(radau)).method).degree, 4);
    EXPECT_EQ(std::get<Radau>(good(solved_by(radau + "degree = 8")).method).degree, 8);
    expect_error(solved_by(radau + "degree = 9"), "out-of-range", "9\n");
    expect_error(solved_by(radau + "window = 2"), "misplaced-key", "window");
    const std::string resolved = good(solved_by(radau)).resolved;
    EXPECT_NE(resolved.find(R"({"family": "radau", "degree": 4, )"), std::string::npos) << resolved;
}

TEST(MixedScenario, ConditionIsAskedForInEveryFamily)
{
    EXPECT_FALSE(good(mixed("")).options.condition);
    EXPECT_FALSE(good(mixed("condition = false")).options.condition);
    for (const char* family : {"mixed", "lobatto", "midpoint", "endpoint"}) {
        const std::string lines = "family = \"" + std::string(family) + "\"\ncondition = true";
        EXPECT_TRUE(good(solved_by(lines)).options.condition) << family;
    }
}

TEST(MixedScenario, WindowsBelongToElementsAlone)
{
    for (const char* family : {"midpoint", "endpoint"})
        expect_error(solved_by("family = \"" + std::string(family) + "\"\nwindow = 2"), "misplaced-key",
                     "window");
}

TEST(MixedScenario, LinearSolversOfOtherBuildsAreRefusedByName)
{
    const std::string text = mixed("linear_solver = \"umfpack\"");
    if (has_backend(SparseBackend::umfpack))
        EXPECT_EQ(method_of(text).linear_solver, SparseBackend::umfpack);
    else
        expect_error(text, "backend-missing", "\"umfpack\"");
}

TEST(MixedScenario, ResolvedStatesEveryChoice)
{
    const std::string resolved = good(mixed("")).resolved;
    EXPECT_NE(resolved.find(R"("method": {"family": "mixed", "basis": "lagrange", "degree": 2, )"
                            R"("momentum": "natural", "multipliers": "equal", "end_multiplier": "smooth", )"
                            R"("gauss_points": "exact", )"
                            R"("window": "all", "interfaces": "carry", "first_guess": "march", )"
                            R"("linear_solver": "eigen", "tolerance": 1e-14, )"),
              std::string::npos)
        << resolved;
    EXPECT_NE(good(splines("[0, 0, 0, 0.5, 1, 1, 1]")).resolved.find(R"("knots": [0, 0, 0, 0.5, 1, 1, 1])"),
              std::string::npos);
}

// --- knots make the elements

TEST(MixedScenario, KnotsMakeTheMesh)
{
    const Scenario s = good(splines("[0, 0, 0, 0.2, 0.5, 0.5, \"600 ms\", 1, 1, 1]"));
    EXPECT_EQ(std::get<TimeMesh>(s.time).ends, (std::vector<double>{0, 0.2, 0.5, 0.6, 1}));
    EXPECT_EQ(s.output, std::get<TimeMesh>(s.time).ends);
    EXPECT_NE(s.resolved.find(R"("elements": 4)"), std::string::npos);
    const Scenario listed = good(splines("[0, 0, 0, 0.2, 0.5, 1, 1, 1]", "", "end = 1\noutput = [0.2, 1]"));
    EXPECT_EQ(listed.output, (std::vector<double>{0.2, 1}));
    good(splines("[0, 0, 0, 0.25, 0.5, 1, 1, 1]", "", "end = 1\nelements = 3"));
}

TEST(MixedScenario, KnotsThatDoNotFitTheTimeAreRefused)
{
    const std::string knots = "[0, 0, 0, 0.5, 1, 1, 1]";
    const auto refused = [&](const std::string& time, const std::string& where) {
        expect_error(splines(knots, "", time), "knots-mesh", where);
    };
    refused("end = 2", "[0, 0, 0, 0.5");
    refused("start = 0.25\nend = 1", "[0, 0, 0, 0.5");
    refused("end = 1\nelements = 3", "3\n\n[method]");
    refused("end = 1\noutput = 0.25", "0.25\n");
    refused("end = 1\noutput = [0.5, 0.75]", "[0.5, 0.75]");
}

TEST(MixedScenario, LoadsBreakAtKnotsOrAreIgnored)
{
    const auto text = [](const std::string& knots, const std::string& time) {
        return replaced(splines(knots, "", time), "value = [0, 1, 0]", "value = [0, 1, 0]\nuntil = 0.3");
    };
    const std::string beside = "[0, 0, 0, 0.5, 1, 1, 1]", on = "[0, 0, 0, 0.3, 0.3, 1, 1, 1]";
    expect_error(text(beside, "end = 1"), "knots-mesh", beside);
    EXPECT_EQ(std::get<TimeMesh>(good(text(beside, "end = 1\nbreaks = \"ignore\"")).time).n_elements(), 2);
    EXPECT_EQ(std::get<TimeMesh>(good(text(on, "end = 1")).time).n_elements(), 2);
}

TEST(MixedScenario, KnotsAndWeightsBelongToTheirBases)
{
    expect_error(mixed("knots = [0, 0, 0, 1, 1, 1]"), "misplaced-key", "[0, 0, 0, 1");
    expect_error(splines("[0, 0, 0, 0.5, 1, 1, 1]", "weights = [1, 1, 1, 1]"), "misplaced-key",
                 "[1, 1, 1, 1]");
    expect_error(mixed("basis = \"nurbs\""), "missing-key", "\"nurbs\"");
}

// --- memory

TEST(MixedScenario, AHundredThousandElementsOfOneBodyFit)
{
    const auto text = [](const std::string& lines, const std::string& elements) {
        return replaced(one_body("", lines), "elements = 4", "elements = " + elements);
    };
    good(text("degree = 1", "100000"));
    expect_error(text("degree = 2", "100000"), "resource-limit", "100000");
    good(text("degree = 2\nwindow = 1000", "100000"));
    expect_error(text("degree = 4\nwindow = 1000", "10000000"), "resource-limit", "10000000");   // the motion
}

// --- conditions at both ends

TEST(BoundaryScenario, TheStartIsGivenUnlessSaid)
{
    const Scenario s = good(test::valid_scenario);
    EXPECT_EQ(s.conditions.at_start, Known::state);
    EXPECT_EQ(s.conditions.at_end, Known::nothing);
    EXPECT_EQ(s.conditions.start.X, s.model.start().X);
    EXPECT_EQ(s.conditions.start.V, s.model.start().V);
    EXPECT_EQ(s.conditions.start.t, 0);
    EXPECT_EQ(s.conditions.end.t, 1);
}

TEST(BoundaryScenario, StatesAtTheEndAreReadAsThoseAtTheStart)
{
    const std::string lines = "position = [1, 2, 3]\nrotation_vector = [0, 0, \"90 deg\"]\n"
                              "velocity = [4, 5, \"6 km/h\"]\n";
    for (const char* spin : {"angular_velocity = [0, 2, 0]", "angular_velocity_body = [2, 0, 0]"}) {
        const Scenario at_end = good(one_body(at_the_end + lines + spin, state_at_end));
        const Scenario at_start = good(one_body("", "", lines + spin));
        EXPECT_EQ(at_end.conditions.at_start, Known::nothing);
        EXPECT_EQ(at_end.conditions.at_end, Known::state);
        ASSERT_EQ(at_end.conditions.end.X.size(), 1u);
        EXPECT_EQ(at_end.conditions.end.X, at_start.conditions.start.X);
        EXPECT_EQ(at_end.conditions.end.V, at_start.conditions.start.V);
        EXPECT_EQ(at_end.conditions.end.t, 3);
        EXPECT_EQ(at_end.conditions.start.X[0].column(0), (Vector3{0, 0, 0})) << "of [[body]], a guess";
        EXPECT_NE(at_end.resolved.find(R"("start": {"given": "nothing", "initial": "check"}, )"
                                       R"("end": {"given": "state"})"),
                  std::string::npos);
    }
}

TEST(BoundaryScenario, EveryFullPairOfConditionsIsTaken)
{
    for (const auto& [start, end] :
         {std::pair("state", "nothing"), std::pair("nothing", "state"), std::pair("positions", "positions"),
          std::pair("positions", "momenta"), std::pair("momenta", "positions")}) {
        const bool has_end = end != std::string("nothing");
        const Scenario s =
            good(one_body(has_end ? at_the_end : "", "[start]\ngiven = \"" + std::string(start) +
                                                         "\"\n[end]\ngiven = \"" + end + "\"\n"));
        EXPECT_EQ(s.conditions.end.X.size(), has_end ? 1u : 0u) << start << ", " << end;
    }
}

TEST(BoundaryScenario, PointMassesHaveAnEndWithoutOrientation)
{
    const std::string text = "format = 1\n[[body]]\nname = \"b\"\nshape = { point = true }\nmass = 2\n"
                             "[body.end]\nposition = [1, 2, 3]\n[time]\nend = 1\nelements = 4\n[method]\n"
                             "family = \"mixed\"\n" +
                             state_at_end;
    EXPECT_EQ(good(text).conditions.end.X[0], (Matrix34{1, 2, 3}));
    expect_error(replaced(text, "position = [1, 2, 3]", "quaternion = [1, 0, 0, 0]"), "point-mass",
                 "[1, 0, 0, 0]");
}

TEST(BoundaryScenario, EveryBodyNeedsItsEnd)
{
    expect_error(one_body("", state_at_end), "missing-key", "[[body]]");
    expect_error(one_body(at_the_end, ""), "boundary-conditions", "[body.end]");
    expect_error(one_body(at_the_end, "[end]\n"), "boundary-conditions", "[body.end]");
}

TEST(BoundaryScenario, WhatIsWrongAtTheEndIsShownThere)
{
    const auto refused = [](const std::string& line, const char* code, const std::string& where) {
        expect_error(
            one_body(at_the_end + line, state_at_end,
                     "directors = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\nangular_velocity = [0, 0, 0]\n"),
            code, where);
    };
    refused("directors = [[0, 1, 0], [1, 0, 0], [0, 0, 1]]", "directors-left-handed", "[[0, 1");
    refused("directors = [[1, 0, 0], [0, 1, 0], [0, 0.1, 1]]", "directors-not-orthonormal",
            "[[1, 0, 0], [0, 1, 0], [0, 0.1");
    refused("quaternion = [1, 1, 0, 0]", "quaternion-norm", "[1, 1, 0, 0]");
    refused("quaternion = [1, 0, 0, 0]\nrotation_vector = [9, 0, 0]", "orientation-conflict", "[9, 0");
    refused("angular_velocity = [9, 0, 0]\nangular_velocity_body = [8, 0, 0]", "rates-conflict", "[8, 0");
    refused("position = [9, 0]", "wrong-type", "[9, 0]");
}

TEST(BoundaryScenario, JointsMustBeClosedAtTheEndToo)
{
    const std::string rod = "\n[[joint]]\nname = \"r\"\ntype = \"rod\"\nbetween = [\"world\", \"b\"]\n";
    const auto text = [&](const std::string& end) {
        return one_body(at_the_end + end + rod, state_at_end, "position = [1, 0, 0]\n");
    };
    good(text("position = [0, 1, 0]"));
    expect_error(text("position = [0, 1.5, 0]"), "end-position", "[body.end]");
    const ScenarioResult result = read(text("position = [0, 1.5, 0]"));
    const Diagnostic& d = *find(result, "end-position");
    EXPECT_EQ(d.message.rfind("joint 'r' (row 'distance') is open at the end of time", 0), 0u) << d.message;
    EXPECT_EQ(d.message.find("start"), std::string::npos) << d.message;
    expect_error(text("position = [0, 1, 0]\nvelocity = [0, 9, 0]"), "end-velocity", "[body.end]");
    // Positions alone: velocities are guesses and need not fit.
    good(one_body(at_the_end + "position = [0, 1, 0]\nvelocity = [0, 9, 0]" + rod,
                  "[start]\ngiven = \"positions\"\n[end]\ngiven = \"positions\"\n",
                  "position = [1, 0, 0]\nvelocity = [1, 0, 0]\n"));
}

TEST(BoundaryScenario, ConditionsThatMakeNoMotionPointAtTheTables)
{
    const auto refused = [](const std::string& conditions, const std::string& where) {
        const bool has_end = conditions.find("[end]") != std::string::npos;
        expect_error(one_body(has_end ? at_the_end : "", conditions), "boundary-conditions", where);
    };
    refused("[end]\ngiven = \"positions\"\n", "\"positions\"");
    refused("[start]\ngiven = \"positions\"\n", "\"positions\"");
    refused("[start]\ngiven = 'momenta'\n[end]\ngiven = \"momenta\"\n", "\"momenta\"");
    good(replaced(one_body(at_the_end, state_at_end), "family = \"mixed\"", "family = \"lobatto\""));
    expect_error(replaced(one_body(at_the_end, state_at_end), "family = \"mixed\"", "family = \"midpoint\""),
                 "boundary-method", "\"nothing\"");
}

TEST(Advice, OfTheCoreIsSpelledInTheKeysOfTheFile)
{
    const ScenarioResult refused =
        read(replaced(one_body(at_the_end, state_at_end), "family = \"mixed\"", "family = \"midpoint\""));
    ASSERT_EQ(refused.diagnostics.size(), 1u) << shown(refused);
    EXPECT_NE(refused.diagnostics[0].help.find("(family = \"lobatto\" in [method])"), std::string::npos)
        << shown(refused);

    const auto help_for = [](const std::string& keys) {
        const ScenarioResult result = read(mixed(keys));
        return result.diagnostics.size() == 1 ? result.diagnostics[0].help : shown(result);
    };
    EXPECT_EQ(help_for("degree = 2\nmultipliers = \"lower\"\nwindow = 2"),
              "use projected interfaces or equal multipliers, or a single block "
              "(multipliers = \"equal\", interfaces = \"project\")");
    EXPECT_NE(help_for("degree = 2\ngauss_points = 2").find("(momentum = \"strong\")"), std::string::npos);

    Complaint open{"start-position", "", "", "", "", "", "correct it, or let the start be projected"};
    EXPECT_EQ(help_in_toml(open), open.help + " (initial = \"project\" in [start])");
    open.help = "change the sign of one director";
    EXPECT_EQ(help_in_toml(open), open.help) << "nothing was said of projection";
    open = {"name-empty", "", "", "", "", "", "projected"};
    EXPECT_EQ(help_in_toml(open), "projected") << "another code";
}

}   // namespace
}   // namespace livens::mixed_scenario_test

namespace livens {

std::vector<test::Case> test::cases_of_mixed()
{
    using namespace mixed_scenario_test;
    const std::string lamina =
        replaced(replaced(mixed(""), "[0.2, 0.3, 0.4]", "[1, 2, 3]"), "mass = 2", "mass = 1");
    return {
        {"boundary-conditions", one_body(at_the_end, "[end]\ngiven = \"positions\"\n"), "\"positions\""},
        {"boundary-method",
         replaced(one_body(at_the_end, state_at_end), "family = \"mixed\"", "family = \"midpoint\""),
         "\"nothing\""},
        {"estimate-method", replaced(mixed(""), "[method]\n", "[method]\nestimate = \"local\"\n"),
         "\"local\""},
        {"knots-decreasing", splines("[0, 0, 0, 0.6, 0.5, 1, 1, 1]"), "[0, 0, 0, 0.6"},
        {"knots-few", splines("[0, 0, 0, 1, 1]"), "[0, 0, 0, 1"},
        {"knots-mesh", splines("[0, 0, 0, 0.5, 2, 2, 2]"), "[0, 0, 0, 0.5"},
        {"knots-multiplicity", splines("[0, 0, 0, 0.5, 0.5, 0.5, 1, 1, 1]"), "[0, 0, 0, 0.5"},
        {"knots-not-clamped", splines("[0, 0, 0.25, 0.5, 0.75, 1, 1, 1]"), "[0, 0, 0.25"},
        {"mass-singular", lamina, "[1, 2, 3]"},
        {"mixed-block",
         mixed("basis = \"bspline\"\nknots = [0, 0, 0, 0.5, 1, 1, 1]\nwindow = 1 # one", "end = 1"),
         "1 # one"},
        {"mixed-pairing", mixed("gauss_points = 1 # one"), "1 # one"},
        {"spline-degree", mixed("basis = \"bspline\"\ndegree = 8 # high", "end = 1\nelements = 4"),
         "8 # high"},
        {"weights-count", nurbs("[1, 1, 1]"), "[1, 1, 1]"},
        {"weights-not-positive", nurbs("[1, -1, 1, 1]"), "[1, -1"},
    };
}

}   // namespace livens
