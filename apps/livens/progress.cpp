#include "progress.h"

#include <fmt/format.h>

#include "console.h"

namespace livens::program {

ProgressLine::ProgressLine(double start, double end, bool enabled)
    : start_(start), end_(end), enabled_(enabled)
{}

ProgressLine::~ProgressLine()
{
    if (visible_) say_raw("\r\x1b[K");
}

void ProgressLine::show(const Progress& progress)
{
    const Clock::time_point now = Clock::now();
    if (!enabled_ || now < next_) return;
    next_ = now + std::chrono::milliseconds(100);
    const double elapsed = std::chrono::duration<double>(now - begin_).count();
    const double done = (progress.t - start_) / (end_ - start_);
    const double to_go = done > 0 ? elapsed * (1 - done) / done : 0;
    say_raw(fmt::format(
        "\r\x1b[K{:3.0f} %  element {} of {}  t = {:.6g} s  {} iterations  residual {:.1e}  {:.0f} s to go",
        100 * done, progress.element + 1, progress.n_elements, progress.t, progress.iterations,
        progress.residual, to_go));
    visible_ = true;
}

}   // namespace livens::program
