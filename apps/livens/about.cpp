// SPDX-License-Identifier: BSD-3-Clause
// What the program knows about itself: schema, explanations, version.
#include <algorithm>

#include <unistd.h>

#include "arguments.h"
#include "console.h"
#include "failure.h"
#include "livens/base/version.h"
#include "livens/io/results.h"
#include "terminal.h"

namespace livens::program {

namespace {

std::string with_end(std::string text)
{
    if (!text.ends_with('\n')) text += '\n';
    return text;
}

constexpr int widest_prose = 100;

/// A page in Markdown for reading: paragraphs wrapped, examples set in, their labels in colour.
std::string laid_out(std::string_view page, const Terminal& terminal)
{
    const int columns = terminal.columns > 0 ? std::min(terminal.columns, widest_prose) : widest_prose;
    std::string out, paragraph;
    const auto end_paragraph = [&] {
        if (paragraph == "Wrong:" || paragraph == "Right:")
            out += painted(terminal, paragraph == "Wrong:" ? Ink::bad : Ink::good, paragraph) + "\n";
        else if (!paragraph.empty())
            out += wrapped(paragraph, columns, 0, 0) + "\n";
        paragraph.clear();
    };
    bool is_example = false;
    while (!page.empty()) {
        const std::string_view line = page.substr(0, page.find('\n'));
        page.remove_prefix(std::min(line.size() + 1, page.size()));
        if (line.starts_with("```")) {
            is_example = !is_example;
        } else if (is_example) {
            out += line.empty() ? "\n" : "    " + std::string(line) + "\n";
        } else if (line.empty()) {
            end_paragraph();
            out += '\n';
        } else {
            paragraph += (paragraph.empty() ? "" : " ") + std::string(line);
        }
    }
    end_paragraph();
    return out;
}

}   // namespace

int schema_command(bool markdown, const std::string& type)
{
    if (!type.empty()) {
        const std::string keys = schema_markdown(type), proposal = nearest(type, schema_types());
        if (keys.empty())
            throw failure(exit_usage,
                          "there is no type '" + type + "'" +
                              (proposal.empty() ? ", types are joint.revolute, load.force and so on"
                                                : "; did you mean '" + proposal + "'?"));
        print(keys);
        return exit_ok;
    }
    print(with_end(markdown ? schema_markdown() : schema_json()));
    return exit_ok;
}

int explain_command(const std::string& code)
{
    const std::vector<std::string_view> known = diagnostic_codes();
    if (code.empty()) {
        std::string text;
        for (const std::string_view one : known) text += std::string(one) + "\n";
        print(text);
        return exit_ok;
    }
    const std::string_view page = explain(code);
    if (page.empty()) {
        const std::string proposal = nearest(code, {known.begin(), known.end()});
        throw failure(exit_usage, "there is no code '" + code + "'; " +
                                      (proposal.empty() ? "'livens explain' alone lists all"
                                                        : "did you mean '" + proposal + "'?"));
    }
    const std::string where =
        "\nIn the sources: docs/diagnostics.md#" + code + "\n\nOn the site: diagnostics/" + code + ".html\n";
    print(laid_out(with_end(std::string(page)) + where, terminal_of(STDOUT_FILENO)));
    return exit_ok;
}

int version_command(const Common& common)
{
    if (!common.json) {
        print(std::string("livens ") + version + "\n");
        return exit_ok;
    }
    JsonWriter json(2);
    json.begin_object().member("version", version);
    json.member("format", format_major).member("format_minor", format_minor).end_object();
    print(json.text() + "\n");
    return exit_ok;
}

}   // namespace livens::program
