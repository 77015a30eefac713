// The linear algebra of one element, behind a small interface so that it can be replaced: blocks of the
// tangent go in, increments of the reduced unknowns come out.
#pragma once

#include <vector>

#include "livens/solvers/dense.h"
#include "livens/multibody/tables.h"

namespace livens {

/// Dense elimination on null spaces: rows Z_A^T at nodes 0..p-1, columns Z_B at nodes 1..p.
///
/// Where the tangent couples no bodies (degree 1 without loads that have one) its bodies are
/// inverted one by one instead and the constraints added by their Schur complement, which is small.
class Elimination {
public:
    Elimination(const Tables& tables, int degree);

    /// Takes the null spaces of all nodes (0..p).
    void begin(const std::vector<const OrthogonalBasis*>& bases);
    /// Starts the block of rows of node A and columns of node B; every pair of A = 0..p-1, B = 1..p comes
    /// once.
    void open(int A, int B);
    /// Adds factor * [1 0 ; 0 H] for a body, H 3 x 3 column by column.
    void add_mass(int body, double factor, const double* H);
    /// Adds the block of rows of body i and columns of body j, 6 x 6 row by row, in scaled twists.
    void add(int body_i, int body_j, const double* block);
    /// Writes the reduced block into the matrix.
    void close();
    /// False if the tangent is singular or not finite.
    bool factorise();
    /// x <- J^-1 x; row block A of x at A * f, column block B at (B - 1) * f. `range` holds the part of the
    /// increment across the null space at node 1 (in the basis), null for none; see takes_constraints().
    void solve(double* x, const double* range);
    /// Whether solve() can take violations of the constraints in; else they are taken off before.
    bool takes_constraints() const { return degree_ == 1 && tables_.loads_with_tangent.empty(); }

    int unknowns() const { return degree_ * f_; }

private:
    const double* null_space(int A, int body) const;
    void form_null_spaces();
    void reduce(int A, int B);
    void multiply_pair(int A, int B, int r);
    bool factorise_bodies();
    void solve_bodies(double* x, const double* range);
    void invert_bodies(double* y) const;

    const Tables& tables_;
    int degree_;
    int f_;
    int A_ = 0, B_ = 1;             // the open pair
    bool by_bodies_ = false;        // as takes_constraints()
    double factor_ = 1;             // of the mass; likewise
    std::vector<double> inverse_;   // of H, 9 a body; likewise
    DenseLU schur_;
    std::vector<double> range_;   // Q_1^T J^-1 Y_0, rank columns of length n; likewise
    std::vector<double> work_;
    std::vector<const OrthogonalBasis*> bases_;
    DenseLU lu_;
    std::vector<double> z_;         // null space of node A at A * n * f
    std::vector<double> product_;   // block of the tangent times the null space at B, n x f
};

}   // namespace livens
