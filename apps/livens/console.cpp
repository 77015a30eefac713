// SPDX-License-Identifier: BSD-3-Clause
#include "console.h"

#include <cerrno>
#include <system_error>

#include <unistd.h>

#include "livens/io/json.h"
#include "terminal.h"

namespace livens::program {

namespace {

Verbosity verbosity_now = Verbosity::normal;

void write_all(int descriptor, std::string_view text)
{
    while (!text.empty()) {
        const ssize_t n = ::write(descriptor, text.data(), text.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0)
            throw OutputError{"cannot write to standard output: " + std::generic_category().message(errno)};
        text.remove_prefix(static_cast<std::size_t>(n));
    }
}

/// One write a line, so that lines of several programs on one terminal stay whole.
void say(Ink ink, const char* kind, std::string_view message)
{
    say_raw("livens: " + painted(terminal_of(STDERR_FILENO), ink, kind) + ": " + plain(message) + "\n");
}

}   // namespace

void print(std::string_view text) { write_all(STDOUT_FILENO, text); }

void set_verbosity(Verbosity verbosity) { verbosity_now = verbosity; }

void say_error(std::string_view message) { say(Ink::bad, "error", message); }
void say_warning(std::string_view message) { say(Ink::doubtful, "warning", message); }
void say_note(std::string_view message)
{
    if (verbosity_now != Verbosity::quiet) say(Ink::good, "info", message);
}
void say_detail(std::string_view message)
{
    if (verbosity_now == Verbosity::verbose) say(Ink::dim, "debug", message);
}

void say_raw(std::string_view text)
{
    try {
        write_all(STDERR_FILENO, text);
    } catch (const OutputError&) {
        // Nowhere is left to complain.
    }
}

bool error_is_terminal() { return ::isatty(STDERR_FILENO) == 1; }
bool output_is_terminal() { return ::isatty(STDOUT_FILENO) == 1; }

std::string plain(std::string_view text)
{
    std::string out;
    while (!text.empty()) {
        const int length = utf8_length(text);
        const char c = text.front();
        if (length == 0 || is_invisible(code_point(text)))
            out += c == '\n' || c == '\t' ? ' ' : '?';
        else
            out.append(text.substr(0, static_cast<std::size_t>(length)));
        text.remove_prefix(length == 0 ? 1 : static_cast<std::size_t>(length));
    }
    return out;
}

}   // namespace livens::program
