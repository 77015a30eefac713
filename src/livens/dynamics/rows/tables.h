// SPDX-License-Identifier: BSD-3-Clause
// The model as the engine reads it: flat tables, unknowns numbered.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "livens/dynamics/rows/body_tables.h"
#include "livens/dynamics/rows/load_tables.h"
#include "livens/dynamics/rows/row_tables.h"

namespace livens::inline dynamics_internal {

class LoadProgram;
class RowPattern;

/// The last pattern that was made of a model's rows, and its loads in lanes.
struct KnownPattern {
    std::shared_ptr<const RowPattern> last;
    std::array<std::shared_ptr<const LoadProgram>, 5> loads;   ///< see RecordedLoads
};

/// Tables made once per solution.
struct ModelTables {
    /// `independent`: rows of the joints, of full rank, that hold for all others.
    /// `with_rigidity`: rigidity_rows() of the bodies follow the rows of the joints.
    /// `known`: of the same model, see Prepared; null: these tables have their own.
    ModelTables(const Model& the_model, std::vector<int> independent, bool with_rigidity = false,
                std::shared_ptr<KnownPattern> known = nullptr);
    ModelTables(const ModelTables&) = delete;
    ModelTables& operator=(const ModelTables&) = delete;

    const Model* model;
    BodyTables bodies;
    RowTables rows;
    LoadTables loads;
    double length;
    int n_twists;                   ///< six a body and three a point mass
    std::vector<int> independent;   ///< rows that are solved for, until choose_rows() finds them unfit
    int rank = 0;                   ///< how many they are
    std::vector<std::array<int, 2>> reaches;   ///< of rows: their first twist, and behind their last one
    std::shared_ptr<KnownPattern> known_pattern;

    int n_bodies() const { return bodies.n_bodies(); }
    int n_rows() const;   ///< of joints
    int freedoms() const { return n_twists - rank; }
    /// The first row of the joints that is not among these and is off by more than so much of its scale; -1:
    /// there is none.
    int first_violated_beside(const std::vector<int>& held, Instant at, const double* X, double most) const;

    /// Force and moment about the centre of mass of one side's gradient, 6 numbers.
    void wrench(int r, int side, const double* X, const double* maps, const double* g, double* q) const;
    /// The same as a row of scaled twists, 6 numbers (0 for what a point has not).
    void scaled_wrench(int r, int side, const double* X, const double* g, double* y) const;
    /// q += factor times these of all sides, n_twists numbers.
    void add_wrenches(int r, const double* X, const double* maps, const double* g, double factor,
                      double* q) const;
    /// The gradient as rows of scaled twists, n_twists numbers. Their square, which does not depend on which
    /// of two bodies comes first.
    double scaled_gradient(int r, const double* X, const double* maps, const double* g, double* out) const;
};

}   // namespace livens::inline dynamics_internal
