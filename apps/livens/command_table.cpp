// SPDX-License-Identifier: BSD-3-Clause
// Commands and options as tables, for shell completion and the manual page.
#include <CLI/CLI.hpp>

#include "arguments.h"

namespace livens::program {

namespace {

std::vector<OptionInfo> options_of(const CLI::App& app)
{
    std::vector<OptionInfo> options;
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_group().empty()) continue;   // hidden
        OptionInfo info;
        for (const std::string& name : option->get_snames()) info.names.push_back("-" + name);
        for (const std::string& name : option->get_lnames()) info.names.push_back("--" + name);
        if (option->get_items_expected_max() > 0) info.value = option->get_type_name();
        info.description = option->get_description();
        info.is_required = option->get_required();
        options.push_back(info);
    }
    return options;
}

}   // namespace

std::vector<CommandInfo> command_table(const CLI::App& app)
{
    std::vector<CommandInfo> commands{{"", app.get_description(), options_of(app)}};
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        commands.push_back({command->get_name(), command->get_description(), options_of(*command)});
    return commands;
}

}   // namespace livens::program
