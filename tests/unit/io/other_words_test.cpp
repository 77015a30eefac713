// SPDX-License-Identifier: BSD-3-Clause
// What users write who know other programs, and what they are told.
#include "scenario_text.h"

namespace livens::other_words_test {
namespace {

using namespace test;

/// The help of the finding of a code.
std::string help(const std::string& text, std::string_view code)
{
    const ScenarioResult result = read(text);
    const Diagnostic* d = find(result, code);
    if (d == nullptr) return "no " + std::string(code) + " in\n" + shown(result);
    return d->help;
}

TEST(OtherWords, AreAnsweredWithThoseOfScenarios)
{
    const auto joint = [](const std::string& type) {
        return help(replaced(valid_scenario, "type = \"spherical\"", "type = \"" + type + "\""),
                    "unknown-choice");
    };
    EXPECT_EQ(joint("ball"), "livens calls it \"spherical\"");
    EXPECT_EQ(joint("hinge"), "livens calls it \"revolute\"");
    EXPECT_EQ(joint("sphericl"), "did you mean 'spherical'?");
    const auto load = [](const std::string& type) {
        return help(replaced(valid_scenario, "type = \"force\"", "type = \"" + type + "\""),
                    "unknown-choice");
    };
    EXPECT_EQ(load("moment"), "livens calls it \"torque\"");
    EXPECT_EQ(load("damper"), "livens calls it \"spring\" with 'damping' alone");
    EXPECT_EQ(load("torsion_spring"),
              "livens calls it \"spring\" with 'joint', the revolute joint that it is wound about");
    // no word of joints for a load
    EXPECT_EQ(load("ball").find("known here: force, torque"), 0u) << load("ball");
}

TEST(OtherWords, KeysOfOtherKindsAreAnsweredWithWhatServes)
{
    const std::string rod = replaced(valid_scenario, "type = \"spherical\"", "type = \"rod\"");
    EXPECT_EQ(help(rod, "misplaced-key").find("its ends are 'points'"), 0u);
    const std::string torque = replaced(replaced(valid_scenario, "type = \"force\"", "type = \"torque\""),
                                        "body = \"lower\"\nvalue", "joint = \"shoulder\"\nvalue");
    EXPECT_NE(help(torque, "misplaced-key").find("\"actuator\""), std::string::npos);
}

TEST(OtherWords, ShapesAndFormulasAreShown)
{
    const std::string shape = "shape = { box = [1, 0.2, 0.1] }";
    EXPECT_EQ(help(replaced(valid_scenario, shape, "shape = [1, 0.2, 0.1]"), "wrong-type"),
              "tables are written in braces: shape = { box = [1, 0.2, 0.1] }");
    EXPECT_NE(help(replaced(valid_scenario, "inertia = [0.2, 0.3, 0.4]\n", ""), "mass-missing")
                  .find("shape = { point = true }"),
              std::string::npos);
    const ScenarioResult formula =
        read(replaced(valid_scenario, "value = [0, 1, 0]", "value = [0, \"sin(t)\", 0]"));
    ASSERT_NE(find(formula, "expression-name"), nullptr);
    EXPECT_EQ(find(formula, "expression-name")->note,
              "a formula is given as 'expression', instead of 'value'");
    const auto expression = [](const std::string& y) {
        return replaced(valid_scenario, "value = [0, 1, 0]", "expression = [\"0\", \"" + y + "\", \"0\"]");
    };
    EXPECT_EQ(help(expression("t**2"), "expression-syntax"), "a power is written x^2");
    EXPECT_EQ(help(expression("time"), "expression-name").find("did you mean 't'?"), 0u);
    EXPECT_EQ(help(expression("temp"), "expression-name").find("known are t, pi"), 0u);
}

TEST(OtherWords, AForgottenTypeIsToldByTheOtherKeys)
{
    const std::string sensor = "[[sensor]]\nname = \"s\"\nload = \"push\"\n\n[time]";
    EXPECT_EQ(help(replaced(valid_scenario, "[time]", sensor), "missing-key"), "write type = \"load\"");
    // a ball and a weld alike are told by a point
    EXPECT_EQ(help(replaced(valid_scenario, "type = \"spherical\"\n", ""), "missing-key"), "");
}

TEST(OtherWords, WhatIsThereAndFaultyIsNotUnknown)
{
    const std::string spring =
        "[[load]]\nname = \"s\"\ntype = \"spring\"\nbetween = [\"world\", \"upper\"]\n"
        "stiffness = 1\nlength = 1\n[[sensor]]\nname = \"force\"\ntype = \"load\"\nload = \"s\"\n\n[time]";
    const ScenarioResult faulty = read(replaced(valid_scenario, "[time]", spring));
    ASSERT_NE(find(faulty, "unknown-key"), nullptr) << shown(faulty);
    EXPECT_EQ(find(faulty, "unknown-key")->help, "its length without force is 'free_length'");
    EXPECT_EQ(find(faulty, "load-unknown"), nullptr) << shown(faulty);
    EXPECT_NE(find(read(replaced(valid_scenario, "[time]", replaced(spring, "load = \"s\"", "load = \"t\""))),
                   "load-unknown"),
              nullptr);
}

/// Numbers of a rod's end that are those of a place in the world, and make another mechanism.
TEST(OtherWords, PointsThatAreMeantInTheWorldAreToldApart)
{
    const auto rod = [](const std::string& points) {
        return replaced(valid_scenario,
                        "type = \"spherical\"\nbetween = [\"upper\", \"lower\"]\nat = [1, 0, 0]",
                        "type = \"rod\"\nbetween = [\"world\", \"upper\"]\npoints = " + points);
    };
    const ScenarioResult meant_in_world = read(rod("[[0, 0, 1], [0.9, 0, 0]]"));
    const Diagnostic* d = find(meant_in_world, "point-outside");
    ASSERT_NE(d, nullptr) << shown(meant_in_world);
    EXPECT_EQ(d->severity, Severity::warning);
    EXPECT_NE(d->message.find("at (1.4, 0, 0) in the world"), std::string::npos) << d->message;
    EXPECT_EQ(d->help, "of the place (0.9, 0, 0) in the world they are [0.4, 0, 0]");
    for (const char* good : {"[[0, 0, 1], [0.4, 0, 0]]",   // on the body
                             "[[0.9, 0, 1], [0, 0, 0]]",   // the world's are places
                             "[[0, 0, 1], [0, 0, 3]]"})    // an arm, either way
        EXPECT_EQ(find(read(rod(good)), "point-outside"), nullptr) << good;
}

}   // namespace
}   // namespace livens::other_words_test
