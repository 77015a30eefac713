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
If it is set and not empty, there are no colours unless \fB\-\-color=always\fR asks for them.
.TP
\fBCOLUMNS\fR
Width that lines are wrapped to, instead of the terminal\(aqs own.
.TP
\fBLIVENS_SIMD\fR
Instructions to solve with, \fBsse2\fR, \fBavx2\fR or \fBavx512\fR, where \fB\-\-simd\fR does not say.
Equal sets give equal bytes.
.TP
\fBLC_ALL\fR, \fBLC_CTYPE\fR, \fBLANG\fR
Signs beyond ASCII are shown on terminals if the first of these that is not empty names UTF\-8. Nothing else
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
    std::string text =
        ".TH LIVENS 1 \"\" \"livens " + roff(version) + "\" \"User Commands\"\n" +
        ".SH NAME\nlivens \\- rigid multibody dynamics with elements in time\n.SH SYNOPSIS\n.nf\n";
    for (const CommandInfo& command : commands)
        if (!command.name.empty()) text += usage(command) + "\n";
    text +=
        ".fi\n.SH DESCRIPTION\nComputes the motion of rigid bodies that are tied together by joints, as a "
        "scenario "
        "describes\nthem, and writes it to a result file. Data goes to standard output, all else to standard "
        "error.\n.SH OPTIONS\n";
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
