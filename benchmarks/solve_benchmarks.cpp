// SPDX-License-Identifier: BSD-3-Clause
// Google Benchmark: seconds of solve() alone, with the error beside them.
#include <benchmark/benchmark.h>

#include "kernels.h"

namespace livens::benchmarks {
namespace {

void time_kernel(benchmark::State& state, const Kernel& kernel)
{
    Solution solution;
    for (auto _ : state) {
        solution = run(kernel);
        benchmark::DoNotOptimize(solution.motion.momenta.data());
    }
    if (!solution.report.converged()) state.SkipWithError(solution.report.message.c_str());
    state.counters["error_m"] = error(kernel, solution);
    state.counters["newton_per_element"] =
        static_cast<double>(solution.report.newton_iterations) / kernel.mesh.n_elements();
    state.counters["s_per_element"] =
        benchmark::Counter(kernel.mesh.n_elements(),
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

[[maybe_unused]] const bool registered = [] {
    std::vector<Kernel> kernels = counted_kernels();
    kernels.push_back(bricks_kernel("bricks_midpoint_2000", Midpoint{}, 2000));
    for (const Kernel& kernel : kernels) {
        benchmark::RegisterBenchmark(kernel.name.c_str(), [kernel](benchmark::State& state) {
            time_kernel(state, kernel);
        })->Unit(benchmark::kMillisecond);
    }
    return true;
}();

}   // namespace
}   // namespace livens::benchmarks
