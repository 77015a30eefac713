// SPDX-License-Identifier: BSD-3-Clause
// Work against error on two bricks to 2 s: `work_error FILE.csv`, drawn by work_error.py.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>

#include "kernels.h"

namespace livens::benchmarks {
namespace {

struct Series {
    const char* name;
    Method method;
    std::vector<int> elements;
};

std::vector<Series> all_series()
{
    return {{"lobatto(2)", Lobatto{2}, {40, 80, 160, 320, 640, 1280, 2560, 5120}},
            {"lobatto(4)", Lobatto{4}, {20, 40, 80, 160, 320, 640}},
            {"lobatto(6)", Lobatto{6}, {20, 40, 80, 120, 160}},
            {"lobatto(8)", Lobatto{8}, {20, 30, 40, 60, 80}},
            {"midpoint", Midpoint{}, {100, 200, 400, 800, 1600, 3200, 6400, 12800}}};
}

/// The shortest of as many runs as fit into a fifth of a second, at least 3: other load on the machine only
/// adds.
double seconds(const Kernel& kernel, Solution& solution)
{
    using clock = std::chrono::steady_clock;
    double best = std::numeric_limits<double>::infinity(), total = 0;
    for (int i = 0; i < 3 || total < 0.2; ++i) {
        const auto start = clock::now();
        solution = run(kernel);
        const double spent = std::chrono::duration<double>(clock::now() - start).count();
        best = std::min(best, spent);
        total += spent;
    }
    return best;
}

bool write_csv(std::FILE* file)
{
    bool good = true;
    std::fprintf(file, "method,elements,h_s,error_m,seconds,newton_iterations,factorisations\n");
    for (const Series& series : all_series()) {
        for (const int n : series.elements) {
            const Kernel kernel = bricks_kernel(series.name, series.method, n);
            Solution solution;
            const double time = seconds(kernel, solution);
            if (!solution.report.converged()) {
                std::fprintf(stderr, "%s, %d elements: %s\n", series.name, n,
                             solution.report.message.c_str());
                good = false;
                continue;
            }
            std::fprintf(file, "%s,%d,%.6g,%.4e,%.4e,%ld,%ld\n", series.name, n, 2.0 / n,
                         error(kernel, solution), time, solution.report.newton_iterations,
                         solution.report.factorisations);
        }
    }
    return good;
}

}   // namespace
}   // namespace livens::benchmarks

int main(int argc, char** argv)
{
    if (argc != 2) {
        std::fprintf(stderr, "usage: work_error FILE.csv\n");
        return 2;
    }
    std::FILE* file = std::fopen(argv[1], "w");
    if (!file) {
        std::perror(argv[1]);
        return 6;
    }
    const bool good = livens::benchmarks::write_csv(file);
    return std::fclose(file) == 0 && good ? 0 : 1;
}
