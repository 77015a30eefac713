// SPDX-License-Identifier: BSD-3-Clause
// What is asked of points side by side, as functions of plain arrays for sources that are compiled for
// several sets of instructions. Nothing here may become an inline function that sources with other processor
// flags share.
#pragma once

namespace livens::lanes {
struct LoadProgram;
}

namespace livens::inline diagnostics_internal {

// Numbers are those of X and V, 12 a body, each of four points side by side. A column is named by its first
// number, 12 body + 3 column.

/// value times the number, or the column, at `number`.
struct PointTerm {
    int number;
    double value;
};
/// Gradient of a row by a column: B and the terms up to those of the next.
struct PointColumn {
    int number;
    int first_term;
    double B[3];
    double size;   ///< |B|
};
/// A quadratic form. One that is linear has entries of B; another one has terms.
struct PointRow {
    int first_column;   ///< up to that of the next; others than such forms have none
    int first_entry;    ///< likewise
    bool is_linear;
    double c;
    double inverse_scale;
};
/// Force of a weight on a column.
struct PointWeight {
    int number;
    double force[3];
    double size;
};

/// Lists of a model; of rows, columns and first terms of masses there is one more, behind the last.
struct PointLists {
    int n_numbers, n_rows, n_weights, n_rigid;
    double length;
    const PointRow* rows;
    const PointColumn* columns;
    const PointTerm *terms, *entries;
    const PointWeight* weights;
    const PointTerm* mass;   ///< P of a column is the sum of these of V
    const int* first_mass;   ///< of each column
    const int* rigid;        ///< first numbers of bodies that have directors
};

/// What a model's points are, from 32 bytes on.
struct PointArrays {
    const double *X, *V, *multipliers;
    double* violations;   ///< |Phi| / scale of a row, or |dPhi/dt| / scale, with their signs
    double* sizes;        ///< |x| of columns of X
    double* forces;       ///< on all bodies
};

/// A number of each point.
struct alignas(32) OfPoints {
    static constexpr int width = 4;
    double at[width];

    double& operator[](int lane) { return at[lane]; }
    double operator[](int lane) const { return at[lane]; }
};

/// What is supplied; see Supply.
struct SupplyOfPoints {
    OfPoints linear[3], angular[3], gross, gross_moment;
};

/// The largest of sizes; `spoilt` is not 0 where one was no finite number.
struct LargestOfPoints {
    OfPoints largest, spoilt;
};

/// Of one set of instructions. Arithmetic is that of any other, to the bit: nothing is fused or reordered.
struct PointKernels {
    void (*sizes)(const PointLists&, const PointArrays&);
    void (*weights)(const PointLists&, const PointArrays&, SupplyOfPoints&);
    void (*potential)(const PointLists&, const PointArrays&, OfPoints&);
    void (*kinetic)(const PointLists&, const PointArrays&, OfPoints&);
    void (*moments)(const PointLists&, const PointArrays&, OfPoints*);   ///< three
    void (*joints)(const PointLists&, const PointArrays&, SupplyOfPoints&);
    void (*violations)(const PointLists&, const PointArrays&);
    void (*rates)(const PointLists&, const PointArrays&);
    void (*largest_violation)(const PointLists&, const PointArrays&, LargestOfPoints&);
    void (*largest_of_rigidity)(const PointLists&, const PointArrays&, LargestOfPoints&);
    /// LoadLanes::Run of as many lanes.
    void (*loads)(const lanes::LoadProgram&, const double* X, const double* V, const double* factors,
                  double* F);
    /// out_k = sum over A of M_kA d_A, of n numbers each, for rows k that are `stride` apart in M.
    void (*multiply)(const double* M, int n_rows, int n_columns, int stride, const double* d, int n,
                     double* out);
};

const PointKernels& portable_point_kernels();
const PointKernels* avx2_point_kernels();   ///< null: this is another processor's library
/// The best that this processor has.
const PointKernels& point_kernels();

}   // namespace livens::inline diagnostics_internal
