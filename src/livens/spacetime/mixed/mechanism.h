// The model as the elements `mixed` see it: numbers of X, rows of joints and of rigidity.
#pragma once

#include <string>
#include <vector>

#include "livens/multibody/assembly.h"
#include "livens/multibody/model.h"

namespace livens::mixed {

/// One number of the gradient of a row: entry `component` (0..11, columns of X) on `body`.
struct GradientEntry {
    int row;
    int body;
    int component;
};

/// One number of the Hessian of a row: d2 Phi / dX_(body_i, component_i) dX_(body_j, component_j).
struct HessianEntry {
    int row;
    int coordinate_i;
    int coordinate_j;
    double value;
};

struct Row {
    ConstraintRow form;
    int model_row;   ///< -1: rigidity
};

/// Bodies are the numbers of X: twelve a rigid body, three a point mass, one after the other. Rows are the
/// independent ones of the joints, then six of rigidity a rigid body.
class Mechanism {
public:
    /// Throws InputError `mass-singular` for a body whose m cannot be inverted.
    Mechanism(const Model& model, const std::vector<int>& independent_rows);

    const Model& model;
    std::vector<int> first;   ///< coordinate of each body
    int n_coordinates = 0;
    std::vector<Row> rows;
    std::vector<Matrix34> weights;   ///< F of gravity, for each body
    std::vector<Matrix4> inverse_masses;
    std::vector<double> root_masses;   ///< square root of m_cc for each coordinate

    // What can differ from zero, so that matrices have no entries where it cannot.
    std::vector<GradientEntry> gradient_entries;
    std::vector<HessianEntry> hessian_entries;

    int n_bodies() const { return static_cast<int>(first.size()); }
    int n_rows() const { return static_cast<int>(rows.size()); }
    int n_numbers(int body) const { return model.bodies()[body].is_point ? 3 : 12; }
    /// "joint 'elbow' (row 'x')", "the rigidity of body 'upper'".
    std::string row_name(int row) const;

    /// Bodies from their coordinates; zero outside the first column for point masses.
    void unstack(const double* coordinates, std::vector<Matrix34>& X) const;
    void stack(const std::vector<Matrix34>& X, double* coordinates) const;

    /// Forces of loads and gravity less the reactions sum lambda G. Returns the name of a load that is not
    /// finite, empty if all are.
    const std::string& forces(double t, const std::vector<Matrix34>& X, const std::vector<Matrix34>& V,
                              const std::vector<double>& lambda, std::vector<Matrix34>& F) const;
    /// What a load is asked with.
    LoadArguments arguments(const Load& load, double t, const std::vector<Matrix34>& X,
                            const std::vector<Matrix34>& V) const;
    /// Gradients of a row on its two bodies; that of the world is zero.
    void gradient(int row, const std::vector<Matrix34>& X, Matrix34& g_i, Matrix34& g_j) const;
    double value(int row, const std::vector<Matrix34>& X) const;
    /// Multipliers of the acceleration-level equation X'' m + G^T lambda = F, G X'' = -tr(X' K X'^T), at
    /// every one of the given states; nan where it is singular.
    std::vector<std::vector<double>> multipliers(const std::vector<State>& states) const;

private:
    void list_gradient(int row);
    void list_hessian(int row);
};

}   // namespace livens::mixed
