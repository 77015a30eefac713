// SPDX-License-Identifier: BSD-3-Clause
// Steps that know the slopes of loads and of joints' forces.
#pragma once

#include "livens/spacetime/nodal/kernel/reduced_tangent.h"
#include "livens/spacetime/nodal/kernel/tree_tangent.h"

namespace livens::inline spacetime_internal {

/// J = h^-1 K + h S dF/dX + C dF/dX' - d(G^T mu)/dX in scaled twists of all nodes of one element, on what the
/// constraints leave free: of few freedoms at once, of many along the joints. A step by it need not be exact:
/// rows and constraints are those of the kernel, and tell when it is done.
class KernelTangent {
public:
    KernelTangent(const ModelTables& tables, const ElementRule& rule, const lanes::Functions* functions);

    /// For the rows of this pattern.
    void use(const std::shared_ptr<const RowPattern>& pattern);
    /// At the numbers, gradients, multipliers and load points of the kernel. False: singular, or not finite.
    bool factorise(const WindowLayout& layout, const JointFactor& start, const lanes::Values& nodes);
    /// step <- - J^-1 rows, in lanes.
    void propose(const lanes::Values& nodes);
    /// All freedoms are solved for at once.
    bool is_reduced() const { return is_reduced_; }
    /// Steps by loads alone, which cost less, shrank too little: joints' forces count from now on.
    void ask_joints() { slopes_.has_joints = true; }
    /// In steps of free bodies of the same element: of a factor, and of a step with it.
    struct Cost {
        double factor, step;
    };
    /// As measured with AVX2 on chains, figures, arms and wheels of 1 to 30 freedoms.
    Cost cost() const;
    /// Of the last factor.
    const TangentSlopes& slopes() const { return slopes_; }

private:
    int degree_, n_twists_, n_reduced_ = 0;
    TangentSlopes slopes_;
    ReducedTangent reduced_;
    TreeTangent tree_;
    bool is_reduced_ = false;
};

}   // namespace livens::inline spacetime_internal
