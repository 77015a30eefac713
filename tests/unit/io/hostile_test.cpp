// SPDX-License-Identifier: BSD-3-Clause
// Files that mean harm, or are no scenarios at all: every one ends in a diagnostic, quickly.
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>

#include "unit/io/scenario_text.h"

namespace livens::hostile_test {

namespace {

using test::expect_error;
using test::find;
using test::read;
using test::shown;

/// A folder that is gone after the test.
class Folder {
public:
    Folder() : path_(std::filesystem::temp_directory_path() / ("livens_io_" + std::to_string(::getpid())))
    {
        std::filesystem::create_directories(path_);
    }
    ~Folder() { std::filesystem::remove_all(path_); }
    std::filesystem::path file(const std::string& name, const std::string& text) const
    {
        std::ofstream(path_ / name, std::ios::binary) << text;
        return path_ / name;
    }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

void expect_file_error(const std::filesystem::path& file, std::string_view code)
{
    const ScenarioResult result = read_scenario(file);
    EXPECT_FALSE(result.scenario.has_value());
    EXPECT_NE(find(result, code), nullptr) << shown(result);
}

TEST(Hostile, WhatIsNoFileIsSaidToBeNone)
{
    const Folder folder;
    expect_file_error(folder.path(), "io-directory");
    expect_file_error(folder.path() / "missing.toml", "io-not-found");
    expect_file_error(folder.path() / "missing" / "missing.toml", "io-not-found");
    expect_file_error("", "io-not-found");
    expect_file_error(folder.file("empty.toml", ""), "empty-file");
}

TEST(Hostile, FilesWithoutPermissionAreUnreadable)
{
    if (::geteuid() == 0) GTEST_SKIP() << "root may read everything";
    const Folder folder;
    const std::filesystem::path secret = folder.file("secret.toml", "format = 1\n");
    std::filesystem::permissions(secret, std::filesystem::perms::none);
    expect_file_error(secret, "io-unreadable");
}

TEST(Hostile, SizeIsCheckedBeforeReading)
{
    const Folder folder;
    const std::filesystem::path big = folder.file("big.toml", "format = 1\n");
    std::filesystem::resize_file(big, std::uintmax_t{1} << 40);   // sparse: reading it would take an hour
    expect_file_error(big, "resource-limit");
    expect_file_error("/dev/zero", "resource-limit");
    EXPECT_NE(find(read(std::string(max_scenario_bytes + 1, ' ')), "resource-limit"), nullptr);
    EXPECT_NE(find(read(std::string(max_scenario_bytes, ' ')), "empty-file"), nullptr);
}

TEST(Hostile, BinaryFilesAreNotText)
{
    expect_error(std::string("\x7f"
                             "ELF\x02\x01\x01\0\0\0",
                             10),
                 "not-text", "\x7f");
    expect_error("a = 1\nb = \"\x01\"\n", "not-text", "\x01");
}

TEST(Hostile, ColumnsBehindOtherCharactersCountThem)
{
    const ScenarioResult result = read("a = \"\xc3\xbc\xff\"");
    ASSERT_EQ(result.diagnostics.size(), 1u);
    EXPECT_EQ(result.diagnostics[0].column, 7) << "a = \"ü is six characters";
}

TEST(Hostile, NestingIsBoundedBeforeParsing)
{
    constexpr int many = 100'000;
    std::string tables = "a = ";
    for (int i = 0; i < many; ++i) tables += "{a=";
    std::string dots = "a";
    for (int i = 0; i < many; ++i) dots += ".a";
    const std::string lists = "a = " + std::string(many, '[') + std::string(many, ']');
    for (const std::string& text : {tables, dots + " = 1", "[" + dots + "]", "[[" + dots + "]]", lists,
                                    "x = {" + dots + "=1}", "format = 1\nx = [\n" + std::string(many, '[')})
        EXPECT_NE(find(read(text), "too-deep"), nullptr) << text.substr(0, 20);
}

TEST(Hostile, TheDeepestThatIsAllowedIsParsed)
{
    const std::string deepest =
        "a = " + std::string(max_scenario_depth, '[') + std::string(max_scenario_depth, ']') + "\n";
    EXPECT_NE(find(read(deepest), "unknown-key"), nullptr) << shown(read(deepest));
    std::string key = "a";
    for (int i = 0; i < max_scenario_depth; ++i) key += ".a";
    EXPECT_NE(find(read("[" + key.substr(4) + "]\n" + key.substr(2) + " = 1\n"), "unknown-key"), nullptr);
    // Neither the braces nor the dots of one key are too many, but all together.
    std::string text;
    for (int i = 0; i < 40; ++i) text += "a.a = {";
    EXPECT_NE(find(read(text + std::string(40, '}')), "too-deep"), nullptr);
}

TEST(Hostile, BracketsInTextsAndCommentsAreNoNesting)
{
    const std::string brackets(1000, '[');
    const std::string text = "format = 1 # " + brackets + "\ntitle = \"" + brackets + "\\\"" + brackets +
                             "\"\n" + "x = '" + brackets + "'\ny = \"\"\"" + brackets + "\n\"\"" + brackets +
                             "\"\"\"\"\n" + "z = '''" + brackets + "\n''" + brackets + "'''\n";
    const ScenarioResult result = read(text);
    EXPECT_EQ(find(result, "too-deep"), nullptr) << shown(result);
    EXPECT_NE(find(result, "unknown-key"), nullptr) << shown(result);
}

TEST(Hostile, CountsAreBounded)
{
    std::string numbers = "format = 1\nx = [";
    for (int i = 0; i < 2'100'000; ++i) numbers += "1,";
    EXPECT_NE(find(read(numbers + "]\n"), "resource-limit"), nullptr);
    std::string bodies = "format = 1\n";
    for (int i = 0; i < 10'001; ++i)
        bodies += "[[body]]\nname = \"" + std::to_string(i) + "\"\nshape = { point = true }\nmass = 1\n";
    EXPECT_NE(find(read(bodies + "[time]\nend = 1\nelements = 1\n"), "resource-limit"), nullptr);
    for (const char* time :
         {"end = 1\nelements = 10000000\noutput = 1e-7\n", "end = 1\nelements = 10000000\n"}) {
        const std::string text = test::replaced(test::valid_scenario, "end = 1\nelements = 10\n", time);
        EXPECT_NE(find(read(text), "resource-limit"), nullptr) << "the motion would not fit into memory";
    }
}

TEST(Hostile, AMillionMistakesAreTwentyFindings)
{
    std::string text = "format = 1\n";
    for (int i = 0; i < 100'000; ++i) text += "[[body]]\n";
    const ScenarioResult result = read(text);
    EXPECT_EQ(result.diagnostics.size(), 20u);
    EXPECT_NE(result.diagnostics.back().note.find("more are not shown"), std::string::npos);
}

/// The parser holds that it cannot meet them: a bare key, a header, a value beyond ASCII.
TEST(Hostile, LettersBeyondAsciiOutsideQuotesAreSyntaxErrors)
{
    for (const char* letter : {"\xc3\xa4", "\xc2\xa0", "\xe1\x9a\x80", "\xcc\x81", "\xe2\x80\xae",
                               "\xef\xbb\xbf", "\xf0\x9f\x8c\x8d", "\xef\xbf\xbf", "\xe1\x88\xb4"})
        for (const char* line :
             {"# = 1", "a# = 1", "[#]", "[a.#]", "[[#]]", "x.# = 1", "x = #", "x = [#]", "x = 1 #",
              "x = { # = 1 }", "x = 1#", "x = 1e#", "x = t#", "x = 19#9-01-01"}) {
            std::string text = "format = 1\n" + std::string(line) + "\n";
            text.replace(text.find('#'), 1, letter);
            const ScenarioResult result = read(text);
            EXPECT_FALSE(result.scenario.has_value());
            EXPECT_TRUE(find(result, "toml-syntax") != nullptr || find(result, "missing-key") != nullptr)
                << text << shown(result);   // some are blanks for the parser
        }
    const ScenarioResult key = read("format = 1\n\xc3\xa4 = 1\n");
    ASSERT_NE(find(key, "toml-syntax"), nullptr) << shown(key);
    EXPECT_EQ(find(key, "toml-syntax")->line, 2);
    EXPECT_EQ(find(key, "toml-syntax")->column, 1);
    EXPECT_NE(find(key, "toml-syntax")->help.find("quotes"), std::string::npos);
    expect_error("format = 1\n[\xc3\xa4]\n", "toml-syntax", "[");
}

TEST(Hostile, NamesThatDeceiveAreRefusedAndShownEscaped)
{
    for (const auto& [mark, name] : {std::pair("\xc2\x80", "U+0080"), std::pair("\xc2\x9f", "U+009F"),
                                     std::pair("\\u0007", "U+0007"), std::pair("\\u007F", "U+007F"),
                                     std::pair("\xe2\x80\x8e", "U+200E"), std::pair("\xe2\x80\x8f", "U+200F"),
                                     std::pair("\xe2\x80\xa8", "U+2028"), std::pair("\xe2\x80\xaa", "U+202A"),
                                     std::pair("\\u202E", "U+202E"), std::pair("\xe2\x81\xa6", "U+2066"),
                                     std::pair("\xe2\x81\xa9", "U+2069"), std::pair("\xd8\x9c", "U+061C")})
        for (const char* given : {"\"upper\"\nshape", "\"shoulder\"", "\"push\""}) {
            const std::string changed = "\"a" + std::string(mark) + std::string(given).substr(1);
            const std::string text = test::replaced(test::valid_scenario, given, changed);
            expect_error(text, "name-invalid", changed.substr(0, 2));
            const ScenarioResult result = read(text);
            ASSERT_NE(find(result, "name-invalid"), nullptr);
            EXPECT_NE(find(result, "name-invalid")->message.find(name), std::string::npos) << shown(result);
            for (const DiagnosticFormat format :
                 {DiagnosticFormat::human, DiagnosticFormat::gnu, DiagnosticFormat::json})
                for (const char* hidden : {"\xc2\x80", "\xc2\x9f", "\x07", "\x7f", "\xe2\x80\x8e",
                                           "\xe2\x80\xae", "\xe2\x80\xa8", "\xe2\x81\xa6", "\xd8\x9c"})
                    EXPECT_EQ(render(result.diagnostics, text, format).find(hidden), std::string::npos);
        }
    const std::string letters =
        test::replaced(test::valid_scenario, "\"push\"", "\"Sto\xc3\x9f \xe6\x97\xa5\"");
    EXPECT_TRUE(read(letters).scenario.has_value()) << shown(read(letters));
}

/// Random damage to valid text: no crash, and never both a scenario and an error.
TEST(Hostile, DamagedTextNeverCrashes)
{
    std::mt19937 random(20240501);
    const std::string alphabet = "[]{}=\"'#.,\n\\ \t\r0aeE-+_\x01\x80\xff\xc3\xbc";
    for (int trial = 0; trial < 1500; ++trial) {
        std::string text = test::valid_scenario;
        for (int n = 1 + trial % 4; n > 0; --n) {
            const std::size_t at = random() % text.size();
            const std::size_t length = random() % 6;
            switch (random() % 4) {
            case 0:
                text.erase(at, length);
                break;
            case 1:
                text.insert(at, 1, alphabet[random() % alphabet.size()]);
                break;
            case 2:
                text[at] = alphabet[random() % alphabet.size()];
                break;
            default:
                text.resize(at + 1);
                break;
            }
        }
        const ScenarioResult result = read(text);
        const bool has_error = std::any_of(result.diagnostics.begin(), result.diagnostics.end(),
                                           [](const Diagnostic& d) { return d.severity == Severity::error; });
        ASSERT_NE(result.scenario.has_value(), has_error) << text;
        ASSERT_EQ(result.text, text);
        ASSERT_FALSE(!result.diagnostics.empty() && shown(result).empty());
    }
}

TEST(Hostile, ExtremeNumbersNeverCrash)
{
    for (const char* number : {"1e308", "-1e308", "1e-308", "0", "-0.0", "1e200", "9223372036854775807"})
        for (const char* place : {"-9.81", "0.2, 0.1", "1000", "0.5, 0, 0", "2\ninertia", "0.2, 0.3, 0.4",
                                  "1.5, 0, 0", "0, 1, 0]"}) {
            std::string text = test::valid_scenario;
            const std::size_t at = text.find(place);
            ASSERT_NE(at, std::string::npos);
            text.replace(at, std::string(place).find_first_of(",\n]"), number);
            const ScenarioResult result = read(text);
            EXPECT_TRUE(result.scenario.has_value() || !result.diagnostics.empty());
        }
}

TEST(Hostile, ByteOrderMarkAndWindowsLinesAreFine)
{
    std::string text = "\xef\xbb\xbf";
    for (const char c : test::valid_scenario) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
    EXPECT_TRUE(read(text).scenario.has_value()) << shown(read(text));
    const ScenarioResult wrong = read(test::replaced(text, "density", "densty"));
    ASSERT_NE(find(wrong, "unknown-key"), nullptr);
    EXPECT_EQ(find(wrong, "unknown-key")->line, 7);
    EXPECT_NE(shown(wrong).find("7 | densty = 1000\n"), std::string::npos) << shown(wrong);
    const ScenarioResult first = read("\xef\xbb\xbfmat = 1\n");
    ASSERT_NE(find(first, "unknown-key"), nullptr);
    EXPECT_EQ(find(first, "unknown-key")->column, 1);
}

}   // namespace

}   // namespace livens::hostile_test
