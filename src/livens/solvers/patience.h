// SPDX-License-Identifier: BSD-3-Clause
// How long work that takes nobody knows how long asks whether it is still wanted.
#pragma once

#include <exception>
#include <functional>

namespace [[gnu::visibility("default")]] livens {

/// What ask() throws where it is not. Whoever can keep something of the work catches it.
class Stopped final : public std::exception {
public:
    const char* what() const noexcept override { return "stopped as asked"; }
};

/// While it lives, ask() of this thread asks `goes_on`, which must outlive it. Loops far below the one who
/// knows (columns of a factorisation, elements of a motion that is judged) have no other way to it; what they
/// compute does not depend on the answer.
class Patience {
public:
    /// Once `goes_on` says no, work goes on for `grace` seconds of the thread's CPU time. Without a function
    /// the one outside of it is asked.
    explicit Patience(const std::function<bool()>& goes_on, double grace = 0);
    ~Patience();
    Patience(const Patience&) = delete;
    Patience& operator=(const Patience&) = delete;

    /// Every millisecond or so; most calls look at a counter alone. Throws Stopped.
    static void ask();
    /// Not so often: no call looks at a counter alone.
    static void ask_now();

private:
    void look();

    const std::function<bool()>& goes_on_;
    Patience* outer_;
    double grace_;
    double last_;              // time of the last question, s
    double stopped_at_ = -1;   // s of CPU time; before: -1
};

}   // namespace gnu::visibility("default")]]livens
