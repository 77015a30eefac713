// SPDX-License-Identifier: BSD-3-Clause
// The exact tangent of a window, block by block.
#pragma once

#include <algorithm>
#include <vector>

#include "livens/dynamics/rows/tables.h"
#include "livens/spacetime/elements/window_layout.h"

namespace livens::inline spacetime_internal {

class Nodes;
class NodalRows;

/// Elements whose tangent a thread has at least: of many freedoms one is worth waking it.
inline int least_elements(const ModelTables& tables)
{
    constexpr int many = 16;
    return tables.freedoms() < many ? least_shared : 1;
}

/// Takes a tangent pair by pair of nodes A, B that share element e: open(), then mass() and block() in any
/// number, then close(). Where two elements share both nodes their blocks add up.
class TangentSink {
public:
    virtual ~TangentSink() = default;
    virtual void open(int e, int A, int B) = 0;
    /// factor [1 0 ; 0 H] for a body with itself, H 3 x 3 column by column.
    virtual void mass(int body, double factor, const double* H) = 0;
    /// NodalRows of body i by twists of body j: 6 x 6 row by row.
    virtual void block(int body_i, int body_j, const double* values) = 0;
    virtual void close() = 0;
    /// All pairs of element e were there.
    virtual void finish(int /*e*/) {}
    /// In place of all mass() of element e, before its pairs are opened, of which those that have nothing
    /// else then are not: the factor of its nodes a, b is k_ab / h, k row by row. False: it is not taken.
    virtual bool take_masses(int /*e*/, const std::vector<double>& /*k*/, double /*h*/) { return false; }
    /// The sink of a thread, for elements of its own; null: all come from one thread, to this.
    virtual TangentSink* of_thread(int /*slot*/) { return nullptr; }
};

/// d(rows at active nodes)/d(twists of unknown nodes), rows and twists scaled by the maps of their nodes,
/// which are not differentiated (docs/theory.md, "The tangent").
class Tangent {
public:
    Tangent(const ModelTables& tables, const ElementRule& rule);

    void form(const WindowLayout& layout, const Nodes& nodes, const NodalRows& rows, TangentSink& sink);

    /// Size of what loads make of X and X' in scaled rows, of the last form(): times eps it is what rounding
    /// of X does to the rows, also where large terms of a load have cancelled (a stiff spring at rest).
    double load_rounding() const
    {
        return load_roundings_.empty() ? 0
                                       : *std::max_element(load_roundings_.begin(), load_roundings_.end());
    }
    double load_rounding(int e) const { return load_roundings_.empty() ? 0 : load_roundings_[e]; }

private:
    /// Of a thread, with its sink.
    struct Workspace {
        TangentSink* sink = nullptr;
        std::vector<LoadTangent> loads;    // of one element: those with tangents, Gauss point after point
        std::vector<double> blocks;        // 36 a body
        std::vector<double> total, X, V;   // 12 a body
    };
    /// What a tangent is made of.
    struct Point {
        const WindowLayout& layout;
        const Nodes& nodes;
        const NodalRows& rows;
    };
    Workspace workspace() const;
    void form_element(const Point& of, int e, Workspace& at);
    void evaluate_loads(const Point& of, int e, Workspace& at);
    void add_masses(const Point& of, int e, int a, int b, Workspace& at) const;
    void add_node_terms(const Point& of, int A, Workspace& at) const;
    void add_constraints(const Point& of, int A, Workspace& at) const;
    void add_loads(const Point& of, int e, int a, int b, Workspace& at) const;

    const ModelTables& tables_;
    const ElementRule& rule_;
    std::vector<Workspace> workspaces_;
    std::vector<double> load_roundings_;   // of the elements
};

}   // namespace livens::inline spacetime_internal
