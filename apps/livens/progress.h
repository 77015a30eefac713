// SPDX-License-Identifier: BSD-3-Clause
// One line on a terminal that says how far the solution is.
#pragma once

#include <chrono>
#include <string>

#include "livens/solvers/report.h"

namespace livens::program {

/// The line after `elapsed` seconds, without its end, cut to be shorter than `columns` (0: any): residual,
/// iterations, time and elements go, in this order.
std::string progress_text(const Progress& progress, double elapsed, int columns);

class ProgressLine {
public:
    /// Nothing is shown if not `enabled`.
    explicit ProgressLine(bool enabled);
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    void show(const Progress& progress);
    void clear();

private:
    using Clock = std::chrono::steady_clock;

    bool enabled_;
    bool visible_ = false;
    Clock::time_point begin_ = Clock::now();
    Clock::time_point next_ = begin_ + std::chrono::milliseconds(200);   // short runs show nothing
};

}   // namespace livens::program
