// One line on a terminal that says how far the solution is.
#pragma once

#include <chrono>

#include "livens/solvers/report.h"

namespace livens::program {

class ProgressLine {
public:
    /// Nothing is shown if not `enabled`.
    explicit ProgressLine(bool enabled);
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    void show(const Progress& progress);

private:
    using Clock = std::chrono::steady_clock;

    bool enabled_;
    bool visible_ = false;
    Clock::time_point begin_ = Clock::now();
    Clock::time_point next_ = begin_ + std::chrono::milliseconds(200);   // short runs show nothing
};

}   // namespace livens::program
