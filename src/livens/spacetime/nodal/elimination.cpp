// SPDX-License-Identifier: BSD-3-Clause
// Z_A^T D^T J_AB D Z_B: the tangent on what the constraints leave free, for a solver of blocks
// (docs/theory.md, "Eliminating the joint multipliers", "The whole matrix of lobatto").
#include "livens/spacetime/nodal/elimination.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "livens/dynamics/instant/instant.h"
#include "livens/solvers/crew.h"
#include "livens/solvers/dense.h"
#include "livens/solvers/patience.h"
#include "livens/solvers/room.h"
#include "livens/solvers/short_rows.h"
#include "livens/spacetime/nodal/carried.h"
#include "livens/spacetime/nodal/condensed/along_joints.h"
#include "livens/spacetime/nodal/nodes.h"
#include "livens/spacetime/nodal/pair_blocks.h"
#include "livens/spacetime/nodal/window_blocks.h"

namespace livens::inline spacetime_internal {

namespace {

class NullSpaces final : public Elimination {
public:
    /// One of `solver` and `inside`.
    NullSpaces(const ModelTables& tables, const WindowLayout& layout, std::unique_ptr<LinearSolver> solver,
               std::unique_ptr<AlongJoints> inside)
        : tables_(tables), f_(tables.freedoms()), structure_(structure_of(layout, tables.freedoms())),
          solver_(std::move(solver)), inside_(std::move(inside)), degree_(layout.degree)
    {
        const auto n = static_cast<std::size_t>(tables.n_twists * f_);
        pairs_.emplace_back(tables, degree_, matrix_);
        if (f_ == 0) return;   // nothing moves but what is driven
        if (inside_ == nullptr) {
            matrix_.resize(structure_);
            solver_->analyse(structure_);
        }
        z_.resize(n * static_cast<std::size_t>(layout.n_nodes()));
        for_each_item(layout.n_nodes(), least_shared,
                      [&](int A) { std::fill_n(z_.data() + place(A), n, 0.0); });
    }

    void begin(const WindowLayout& layout, const Nodes& nodes) override
    {
        layout_ = &layout;
        stand_at(tables_, nodes);
        while (static_cast<int>(pairs_.size()) < Crew::size()) pairs_.emplace_back(tables_, degree_, matrix_);
        for_each_item(layout.n_nodes(), least_shared, [&](int A) {
            if (layout.is_active(A) || layout.is_unknown(A))
                nodes.basis(A).q.null_space(z_.data() + place(A));
        });
        const NullSpacesOfNodes z{z_.data(), tables_.n_twists, f_};
        for (PairBlocks& pairs : pairs_) pairs.begin(layout, nodes, z);
        if (inside_ != nullptr) inside_->begin(layout, nodes, z);
        maps_.clear();
        if (!layout.is_march()) maps_.assign(nodes.maps(0), nodes.maps(layout.n_nodes()));
    }
    void open(int e, int A, int B) override { pairs_[0].open(e, A, B); }
    void mass(int body, double factor, const double* H) override { pairs_[0].mass(body, factor, H); }
    void block(int i, int j, const double* values) override { pairs_[0].block(i, j, values); }
    void close() override { pairs_[0].close(); }
    bool take_masses(int e, const std::vector<double>& k, double h) override
    {
        return pairs_[0].take_masses(e, k, h);
    }
    TangentSink* of_thread(int slot) override
    {
        if (inside_ != nullptr) return &inside_->of_thread(slot);
        return &pairs_[static_cast<std::size_t>(slot)];
    }
    void close_with(std::span<const double> closing, const DenseMatrix& by_numbers) override;
    void stand_at(const ModelTables& tables, const Nodes& nodes) override
    {
        bodies_ = &tables.bodies;
        nodes_ = &nodes;
    }
    void carry(double* rows) const override { to_factorised(rows); }
    bool factorise() override
    {
        if (inside_ != nullptr) return inside_->factorise();
        return f_ == 0 || solver_->factorise(matrix_) == Outcome::regular;
    }
    bool is_whole() const override { return inside_ == nullptr; }
    void solve(std::span<const double> rows, const double* range, double* y) override;
    void last_twist(std::span<const double> conditions, double* y) override
    {
        std::vector<double> ends(static_cast<std::size_t>(2 * f_ + structure_.n_border));
        solver().solve_closing(conditions, ends);
        to_current(ends.data() + f_, structure_.n_nodes() - 1, y);
    }
    void describe(SolveReport& report) const override
    {
        if (f_ > 0 && structure_.n_elements() > 1)
            report.factor_entries =
                inside_ != nullptr ? inside_->n_entries() : solver_->report().factor_entries;
    }
    long long flops() const override { return f_ > 0 && is_whole() ? solver_->report().flops : 0; }
    double least_resisted(std::span<const double> rows, std::vector<double>& y) override;
    void measure_condition(SolveReport& report, const std::function<bool()>& goes_on) override;

private:
    const LinearSolver& solver() const { return inside_ != nullptr ? inside_->solver() : *solver_; }
    void apply_inverse(std::span<double> x, bool is_transposed)
    {
        if (inside_ != nullptr) return inside_->solve(x, is_transposed);
        is_transposed ? solver_->solve_transposed(x) : solver_->solve(x);
    }
    LinearMap applying(void (LinearSolver::*apply)(std::span<double>) const) const
    {
        return [this, apply](std::span<const double> x, std::span<double> y) {
            std::copy(x.begin(), x.end(), y.begin());
            ((*solver_).*apply)(y);
        };
    }
    std::size_t place(int A) const
    {
        return static_cast<std::size_t>(A) * static_cast<std::size_t>(tables_.n_twists * f_);
    }
    const double* maps_at(int A) const
    {
        return maps_.data() + 12 * tables_.bodies.size() * static_cast<std::size_t>(A);
    }
    void to_factorised(double* x) const;
    void to_current(const double* x, int A, double* y) const;

    const ModelTables& tables_;
    const WindowLayout* layout_ = nullptr;   // current
    const Nodes* nodes_ = nullptr;           // rows and increments belong to them, and to these bodies
    const BodyTables* bodies_ = nullptr;
    int f_;
    BlockStructure structure_;
    std::unique_ptr<LinearSolver> solver_;
    std::unique_ptr<AlongJoints> inside_;   // in place of the solver and its matrix
    BlockMatrix matrix_;
    int degree_;
    std::vector<PairBlocks> pairs_;   // of each thread
    Room z_;                     // null space of every node, n x f
    std::vector<double> x_;      // reduced unknowns
    std::vector<double> maps_;   // of the nodes where the tangent was formed; empty: bases may turn
};

/// P(0) is added at the first node, P(T) taken off at the last.
void NullSpaces::close_with(std::span<const double> closing, const DenseMatrix& by_numbers)
{
    if (f_ == 0) return;
    const int last = structure_.n_elements() - 1, m = structure_.n_border, n_closing = structure_.n_closing;
    const int first_number = m - layout_->n_numbers, every = is_whole() ? 1 : layout_->degree;
    BlockMatrix& matrix = is_whole() ? matrix_ : inside_->between();
    for (int e = 0; e <= last; ++e) std::ranges::fill(matrix.border_storage(e), 0.0);
    double *first_row = matrix.border(0, 0),
           *last_row = matrix.border(last, (structure_.n_nodes() - 1) / every);
    for (int i = 0; i < f_; ++i) {
        first_row[i * m + i] = 1;
        last_row[i * m + f_ + i] = -1;
    }
    std::vector<double>& rows = matrix.closing();
    rows.assign(static_cast<std::size_t>(n_closing * (2 * f_ + m)), 0.0);
    const int n_seen = 2 * f_ + first_number;
    for (int i = 0; i < n_closing; ++i)
        std::copy_n(closing.data() + n_seen * i, n_seen, rows.data() + (2 * f_ + m) * i);
    for (int j = 0; j < layout_->n_numbers; ++j) {
        const double* column = by_numbers.column(j).data();
        for (int A = 0; A < structure_.n_nodes(); ++A, column += f_) {
            if (A % every != 0) continue;   // inside
            double* border = matrix.border(layout_->first_element(A), A / every) + first_number + j;
            for (int i = 0; i < f_; ++i) border[i * m] = column[i];
        }
        for (int i = 0; i < n_closing; ++i) rows[(2 * f_ + m) * i + n_seen + j] = *column++;
    }
    if (inside_ != nullptr && layout_->n_numbers > 0) inside_->take_numbers(by_numbers);
}

/// Reduced rows at the nodes as they stand now, to those that the factors belong to. Where a node has moved,
/// its null space and its axes have turned: rows in turned coordinates would not fall with a step, however
/// short, off a solution.
void NullSpaces::to_factorised(double* x) const
{
    const int first = layout_->is_active(0) ? 0 : 1;
    in_shares(structure_.n_nodes(), least_shared, [&](int, int begin, int end) {
        const RowFunctions& rows = row_functions();
        const int n = tables_.n_twists, k = tables_.rank, f = f_;
        std::vector<double> row(static_cast<std::size_t>(n));
        for (int A = begin; A < end; ++A) {
            if (!layout_->is_active(A)) continue;
            double* const of_node = x + static_cast<std::ptrdiff_t>(A - first) * f;
            std::fill_n(row.begin(), k, 0.0);
            std::copy_n(of_node, f, row.begin() + k);
            nodes_->basis(A).q.apply(row.data());
            carry_rows({*bodies_, nodes_->maps(A)}, {tables_.bodies, maps_at(A)}, row.data());
            std::fill_n(of_node, f, 0.0);
            const double *z = z_.data() + place(A), *value = row.data();
            for (int i = 0; i < n; ++i) subtract_scaled(rows, of_node, -value[i], z + i * f, f);
        }
    });
}

/// A twist of node A in the null space that the factors belong to, in the axes of where it stands now. It is
/// not turned into the null space there: increments are compared with those before.
void NullSpaces::to_current(const double* x, int A, double* y) const
{
    const double* z = z_.data() + place(A);
    const RowFunctions& rows = row_functions();
    for (int i = 0; i < tables_.n_twists; ++i) y[i] = inner(rows, z + i * f_, x, f_);
    carry_twists({tables_.bodies, maps_at(A)}, {*bodies_, nodes_->maps(A)}, y);
}

/// Rows and increments of a march are in the null spaces where nodes stand; those of a window, whose steps
/// may be long, are carried to where the factors were made, and back.
void NullSpaces::solve(std::span<const double> rows, const double*, double* y)
{
    const int n = tables_.n_twists, k = tables_.rank;
    const int n_unknowns = size_of(structure_);
    x_.assign(rows.begin(), rows.end());
    if (structure_.is_part) x_.resize(std::max(x_.size(), static_cast<std::size_t>(n_unknowns)), 0.0);
    if (!maps_.empty()) to_factorised(x_.data());
    if (f_ > 0) apply_inverse(x_, false);
    const int first = layout_->is_unknown(0) ? 0 : 1;
    for_each_item(structure_.n_nodes(), least_shared, [&](int A) {
        if (!layout_->is_unknown(A)) return;
        const double* x = x_.data() + static_cast<std::ptrdiff_t>(A - first) * f_;
        double* to = y + static_cast<std::ptrdiff_t>(A - first) * n;
        if (!maps_.empty()) return to_current(x, A, to);
        std::fill(to, to + k, 0.0);
        std::copy(x, x + f_, to + k);
        nodes_->basis(A).q.apply(to);
    });
    const int last = structure_.n_nodes() - 1, n_unknown = last + (layout_->is_unknown(last) ? 1 : 0) - first;
    std::copy_n(x_.begin() + n_unknowns - structure_.n_border, structure_.n_border,
                y + static_cast<std::ptrdiff_t>(n_unknown) * n);
}

/// A few powers of A^-1 W W A^-T, W the sizes of rows: the largest singular value of A^-1 W, from below, and
/// its unknowns.
double NullSpaces::least_resisted(std::span<const double> rows, std::vector<double>& y)
{
    const int n = size_of(structure_);
    if (f_ == 0 || n == 0) return 0;
    std::vector<double> x(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) x[i] = 1 + 0.1 * (i % 7);   // with a share of any
    const auto normalise = [&x] {
        double sum = 0;
        for (const double v : x) sum += v * v;
        const double norm = std::sqrt(sum);
        for (double& v : x) v /= norm;
        return norm;
    };
    double square = 0;
    normalise();
    for (int round = 0; round < 2; ++round) {
        apply_inverse(x, true);
        double* row = x.data();
        for (int A = 0; A < structure_.n_nodes(); ++A)
            for (int i = 0; layout_->is_active(A) && i < f_; ++i) *row++ *= rows[A] * rows[A];
        for (int i = 0; i < structure_.n_closing; ++i)
            *row++ *= rows[structure_.n_nodes() + i] * rows[structure_.n_nodes() + i];
        apply_inverse(x, false);
        square = normalise();
    }
    y.assign(static_cast<std::size_t>((n - structure_.n_border) / f_ * tables_.n_twists), 0.0);
    const double* from = x.data();
    double* to = y.data();
    for (int A = 0; A < structure_.n_nodes(); ++A) {
        if (!layout_->is_unknown(A)) continue;
        to_current(from, A, to);
        from += f_;
        to += tables_.n_twists;
    }
    y.insert(y.end(), x.end() - layout_->n_numbers, x.end());
    return std::sqrt(square);
}

/// Nothing is scaled: rows and unknowns are in mass-orthonormal coordinates. The 2-norm knows no choice of
/// units, axes and bases; the 1-norm feels the bases of the free motions (a factor of f^2 at the very most).
/// The blocks go before vectors come.
void NullSpaces::measure_condition(SolveReport& report, const std::function<bool()>& goes_on)
{
    const SparseMatrix whole = to_sparse(structure_, matrix_);
    if (solver_->factorise(matrix_) != Outcome::regular) {
        report.notes.push_back(
            "the whole matrix is singular to its factorisation: it has no condition number");
        return;
    }
    matrix_ = {};
    z_ = {};
    const ConditionNumbers condition = condition_numbers(whole, applying(&LinearSolver::solve),
                                                         applying(&LinearSolver::solve_transposed), goes_on);
    report.condition_1 = report.scaled_condition = condition.one;
    report.condition_2 = condition.two;
    report.factor_entries = solver_->report().factor_entries;
}

}   // namespace

std::unique_ptr<Elimination> null_space_elimination(const ModelTables& tables, const WindowLayout& layout,
                                                    std::unique_ptr<LinearSolver> solver, Inside inside)
{
    const bool is_wanted =
        inside == Inside::along_joints || (inside == Inside::as_it_pays && AlongJoints::pays(tables, layout));
    std::unique_ptr<AlongJoints> along;
    if (is_wanted && tables.freedoms() > 0 && AlongJoints::fits(tables, layout))
        along = std::make_unique<AlongJoints>(
            tables, structure_of(layout, tables.freedoms(), layout.degree), std::move(solver));
    return std::make_unique<NullSpaces>(tables, layout, std::move(solver), std::move(along));
}

}   // namespace livens::inline spacetime_internal
