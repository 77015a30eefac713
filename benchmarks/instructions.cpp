// SPDX-License-Identifier: BSD-3-Clause
// The program that scripts/instructions runs under callgrind: `instructions NAME` solves one kernel, `--all`
// every one. Prints a line "name elements error" each; fails if a motion is not the right one.
#include <cstdio>
#include <cstring>

#include "kernels.h"

namespace {

using livens::benchmarks::Kernel;

const Kernel* counted_kernel = nullptr;
livens::Solution* counted_solution = nullptr;

}   // namespace

// Callgrind counts between entry and return of this function and knows it by its plain name, so it must
// neither be inlined nor cloned: external, and called through a pointer that the compiler cannot see through.
extern "C" void livens_counted_solve();
__attribute__((noinline, used)) void livens_counted_solve()
{
    *counted_solution = livens::benchmarks::run(*counted_kernel);
}

int main(int argc, char** argv)
{
    if (argc != 2) {
        std::fprintf(stderr, "usage: instructions NAME | --all\n");
        return 2;
    }
    void (*volatile counted)() = livens_counted_solve;
    bool found = false, good = true;
    for (const Kernel& kernel : livens::benchmarks::counted_kernels()) {
        if (std::strcmp(argv[1], "--all") != 0 && kernel.name != argv[1]) continue;
        found = true;
        livens::Solution solution;
        counted_kernel = &kernel;
        counted_solution = &solution;
        counted();
        const double error = livens::benchmarks::error(kernel, solution);
        std::printf("%s %d %.2e\n", kernel.name.c_str(), kernel.mesh.n_elements(), error);
        if (!(error <= kernel.largest_error)) {
            std::fprintf(stderr, "%s: error %.2e m, at most %.0e m is right; %s\n", kernel.name.c_str(),
                         error, kernel.largest_error, solution.report.message.c_str());
            good = false;
        }
    }
    if (!found) std::fprintf(stderr, "no kernel '%s'\n", argv[1]);
    return found && good ? 0 : 1;
}
