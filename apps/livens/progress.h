// One line on a terminal that says how far the solution is.
#pragma once

#include <chrono>

#include "livens/solvers/report.h"

namespace livens::program {

class ProgressLine {
public:
    /// `start` and `end` of the motion, s. Nothing is shown if not `enabled`.
    ProgressLine(double start, double end, bool enabled);
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    void show(const Progress& progress);

private:
    using Clock = std::chrono::steady_clock;

    double start_, end_;
    bool enabled_;
    bool visible_ = false;
    Clock::time_point begin_ = Clock::now();
    Clock::time_point next_ = begin_ + std::chrono::milliseconds(200);   // short runs show nothing
};

}   // namespace livens::program
