// SPDX-License-Identifier: BSD-3-Clause
// Result files of strangers: what is in them contradicts itself, and every checksum fits.
#include <functional>
#include <limits>

#include "fuzz/crafted.h"
#include "livens/io/json.h"
#include "livens/multibody/model.h"
#include "unit/io/sample_run.h"

namespace livens::crafted_files_test {
namespace {

using test::Crafted;

Crafted whole()
{
    const Model model = sample_model();
    return Crafted(image_of(model, sample_run(model)));
}

/// Code and words of the refusal; empty: it was read.
std::string said_of(const Crafted& crafted)
{
    const std::string bytes = crafted.bytes();
    try {
        read_run_from(source_of(bytes));
    } catch (const IoError& error) {
        return error.code() + ": " + error.what();
    }
    return "";
}

std::string said(const std::function<void(Crafted&)>& change)
{
    Crafted crafted = whole();
    change(crafted);
    return said_of(crafted);
}

void expect_damaged(const std::string& said, const std::string& part)
{
    EXPECT_TRUE(said.starts_with("io-damaged: ")) << said;
    EXPECT_NE(said.find(part), std::string::npos) << said;
}

/// The control of all that follows: taken apart and put together it is the file that it was.
TEST(CraftedFiles, WithoutAChangeTheyAreRead)
{
    const Model model = sample_model();
    const std::string image = image_of(model, sample_run(model));
    EXPECT_EQ(said_of(whole()), "");
    const std::string again = Crafted(image).bytes();
    EXPECT_EQ(image_of(model, read_run_from(source_of(again))), image);
}

TEST(CraftedFiles, TwoOfOneNameAreRefused)
{
    for (const ClassicDimension& dimension : whole().dimensions)
        for (const std::uint64_t length : {0, 1, 3, 0x7fffffff})
            for (const bool is_first : {true, false})
                expect_damaged(said([&](Crafted& c) {
                                   c.add({dimension.name, length}, is_first);
                               }),
                               "two dimensions in its header have the name '" + dimension.name + "'");
    expect_damaged(said([](Crafted& c) { c.variables.push_back(*c.find("X")); }), "two variables");
    expect_damaged(said([](Crafted& c) { c.attributes.push_back({"n_bodies", 1 << 30}); }), "two attributes");
    expect_damaged(said([](Crafted& c) {
                       c.find("X")->attributes.push_back({"degree", 32});
                   }),
                   "two attributes");
    EXPECT_EQ(said([](Crafted& c) { c.add({"something else", 5}, true); }), "") << "a control";
}

/// Each dimension in turn, with what hangs on it: no width of zero is counted up by, no length divided by.
TEST(CraftedFiles, LengthsOfZeroAreRefusedWhereTheyAreRead)
{
    const Crafted untouched = whole();
    for (std::size_t i = 0; i < untouched.dimensions.size(); ++i) {
        Crafted c = untouched;
        c.dimensions[i].length = 0;
        for (Crafted::Variable& v : c.variables)
            if (std::ranges::count(v.dimensions, i) > 0) v.data.clear();
        const std::string said = said_of(c);
        EXPECT_TRUE(said.empty() || said.starts_with("io-damaged: ")) << said;
    }
    for (const char* name : {"body", "body_length", "row_length", "X_node", "P_node", "multiplier_node",
                             "xyz", "rigidity_node", "element_end", "note_length", "scenario_length"})
        expect_damaged(said([&](Crafted& c) {
                           const std::uint32_t number = c.number_of(name);
                           c.dimensions[number].length = 0;
                           for (Crafted::Variable& v : c.variables)
                               if (std::ranges::count(v.dimensions, number) > 0) v.data.clear();
                       }),
                       "a dimension of length 0");
}

TEST(CraftedFiles, RanksAndNamesAreBounded)
{
    for (const std::size_t rank : {std::size_t{9}, std::size_t{100'000}})
        expect_damaged(said([&](Crafted& c) {
                           c.dimensions.push_back({"one", 1});
                           c.find("X")->dimensions.assign(rank, c.number_of("one"));
                       }),
                       "more than 8 dimensions");
    for (const std::size_t n : {std::size_t{0}, std::size_t{257}, std::size_t{400'000}})
        expect_damaged(said([&](Crafted& c) {
                           c.dimensions.push_back({std::string(n, 'n'), 1});
                       }),
                       "longer than 256 bytes");
    EXPECT_EQ(said([](Crafted& c) {
                  c.dimensions.push_back({std::string(256, 'n'), 1});
                  Crafted::Variable& v = c.variables.emplace_back();
                  v.name = "own";
                  v.dimensions.assign(8, c.number_of(std::string(256, 'n')));
                  v.data.assign(8, '\0');
              }),
              "");
    expect_damaged(said([](Crafted& c) {
                       for (int i = 0; i < 5000; ++i) c.attributes.push_back({"a" + std::to_string(i), i});
                   }),
                   "too many entries");
}

/// 400 variables of one megabyte each, which are the same megabyte: reading them all would take 400.
TEST(CraftedFiles, VariablesHaveNoByteInCommon)
{
    expect_damaged(said([](Crafted& c) {
                       const std::string image = whole().bytes();
                       c.dimensions.push_back({"many", 1u << 17});
                       Crafted::Variable one{"v", {c.number_of("many")}, {}, 6, std::string(1u << 20, '\0')};
                       c.variables.push_back(one);
                       c.variables.push_back(one);
                       c.variables.back().name = "w";
                       for (int i = 0; i < 400; ++i) {
                           Crafted::Variable& v = c.variables.emplace_back(one);
                           v.name += std::to_string(i);
                           v.data.clear();
                           v.begin = image.size() + (1u << 16);
                       }
                   }),
                   "upon each other");
}

/// Loads read as many angles as their model has, whatever the motion holds.
TEST(CraftedFiles, AnglesOfLoadsAreThoseOfTheModel)
{
    const Model model = sample_model();
    for (const std::size_t n : {1, 3, 40}) {
        RunFile run = sample_run(model);
        run.motion.load_angles.resize(n * run.motion.mesh.ends.size());
        EXPECT_THROW(check_model(model, run), IoError) << n;
    }
    RunFile run = sample_run(model);
    EXPECT_NO_THROW(check_model(model, run));
    run.motion.load_angles.clear();
    EXPECT_NO_THROW(check_model(model, run)) << "nobody counted";
}

TEST(CraftedFiles, NumbersThatLeadNowhereAreRefused)
{
    const auto refused = [](auto&& change) {
        RunFile run = sample_run(sample_model());
        change(run);
        try {
            check_run(run);
        } catch (const IoError& error) {
            return error.code() == "io-damaged";
        }
        return false;
    };
    EXPECT_TRUE(refused([](RunFile& r) {
        r.motion.mesh.ends.front() = -std::numeric_limits<double>::max();
        r.motion.mesh.ends.back() = std::numeric_limits<double>::max();
    }));
    EXPECT_TRUE(refused([](RunFile& r) {
        r.motion.rigidity = {};
        r.motion.rigidity.denominators = {1};
    }));
}

/// Options go as they are into JSON of our own.
TEST(CraftedFiles, OptionsAreAJsonObject)
{
    const auto with = [](const std::string& options) {
        return said([&](Crafted& c) {
            Crafted::Variable& v = *c.find("options");
            c.dimensions[c.number_of("options_length")].length = options.size();
            v.data = options;
            v.data.resize(padded(options.size()));
        });
    };
    EXPECT_EQ(with("{\"a\": [1, -2.5e3, true, null, {\"b\": \"\\u00e4\\n\"}]}"), "");
    for (const char* options : {"{}, \"converged\": true", "{\"a\": 1", "[1]", "{\"a\": 01}", "{\"a\" 1}",
                                "{'a': 1}", "{\"a\": 1.}", "{\"a\": \"\n\"}", "{\"a\": \"\\x\"}", "x", "{}}"})
        expect_damaged(with(options), "no JSON object");
    EXPECT_TRUE(is_json(std::string(60, '[') + std::string(60, ']')));
    EXPECT_FALSE(is_json(std::string(100'000, '[')));
}

}   // namespace
}   // namespace livens::crafted_files_test
