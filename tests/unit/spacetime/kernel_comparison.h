// SPDX-License-Identifier: BSD-3-Clause
// One element by the march kernel and by Newton's iteration, and random mechanisms to compare them on.
#pragma once

#include <algorithm>
#include <vector>

#include "livens/dynamics/instant/instant.h"
#include "livens/multibody/model.h"
#include "livens/solvers/instructions.h"
#include "livens/spacetime/elements/rule.h"
#include "unit/multibody/random_states.h"

namespace livens {

struct Comparison {
    bool is_solved = false, has_reference = false;
    bool took_slopes = false;
    int factors_again = 1;                    // of slopes, where the same element is solved once more
    double X = 0, wrench = 0, momentum = 0;   // largest differences, see below
    double worst() const { return std::max({X, wrench, momentum}); }
};

/// The largest difference of two arrays; nan if there is one.
double difference(const std::vector<double>& a, const std::vector<double>& b);
inline double size_of(const std::vector<double>& a)
{
    return difference(a, std::vector<double>(a.size(), 0.0));
}

/// One element of length h by both; `fault` is added to one entry k_AB of the kernel's rule. `kernels`: the
/// model as the kernel sees it, if that is another one. With radau nothing is compared of momenta: its rows
/// balance no moments.
Comparison compare(const Model& model, int degree, double h, double fault = 0, const Model* kernels = nullptr,
                   Points points = Points::lobatto);

/// A tree with perhaps loops, rows stated twice, point masses, springs, dampers and torques.
Model any_mechanism(Random& random);
/// Differences on many random mechanisms, ascending, of those that have a start and that both solve.
std::vector<double> differences(int n, double fault, int& unsolved, Points points = Points::lobatto);

/// With each set of instructions that the processor has.
template <class Act>
void with_all_instructions(const Act& act)
{
    const Instructions before = instructions();
    for (const Instructions set : {Instructions::sse2, Instructions::avx2, Instructions::avx512}) {
        if (!use_instructions(set)) continue;
        SCOPED_TRACE(to_string(set));
        act();
    }
    use_instructions(before);
}

}   // namespace livens
