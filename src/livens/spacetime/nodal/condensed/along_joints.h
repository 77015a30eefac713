// SPDX-License-Identifier: BSD-3-Clause
// Elements of a window condensed to their ends along the joints, for a solver of what is left between ends.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "livens/solvers/dense_matrix.h"
#include "livens/solvers/linear_solver.h"
#include "livens/spacetime/nodal/condensed/element_factor.h"
#include "livens/spacetime/nodal/pair_blocks.h"

namespace livens::inline spacetime_internal {

class ElementSink;

/// Of the reduced systems that Elimination describes: rows Z_A^T r at active nodes, unknowns at unknown ones.
class AlongJoints {
public:
    /// Whether bodies are held as branches of trees, and there is something inside of elements of lobatto.
    static bool fits(const ModelTables& tables, const WindowLayout& layout);
    /// The same, and elimination along joints takes less than of dense blocks.
    static bool pays(const ModelTables& tables, const WindowLayout& layout);

    /// Of what fits. `between`: elements from end to end alone.
    AlongJoints(const ModelTables& tables, const BlockStructure& between,
                std::unique_ptr<LinearSolver> solver);
    ~AlongJoints();

    /// References must outlive what is formed and solved.
    void begin(const WindowLayout& layout, const Nodes& nodes, const NullSpacesOfNodes& z);
    TangentSink& of_thread(int slot);
    /// To be completed by borders and closing rows.
    BlockMatrix& between() { return between_; }
    /// Rows of all nodes by unknown numbers, whose columns in the border are the last ones.
    void take_numbers(const DenseMatrix& by_numbers);
    bool factorise();
    /// As of LinearSolver, of all nodes.
    void solve(std::span<double> x, bool is_transposed);
    const LinearSolver& solver() const { return *solver_; }
    long long n_entries() const;

private:
    friend class ElementSink;

    struct OfElement {
        ElementFactor factor;
        Numbers inside, ends;   // of a solution
        bool is_good = false;
    };

    int n_inside() const { return layout_->degree - 1; }
    void to_inside(std::span<const double> x, int first, int e, Numbers& inside) const;
    void from_inside(const Numbers& inside, int first, int e, std::span<double> x) const;
    Numbers go_in(std::span<const double> x, bool is_transposed);
    void go_out(const Numbers& y, bool is_transposed, std::span<double> x);
    void pass_numbers(const Numbers& y, std::span<double> rows) const;
    int first_node(bool of_rows) const;

    const ModelTables& tables_;
    JointForest forest_;
    BlockStructure structure_;
    std::unique_ptr<LinearSolver> solver_;
    BlockMatrix between_;
    const WindowLayout* layout_ = nullptr;
    const Nodes* nodes_ = nullptr;
    NullSpacesOfNodes z_;
    std::vector<OfElement> elements_;
    std::vector<std::unique_ptr<ElementSink>> sinks_;   // of each thread
    DenseMatrix by_numbers_;
};

}   // namespace livens::inline spacetime_internal
