// SPDX-License-Identifier: BSD-3-Clause
// Browsers that ask for one page, and for what is new of it: all at once, none waits for another.
#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <poll.h>

namespace livens::program {

/// A file number that is closed at the end.
class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept;
    Descriptor& operator=(Descriptor&& other) noexcept;
    ~Descriptor();
    int number() const { return number_; }

private:
    int number_;
};

/// What pages that follow the program are told: an event of the server (text/event-stream), later ones by
/// higher numbers.
struct Event {
    long number = 0;
    std::shared_ptr<const std::string> text;
};

/// What is served, and to whom. Page and events may change while browsers still take older ones.
struct Served {
    std::shared_ptr<const std::string> page;
    std::string path;   ///< that nobody guesses
    int port = 0;
    bool has_events = false;   ///< at `path`events?N: those with numbers above N
    // The last run, and what has been told since. Who is slow misses those between, and nothing by that.
    std::array<Event, 2> events{};
};

/// Whether the head of a request names this host, which a page of another site, that finds the port by
/// trying, does not. Names of fields and hosts have no case; exactly one field is Host. [RFC 9112, 3.2]
bool asks_this_host(std::string_view head, int port);

/// One browser, from its first byte to its last. It may be slow: nothing here waits.
class Visitor {
public:
    using Clock = std::chrono::steady_clock;

    explicit Visitor(int socket) : socket_(socket), until_(Clock::now() + patience) {}

    pollfd wanted(const Served& served) const;
    /// Reads or writes what can be without waiting.
    void go_on(const Served& served);
    /// It has its answer, has hung up, or took too long: for its request, or for the next piece of the page.
    bool is_done() const { return is_done_ || (stage_ != Stage::listening && Clock::now() > until_); }
    bool is_asking() const { return stage_ == Stage::asking; }

private:
    static constexpr std::chrono::seconds patience{5};
    enum class Stage { asking, taking, listening, leaving };

    void ask(const Served& served);
    void answer(const Served& served);
    bool send_some(std::string_view text, std::size_t& n_sent);
    /// True when all is on its way.
    bool take();
    const Event* news(const Served& served) const;
    void listen(const Served& served);
    void leave();

    Descriptor socket_;
    Stage stage_ = Stage::asking;
    bool is_done_ = false;
    Clock::time_point until_;
    std::string head_;        // of the request, then what is left of the answer's
    std::string_view body_;   // what is left of it, in what is kept
    std::shared_ptr<const std::string> kept_;
    bool is_follower_ = false;   // that listens when it has its answer
    long heard_ = 0;             // the number of the last event
};

/// Those that are here.
class Visitors {
public:
    explicit Visitors(const Served& served) : served_(served) {}

    /// Waits for at most so many milliseconds until somebody comes to the door or somebody here goes on.
    void wait(int door, int milliseconds);

private:
    static constexpr std::size_t most = 64;   // one more, and the one that has been asking for longest goes

    void receive(int door);

    const Served& served_;
    std::vector<Visitor> all_;
};

}   // namespace livens::program
