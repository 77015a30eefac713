// SPDX-License-Identifier: BSD-3-Clause
// Numbers that are computed while a scenario is read, and the parameters that they are computed from.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "livens/io/scenario/text/parameters.h"
#include "scenario_text.h"

namespace livens::parameters_test {

namespace {

using namespace test;

constexpr double pi = std::numbers::pi;

/// Parameters of a table's lines.
struct Table {
    explicit Table(const std::string& lines, const std::vector<Override>& overrides = {})
        : root(parse_toml("[parameters]\n" + lines, findings)),
          parameters(root->find("parameters"), overrides, findings)
    {}
    std::vector<Diagnostic> found() { return findings.take("test.toml"); }

    Findings findings;
    std::optional<Node> root;
    Parameters parameters;
};

double value(std::string_view text, std::string_view unit, const std::string& lines = "")
{
    Table table(lines);
    EXPECT_EQ(table.findings.n_errors(), 0) << lines;
    const Computed found = compute(text, unit, table.parameters);
    EXPECT_EQ(found.code, "") << text << ": " << found.error;
    return found.amount.value;
}

std::string fault(std::string_view text, std::string_view unit, const std::string& lines = "")
{
    Table table(lines);
    EXPECT_EQ(table.findings.n_errors(), 0) << lines;
    const Computed found = compute(text, unit, table.parameters);
    EXPECT_NE(found.code, "") << text << " is " << found.amount.value;
    return found.error;
}

TEST(Computed, NumbersHaveUnitsAnywhere)
{
    EXPECT_EQ(value("2*0.5 m", "m"), 1);
    EXPECT_EQ(value("2*300 mm", "m"), 0.6);
    EXPECT_EQ(value("3*5 mm", "m"), 3 * 0.005) << "5 mm is rounded once";
    EXPECT_DOUBLE_EQ(value("1 m + 2 in", "m"), 1.0508);
    EXPECT_EQ(value("(1 m + 50 cm)/2", "m"), 0.75);
    EXPECT_EQ(value("30 mm/2", "m"), 0.015);
    EXPECT_EQ(value("30 mm/1.5", "m"), 0.02);
    EXPECT_EQ(value("7850 kg/m^3*2", "kg/m^3"), 15700);
    EXPECT_EQ(value("(2 m)^2 + 1 m^2", "m^2"), 5);
    EXPECT_EQ(value("sqrt((3 m)^2 + (4 m)^2)", "m"), 5);
    EXPECT_EQ(value("10 N/(2 kN/m)", "m"), 0.005);
    EXPECT_EQ(value("2 kg*9.81 m/s^2", "N"), 19.62);
    EXPECT_EQ(value("3*2 1/s", "Hz"), 6);
    EXPECT_EQ(value("max(2 mm, 0)", "m"), 0.002);
    EXPECT_EQ(value("2\xc2\xb7"
                    "3 m",
                    "m"),
              6)
        << "typeset signs";
}

TEST(Computed, ParametersAreNumbersWithDimension)
{
    EXPECT_EQ(value("2*L", "m", "L = \"400 mm\""), 0.8);
    EXPECT_EQ(value("-L", "m", "L = 0.4"), -0.4);
    EXPECT_DOUBLE_EQ(value("L/2 + 30 mm", "m", "L = \"0.4 m\""), 0.23);
    EXPECT_DOUBLE_EQ(value("sqrt(2)*L", "m", "L = 0.4"), std::sqrt(2) * 0.4);
    EXPECT_EQ(value("2*pi", "rad"), 2 * pi);
    EXPECT_EQ(value("b", "m", "a = \"2*c\"\nb = \"a + c\"\nc = 1"), 3) << "in any order";
    EXPECT_DOUBLE_EQ(value("2*pi*sqrt(L/g)", "s", "L = \"1 m\"\ng = \"9.81 m/s^2\""),
                     2 * pi / std::sqrt(9.81));
    EXPECT_DOUBLE_EQ(value("m*a", "N", "m = \"2 kg\"\na = \"3 m/s^2\""), 6) << "m is a parameter here";
    EXPECT_EQ(value("2 m", "m", "m = \"3 kg\""), 2) << "and behind a number the unit";
    EXPECT_EQ(value("7850 kg/m^3", "kg/m^3", "m = \"3 kg\""), 7850);
    EXPECT_DOUBLE_EQ(value("V^(1/3)", "m", "V = \"8 m^3\""), 2);
}

TEST(Computed, AnglesKeepTheirFactorAndAreNumbersOtherwise)
{
    EXPECT_EQ(value("2*30 deg", "rad"), 2 * (pi * 30 / 180));
    EXPECT_DOUBLE_EQ(value("sin(30 deg)", ""), 0.5);
    EXPECT_DOUBLE_EQ(value("30 deg + 0.5", "rad"), pi / 6 + 0.5);
    EXPECT_DOUBLE_EQ(value("R*30 deg", "m", "R = \"2 m\""), pi / 3) << "an arc";
    EXPECT_DOUBLE_EQ(value("v/R", "rad/s", "v = \"3 m/s\"\nR = \"2 m\""), 1.5);
    EXPECT_DOUBLE_EQ(value("2*pi*3 Hz", "rad/s"), 6 * pi);
    EXPECT_DOUBLE_EQ(value("n/(1 rev)", "Hz", "n = \"120 rpm\""), 2);
    EXPECT_DOUBLE_EQ(value("w/(2*pi)", "Hz", "w = \"120 rpm\""), 2);
    EXPECT_DOUBLE_EQ(value("atan2(3 m, 4 m)", "rad"), std::atan2(3, 4));
    // What may be a factor of 2 pi off is refused.
    EXPECT_EQ(fault("2*3 Hz", "rad/s"), "it is a frequency (1/s), and an angular velocity (rad/s) is wanted");
    EXPECT_NE(fault("2*60 rpm", "Hz"), "");
    EXPECT_NE(fault("60 rpm + 3 Hz", "rad/s"), "");
    EXPECT_EQ(fault("2*30 deg", ""), "it is an angle (rad), and a plain number is wanted");
    EXPECT_NE(fault("2*30 deg", "m"), "");
}

TEST(Computed, DimensionsThatDoNotGoTogetherAreBothSaid)
{
    EXPECT_EQ(fault("1 m + 2 kg", "m"), "a mass (kg) is added to a length (m) at column 5");
    EXPECT_EQ(fault("L + 30 mm", "m", "L = 0.4"), "a length (m) is added to a plain number at column 3");
    EXPECT_EQ(fault("2*L", "kg", "L = \"1 m\""), "it is a length (m), and a mass (kg) is wanted");
    EXPECT_EQ(fault("L*L", "m", "L = \"1 m\""), "it is an area (m^2), and a length (m) is wanted");
    EXPECT_EQ(fault("L/b", "m", "L = \"1 m\"\nb = \"2 m\""), "it is a ratio, and a length (m) is wanted");
    EXPECT_EQ(fault("2 kg*3 m/(1 s)", "N"), "it is a quantity in kg m/s, and a force (N) is wanted");
    EXPECT_NE(fault("sin(1 m)", ""), "");
    EXPECT_NE(fault("2^(1 m)", ""), "");
    EXPECT_NE(fault("floor(2.5 m)", "m"), "");
    EXPECT_NE(fault("max(1 m, 1 s)", "m"), "");
    EXPECT_NE(fault("atan2(1 m, 1 s)", "rad"), "");
    EXPECT_NE(fault("L + z", "m", "L = \"1 m\"\nz = 0"), "") << "a parameter is no literal zero";
}

TEST(Computed, WhatHasNoValueSaysWhy)
{
    EXPECT_NE(fault("1 m/0", "m").find("division by 0 at column 4"), std::string::npos);
    EXPECT_NE(fault("L/(a - a)", "m", "L = 1\na = 2").find("division by 0"), std::string::npos);
    EXPECT_NE(fault("sqrt(-L)", "m", "L = 2").find("sqrt(-2)"), std::string::npos);
    EXPECT_NE(fault("1e300*L", "m", "L = 1e300"), "");
    EXPECT_NE(fault("1e308 km", "m"), "");
    EXPECT_EQ(fault("2*l", "m", "L = 1"), "there is no parameter 'l' at column 3");
    EXPECT_NE(fault("sin(t)", "").find("does not change with time"), std::string::npos);
    EXPECT_NE(fault("2*3*4 L", "m", "L = 1").find("'L' at column 7"), std::string::npos);
    EXPECT_NE(fault("(2*3", "m"), "");
    for (const char* text :
         {"2*j", "2/j", "2 *j", "2^j", "L", "-5*2 m", "(1)", "2 + 3 m", "1 m - 3 mm", "2 pi", "- 5 mm"})
        EXPECT_TRUE(is_computed(text, no_parameters())) << text;
    for (const char* text :
         {"5 mm", "-5 mm", "+5 mm", "2", " 1.5e-3 kN/mm", "3 1/s", "2 m^2", "2 m^-1 s", "5 foo", "kg"})
        EXPECT_EQ(is_computed(text, no_parameters()), text[0] == 'k') << text;
    Table table("length = 1");
    EXPECT_EQ(compute("2*lenght", table.parameters).help, "did you mean 'length'?");
    EXPECT_EQ(compute("kg*2", table.parameters).help, "a unit stands behind a number: 1 kg");
}

TEST(Computed, ANameThatMayBeTheUnitIsRefused)
{
    EXPECT_EQ(fault("2 N/m", "N", "m = \"3 m\""), "'m' may be the unit or the parameter");
    EXPECT_EQ(value("2 N m^-1", "N/m", "m = \"3 m\""), 2);
    EXPECT_NE(fault("(2 m)^n + 2 m^n", "m^2", "n = 2"), "");
}

TEST(Parameters, BadOnesAreEachToldOnce)
{
    struct Wrong {
        std::string lines, code, said;
    };
    const Wrong wrong[] = {
        {"t = 1", "parameter-name", "the time"},
        {"sin = 1", "parameter-name", "hides"},
        {"pi = 3", "parameter-name", "hides"},
        {"asin = 3", "parameter-name", "hides"},
        {"\"my length\" = 3", "parameter-name", "names have"},
        {"1x = 3", "parameter-name", "names have"},
        {"a-b = 3", "parameter-name", "names have"},
        {"leg.L = 3", "parameter-name", "not nested"},
        {"a = \"b\"\nb = \"c\"\nc = \"2*a\"", "parameter-ring", "a needs b needs c needs a"},
        {"a = \"2*a\"", "parameter-ring", "needs itself"},
        {"a = true", "wrong-type", "not true or false"},
        {"a = [1]", "wrong-type", "a list"},
        {"a = nan", "not-finite", "nan"},
        {"a = \"\"", "expression-syntax", "empty"},
        {"a = \"1/0\"", "expression-value", "division by 0"},
        {"a = \"2*b\"\nb2 = 1", "expression-name", "no parameter 'b'"},
        {"a = \"1 m + 1 s\"\nb = \"2*a\"\nc = \"b\"", "unit", "a time (s) is added to a length (m)"},
        {"a = \"\"\"1\n+ 1\"\"\"", "expression-syntax", "one line"},
    };
    for (const Wrong& w : wrong) {
        Table table(w.lines);
        const std::vector<Diagnostic> found = table.found();
        ASSERT_EQ(found.size(), 1u) << w.lines;
        EXPECT_EQ(found[0].code, w.code) << w.lines << found[0].message;
        EXPECT_NE((found[0].message + found[0].note + found[0].help).find(w.said), std::string::npos)
            << w.lines << ": " << found[0].message;
        EXPECT_GT(found[0].line, 1);
    }
}

TEST(Parameters, OfALongChainNeedNoStack)
{
    std::string lines;
    constexpr int n = 9000;
    for (int i = 0; i < n; ++i)
        lines += "a" + std::to_string(i) + " = \"a" + std::to_string(i + 1) + " + 1\"\n";
    EXPECT_EQ(value("a0", "m", lines + "a" + std::to_string(n) + " = 0"), n);
    Table ring(lines + "a" + std::to_string(n) + " = \"a0\"");
    ASSERT_EQ(ring.found().size(), 1u);
}

TEST(Parameters, AreSetFromOutside)
{
    const auto set = [](const std::string& lines, const std::string& name, const std::string& text) {
        Table table(lines, {{.name = name, .text = text, .said_by = "set: " + name}});
        const Parameters::One* one = table.parameters.find(name);
        const std::vector<Diagnostic> found = table.found();
        return found.empty() ? described(one->amount) + " " + std::to_string(one->amount.value)
                             : found[0].message;
    };
    EXPECT_EQ(set("L = 0.5", "L", "0.25"), "a plain number 0.250000");
    EXPECT_EQ(set("L = \"500 mm\"", "L", "0.25"), "a length (m) 0.250000") << "in the unit of the file, SI";
    EXPECT_EQ(set("L = \"500 mm\"", "L", "250 mm"), "a length (m) 0.250000");
    EXPECT_EQ(set("L = 0.5", "L", "250 mm"), "a length (m) 0.250000");
    EXPECT_EQ(set("L = \"500 mm\"\nb = \"1 m\"", "L", "b/4"), "a length (m) 0.250000");
    EXPECT_NE(set("L = \"500 mm\"", "L", "2 kg").find("it is a mass (kg), and a length (m) in the file"),
              std::string::npos);
    EXPECT_NE(set("L = \"500 mm\"", "l", "2").find("no parameter 'l' to set (set: l)"), std::string::npos);
    EXPECT_NE(set("L = 0.5", "L", "2*").find("(set: L)"), std::string::npos);
    EXPECT_NE(set("L = 0.5", "L", "2*L").find("needs itself"), std::string::npos);
    Table twice("L = 1", {{.name = "L", .text = "1"}, {.name = "L", .text = "2"}});
    EXPECT_EQ(twice.found()[0].code, "parameter-set");
    Table amount("L = \"1 m\"\nb = \"2*L\"",
                 {{.name = "L", .amount = {.value = 3, .powers = {1}, .has_unit = true}}});
    EXPECT_EQ(amount.parameters.find("b")->amount.value, 6) << "of another file's parameters";
}

const std::string swing = R"(format = 1
gravity = [0, 0, "-g"]
[parameters]   # the arm
L = "400 mm"   # its length
w = "L/10"
g = 9.81
n = 20
c = 3
[[body]]
name = "arm"
shape = { box = ["L", "w", "w"] }
mass = "2 kg*n/10"
position = ["L/2", 0, 0]
[[joint]]
name = "shaft"
type = "revolute"
between = ["world", "arm"]
at = [0, 0, 0]
axis = [0, 1, 0]
[[load]]
type = "actuator"
joint = "shaft"
expression = "-c*shaft.angle + 0*g"
[time]
end = "2*1 s"
elements = "n/2"
)";

TEST(ParametersOfScenarios, StandInEveryNumber)
{
    const ScenarioResult read_one = read(swing);
    ASSERT_TRUE(read_one.scenario) << shown(read_one);
    EXPECT_TRUE(read_one.diagnostics.empty()) << shown(read_one);
    const Body& arm = read_one.scenario->model.bodies()[0];
    EXPECT_EQ(arm.X(0, 0), 0.2);
    EXPECT_EQ(arm.mass(0, 0), 4);
    EXPECT_EQ(end_of(read_one.scenario->time), 2);
    EXPECT_NE(read_one.scenario->resolved.find(
                  R"("parameters": {"L": 0.4, "w": 0.04, "g": 9.81, "n": 20, "c": 3})"),
              std::string::npos)
        << read_one.scenario->resolved;
}

TEST(ParametersOfScenarios, ThatAreSetStandInTheTextThatIsKept)
{
    const ScenarioResult set = parse_scenario(swing, "test.toml", {}, {{"L", "2*100 mm"}, {"n", "40"}});
    ASSERT_TRUE(set.scenario) << shown(set);
    EXPECT_EQ(set.scenario->text,
              replaced(replaced(swing, "\"400 mm\"", "\"2*100 mm\""), "n = 20", "n = 40"));
    const ScenarioResult again = read(set.scenario->text);
    ASSERT_TRUE(again.scenario) << shown(again);
    EXPECT_EQ(again.scenario->resolved, set.scenario->resolved);
    EXPECT_EQ(again.scenario->model.bodies()[0].X(0, 0), 0.1);
    EXPECT_EQ(again.scenario->model.bodies()[0].mass(0, 0), 8);
    // A plain number keeps the unit that the file has.
    const ScenarioResult plain = parse_scenario(swing, "test.toml", {}, {{"L", "0.2/2"}});
    ASSERT_TRUE(plain.scenario) << shown(plain);
    EXPECT_NE(plain.scenario->text.find("L = \"0.1 m\""), std::string::npos) << plain.scenario->text;
    EXPECT_EQ(read(plain.scenario->text).scenario->resolved, plain.scenario->resolved);
    // Inline tables, dotted keys and strings of other kinds are found as well.
    for (const char* head :
         {"parameters = { L = 'L0', L0 = 1 }\n", "parameters.L0 = 1\nparameters.L = \"\"\"L0\"\"\"  # ä\n"}) {
        const std::string text =
            "format = 1\n" + std::string(head) +
            "[[body]]\nname = 'ä'\nmass = \"L\"\ninertia = [1, 1, 1]\n[time]\nend = \"L0\"\n";
        const ScenarioResult other = parse_scenario(text, "t", {}, {{"L", "3*L0"}, {"L0", "+2"}});
        ASSERT_TRUE(other.scenario) << shown(other);
        EXPECT_EQ(read(other.scenario->text).scenario->model.bodies()[0].mass(0, 0), 6)
            << other.scenario->text;
    }
}

TEST(ParametersOfScenarios, AreToldOfWhereTheyStand)
{
    expect_error(replaced(swing, "\"2 kg*n/10\"", "\"2 m*n/10\""), "unit", "\"2 m*n/10\"");
    expect_error(replaced(swing, "\"L/2\"", "\"L/0\""), "expression-value", "\"L/0\"");
    expect_error(replaced(swing, "\"L/2\"", "\"l/2\""), "expression-name", "\"l/2\"");
    expect_error(replaced(swing, "\"n/2\"", "\"n/3\""), "wrong-type", "\"n/3\"");
    expect_error(replaced(swing, "-c*", "-C*d*"), "expression-name", "\"-C*d*");
    expect_error(replaced(swing, "expression =", "inputs = { c = \"shaft.angle_rate\" }\nexpression ="),
                 "parameter-name", "{ c = ");
    expect_error(replaced(swing, "[parameters]", "[parameters.leg]"), "parameter-name", "leg]");
    expect_error(replaced(swing, "\"2*1 s\"", "\"2*-1 s\""), "time-end", "\"2*-1 s\"");
    const ScenarioResult unused = read(replaced(swing, "c = 3", "c = 3\nd = 4"));
    ASSERT_TRUE(unused.scenario);
    ASSERT_NE(find(unused, "parameter-unused"), nullptr);
    EXPECT_EQ(find(unused, "parameter-unused")->line, spot(unused.text, "4\n[[body]]").line);
    const ScenarioResult near = parse_scenario(swing, "t", {}, {{"length", "1"}, {"nn", "3"}});
    ASSERT_EQ(near.diagnostics.size(), 2u) << shown(near);
    EXPECT_EQ(near.diagnostics[0].line, 0);
    EXPECT_NE(near.diagnostics[1].help.find("did you mean 'n'"), std::string::npos);
}

/// What needs a parameter that is wrong is not told of as well.
TEST(ParametersOfScenarios, ThatAreWrongAreToldOfOnce)
{
    for (const char* wrong : {"\"1 m + 1 s\"", "true", "\"w\""}) {
        const ScenarioResult result = read(replaced(swing, "\"400 mm\"", wrong));
        EXPECT_EQ(result.diagnostics.size(), 1u) << shown(result);
    }
    EXPECT_EQ(read(replaced(swing, "L = ", "L-1 = ")).diagnostics.size(), 1u);
    const ScenarioResult set = parse_scenario(swing, "t", {}, {{"L", "2 kg"}});
    EXPECT_EQ(set.diagnostics.size(), 1u) << shown(set);
}

/// `--set L=500` beside "400 mm" is taken as 500 m, which hardly anybody means.
TEST(ParametersOfScenarios, APlainNumberLikeTheOneBesideAUnitIsNoticed)
{
    const auto codes = [](const std::string& value) {
        std::string all;
        for (const Diagnostic& one : parse_scenario(swing, "t", {}, {{"L", value}}).diagnostics)
            all += one.code + ";";
        return all;
    };
    ASSERT_NE(swing.find("L = \"400 mm\""), std::string::npos);
    EXPECT_EQ(codes("500"), "parameter-unit;");
    EXPECT_EQ(codes("4000"), "parameter-unit;");
    for (const char* meant : {"0.5", "0.004", "4", "500 mm", "0.5 m", "0"})
        EXPECT_EQ(codes(meant).find("parameter-unit"), std::string::npos) << meant;
}

TEST(ParametersOfScenarios, WordsAndLoneNumbersAreNoExpressions)
{
    const std::string plain = replaced(replaced(valid_scenario, "mass = 2", "mass = \"heavy\""),
                                       "density = 1000", "density = \"1000\"");
    const ScenarioResult words = read(plain);
    ASSERT_EQ(words.diagnostics.size(), 2u) << shown(words);
    EXPECT_NE(words.diagnostics[0].message.find("the unit is missing"), std::string::npos);
    EXPECT_NE(words.diagnostics[1].message.find("no parameter 'heavy'"), std::string::npos);
}

}   // namespace

}   // namespace livens::parameters_test
