// SPDX-License-Identifier: BSD-3-Clause
// The command line: what can be typed, what was typed, and the same as a table for help, completion and the
// man page.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "commands.h"

namespace CLI {
class App;
class ParseError;
}   // namespace CLI

namespace livens::program {

/// What stands beside the arguments of a command itself, and the command.
struct Arguments {
    Common common;
    std::string layout = "human";   ///< of diagnostics
    std::string colour = "auto";
    bool is_version = false;
    std::function<int(const Common&)> run;   ///< the command that was typed; empty: none
};

/// Adds all commands, each with its arguments and what runs it.
void declare(CLI::App& app, Arguments& arguments);

/// One argument or option. `value` is a word for what it takes, and what completion goes by: "FILE.toml" and
/// "RUN.nc" are files that end so, "FILE" any file, BODY and JOINT names in the run, CODE a diagnostic code,
/// "a|b" one of these words, all else free.
struct OptionInfo {
    std::vector<std::string> names;   ///< with dashes; empty: by place
    std::string value;                ///< empty: a flag
    std::string description;
    bool is_required = false;
};
struct CommandInfo {
    std::string name;   ///< the first one's is empty: the program itself
    std::string description;
    std::vector<OptionInfo> options;
};
std::vector<CommandInfo> command_table(const CLI::App& app);

/// One sentence on what CLI11 objects to, with the nearest thing that could have been meant.
std::string objection(const CLI::App& app, const CLI::ParseError& error);

/// The nearest of `known` (Damerau's distance: letters wrong, missing, too many, swapped), if it is within a
/// third of the length; else empty.
std::string nearest(std::string_view word, const std::vector<std::string>& known);

}   // namespace livens::program
