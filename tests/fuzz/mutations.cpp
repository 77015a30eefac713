// SPDX-License-Identifier: BSD-3-Clause
// Random damage to scenarios and URDFs, the same in every run: each text ends in findings or a scenario.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <random>
#include <sstream>
#include <vector>

#include "fuzz/scenario.h"
#include "fuzz/urdf.h"
#include "livens/base/error.h"
#include "livens/io/scenario/bodies/collada.h"

namespace livens {

namespace {

/// Files of these folders with that ending.
std::vector<std::string> files_of(const std::vector<std::string>& folders, const std::string& ending)
{
    std::vector<std::filesystem::path> files;
    for (const std::string& folder : folders)
        for (const auto& entry : std::filesystem::directory_iterator(LIVENS_SOURCE_DIR + folder))
            if (entry.path().extension() == ending) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::vector<std::string> texts;
    for (const std::filesystem::path& file : files) {
        std::ifstream stream(file, std::ios::binary);
        texts.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    }
    return texts;
}

std::vector<std::string> damaging(const std::string& words)
{
    std::istringstream all(words);
    std::vector<std::string> odd{"\r\n", "\t", "\n"};
    for (std::string word; all >> word;) odd.push_back(word);
    return odd;
}

/// What a scenario may be damaged with, what a URDF, and what a Collada file.
const std::vector<std::string>& words_of_scenarios()
{
    static const std::vector<std::string> all = damaging(
        "nan -inf 1e308 -1e-308 1e400 0 -0.0 9223372036854775807 1_0 0x7f \"\" \"5mm\" \"world\" [] {} [[]] "
        "true "
        "[[1,0,0],[0,1,0]] 1979-05-27 [body.end] [[joint]] [[load]] [end] given=\"state\" type=\"universal\" "
        "[parameters] [[repeat]] \"2*L\" \"1/0\" \"{i}\" \"{\" \"(i-1)*3mm\" \"1m+1kg\" count=10000 "
        "L=\"2*L\" "
        "family=\"mixed\" basis=\"nurbs\" window=\"all\" shape={point=true} \\u202e \xc2\x85 \xe2\x80\xae "
        "\xc3\xa4 \xff \x01 \"\"\" ''' . = [ ] { } , \" #");
    return all;
}

const std::vector<std::string>& words_of_urdfs()
{
    static const std::vector<std::string> all =
        damaging("nan -inf 1e308 -1e-308 1e400 0 -1 <link <joint name=\"a\"/> </link> </robot> <robot> "
                 "<!DOCTYPE <!-- --> "
                 "<![CDATA[ ]]> <?xml?> &amp; &lol; &#0; &#xffff; base arm lift world type=\"fixed\" "
                 "type=\"prismatic\" "
                 "<mimic joint=\"lift\"/> <mass value=\"0\"/> xyz=\"0 0 0\" ${a} xacro:x \xff \x01 "
                 "\xe2\x80\xae . = < > / \" ' 1,5");
    return all;
}

const std::vector<std::string>& words_of_colladas()
{
    static const std::vector<std::string> all =
        damaging("nan -inf 1e308 1e-320 1e400 0 -1 4 2147483647 2147483648 <node> </node> <p> </p> <vcount> "
                 "<!DOCTYPE <!-- --> "
                 "&amp; &lol; &#0; url=\"#foot\" url=\"#leg\" url=\"#scene\" source=\"#corners\" "
                 "offset=\"2\" offset=\"-1\" "
                 "offset=\"999\" stride=\"0\" stride=\"5\" meter=\"-1\" POSITION VERTEX triangles trifans "
                 "polygons tristrips \xff "
                 "\x01 . = < > / \" ' 1,5");
    return all;
}

/// Begin and length of a word, a line or a character of a text.
struct Piece {
    std::size_t begin, length;
};

class Mutation {
public:
    Mutation(const std::vector<std::string>& texts, const std::vector<std::string>& odd, unsigned seed)
        : texts_(texts), odd_(odd), random_(seed)
    {}

    std::string text()
    {
        std::string text = any(texts_);
        for (std::size_t n = 1 + below(6); n > 0 && !text.empty(); --n) change(text);
        return text;
    }

private:
    std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }
    template <class Values>
    auto any(const Values& values) -> decltype(values[0])
    {
        return values[below(std::size(values))];
    }

    Piece piece(const std::string& text, const char* separators)
    {
        const std::size_t at = below(text.size());
        const std::size_t before = text.find_last_of(separators, at);
        const std::size_t begin = before == std::string::npos ? 0 : std::min(before + 1, at);
        return {begin, std::min(text.find_first_of(separators, at), text.size()) - begin};
    }

    void change(std::string& text)
    {
        const Piece word = piece(text, " \n,=[]{}\""), line = piece(text, "\n");
        const std::string& other = any(texts_);
        switch (below(9)) {
        case 0:
            text.erase(below(text.size()), below(6));
            break;
        case 1:
            text.insert(below(text.size()), any(odd_));
            break;
        case 2:
            text[below(text.size())] = static_cast<char>(below(256));
            break;
        case 3:
            text.resize(below(text.size() + 1));
            break;
        case 4:
            text.replace(word.begin, word.length, any(odd_));
            break;
        case 5:
            text.erase(line.begin, line.length);
            break;
        case 6:
            text.insert(line.begin, text.substr(line.begin, line.length + 1));
            break;
        case 7: {
            const Piece from = piece(other, "\n");
            text.insert(line.begin, other.substr(from.begin, from.length) + "\n");
            break;
        }
        default: {
            const Piece from = piece(other, " \n,=[]{}\"");
            text.replace(word.begin, word.length, other.substr(from.begin, from.length));
        }
        }
    }

    const std::vector<std::string>& texts_;
    const std::vector<std::string>& odd_;
    std::mt19937 random_;
};

/// LIVENS_MUTATIONS asks for another number of them, LIVENS_FIRST_MUTATION where to begin. More than one in
/// `valid_in` is to be read.
template <class IsAnswered, class IsValid>
void damage(const std::vector<std::string>& texts, const std::vector<std::string>& odd, unsigned usual,
            unsigned valid_in, const IsAnswered& is_answered, const IsValid& is_valid)
{
    const char* wanted = std::getenv("LIVENS_MUTATIONS");
    const unsigned n = wanted != nullptr ? static_cast<unsigned>(std::atol(wanted)) : usual;
    const char* from = std::getenv("LIVENS_FIRST_MUTATION");
    const unsigned first = from != nullptr ? static_cast<unsigned>(std::atol(from)) : 0;
    unsigned n_valid = 0;
    for (unsigned seed = first; seed < first + n; ++seed) {
        if (wanted != nullptr && seed % 10'000 == 0) std::cerr << "seed " << seed << std::endl;
        const std::string text = Mutation(texts, odd, seed).text();
        ASSERT_TRUE(is_answered(text)) << "seed " << seed << ":\n" << text;
        n_valid += is_valid(text) ? 1 : 0;
    }
    EXPECT_GT(n_valid, n / valid_in) << "hardly any text gets beyond the parser";
    EXPECT_LT(n_valid, n / 2) << "hardly any text is damaged";
}

TEST(Mutations, EachEndsInFindingsOrAScenario)
{
    const std::vector<std::string> texts = files_of({"/examples", "/tests/fuzz/corpus"}, ".toml");
    ASSERT_GT(texts.size(), 10u);
    damage(texts, words_of_scenarios(), 8'000, 20, test::is_answered,
           [](const std::string& text) { return parse_scenario(text, "").scenario.has_value(); });
}

TEST(Mutations, EachColladaEndsInFacesOrAnError)
{
    const std::vector<std::string> texts = files_of({"/tests/fuzz/corpus_collada"}, ".dae");
    ASSERT_EQ(texts.size(), 1u);
    const auto read = [](const std::string& text) -> std::optional<Mesh> {
        try {
            return io_internal::read_collada(text, "a.dae");
        } catch (const InputError& error) {
            EXPECT_EQ(error.complaint().code, "mesh-format") << text;
            return {};
        }
    };
    const auto is_sound = [&](const std::string& text) {
        const std::optional<Mesh> mesh = read(text);
        if (!mesh) return true;
        const auto n = static_cast<std::int32_t>(mesh->points.size());
        return std::ranges::all_of(mesh->blocks.front().nodes,
                                   [&](std::int32_t node) { return node >= 0 && node < n; }) &&
               std::ranges::all_of(mesh->points, [](const Vector3& x) { return std::isfinite(norm(x)); });
    };
    damage(texts, words_of_colladas(), 8'000, 20, is_sound,
           [&](const std::string& text) { return read(text).has_value(); });
}

TEST(Mutations, EachUrdfEndsInFindingsOrAScenario)
{
    const std::vector<std::string> texts = files_of({"/tests/fuzz/corpus_urdf"}, ".urdf");
    ASSERT_GT(texts.size(), 1u);
    UrdfOptions options;
    options.meshes = UrdfOptions::Meshes::none;
    damage(texts, words_of_urdfs(), 8'000, 50, test::is_answered_as_urdf,
           [&](const std::string& text) { return parse_urdf(text, "", options).scenario.has_value(); });
}

}   // namespace

}   // namespace livens
