#include <algorithm>
#include <cmath>

#include "livens/io/detail/results_layout.h"

namespace livens {

namespace {

/// A nan stays: std::max would drop it.
void raise_to(double& largest, double value)
{
    if (std::isnan(value) || value > largest) largest = value;
}

/// Largest |Phi| / scale over the rows of all joints.
double joint_violation(const Model& model, std::span<const Matrix34> X)
{
    double largest = 0;
    for (int r = 0; r < model.n_rows(); ++r) {
        const ConstraintRow& row = model.row(r);
        const Matrix34& X_i = row.body_i == world ? world_configuration : X[row.body_i];
        raise_to(largest, std::abs(constraint_value(row, X_i, X[row.body_j])) / row.scale);
    }
    return largest;
}

/// Largest |Phi| over the rigidity rows of all bodies  (P4).
double rigidity_violation(const std::vector<ConstraintRow>& rigidity, std::span<const Matrix34> X)
{
    double largest = 0;
    for (const ConstraintRow& row : rigidity) {
        raise_to(largest, std::abs(constraint_value(row, {}, X[row.body_j])));
    }
    return largest;
}

}   // namespace

void write_violations(NetcdfWriter& file, const Model& model, const Motion& motion, DerivedNumbers& owner)
{
    if (motion.X.empty()) return;
    std::vector<ConstraintRow> rigidity;
    for (int b = 0; b < model.n_bodies(); ++b) {
        if (model.bodies()[b].is_point) continue;
        for (ConstraintRow& row : rigidity_rows(b)) rigidity.push_back(std::move(row));
    }
    const std::size_t n_values = static_cast<std::size_t>(motion.X.n_values);
    std::vector<double> joints, bodies;
    std::vector<Matrix34> X(model.bodies().size());
    for (std::size_t at = 0; at < motion.X.values.size(); at += n_values) {
        for (std::size_t b = 0; b < X.size(); ++b)
            std::copy_n(motion.X.values.data() + at + 12 * b, 12, X[b].data());
        joints.push_back(joint_violation(model, X));
        bodies.push_back(rigidity_violation(rigidity, X));
    }
    const auto put = [&](const char* name, const char* long_name, std::vector<double>& values) {
        owner.doubles.push_back(std::move(values));
        file.variable({name, {"X_node"}, "1", "none", long_name},
                      std::span<const double>(owner.doubles.back()));
    };
    if (model.n_rows() > 0) put("joint_violation", "largest |Phi| / scale of the joints' rows", joints);
    if (!rigidity.empty()) put("rigidity_violation", "largest |Phi| of the bodies' rigidity", bodies);
}

}   // namespace livens
