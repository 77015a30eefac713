// SPDX-License-Identifier: BSD-3-Clause
// The motion of solved blocks, field by field.
#pragma once

#include <map>
#include <memory>

#include "livens/multibody/motion.h"
#include "livens/spacetime/method.h"

namespace livens::mixed {

struct Coordinates;
class Equations;
struct Fields;

/// Collects blocks, in any order, and makes a motion of those that stand side by side.
///
/// Momenta at block ends are those that are handed on: the law's, which a part in the range of G^T may belong
/// to, as they close the balances. Velocities there are the nearest that keep joints and bodies. At other
/// element ends both are those of the field P.
class MotionOfBlocks {
public:
    MotionOfBlocks(const Coordinates& coordinates, const TimeMesh& mesh, const Mixed& method);

    /// Whether a block begins and ends where momenta are handed on; else its ends are those of elements.
    struct HandsOn {
        bool at_start = true, at_end = true;
    };
    /// A block that begins with element `first`.
    void add(int first, const Equations& equations, const Fields& fields, HandsOn hands_on);
    std::size_t n_blocks() const { return blocks_.size(); }
    /// `torn`: positions may jump between blocks. Without blocks the motion is the given start alone.
    Motion take(bool torn, const State& start);

private:
    struct Block {
        std::vector<double> X, P, multipliers, rigidity,
            denominators;                       ///< nodes of all elements, none shared
        std::vector<Matrix34> P_start, P_end;   ///< empty: nothing is handed on there
        int n_elements = 0;
    };
    void append_multipliers(const std::vector<double>& lambda, Block& block) const;
    void append_block(const Block& block, bool is_first, Motion& motion) const;
    void append_end(const double* X, const std::vector<Matrix34>& P, bool of_block, Motion& motion) const;

    const Coordinates& coordinates_;
    const TimeMesh& mesh_;
    const Mixed& method_;
    int gauss_points_ = 0;
    std::map<int, Block> blocks_;
};

}   // namespace livens::mixed
