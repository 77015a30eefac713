// SPDX-License-Identifier: BSD-3-Clause
#include "livens/io/diagnostic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "livens/io/scenario/text/findings.h"

namespace livens::diagnostic_test {

namespace {

Diagnostic sample(int line, int column, int length)
{
    return {Severity::error, "unknown-key", "unknown key 'postion' in body 'upper'",
            "a.toml",        line,          column,
            length,          "a note",      "did you mean 'position'?"};
}

TEST(Diagnostics, HumanFormShowsTheLineAndUnderlinesThePlace)
{
    const std::string text = render({sample(2, 3, 7)}, "first\n  postion = 1\r\nlast\n",
                                    DiagnosticFormat::human);
    EXPECT_EQ(text,
              "error[unknown-key]: unknown key 'postion' in body 'upper'\n"
              " --> a.toml:2:3\n"
              "  |\n"
              "2 |   postion = 1\n"
              "  |   ^^^^^^^\n"
              "  = note: a note\n"
              "  = help: did you mean 'position'?\n");
}

TEST(Diagnostics, WholeFileFindingsShowNoLine)
{
    Diagnostic d = sample(0, 0, 1);
    d.note = d.help = "";
    EXPECT_EQ(render({d}, "x", DiagnosticFormat::human),
              "error[unknown-key]: unknown key 'postion' in body 'upper'\n--> a.toml\n");
    EXPECT_EQ(render({d}, "x", DiagnosticFormat::gnu),
              "a.toml: error: unknown key 'postion' in body 'upper' [unknown-key]\n");
}

TEST(Diagnostics, GnuFormIsOneLineEach)
{
    EXPECT_EQ(render({sample(2, 3, 7)}, "", DiagnosticFormat::gnu),
              "a.toml:2:3: error: unknown key 'postion' in body 'upper' [unknown-key]\n"
              "a.toml:2:3: note: a note\n"
              "a.toml:2:3: note: did you mean 'position'?\n");
}

TEST(Diagnostics, JsonFormHoldsEveryMember)
{
    Diagnostic warning = sample(2, 3, 7);
    warning.severity = Severity::warning;
    const std::string text = render({warning}, "", DiagnosticFormat::json);
    for (const char* part :
         {R"("severity": "warning")", R"("code": "unknown-key")", R"("line": 2)", R"("column": 3)",
          R"("length": 7)", R"("note": "a note")", R"("file": "a.toml")", R"("help": "did)"})
        EXPECT_NE(text.find(part), std::string::npos) << part << text;
    EXPECT_EQ(render({}, "", DiagnosticFormat::json), "[]\n");
}

TEST(Diagnostics, ColumnsCountCharactersAndUnderlinesMatchThem)
{
    // Two characters of two and three bytes stand before the place, one of four bytes in it.
    const std::string source = "\xc3\xbc\xe6\x97\xa5 k\xf0\x9f\x8c\x8d = 1";
    const std::string text = render({sample(1, 4, 2)}, source, DiagnosticFormat::human);
    EXPECT_NE(text.find("  |    ^^\n"), std::string::npos) << text;
}

TEST(Diagnostics, ControlCharactersNeverReachTheTerminal)
{
    Diagnostic d = sample(1, 2, 1);
    d.message = "a \x1b[31m \x07 \xc2\x9b \xe2\x80\xae \xff";
    d.file = "b\n\x1b.toml";
    d.help = "\x1b]0;title\x07";
    for (const DiagnosticFormat format :
         {DiagnosticFormat::human, DiagnosticFormat::gnu, DiagnosticFormat::json}) {
        const std::string text = render({d}, "a\x1b[2J\t\x7f\xff\xe2\x81\xa6", format);
        for (const char c : text) EXPECT_TRUE(static_cast<unsigned char>(c) >= 0x20 || c == '\n') << text;
        EXPECT_EQ(text.find('\x7f'), std::string::npos);
        EXPECT_EQ(text.find("\xe2\x80\xae"), std::string::npos) << "direction overrides hide code";
        EXPECT_EQ(text.find("\xc2\x9b"), std::string::npos) << "C1 is the short form of escape";
        EXPECT_EQ(text.find('\xff'), std::string::npos);
    }
}

TEST(Diagnostics, EscapedCharactersMoveTheUnderline)
{
    const std::string text = render({sample(1, 3, 1)}, "a\x1b!b", DiagnosticFormat::human);
    EXPECT_NE(text.find("1 | a\\x1b!b\n  |      ^\n"), std::string::npos) << text;
}

TEST(Diagnostics, LongLinesAreCutAroundThePlace)
{
    std::string source(5'000'000, 'x');
    source[4'000'000] = '!';
    const std::string text = render({sample(1, 4'000'001, 1)}, source, DiagnosticFormat::human);
    EXPECT_LT(text.size(), 1000u);
    const std::size_t mark = text.find('!'), caret = text.find('^');
    ASSERT_NE(mark, std::string::npos);
    ASSERT_NE(caret, std::string::npos);
    EXPECT_EQ(mark - text.rfind('\n', mark), caret - text.rfind('\n', caret)) << text;
}

TEST(Diagnostics, LinesAreNoWiderThanTheTerminal)
{
    const std::string line =
        "name = \"" + std::string(60, 'a') + "\", shapee = { box = [1, 1, 1] }, " + std::string(60, 'b');
    for (const int columns : {0, 40, 80, 120})
        for (const int at : {1, 8, 40, 71, 110, 160}) {
            const std::string text =
                render({sample(1, at, 6)}, line, DiagnosticFormat::human, false, columns);
            std::istringstream lines(text);
            std::string message, place, bar, excerpt, marks;
            for (std::string* one : {&message, &place, &bar, &excerpt, &marks}) std::getline(lines, *one);
            const std::size_t most = columns == 0 ? 132 : static_cast<std::size_t>(columns);
            EXPECT_LE(excerpt.size(), most) << text;
            EXPECT_LE(marks.size(), most) << text;
            if (at < 150) {
                EXPECT_EQ(excerpt.substr(marks.find('^'), 1), line.substr(at - 1, 1)) << text;
            }
        }
}

TEST(Diagnostics, PlacesBeyondTheTextAreHarmless)
{
    for (const auto& [line, column] : {std::pair(1, 100), std::pair(100, 1), std::pair(1, 1'000'000'000)})
        EXPECT_NE(render({sample(line, column, 5)}, "ab", DiagnosticFormat::human), "");
}

TEST(Diagnostics, ColoursOnlyOnRequest)
{
    EXPECT_EQ(render({sample(1, 1, 1)}, "a", DiagnosticFormat::human).find('\x1b'), std::string::npos);
    EXPECT_NE(render({sample(1, 1, 1)}, "a", DiagnosticFormat::human, true).find('\x1b'), std::string::npos);
}

TEST(Findings, ProposeTheNearestWordOnly)
{
    constexpr std::array<std::string_view, 4> words{"position", "quaternion", "mass", "density"};
    EXPECT_EQ(closest("postion", words), "position");
    EXPECT_EQ(closest("psoition", words), "position");
    EXPECT_EQ(closest("dnesity", words), "density");
    EXPECT_EQ(closest("masss", words), "mass");
    EXPECT_EQ(closest("colour", words), "");
    EXPECT_EQ(closest("", words), "");
    EXPECT_EQ(closest(std::string(1'000'000, 'p'), words), "");
}

TEST(Findings, ShowTwentyAndCountTheRest)
{
    Findings findings;
    findings.warning({1, 1, 1}, "format-first", "a warning");
    for (int i = 30; i > 0; --i) findings.error({i, 1, 1}, "unit", "e");
    const std::vector<Diagnostic> shown = findings.take("f");
    ASSERT_EQ(shown.size(), 20u);
    for (int i = 0; i < 20; ++i) {
        EXPECT_EQ(shown[static_cast<std::size_t>(i)].line, i + 1);
        EXPECT_EQ(shown[static_cast<std::size_t>(i)].severity, Severity::error)
            << "errors go before warnings";
    }
    EXPECT_EQ(shown.back().note, "11 more are not shown");
}

TEST(Codes, EachHasAPageAndTheyAscend)
{
    const std::vector<std::string_view> codes = diagnostic_codes();
    EXPECT_TRUE(std::is_sorted(codes.begin(), codes.end()));
    EXPECT_EQ(std::adjacent_find(codes.begin(), codes.end()), codes.end());
    for (const std::string_view code : codes) EXPECT_GT(explain(code).size(), 20u) << code;
    EXPECT_EQ(explain("no-such-code"), "");
    EXPECT_EQ(explain(""), "");
}

/// `explain` finds each page whole: together they are the file in docs, but for its introduction.
TEST(Codes, PagesInDocsAreTheseOnes)
{
    std::ifstream stream(std::string(LIVENS_SOURCE_DIR) + "/docs/diagnostics.md", std::ios::binary);
    const std::string file(std::istreambuf_iterator<char>(stream), {});
    std::string pages;
    for (const std::string_view code : diagnostic_codes())
        pages += "\n## " + std::string(code) + "\n\n" + std::string(explain(code)) + "\n";
    EXPECT_EQ(file.substr(file.find("\n## ")), pages);
}

/// The texts that follow `opening` directly, as in `InputError({"axis-zero"`.
std::vector<std::string> codes_behind(const std::string& source, const std::string& opening)
{
    std::vector<std::string> codes;
    for (std::size_t at = source.find(opening); at != std::string::npos; at = source.find(opening, at + 1)) {
        const std::size_t quote = source.find_first_not_of(" \n", at + opening.size());
        if (quote == std::string::npos || source[quote] != '"') continue;
        const std::size_t end = source.find('"', quote + 1);
        codes.push_back(source.substr(quote + 1, end - quote - 1));
    }
    return codes;
}

/// Whoever adds a code in the core adds its page.
TEST(Codes, EveryCodeInTheSourcesHasAPage)
{
    int n_codes = 0;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(std::string(LIVENS_SOURCE_DIR) + "/src")) {
        if (entry.path().extension() != ".cpp") continue;
        std::ifstream stream(entry.path(), std::ios::binary);
        const std::string source(std::istreambuf_iterator<char>(stream), {});
        for (const char* opening :
             {"InputError({", " refuse(", " complain(", " refuse_table(", "omplaint = {", "omplaint{"})
            for (const std::string& code : codes_behind(source, opening)) {
                const bool is_code = code.find_first_not_of("abcdefghijklmnopqrstuvwxyz-") ==
                                     std::string::npos;
                if (!is_code || code.empty()) continue;
                EXPECT_NE(explain(code), "") << code << " in " << entry.path();
                ++n_codes;
            }
    }
    for (const char* code : {"io-damaged", "io-foreign", "io-not-a-file", "io-truncated", "io-version"})
        EXPECT_NE(explain(code), "") << code;   // of IoError
    EXPECT_GT(n_codes, 40) << "codes are not found any more";
}

}   // namespace

}   // namespace livens::diagnostic_test
