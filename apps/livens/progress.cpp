#include "progress.h"

#include <fmt/format.h>

#include "console.h"

namespace livens::program {

ProgressLine::ProgressLine(bool enabled) : enabled_(enabled) {}

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
    const double done =
        progress.n_elements > 0 ? static_cast<double>(progress.done) / progress.n_elements : 0;
    const double to_go = done > 0 ? elapsed * (1 - done) / done : 0;
    say_raw(fmt::format(
        "\r\x1b[K{:3.0f} %  {} of {} elements  t = {:.6g} s  {} iterations  residual {:.1e}  {:.0f} s to go",
        100 * done, progress.done, progress.n_elements, progress.t, progress.iterations,
        progress.residual, to_go));
    visible_ = true;
}

}   // namespace livens::program
