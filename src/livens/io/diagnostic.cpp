// SPDX-License-Identifier: BSD-3-Clause
// Messages about a scenario as people, editors and programs read them: with an excerpt of the line, as GNU
// tools print them, or as JSON (docs/program.md). Nothing of a file reaches a terminal unseen: what is
// invisible is written out.
#include "livens/io/diagnostic.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>

#include "livens/io/json.h"
#include "livens/io/scenario/text/findings.h"

namespace livens {

namespace {

constexpr int widest_line = 120;     // characters shown of a line; longer ones are cut around the place
constexpr int narrowest_line = 20;   // likewise, on any terminal
constexpr int marks = 8;             // "... " before and " ..." behind what is cut

bool is_control(std::uint32_t code) { return code < 0x20 || (code >= 0x7f && code < 0xa0); }

/// One character of a text, made visible: what is_invisible() and bytes that are not UTF-8 are written out.
std::string visible(std::string_view character)
{
    static constexpr char digits[] = "0123456789abcdef";
    if (character == "\t") return " ";
    const std::uint32_t code = code_point(character);
    const bool is_odd_byte = code == 0xfffd && character.size() == 1;
    if (!is_invisible(code) && !is_odd_byte) return std::string(character);
    std::string text;
    for (const char c : character) {
        const unsigned char byte = static_cast<unsigned char>(c);
        text += {'\\', 'x', digits[byte >> 4], digits[byte & 15]};
    }
    return text;
}

std::size_t character_length(std::string_view text)
{
    return static_cast<std::size_t>(
        std::max(1, utf8_length(text)));   // a byte that is not UTF-8 counts as one
}

std::string escaped(std::string_view text)
{
    std::string all;
    for (; !text.empty(); text.remove_prefix(character_length(text)))
        all += visible(text.substr(0, character_length(text)));
    return all;
}

/// Width of visible text, one column for each code point.
int width(std::string_view text)
{
    return static_cast<int>(std::count_if(
        text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

/// At most `widest` characters of a line around the columns in question, and the underline below.
struct Excerpt {
    std::string text;
    std::string underline;
};

/// Columns count characters, from 1. A line that fits with what would mark a cut is shown whole.
Excerpt excerpt(std::string_view line, int column, int length, int widest)
{
    const bool fits = width(line) <= widest + marks && column <= widest + marks;
    const int lead = widest / 3;   // characters before the place, of a line that is cut
    if (fits) widest += marks;
    int first = 1;   // column of the first character shown
    Excerpt e;
    if (!fits && column > widest - lead) {
        std::string_view rest = line;
        int position = 1;
        for (; position < column - lead && !rest.empty(); ++position)
            rest.remove_prefix(character_length(rest));
        if (position > 1) {
            line = rest;
            first = position;
            e.text = "... ";
        }
    }
    int at = first;
    for (; at < first + widest && !line.empty(); ++at) {
        const std::string shown = visible(line.substr(0, character_length(line)));
        if (at == column) e.underline.assign(static_cast<std::size_t>(width(e.text)), ' ');
        if (at >= column && at - column < length)
            e.underline.append(static_cast<std::size_t>(width(shown)), '^');
        e.text += shown;
        line.remove_prefix(character_length(line));
    }
    // What is missing is said to be behind the end of the line: one mark stands there.
    if (column >= at) e.underline.assign(static_cast<std::size_t>(width(e.text)), ' ').append("^");
    if (!line.empty()) e.text += " ...";
    return e;
}

struct Colours {
    const char* error = "";
    const char* warning = "";
    const char* frame = "";
    const char* strong = "";
    const char* plain = "";
};
constexpr Colours ansi{"\x1b[1;31m", "\x1b[1;33m", "\x1b[1;34m", "\x1b[1m", "\x1b[0m"};

const char* name(Severity severity) { return severity == Severity::error ? "error" : "warning"; }

std::string place(const Diagnostic& d, std::string_view separator)
{
    std::string text = escaped(d.file);
    if (d.line <= 0) return text;
    text += separator;
    text += std::to_string(d.line);
    text += separator;
    return text + std::to_string(d.column);
}

std::string render_human(const Diagnostic& d, std::string_view source, const Colours& c, int columns)
{
    const std::string number = d.line > 0 ? std::to_string(d.line) : "";
    const std::string margin(number.size(), ' ');
    const std::string bar = c.frame + margin + " |" + c.plain;
    std::string out = d.severity == Severity::error ? c.error : c.warning;
    out += std::string(name(d.severity)) + "[" + d.code + "]" + c.plain + c.strong + ": " +
           escaped(d.message) + c.plain;
    out += "\n" + margin + c.frame + "--> " + c.plain + place(d, ":") + "\n";
    if (d.line > 0) {
        const int gutter = static_cast<int>(number.size()) + 3;
        const int room =
            columns > 0 ? std::clamp(columns - gutter - marks, narrowest_line, widest_line) : widest_line;
        const Excerpt e =
            excerpt(d.source_line.empty() ? find_line(source, d.line) : std::string_view(d.source_line),
                    d.column, d.length, room);
        out += bar + "\n" + c.frame + number + " |" + c.plain + (e.text.empty() ? "" : " ") + e.text + "\n";
        out +=
            bar + " " + (d.severity == Severity::error ? c.error : c.warning) + e.underline + c.plain + "\n";
    }
    const auto say = [&](const char* kind, const std::string& text) {
        if (!text.empty())
            out +=
                margin + c.frame + " = " + c.plain + c.strong + kind + c.plain + ": " + escaped(text) + "\n";
    };
    say("note", d.note);
    say("help", d.help);
    return out;
}

std::string render_gnu(const Diagnostic& d)
{
    std::string out =
        place(d, ":") + ": " + name(d.severity) + ": " + escaped(d.message) + " [" + d.code + "]\n";
    const std::string at = place(d, ":") + ": note: ";
    if (!d.note.empty()) out += at + escaped(d.note) + "\n";
    if (!d.help.empty()) out += at + escaped(d.help) + "\n";
    return out;
}

std::string render_json(const std::vector<Diagnostic>& diagnostics)
{
    JsonWriter json(2);
    json.begin_array();
    for (const Diagnostic& d : diagnostics) {
        json.begin_object()
            .member("severity", name(d.severity))
            .member("code", d.code)
            .member("message", escaped(d.message));
        json.member("file", d.file)
            .member("line", d.line)
            .member("column", d.column)
            .member("length", d.length);
        json.member("note", escaped(d.note)).member("help", escaped(d.help)).end_object();
    }
    return json.end_array().text() + "\n";
}

}   // namespace

std::string io_internal::first_invisible(std::string_view text)
{
    for (; !text.empty(); text.remove_prefix(character_length(text))) {
        const std::uint32_t code = code_point(text.substr(0, character_length(text)));
        if (!is_invisible(code)) continue;
        char name[16];
        std::snprintf(name, sizeof name, "U+%04X", code);
        return std::string(is_control(code) ? "control characters"
                                            : "invisible marks, as of writing direction") +
               ", here " + name;
    }
    return {};
}

std::string render(const std::vector<Diagnostic>& diagnostics, std::string_view source,
                   DiagnosticFormat format, bool colour, int columns)
{
    if (format == DiagnosticFormat::json) return render_json(diagnostics);
    std::string out;
    for (const Diagnostic& d : diagnostics) {
        if (format == DiagnosticFormat::gnu) {
            out += render_gnu(d);
            continue;
        }
        if (!out.empty()) out += "\n";
        out += render_human(d, source, colour ? ansi : Colours{}, columns);
    }
    return out;
}

}   // namespace livens
