// SPDX-License-Identifier: BSD-3-Clause
// What is wrong with a command line, and what was probably meant.
#include <algorithm>
#include <utility>

#include <CLI/CLI.hpp>

#include "arguments.h"

namespace livens::program {

namespace {

/// Damerau's distance in its restricted form: no letter is touched twice.
std::size_t distance(std::string_view a, std::string_view b)
{
    std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i)
        for (std::size_t j = 0; j <= b.size(); ++j) {
            if (i == 0 || j == 0) {
                d[i][j] = i + j;
                continue;
            }
            const std::size_t change = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            d[i][j] = std::min({change, d[i - 1][j] + 1, d[i][j - 1] + 1});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
        }
    return d[a.size()][b.size()];
}

bool is_option(const std::string& word) { return word.size() > 1 && word.front() == '-'; }

std::string meant(const std::string& word, const std::vector<std::string>& known)
{
    const std::string proposal = nearest(word, known);
    return proposal.empty() ? "" : "; did you mean '" + proposal + "'?";
}

const CommandInfo& info_of(const std::vector<CommandInfo>& commands, const std::string& name)
{
    const auto found = std::ranges::find(commands, name, &CommandInfo::name);
    return found == commands.end() ? commands.front() : *found;
}

std::vector<std::string> options_of(const CommandInfo& command)
{
    std::vector<std::string> names;
    for (const OptionInfo& option : command.options)
        names.insert(names.end(), option.names.begin(), option.names.end());
    return names;
}

/// `--name=value` without its value.
std::string name_in(const std::string& word) { return word.substr(0, word.find('=')); }

std::string unknown_option(const CommandInfo& command, const std::string& word)
{
    const std::string name = name_in(word);
    const std::string full = command.name.empty() ? "livens" : "livens " + command.name;
    const std::string proposal = meant(name, options_of(command));
    return "'" + full + "' has no option '" + name + "'" +
           (proposal.empty() ? "; '" + full + " --help' lists them" : proposal);
}

/// Words before the command, or instead of it.
std::string stray_word(const std::vector<CommandInfo>& commands, const std::string& word,
                       const std::string& command)
{
    if (is_option(word) && !command.empty()) {
        const std::vector<std::string> known = options_of(info_of(commands, command));
        if (std::ranges::find(known, name_in(word)) != known.end())
            return "the option '" + name_in(word) + "' follows the command '" + command + "'";
    }
    if (is_option(word)) return unknown_option(commands.front(), word);
    std::vector<std::string> names;
    for (const CommandInfo& c : commands)
        if (!c.name.empty()) names.push_back(c.name);
    const std::string proposal = meant(word, names);
    return "no command '" + word + "'" + (proposal.empty() ? "; 'livens --help' lists them" : proposal);
}

}   // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& known)
{
    std::pair<std::size_t, std::string> best{std::max<std::size_t>(1, word.size() / 3) + 1, ""};
    if (word.size() > 100) return "";
    for (const std::string& other : known) {
        const std::size_t d = distance(word, other);
        if (d < best.first && d < other.size()) best = {d, other};
    }
    return best.second;
}

std::string objection(const CLI::App& app, const CLI::ParseError& error)
{
    const std::vector<CommandInfo> commands = command_table(app);
    const std::vector<CLI::App*> parsed = app.get_subcommands();
    const std::string command = parsed.empty() ? "" : parsed.front()->get_name();
    // Words that no option or argument has taken; an option that is misspelled leaves its value there too.
    const std::vector<std::string> strays = app.remaining();
    if (!strays.empty()) {
        const auto first = command.empty() ? strays.begin() : std::ranges::find_if(strays, is_option);
        return stray_word(commands, first == strays.end() ? strays.front() : *first, command);
    }
    const std::string help = "; 'livens" + (command.empty() ? "" : " " + command) + " --help' explains more";
    if (command.empty()) return error.what() + help;
    const std::vector<std::string> unknown = parsed.front()->remaining();
    if (unknown.empty()) return error.what() + help;
    const auto option = std::ranges::find_if(unknown, is_option);
    if (option != unknown.end()) return unknown_option(info_of(commands, command), *option);
    return "'livens " + command + "' cannot use '" + unknown.front() + "'" + help;
}

}   // namespace livens::program
