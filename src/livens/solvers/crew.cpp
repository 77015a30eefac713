// SPDX-License-Identifier: BSD-3-Clause
// A few threads that wait for shares of loops. Which items a share has depends on the number of threads, what
// an item does must not: see in_shares().
#include "livens/solvers/crew.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "livens/solvers/patience.h"

namespace livens::inline solvers_internal {

namespace {

/// The one who waits for the others asks that often whether they are still wanted.
constexpr auto between_questions = std::chrono::milliseconds(10);

using Share = std::function<void(int, int, int)>;

}   // namespace

class CrewMembers {
public:
    explicit CrewMembers(int n) : wanted(std::min(n, Crew::most_threads)) {}
    CrewMembers(const CrewMembers&) = delete;
    CrewMembers& operator=(const CrewMembers&) = delete;
    ~CrewMembers()
    {
        {
            const std::lock_guard lock(mutex);
            is_over = true;
        }
        begins.notify_all();
    }

    void run(int n, int least, const Share& share);

    int wanted;
    std::mutex mutex;
    std::condition_variable begins, ends;
    const Share* work = nullptr;   // of the round at hand
    int n_items = 0, n_shares = 0, n_left = 0;
    long round = 0;
    bool is_over = false;
    std::atomic<bool> is_stopped = false;
    std::vector<std::exception_ptr> thrown;   // of each slot
    bool is_started = false;
    std::vector<std::jthread> threads;   // joined first

private:
    void start();
    void wait_for_rounds(int slot);
    void do_share(int slot);
    void wait_for_others();
};

namespace {

thread_local CrewMembers* present = nullptr;

}   // namespace

/// Inside another crew of as many threads it is that one; threads start with the first loop that is divided.
Crew::Crew(int n_threads) : outer_(present)
{
    if (n_threads < 2 || (present != nullptr && present->wanted == n_threads)) return;
    members_ = std::make_unique<CrewMembers>(n_threads);
    present = members_.get();
}

Crew::~Crew() { present = outer_; }

int Crew::size() { return present != nullptr ? present->wanted : 1; }

bool Crew::divides(int n, int least) { return present != nullptr && n / 2 >= least; }

void CrewMembers::start()
{
    is_started = true;
    try {
        for (int slot = 1; slot < wanted; ++slot)
            threads.emplace_back([this, slot] { wait_for_rounds(slot); });
    } catch (const std::system_error&) {   // fewer do it, too
    }
    thrown.resize(threads.size() + 1);
}

void CrewMembers::do_share(int slot)
{
    const auto bound = [&](int share) {
        return static_cast<int>(static_cast<long long>(n_items) * share / n_shares);
    };
    try {
        (*work)(slot, bound(slot), bound(slot + 1));
    } catch (...) {
        thrown[static_cast<std::size_t>(slot)] = std::current_exception();
    }
}

void CrewMembers::wait_for_rounds(int slot)
{
    const std::function<bool()> is_wanted = [this] { return !is_stopped; };
    const Patience patience(is_wanted);   // the other thread asks the caller
    for (long seen = 0;;) {
        {
            std::unique_lock lock(mutex);
            begins.wait(lock, [&] { return is_over || round != seen; });
            if (is_over) return;
            seen = round;
            if (slot >= n_shares) continue;
        }
        do_share(slot);
        const std::lock_guard lock(mutex);
        if (--n_left == 0) ends.notify_one();
    }
}

void CrewMembers::wait_for_others()
{
    std::unique_lock lock(mutex);
    while (!ends.wait_for(lock, between_questions, [this] { return n_left == 0; })) {
        if (thrown[0]) continue;
        lock.unlock();
        try {
            Patience::ask_now();
        } catch (...) {
            thrown[0] = std::current_exception();
            is_stopped = true;
        }
        lock.lock();
    }
}

void CrewMembers::run(int n, int least, const Share& share)
{
    if (!is_started) start();
    const int shares = std::min(static_cast<int>(threads.size()) + 1, n / std::max(least, 1));
    if (shares < 2) return share(0, 0, n);
    {
        const std::lock_guard lock(mutex);
        work = &share;
        n_items = n;
        n_shares = shares;
        n_left = shares - 1;
        is_stopped = false;
        std::ranges::fill(thrown, nullptr);
        ++round;
    }
    begins.notify_all();
    // loops inside of a share are not divided again
    CrewMembers* const own = std::exchange(present, nullptr);
    do_share(0);
    present = own;
    if (thrown[0]) is_stopped = true;   // what comes first is thrown on, so that nobody else counts
    wait_for_others();
    for (const std::exception_ptr& one : thrown)
        if (one) std::rethrow_exception(one);
}

void divide(int n, int least, const std::function<void(int, int, int)>& work)
{
    present->run(n, least, work);
}

namespace {

/// Who has which item of a loop in order: the first slot, which does what goes from item to item as well, has
/// fewer. Ends of a loop that is broken off, and items that others wait for, are told to all.
class Turns {
public:
    explicit Turns(const LoopInOrder& loop)
        : n(loop.n), n_slots(std::min(Crew::size(), loop.n / std::max(loop.least, 1))),
          is_done_(static_cast<std::size_t>(loop.n))
    {
        // n_first + n in_turn = (n - n_first) / (n_slots - 1)
        const double others = n_slots - 1, share = std::max(0.0, (1 - loop.in_turn * others) / n_slots);
        n_first = static_cast<int>(share * n);
    }

    /// Whoever awaits the item sees all that was written before its end.
    void end(int item) { is_done_[item].store(true, std::memory_order_release); }
    /// False: it is broken off.
    bool await(int item)
    {
        while (!is_done_[item].load(std::memory_order_acquire)) {
            if (is_over_) return false;
            Patience::ask();
            std::this_thread::yield();
        }
        return true;
    }
    void break_off() { is_over_ = true; }
    bool is_over() const { return is_over_; }
    /// Calls role(first slot, slot behind) of each thread.
    template <class Role>
    void divide(const Role& role)
    {
        solvers_internal::divide(n_slots, 1, [&](int, int begin, int end) {
            try {
                role(begin, end);
            } catch (...) {
                is_over_ = true;
                throw;
            }
        });
    }

    const int n, n_slots;
    int n_first = 0;   // items of the first slot

private:
    std::vector<std::atomic<bool>> is_done_;
    std::atomic<bool> is_over_ = false;
};

}   // namespace

/// The first slot has the first items, and is behind the others from there on.
bool in_order_behind(const LoopInOrder& loop, const std::function<void(int, int)>& work,
                     const std::function<bool(int)>& then)
{
    if (!Crew::divides(loop.n, loop.least)) {
        for (int i = 0; i < loop.n; ++i) {
            work(0, i);
            if (!then(i)) return false;
        }
        return true;
    }
    Turns turns(loop);
    const auto bound = [&](int slot) {
        const long long left = turns.n - turns.n_first;
        return slot == 0 ? 0 : turns.n_first + static_cast<int>(left * (slot - 1) / (turns.n_slots - 1));
    };
    turns.divide([&](int begin, int end) {
        for (int slot = begin; slot < end; ++slot)
            for (int i = bound(slot); i < bound(slot + 1) && !turns.is_over(); ++i) {
                work(slot, i);
                turns.end(i);
            }
        for (int i = 0; begin == 0 && i < turns.n; ++i)
            if (!turns.await(i) || !then(i)) return turns.break_off();
    });
    return !turns.is_over();
}

/// The first slot has the last items, the others one after the other of those before, so that none waits
/// long.
void in_order_ahead(const LoopInOrder& loop, const std::function<void(int)>& first,
                    const std::function<void(int, int)>& work)
{
    if (!Crew::divides(loop.n, loop.least)) {
        for (int i = 0; i < loop.n; ++i) first(i);
        for (int i = 0; i < loop.n; ++i) work(0, i);
        return;
    }
    Turns turns(loop);
    const int n_others = turns.n - turns.n_first;
    turns.divide([&](int begin, int end) {
        for (int i = 0; begin == 0 && i < turns.n && !turns.is_over(); ++i) {
            first(i);
            turns.end(i);
        }
        for (int slot = begin; slot < end; ++slot) {
            const int step = slot == 0 ? 1 : turns.n_slots - 1, last = slot == 0 ? turns.n : n_others;
            for (int i = slot == 0 ? n_others : slot - 1; i < last; i += step) {
                if (!turns.await(i)) return;
                work(slot, i);
            }
        }
    });
}

}   // namespace livens::inline solvers_internal
