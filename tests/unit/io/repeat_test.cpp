// SPDX-License-Identifier: BSD-3-Clause
// Tables of scenarios that stand many times.
#include <gtest/gtest.h>

#include "scenario_text.h"

namespace livens::repeat_test {

namespace {

using namespace test;

const std::string chain = R"(format = 1
gravity = [0, 0, -9.81]
[parameters]
n = 3
L = "0.5 m"
[[body]]
name = "link 0"
shape = { box = ["L", 0.05, 0.05] }
mass = 1
position = ["-L/2", 0, 0]
[[joint]]
name = "pin 0"
type = "revolute"
between = ["world", "link 0"]
at = ["-L", 0, 0]
axis = [0, 1, 0]
[[repeat]]
count = "n"
[[repeat.body]]
name = "link {i}"
shape = { box = ["L", 0.05, 0.05] }
mass = "1 kg + i*100 g"
position = ["(i-0.5)*L", 0, 0]
[[repeat.joint]]
name = "pin {i}"
type = "revolute"
between = ["link {i-1}", "link {i}"]
at = ["(i-1)*L", 0, 0]
axis = [0, 1, 0]
[[repeat.load]]
name = "friction {i}"
type = "actuator"
joint = "pin {i}"
inputs = { w = "pin {i}.angle_rate" }
expression = "-0.1*i*w + 0*'pin {i-1}'.angle"
[[repeat.sensor]]
name = "tip {i}"
type = "point"
body = "link {i}"
point = ["L/2", 0, 0]
[time]
end = 1
elements = 10
)";

TEST(Repeat, MakesCopiesThatKnowTheirIndex)
{
    const ScenarioResult result = read(chain);
    ASSERT_TRUE(result.scenario) << shown(result);
    EXPECT_TRUE(result.diagnostics.empty()) << shown(result);
    const Model& model = result.scenario->model;
    ASSERT_EQ(model.bodies().size(), 4u);
    EXPECT_EQ(model.bodies()[2].name, "link 2");
    EXPECT_DOUBLE_EQ(model.bodies()[3].X(0, 0), 1.25);
    EXPECT_DOUBLE_EQ(model.bodies()[3].mass(0, 0), 1.3);
    EXPECT_EQ(model.joints()[3].name, "pin 3");
    EXPECT_EQ(model.loads().size(), 3u);
    EXPECT_EQ(model.sensors()[1].name, "tip 2");
    EXPECT_EQ(result.scenario->text, chain) << "the text is kept as it is";
}

/// The copies are what would be written by hand.
TEST(Repeat, IsTheSameAsWritingItOut)
{
    std::string by_hand = chain.substr(0, chain.find("[[repeat]]"));
    const std::string each =
        chain.substr(chain.find("[[repeat.body]]"), chain.find("[time]") - chain.find("[[repeat.body]]"));
    for (int i = 1; i <= 3; ++i) {
        std::string copy = each;
        const auto replace_all = [&](const std::string& from, const std::string& to) {
            for (std::size_t at; (at = copy.find(from)) != std::string::npos;)
                copy.replace(at, from.size(), to);
        };
        replace_all("[[repeat.", "[[");
        replace_all("{i-1}", std::to_string(i - 1));
        replace_all("{i}", std::to_string(i));
        replace_all("(i-0.5)", std::to_string(i - 0.5));
        replace_all("(i-1)", std::to_string(i - 1));
        replace_all("+ i*100", "+ " + std::to_string(i) + "*100");
        replace_all("*i*w", "*" + std::to_string(i) + "*w");
        by_hand += copy;
    }
    const ScenarioResult written =
                             read(replaced(by_hand + chain.substr(chain.find("[time]")), "n = 3\n", "")),
                         made = read(chain);
    ASSERT_TRUE(written.scenario && made.scenario) << shown(written);
    const Model &a = written.scenario->model, &b = made.scenario->model;
    ASSERT_EQ(a.bodies().size(), b.bodies().size());
    for (std::size_t i = 0; i < a.bodies().size(); ++i) {
        EXPECT_EQ(a.bodies()[i].name, b.bodies()[i].name);
        EXPECT_TRUE(std::ranges::equal(a.bodies()[i].X.a, b.bodies()[i].X.a)) << i;
        EXPECT_TRUE(std::ranges::equal(a.bodies()[i].mass.a, b.bodies()[i].mass.a)) << i;
    }
    ASSERT_EQ(a.joints().size(), b.joints().size());
    for (std::size_t i = 0; i < a.joints().size(); ++i) EXPECT_EQ(a.joints()[i].name, b.joints()[i].name);
    EXPECT_EQ(a.loads().size(), b.loads().size());
}

/// Times of output behind an end that is found are left out, in whatever way the file says the rest.
TEST(Repeat, LeavesUnknownNumbersUnknown)
{
    const std::string found = R"(format = 1
gravity = [0, 0, -9.81]
[time]
end = { unknown = 2.6 }
elements = 16
periodic = true
output = [0.5, 20]
[[body]]
name = "bob"
shape = { point = true }
mass = 1
position = [1, 0, 0]
[[joint]]
name = "rod"
type = "rod"
between = ["world", "bob"]
[[joint]]
name = "plane"
type = "point_in_plane"
between = ["world", "bob"]
points = [[0, 0, 0], [0, 0, 0]]
axis = [0, 1, 0]
[start.known]
"bob.z" = 0
"bob.vz" = 0
)",
                      repeat = "[[repeat]]\ncount = 1\n[[repeat.load]]\nname = \"wind {i}\"\n"
                               "type = \"force\"\nbody = \"bob\"\nvalue = [0, 0, 0]\n";
    for (const std::string& text : {found, found + repeat}) {
        EXPECT_TRUE(read(text).scenario) << shown(read(text));
        EXPECT_FALSE(read(replaced(text, "{ unknown = 2.6 }", "2.6")).scenario) << "20 s are behind it";
    }
    const std::string no_number = replaced(found, "periodic = true", "periodic = { unknown = 1 }");
    EXPECT_FALSE(read(no_number).scenario);
    EXPECT_EQ(read(no_number).diagnostics.front().code, read(no_number + repeat).diagnostics.front().code);
}

TEST(Repeat, NamesAndFactorsOfCouplingsHaveTheIndex)
{
    const ScenarioResult result = read(replaced(chain, "[[repeat.load]]", R"([[repeat.joint]]
name = "follow {i}"
type = "coupling"
terms = { "pin {i}.angle" = "-i/2", "pin {i-1}.angle" = 1 }
[[repeat.load]])"));
    ASSERT_TRUE(result.scenario) << shown(result);
    const std::vector<Joint>& joints = result.scenario->model.joints();
    ASSERT_EQ(joints.size(), 7u);
    EXPECT_EQ(joints[6].name, "follow 3");
    EXPECT_EQ(joints[6].rows[0].scale, 1.5);
}

TEST(Repeat, CountsFromAnyFirstIndexUnderAnyName)
{
    const std::string text = R"(format = 1
parameters = { d = 2 }
[[repeat]]
index = "k"
first = -1
count = 3
[[repeat.body]]
name = "{k} and {k+d} and {2*(k+1)}"
mass = "k^2 + 1"
inertia = [1, 1, 1]
position = ["3*k", "-{k}", "k"]
[time]
end = 1
)";
    const ScenarioResult result = read(text);
    ASSERT_TRUE(result.scenario) << shown(result);
    const std::vector<Body>& bodies = result.scenario->model.bodies();
    ASSERT_EQ(bodies.size(), 3u);
    EXPECT_EQ(bodies[0].name, "-1 and 1 and 0");
    EXPECT_EQ(bodies[0].mass(0, 0), 2) << "(-1)^2, not -(1^2)";
    EXPECT_EQ(bodies[0].X(1, 0), 1);
    EXPECT_EQ(bodies[2].X(0, 0), 3);
    EXPECT_EQ(bodies[2].X(2, 0), 1) << "the index alone";
}

TEST(Repeat, TellsPlaceAndIndexOfWhatIsWrong)
{
    const auto expect_told = [](const std::string& from, const std::string& to, std::string_view code,
                                const std::string& where, const std::string& index) {
        const std::string text = replaced(chain, from, to);
        const ScenarioResult result = read(text);
        const Diagnostic* d = find(result, code);
        ASSERT_NE(d, nullptr) << shown(result);
        EXPECT_EQ(d->line, spot(text, where).line) << shown(result);
        EXPECT_NE(d->note.find(index), std::string::npos) << shown(result);
        const auto is_it = [&](const Diagnostic& one) {
            return one.code == code && one.line == d->line && one.column == d->column;
        };
        EXPECT_EQ(std::ranges::count_if(result.diagnostics, is_it), 1) << "copies are not told of again:\n"
                                                                       << shown(result);
    };
    expect_told("name = \"link {i}\"\nshape", "name = \"link\"\nshape", "name-duplicate",
                "name = \"link\"\nshape", "i = 2");
    expect_told("[\"L\", 0.05, 0.05] }\nmass = \"1", "[\"(i-2)*L\", 0.05, 0.05] }\nmass = \"1",
                "out-of-range", "{ box = [\"(i", "i = 1");
    expect_told("1 kg + i*100 g", "1 kg/(i-2)", "expression-value", "\"1 kg/", "i = 2");
    expect_told("1 kg + i*100 g", "1 m", "unit", "\"1 m\"", "i = 1");
    expect_told("\"link {i-1}\"", "\"link {i-2}\"", "body-unknown", "[\"link {i-2}", "i = 1");
    expect_told("\"link {i-1}\"", "\"link {i/2}\"", "repeat-braces", "[\"link {i/2}", "i = 1");
    expect_told("\"link {i-1}\"", "\"link {j}\"", "repeat-braces", "[\"link {j}", "i = 1");
    expect_told("\"link {i-1}\"", "\"link {i-1\"", "repeat-braces", "[\"link {i-1", "i = 1");
    expect_told("\"link {i-1}\"", "\"link {}\"", "repeat-braces", "[\"link {}", "i = 1");
    expect_told("\"link {i-1}\"", "\"link {i*L}\"", "repeat-braces", "[\"link {i*L}", "i = 1");
}

TEST(Repeat, HasAHeadOfItsOwn)
{
    expect_error(replaced(chain, "count = \"n\"", "count = 0"), "out-of-range", "0\n[[repeat.body");
    expect_error(replaced(chain, "count = \"n\"", "count = \"n/2\""), "wrong-type", "\"n/2\"");
    expect_error(replaced(chain, "count = \"n\"\n", ""), "missing-key", "[[repeat]]");
    expect_error(replaced(chain, "count = \"n\"", "number = 3"), "unknown-key", "number");
    expect_error(replaced(chain, "count = \"n\"", "count = 2\nbodies = []"), "unknown-key", "bodies");
    for (const char* name : {"m", "sin", "t", "n", "1i", "a b"})
        expect_error(replaced(chain, "count = \"n\"", "count = 2\nindex = \"" + std::string(name) + "\""),
                     "repeat-index", "\"" + std::string(name) + "\"\n[[repeat.body");
    EXPECT_EQ(read(replaced(chain, "n = 3", "n = true")).diagnostics.size(), 1u) << "told once";
    // Neither memory nor time is spent on what is too large.
    const std::string long_text(100000, 'x');
    expect_error("format = 1\n[time]\nend = 1\n[[repeat]]\ncount = 10000\nbody = [{ name = \"" + long_text +
                     "\" }]\n",
                 "resource-limit", "10000\nbody");
}

}   // namespace

}   // namespace livens::repeat_test
