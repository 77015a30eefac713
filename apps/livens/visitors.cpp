// SPDX-License-Identifier: BSD-3-Clause
#include "visitors.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
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

/// Who listens is also heard hanging up.
pollfd Visitor::wanted(const Served& served) const
{
    const bool is_sent = stage_ == Stage::taking ||
                         (stage_ == Stage::listening && (!body_.empty() || news(served) != nullptr));
    const int events = (is_sent ? POLLOUT : 0) | (stage_ == Stage::taking ? 0 : POLLIN);
    return {socket_.number(), static_cast<short>(events), 0};
}

void Visitor::go_on(const Served& served)
{
    if (stage_ == Stage::asking) ask(served);
    if (stage_ == Stage::taking && take()) {
        stage_ = is_follower_ ? Stage::listening : Stage::leaving;
        if (!is_follower_) ::shutdown(socket_.number(), SHUT_WR);
        until_ = Clock::now() + farewell;
    }
    if (stage_ == Stage::listening) listen(served);
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
    answer(served);
    stage_ = Stage::taking;
    until_ = Clock::now() + patience;
}

void Visitor::answer(const Served& served)
{
    const std::string events = "GET " + served.path + "events?";
    const bool is_head = head_.starts_with("HEAD " + served.path + " "),
               is_get = head_.starts_with("GET " + served.path + " "),
               is_here = asks_this_host(head_, served.port);
    is_follower_ = is_here && served.has_events && head_.starts_with(events);
    const bool is_page = is_here && (is_get || is_head);
    if (is_follower_) std::from_chars(head_.data() + events.size(), head_.data() + head_.size(), heard_);
    if (is_page && !is_head) kept_ = served.page;
    const std::string_view other = is_follower_ ? "" : "not here\n";
    const std::size_t size = is_page ? served.page->size() : other.size();
    head_ = fmt::format("HTTP/1.1 {}\r\nContent-Type: text/{}; charset=utf-8\r\n{}"
                        "Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\n"
                        "Referrer-Policy: no-referrer\r\nConnection: close\r\n\r\n",
                        is_page || is_follower_ ? "200 OK" : "404 Not Found",
                        is_page        ? "html"
                        : is_follower_ ? "event-stream"
                                       : "plain",
                        is_follower_ ? "" : fmt::format("Content-Length: {}\r\n", size));
    body_ = kept_ ? std::string_view(*kept_) : is_page ? std::string_view() : other;
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

bool Visitor::take()
{
    std::size_t n = 0;
    while (!head_.empty()) {
        if (!send_some(head_, n)) return false;
        head_.erase(0, n);
    }
    while (!body_.empty()) {
        if (!send_some(body_, n)) return false;
        body_.remove_prefix(n);
    }
    return true;
}

/// The first one that it has not heard; null: there is none.
const Event* Visitor::news(const Served& served) const
{
    const Event* first = nullptr;
    for (const Event& event : served.events)
        if (event.number > heard_ && (first == nullptr || event.number < first->number)) first = &event;
    return first;
}

/// What it says is not listened to: it is looked whether it has hung up.
void Visitor::listen(const Served& served)
{
    std::array<char, 4096> rest{};
    const ssize_t n = ::recv(socket_.number(), rest.data(), rest.size(), MSG_DONTWAIT);
    is_done_ = n == 0 || (n < 0 && !would_block());
    while (!is_done_ && take()) {
        const Event* const next = news(served);
        if (next == nullptr) return;
        heard_ = next->number;
        kept_ = next->text;
        body_ = *kept_;
    }
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
    for (const Visitor& visitor : all_) polls.push_back(visitor.wanted(served_));
    polls.push_back({door, POLLIN, 0});
    if (::poll(polls.data(), polls.size(), milliseconds) > 0) {
        for (std::size_t i = 0; i < all_.size(); ++i)
            if (polls[i].revents != 0) all_[i].go_on(served_);
        if (polls.back().revents != 0) receive(door);
    }
    std::erase_if(all_, &Visitor::is_done);
}

}   // namespace livens::program
