// SPDX-License-Identifier: BSD-3-Clause
// livens man: the manual page, made from the table of commands.
#include "arguments.h"
#include "console.h"
#include "exit_code.h"
#include "livens/base/version.h"

namespace livens::program {

namespace {

/// Text for roff: no character of it is a request or an escape, and dashes are what is typed.
std::string roff(std::string_view text)
{
    std::string out;
    for (const char c : text) {
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else if (c == '\'')
            out += "\\(aq";
        else if (c == '.' && (out.empty() || out.ends_with('\n')))
            out += "\\&.";
        else
            out += c;
    }
    return out;
}

std::string bold(std::string_view text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(std::string_view text) { return "\\fI" + roff(text) + "\\fR"; }

std::string title_of(const OptionInfo& option)
{
    std::string title;
    for (const std::string& name : option.names) title += (title.empty() ? "" : ", ") + bold(name);
    if (option.value.empty()) return title;
    return title + (title.empty() ? "" : " ") + italic(option.value);
}

std::string option_entries(const CommandInfo& command)
{
    std::string text;
    for (const OptionInfo& option : command.options)
        text += ".TP\n" + title_of(option) + "\n" + roff(option.description) + "\n";
    return text;
}

/// `livens solve [options] FILE.toml`
std::string usage(const CommandInfo& command)
{
    std::string text = bold("livens " + command.name) + " [" + italic("options") + "]";
    for (const OptionInfo& option : command.options) {
        if (!option.names.empty() && !option.is_required) continue;
        const std::string what = title_of(option);
        text += option.is_required ? " " + what : " [" + what + "]";
    }
    return text;
}

constexpr const char* environment = R"(.SH ENVIRONMENT
.TP
\fBNO_COLOR\fR
If set and not empty, colours are off unless \fB\-\-color=always\fR is given.
.TP
\fBCOLUMNS\fR
Width to which lines are wrapped, instead of the width of the terminal.
.TP
\fBLIVENS_SIMD\fR
Instruction set to solve with, \fBsse2\fR, \fBavx2\fR or \fBavx512\fR, unless \fB\-\-simd\fR is given.
The same set gives the same bytes.
.TP
\fBLC_ALL\fR, \fBLC_CTYPE\fR, \fBLANG\fR
Non\-ASCII signs are used on terminals if the first non\-empty one of these names UTF\-8. Nothing else
depends on the locale.
.SH EXAMPLES
.nf
livens init
livens solve pendulum.toml
livens sample pendulum.nc \-\-body rod \-\-at 2.5 \-\-json
livens export pendulum.nc \-\-csv pendulum.csv
.fi
)";

}   // namespace

int man_command(const std::vector<CommandInfo>& commands)
{
    std::string text = ".TH LIVENS 1 \"\" \"livens " + roff(version) + "\" \"User Commands\"\n" +
                       ".SH NAME\nlivens \\- rigid multibody dynamics with space\\-time finite elements\n.SH "
                       "SYNOPSIS\n.nf\n";
    for (const CommandInfo& command : commands)
        if (!command.name.empty()) text += usage(command) + "\n";
    text +=
        ".fi\n.SH DESCRIPTION\nComputes the motion of rigid bodies connected by joints, as described in a "
        "scenario file,\nand writes it "
        "to a result file. Data goes to standard output, everything else to standard error.\n.SH OPTIONS\n";
    text += option_entries(commands.front()) + ".SH COMMANDS\n";
    for (const CommandInfo& command : commands)
        if (!command.name.empty())
            text +=
                ".SS " + usage(command) + "\n" + roff(command.description) + ".\n" + option_entries(command);
    text += ".SH EXIT STATUS\n";
    for (const ExitMeaning& e : exit_meanings) text += ".TP\n" + bold(e.code) + "\n" + roff(e.meaning) + "\n";
    print(text + environment);
    return exit_ok;
}

}   // namespace livens::program
