// SPDX-License-Identifier: BSD-3-Clause
#include "visitors.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <utility>

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

namespace livens::program {

namespace {

constexpr std::size_t most_head = 16384;
constexpr std::chrono::milliseconds farewell{200};

std::string lower(std::string_view text)
{
    std::string out(text);
    for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

bool would_block() { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }

}   // namespace

Descriptor::Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept
{
    std::swap(number_, other.number_);
    return *this;
}

Descriptor::~Descriptor()
{
    if (number_ >= 0) ::close(number_);
}

bool asks_this_host(std::string_view head, int port)
{
    int n_hosts = 0;
    bool is_this = false;
    for (std::size_t at = head.find("\r\n"); at != std::string_view::npos;) {
        const std::size_t begin = at + 2;
        at = head.find("\r\n", begin);
        const std::string line = lower(head.substr(begin, at - begin));
        if (!line.starts_with("host:")) continue;
        ++n_hosts;
        const std::size_t first = std::min(line.find_first_not_of(" \t", 5), line.size());
        const std::string host = line.substr(first, line.find_last_not_of(" \t") + 1 - first);
        is_this = host == fmt::format("127.0.0.1:{}", port) || host == fmt::format("localhost:{}", port);
    }
    return n_hosts == 1 && is_this;
}

pollfd Visitor::wanted() const
{
    return {socket_.number(), static_cast<short>(stage_ == Stage::taking ? POLLOUT : POLLIN), 0};
}

void Visitor::go_on(const Served& served)
{
    if (stage_ == Stage::asking) ask(served);
    if (stage_ == Stage::taking) take();
    if (stage_ == Stage::leaving) leave();
}

void Visitor::ask(const Served& served)
{
    std::array<char, 4096> buffer{};
    const ssize_t n = ::recv(socket_.number(), buffer.data(), buffer.size(), MSG_DONTWAIT);
    is_done_ = n == 0 || (n < 0 && !would_block());
    if (n <= 0) return;
    head_.append(buffer.data(), static_cast<std::size_t>(n));
    if (head_.find("\r\n\r\n") == std::string::npos) {
        is_done_ = head_.size() > most_head;
        return;
    }
    const bool is_head = head_.starts_with("HEAD " + served.path + " "),
               is_get = head_.starts_with("GET " + served.path + " ");
    const bool is_ours = (is_get || is_head) && asks_this_host(head_, served.port);
    const std::string_view body = is_ours ? served.page : "not here\n";
    head_ = fmt::format("HTTP/1.1 {}\r\nContent-Type: text/{}; charset=utf-8\r\nContent-Length: {}\r\n"
                        "Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\n"
                        "Referrer-Policy: no-referrer\r\nConnection: close\r\n\r\n",
                        is_ours ? "200 OK" : "404 Not Found", is_ours ? "html" : "plain", body.size());
    body_ = is_head ? std::string_view() : body;
    stage_ = Stage::taking;
    until_ = Clock::now() + patience;
}

/// False if it cannot be taken now, or ever.
bool Visitor::send_some(std::string_view text, std::size_t& n_sent)
{
    const ssize_t n = ::send(socket_.number(), text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    is_done_ = n < 0 && !would_block();
    n_sent = n < 0 ? 0 : static_cast<std::size_t>(n);
    if (n > 0) until_ = Clock::now() + patience;
    return n > 0;
}

void Visitor::take()
{
    std::size_t n = 0;
    while (!head_.empty()) {
        if (!send_some(head_, n)) return;
        head_.erase(0, n);
    }
    while (!body_.empty()) {
        if (!send_some(body_, n)) return;
        body_.remove_prefix(n);
    }
    ::shutdown(socket_.number(), SHUT_WR);
    stage_ = Stage::leaving;
    until_ = Clock::now() + farewell;
}

/// Closing with unread bytes would take back what is on its way.
void Visitor::leave()
{
    std::array<char, 4096> rest{};
    const ssize_t n = ::recv(socket_.number(), rest.data(), rest.size(), MSG_DONTWAIT);
    is_done_ = n == 0 || (n < 0 && !would_block());
}

void Visitors::receive(int door)
{
    const int socket = ::accept4(door, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (socket < 0) return;
    if (all_.size() >= most) {
        const auto asking = std::ranges::find_if(all_, &Visitor::is_asking);
        all_.erase(asking == all_.end() ? all_.begin() : asking);
    }
    all_.emplace_back(socket);
}

void Visitors::wait(int door, int milliseconds)
{
    std::vector<pollfd> polls;
    for (const Visitor& visitor : all_) polls.push_back(visitor.wanted());
    polls.push_back({door, POLLIN, 0});
    if (::poll(polls.data(), polls.size(), milliseconds) > 0) {
        for (std::size_t i = 0; i < all_.size(); ++i)
            if (polls[i].revents != 0) all_[i].go_on(served_);
        if (polls.back().revents != 0) receive(door);
    }
    std::erase_if(all_, &Visitor::is_done);
}

}   // namespace livens::program
