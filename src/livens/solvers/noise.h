// SPDX-License-Identifier: BSD-3-Clause
// Numbers at random that are the same on every machine and in each run.  [Marsaglia 2003, xorshift]
#pragma once

#include <cstdint>

namespace livens::inline solvers_internal {

/// Numbers between -1 and 1.
class Noise {
public:
    double operator()()
    {
        state_ ^= state_ << 13, state_ ^= state_ >> 7, state_ ^= state_ << 17;
        return 2 * static_cast<double>(state_ >> 11) / 9007199254740992.0 - 1;
    }

private:
    std::uint64_t state_ = 0x9e3779b97f4a7c15u;
};

}   // namespace livens::inline solvers_internal
