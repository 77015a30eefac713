// SPDX-License-Identifier: BSD-3-Clause
// livens view: a page of a run, served to browsers on this machine until the user has seen enough.
#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <spawn.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "commands.h"
#include "console.h"
#include "failure.h"
#include "interrupt.h"

extern char** environ;

namespace livens::program {

namespace {

constexpr int slice = 200;       // ms between looks for a signal
constexpr int patience = 5000;   // ms for a browser to say or take anything
constexpr std::size_t most_head = 16384;

[[noreturn]] void give_up(const std::string& what)
{
    throw failure(exit_input_output, what + ": " + std::strerror(errno));
}

/// A file number that is closed at the end.
class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor()
    {
        if (number_ >= 0) ::close(number_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int number() const { return number_; }

private:
    int number_;
};

/// Waits, a slice at a time, until the descriptor can be used or a signal has come.
bool wait_for(int number, short event, int milliseconds)
{
    const bool for_ever = milliseconds < 0;
    for (int waited = 0; for_ever || waited < milliseconds; waited += for_ever ? 0 : slice) {
        if (InterruptWatch::signal() != 0) return false;
        pollfd poll{number, event, 0};
        if (::poll(&poll, 1, slice) > 0) return true;
    }
    return false;
}

/// Other users of this machine reach its ports, but do not guess this.
std::string secret()
{
    std::array<unsigned char, 16> bytes{};
    if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
        give_up("no random numbers are to be had");
    std::string text;
    for (const unsigned char byte : bytes) text += fmt::format("{:02x}", byte);
    return text;
}

std::string head_of_request(int browser)
{
    std::string head;
    std::array<char, 4096> buffer{};
    while (head.find("\r\n\r\n") == std::string::npos && head.size() < most_head) {
        if (!wait_for(browser, POLLIN, patience)) return {};
        const ssize_t n = ::recv(browser, buffer.data(), buffer.size(), 0);
        if (n <= 0) return {};
        head.append(buffer.data(), static_cast<std::size_t>(n));
    }
    return head;
}

void send_all(int browser, std::string_view text)
{
    while (!text.empty() && wait_for(browser, POLLOUT, patience)) {
        const ssize_t n = ::send(browser, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (n < 0 && errno != EAGAIN && errno != EINTR) return;
        if (n > 0) text.remove_prefix(static_cast<std::size_t>(n));
    }
}

/// What a page of another site, which finds this port by trying, must not be told: the host must be this one.
bool asks_this_host(std::string_view head, int port)
{
    for (const char* const host : {"127.0.0.1", "localhost"})
        if (head.find(fmt::format("\r\nHost: {}:{}\r\n", host, port)) != std::string_view::npos) return true;
    return false;
}

void answer(int browser, std::string_view page, const std::string& path, int port)
{
    const std::string head = head_of_request(browser);
    if (head.empty()) return;
    const bool is_get = head.starts_with("GET " + path + " "),
               is_head = head.starts_with("HEAD " + path + " ");
    const bool is_ours = (is_get || is_head) && asks_this_host(head, port);
    const std::string_view body = is_ours ? page : "not here\n";
    send_all(browser,
             fmt::format("HTTP/1.1 {}\r\nContent-Type: text/{}; charset=utf-8\r\nContent-Length: {}\r\n"
                         "Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\n"
                         "Referrer-Policy: no-referrer\r\nConnection: close\r\n\r\n",
                         is_ours ? "200 OK" : "404 Not Found", is_ours ? "html" : "plain", body.size()));
    if (!is_head) send_all(browser, body);
    ::shutdown(browser, SHUT_WR);
    std::array<char, 256> rest{};   // so that closing does not take back what is on its way
    while (wait_for(browser, POLLIN, slice) && ::recv(browser, rest.data(), rest.size(), 0) > 0) {
    }
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
    const Descriptor door(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    const int port = listen_here(door, arguments.port);
    const std::string path = "/" + secret() + "/";
    const std::string address = fmt::format("http://127.0.0.1:{}{}", port, path);
    if (common.json)
        print("{\"address\": \"" + address + "\"}\n");
    else
        print(address + "\n");
    if (!arguments.address_only && !open_browser(address))
        say_warning("found no browser; open the address in one");
    say_note("serving until Ctrl-C");
    while (wait_for(door.number(), POLLIN, -1)) {
        const Descriptor browser(::accept4(door.number(), nullptr, nullptr, SOCK_CLOEXEC));
        if (browser.number() >= 0) answer(browser.number(), page, path, port);
        while (::waitpid(-1, nullptr, WNOHANG) > 0) {
        }   // what opened the browser
    }
    return exit_ok;
}

}   // namespace livens::program
