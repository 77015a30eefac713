// SPDX-License-Identifier: BSD-3-Clause
// The tangent of an element on the few freedoms of a mechanism, loops or not.
#pragma once

#include <memory>
#include <vector>

#include "livens/dynamics/lanes/joint_factor.h"
#include "livens/spacetime/elements/kernel_functions.h"
#include "livens/spacetime/nodal/kernel/tangent_slopes.h"

namespace livens::inline spacetime_internal {

/// Z_A^T J_AB Z_B with an orthonormal basis Z of what constraints leave free at each node: some twists as
/// they are projected, all nodes side by side. It takes (p f)^2 numbers.
class ReducedTangent {
public:
    /// References must outlive it.
    ReducedTangent(const ModelTables& tables, const ElementRule& rule, const lanes::Functions* functions);

    void use(const std::shared_ptr<const RowPattern>& pattern);
    /// See KernelTangent.
    bool factorise(const WindowLayout& layout, const JointFactor& start, const lanes::Values& nodes,
                   TangentSlopes& slopes);
    void propose(const lanes::Values& nodes);

private:
    void choose(const JointFactor& start);
    bool find_bases(const JointFactor& start, const lanes::Values& nodes);
    bool orthonormalise(int node);
    void add_mass(double h);
    void add_load(const SlopesOfPair& pair, const double* slopes, const Numbers& in_time, double factor);
    void add_product(const SlopesOfProduct& of, const LoadSlopes& slopes, double h);
    void add_at_node(int node, const SlopesOfPair& pair);
    double* z(int node, int k) { return bases_.data() + static_cast<std::ptrdiff_t>((node * f_ + k) * n_); }
    double& entry(int A, int k, int l, int m)
    {
        return factor_.A[static_cast<std::size_t>((A * f_ + k) * rule_.degree * f_ + l * f_ + m)];
    }

    const ModelTables& tables_;
    const ElementRule& rule_;
    const lanes::Functions* functions_;
    std::shared_ptr<const RowPattern> pattern_;
    int n_ = 0, f_ = 0;
    std::vector<int> chosen_;   // twists
    Numbers bases_;             // of nodes 0 .. p
    AlignedDoubles work_;       // in lanes: a step, violations and multipliers
    SquareFactor factor_;
    Numbers theta_;
    Numbers directions_, by_X_, by_V_;   // of a product, at all nodes
    Numbers columns_;                    // of a load: twists, forces, sums of a row and factors in time
};

}   // namespace livens::inline spacetime_internal
