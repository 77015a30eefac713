// SPDX-License-Identifier: BSD-3-Clause
// The numbers of X that the elements `mixed` take for unknowns, and the rows that hold them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "livens/dynamics/rows/tables.h"

namespace livens::mixed {

/// One number of the gradient of a row: entry `component` (0..11, columns of X) on side `side`.
struct GradientEntry {
    int row;
    int side;
    int component;
    int coordinate;   ///< that it is the derivative by
};

/// One number of the Hessian of a row: d2 Phi / dx_i dx_j.
struct HessianEntry {
    int row;
    int coordinate_i;
    int coordinate_j;
    double value;
};

/// Twelve numbers a rigid body, three a point mass, one after the other. Rows are the independent ones of the
/// joints, then six of rigidity a rigid body. Arrays `X`, `V`, `F` hold 12 numbers a body, as the tables do.
/// Drives are refused, see check_method(): rows are asked without an instant.
struct Coordinates {
    /// Throws InputError `mass-singular` for a body whose m cannot be inverted.
    explicit Coordinates(const ModelTables& tables);

    const ModelTables& tables;
    std::vector<int> first;   ///< coordinate of each body
    int size = 0;
    std::vector<int> rows;                 ///< of the tables
    std::vector<Matrix4> inverse_masses;   ///< of each body
    std::vector<double> root_masses;       ///< square root of m_cc for each coordinate
    // What can differ from zero, so that matrices have no entries where it cannot.
    std::vector<GradientEntry> gradient_entries;   ///< row after row
    std::vector<HessianEntry> hessian_entries;

    int n_bodies() const { return static_cast<int>(first.size()); }
    int n_rows() const { return static_cast<int>(rows.size()); }
    int n_numbers(int body) const { return tables.bodies[body].dofs == 3 ? 3 : 12; }
    int n_X() const { return 12 * n_bodies(); }
    /// "joint 'elbow' (row 'x')", "the rigidity of body 'upper'".
    std::string row_name(int row) const;

    /// X from coordinates, zero outside the first column for point masses; and back.
    void spread(const double* coordinates, double* X) const;
    void gather(const double* X, double* coordinates) const;
    std::vector<double> gather(std::span<const Matrix34> X) const;
    std::vector<Matrix34> bodies(const double* coordinates) const;

    /// The numbers of gradient_entries at X.
    void gradients(const double* X, std::vector<double>& values) const;
    /// F <- forces of loads and gravity less the reactions sum lambda G.
    void forces(double t, const double* X, const double* V, const double* lambda, double* F) const;
    /// Multipliers of the acceleration-level equation X'' m + G^T lambda = F, G X'' = -tr(X' K X'^T), at a
    /// state; nan where it is singular.
    std::vector<double> multipliers(const State& state) const;

private:
    std::vector<double> multipliers_of_few(const std::vector<double>& F, std::vector<double> right_side,
                                           const std::vector<double>& values) const;
};

}   // namespace livens::mixed
