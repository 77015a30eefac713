#include "livens/spacetime/lobatto/whole_matrix.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>
#include <utility>

#include "livens/multibody/constraint_basis.h"
#include "livens/spacetime/lobatto/rule.h"
#include "livens/multibody/twist.h"

namespace livens {

namespace {

/// Column node B shares elements with the row nodes first_row(B)..last_row(B), one after the other, and with
/// no others; the last node of all has no row.
int first_row(int B, int degree) { return (B - 1) / degree * degree; }
int last_row(int B, int degree, int n_nodes) { return std::min((B / degree + 1) * degree, n_nodes - 2); }

/// Forms the matrix column by column in X: a direction dX of node B, what the rows of node A make of it
/// (3 x 4 a body), and its products with the directions of node A. Slower than the blocks of Element, and
/// apart from them: there is one such matrix a solution, and it is made only if asked for.
class Former {
public:
    Former(const Model& model, const Motion& motion)
        : motion_(motion), rule_(lobatto_rule(motion.X.degree)),
          tables_(model, motion.n_rows - static_cast<int>(motion.redundant_rows.size())),
          size_(12 * tables_.bodies.size())
    {
        assert(motion.X.continuous && motion.X.denominators.empty() && motion.n_bodies == model.n_bodies());
        assert(motion.n_rows == 0 ||
               (motion.multipliers.degree == rule_.degree && !motion.multipliers.continuous));
        whole_.n_nodes = motion.n_elements() * rule_.degree + 1;
        whole_.n_twists = tables_.n_twists;
        whole_.freedoms = tables_.freedoms();
        totals_.assign(static_cast<std::size_t>(whole_.n_nodes) * size_, 0.0);
        impulses_.assign(static_cast<std::size_t>(whole_.n_nodes * motion.n_rows), 0.0);
        for (auto* v : {&X_, &V_, &Y_, &dX_}) v->assign(size_, 0.0);
        q_.assign(static_cast<std::size_t>(tables_.n_twists), 0.0);
        const auto columns = static_cast<std::size_t>(rule_.size() * whole_.freedoms);
        for (auto* v : {&moves_, &masses_}) v->assign(columns * size_, 0.0);
    }

    WholeMatrix run()
    {
        choose_directions();
        form_pattern();
        for (int e = 0; e < motion_.n_elements(); ++e) add_element(e);
        for (int A = 1; A + 1 < whole_.n_nodes; ++A) add_node(A);
        return std::move(whole_);
    }

private:
    const double* X(int node) const
    {
        return motion_.X.values.data() + static_cast<std::size_t>(node) * size_;
    }
    double* total(int node) { return totals_.data() + static_cast<std::size_t>(node) * size_; }
    double* impulse(int node)
    {
        return impulses_.data() + static_cast<std::size_t>(node) * static_cast<std::size_t>(motion_.n_rows);
    }
    /// Places of column j at local node B in `moves_` and `masses_`.
    std::size_t place(int B, int j) const
    {
        return static_cast<std::size_t>(B * whole_.freedoms + j) * size_;
    }

    void choose_directions();
    void form_pattern();
    void add_element(int e);
    void move_nodes(int e);
    void add_rows(int e, int A);
    void add_loads(int e);
    void add_block(int e, int A, int B);
    void add_load(std::size_t load, int e, int A, int B, const double* dX);
    void add_node(int A);
    void add_curvature(int A, const double* dX);
    void add_turning(int A, const double* dX);
    void add(int A, int B, int j);
    void twist_rows(int A);

    const Motion& motion_;
    LobattoRule rule_;
    Tables tables_;
    std::size_t size_;                         // 12 a body
    std::vector<double> totals_;               // size_ a node: total rows r_A
    std::vector<double> impulses_;             // rows a node: W_A lambda_A
    std::vector<double> moves_, masses_;       // dX and dX m of all columns of one element
    std::vector<double> X_, V_, dX_;           // size_: X and X' at one Gauss point, one column
    std::vector<double> Y_;                    // size_: what rows make of a column, 3 x 4 a body
    std::vector<double> q_;                    // the same in plain twists
    std::vector<LoadTangent> load_tangents_;   // Gauss point after Gauss point
    WholeMatrix whole_;
};

/// D Z at every node. The rows are chosen node by node, so any rank that the start has is found again; Z then
/// may jump from node to node, which turns rows and columns but changes no singular value.
void Former::choose_directions()
{
    const int n = whole_.n_twists, f = whole_.freedoms;
    ConstraintBasis basis;
    basis.resize(tables_, true);
    std::vector<double> maps(size_, 0.0), y(static_cast<std::size_t>(n));
    std::vector<double> z(static_cast<std::size_t>(n * f));
    whole_.directions.resize(static_cast<std::size_t>(whole_.n_nodes) * z.size());
    double* out = whole_.directions.data();
    for (int A = 0; A < whole_.n_nodes; ++A) {
        tables_.map_twists(X(A), maps.data());
        basis.choose(tables_, X(A), maps.data());
        basis.q.null_space(z.data());
        for (int j = 0; j < f; ++j, out += n) {
            for (int i = 0; i < n; ++i) y[i] = z[i * f + j];
            tables_.to_twist(maps.data(), y.data(), out);
        }
    }
}

/// Dense blocks f x f between all nodes that share an element.
void Former::form_pattern()
{
    const int f = whole_.freedoms;
    SparseMatrix& matrix = whole_.matrix;
    matrix.size = (whole_.n_nodes - 1) * f;
    matrix.column_starts.assign(1, 0);
    for (int B = 1; B < whole_.n_nodes; ++B) {
        const int first = first_row(B, rule_.degree) * f;
        const int end = (last_row(B, rule_.degree, whole_.n_nodes) + 1) * f;
        for (int j = 0; j < f; ++j) {
            for (int row = first; row < end; ++row) matrix.rows.push_back(row);
            matrix.column_starts.push_back(matrix.n_entries());
        }
    }
    matrix.values.assign(matrix.rows.size(), 0.0);
}

/// Kinetic part and loads of element e, its share in the total rows and in the impulses of its joints.
void Former::add_element(int e)
{
    const int p = rule_.degree, n_rows = motion_.n_rows;
    move_nodes(e);
    add_loads(e);
    for (int A = 0; A <= p; ++A) {
        add_rows(e, A);
        for (int r = 0; r < n_rows; ++r)
            impulse(e * p + A)[r] += motion_.mesh.length(e) * rule_.weights[A] *
                                     motion_.multipliers.coefficient(e, A)[static_cast<std::size_t>(r)];
        if (e * p + A == whole_.n_nodes - 1) break;
        for (int B = e == 0 ? 1 : 0; B <= p; ++B) add_block(e, A, B);
    }
}

/// All columns of one element, and these times the mass.
void Former::move_nodes(int e)
{
    for (int B = 0; B <= rule_.degree; ++B) {
        const int node = e * rule_.degree + B;
        for (int j = 0; j < whole_.freedoms; ++j) {
            double* dX = moves_.data() + place(B, j);
            tables_.rates_of(X(node), whole_.direction(node, j).data(), dX);
            tables_.times_mass(dX, 1.0, masses_.data() + place(B, j));
        }
    }
}

/// r_A += h^-1 sum_B k_AB (X_B - X_0) m + h w_A times the weight.
void Former::add_rows(int e, int A)
{
    const double h = motion_.mesh.length(e);
    const double* X0 = X(e * rule_.degree);
    std::fill(dX_.begin(), dX_.end(), 0.0);
    for (int B = 1; B <= rule_.degree; ++B) {
        const double* XB = X(e * rule_.degree + B);
        const double k = rule_.k[A * rule_.size() + B];
        for (std::size_t i = 0; i < size_; ++i) dX_[i] += k * (XB[i] - X0[i]);
    }
    const int node = e * rule_.degree + A;
    tables_.times_mass(dX_.data(), 1 / h, Y_.data());
    tables_.add_weight(h * rule_.weights[A], Y_.data());
    for (std::size_t i = 0; i < size_; ++i) total(node)[i] += Y_[i];
}

/// Loads at the Gauss points in the rows of all nodes, and their tangents.
void Former::add_loads(int e)
{
    const double h = motion_.mesh.length(e);
    const std::size_t n = tables_.loads_with_tangent.size();
    load_tangents_.assign(n * static_cast<std::size_t>(rule_.degree), {});
    for (int c = 0; c < rule_.degree; ++c) {
        const Instant at{motion_.mesh.ends[e] + rule_.loads.points[c] * h, Side::middle};
        std::fill(X_.begin(), X_.end(), 0.0);
        std::fill(V_.begin(), V_.end(), 0.0);
        for (int B = 0; B <= rule_.degree; ++B) {
            const double* XB = X(e * rule_.degree + B);
            const double m = rule_.M[c * rule_.size() + B], d = rule_.dM[c * rule_.size() + B] / h;
            for (std::size_t i = 0; i < size_; ++i) {
                X_[i] += m * XB[i];
                V_[i] += d * XB[i];
            }
        }
        std::fill(Y_.begin(), Y_.end(), 0.0);
        tables_.add_loads(at, X_.data(), V_.data(), h * rule_.loads.weights[c], Y_.data());
        for (int A = 0; A <= rule_.degree; ++A)
            for (std::size_t i = 0; i < size_; ++i)
                total(e * rule_.degree + A)[i] += rule_.M[c * rule_.size() + A] * Y_[i];
        for (std::size_t l = 0; l < n; ++l) {
            const Load& load =
                tables_.model->loads()[static_cast<std::size_t>(tables_.loads_with_tangent[l])];
            LoadArguments arguments;
            arguments.at = at;
            for (int side = 0; side < 2; ++side) {
                if (load.bodies[side] == world) continue;
                std::copy_n(X_.data() + 12 * load.bodies[side], 12, arguments.X[side].a);
                std::copy_n(V_.data() + 12 * load.bodies[side], 12, arguments.V[side].a);
            }
            load.tangent(arguments, load_tangents_[static_cast<std::size_t>(c) * n + l]);
        }
    }
}

/// The share of element e in the block of its nodes A and B.
void Former::add_block(int e, int A, int B)
{
    const int first = e * rule_.degree;
    const double factor = rule_.k[A * rule_.size() + B] / motion_.mesh.length(e);
    for (int j = 0; j < whole_.freedoms; ++j) {
        const double* mass = masses_.data() + place(B, j);
        for (std::size_t i = 0; i < size_; ++i) Y_[i] = factor * mass[i];
        for (std::size_t l = 0; l < tables_.loads_with_tangent.size(); ++l)
            add_load(l, e, A, B, moves_.data() + place(B, j));
        twist_rows(first + A);
        add(first + A, first + B, j);
    }
}

/// Y_ += sum_c h w_c M_A(s_c) (M_B(s_c) dF/dX + h^-1 M_B'(s_c) dF/dX') dX.
void Former::add_load(std::size_t l, int e, int A, int B, const double* dX)
{
    const std::size_t n = tables_.loads_with_tangent.size();
    const Load& load =
        tables_.model->loads()[static_cast<std::size_t>(tables_.loads_with_tangent[l])];
    for (int point = 0; point < rule_.degree; ++point) {
        const int at = point * rule_.size();
        const double w = rule_.loads.weights[point] * rule_.M[at + A];
        const double by_X = motion_.mesh.length(e) * w * rule_.M[at + B], by_V = w * rule_.dM[at + B];
        const LoadTangent& tangent = load_tangents_[static_cast<std::size_t>(point) * n + l];
        for (int r = 0; r < 2; ++r) {
            for (int c = 0; c < 2; ++c) {
                if (load.bodies[r] == world || load.bodies[c] == world) continue;
                double* out = Y_.data() + 12 * load.bodies[r];
                const double* in = dX + 12 * load.bodies[c];
                const auto &K_X = tangent.X[r][c], &K_V = tangent.V[r][c];
                for (int k = 0; k < 12; ++k)
                    for (int i = 0; i < 12; ++i) out[i] += (by_X * K_X(i, k) + by_V * K_V(i, k)) * in[k];
            }
        }
    }
}

/// What stands at (A, A) besides mass and loads: Hessians of the constraints, rows that turn with the body.
void Former::add_node(int A)
{
    double g[24];
    for (int r = 0; r < motion_.n_rows; ++r) {
        const auto& table = tables_.rows[r];
        tables_.gradient(r, X(A), g);
        for (int side = table.first_side(); side < 2; ++side) {
            double* out = total(A) + 12 * table.body(side);
            for (const int a : table.columns[side])
                for (int i = a; i < a + 3; ++i) out[i] -= impulse(A)[r] * g[12 * side + i];
        }
    }
    for (int j = 0; j < whole_.freedoms; ++j) {
        tables_.rates_of(X(A), whole_.direction(A, j).data(), dX_.data());
        std::fill(Y_.begin(), Y_.end(), 0.0);
        add_curvature(A, dX_.data());
        twist_rows(A);
        add_turning(A, dX_.data());
        add(A, A, j);
    }
}

/// Y_ -= W_A sum_r lambda_r dX K_r.
void Former::add_curvature(int A, const double* dX)
{
    for (int r = 0; r < motion_.n_rows; ++r) {
        const auto& table = tables_.rows[r];
        for (const auto& entry : table.form) {
            const double* from = dX + 12 * table.body(entry.from_side) + entry.from;
            double* to = Y_.data() + 12 * table.body(entry.to_side) + entry.to;
            for (int i = 0; i < 3; ++i) to[i] -= impulse(A)[r] * entry.value * from[i];
        }
    }
}

/// q_ += [0 ; sum_a dd_a x r_a]: the rows are taken against directors that move.
void Former::add_turning(int A, const double* dX)
{
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        if (tables_.bodies[b].dofs == 3) continue;
        double turned[6];
        twist::rows(dX + 12 * b, total(A) + 12 * b, turned);
        for (int i = 3; i < 6; ++i) q_[tables_.bodies[b].first + i] += turned[i];
    }
}

/// q_ <- N_A^T Y_.
void Former::twist_rows(int A)
{
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        double* q = q_.data() + tables_.bodies[b].first;
        if (tables_.bodies[b].dofs == 3)
            std::copy_n(Y_.data() + 12 * b, 3, q);
        else
            twist::rows(X(A) + 12 * b, Y_.data() + 12 * b, q);
    }
}

/// Column j of block (A, B) += (D_A Z_A)^T q_.
void Former::add(int A, int B, int j)
{
    const int f = whole_.freedoms, n = whole_.n_twists;
    SparseMatrix& matrix = whole_.matrix;
    double* entries = matrix.values.data() + matrix.column_starts[(B - 1) * f + j] +
                      static_cast<std::ptrdiff_t>((A - first_row(B, rule_.degree)) * f);
    for (int i = 0; i < f; ++i) {
        const std::span<const double> direction = whole_.direction(A, i);
        for (int k = 0; k < n; ++k) entries[i] += direction[static_cast<std::size_t>(k)] * q_[k];
    }
}

/// An upper bound for the entries of the whole matrix.
double most_entries(const Motion& motion, int freedoms)
{
    const double f = freedoms, p = motion.X.degree;
    return motion.n_elements() * p * (2 * p + 1) * f * f;
}

}   // namespace

WholeMatrix whole_matrix(const Model& model, const Motion& motion) { return Former(model, motion).run(); }

void measure_condition(const Model& model, const Motion& motion, SolveReport& report)
{
    const int rank = motion.n_rows - static_cast<int>(motion.redundant_rows.size());
    const int freedoms = Tables(model, rank).freedoms();
    if (freedoms == 0 || motion.n_elements() == 0) return;   // nothing moves: there is no matrix
    if (most_entries(motion, freedoms) > std::numeric_limits<int>::max()) {
        report.notes.push_back("the whole matrix is too large for its condition number; use fewer elements");
        return;
    }
    const WholeMatrix whole = whole_matrix(model, motion);
    SparseLU lu(SparseBackend::eigen);
    lu.analyse(whole.matrix);
    if (!lu.factorise(whole.matrix)) {
        report.notes.push_back(
            "the whole matrix is singular to its factorisation: it has no condition number");
        return;
    }
    const ConditionNumbers condition = condition_numbers(whole.matrix, lu);
    report.condition_1 = report.scaled_condition = condition.one;
    report.condition_2 = condition.two;
    report.factor_entries = lu.factor_entries();
}

}   // namespace livens
