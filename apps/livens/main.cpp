// SPDX-License-Identifier: BSD-3-Clause
// livens, the program: arguments in, a command's exit code out.
#include <algorithm>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "arguments.h"
#include "console.h"
#include "failure.h"
#include "interrupt.h"
#include "livens/base/version.h"
#include "terminal.h"

namespace livens::program {

namespace {

/// A standard stream that the caller closed would give its number to the next file that is opened.
void fill_standard_streams()
{
    for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(number, F_GETFD) == -1) {
            // The lowest free number is this one; read-only, so that writing still fails as it should.
            [[maybe_unused]] const int opened = ::open("/dev/null", O_RDONLY);
        }
}

/// Of glibc: what is large goes back to the system when it is freed. It would keep holes of any size once
/// arrays as large have come and gone, and what a run takes at most would depend on their order.
void return_large_memory()
{
#ifdef __GLIBC__
    constexpr int large = 1 << 20;   // bytes
    ::mallopt(M_MMAP_THRESHOLD, large);
#endif
}

void apply_layout(Arguments& a)
{
    a.common.diagnostics = a.layout == "json"  ? DiagnosticFormat::json
                           : a.layout == "gnu" ? DiagnosticFormat::gnu
                                               : DiagnosticFormat::human;
    set_colour(a.colour == "always"  ? Colour::always
               : a.colour == "never" ? Colour::never
                                     : Colour::automatic);
}

int run(const Arguments& a)
{
    const Common& common = a.common;
    set_verbosity(common.quiet ? Verbosity::quiet : common.verbose ? Verbosity::verbose : Verbosity::normal);
    return a.run ? a.run(common) : version_command(common);
}

/// Without parsing, which may have stopped early or not have begun.
bool asks_for_json(int n, char** arguments)
{
    const auto is_it = [](std::string_view argument) { return argument == "--json"; };
    return std::any_of(arguments, arguments + n, is_it);
}

/// What CLI11 objects to, or its help.
int parse_failed(const CLI::App& app, const CLI::ParseError& error, Common common, int n, char** arguments)
{
    if (error.get_exit_code() == 0)
        return guarded(common, [&] {
            const bool is_top = app.get_subcommands().empty();
            print(is_top ? app.help() : app.get_subcommands().front()->help("livens"));
            return static_cast<int>(exit_ok);
        });
    common.json |= asks_for_json(n, arguments);
    return guarded(common, [&]() -> int { throw failure(exit_usage, objection(app, error)); });
}

int parsed_main(int n, char** arguments)
{
    Arguments a;
    CLI::App app("livens " + std::string(version) +
                     ": rigid multibody dynamics with space-time finite elements",
                 "livens");
    declare(app, a);
    try {
        app.parse(n, arguments);
        apply_layout(a);
    } catch (const CLI::ParseError& error) {
        apply_layout(a);
        return parse_failed(app, error, a.common, n, arguments);
    }
    return guarded(a.common, [&]() -> int {
        if (app.get_subcommands().empty() && !a.is_version)
            throw failure(exit_usage, "a command is missing; 'livens --help' lists them");
        return run(a);
    });
}

}   // namespace

int main(int n, char** arguments)
{
    fill_standard_streams();
    return_large_memory();
    ignore_write_signals();
    Common common;
    common.json = asks_for_json(n, arguments);
    return guarded(common, [&] {
        keep_memory_for_report();
        return parsed_main(n, arguments);
    });
}

}   // namespace livens::program

int main(int n, char** arguments) { return livens::program::main(n, arguments); }
