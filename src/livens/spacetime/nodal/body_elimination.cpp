// SPDX-License-Identifier: BSD-3-Clause
// The tangent of one element of degree 1, which couples no bodies: body by body, with a Schur complement of
// the constraints (docs/theory.md, "Newton's iteration").
#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include "livens/solvers/dense.h"
#include "livens/spacetime/nodal/elimination.h"
#include "livens/spacetime/nodal/nodes.h"

namespace livens::inline spacetime_internal {

namespace {

/// J y + Y_0 nu = x, Y_1^T y = 0, with the Schur complement Y_1^T J^-1 Y_0.
class Bodies final : public Elimination {
public:
    explicit Bodies(const ModelTables& tables) : tables_(tables)
    {
        const auto n = static_cast<std::size_t>(tables.n_twists);
        work_.assign(n, 0.0);
        inverse_.resize(tables.bodies.size());
        columns_.assign(n * static_cast<std::size_t>(tables.rank), 0.0);
        schur_.resize(tables.rank);
    }

    void begin(const WindowLayout&, const Nodes& nodes) override
    {
        first_ = &nodes.basis(0).q;
        last_ = &nodes.basis(1).q;
    }
    void open(int, int, int) override {}
    void mass(int body, double factor, const double* H) override
    {
        factor_ = factor;
        if (tables_.bodies[body].dofs == 3) return;
        Matrix3 h;
        std::copy(H, H + 9, h.a);
        inverse_[body] = inverse(h);
    }
    void block(int, int, const double*) override {}   // nothing but mass comes to this element
    void close() override {}
    bool factorise() override;
    void solve(std::span<const double> rows, const double* range, double* y) override;
    bool takes_constraints() const override { return true; }
    void describe(SolveReport&) const override {}
    void measure_condition(SolveReport&, const std::function<bool()>&) override {}

private:
    void invert_bodies(double* y) const;

    const ModelTables& tables_;
    const OrthogonalBasis *first_ = nullptr, *last_ = nullptr;
    double factor_ = 1;              // of the mass
    std::vector<Matrix3> inverse_;   // of H
    DenseLU schur_;
    std::vector<double> columns_;   // J^-1 Y_0, rank columns of length n
    std::vector<double> work_;
};

/// y <- J^-1 y, body by body.
void Bodies::invert_bodies(double* y) const
{
    const double s = 1 / factor_;
    for (int body = 0; body < tables_.n_bodies(); ++body) {
        double* v = y + tables_.bodies[body].first;
        for (int i = 0; i < 3; ++i) v[i] *= s;
        if (tables_.bodies[body].dofs == 3) continue;
        const double* h = inverse_[body].a;
        const double a = s * v[3], b = s * v[4], c = s * v[5];
        for (int i = 0; i < 3; ++i) v[3 + i] = h[i] * a + h[3 + i] * b + h[6 + i] * c;
    }
}

bool Bodies::factorise()
{
    const int k = tables_.rank, n = tables_.n_twists;
    for (int c = 0; c < k; ++c) {
        double* column = columns_.data() + c * n;
        std::fill(column, column + n, 0.0);
        column[c] = 1;
        first_->apply(column);
        invert_bodies(column);
        std::copy(column, column + n, work_.data());
        last_->apply_transposed(work_.data());
        for (int r = 0; r < k; ++r) schur_.row(r)[c] = work_[r];
    }
    return factor_ != 0 && schur_.factorise();
}

/// Y_1^T y = range in place of 0 where violations are to be taken off with the same step.
void Bodies::solve(std::span<const double> rows, const double* range, double* y)
{
    const int k = tables_.rank, n = tables_.n_twists;
    double* nu = work_.data();
    std::fill(y, y + k, 0.0);
    std::copy(rows.begin(), rows.end(), y + k);
    first_->apply(y);
    invert_bodies(y);
    std::copy(y, y + n, nu);
    last_->apply_transposed(nu);
    for (int c = 0; range != nullptr && c < k; ++c) nu[c] -= range[c];
    schur_.solve(nu);
    for (int c = 0; c < k; ++c)
        for (int i = 0; i < n; ++i) y[i] -= nu[c] * columns_[c * n + i];
}

}   // namespace

std::unique_ptr<Elimination> body_elimination(const ModelTables& tables)
{
    return std::make_unique<Bodies>(tables);
}

}   // namespace livens::inline spacetime_internal
