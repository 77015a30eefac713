// SPDX-License-Identifier: BSD-3-Clause
// livens init: a small scenario to begin with.
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include "commands.h"
#include "console.h"
#include "failure.h"
#include "summary.h"

namespace livens::program {

namespace {

constexpr const char* pendulum =
    R"(#:schema ./livens.schema.json
# A rod of steel swings from a hinge. Plain numbers are in m, kg, s, rad; "5 mm" and "30 deg" work too.
# All keys: livens schema.   Check this file: livens check FILE.   Solve it: livens solve FILE.
format = 1
title = "a pendulum"
gravity = [0, 0, -9.81]

[[body]]
name = "rod"
shape = { box = [1, 0.05, 0.05] }   # edges along the body's own axes
density = 7850
position = [0.5, 0, 0]              # of its centre, at the start
# angular_velocity = [0, 1, 0]      # give it a push: rad/s about the world axes

[[joint]]
name = "hinge"
type = "revolute"
between = ["world", "rod"]
at = [0, 0, 0]                      # a point of the world and an axis, as things stand at the start
axis = [0, 1, 0]

[time]
end = 5
elements = 50                       # twice as many: errors 256 times smaller, at this degree
output = 0.1                        # samples are kept at these intervals

[method]
family = "lobatto"
degree = 4
)";

/// Never over something that is there: the file is made by this call or not at all.
void write_new(const std::filesystem::path& file, std::string_view text)
{
    const auto refuse = [&](int number) {
        const std::string why =
            number == EEXIST ? std::string("it is there already") : std::generic_category().message(number);
        throw failure(exit_input_output, "cannot write '" + file.string() + "': " + why);
    };
    const int made = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (made < 0) refuse(errno);
    int number = 0;
    while (!text.empty() && number == 0) {
        const ssize_t n = ::write(made, text.data(), text.size());
        if (n < 0 && errno != EINTR) number = errno;
        if (n > 0) text.remove_prefix(static_cast<std::size_t>(n));
    }
    if (::close(made) != 0 && number == 0) number = errno;
    if (number == 0) return;
    ::unlink(file.c_str());
    refuse(number);
}

constexpr const char* schema_name = "livens.schema.json";

/// What editors check the file by, beside it: a new one, or in place of an older one of livens. Whether it
/// is there then: the scenario is worth as much without it.
bool write_schema(const std::filesystem::path& file)
{
    const std::string text = schema_json();
    if (std::ifstream old{file, std::ios::binary}) {
        const std::string there{std::istreambuf_iterator<char>(old), {}};
        if (there.find("\"title\": \"livens scenario") == std::string::npos) return false;
        if (there == text) return true;
    }
    try {
        replace_file(file, text);
    } catch (const std::exception&) {
        return false;
    }
    return true;
}

}   // namespace

int init_command(const std::string& name, const Common& common)
{
    std::filesystem::path file = name.empty() ? "pendulum" : name;
    if (file.extension() != ".toml") file += ".toml";
    write_new(file, pendulum);
    const std::filesystem::path schema = file.parent_path() / schema_name;
    const bool has_schema = write_schema(schema);
    if (common.json) {
        JsonWriter json(2);
        json.begin_object().member("scenario", file.string());
        if (has_schema) json.member("schema", schema.string());
        json.end_object();
        print(json.text() + "\n");
        return exit_ok;
    }
    if (common.quiet) return exit_ok;
    Summary summary(terminal_of(STDOUT_FILENO));
    summary.headline(Ink::good, "Written", plain(file.string()) + ", a pendulum to be changed");
    if (has_schema) summary.aside("for editors: " + plain(schema.string()));
    summary.aside("next: livens solve " + plain(quoted(file.string())));
    print(summary.text());
    return exit_ok;
}

}   // namespace livens::program
