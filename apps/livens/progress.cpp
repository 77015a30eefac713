// SPDX-License-Identifier: BSD-3-Clause
#include "progress.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "console.h"
#include "terminal.h"

namespace livens::program {

namespace {

struct Part {
    std::string text;
    int worth;   ///< the least goes first where the terminal is too narrow
};

std::string joined(const std::vector<Part>& parts)
{
    std::string text;
    for (const Part& part : parts) text += (text.empty() ? "" : "  ") + part.text;
    return text;
}

}   // namespace

ProgressLine::ProgressLine(bool enabled) : enabled_(enabled) {}

ProgressLine::~ProgressLine() { clear(); }

void ProgressLine::clear()
{
    if (!visible_) return;
    say_raw("\r\x1b[K");
    visible_ = false;
}

void ProgressLine::show(const Progress& progress)
{
    const Clock::time_point now = Clock::now();
    if (!enabled_ || now < next_) return;
    next_ = now + std::chrono::milliseconds(100);
    const double elapsed = std::chrono::duration<double>(now - begin_).count();
    say_raw("\r\x1b[K" + progress_text(progress, elapsed, terminal_of(STDERR_FILENO).columns));
    visible_ = true;
}

std::string progress_text(const Progress& progress, double elapsed, int columns)
{
    const double done =
        progress.n_elements > 0 ? static_cast<double>(progress.done) / progress.n_elements : 0;
    std::vector<Part> parts{
        {fmt::format("{:3.0f} %", 100 * done), 5},
        {fmt::format("{} of {} elements", progress.done, progress.n_elements), 3},
        {fmt::format("t = {:.6g} s", progress.t), 2},
        {fmt::format("{} iteration{}", progress.iterations, progress.iterations == 1 ? "" : "s"), 1},
        {fmt::format("residual {:.1e}", progress.residual), 0},
    };
    if (done == 1)   // what is left has no count: condition numbers
        parts = {parts.front(), {"all elements are solved; checking", 1}};
    else if (done > 0)
        parts.push_back({fmt::format("{:.0f} s to go", elapsed * (1 - done) / done), 4});
    // The last column stays free: some terminals wrap as soon as it is written.
    const auto fits = [&] { return columns <= 0 || width_of(joined(parts)) < columns; };
    while (parts.size() > 1 && !fits()) parts.erase(std::ranges::min_element(parts, {}, &Part::worth));
    std::string text = joined(parts);
    if (!fits()) text.resize(static_cast<std::size_t>(columns - 1));
    return text;
}

}   // namespace livens::program
