// SPDX-License-Identifier: BSD-3-Clause
// Rows about centres of mass, by inner products of columns. Those of directors of one body are constants,
// since lanes keep bodies rigid: such terms leave the sums (docs/theory.md, "Without a tangent").
#include "livens/dynamics/lanes/row_sums.h"

#include <algorithm>
#include <utility>

#include "livens/multibody/model.h"

namespace livens::inline dynamics_internal {

/// A linear function of the numbers of a configuration.
struct LinearSum {
    double constant = 0;
    std::vector<lanes::Term> terms{};   // few: a search is all that is needed

    void clear(double with)
    {
        constant = with;
        terms.clear();
    }
    void add(int number, double factor)
    {
        if (factor == 0) return;
        for (lanes::Term& term : terms)
            if (term.number == number) return void(term.factor += factor);
        terms.push_back({number, factor});
    }
};

void SumTable::add(double constant, std::span<const lanes::Term> sum)
{
    const auto first = std::ssize(terms);
    for (const lanes::Term& term : sum)
        if (term.factor != 0) terms.push_back(term);
    std::sort(terms.begin() + first, terms.end(),
              [](const lanes::Term& a, const lanes::Term& b) { return a.number < b.number; });
    begin.push_back(static_cast<int>(terms.size()));
    constants.push_back(constant);
}

/// 1/2 sum K_pq x_p . x_q + sum B_p . x_p + c over the columns p of both sides, four a side, the first of
/// them the centre of mass. Where body i is the world there is one side.
class CentredForm {
public:
    static constexpr int size = 8;
    double K[size][size] = {}, B[size][3] = {}, c = 0;
    int place[size] = {};                      // of each column among the numbers
    bool has_B[size] = {}, has_K[size] = {};   // a joint's row knows few columns
    int n = 0;

    CentredForm(const ModelTables& tables, const QuadraticForm& form, int body_i, int body_j)
        : c(form.c), n(body_i == world ? 4 : 8)
    {
        const int bodies[2] = {body_i == world ? body_j : body_i, body_j}, j = n - 4;
        for (int a = 0; a < 4; ++a) {
            for (int i = 0; j > 0 && i < 3; ++i) B[a][i] = form.b_i(i, a);
            for (int i = 0; i < 3; ++i) B[j + a][i] = form.b_j(i, a);
            for (int b = 0; b < 4; ++b) {
                if (j > 0) K[a][b] = form.c_ii(a, b);
                if (j > 0) K[a][j + b] = form.c_ij(a, b);
                if (j > 0) K[j + b][a] = form.c_ij(a, b);
                K[j + a][j + b] = form.c_jj(a, b);
            }
        }
        for (int p = 0; p < n; ++p) place[p] = 12 * bodies[p / 4] + 3 * (p % 4);
        for (int side = 0; side < n; side += 4) {   // x_0 is the reference point no more
            const double* center = tables.bodies[bodies[side / 4]].center;
            for (int a = 0; a < 3; ++a) {
                const double shift = center[a];
                if (shift == 0) continue;
                for (int i = 0; i < 3; ++i) B[side + 1 + a][i] -= shift * B[side][i];
                for (int q = 0; q < n; ++q) K[side + 1 + a][q] -= shift * K[side][q];
                for (int q = 0; q < n; ++q) K[q][side + 1 + a] -= shift * K[q][side];
            }
        }
        for (int p = 0; p < n; ++p) {
            has_B[p] = B[p][0] != 0 || B[p][1] != 0 || B[p][2] != 0;
            has_K[p] = std::any_of(K[p], K[p] + n, [](double k) { return k != 0; });
        }
    }
    /// Their inner product is 1 or 0.
    bool are_directors_of_one(int p, int q) const { return p / 4 == q / 4 && p % 4 != 0 && q % 4 != 0; }
};

RowSums::RowSums(const ModelTables& tables, const std::vector<int>& rows)
{
    for (int b = 0; b < tables.n_bodies(); ++b) add_body(tables, b);
    LinearSum room;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const ConstraintRow& row = *tables.rows[rows[r]].row;
        const CentredForm form(tables, row, row.body_i, row.body_j);
        const int first_entry = static_cast<int>(twist.size());
        for (int side = 0; side < form.n; side += 4)
            add_gradient(form, side, room, [&](int of) {
                entries.add(room.constant, room.terms);
                twist.push_back(of);
            });
        add_value(form, room, violations);
        for (const Drive& drive : row.drives)
            add_form({tables, drive.form, row.body_i, row.body_j}, first_entry, room);
        for (const PairForm& q : row.coordinates)
            add_form({tables, q, q.body_i, q.body_j}, first_entry, room);
        begin.push_back(static_cast<int>(twist.size()));
        if (row.is_quadratic()) continue;
        forms.add(row);
        with_forms.push_back(static_cast<int>(r));
    }
}

/// One more form with a weight; the row's entries begin at `first_entry`.
void RowSums::add_form(const CentredForm& form, int first_entry, LinearSum& room)
{
    const int number = static_cast<int>(form_values.constants.size());
    for (int side = 0; side < form.n; side += 4)
        add_gradient(form, side, room, [&](int of) {
            const auto found = std::find(twist.begin() + first_entry, twist.end(), of);
            const int entry = static_cast<int>(found - twist.begin());
            if (found == twist.end()) {
                entries.add(0, {});
                twist.push_back(of);
            }
            bool is_first = true;
            for (auto other = weighted.rbegin(); other != weighted.rend() && other->entry >= first_entry;
                 ++other)
                is_first = is_first && other->entry != entry;
            weighted.push_back({entry, number, is_first});
            form_gradients.add(room.constant, room.terms);
        });
    add_value(form, room, form_values);
}

void RowSums::add_body(const ModelTables& tables, int b)
{
    const BodyTable& table = tables.bodies[b];
    lanes::Body body;
    body.first = table.first;
    body.dofs = table.dofs;
    body.principal = table.principal;
    for (const Load& load : tables.model->loads())
        body.loaded = body.loaded || std::ranges::find(load.bodies, b) != load.bodies.end();
    body.inverse_root_mass = table.inverse_root_mass;
    body.root_mass = 1 / table.inverse_root_mass;
    for (int i = 0; i < 3; ++i) body.weight[i] = table.inverse_root_mass * table.weight[i];
    std::copy_n(table.euler, 9, body.euler);
    std::copy_n(table.spin, 9, body.spin);
    if (body.dofs == 6) {
        Matrix3 spin{};
        std::copy_n(table.spin, 9, spin.a);
        const Matrix3 L = transpose(inverse(spin));
        std::copy_n(L.a, 9, body.root_spin);
        Matrix3 E{};
        std::copy_n(table.euler, 9, E.a);
        const Matrix3 still = -determinant(spin) * (transpose(L) * E);   // of norm one but for rounding
        if (norm(still) < 2) std::copy_n(still.a, 9, body.still);
    }
    bodies.push_back(body);
}

/// The number of the inner product of two columns.
int RowSums::product(int x, int y)
{
    if (x > y) std::swap(x, y);
    // one of those that the last rows have, or new
    const auto recent = products.rbegin() + std::min<std::ptrdiff_t>(32, std::ssize(products));
    const auto found = std::find_if(products.rbegin(), recent,
                                    [=](const lanes::Columns& of) { return of.x == x && of.y == y; });
    if (found == recent) {
        products.push_back({x, y});
        return first_product() + static_cast<int>(products.size()) - 1;
    }
    return first_product() + static_cast<int>(products.rend() - found) - 1;
}

/// sum += factor * d_at . g_p, the gradient by column p being g_p = sum_q K_pq x_q + B_p.
void RowSums::add_moment(const CentredForm& form, int at, int p, double factor, LinearSum& sum)
{
    for (int i = 0; form.has_B[p] && i < 3; ++i) sum.add(form.place[at] + i, factor * form.B[p][i]);
    for (int q = 0; form.has_K[p] && q < form.n; ++q) {
        if (form.K[p][q] == 0) continue;
        if (form.are_directors_of_one(at, q))
            sum.constant += at == q ? factor * form.K[p][q] : 0;
        else
            sum.add(product(form.place[at], form.place[q]), factor * form.K[p][q]);
    }
}

/// A side's gradient by scaled twists: g_0 / sqrt(M), and L^-1 t with the torque in body axes
/// t_a = d_c . g_b - d_b . g_c. take(twist) of what is not zero, in `sum`.
template <class Take>
void RowSums::add_gradient(const CentredForm& form, int side, LinearSum& sum, const Take& take)
{
    const auto add_entry = [&](int of) {
        const bool has_terms =
            std::ranges::any_of(sum.terms, [](const auto& term) { return term.factor != 0; });
        if (has_terms || sum.constant != 0) take(of);
    };
    const lanes::Body& body = bodies[form.place[side] / 12];
    for (int i = 0; i < 3; ++i) {
        sum.clear(body.inverse_root_mass * form.B[side][i]);
        for (int q = 0; form.has_K[side] && q < form.n; ++q)
            sum.add(form.place[q] + i, body.inverse_root_mass * form.K[side][q]);
        add_entry(body.first + i);
    }
    for (int a = 0; body.dofs == 6 && a < 3; ++a) {
        sum.clear(0);
        for (int e = 0; e < 3; ++e) {
            const int b = side + 1 + (e + 1) % 3, c = side + 1 + (e + 2) % 3;
            const double s = body.spin[3 * a + e];
            if (s == 0) continue;
            add_moment(form, c, b, s, sum);
            add_moment(form, b, c, -s, sum);
        }
        add_entry(body.first + 3 + a);
    }
}

/// The lower triangle of the symmetric K, with half of its diagonal, is 1/2 sum K_pq x_p . x_q.
void RowSums::add_value(const CentredForm& form, LinearSum& phi, SumTable& to)
{
    phi.clear(form.c);
    for (int p = 0; p < form.n; ++p) {
        for (int i = 0; form.has_B[p] && i < 3; ++i) phi.add(form.place[p] + i, form.B[p][i]);
        for (int q = 0; form.has_K[p] && q <= p; ++q) {
            const double k = p == q ? 0.5 * form.K[p][q] : form.K[p][q];
            if (k == 0) continue;
            if (form.are_directors_of_one(p, q))
                phi.constant += p == q ? k : 0;
            else
                phi.add(product(form.place[p], form.place[q]), k);
        }
    }
    to.add(phi.constant, phi.terms);
}

}   // namespace livens::inline dynamics_internal
