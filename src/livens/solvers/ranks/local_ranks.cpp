// SPDX-License-Identifier: BSD-3-Clause
// Ranks that are threads of one process, with a letter box for every pair of them.
#include <condition_variable>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

#include "livens/solvers/ranks.h"

namespace livens {

namespace {

struct LetterBoxes {
    std::mutex mutex;
    std::condition_variable has_come;
    std::map<std::pair<int, int>, std::deque<std::vector<double>>> letters;   // from, to
    bool is_lost = false;
};

class LocalRanks final : public Ranks {
public:
    LocalRanks(LetterBoxes& boxes, int rank, int size) : boxes_(boxes), rank_(rank), size_(size) {}
    int rank() const override { return rank_; }
    int size() const override { return size_; }

protected:
    /// Never waits: a box takes any number of letters, so that two ranks may send to each other at once.
    void put(int to, std::span<const double> values) override
    {
        const std::lock_guard lock(boxes_.mutex);
        boxes_.letters[{rank_, to}].emplace_back(values.begin(), values.end());
        boxes_.has_come.notify_all();
    }
    void take(int from, std::span<double> values) override
    {
        std::unique_lock lock(boxes_.mutex);
        auto& letters = boxes_.letters[{from, rank_}];
        boxes_.has_come.wait(lock, [&] { return boxes_.is_lost || !letters.empty(); });
        if (letters.empty()) throw RankLost("another rank has failed");
        if (letters.front().size() != values.size())
            throw std::logic_error("a message between ranks is not as long as it is expected");
        std::copy(letters.front().begin(), letters.front().end(), values.begin());
        letters.pop_front();
    }

private:
    LetterBoxes& boxes_;
    int rank_, size_;
};

}   // namespace

/// The caller is the first rank. A rank that throws wakes all others, which are lost then; what it has thrown
/// comes out, not what became of them.
void run_as_ranks(int n, const std::function<void(Ranks&)>& work)
{
    LetterBoxes boxes;
    std::exception_ptr failure;
    const auto run = [&](int rank) {
        LocalRanks ranks(boxes, rank, n);
        try {
            work(ranks);
        } catch (...) {
            const std::lock_guard lock(boxes.mutex);
            if (!boxes.is_lost) failure = std::current_exception();   // others are lost by this one
            boxes.is_lost = true;
            boxes.has_come.notify_all();
        }
    };
    {
        std::vector<std::jthread> threads;
        for (int rank = 1; rank < n; ++rank) threads.emplace_back(run, rank);
        run(0);
    }
    if (failure) std::rethrow_exception(failure);
}

}   // namespace livens
