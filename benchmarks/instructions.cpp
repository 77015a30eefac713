// SPDX-License-Identifier: BSD-3-Clause
// The program that scripts/instructions runs under callgrind: `instructions NAME` solves one kernel, `--all`
// every one. Prints a line "name elements error" each; fails if a motion is not the right one.
// `instructions chain KIND BODIES ELEMENTS` solves a chain and prints "KIND BODIES ELEMENTS steps", the most
// of an element; fails if that needed a tangent.
#include <cstdio>
#include <cstdlib>
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

namespace {

livens::Solution solve_counted(const Kernel& kernel)
{
    void (*volatile counted)() = livens_counted_solve;
    livens::Solution solution;
    counted_kernel = &kernel;
    counted_solution = &solution;
    counted();
    return solution;
}

int solve_chain(int n, const char* kind, int n_elements)
{
    const livens::SolveReport report =
        solve_counted(livens::benchmarks::chain_kernel(n, kind, n_elements)).report;
    int most = 0;   // but for the first elements, which have nothing to go on from
    for (std::size_t e = 3; e < report.iterations.size(); ++e)
        most = report.iterations[e] > most ? report.iterations[e] : most;
    std::printf("%s %d %d %d\n", kind, n, n_elements, most);
    if (report.converged() && report.factorisations == 0) return 0;
    std::fprintf(stderr, "not by the kernel alone; %s\n", report.message.c_str());
    return 1;
}

}   // namespace

int main(int argc, char** argv)
{
    if (argc == 5 && std::strcmp(argv[1], "chain") == 0)
        return solve_chain(std::atoi(argv[3]), argv[2], std::atoi(argv[4]));
    if (argc != 2) {
        std::fprintf(stderr, "usage: instructions NAME | --all | chain KIND BODIES ELEMENTS\n");
        return 2;
    }
    bool found = false, good = true;
    for (const Kernel& kernel : livens::benchmarks::counted_kernels()) {
        if (std::strcmp(argv[1], "--all") != 0 && kernel.name != argv[1]) continue;
        found = true;
        const livens::Solution solution = solve_counted(kernel);
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
