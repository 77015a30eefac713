// SPDX-License-Identifier: BSD-3-Clause
// Rows and unknowns of all nodes stand in the null spaces there. Those inside of elements go to scaled twists
// of bodies by Z_A and are eliminated along the joints (ElementFactor); what is left between ends is a system
// of blocks for another solver, with the border and closing rows. From the ends twists inside follow, and go
// back to the null spaces (docs/theory.md, "The whole matrix of lobatto", Along the joints).
#include "livens/spacetime/nodal/condensed/along_joints.h"

#include <algorithm>
#include <utility>

#include "livens/solvers/crew.h"
#include "livens/solvers/patience.h"
#include "livens/solvers/short_rows.h"
#include "livens/spacetime/nodal/condensed/element_sink.h"
#include "livens/spacetime/nodal/nodes.h"

namespace livens {

bool AlongJoints::fits(const ModelTables& tables, const WindowLayout& layout)
{
    const int q = layout.degree - 1;
    return q > 0 && layout.points == Points::lobatto && (layout.n_elements() > 1 || !layout.is_march()) &&
           lanes::functions(q) != nullptr && JointForest::of(tables).has_value();
}

/// By the products of both ways; those of blocks of a body are shorter rows.
bool AlongJoints::pays(const ModelTables& tables, const WindowLayout& layout)
{
    if (!fits(tables, layout)) return false;
    const JointForest forest = *JointForest::of(tables);
    const double q = layout.degree - 1, f = tables.freedoms(), ends = 2 * f, inside = q * f,
                 dense = inside * inside * (inside / 3 + ends) + inside * ends * ends +
                         tables.n_twists * f * f * (q + 2) * (q + 2) / 2;
    double along = 0;
    for (const JointForest::Body& body : forest.bodies) {
        const double d = body.d, own = body.f * q,
                     above = body.parent == world ? 0 : forest.bodies[body.parent].d * q;
        along += d * d * q * own + above * d * (d * q + above) + above * above * own + own * own * own / 3 +
                 own * (own + above) * (ends + above) + own * above * ends + own * ends * ends +
                 2 * d * ends * (above + own);
    }
    return 1.5 * along < dense;
}

AlongJoints::AlongJoints(const ModelTables& tables, const BlockStructure& between,
                         std::unique_ptr<LinearSolver> solver)
    : tables_(tables), forest_(*JointForest::of(tables)), structure_(between), solver_(std::move(solver)),
      elements_(static_cast<std::size_t>(between.n_elements()))
{
    between_.resize(structure_);
    solver_->analyse(structure_);
}

AlongJoints::~AlongJoints() = default;

void AlongJoints::begin(const WindowLayout& layout, const Nodes& nodes, const NullSpacesOfNodes& z)
{
    layout_ = &layout;
    nodes_ = &nodes;
    z_ = z;
    by_numbers_ = {};
    between_.clear();
    while (static_cast<int>(sinks_.size()) < Crew::size())
        sinks_.push_back(std::make_unique<ElementSink>(*this, layout.degree));
    for (const std::unique_ptr<ElementSink>& sink : sinks_) sink->forget();
}

TangentSink& AlongJoints::of_thread(int slot) { return *sinks_[static_cast<std::size_t>(slot)]; }

bool AlongJoints::factorise()
{
    const bool are_good = std::ranges::all_of(elements_, &OfElement::is_good);
    return are_good && solver_->factorise(between_) == Outcome::regular;
}

/// The first node that has rows, or unknowns.
int AlongJoints::first_node(bool of_rows) const
{
    return (of_rows ? layout_->is_active(0) : layout_->is_unknown(0)) ? 0 : 1;
}

/// Rows, or unknowns, of the nodes inside: in the null spaces there, of all nodes in x, and by bodies.
void AlongJoints::to_inside(std::span<const double> x, int first, int e, Numbers& inside) const
{
    const RowFunctions& sums = row_functions();
    const int f = z_.f, q = n_inside();
    inside.resize(static_cast<std::size_t>(elements_[e].factor.n_numbers()));
    for (int a = 0; a < q; ++a) {
        const int A = e * layout_->degree + 1 + a;
        const double* z = z_.at(A);
        for (int b = 0; b < tables_.n_bodies(); ++b)
            for (int i = 0; i < tables_.bodies[b].dofs; ++i, z += f)
                inside[elements_[e].factor.first(b) + i * q + a] =
                    inner(sums, z, x.data() + (A - first) * f, f);
    }
}

void AlongJoints::from_inside(const Numbers& inside, int first, int e, std::span<double> x) const
{
    const RowFunctions& sums = row_functions();
    const int f = z_.f, q = n_inside();
    for (int a = 0; a < q; ++a) {
        const int A = e * layout_->degree + 1 + a;
        const double* z = z_.at(A);
        double* const to = x.data() + (A - first) * f;
        std::fill_n(to, f, 0.0);
        for (int b = 0; b < tables_.n_bodies(); ++b)
            for (int i = 0; i < tables_.bodies[b].dofs; ++i, z += f)
                subtract_scaled(sums, to, -inside[elements_[e].factor.first(b) + i * q + a], z, f);
    }
}

/// What is asked of the ends, once the inside of elements has taken its part.
Numbers AlongJoints::go_in(std::span<const double> x, bool is_transposed)
{
    const int f = z_.f, p = layout_->degree, n = structure_.n_elements();
    const bool of_rows = !is_transposed;
    const int first = first_node(of_rows);
    const auto has = [&](int A) { return of_rows ? layout_->is_active(A) : layout_->is_unknown(A); };
    for_each_item(n, least_elements(tables_), [&](int e) {
        OfElement& of = elements_[e];
        to_inside(x, first, e, of.inside);
        of.ends.assign(static_cast<std::size_t>(of_rows ? between_.n_rows(e) : between_.n_columns(e)), 0.0);
        of.factor.go_inwards(forest_, is_transposed, of.inside, of.ends.data());
    });
    Numbers y;
    for (int E = 0; E <= n; ++E)
        if (has(E * p))
            y.insert(y.end(), x.begin() + (E * p - first) * f, x.begin() + (E * p - first + 1) * f);
    for (int e = 0; e < n; ++e) {
        const double* ends = elements_[e].ends.data();
        for (const int E : {e, e + 1}) {
            if (!has(E * p)) continue;
            for (int i = 0; i < f; ++i) y[(E - first) * f + i] += ends[i];
            ends += f;
        }
    }
    const int last = n * p, behind = (last - first + (has(last) ? 1 : 0)) * f;
    y.insert(y.end(), x.begin() + behind,
             x.begin() + behind + (of_rows ? structure_.n_closing : structure_.n_border));
    return y;
}

void AlongJoints::go_out(const Numbers& y, bool is_transposed, std::span<double> x)
{
    const int f = z_.f, p = layout_->degree, n = structure_.n_elements();
    const bool of_rows = is_transposed;
    const int first = first_node(of_rows);
    const auto has = [&](int A) { return of_rows ? layout_->is_active(A) : layout_->is_unknown(A); };
    for_each_item(n, least_elements(tables_), [&](int e) {
        OfElement& of = elements_[e];
        of.ends.clear();
        for (const int E : {e, e + 1})
            if (has(E * p))
                of.ends.insert(of.ends.end(), y.begin() + (E - first) * f, y.begin() + (E - first + 1) * f);
        of.factor.go_outwards(forest_, is_transposed, of.ends.data(), of.inside);
        from_inside(of.inside, first, e, x);
    });
    for (int E = 0; E <= n; ++E)
        if (has(E * p)) std::copy_n(y.begin() + (E - first) * f, f, x.begin() + (E * p - first) * f);
    const int last = n * p, n_ends = n - first + (has(last) ? 1 : 0);
    std::copy_n(y.begin() + n_ends * f, of_rows ? structure_.n_closing : structure_.n_border,
                x.begin() + (last - first + (has(last) ? 1 : 0)) * f);
}

/// A column has entries in rows inside as well: what elimination makes of these is added to those of the ends
/// in the border. Columns are kept for solve(). Elements without a factor are refused by factorise().
void AlongJoints::take_numbers(const DenseMatrix& by_numbers)
{
    by_numbers_ = by_numbers;
    const int f = z_.f, p = layout_->degree, m = structure_.n_border, first = first_node(true);
    for (int j = 0; j < by_numbers_.cols; ++j) {
        const int place = m - by_numbers_.cols + j;
        for (int e = 0; e < structure_.n_elements(); ++e) {
            OfElement& of = elements_[e];
            if (!of.is_good) return;
            to_inside(by_numbers_.column(j), first, e, of.inside);
            of.ends.assign(static_cast<std::size_t>(between_.n_rows(e)), 0.0);
            of.factor.go_inwards(forest_, false, of.inside, of.ends.data());
            const double* ends = of.ends.data();
            for (const int E : {e, e + 1}) {
                if (!layout_->is_active(E * p)) continue;
                double* border = between_.border(e, E) + place;
                for (int i = 0; i < f; ++i) border[i * m] += *ends++;
            }
        }
    }
}

/// Unknown numbers are seen from inside of elements, too: rows less what those in y make of them.
void AlongJoints::pass_numbers(const Numbers& y, std::span<double> x) const
{
    const int n = by_numbers_.cols, f = z_.f, first = first_node(true);
    const double* numbers = y.data() + y.size() - n;
    for (int j = 0; j < n; ++j) {
        const std::span<const double> column = by_numbers_.column(j);
        for (int A = 1; A < layout_->n_nodes() - 1; ++A)
            for (int i = 0; i < f && A % layout_->degree != 0; ++i)
                x[(A - first) * f + i] -= numbers[j] * column[(A - first) * f + i];
    }
}

/// With unknown numbers the inside is gone through twice: y tells the numbers, these change the rows inside,
/// and the second go_in() leaves in the elements what go_out() asks for; its y is not needed. Transposed, y
/// lacks what the columns of numbers see of the inside, which therefore comes first, for ends at rest.
void AlongJoints::solve(std::span<double> x, bool is_transposed)
{
    Numbers y = go_in(x, is_transposed);
    if (!is_transposed) {
        solver_->solve(y);
        if (by_numbers_.cols > 0) {
            pass_numbers(y, x);
            go_in(x, false);
        }
        return go_out(y, false, x);
    }
    if (by_numbers_.cols > 0) {
        // what the inside alone asks for
        Numbers inside(x.begin(), x.end());
        go_out(Numbers(y.size(), 0.0), true, inside);
        const int n = by_numbers_.cols, f = z_.f, first = first_node(true);
        for (int j = 0; j < n; ++j) {
            double sum = 0;
            for (int A = 1; A < layout_->n_nodes() - 1; ++A)
                for (int i = 0; i < f && A % layout_->degree != 0; ++i)
                    sum += by_numbers_.column(j)[(A - first) * f + i] * inside[(A - first) * f + i];
            y[y.size() - n + j] -= sum;
        }
        go_in(x, true);
    }
    solver_->solve_transposed(y);
    go_out(y, true, x);
}

long long AlongJoints::n_entries() const
{
    long long n = solver_->report().factor_entries;
    for (const OfElement& of : elements_) n += of.factor.n_entries();
    return n;
}

}   // namespace livens
