// SPDX-License-Identifier: BSD-3-Clause
#include "terminal.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>

#include <sys/ioctl.h>
#include <unistd.h>

namespace livens::program {

namespace {

Colour chosen = Colour::automatic;

std::string_view variable(const char* name)
{
    const char* value = std::getenv(name);
    return value == nullptr ? std::string_view() : std::string_view(value);
}

/// The first of these that is not empty decides, as setlocale() would have it. [POSIX, 8.2]
bool is_utf8_locale()
{
    for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
        std::string value(variable(name));
        if (value.empty()) continue;
        for (char& c : value) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        return value.find("utf-8") != std::string::npos || value.find("utf8") != std::string::npos;
    }
    return false;
}

/// 0 where none is set.
int columns_wished()
{
    const std::string_view text = variable("COLUMNS");
    int columns = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), columns);
    return error == std::errc() && end == text.data() + text.size() && columns > 0 ? columns : 0;
}

int columns_of(int descriptor)
{
    winsize size{};
    if (::ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
    return 80;
}

const char* escape(Ink ink)
{
    switch (ink) {
    case Ink::good:
        return "\x1b[1;32m";
    case Ink::doubtful:
        return "\x1b[1;33m";
    case Ink::bad:
        return "\x1b[1;31m";
    case Ink::dim:
        return "\x1b[2m";
    case Ink::strong:
        break;
    }
    return "\x1b[1m";
}

}   // namespace

void set_colour(Colour colour) { chosen = colour; }

Terminal terminal_of(int descriptor)
{
    const bool is_terminal = ::isatty(descriptor) == 1;
    Terminal t;
    t.colour = chosen == Colour::always || (chosen == Colour::automatic && is_terminal &&
                                            variable("NO_COLOR").empty() && variable("TERM") != "dumb");
    t.signs = (is_terminal || chosen == Colour::always) && is_utf8_locale();
    t.columns = columns_wished();
    if (t.columns == 0 && is_terminal) t.columns = columns_of(descriptor);
    return t;
}

std::string painted(const Terminal& terminal, Ink ink, std::string_view text)
{
    if (!terminal.colour) return std::string(text);
    return escape(ink) + std::string(text) + "\x1b[0m";
}

int width_of(std::string_view text)
{
    return static_cast<int>(
        std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

std::string wrapped(std::string_view text, int columns, int indent, int used)
{
    std::string out;
    bool is_first = true;   // of its line
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(' '), text.size());
        const std::string_view word = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        const int width = width_of(word);
        if (!is_first && columns > 0 && used + 1 + width > columns) {
            out += "\n" + std::string(static_cast<std::size_t>(indent), ' ');
            used = indent;
            is_first = true;
        }
        if (!is_first) {
            out += ' ';
            ++used;
        }
        out += word;
        used += width;
        is_first = false;
    }
    return out;
}

}   // namespace livens::program
