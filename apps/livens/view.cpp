// SPDX-License-Identifier: BSD-3-Clause
// livens view: a page of a run, or of a scenario that is solved whenever it is saved, served to browsers on
// this machine until the user has seen enough.
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <spawn.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include "commands.h"
#include "console.h"
#include "failure.h"
#include "interrupt.h"
#include "live_scenario.h"
#include "simd.h"
#include "visitors.h"

extern char** environ;

namespace livens::program {

namespace {

// ms between looks for a signal; for files that were saved; for a solution that is done
constexpr int slice = 200, slice_of_files = 50, slice_of_solution = 10;

[[noreturn]] void give_up(const std::string& what)
{
    throw failure(exit_input_output, what + ": " + std::strerror(errno));
}

/// Other users of this machine reach its ports, but do not guess this.
std::string secret()
{
    std::array<unsigned char, 16> bytes{};
    if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
        give_up("no random numbers are available");
    std::string text;
    for (const unsigned char byte : bytes) text += fmt::format("{:02x}", byte);
    return text;
}

/// $BROWSER, or what the desktop has; no shell sees the address.
bool open_browser(const std::string& address)
{
    const char* const chosen = std::getenv("BROWSER");
    for (const char* const program : {chosen, "xdg-open", "open"}) {
        if (program == nullptr || *program == '\0') continue;
        std::string name = program, argument = address;
        std::array<char*, 3> arguments{name.data(), argument.data(), nullptr};
        pid_t process = 0;
        if (::posix_spawnp(&process, program, nullptr, nullptr, arguments.data(), environ) == 0) return true;
    }
    return false;
}

int listen_here(const Descriptor& door, int port)
{
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    place.sin_port = htons(static_cast<std::uint16_t>(port));
    const int yes = 1;
    socklen_t size = sizeof place;
    auto* const address = reinterpret_cast<sockaddr*>(&place);
    if (door.number() < 0 || ::setsockopt(door.number(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) != 0 ||
        ::bind(door.number(), address, size) != 0 || ::listen(door.number(), 8) != 0 ||
        ::getsockname(door.number(), address, &size) != 0)
        give_up(fmt::format("cannot listen on 127.0.0.1{}", port > 0 ? fmt::format(":{}", port) : ""));
    return ntohs(place.sin_port);
}

void check_view(const ReportArguments& arguments)
{
    if (arguments.watched.empty() && arguments.run.empty())
        throw failure(exit_usage, "view needs RUN.nc, or --watch FILE.toml");
    if (!arguments.watched.empty() && !arguments.run.empty())
        throw failure(exit_usage, "view shows a run, or with --watch a scenario, not both");
    if (arguments.run.ends_with(".toml"))
        throw failure(exit_usage, "'" + plain(arguments.run) +
                                      "' is a scenario, not a run; 'livens view --watch " +
                                      plain(arguments.run) + "' solves and shows it");
}

void show_address(const std::string& address, const ReportArguments& arguments, const Common& common)
{
    print(common.json ? "{\"address\": \"" + address + "\"}\n" : address + "\n");
    if (!arguments.address_only && !open_browser(address))
        say_warning("found no browser; open the address in one");
    say_note("serving until Ctrl-C");
}

}   // namespace

int view_command(const ReportArguments& arguments, const Common& common)
{
    check_view(arguments);
    const bool is_live = !arguments.watched.empty();
    pin_instructions("");
    Served served;
    const InterruptWatch watch;
    std::optional<LiveScenario> scenario;
    if (is_live)
        scenario.emplace(arguments.watched, common, served);
    else
        served.page = std::make_shared<std::string>(report_of(arguments));
    const Descriptor door(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    served.port = listen_here(door, arguments.port);
    served.path = "/" + secret() + "/";
    show_address(fmt::format("http://127.0.0.1:{}{}", served.port, served.path), arguments, common);
    Visitors visitors(served);
    while (InterruptWatch::signal() == 0) {
        if (is_live) scenario->go_on();
        visitors.wait(door.number(), !is_live                 ? slice
                                     : scenario->is_solving() ? slice_of_solution
                                                              : slice_of_files);
        while (::waitpid(-1, nullptr, WNOHANG) > 0) {
        }   // what opened the browser
    }
    return exit_ok;
}

}   // namespace livens::program
