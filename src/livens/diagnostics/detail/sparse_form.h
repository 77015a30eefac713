// SPDX-License-Identifier: BSD-3-Clause
// Quadratic forms of configurations that are evaluated many times.
#pragma once

#include <vector>

#include "livens/multibody/joint_coordinates.h"

namespace livens::inline diagnostics_internal {

/// A form by those of its coefficients that are not zero; X and V hold 12 numbers a body.
class SparseForm {
public:
    explicit SparseForm(const PairForm& form);

    double value(const double* X) const;
    double rate(const double* X, const double* V) const;
    /// Its second derivative by time where X'' is A.
    double acceleration(const double* X, const double* V, const double* A) const;

private:
    struct Term {
        int number;
        double value;
    };
    struct Product {
        int x, y;   ///< first numbers of two columns
        double value;
    };

    void add_products(int body, int other, const Matrix4& c, double factor);
    void add_terms(int body, const Matrix34& b);

    double constant_;
    std::vector<Term> terms_;
    std::vector<Product> products_;
};

/// A coordinate of a joint and how far it is from where the bodies are stated. Hidden, as a public header
/// whose names are not may name it first.
class [[gnu::visibility("hidden")]] SparseCoordinate {
public:
    SparseCoordinate(const JointCoordinate& coordinate, const double* stated);

    bool counts_turns() const
    {
        return kind_ == CoordinateKind::angle || kind_ == CoordinateKind::outer_angle;
    }
    /// See is_known().
    bool is_known(const double* X) const { return livens::is_known(kind_, forms_at(X)); }
    /// See coordinate_change(), from the stated bodies; and coordinate_rate().
    double change(const double* X) const;
    double rate(const double* X, const double* V) const;
    double acceleration(const double* X, const double* V, const double* A) const;

private:
    SmoothFunction::Point forms_at(const double* X) const;

    std::vector<SparseForm> forms_;
    std::vector<double> stated_;   ///< forms there
    CoordinateKind kind_;
};

}   // namespace livens::inline diagnostics_internal
