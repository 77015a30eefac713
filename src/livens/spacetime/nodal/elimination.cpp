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
#include "livens/spacetime/nodal/mass_products.h"
#include "livens/spacetime/nodal/nodes.h"

namespace livens::inline spacetime_internal {

namespace {

/// Rows of radau(p) are numbered with the node before their own, as a march has them.
int place_of_row(const WindowLayout& layout, int A) { return layout.points == Points::radau ? A - 1 : A; }

BlockStructure structure_of(const WindowLayout& layout, int freedoms)
{
    BlockStructure structure;
    structure.n_rows.assign(static_cast<std::size_t>(layout.n_nodes()), 0);
    for (int A = 0; A < layout.n_nodes(); ++A) {
        structure.n_unknowns.push_back(layout.is_unknown(A) ? freedoms : 0);
        if (layout.is_active(A)) structure.n_rows[place_of_row(layout, A)] = freedoms;
    }
    for (int e = 0; e < layout.n_elements(); ++e)
        structure.elements.push_back({e * layout.degree, (e + 1) * layout.degree});
    if (layout.are_momenta_unknown)
        structure.n_border = structure.n_closing = 2 * freedoms + layout.n_numbers;
    if (layout.part) {
        structure.is_part = true;
        structure.n_closing = layout.part->n_closing;
        structure.n_border += layout.part->n_joins;
    }
    return structure;
}

class NullSpaces;

/// Blocks of the pairs that one thread puts in.
class Pairs final : public TangentSink {
public:
    Pairs(NullSpaces& all, int degree);

    void open(int e, int A, int B) override
    {
        e_ = e;
        A_ = A;
        B_ = B;
        std::ranges::fill(product_, 0.0);
    }
    void mass(int, double, const double*) override {}   // all are taken together
    bool take_masses(int e, const std::vector<double>& k, double h) override;
    void block(int body_i, int body_j, const double* values) override;
    void close() override;

private:
    NullSpaces& all_;
    MassProducts masses_;
    int e_ = 0, A_ = 0, B_ = 1;     // the open pair
    std::vector<double> product_;   // block of the tangent times the null space at B, n x f
    std::vector<double> row_;       // of Z_A^T times it
};

class NullSpaces final : public Elimination {
public:
    NullSpaces(const ModelTables& tables, const WindowLayout& layout, std::unique_ptr<LinearSolver> solver)
        : tables_(tables), f_(tables.freedoms()), structure_(structure_of(layout, tables.freedoms())),
          solver_(std::move(solver)), degree_(layout.degree)
    {
        const auto n = static_cast<std::size_t>(tables.n_twists * f_);
        pairs_.emplace_back(*this, degree_);
        if (f_ == 0) return;   // nothing moves but what is driven
        matrix_.resize(structure_);
        solver_->analyse(structure_);
        z_.resize(n * static_cast<std::size_t>(layout.n_nodes()));
        for_each_item(layout.n_nodes(), least_shared,
                      [&](int A) { std::fill_n(z_.data() + place(A), n, 0.0); });
    }

    void begin(const WindowLayout& layout, const Nodes& nodes) override
    {
        layout_ = &layout;
        stand_at(tables_, nodes);
        while (static_cast<int>(pairs_.size()) < Crew::size()) pairs_.emplace_back(*this, degree_);
        for_each_item(layout.n_nodes(), least_shared, [&](int A) {
            if (layout.is_active(A) || layout.is_unknown(A))
                nodes.basis(A).q.null_space(z_.data() + place(A));
        });
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
    TangentSink* of_thread(int slot) override { return &pairs_[static_cast<std::size_t>(slot)]; }
    void close_with(std::span<const double> closing, const DenseMatrix& by_numbers) override;
    void stand_at(const ModelTables& tables, const Nodes& nodes) override
    {
        bodies_ = &tables.bodies;
        nodes_ = &nodes;
    }
    void carry(double* rows) const override { to_factorised(rows); }
    bool factorise() override { return f_ == 0 || solver_->factorise(matrix_) == Outcome::regular; }
    void solve(std::span<const double> rows, const double* range, double* y) override;
    void last_twist(std::span<const double> conditions, double* y) override
    {
        std::vector<double> ends(static_cast<std::size_t>(2 * f_ + structure_.n_border));
        solver_->solve_closing(conditions, ends);
        to_current(ends.data() + f_, structure_.n_nodes() - 1, y);
    }
    void describe(SolveReport& report) const override
    {
        if (f_ > 0 && structure_.n_elements() > 1) report.factor_entries = solver_->report().factor_entries;
    }
    long long flops() const override { return f_ > 0 ? solver_->report().flops : 0; }
    double least_resisted(std::span<const double> rows, std::vector<double>& y) override;
    void measure_condition(SolveReport& report, const std::function<bool()>& goes_on) override;

private:
    friend class Pairs;

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
    const double* null_space(int A, int body) const
    {
        return z_.data() + place(A) + tables_.bodies[body].first * f_;
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
    BlockMatrix matrix_;
    int degree_;
    std::vector<Pairs> pairs_;   // of each thread
    Room z_;                     // null space of every node, n x f
    std::vector<double> x_;      // reduced unknowns
    std::vector<double> maps_;   // of the nodes where the tangent was formed; empty: bases may turn
};

Pairs::Pairs(NullSpaces& all, int degree)
    : all_(all), masses_(all.tables_, degree + 1),
      product_(static_cast<std::size_t>(all.tables_.n_twists * all.f_ + register_room), 0.0),
      row_(static_cast<std::size_t>(all.f_ + register_room), 0.0)
{}

/// Sets the blocks of all pairs: the product of (A, B) is the transpose of that of (B, A). All nodes but the
/// ends of a window have rows and unknowns.
bool Pairs::take_masses(int e, const std::vector<double>& k, double h)
{
    const WindowLayout& layout = *all_.layout_;
    const int f = all_.f_, p = layout.degree, first = e * p;
    if (f == 0) return true;   // there is no matrix
    const int stride = all_.matrix_.stride(e);
    const auto at = [&](int a, int b) {
        return all_.matrix_.block(e, place_of_row(layout, first + a), first + b);
    };
    std::vector<double> by_row(static_cast<std::size_t>(p + 1)), by_column(by_row);
    for (int part = 0; part < masses_.n_parts(); ++part) {
        for (int a = 0; a <= p; ++a)
            masses_.place(part, a, all_.nodes_->X(first + a), all_.nodes_->maps(first + a),
                          all_.z_.data() + all_.place(first + a));
        for (int a = 0; a <= p; ++a) {
            if (f >= 64) Patience::ask();
            masses_.multiply(a);
            for (int b = 0; b <= p; ++b) {
                by_row[b] = k[a * (p + 1) + b] / h;
                by_column[b] = k[b * (p + 1) + a] / h;
            }
            int begin = layout.is_unknown(first + a) ? a : a + 1,
                end = layout.is_unknown(first + p) ? p : p - 1;
            if (layout.is_active(first + a) && begin <= end)
                masses_.put_rows({at(a, begin), stride, begin, end}, a, by_row.data(), part > 0);
            begin = a + 1;
            end = layout.is_active(first + p) ? p : p - 1;
            if (layout.is_unknown(first + a) && begin <= end)
                masses_.put_columns({at(begin, a), stride, begin, end}, a, by_column.data(), part > 0);
        }
    }
    return true;
}

void Pairs::block(int body_i, int body_j, const double* values)
{
    const BodyTables& bodies = all_.tables_.bodies;
    const double* z = all_.null_space(B_, body_j);
    const int f = all_.f_;
    for (int i = 0; i < bodies[body_i].dofs; ++i) {
        double* __restrict v = product_.data() + (bodies[body_i].first + i) * f;
        for (int k = 0; k < bodies[body_j].dofs; ++k) {
            const double s = values[6 * i + k];
            if (s != 0) subtract_scaled(v, -s, z + k * f, f);
        }
    }
}

/// The block at (A, B) += Z_A^T product.
void Pairs::close()
{
    const int f = all_.f_;
    if (f == 0) return;
    if (f >= 64) Patience::ask();
    const RowFunctions& rows = row_functions();
    const double* z = all_.z_.data() + all_.place(A_);
    double* to = all_.matrix_.block(e_, place_of_row(*all_.layout_, A_), B_);
    const int stride = all_.matrix_.stride(e_);
    for (int i = 0; i < f; ++i, to += stride) {
        rows.product(row_.data(), {z + i, f, product_.data(), f, all_.tables_.n_twists}, f);
        subtract_scaled(to, -1, row_.data(), f);
    }
}

/// P(0) is added at the first node, P(T) taken off at the last.
void NullSpaces::close_with(std::span<const double> closing, const DenseMatrix& by_numbers)
{
    if (f_ == 0) return;
    const int last = structure_.n_elements() - 1, m = structure_.n_border, n_closing = structure_.n_closing;
    const int first_number = m - layout_->n_numbers;
    for (int e = 0; e <= last; ++e) std::ranges::fill(matrix_.border_storage(e), 0.0);
    double *first_row = matrix_.border(0, 0), *last_row = matrix_.border(last, structure_.n_nodes() - 1);
    for (int i = 0; i < f_; ++i) {
        first_row[i * m + i] = 1;
        last_row[i * m + f_ + i] = -1;
    }
    std::vector<double>& rows = matrix_.closing();
    rows.assign(static_cast<std::size_t>(n_closing * (2 * f_ + m)), 0.0);
    const int n_seen = 2 * f_ + first_number;
    for (int i = 0; i < n_closing; ++i)
        std::copy_n(closing.data() + n_seen * i, n_seen, rows.data() + (2 * f_ + m) * i);
    for (int j = 0; j < layout_->n_numbers; ++j) {
        const double* column = by_numbers.column(j).data();
        for (int A = 0; A < structure_.n_nodes(); ++A) {
            double* border = matrix_.border(layout_->first_element(A), A) + first_number + j;
            for (int i = 0; i < f_; ++i) border[i * m] = *column++;
        }
        for (int i = 0; i < n_closing; ++i) rows[(2 * f_ + m) * i + n_seen + j] = *column++;
    }
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

void NullSpaces::solve(std::span<const double> rows, const double*, double* y)
{
    const int n = tables_.n_twists, k = tables_.rank;
    const int n_unknowns = size_of(structure_);
    x_.assign(rows.begin(), rows.end());
    if (structure_.is_part) x_.resize(std::max(x_.size(), static_cast<std::size_t>(n_unknowns)), 0.0);
    if (!maps_.empty()) to_factorised(x_.data());
    if (f_ > 0) solver_->solve(x_);
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
        solver_->solve_transposed(x);
        double* row = x.data();
        for (int A = 0; A < structure_.n_nodes(); ++A)
            for (int i = 0; layout_->is_active(A) && i < f_; ++i) *row++ *= rows[A] * rows[A];
        for (int i = 0; i < structure_.n_closing; ++i)
            *row++ *= rows[structure_.n_nodes() + i] * rows[structure_.n_nodes() + i];
        solver_->solve(x);
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
                                                    std::unique_ptr<LinearSolver> solver)
{
    return std::make_unique<NullSpaces>(tables, layout, std::move(solver));
}

}   // namespace livens::inline spacetime_internal
