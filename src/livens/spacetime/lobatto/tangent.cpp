// The exact tangent of an element, block by block.  (docs/theory.md, "The tangent")
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "livens/spacetime/lobatto/element.h"

namespace livens {

/// Sink takes the tangent pair by pair of nodes: open(A, B), then mass(body, factor, H) and block(body_i,
/// body_j, block) in scaled twists in any number, then close().
template <class Sink>
void Element::form_tangent(Sink&& sink)
{
    const int n_nodes = rule_.size();
    double H[9] = {};
    evaluate_load_tangents();
    for (int A = 0; A + 1 < n_nodes; ++A) {
        for (int B = 1; B < n_nodes; ++B) {
            sink.open(A, B);
            const double factor = rule_.k[A * n_nodes + B] / h_;
            for (int b = 0; b < tables_.n_bodies(); ++b) {
                if (tables_.bodies[b].dofs == 6) tables_.spin_mass(b, X(A), X(B), H);
                sink.mass(b, factor, H);
            }
            if (A == B) node_terms(A, sink);
            load_terms(A, B, sink);
            sink.close();
        }
    }
}

/// out <- D_i^T block D_j, 6 x 6 row by row.
void Element::scale_block(int A, int i, int B, int j, const double* block, double* out) const
{
    double columns[36];
    double map[2][36];   // D, column by column
    const int body[2] = {i, j}, at[2] = {A, B};
    for (int side = 0; side < 2; ++side) {
        const auto& b = tables_.bodies[body[side]];
        const double* f = maps(at[side]) + 12 * body[side];
        std::fill(map[side], map[side] + 36, 0.0);
        for (int c = 0; c < 3; ++c) map[side][7 * c] = b.inverse_root_mass;
        if (b.dofs == 3) continue;
        for (int c = 0; c < 3; ++c) {
            const double* w = f + 3 * c;
            double* m = map[side] + 18 + 6 * c;
            m[0] = f[10] * w[2] - f[11] * w[1];
            m[1] = f[11] * w[0] - f[9] * w[2];
            m[2] = f[9] * w[1] - f[10] * w[0];
            for (int r = 0; r < 3; ++r) m[3 + r] = w[r];
        }
    }
    for (int r = 0; r < 6; ++r) {
        for (int c = 0; c < 6; ++c) {
            double sum = 0;
            for (int k = 0; k < 6; ++k) sum += block[6 * r + k] * map[1][6 * c + k];
            columns[6 * r + c] = sum;
        }
    }
    for (int r = 0; r < 6; ++r) {
        for (int c = 0; c < 6; ++c) {
            double sum = 0;
            for (int k = 0; k < 6; ++k) sum += map[0][6 * r + k] * columns[6 * k + c];
            out[6 * r + c] = sum;
        }
    }
}

/// What stands at (A, A) besides mass and loads: turning rows, Hessians of the constraints.
template <class Sink>
void Element::node_terms(int A, Sink&& sink)
{
    double* total = scratch_.data();
    std::copy_n(raw_.data() + node(A), X0_.size(), total);
    subtract_reactions(A, total);
    std::fill(blocks_.begin(), blocks_.end(), 0.0);
    for (int b = 0; b < tables_.n_bodies(); ++b)
        if (tables_.bodies[b].dofs == 6)
            twist::add_geometric(X(A) + 12 * b, total + 12 * b, blocks_.data() + 36 * b, 6);
    double cross[36], scaled[36];
    for (int c = 0; c < tables_.rank; ++c) {
        const auto& table = tables_.rows[bases_[A].rows[c]];
        if (table.form.empty()) continue;
        const double s = -h_ * rule_.weights[A] * lambda_[static_cast<std::size_t>(A * tables_.rank + c)];
        const int i = table.row->body_i, j = table.row->body_j;
        const double *X_i = X(A) + 12 * (table.has_i ? i : j), *X_j = X(A) + 12 * j;
        twist::add_block(table.row->c_jj.data(), X_j, X_j, s, blocks_.data() + 36 * j, 6);
        if (!table.has_i) continue;
        twist::add_block(table.row->c_ii.data(), X_i, X_i, s, blocks_.data() + 36 * i, 6);
        for (int turn = 0; turn < 2; ++turn) {
            std::fill(cross, cross + 36, 0.0);
            if (turn == 0)
                twist::add_block(table.row->c_ij.data(), X_i, X_j, s, cross, 6);
            else
                twist::add_block(transpose(table.row->c_ij).data(), X_j, X_i, s, cross, 6);
            scale_block(A, turn == 0 ? i : j, A, turn == 0 ? j : i, cross, scaled);
            sink.block(turn == 0 ? i : j, turn == 0 ? j : i, scaled);
        }
    }
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        scale_block(A, b, A, b, blocks_.data() + 36 * b, scaled);
        sink.block(b, b, scaled);
    }
}

namespace {

/// block <- N(X_row)^T K N(X_column), column by column.
void reduce_load(const Matrix<12, 12>& K, const double* X_row, const double* X_column, int dofs,
                 double* block)
{
    std::fill(block, block + 36, 0.0);
    for (int j = 0; j < dofs; ++j) {
        double unit[6] = {0, 0, 0, 0, 0, 0}, dX[12], dF[12], row[6] = {0, 0, 0, 0, 0, 0};
        unit[j] = 1;
        twist::columns(X_column, unit, dX);
        for (int r = 0; r < 12; ++r) {
            dF[r] = 0;
            for (int c = 0; c < 12; ++c) dF[r] += K(r, c) * dX[c];
        }
        twist::rows(X_row, dF, row);
        for (int r = 0; r < 6; ++r) block[6 * r + j] = row[r];
    }
}

}   // namespace

/// Size of what a load makes of X and X', in scaled rows: times eps it is what rounding of X does to the
/// rows, also where large terms of the load have cancelled (a stiff spring at rest).
double Element::rounding_of(const Load& load, const LoadArguments& at, const LoadTangent& tangent) const
{
    double size = 0;
    for (int r = 0; r < 2; ++r) {
        if (load.bodies[r] == world) continue;
        const auto& body = tables_.bodies[load.bodies[r]];
        double root = 0;
        for (const double l : body.spin) root = std::max(root, std::abs(l));
        for (int i = 0; i < 12; ++i) {
            double term = 0;
            for (int c = 0; c < 2; ++c)
                for (int k = 0; k < 12; ++k)
                    term += std::abs(tangent.X[r][c](i, k) * at.X[c].a[k]) +
                            std::abs(tangent.V[r][c](i, k) * at.V[c].a[k]);
            size = std::max(size, term * (i < 3 ? body.inverse_root_mass + body.reach * root : root));
        }
    }
    return h_ * size;
}

/// dF/dX and dF/dX' of all loads at the Gauss points.
void Element::evaluate_load_tangents()
{
    const std::size_t n = tables_.loads_with_tangent.size();
    load_tangents_.assign(n * static_cast<std::size_t>(rule_.degree), {});
    load_rounding_ = 0;
    for (int c = 0; n > 0 && c < rule_.degree; ++c) {
        interpolate(c, X_c_.data(), V_c_.data());
        for (std::size_t l = 0; l < n; ++l) {
            const Load& load =
                tables_.model->loads()[static_cast<std::size_t>(tables_.loads_with_tangent[l])];
            LoadArguments arguments;
            arguments.at = {t0_ + rule_.loads.points[c] * h_, Side::middle};
            for (int side = 0; side < 2; ++side) {
                if (load.bodies[side] == world) continue;
                std::copy_n(X_c_.data() + 12 * load.bodies[side], 12, arguments.X[side].a);
                std::copy_n(V_c_.data() + 12 * load.bodies[side], 12, arguments.V[side].a);
            }
            LoadTangent& tangent = load_tangents_[static_cast<std::size_t>(c) * n + l];
            load.tangent(arguments, tangent);
            load_rounding_ = std::max(load_rounding_, rounding_of(load, arguments, tangent));
        }
    }
}

/// sum_c h w_c M_A(s_c) N_A^T [ M_B(s_c) dF/dX + h^-1 M_B'(s_c) dF/dX' ] N_B.
template <class Sink>
void Element::load_terms(int A, int B, Sink&& sink)
{
    const std::size_t n = tables_.loads_with_tangent.size();
    const int n_nodes = rule_.size();
    double block[36], scaled[36];
    for (std::size_t l = 0; l < n; ++l) {
        const Load& load =
            tables_.model->loads()[static_cast<std::size_t>(tables_.loads_with_tangent[l])];
        for (int r = 0; r < 2; ++r) {
            for (int s = 0; s < 2; ++s) {
                const int i = load.bodies[r], j = load.bodies[s];
                if (i == world || j == world) continue;
                Matrix<12, 12> K{};
                for (int c = 0; c < rule_.degree; ++c) {
                    const LoadTangent& tangent = load_tangents_[static_cast<std::size_t>(c) * n + l];
                    const double w = rule_.loads.weights[c] * rule_.M[c * n_nodes + A];
                    const double by_X = load.depends_on_X ? h_ * w * rule_.M[c * n_nodes + B] : 0.0;
                    const double by_V = load.depends_on_V ? w * rule_.dM[c * n_nodes + B] : 0.0;
                    for (int k = 0; k < 144; ++k)
                        K.a[k] += by_X * tangent.X[r][s].a[k] + by_V * tangent.V[r][s].a[k];
                }
                reduce_load(K, X(A) + 12 * i, X(B) + 12 * j, tables_.bodies[j].dofs, block);
                scale_block(A, i, B, j, block, scaled);
                sink.block(i, j, scaled);
            }
        }
    }
}

bool Element::factorise()
{
    struct Sink {
        Elimination& e;
        void open(int A, int B) { e.open(A, B); }
        void mass(int body, double factor, const double* H) { e.add_mass(body, factor, H); }
        void block(int i, int j, const double* values) { e.add(i, j, values); }
        void close() { e.close(); }
    };
    elimination_.begin(orthogonal_);
    form_tangent(Sink{elimination_});
    return elimination_.factorise();
}

namespace {

/// The tangent without elimination, for tests.
struct DenseSink {
    const Tables& tables;
    int n;   // rows and columns
    std::vector<double>& dense;

    int A = 0, B = 1;

    double& at(int i, int r, int j, int c)
    {
        const int row = A * tables.n_twists + tables.bodies[i].first + r;
        const int column = (B - 1) * tables.n_twists + tables.bodies[j].first + c;
        return dense[static_cast<std::size_t>(row * n + column)];
    }
    void open(int row_node, int column_node)
    {
        A = row_node;
        B = column_node;
    }
    void close() {}
    void mass(int body, double factor, const double* H)
    {
        for (int r = 0; r < 3; ++r) at(body, r, body, r) += factor;
        for (int r = 3; r < tables.bodies[body].dofs; ++r)
            for (int c = 3; c < 6; ++c) at(body, r, body, c) += factor * H[(r - 3) + 3 * (c - 3)];
    }
    void block(int i, int j, const double* values)
    {
        for (int r = 0; r < tables.bodies[i].dofs; ++r)
            for (int c = 0; c < tables.bodies[j].dofs; ++c) at(i, r, j, c) += values[6 * r + c];
    }
};

}   // namespace

std::vector<double> Element::tangent()
{
    const int n = rule_.degree * n_;
    std::vector<double> dense(static_cast<std::size_t>(n) * static_cast<std::size_t>(n), 0.0);
    form_tangent(DenseSink{tables_, n, dense});
    return dense;
}

std::vector<double> Element::rows_with(int A, const std::vector<double>& lambda, const double* maps) const
{
    std::vector<double> raw(raw_.begin() + static_cast<std::ptrdiff_t>(node(A)),
                            raw_.begin() + static_cast<std::ptrdiff_t>(node(A) + X0_.size()));
    const ConstraintBasis& basis = A == 0 ? start_->basis : bases_[A];
    for (int c = 0; c < tables_.rank; ++c) {
        const auto& table = tables_.rows[basis.rows[c]];
        const double s = h_ * rule_.weights[A] * lambda[static_cast<std::size_t>(basis.rows[c])];
        for (int side = table.first_side(); side < 2; ++side) {
            double* r = raw.data() + 12 * table.body(side);
            const double* g = basis.gradients.data() + 24 * c + 12 * side;
            for (const int a : table.columns[side])
                for (int i = a; i < a + 3; ++i) r[i] -= s * g[i];
        }
    }
    std::vector<double> q(static_cast<std::size_t>(n_), 0.0);
    tables_.twist_rows(X(A), maps, raw.data(), q.data());
    std::vector<double> scaled(q.size());
    tables_.to_scaled_rows(maps, q.data(), scaled.data());
    if (A == 0)
        for (int i = 0; i < n_; ++i)
            scaled[static_cast<std::size_t>(i)] += start_->momentum[static_cast<std::size_t>(i)];
    return scaled;
}

}   // namespace livens
