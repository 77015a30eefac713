// SPDX-License-Identifier: BSD-3-Clause
// Many motions at a time, each solved by one thread and told in their order. Threads share what is read
// alone, so bits do not depend on their number (docs/architecture.md, "The rooms").
#include "livens/spacetime/ensemble.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <system_error>
#include <thread>

namespace livens {

namespace {

/// What is to be done, and how far it is.
struct Tasks {
    explicit Tasks(int n) : ended(static_cast<std::size_t>(n)), thrown(ended.size()) {}

    std::atomic<int> next{0};
    std::vector<std::atomic<bool>> ended;
    std::vector<std::exception_ptr> thrown;

    void work_off(const std::function<void(int)>& work)
    {
        const int n = static_cast<int>(ended.size());
        for (int i = next++; i < n; i = next++) {
            try {
                work(i);
            } catch (...) {
                thrown[i] = std::current_exception();
            }
            ended[i] = true;
            ended[i].notify_one();
        }
    }
};

/// As many as the system gives, and fewer than that are wanted.
std::vector<std::jthread> start_threads(int n, Tasks& tasks, const std::function<void(int)>& work)
{
    std::vector<std::jthread> threads;
    try {
        for (int k = 0; k < n; ++k) threads.emplace_back([&] { tasks.work_off(work); });
    } catch (const std::system_error&) {   // fewer do it, too
    }
    return threads;
}

}   // namespace

int threads_for(int n_threads)
{
    return n_threads > 0 ? n_threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void run_in_order(int n, int n_threads, const std::function<void(int)>& work,
                  const std::function<void(int)>& done)
{
    const int wanted = std::min(n, threads_for(n_threads));
    if (wanted < 2) {
        for (int i = 0; i < n; ++i) {
            work(i);
            done(i);
        }
        return;
    }
    Tasks tasks(n);
    const std::vector<std::jthread> threads = start_threads(wanted, tasks, work);   // joined at the end
    if (threads.empty()) tasks.work_off(work);
    try {
        for (int i = 0; i < n; ++i) {
            // Results are told in order even if later ones are ready: a stream that is written is then the
            // same in every run.
            tasks.ended[i].wait(false);
            if (tasks.thrown[i]) std::rethrow_exception(tasks.thrown[i]);
            done(i);
        }
    } catch (...) {
        // Nobody takes another task; those at work end by themselves before the threads are joined.
        tasks.next = n;
        throw;
    }
}

std::vector<Solution> solve_all(std::span<const Variation> variations, int n_threads)
{
    std::vector<Solution> solutions(variations.size());
    run_in_order(
        static_cast<int>(variations.size()), n_threads,
        [&](int i) {
            const Variation& v = variations[i];
            solutions[i] = solve(*v.model, v.problem, v.time, v.method, v.options);
        },
        [](int) {});
    return solutions;
}

}   // namespace livens
