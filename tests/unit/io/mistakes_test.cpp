// SPDX-License-Identifier: BSD-3-Clause
// Mistakes of users who come from other programs: each is one finding for what was typed, with what to type
// instead.
#include "scenario_text.h"

namespace livens::mistakes_test {
namespace {

using namespace test;

const std::string arm = R"(format = 1
gravity = [0, 0, -9.81]
[[body]]
name = "arm"
shape = { box = [1, 0.05, 0.05] }
mass = 3
position = [0.5, 0, 0]
[[joint]]
name = "shaft"
type = "revolute"
between = ["world", "arm"]
at = [0, 0, 0]
axis = [0, 1, 0]
[time]
end = 2
)";

/// A line that takes the place of another (empty: follows at the end), and what the answer has to say.
struct Mistake {
    std::string line, instead, answer;
};

std::string text_of(const Mistake& mistake)
{
    return mistake.line.empty() ? arm + mistake.instead : replaced(arm, mistake.line, mistake.instead);
}

/// One answer for one mistake: what follows from it is not told, and all of it is in one finding.
void expect_answer(const Mistake& mistake)
{
    const ScenarioResult result = read(text_of(mistake));
    int n_errors = 0;
    bool is_answered = false;
    for (const Diagnostic& d : result.diagnostics) {
        n_errors += d.severity == Severity::error ? 1 : 0;
        is_answered = is_answered || (d.message + d.note + d.help).find(mistake.answer) != std::string::npos;
    }
    EXPECT_EQ(n_errors, 1) << mistake.instead << shown(result);
    EXPECT_TRUE(is_answered) << mistake.instead << "\nlacks " << mistake.answer << shown(result);
}

const std::string axis = "axis = [0, 1, 0]", mass = "mass = 3", end = "end = 2",
                  load = "[[load]]\ntype = \"actuator\"\njoint = \"shaft\"\n",
                  spring = "[[load]]\ntype = \"spring\"\njoint = \"shaft\"\n",
                  force = "[[load]]\ntype = \"force\"\nbody = \"arm\"\n",
                  drive = "[[drive]]\ntype = \"joint\"\njoint = \"shaft\"\n";

TEST(Mistakes, OfValuesAreShownAsTheyAreWritten)
{
    EXPECT_TRUE(read(arm).diagnostics.empty()) << shown(read(arm));
    for (const Mistake& mistake : {
             Mistake{"gravity = [0, 0, -9.81]", "gravity = 9.81", "gravity = [0, 0, -9.81]"},
             Mistake{axis, "axis = \"y\"", "axis = [0, 1, 0]"},
             Mistake{axis, "axis = \"-Z\"", "axis = [0, 0, -1]"},
             Mistake{"[\"world\", \"arm\"]", "[\"arm\"]", "between = [\"world\", \"arm\"]"},
             Mistake{"[\"world\", \"arm\"]", "\"arm\"", "between = [\"world\", \"arm\"]"},
             Mistake{"[\"world\", \"arm\"]", "[\"ground\", \"arm\"]", "\"world\""},
             Mistake{"[\"world\", \"arm\"]", "[\"World\", \"arm\"]", "\"world\""},
             Mistake{"box = [1, 0.05, 0.05]", "box = 1", "box = [1, 1, 1]"},
             Mistake{"box = [1, 0.05, 0.05]", "sphere = [0.1]", "sphere = 0.1"},
             Mistake{"box = [1, 0.05, 0.05]", "cylinder = [0.1, 1]",
                     "cylinder = { radius = 0.1, length = 1 }"},
             Mistake{"{ box = [1, 0.05, 0.05] }", "\"cone\"", "shape = { cone = .. }"},
             Mistake{"{ box = [1, 0.05, 0.05] }", "[1, 0.05, 0.05]", "shape = { box = [1, 0.05, 0.05] }"},
             Mistake{"mass = 3\n", "\n", "mass = 3 (kg)"},
             Mistake{mass, "mass = 3\ndensity = 2\ninertia = [1, 1, 1]", "density"},
             Mistake{"type = \"revolute\"", "type = revolute", "\"revolute\""},
             Mistake{"position = [0.5, 0, 0]", "position = 0.5", "position = [0.5, 0, 0] along x"},
             Mistake{"", "[[load]]\ntype = \"torque\"\nbody = \"arm\"\nexpression = \"t\"",
                     "[\"0\", \"0\", \"t\"]"},
             Mistake{"", load + "expression = \"IF(t, 1, 2)\"", "step(x)*a"},
             Mistake{"", load + "expression = \"np.sin(t)\"", "sin(t)"},
             Mistake{"", load + "expression = \"SIN(t)\"", "did you mean 'sin'?"},
         })
        expect_answer(mistake);
}

TEST(Mistakes, OfTypesAreThoseOfTheTypeThatIsMeant)
{
    for (const Mistake& mistake : {
             Mistake{"\"revolute\"", "\"hinge\"", "livens calls it \"revolute\""},
             Mistake{"\"revolute\"", "\"Revolute\"", "livens calls it \"revolute\""},
             Mistake{"\"revolute\"", "\"HingeJoint\"", "livens calls it \"revolute\""},
             Mistake{"", spring + "damping = 1\n[method]\nfamily = \"RK45\"", "leave [method] out"},
             Mistake{"", spring + "damping = 1\n[method]\nfamily = \"bdf\"", "\"radau\""},
             Mistake{"", "[[load]]\ntype = \"damper\"\njoint = \"shaft\"\ndamping = 1", "\"spring\""},
             Mistake{"", "[[load]]\ntype = \"motor\"\njoint = \"shaft\"\nvalue = 1", "[[drive]]"},
             Mistake{"", "[[drive]]\ntype = \"motor\"\njoint = \"shaft\"\nrate = 1", "\"joint\""},
             Mistake{"", "[[sensor]]\nname = \"s\"\ntype = \"marker\"\nbody = \"arm\"", "\"point\""},
         })
        expect_answer(mistake);
}

TEST(Mistakes, OfKeysAreAnsweredWithTheKeyOrTheTable)
{
    for (const char* key : {"range", "lower", "stops"})
        expect_answer({axis, axis + "\n" + key + " = 1", "limits = [\"-90 deg\", \"90 deg\"]"});
    for (const char* key : {"d", "viscous_damping"})
        expect_answer({axis, axis + "\n" + key + " = 1", "livens calls it 'damping'"});
    expect_answer({axis, axis + "\nk = 1", "livens calls it 'stiffness'"});
    expect_answer({axis, axis + "\narmature = 1", "livens calls it 'rotor_inertia'"});
    for (const char* key : {"damping", "stiffness", "viscous_damping"})
        expect_answer({"type = \"revolute\"", "type = \"cylindrical\"\n" + std::string(key) + " = 1",
                       "angle = { damping = 0.1 }"});
    for (const char* key : {"motor", "actuator", "speed", "rpm"})
        expect_answer(
            {axis, axis + "\n" + key + " = 1", "[[drive]] with type = \"joint\", joint = \"shaft\""});
    for (const char* key : {"step", "dt", "steps", "timestep", "max_step", "maxStep", "h", "n_steps"})
        expect_answer({end, end + "\n" + key + " = 1", "no step size is needed"});
    for (const char* key : {"tolerance", "rtol", "RelTol"})
        expect_answer({end, end + "\n" + key + " = 1", "accuracy = 1e-8"});
    for (const char* key : {"duration", "t_end", "stop_time"})
        expect_answer({end, std::string(key) + " = 2", "livens calls it 'end'"});
    for (const char* key : {"euler", "rpy", "orientation", "rotation", "Euler_Angles"})
        expect_answer({mass, mass + "\n" + key + " = [0, 0, 1]", "quaternion = [w, x, y, z]"});
    for (const Mistake& mistake : {
             Mistake{"[[body]]", "[[bodies]]", "a table [[body]]"},
             Mistake{"[[body]]", "[body]", "[[body]]"},
             Mistake{"[[body]]", "[bodies.arm]", "a table [[body]]"},
             Mistake{"[[joint]]", "[[constraints]]", "a table [[joint]]"},
             Mistake{"mass", "m", "mass = 3 (kg)"},
             Mistake{"mass", "masss", "did you mean 'mass'?"},
             Mistake{"position", "pos", "'position'"},
             Mistake{axis, axis + "\nfriction = 1", "\"shaft.angle_rate\""},
             Mistake{axis, axis + "\nangle = 1", "[[start.coordinates]]"},
             Mistake{"\nat =", "\norigin =", "at = [x, y, z]"},
             Mistake{"axis =", "direction =", "axis = [0, 1, 0]"},
             Mistake{"between = [\"world\", \"arm\"]", "bodies = 1", "between"},
             Mistake{mass, mass + "\nfixed = true", "type = \"weld\""},
             Mistake{"", load + "torque = 1", "value = 1"},
             Mistake{"", spring + "k = 1", "'stiffness'"},
             Mistake{"", force + "magnitude = 1", "value = [10, 0, 0]"},
             Mistake{"", force + "value = [0, 0, 1]\nat = [0, 0, 0]", "'point'"},
             Mistake{"", drive + "omega = 1\n", "rate = 6.28"},
             Mistake{"", "[method]\ntype = \"radau\"", "'family'"},
             Mistake{"", "[method]\nfamily = \"radau\"\nrtol = 1", "`accuracy` in [time]"},
         })
        expect_answer(mistake);
}

TEST(Mistakes, GravityOfOtherUnitsIsNoticedFromTheEquatorToThePoles)
{
    for (const char* weight : {"-9780", "-9800", "-9832", "-981", "-386.4", "-32.2"})
        EXPECT_NE(find(read(replaced(arm, "-9.81]", std::string(weight) + "]")), "gravity-unit"), nullptr)
            << weight;
    for (const char* weight : {"-9.81", "-1.62", "-24.8", "-274", "-9700", "\"-9810 mm/s^2\"", "\"-1 g0\""})
        EXPECT_EQ(find(read(replaced(arm, "-9.81]", std::string(weight) + "]")), "gravity-unit"), nullptr)
            << weight;
}

TEST(Mistakes, SyntaxErrorsPointAtTheCause)
{
    for (const auto& [line, code, column] :
         {std::tuple("mass = 5 kg", "toml-syntax", 10), std::tuple("mass = 1,5", "toml-syntax", 9),
          std::tuple("mass = 010", "toml-syntax", 11), std::tuple("mass = upper", "toml-syntax", 8),
          std::tuple("mass = 1e400", "number-overflow", 8),
          std::tuple("mass = 99999999999999999999", "number-overflow", 8),
          std::tuple("{ a = 1 }", "toml-syntax", 1),
          std::tuple("x = { a = 1, a = 2 }", "duplicate-key", 14)}) {
        const ScenarioResult result = read("format = 1\n" + std::string(line) + "\n");
        ASSERT_EQ(result.diagnostics.size(), 1u) << line;
        EXPECT_EQ(result.diagnostics[0].code, code) << shown(result);
        EXPECT_EQ(result.diagnostics[0].line, 2) << shown(result);
        EXPECT_EQ(result.diagnostics[0].column, column) << shown(result);
    }
    for (const std::string line :
         {R"(x = { "s.angle" = 1, "s.angle" = 2 })", R"(x = { 's.angle' = 1, "s.angle"=2 })",
          "[x]\n\"s.angle\" = 1\n\"s.angle\" = 2"}) {
        const ScenarioResult twice = read("format = 1\n" + line + "\n");
        ASSERT_EQ(twice.diagnostics.size(), 1u) << line;
        EXPECT_EQ(twice.diagnostics[0].message, "'s.angle' is given a second time") << shown(twice);
        EXPECT_EQ(twice.diagnostics[0].length, 9) << shown(twice);
    }
    const ScenarioResult unit = read("mass = 5 kg\n");
    EXPECT_NE(unit.diagnostics[0].help.find("quotes"), std::string::npos);
    const ScenarioResult brackets = read("format = 1\n[body]\nname = \"a\"\n");
    ASSERT_NE(find(brackets, "wrong-type"), nullptr);
    EXPECT_NE(find(brackets, "wrong-type")->help.find("[[body]]"), std::string::npos);
}

/// Words that are names of parts, or keys where they belong, are nobody's mistakes.
TEST(Mistakes, AreNotSeenInWhatIsRight)
{
    for (const std::string& good :
         {replaced(replaced(arm, "name = \"shaft\"", "name = \"hinge\""), "between", "until = 1\nbetween"),
          arm + load + "value = 1\nname = \"motor\"", arm + spring + "damping = 1\nname = \"damper\"",
          arm + "output = 0.1\nstart = 0", arm + drive + "step = { from = 0, until = 1, rise = 1 }"})
        EXPECT_TRUE(read(good).scenario.has_value()) << shown(read(good));
}

}   // namespace
}   // namespace livens::mistakes_test
