// SPDX-License-Identifier: BSD-3-Clause
// livens view: a page of a run, served to browsers on this machine until the user has seen enough.
#include <array>
#include <cerrno>
#include <cstring>
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
#include "visitors.h"

extern char** environ;

namespace livens::program {

namespace {

constexpr int slice = 200;   // ms between looks for a signal

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

}   // namespace

int view_command(const ReportArguments& arguments, const Common& common)
{
    const std::string page = report_of(arguments);
    const InterruptWatch watch;
    const Descriptor door(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    const int port = listen_here(door, arguments.port);
    const Served served{page, "/" + secret() + "/", port};
    const std::string address = fmt::format("http://127.0.0.1:{}{}", port, served.path);
    if (common.json)
        print("{\"address\": \"" + address + "\"}\n");
    else
        print(address + "\n");
    if (!arguments.address_only && !open_browser(address))
        say_warning("found no browser; open the address in one");
    say_note("serving until Ctrl-C");
    Visitors visitors(served);
    while (InterruptWatch::signal() == 0) {
        visitors.wait(door.number(), slice);
        while (::waitpid(-1, nullptr, WNOHANG) > 0) {
        }   // what opened the browser
    }
    return exit_ok;
}

}   // namespace livens::program
