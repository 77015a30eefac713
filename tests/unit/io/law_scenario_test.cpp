// SPDX-License-Identifier: BSD-3-Clause
// Expressions, laws and sensors: what arrives, and what is told where.
#include "unit/io/scenario_text.h"

namespace livens::law_scenario_test {

namespace {

/// A body on a pivot, and more.
std::string with(const std::string& lines)
{
    return "format = 1\n[[body]]\nname = \"b\"\nmass = 2\ninertia = [1, 2, 2]\n"
           "[[joint]]\nname = \"j\"\nbetween = [\"world\", \"b\"]\ntype = \"revolute\"\nat = [0, 0, 0]\n"
           "axis = [0, 0, 1]\n[[sensor]]\nname = \"tip\"\ntype = \"point\"\nbody = \"b\"\n" +
           lines + "\n[time]\nend = 1\nelements = 4\n";
}

std::string actuator(const std::string& lines)
{
    return with("[[load]]\ntype = \"actuator\"\njoint = \"j\"\n" + lines);
}

std::string spring(const std::string& lines)
{
    return with("[[load]]\ntype = \"spring\"\njoint = \"j\"\n" + lines);
}

std::string bushing(const std::string& lines)
{
    return with("[[load]]\ntype = \"bushing\"\nbetween = [\"world\", \"b\"]\n" + lines);
}

std::string slotted(const std::string& curve)
{
    return with("[[body]]\nname = \"c\"\nmass = 1\ninertia = [1, 1, 1]\n[[joint]]\nname = \"s\"\n"
                "type = \"slot\"\nbetween = [\"world\", \"c\"]\ncurve = { " +
                curve + " }");
}

std::string sensor(const std::string& lines) { return with("[[sensor]]\nname = \"s\"\n" + lines); }

TEST(LawScenario, AnExpressionWithoutInputsIsAFunctionOfTime)
{
    const ScenarioResult result = test::read(actuator("expression = \"2*t + 1\"\nfrom = 0.5"));
    ASSERT_TRUE(result.scenario.has_value()) << test::shown(result);
    const Load& load = result.scenario->model.loads()[0];
    EXPECT_FALSE(load.depends_on_V);
    EXPECT_EQ(load.breaks, std::vector<double>{0.5});
    LoadArguments at;
    at.at.t = 0.75;
    EXPECT_EQ(load.readings[0].value(at), 2.5);
    at.at.t = 0.25;
    EXPECT_EQ(load.readings[0].value(at), 0);
}

TEST(LawScenario, DrivesNeedValuesOnlyWhileTheyAct)
{
    for (const bool acts : {false, true}) {
        const ScenarioResult result = test::read(
            with("[[drive]]\nname = \"d\"\ntype = \"joint\"\njoint = \"j\"\nexpression = \"0*log(0.75 - "
                 "t)\"\n" +
                 std::string(acts ? "" : "until = 0.5\n")));
        EXPECT_EQ(result.scenario.has_value(), !acts) << test::shown(result);
        EXPECT_EQ(test::shown(result).find("t = 0.75") != std::string::npos, acts) << test::shown(result);
    }
}

/// One number each, with units of their own, and a whole matrix.
TEST(LawScenario, BushingsTakeUnits)
{
    const std::string at = "at = [0, 0, 0]\n";
    const std::string with_units = "stiffness = [\"1 kN/mm\", 2, 3, \"1 N m/deg\", 5, 6]\ndamping = [\"2 kN "
                                   "s/m\", 0, 0, \"3 N mm s/rad\", 0, "
                                   "0]\npreload = [\"1 kN\", 0, 0, \"2 kN mm\", 0, 0]";
    const std::string plain = "stiffness = [1e6, 2, 3, 57.29577951308232, 5, 6]\ndamping = [2000, 0, 0, "
                              "0.003, 0, 0]\npreload = [1000, 0, 0, "
                              "2, 0, 0]";
    const ScenarioResult one = test::read(bushing(at + with_units)), two = test::read(bushing(at + plain));
    ASSERT_TRUE(one.scenario && two.scenario) << test::shown(one) << test::shown(two);
    for (const LoadReading& r : one.scenario->model.loads()[0].readings) EXPECT_NE(r.name, "");
    EXPECT_EQ(test::shown(one), test::shown(two));
    std::string matrix = "stiffness = [";
    for (int i = 0; i < 36; ++i) {
        const bool is_torque = i >= 18, is_angle = i % 6 >= 3;
        const std::string unit = is_torque ? (is_angle ? "N m/rad" : "N") : (is_angle ? "N/rad" : "N/m");
        matrix += std::string(i == 0 ? "" : ", ") + "\"" + (i % 7 == 0 ? "1 " : "0 ") + unit + "\"";
    }
    EXPECT_TRUE(test::read(bushing(at + matrix + "]")).scenario.has_value());
    for (const std::string& wrong :
         {std::string("stiffness = [1, 1, 1, \"1 N/m\", 1, 1]"),
          std::string("stiffness = [\"1 N m/rad\", 1, 1, 1, 1, 1]"),
          std::string("stiffness = [1, 1, 1, 1, 1, 1]\npreload = [0, 0, 0, \"1 N\", 0, 0]")}) {
        const ScenarioResult refused = test::read(bushing(at + wrong));
        EXPECT_NE(test::shown(refused).find("is not a unit of this quantity"), std::string::npos)
            << test::shown(refused);
    }
}

TEST(LawScenario, InputsAreReadFromJointsAndSensors)
{
    const ScenarioResult result = test::read(actuator("expression = \"a + 10*b + 100*c\"\ninputs = { a = "
                                                      "\"j.angle\", b = \"j.angle_rate\", c = \"tip.vy\" }"));
    ASSERT_TRUE(result.scenario.has_value()) << test::shown(result);
    const Load& load = result.scenario->model.loads()[0];
    EXPECT_TRUE(load.depends_on_V);
    LoadArguments at;
    at.X[0] = configuration({}, directors_from_rotation_vector({0, 0, 0.25}));
    at.V[0] = rate(at.X[0], {0, 3, 0}, {0, 0, 2});
    EXPECT_NEAR(load.readings[0].value(at), 0.25 + 20 + 300, 1e-12);
}

TEST(LawScenario, NamesStandInExpressionsThemselves)
{
    const ScenarioResult result =
        test::read(actuator("expression = \"j.angle + 10*j.angle_rate + 100*'tip'.vy\""));
    ASSERT_TRUE(result.scenario.has_value()) << test::shown(result);
    LoadArguments at;
    at.X[0] = configuration({}, directors_from_rotation_vector({0, 0, 0.25}));
    at.V[0] = rate(at.X[0], {0, 3, 0}, {0, 0, 2});
    EXPECT_NEAR(result.scenario->model.loads()[0].readings[0].value(at), 0.25 + 20 + 300, 1e-12);
    test::expect_error(actuator("expression = \"k.angle\""), "input-unknown", "\"k.angle\"");
    const std::string drive = "[[drive]]\nname = \"d\"\ntype = \"joint\"\njoint = \"j\"\n";
    test::expect_error(with(drive + "expression = \"j.angle\""), "expression-name", "\"j.angle\"");
}

/// Factors of time in all rows of the last joint, at an instant.
std::vector<double> factors_of_drive(const std::string& law, double t)
{
    const ScenarioResult result =
        test::read(with("[[drive]]\nname = \"d\"\ntype = \"joint\"\njoint = \"j\"\n" + law +
                        "\n[start]\ninitial = \"project\""));
    EXPECT_TRUE(result.scenario.has_value()) << law << test::shown(result);
    std::vector<double> factors;
    if (!result.scenario) return factors;
    for (const ConstraintRow& row : result.scenario->model.joints().back().rows)
        for (const Drive& drive : row.drives) factors.push_back(drive.factor({t}).value);
    return factors;
}

TEST(LawScenario, DrivesTakeUnitsOfTheirCoordinate)
{
    for (const auto& [law, plain] :
         {std::pair("rate = \"60 rpm\"", "rate = 6.283185307179586"),
          std::pair("value = \"0.1 rev\"", "value = 0.6283185307179586"),
          std::pair(
              "harmonic = { amplitude = \"30 deg\", frequency = \"60 1/min\", phase = \"90 deg\" }",
              "harmonic = { amplitude = 0.5235987755982988, frequency = 1, phase = 1.5707963267948966 }"),
          std::pair("step = { from = 0, until = \"500 ms\", rise = \"90 \u00b0\" }",
                    "step = { from = 0, until = 0.5, rise = 1.5707963267948966 }"),
          std::pair("table = { times = [0, \"500 ms\"], values = [0, \"45 deg\"] }",
                    "table = { times = [0, 0.5], values = [0, 0.7853981633974483] }")}) {
        const std::vector<double> found = factors_of_drive(law, 0.3), wanted = factors_of_drive(plain, 0.3);
        ASSERT_EQ(found.size(), wanted.size());
        ASSERT_GT(found.size(), 0u);
        for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], wanted[i], 1e-15) << law;
        EXPECT_NE(factors_of_drive(law, 0.31), factors_of_drive("rate = 6.2831854", 0.31))
            << "negative control";
    }
    const std::string drive = "[[drive]]\nname = \"d\"\ntype = \"joint\"\njoint = \"j\"\n";
    for (const std::string law : {"rate = \"1 m/s\"", "value = \"3 mm\"", "rate = \"3 Hz\"",
                                  "step = { from = 0, until = 1, rise = \"1 m\" }"})
        EXPECT_NE(test::find(test::read(with(drive + law)), "unit"), nullptr) << law;
}

TEST(LawScenario, NamesOfInputsMayHaveBlanksAndPoints)
{
    std::string text = actuator("expression = \"x\"\ninputs = { x = \"the tip. 2.x\" }");
    text.replace(text.find("\"tip\""), 5, "\"the tip. 2\"");
    EXPECT_TRUE(test::read(text).scenario.has_value()) << test::shown(test::read(text));
}

}   // namespace

namespace {

std::vector<test::Case> cases_of_driven_laws()
{
    const auto by = [](const std::string& expression, const std::string& lines = "") {
        return with("[[drive]]\nname = \"d\"\ntype = \"joint\"\njoint = \"j\"\nexpression = \"" + expression +
                    "\"\n" + lines + "[start]\ninitial = \"project\"");
    };
    return {
        {"expression-value", by("acos(t - 1.5)"), "\"acos"},
        {"expression-value", by("sqrt(t)"), "\"sqrt"},   // it begins with an infinite rate
        {"expression-value", by("log(0.75 - t)"), "\"log"},
        {"drive-jumps",
         with("[[drive]]\nname = \"d\"\ntype = \"joint\"\njoint = \"j\"\nexpression = \"abs(t - 0.5137) - "
              "0.5137\"\n[start]\ninitial = \"project\""),
         "\"d\""},
        {"expression-name", with("[[drive]]\nname = \"d\"\ntype = \"joint\"\njoint = \"j\"\nrate = \"2*t\""),
         "\"2*t\""},
    };
}

TEST(Slots, AreTheSameWhetherRoundingKeepsTheFirstPointFromTheLast)
{
    const std::string round = "closed = true, points = [[1, 0, 0], [0, 1, 0], [-1, 0, 0], [1, 0, ";
    for (const char* last : {"0]]", "1e-16]]"}) {
        const ScenarioResult result = parse_scenario(slotted(round + last), "test.toml");
        const Diagnostic* d = test::find(result, "curve-points");
        ASSERT_NE(d, nullptr) << test::shown(result);
        EXPECT_NE(d->message.find("closed curve is its first again"), std::string::npos) << d->message;
    }
    EXPECT_EQ(test::find(parse_scenario(slotted(round + "1e-3]]"), "test.toml"), "curve-points"), nullptr);
}

}   // namespace
}   // namespace livens::law_scenario_test

namespace livens {

std::vector<test::Case> test::cases_of_laws()
{
    using namespace law_scenario_test;
    const std::string angle = "inputs = { a = \"j.angle\" }\n";
    const std::string unit = "stiffness = [1, 1, 1, 1, 1, 1]\n";
    std::vector<Case> all{
        {"expression-syntax", actuator("expression = \"1 +\""), "\"1 +\""},
        {"expression-name", actuator(angle + "expression = \"a + b\""), "\"a + b\""},
        {"expression-name", actuator("inputs = { sin = \"j.angle\" }\nexpression = \"1\""), "\"1\"\n[time]"},
        {"expression-value", actuator("expression = \"1/0\""), "\"1/0\""},
        {"expression-size", actuator("expression = \"" + std::string(70, '-') + "1\""), "\"-----"},
        {"input-unknown", actuator("inputs = { a = \"k.angle\" }\nexpression = \"a\""), "{ a"},
        {"input-unknown", actuator("inputs = { a = \"tip\" }\nexpression = \"a\""), "{ a"},
        {"input-unused", actuator(angle + "expression = \"t\""), "{ a"},
        {"input-algebraic",
         actuator("inputs = { a = \"e.kinetic\" }\nexpression = \"a\"\n[[sensor]]\nname = \"e\"\ntype = "
                  "\"energy\"\nbody = \"b\""),
         "{ a"},
        {"joint-coordinate", actuator("inputs = { a = \"j.displacement\" }\nexpression = \"a\""), "{ a"},
        {"input-algebraic",
         actuator(
             "name = \"m\"\ninputs = { a = \"own.force\" }\nexpression = \"a\"\n[[sensor]]\nname = \"own\"\n"
             "type = \"load\"\nload = \"m\""),
         "{ a"},
        {"expression-value", actuator("expression = \"sqrt(t - 0.5)\""), "\"sqrt"},
        {"load-value", with("[[load]]\ntype = \"drag\"\nbody = \"b\""), "[[load]]"},
        {"load-value", actuator("expression = \"1\"\nvalue = 2"), "\"1\"\nvalue"},
        {"load-value", actuator(angle + "value = 2"), "{ a"},
        {"wrong-type", actuator("expression = \"1\"\ninputs = { a = 2 }"), "2 }"},
        {"spring-law", spring("stiffness = 1\nlaw = \"table\""), "[[load]]"},
        {"spring-law", spring("stiffness = 1\ncubic = 1"), "1\n[time]"},
        {"spring-law", spring(""), "[[load]]"},
        {"table-order", spring("law = \"table\"\ntable = { elongations = [0, 0, 1], forces = [0, 1, 2] }"),
         "{ elong"},
        {"table-size", spring("law = \"table\"\ntable = { elongations = [0, 1], forces = [0, 1, 2] }"),
         "{ elong"},
        {"bushing-matrix", bushing("at = [0, 0, 0]\nstiffness = [1, 2]"), "[1, 2]"},
        {"bushing-matrix", bushing("at = [0, 0, 0]\nstiffness = [1, 1, 1, 1, 1, -1]"), "[1, 1, 1, 1, 1, -1]"},
        {"joint-placement", bushing(unit), "[[load]]"},
        {"joint-frames", bushing(unit + "frames = [{}]"), "[{}]"},
        {"curve-points", slotted("points = [[0, 0, 0]]"), "{ points"},
        {"curve-straight-back", slotted("points = [[0, 0, 0], [1, 0, 0], [0, 0, 0]]"), "{ points"},
        {"curve-crosses-itself", slotted("points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0.5, -1, 0]]"),
         "\"s\"\ntype"},
        {"load-not-finite", with("[[load]]\ntype = \"attraction\"\nbody = \"b\"\nmu = 1"), "[[load]]"},
        {"load-not-finite", actuator(angle + "expression = \"1/a\""), "[[load]]"},
        {"sensor-self", sensor("type = \"point\"\nbody = \"world\""), "\"world\"\n[time]"},
        {"joint-unknown", sensor("type = \"joint\"\njoint = \"jj\""), "\"jj\""},
        {"load-unknown", sensor("type = \"load\"\nload = \"l\""), "\"l\""},
        {"name-duplicate", with("[[sensor]]\nname = \"j\"\ntype = \"point\"\nbody = \"b\""),
         "\"j\"\ntype = \"point\""},
        {"out-of-range", with("[[load]]\ntype = \"attraction\"\nbody = \"b\"\nmu = -1"), "-1\n[time]"},
        {"drive-size",
         with("[[body]]\nname = \"c\"\nmass = 1\ninertia = [1, 1, 1]\n[[drive]]\nname = \"d\"\ntype = "
              "\"point\"\nbody = \"c\"\nexpression = \"t\""),
         "\"t\"\n[time]"},
    };
    for (const Case& more : cases_of_driven_laws()) all.push_back(more);
    return all;
}

}   // namespace livens
