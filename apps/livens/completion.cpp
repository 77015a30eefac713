// SPDX-License-Identifier: BSD-3-Clause
// livens completion: scripts for shells, made from the table of commands.
#include "arguments.h"
#include "console.h"
#include "failure.h"
#include "livens/io/results.h"
#include "sample_query.h"

namespace livens::program {

namespace {

using Table = std::vector<CommandInfo>;

std::string replaced(std::string text, std::string_view from, std::string_view to)
{
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
    return text;
}

/// Between single quotes of any of the three shells; in fish a backslash is special there.
std::string in_quotes(const std::string& text, bool is_fish = false)
{
    if (is_fish) return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'";
    return "'" + replaced(text, "'", "'\\''") + "'";
}

bool is_choice(const OptionInfo& option) { return option.value.find('|') != std::string::npos; }
std::string choices(const OptionInfo& option) { return replaced(option.value, "|", " "); }

/// The ending of files that are meant, with its dot; "*" for any file, empty for what is no file.
std::string ending(const OptionInfo& option)
{
    const std::size_t dot = option.value.find('.');
    if (dot != std::string::npos) return option.value.substr(dot);
    return option.value == "FILE" ? "*" : "";
}

// --- bash

/// What follows an option, or stands at an argument's place; empty: nothing is known.
std::string bash_value(const OptionInfo& option)
{
    if (is_choice(option)) return "_livens_words " + choices(option);
    const std::string end = ending(option);
    if (!end.empty()) return end == "*" ? "_livens_files '*'" : "_livens_files '*" + end + "'";
    if (option.value == "BODY") return "_livens_names bodies";
    if (option.value == "JOINT") return "_livens_names joints";
    if (option.value == "SENSOR") return "_livens_names sensors";
    if (option.value == "CODE") return "_livens_words $(\"$program\" explain 2> /dev/null)";
    return "";
}

constexpr const char* bash_begin =
    R"bash(# bash completion of livens. Try it: source <(livens completion bash)
_livens_words() {
    local word
    for word in "$@"; do [[ $word == "$cur"* ]] && COMPREPLY+=("$word"); done
}
_livens_files() {
    compopt -o filenames 2> /dev/null
    mapfile -t COMPREPLY < <(compgen -d -- "$cur"; compgen -f -X "!$1" -- "$cur")
}
_livens_names() {   # names of the run on the line; names may hold spaces
    local name
    while IFS= read -r name; do
        [[ $name == "$cur"* ]] && COMPREPLY+=("$(printf %q "$name")")
    done < <("$program" completion "--$1" "$run" 2> /dev/null)
}
_livens() {
    local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]} command= run= i
    local program=${COMP_WORDS[0]/#\~/$HOME}
    COMPREPLY=()
    if [[ $cur == = ]]; then   # --option=value arrives as three words
        cur=
    elif [[ $prev == = ]]; then
        prev=${COMP_WORDS[COMP_CWORD - 2]}
    fi
    for ((i = 1; i < COMP_CWORD; ++i)); do
        case ${COMP_WORDS[i]} in
        *.nc) run=${run:-${COMP_WORDS[i]}} ;;
        @COMMANDS@) command=${command:-${COMP_WORDS[i]}} ;;
        esac
    done
    case "$command $prev" in
)bash";

std::string bash(const Table& table)
{
    std::string names, after, dashes, places;
    for (const CommandInfo& command : table) {
        if (!command.name.empty()) names += (names.empty() ? "" : " ") + command.name;
        std::string options, place;
        for (const OptionInfo& option : command.options) {
            if (option.names.empty() && place.empty()) place = bash_value(option);
            std::string patterns;
            for (const std::string& name : option.names) {
                options += " " + name;
                patterns += (patterns.empty() ? "'" : " | '") + command.name + " " + name + "'";
            }
            if (option.names.empty() || option.value.empty()) continue;
            const std::string value = bash_value(option);
            after += "    " + patterns + ") " + (value.empty() ? "" : value + "; ") + "return ;;\n";
        }
        const std::string label = "        " + (command.name.empty() ? "''" : command.name) + ") ";
        dashes += label + "_livens_words" + options + " ;;\n";
        if (!place.empty()) places += label.substr(4) + place + " ;;\n";
    }
    return replaced(bash_begin, "@COMMANDS@", replaced(names, " ", " | ")) + after +
           "    esac\n    if [[ $cur == -* ]]; then\n        case $command in\n" + dashes +
           "        esac\n        return\n    fi\n    case $command in\n    '') _livens_words " + names +
           " ;;\n" + places + "    esac\n}\ncomplete -F _livens livens\n";
}

// --- zsh

/// A blank before a call keeps _arguments from adding words of its own.
std::string zsh_action(const OptionInfo& option)
{
    if (is_choice(option)) return "(" + choices(option) + ")";
    const std::string end = ending(option);
    if (!end.empty()) return end == "*" ? "_files" : "_files -g \"*" + end + "\"";
    if (option.value == "BODY") return " _livens_names bodies";
    if (option.value == "JOINT") return " _livens_names joints";
    if (option.value == "SENSOR") return " _livens_names sensors";
    if (option.value == "CODE") return " _livens_codes";
    return " ";
}

std::string zsh_specification(const OptionInfo& option)
{
    const std::string text = replaced(replaced(option.description, "[", "\\["), "]", "\\]");
    const std::string value =
        option.value.empty() ? "" : ":" + replaced(option.value, ":", "\\:") + ":" + zsh_action(option);
    if (option.names.empty()) return in_quotes(value);
    if (option.names.size() == 1) return in_quotes(option.names[0] + "[" + text + "]" + value);
    return in_quotes("(" + option.names[0] + " " + option.names[1] + ")") + "{" + option.names[0] + "," +
           option.names[1] + "}" + in_quotes("[" + text + "]" + value);
}

constexpr const char* zsh_begin = R"zsh(#compdef livens
# zsh completion of livens: as _livens in a folder of $fpath, or source <(livens completion zsh)
_livens_names() {   # names of the run on the line
    local run=${words[(r)*.nc]}
    local -a names
    [[ -n $run ]] && names=("${(@f)$($livens completion --$1 $run 2> /dev/null)}")
    compadd -a names
}
_livens_codes() {
    local -a codes
    codes=("${(@f)$($livens explain 2> /dev/null)}")
    compadd -a codes
}
_livens() {
    local curcontext=$curcontext state line livens=$words[1]
    local -a commands
    commands=(
)zsh";

std::string zsh(const Table& table)
{
    std::string names, top, cases;
    for (const CommandInfo& command : table) {
        std::string options;
        for (const OptionInfo& option : command.options)
            options += " \\\n            " + zsh_specification(option);
        if (command.name.empty()) {
            top = options;
            continue;
        }
        names += "        " + in_quotes(command.name + ":" + command.description) + "\n";
        cases += "        " + command.name + ") _arguments" + options + " ;;\n";
    }
    return zsh_begin + names + "    )\n    _arguments -C" + replaced(top, "            ", "        ") +
           " \\\n        '1: :->command' '*:: :->rest' && return\n    case $state in\n"
           "    command) _describe command commands ;;\n    rest)\n        case $words[1] in\n" +
           cases +
           "        esac ;;\n    esac\n}\n"
           "if [[ $funcstack[1] == _livens ]]; then _livens \"$@\"; else compdef _livens livens; "
           "fi\n";
}

// --- fish

std::string fish_value(const OptionInfo& option)
{
    if (is_choice(option)) return " -x -a " + in_quotes(choices(option), true);
    const std::string end = ending(option);
    if (end == "*") return " -r -F";
    if (!end.empty()) return " -x -a '(__fish_complete_suffix " + end + ")'";
    if (option.value == "BODY") return " -x -a '(__livens_names bodies)'";
    if (option.value == "JOINT") return " -x -a '(__livens_names joints)'";
    if (option.value == "SENSOR") return " -x -a '(__livens_names sensors)'";
    if (option.value == "CODE") return " -x -a '(livens explain)'";
    return " -x";
}

std::string fish_option(const OptionInfo& option, const std::string& condition)
{
    std::string line = "complete -c livens -n " + in_quotes(condition, true);
    for (const std::string& name : option.names)
        line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (!option.value.empty()) line += fish_value(option);
    if (option.names.empty()) line = replaced(line, " -x -a", " -a");   // an argument by its place
    if (!option.names.empty()) line += " -d " + in_quotes(option.description, true);
    return line + "\n";
}

constexpr const char* fish_begin = R"fish(# fish completion of livens: livens completion fish | source
function __livens_names   # names of the run on the line
    for word in (commandline -opc)
        if string match -q -- '*.nc' $word
            livens completion --$argv[1] $word 2> /dev/null
            return
        end
    end
end
complete -c livens -f
)fish";

std::string fish(const Table& table)
{
    std::string text = fish_begin;
    for (const CommandInfo& command : table) {
        const bool is_top = command.name.empty();
        if (!is_top)
            text += "complete -c livens -n __fish_use_subcommand -a " + command.name + " -d " +
                    in_quotes(command.description, true) + "\n";
        const std::string condition =
            is_top ? "__fish_use_subcommand" : "__fish_seen_subcommand_from " + command.name;
        for (const OptionInfo& option : command.options)
            if (!option.names.empty() || option.value != "NAME") text += fish_option(option, condition);
    }
    return text;
}

/// Names that a line cannot hold are left out.
int print_names(const std::vector<std::string>& names)
{
    std::string text;
    for (const std::string& name : names)
        if (plain(name) == name) text += name + "\n";
    print(text);
    return exit_ok;
}

}   // namespace

int completion_command(const CompletionArguments& arguments, const std::vector<CommandInfo>& commands)
{
    if (!arguments.bodies.empty()) return print_names(read_run(arguments.bodies).told_bodies());
    if (!arguments.joints.empty()) return print_names(read_run(arguments.joints).joint_names);
    if (!arguments.sensors.empty()) {
        const Scenario scenario = scenario_of_run(read_run(arguments.sensors), arguments.sensors);
        const Model model = with_all_readings(scenario.model);
        std::vector<std::string> names;
        for (const Sensor& sensor : model.sensors()) names.push_back(sensor.name);
        return print_names(names);
    }
    if (arguments.shell.empty())
        throw failure(exit_usage, "a shell is missing: livens completion bash, zsh or fish");
    const std::string& shell = arguments.shell;
    print(shell == "bash" ? bash(commands) : shell == "zsh" ? zsh(commands) : fish(commands));
    return exit_ok;
}

}   // namespace livens::program
