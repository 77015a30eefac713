// SPDX-License-Identifier: BSD-3-Clause
// Threads that share the loops of one solution.
#pragma once

#include <functional>
#include <memory>

namespace livens::inline solvers_internal {

class CrewMembers;

/// While it lives, in_shares() of this thread divides its work among this thread and n_threads - 1 others,
/// which are started when they are first needed, and are fewer where the system gives no more. Like Patience
/// it is found by the loops far below, which then need not be told.
class Crew {
public:
    static constexpr int most_threads = 256;

    /// Less than 2, or as many as there are in the crew outside of it: nothing changes.
    explicit Crew(int n_threads);
    ~Crew();
    Crew(const Crew&) = delete;
    Crew& operator=(const Crew&) = delete;

    /// Threads that in_shares() of this thread has, 1 without a crew: slots are numbered from 0 to one less.
    static int size();
    /// Whether in_shares() divides so many items.
    static bool divides(int n, int least);

private:
    std::unique_ptr<CrewMembers> members_;
    CrewMembers* outer_;
};

/// Calls work(slot, begin, end) for several shares of 0..n - 1 that follow each other, one a thread at most,
/// slots ascending.
void divide(int n, int least, const std::function<void(int slot, int begin, int end)>& work);

/// The same; of less than 2 `least` items, or without a crew, all of it is done here, as slot 0. Returns when
/// all have ended.
///
/// Each item must write what no other reads or writes, and workspaces by slot: then no bit depends on the
/// number of threads. What is thrown for the first of the items is thrown on, as one thread alone would have
/// it. Who asks Patience inside asks whether this thread is still wanted: where it is not, all others end at
/// their next question, and Stopped is thrown. Inside of several shares there is no crew.
template <class Work>
void in_shares(int n, int least, const Work& work)
{
    if (Crew::divides(n, least))
        divide(n, least, std::cref(work));
    else
        work(0, 0, n);
}

/// The same for work(i) alone, of all items.
template <class Work>
void for_each_item(int n, int least, const Work& work)
{
    in_shares(n, least, [&](int, int begin, int end) {
        for (int i = begin; i < end; ++i) work(i);
    });
}

/// A loop of which a part goes from item to item: one thread does it, and has less of the rest than others.
struct LoopInOrder {
    int n = 0;
    int least = 1;   ///< as of in_shares()
    double in_turn = 0;   ///< what the part in order costs over the rest
};

/// Calls work(slot, i) of all items, and then(i) in their order, each behind the work of its item. Ends where
/// then() says no. Without a crew each comes at once behind its work.
bool in_order_behind(const LoopInOrder& loop, const std::function<void(int slot, int item)>& work,
                     const std::function<bool(int)>& then);

/// Calls first(i) of all items in their order, and work(slot, i), each behind the first(i) of its item.
void in_order_ahead(const LoopInOrder& loop, const std::function<void(int)>& first,
                    const std::function<void(int slot, int item)>& work);

}   // namespace livens::inline solvers_internal
