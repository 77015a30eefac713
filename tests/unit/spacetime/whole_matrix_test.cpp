// The whole matrix of lobatto against differences of its rows, against differences of solved motions, and
// where its inverse is known.
#include "livens/spacetime/lobatto/whole_matrix.h"

#include <gtest/gtest.h>
#include <mechanisms.h>   // of all tests, not of this folder

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "livens/spacetime/lobatto/rule.h"
#include "livens/spacetime/solve.h"
#include "unit/spacetime/mechanisms.h"

namespace livens {
namespace {

/// Elements of unlike length, so that the two sides of a shared node weigh differently.
const TimeMesh uneven{{0, 0.03, 0.08, 0.1, 0.16}};

/// A box about a point that is not its centre, turning; its loads depend on X and X', and jump at an element
/// end.
Model loaded_box()
{
    Placement placement;
    placement.position = {0.1, 0.2, -0.3};
    placement.directors = directors_from_rotation_vector({0.4, -0.2, 0.7});
    placement.velocity = {0.5, -1, 0.25};
    placement.angular_velocity = {3, -2, 4};
    Model model({0, 0, -9.81});
    const int box_ =
        model.add_body(rigid_body("box", with_center(box(1.5, {2, 1, 0.5}), {0.2, -0.1, 0.3}), placement));
    model.add_load(torque("motor", box_, window({6.0, -4.0, 2.0}, 0.03, 0.08), Frame::body_fixed));
    model.add_load(torque("wind", box_, {0.5, 1.0, 0.5}, Frame::inertial));
    model.add_load(spring_damper("strut", world, {0, 0, 2}, box_, {0.5, 0.5, 0.2}, {100, 5, 1}));
    return model;
}

/// A needle, whose inertia about d1 is zero, hinged across.
Model needle()
{
    Model model({0, -9.81, 0});
    const int body =
        model.add_body(rigid_body("needle", {2, {0.5, 0, 0}, Matrix3{0, 0, 0, 0, 0.2, 0, 0, 0, 0.2}}));
    model.add_joint(revolute("hinge", world, body, {}));
    return model;
}

struct Case {
    std::string name;
    Model (*make)();
    int degree;
};

Model four_bar() { return tests::four_bar(); }

Solution solved(const Model& model, int degree, const State& start)
{
    SolveOptions options;
    options.tolerance = 1e-14;
    Solution solution = solve(model, {start}, uneven, Lobatto{degree}, options);
    EXPECT_TRUE(solution.report.converged()) << solution.report.message;
    return solution;
}

/// The rows of all nodes, from the definition and in plain 3 x 4 matrices; directions and W_A lambda_A stay
/// what they are at the solution.
class Rows {
public:
    Rows(const Model& model, const Motion& motion, const WholeMatrix& whole)
        : model_(model), motion_(motion), whole_(whole), rule_(lobatto_rule(motion.X.degree))
    {
        const double* from = motion.X.values.data();
        for (int A = 0; A < whole.n_nodes; ++A) {
            X.emplace_back(model.bodies().size());
            for (Matrix34& x : X.back()) {
                std::copy_n(from, 12, x.a);
                from += 12;
            }
        }
    }

    /// Turns and moves node B along direction j.
    void move(int B, int j, double size)
    {
        const double* xi = whole_.direction(B, j).data();
        for (int b = 0; b < model_.n_bodies(); ++b) {
            Matrix34& x = X[B][b];
            const bool is_point = model_.bodies()[b].is_point;
            Matrix3 d = directors(x);
            if (!is_point)
                d = directors_from_rotation_vector({size * xi[3], size * xi[4], size * xi[5]}) * d;
            x = configuration(x.column(0) + size * Vector3{xi[0], xi[1], xi[2]}, d);
            xi += is_point ? 3 : 6;
        }
    }

    /// Products of row r_A, less the momentum at the start, with the directions at A.
    std::vector<double> row(int A) const
    {
        std::vector<Matrix34> r(X[A].size(), Matrix34{});
        const int p = rule_.degree;
        for (int e = 0; e < motion_.n_elements(); ++e)
            if (A >= e * p && A <= (e + 1) * p) add_element(e, A - e * p, r);
        if (A == 0)
            for (int b = 0; b < model_.n_bodies(); ++b) r[b] += motion_.momenta[b];
        std::vector<double> result;
        for (int i = 0; i < whole_.freedoms; ++i) result.push_back(product(A, i, r));
        return result;
    }

    std::vector<double> all() const
    {
        std::vector<double> result;
        for (int A = 0; A + 1 < whole_.n_nodes; ++A) {
            const std::vector<double> part = row(A);
            result.insert(result.end(), part.begin(), part.end());
        }
        return result;
    }

    std::vector<std::vector<Matrix34>> X;   ///< nodes, bodies

private:
    void add_element(int e, int A, std::vector<Matrix34>& r) const
    {
        const int p = rule_.degree, node = e * p + A;
        const double h = motion_.mesh.length(e), weight = h * rule_.weights[A];
        for (int B = 0; B <= p; ++B) {
            for (std::size_t b = 0; b < r.size(); ++b) {
                const Matrix34 increment = X[e * p + B][b] - X[e * p][b];
                r[b] += (rule_.k[A * (p + 1) + B] / h) * increment * model_.bodies()[b].mass;
            }
        }
        for (std::size_t b = 0; b < r.size(); ++b)
            r[b] += weight * livens::weight(model_.bodies()[b], model_.gravity());
        for (int point = 0; point < p; ++point) {   // loads at the Gauss points
            std::vector<Matrix34> X_c(r.size(), Matrix34{}), V_c(r.size(), Matrix34{});
            for (int B = 0; B <= p; ++B) {
                for (std::size_t b = 0; b < r.size(); ++b) {
                    X_c[b] += rule_.M[point * (p + 1) + B] * X[e * p + B][b];
                    V_c[b] += (rule_.dM[point * (p + 1) + B] / h) * X[e * p + B][b];
                }
            }
            const double t = motion_.mesh.ends[e] + rule_.loads.points[point] * h;
            const double share = h * rule_.loads.weights[point] * rule_.M[point * (p + 1) + A];
            for (const Load& load : model_.loads())
                add_load(load, {t, Side::middle}, X_c, V_c, share, r);
        }
        for (int c = 0; c < model_.n_rows(); ++c) {
            const ConstraintRow& row = model_.row(c);
            const double impulse = weight * motion_.multipliers.coefficient(e, A)[c];
            Matrix34 g_i{}, g_j{};
            const bool has_i = row.body_i != world;
            constraint_gradient(row, has_i ? X[node][row.body_i] : world_configuration, X[node][row.body_j],
                                g_i, g_j);
            if (has_i) r[row.body_i] -= impulse * g_i;
            r[row.body_j] -= impulse * g_j;
        }
    }

    static void add_load(const Load& load, Instant at, const std::vector<Matrix34>& X_node,
                         const std::vector<Matrix34>& V, double weight, std::vector<Matrix34>& r)
    {
        LoadArguments arguments;
        arguments.at = at;
        for (int side = 0; side < 2; ++side) {
            if (load.bodies[side] == world) continue;
            arguments.X[side] = X_node[load.bodies[side]];
            arguments.V[side] = V[load.bodies[side]];
        }
        LoadForces forces{};
        load.forces(arguments, forces);
        for (int side = 0; side < 2; ++side)
            if (load.bodies[side] != world) r[load.bodies[side]] += weight * forces[side];
    }

    /// sum over bodies of dphi . r_0 + w . sum_a d_a x r_a
    double product(int A, int i, const std::vector<Matrix34>& r) const
    {
        const double* xi = whole_.direction(A, i).data();
        double sum = 0;
        for (int b = 0; b < model_.n_bodies(); ++b) {
            sum += dot(Vector3{xi[0], xi[1], xi[2]}, r[b].column(0));
            if (model_.bodies()[b].is_point) {
                xi += 3;
                continue;
            }
            Vector3 moment{};
            for (int a = 1; a < 4; ++a) moment += cross(X[A][b].column(a), r[b].column(a));
            sum += dot(Vector3{xi[3], xi[4], xi[5]}, moment);
            xi += 6;
        }
        return sum;
    }

    const Model& model_;
    const Motion& motion_;
    const WholeMatrix& whole_;
    LobattoRule rule_;
};

std::vector<std::vector<double>> dense(const SparseMatrix& A)
{
    std::vector<std::vector<double>> result(A.size, std::vector<double>(A.size, 0.0));
    for (int j = 0; j < A.size; ++j)
        for (int k = A.column_starts[j]; k < A.column_starts[j + 1]; ++k)
            result[A.rows[k]][j] = A.values[k];
    return result;
}

double largest(const SparseMatrix& A)
{
    double result = 0;
    for (const double v : A.values) result = std::max(result, std::abs(v));
    return result;
}

class WholeMatrixOf : public ::testing::TestWithParam<Case> {};

TEST_P(WholeMatrixOf, RowsVanishAtTheSolution)
{
    const Model model = GetParam().make();
    const Solution s = solved(model, GetParam().degree, model.start());
    const WholeMatrix whole = whole_matrix(model, s.motion);
    const Rows rows(model, s.motion, whole);
    double impulse = 0;   // of the rows' own terms
    for (int b = 0; b < model.n_bodies(); ++b)
        impulse = std::max(impulse, norm(s.motion.momenta[s.motion.momenta.size() - 1 - b]));
    for (const double r : rows.all()) EXPECT_NEAR(r, 0, 1e-10 * impulse);
}

TEST_P(WholeMatrixOf, MatchesDifferencesOfTheWholeResidual)
{
    const Model model = GetParam().make();
    const Solution s = solved(model, GetParam().degree, model.start());
    const WholeMatrix whole = whole_matrix(model, s.motion);
    const auto J = dense(whole.matrix);
    const double scale = largest(whole.matrix);
    // four points: error eps^4 / 30 of the fifth derivative, rounding 1e-16 k / (h eps)
    const double eps = 2e-4, weight[4] = {1, -8, 8, -1}, place[4] = {-2, -1, 1, 2};
    double worst = 0;
    for (int B = 1; B < whole.n_nodes; ++B) {
        for (int j = 0; j < whole.freedoms; ++j) {
            std::vector<double> difference(whole.matrix.size, 0.0);
            for (int side = 0; side < 4; ++side) {
                Rows rows(model, s.motion, whole);
                rows.move(B, j, place[side] * eps);
                const std::vector<double> all = rows.all();
                for (std::size_t i = 0; i < all.size(); ++i)
                    difference[i] += weight[side] * all[i] / (12 * eps);
            }
            for (int i = 0; i < whole.matrix.size; ++i)
                worst = std::max(worst, std::abs(difference[i] - J[i][(B - 1) * whole.freedoms + j]));
        }
    }
    EXPECT_LT(worst / scale, 1e-9);
}

/// dX of all bodies for a twist at X; nothing in the columns that a point mass does not have.
std::vector<Matrix34> turned(const Model& model, const double* xi, const Matrix34* X)
{
    std::vector<Matrix34> dX;
    for (int b = 0; b < model.n_bodies(); ++b) {
        const bool is_point = model.bodies()[b].is_point;
        const Vector3 v{xi[0], xi[1], xi[2]};
        dX.push_back(is_point ? configuration(v, Matrix3{}) : rate(X[b], v, {xi[3], xi[4], xi[5]}));
        xi += is_point ? 3 : 6;
    }
    return dX;
}

/// The motion that starts faster by `size` times direction j, less the one that starts slower by as much.
std::vector<double> difference_of_motions(const Model& model, int degree, const WholeMatrix& whole, int j,
                                          double size)
{
    std::vector<double> difference;
    for (const double sign : {1.0, -1.0}) {
        State start = model.start();
        const std::vector<Matrix34> dV = turned(model, whole.direction(0, j).data(), start.X.data());
        for (std::size_t b = 0; b < dV.size(); ++b) start.V[b] += sign * size * dV[b];
        const std::vector<double> X = solved(model, degree, start).motion.X.values;
        difference.resize(X.size(), 0.0);
        for (std::size_t i = 0; i < X.size(); ++i) difference[i] += sign * X[i];
    }
    return difference;
}

/// Momentum of direction j at the start in the row of direction i; 1 for i = j and else 0, but for needles.
double mass_between(const Model& model, const WholeMatrix& whole, const std::vector<Matrix34>& X, int i,
                    int j)
{
    const auto dX_i = turned(model, whole.direction(0, i).data(), X.data());
    const auto dX_j = turned(model, whole.direction(0, j).data(), X.data());
    double sum = 0;
    for (std::size_t b = 0; b < dX_i.size(); ++b) sum += dot(dX_i[b], dX_j[b] * model.bodies()[b].mass);
    return sum;
}

/// The derivative of the solved motion by its momentum at the start is -J^-1 of that column: no multiplier
/// and no direction is held here.
TEST_P(WholeMatrixOf, InverseTellsHowTheMotionAnswersItsStart)
{
    const Model model = GetParam().make();
    const Solution s = solved(model, GetParam().degree, model.start());
    const WholeMatrix whole = whole_matrix(model, s.motion);
    const Rows nodes(model, s.motion, whole);
    SparseLU lu(SparseBackend::eigen);
    lu.analyse(whole.matrix);
    ASSERT_TRUE(lu.factorise(whole.matrix));
    const double eps = 1e-4;
    double worst = 0, answer = 0;
    for (int j = 0; j < whole.freedoms; ++j) {
        const auto difference = difference_of_motions(model, GetParam().degree, whole, j, eps);
        std::vector<double> eta(whole.matrix.size, 0.0);
        for (int i = 0; i < whole.freedoms; ++i) eta[i] = -mass_between(model, whole, nodes.X[0], i, j);
        lu.solve(eta, eta);
        for (int B = 1; B < whole.n_nodes; ++B) {
            std::vector<double> xi(whole.n_twists, 0.0);
            for (int i = 0; i < whole.freedoms; ++i)
                for (int k = 0; k < whole.n_twists; ++k)
                    xi[k] += eta[(B - 1) * whole.freedoms + i] * whole.direction(B, i)[k];
            const std::vector<Matrix34> dX = turned(model, xi.data(), nodes.X[B].data());
            const double* at = difference.data() + B * 12 * model.n_bodies();
            for (std::size_t i = 0; i < 12 * dX.size(); ++i) {
                const double slope = at[i] / (2 * eps);
                worst = std::max(worst, std::abs(dX[i / 12].a[i % 12] - slope));
                answer = std::max(answer, std::abs(slope));
            }
        }
    }
    EXPECT_LT(worst / answer, 1e-7);
}

INSTANTIATE_TEST_SUITE_P(
    Lobatto, WholeMatrixOf,
    ::testing::Values(Case{"box", loaded_box, 1}, Case{"box", loaded_box, 2}, Case{"box", loaded_box, 5},
                      Case{"bricks", testing_models::two_bricks, 1},
                      Case{"bricks", testing_models::two_bricks, 3},
                      Case{"everything", testing_models::everything, 2}, Case{"needle", needle, 2},
                      Case{"four_bar", four_bar, 1}, Case{"four_bar", four_bar, 4}),
    [](const auto& which) { return which.param.name + "_degree_" + std::to_string(which.param.degree); });

TEST(WholeMatrix, IsBlockTriangularOverElementsWithTwoSubdiagonals)
{
    const Model model = testing_models::two_bricks();
    for (const int p : {1, 2, 3}) {
        const Solution s = solved(model, p, model.start());
        const WholeMatrix whole = whole_matrix(model, s.motion);
        const int f = whole.freedoms;
        ASSERT_EQ(f, 6);
        ASSERT_EQ(whole.matrix.size, uneven.n_elements() * p * f);
        int last = 0;
        for (int j = 0; j < whole.matrix.size; ++j) {
            for (int k = whole.matrix.column_starts[j]; k < whole.matrix.column_starts[j + 1]; ++k) {
                const int row_block = whole.matrix.rows[k] / (p * f), column_block = j / (p * f);
                EXPECT_GE(row_block, column_block);
                EXPECT_LE(row_block, column_block + 2);
                last = std::max(last, row_block - column_block);
            }
        }
        EXPECT_EQ(last, 2);
    }
}

TEST(WholeMatrix, DirectionsCarryUnitEnergyAndKeepTheJoints)
{
    const Model model = four_bar();
    const Solution s = solved(model, 3, model.start());
    ASSERT_EQ(s.motion.redundant_rows.size(), 3u);
    const WholeMatrix whole = whole_matrix(model, s.motion);
    ASSERT_EQ(whole.freedoms, 1);
    const Rows nodes(model, s.motion, whole);
    for (int A = 0; A < whole.n_nodes; ++A) {
        const double* xi = whole.direction(A, 0).data();
        std::vector<Matrix34> V;
        double twice_energy = 0;
        for (int b = 0; b < model.n_bodies(); ++b, xi += 6) {
            V.push_back(rate(nodes.X[A][b], {xi[0], xi[1], xi[2]}, {xi[3], xi[4], xi[5]}));
            twice_energy += dot(V[b] * model.bodies()[b].mass, V[b]);
        }
        EXPECT_NEAR(twice_energy, 1, 1e-12);
        for (int r = 0; r < model.n_rows(); ++r) {   // all 20 rows, also those left out
            const ConstraintRow& row = model.row(r);
            Matrix34 g_i{}, g_j{};
            const bool has_i = row.body_i != world;
            constraint_gradient(row, has_i ? nodes.X[A][row.body_i] : world_configuration,
                                nodes.X[A][row.body_j], g_i, g_j);
            EXPECT_NEAR((has_i ? dot(g_i, V[row.body_i]) : 0.0) + dot(g_j, V[row.body_j]), 0, 1e-12);
        }
    }
}

Model flying_point()
{
    Model model;
    model.add_body(point_mass("point", 2.5, {0, 0, 0}, {1, 2, 3}));
    return model;
}

/// The 2-norm of a dense n x n matrix by power iterations with A^T A.
template <class Entry>
double dense_norm(int n, Entry&& entry)
{
    std::vector<double> x(n), y(n);
    for (int i = 0; i < n; ++i) x[i] = 1 + 0.37 * std::sin(1.7 * i * i);
    double squared = 0;
    for (int round = 0; round < 4000; ++round) {
        for (int i = 0; i < n; ++i) {
            y[i] = 0;
            for (int j = 0; j < n; ++j) y[i] += entry(i, j) * x[j];
        }
        double sum = 0;
        for (int j = 0; j < n; ++j) {
            x[j] = 0;
            for (int i = 0; i < n; ++i) x[j] += entry(i, j) * y[i];
            sum += x[j] * x[j];
        }
        squared = std::sqrt(sum);
        for (double& v : x) v /= squared;
    }
    return std::sqrt(squared);
}

/// Linear elements of a free point: J = -(1/h) (1, -2, 1) and J^-1 = -h (1, 2, 3, ...) by diagonals downwards
/// from the main one, so |J|_1 |J^-1|_1 = (4/h) (h n (n + 1)/2).
TEST(WholeMatrix, OfAFreePointHasTheInverseOfSecondDifferences)
{
    const Model model = flying_point();
    SolveOptions options;
    options.condition = true;
    for (const int n : {3, 20}) {
        const Solution s = solve(model, {model.start()}, make_time_mesh(0, 2, n), Lobatto{1}, options);
        ASSERT_TRUE(s.report.converged());
        EXPECT_NEAR(s.report.condition_1, 2.0 * n * (n + 1), 1e-9 * n * n);
        const double norm = dense_norm(n, [](int i, int j) {
            return i == j || i == j + 2 ? -1.0 : (i == j + 1 ? 2.0 : 0.0);
        });
        const double inverse_norm = dense_norm(n, [](int i, int j) { return i >= j ? i - j + 1.0 : 0.0; });
        EXPECT_NEAR(s.report.condition_2 / (norm * inverse_norm), 1, 1e-4);
        EXPECT_EQ(s.report.scaled_condition, s.report.condition_1);
        EXPECT_GT(s.report.factor_entries, 3 * n);
    }
}

Solution with_condition(const Model& model, double end, int n, int degree)
{
    SolveOptions options;
    options.condition = true;
    Solution s = solve(model, {model.start()}, make_time_mesh(0, end, n), Lobatto{degree}, options);
    EXPECT_TRUE(s.report.converged()) << s.report.message;
    return s;
}

TEST(ConditionNumber, GrowsWithTheSquareOfTheNumberOfElements)
{
    const Model model = tests::free_box();
    for (const int p : {1, 2}) {
        const SolveReport coarse = with_condition(model, 1, 40, p).report;
        const SolveReport fine = with_condition(model, 1, 160, p).report;
        EXPECT_NEAR(std::log(fine.condition_1 / coarse.condition_1) / std::log(4.0), 2, 0.1) << p;
        EXPECT_NEAR(std::log(fine.condition_2 / coarse.condition_2) / std::log(4.0), 2, 0.1) << p;
        EXPECT_NEAR(static_cast<double>(fine.factor_entries) / static_cast<double>(coarse.factor_entries), 4,
                    0.2)
            << "the factors grow linearly";
    }
}

TEST(ConditionNumber, KnowsNoUnitOfLengthAndNoDirectionOfSpace)
{
    tests::Setting other;
    other.turn = directors_from_rotation_vector({0.3, -1.1, 0.6});
    other.metre = 1000;
    const SolveReport here = with_condition(tests::two_bricks(), 0.5, 10, 3).report;
    const SolveReport there = with_condition(tests::two_bricks(other), 0.5, 10, 3).report;
    EXPECT_GT(here.condition_2, 1e3);
    EXPECT_NEAR(there.condition_2 / here.condition_2, 1, 1e-4);
}

TEST(ConditionNumber, IsComputedOnlyWhenAskedFor)
{
    const Model model = testing_models::two_bricks();
    const TimeMesh mesh = make_time_mesh(0, 0.2, 4);
    const Solution plain = solve(model, {model.start()}, mesh, Lobatto{2});
    EXPECT_EQ(plain.report.condition_1, 0);
    EXPECT_EQ(plain.report.condition_2, 0);
    EXPECT_EQ(plain.report.scaled_condition, 0);
    EXPECT_EQ(plain.report.factor_entries, 0);
    const Solution asked = with_condition(model, 0.2, 4, 2);
    EXPECT_GT(asked.report.condition_1, 1);
    EXPECT_EQ(asked.motion.X.values, plain.motion.X.values);
    EXPECT_EQ(asked.report.factorisations, plain.report.factorisations);
    SolveOptions options;
    options.condition = true;
    const ExactSample sample = sample_exactly(model, plain.motion, Lobatto{2}, 0.13, options);
    EXPECT_EQ(sample.report.condition_1, 0);
}

TEST(ConditionNumber, IsLeftOutWhereTheMarchFailsOrNothingMoves)
{
    SolveOptions options;
    options.condition = true;
    options.progress = [](const Progress& progress) { return progress.element < 2; };
    const Model bricks = testing_models::two_bricks();
    const Solution stopped =
        solve(bricks, {bricks.start()}, make_time_mesh(0, 0.2, 4), Lobatto{2}, options);
    EXPECT_EQ(stopped.report.status, SolveStatus::cancelled);
    EXPECT_EQ(stopped.report.condition_1, 0);

    Model held({0, 0, -9.81});
    held.add_body(rigid_body("block", box(1, {1, 1, 1})));
    held.add_joint(weld("seat", world, 0, {}, world_configuration, held.bodies()[0].X));
    const Solution still = with_condition(held, 0.2, 4, 2);
    EXPECT_EQ(still.report.condition_1, 0);
}

}   // namespace
}   // namespace livens
