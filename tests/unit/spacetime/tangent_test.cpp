// SPDX-License-Identifier: BSD-3-Clause
// The tangent of windows of lobatto against differences of their rows, and what it does for Newton.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "livens/dynamics/instant/instant.h"
#include "livens/dynamics/start/consistent_start.h"
#include "livens/spacetime/nodal/condensed/along_joints.h"
#include "livens/spacetime/nodal/elimination.h"
#include "livens/spacetime/nodal/nodes.h"
#include "livens/spacetime/nodal/system.h"
#include "livens/spacetime/solve.h"
#include "unit/spacetime/mechanisms.h"

namespace livens::tangent_test {
namespace {

using testing_models::everything;
using testing_models::two_bricks;

class Dice {
public:
    explicit Dice(unsigned seed) : engine_(seed) {}
    double operator()() { return 2 * (static_cast<double>(engine_() >> 11) * 0x1p-53) - 1; }

private:
    std::mt19937_64 engine_;
};

/// The tangent without elimination.
struct Dense final : TangentSink {
    Dense(const ModelTables& the_tables, const WindowLayout& stretch) : tables(the_tables)
    {
        for (int A = 0; A < stretch.n_nodes(); ++A) {
            rows.push_back(stretch.is_active(A) ? n_rows++ * tables.n_twists : -1);
            columns.push_back(stretch.is_unknown(A) ? n_columns++ * tables.n_twists : -1);
        }
        n_rows *= tables.n_twists;
        n_columns *= tables.n_twists;
        entries.assign(static_cast<std::size_t>(n_rows * n_columns), 0.0);
    }
    double& at(int i, int r, int j, int c)
    {
        return entries[(rows[row] + tables.bodies[i].first + r) * n_columns + columns[column] +
                       tables.bodies[j].first + c];
    }
    void open(int, int A, int B) override
    {
        row = A;
        column = B;
    }
    void mass(int body, double factor, const double* H) override
    {
        for (int r = 0; r < 3; ++r) at(body, r, body, r) += factor;
        for (int r = 3; r < tables.bodies[body].dofs; ++r)
            for (int c = 3; c < 6; ++c) at(body, r, body, c) += factor * H[(r - 3) + 3 * (c - 3)];
    }
    void block(int i, int j, const double* values) override
    {
        for (int r = 0; r < tables.bodies[i].dofs; ++r)
            for (int c = 0; c < tables.bodies[j].dofs; ++c) at(i, r, j, c) += values[6 * r + c];
    }
    void close() override {}

    const ModelTables& tables;
    std::vector<int> rows, columns;   // of each node, -1: none
    int n_rows = 0, n_columns = 0, row = 0, column = 0;
    std::vector<double> entries;
};

struct Case {
    int degree, elements;
    bool X_first, P_first, X_last, P_last;
};

void PrintTo(const Case& c, std::ostream* out)
{
    *out << "degree " << c.degree << ", " << c.elements << " elements, first " << c.X_first << c.P_first
         << ", last " << c.X_last << c.P_last;
}

/// A window of `everything` at nodes that are no motion at all, and its rows at fixed multipliers and maps.
class Window {
public:
    /// Nodes are `off` from where the mechanism stands, in lengths and radians.
    Window(const Model& model, const Case& c, double off = 0.1)
        : assembly_(consistent_start(model, model.start(), StartPolicy::check)),
          tables(model, assembly_.independent), rule(lobatto_rule(c.degree)), system(tables, rule),
          ends_(tables)
    {
        stretch.degree = c.degree;
        for (int e = 0; e <= c.elements; ++e) stretch.times.push_back(0.1 * e + 0.03 * e * e);
        stretch.X_first = c.X_first;
        stretch.P_first = c.P_first;
        stretch.X_last = c.X_last;
        stretch.P_last = c.P_last;
        state_.resize(tables);
        for (int b = 0; b < model.n_bodies(); ++b)
            std::copy_n(assembly_.start.X[b].a, 12, state_.X.begin() + 12 * b);
        EXPECT_TRUE(ends_.prepare(state_, tables.independent));
        Dice dice(3);
        for (double& v : state_.momentum) v = dice();
        system.open(stretch, c.X_first ? &state_ : nullptr, c.X_last ? &state_ : nullptr);
        for (const bool last : {false, true})
            for (double& v : system.balances().end_momentum(last).about_reference) v = 2 * dice();
        std::vector<double> xi(static_cast<std::size_t>(tables.n_twists));
        if (!c.X_first) system.nodes().place_at(0, state_.X.data());
        for (int A = 1; A < stretch.n_nodes(); ++A) {
            for (double& v : xi) v = off * dice();
            if (stretch.is_unknown(A)) system.nodes().place_from(A, 0, xi.data());
        }
        EXPECT_TRUE(system.nodes().constrain(stretch, false));
        EXPECT_TRUE(system.residual());
        system.keep();
        for (int A = 0; A < stretch.n_nodes(); ++A) {
            maps.emplace_back(system.nodes().maps(A), system.nodes().maps(A) + 12 * model.n_bodies());
            impulses.emplace_back(static_cast<std::size_t>(tables.rank));
            if (stretch.is_active(A))
                std::copy_n(system.balances().impulses(A), tables.rank, impulses[A].begin());
        }
    }

    /// Rows where node B is moved along scaled twist j.
    std::vector<double> rows_at(int B, int j, double size)
    {
        std::vector<double> y(static_cast<std::size_t>(tables.n_twists)), xi(y), zero(y);
        y[j] = size;
        tables.bodies.to_twist(maps[B].data(), y.data(), xi.data());
        system.nodes().begin_move();
        for (int A = 0; A < stretch.n_nodes(); ++A)
            if (stretch.is_unknown(A)) system.nodes().move(A, A == B ? xi.data() : zero.data(), 1);
        EXPECT_TRUE(system.nodes().constrain(stretch, true));
        EXPECT_TRUE(system.residual());
        std::vector<double> result;
        for (int A = 0; A < stretch.n_nodes(); ++A) {
            if (!stretch.is_active(A)) continue;
            const Nodes& nodes = system.nodes();
            std::vector<double> raw(system.balances().raw(A), system.balances().raw(A) + maps[A].size());
            system.balances().subtract(nodes.basis(A), impulses[A].data(), raw.data());
            std::vector<double> q(y.size()), scaled(y.size());
            tables.bodies.twist_rows(nodes.X(A), maps[A].data(), raw.data(), q.data());
            tables.bodies.to_scaled_rows(maps[A].data(), q.data(), scaled.data());
            result.insert(result.end(), scaled.begin(), scaled.end());
        }
        return result;
    }

private:
    ConsistentStart assembly_;

public:
    ModelTables tables;
    ElementRule rule;
    WindowLayout stretch;
    NodalSystem system;
    std::vector<std::vector<double>> maps, impulses;

private:
    InstantSystem ends_;
    InstantState state_;
};

class TangentOf : public ::testing::TestWithParam<Case> {};

/// At nodes that are `off` from where the mechanism stands.
void expect_differences(const Model& model, const Case& c, double off)
{
    Window window(model, c, off);
    Dense dense(window.tables, window.stretch);
    window.system.form_tangent(dense);
    EXPECT_EQ(dense.n_rows, dense.n_columns);
    double worst = 0, largest = 0;
    const double eps = 2e-4, places[4] = {-2, -1, 1, 2}, weights[4] = {1, -8, 8, -1};
    for (int B = 0; B < window.stretch.n_nodes(); ++B) {
        if (!window.stretch.is_unknown(B)) continue;
        for (int j = 0; j < window.tables.n_twists; ++j) {
            // four points: error eps^4 / 30 of the fifth derivative, rounding 1e-16 / eps
            std::vector<double> difference(static_cast<std::size_t>(dense.n_rows), 0.0);
            for (int side = 0; side < 4; ++side) {
                const std::vector<double> rows = window.rows_at(B, j, places[side] * eps);
                for (std::size_t r = 0; r < rows.size(); ++r)
                    difference[r] += weights[side] * rows[r] / (12 * eps);
            }
            for (int r = 0; r < dense.n_rows; ++r) {
                const double entry = dense.entries[r * dense.n_columns + dense.columns[B] + j];
                worst = std::max(worst, std::abs(difference[r] - entry));
                largest = std::max(largest, std::abs(entry));
            }
        }
    }
    EXPECT_LT(worst / largest, 1e-9) << off;
}

TEST_P(TangentOf, MatchesDifferencesWithEveryKindOfTerm)
{
    for (const double off : {0.1, 0.3}) expect_differences(everything(), GetParam(), off);
}

TEST_P(TangentOf, MatchesDifferencesWithoutLoads) { expect_differences(two_bricks(), GetParam(), 0.3); }

/// Twists that are solved for meet the rows in the tangent that differences have, of which masses of all
/// pairs are formed together in the solver's blocks.
void expect_solutions(const Model& model, const Case& c, Inside inside = Inside::as_a_whole)
{
    Window window(model, c, 0.3);
    const int n = window.tables.n_twists, f = window.tables.freedoms(), k = window.tables.rank;
    Dense dense(window.tables, window.stretch);
    window.system.form_tangent(dense);
    const Nodes& nodes = window.system.nodes();
    const auto blocks =
        null_space_elimination(window.tables, window.stretch,
                               window.stretch.is_march() ? forward_solver() : chain_solver(), inside);
    EXPECT_EQ(blocks->is_whole(), inside == Inside::as_a_whole);
    blocks->begin(window.stretch, nodes);
    window.system.form_tangent(*blocks);
    ASSERT_TRUE(blocks->factorise());
    std::vector<double> rows(static_cast<std::size_t>(dense.n_rows / n * f)),
        twists(static_cast<std::size_t>(dense.n_columns));
    Dice dice(5);
    for (double& v : rows) v = dice();
    blocks->solve(rows, nullptr, twists.data());
    double worst = 0, largest = 1;
    for (int A = 0; A < window.stretch.n_nodes(); ++A) {
        if (!window.stretch.is_active(A)) continue;
        std::vector<double> y(static_cast<std::size_t>(n), 0.0);
        for (int r = 0; r < n; ++r)
            for (int j = 0; j < dense.n_columns; ++j) {
                y[r] += dense.entries[(dense.rows[A] + r) * dense.n_columns + j] * twists[j];
                largest = std::max(largest, std::abs(twists[j]));
            }
        nodes.basis(A).q.apply_transposed(y.data());
        for (int i = 0; i < f; ++i)
            worst = std::max(worst, std::abs(y[k + i] - rows[dense.rows[A] / n * f + i]));
    }
    EXPECT_LT(worst, 1e-11 * largest);
}

TEST_P(TangentOf, IsThatOfTheBlocksThatAreSolved)
{
    expect_solutions(everything(), GetParam());
    expect_solutions(two_bricks(), GetParam());
}

/// Of the same window by both ways: how far rows move unknowns, which takes transposed solutions.
void expect_resistance(const Model& model, const Case& c)
{
    Window window(model, c, 0.3);
    std::vector<double> sizes, rows, twists[2];
    Dice dice(7);
    for (int A = 0; A < window.stretch.n_nodes(); ++A) sizes.push_back(1 + 0.5 * dice());
    double resisted[2] = {};
    for (const Inside inside : {Inside::as_a_whole, Inside::along_joints}) {
        const auto blocks = null_space_elimination(
            window.tables, window.stretch, window.stretch.is_march() ? forward_solver() : chain_solver(),
            inside);
        blocks->begin(window.stretch, window.system.nodes());
        window.system.form_tangent(*blocks);
        ASSERT_TRUE(blocks->factorise());
        const auto i = static_cast<std::size_t>(inside == Inside::along_joints);
        resisted[i] = blocks->least_resisted(sizes, twists[i]);
    }
    EXPECT_GT(resisted[0], 0);
    EXPECT_NEAR(resisted[1] / resisted[0], 1, 1e-8);
    double off = 0, size = 0;
    ASSERT_EQ(twists[0].size(), twists[1].size());
    for (std::size_t i = 0; i < twists[0].size(); ++i) {
        off = std::max(off, std::abs(twists[0][i] - twists[1][i]));
        size = std::max(size, std::abs(twists[0][i]));
    }
    EXPECT_LT(off, 1e-8 * size);
}

/// Branches of up to five bodies on the world and one that floats, on joints of every number of freedoms,
/// with loads of bodies on their parents and on the world.
Model branched(unsigned seed)
{
    Dice dice(seed);
    Model model({0.3, 0, -9.81});
    const int n = 6;
    for (int b = 0; b < n; ++b) {
        Placement placement;
        placement.position = {0.7 * dice(), 0.7 * dice(), 0.7 * dice()};
        placement.directors = directors_from_rotation_vector({dice(), dice(), dice()});
        if (b == n - 1)
            model.add_body(point_mass("point", 0.4, placement.position));
        else
            model.add_body(rigid_body("body " + std::to_string(b),
                                      with_center(box(1000, {0.2, 0.3, 0.1 + 0.1 * b}),
                                                  {0.1 * dice(), 0.1 * dice(), 0.1 * dice()}),
                                      placement));
    }
    const int parents[] = {world, 0, 1, 0, world, 3};
    for (int b = 0; b < n; ++b) {
        if (b == 4) continue;   // it floats
        const int on = parents[b];
        const Matrix34 first = on == world ? configuration({}, identity<3>()) : model.bodies()[on].X,
                       second = model.bodies()[b].X;
        const Vector3 at{dice(), dice(), dice()};
        const JointFrame frame = joint_frame(first, second, at, {dice(), 0.3, dice()});
        const std::string name = "joint " + std::to_string(b);
        JointFrame ends;
        ends.point_first = frame.point_first;
        const unsigned kind = b == n - 1 ? 4 : (seed + static_cast<unsigned>(b)) % 4;
        model.add_joint(kind == 0   ? spherical(name, on, b, frame)
                        : kind == 1 ? revolute(name, on, b, frame)
                        : kind == 2 ? prismatic(name, on, b, frame, first, second)
                        : kind == 3 ? weld(name, on, b, frame, first, second)
                                    : rod(name, on, b, ends, norm(second.column(0) - at)));
        model.add_load(spring_damper("spring " + std::to_string(b), on, {0.1, 0.2, 0}, b, {0, 0, 0},
                                     {40, 3, 0.1}));
    }
    model.add_load(spring_damper("tether", world, {0, 1, 1}, 4, {0.1, 0, 0}, {30, 2, 0.1}));
    model.add_load(torque("twist", 1, {1.0, 2.0, 3.0}, Frame::body_fixed));
    return model;
}

class InsideOfElements : public ::testing::TestWithParam<Case> {};

TEST_P(InsideOfElements, IsEliminatedAlongJointsOfTrees)
{
    const Case c = GetParam();
    std::vector<Model> models{two_bricks()};
    for (unsigned seed = 0; seed < 4; ++seed) models.push_back(branched(seed));
    for (const Model& model : models) {
        expect_solutions(model, c, Inside::along_joints);
        if (!c.X_first || !c.P_first) expect_resistance(model, c);   // nobody asks a march
    }
}

INSTANTIATE_TEST_SUITE_P(LargeElements, InsideOfElements,
                         ::testing::Values(Case{2, 3, 1, 1, 0, 0}, Case{3, 2, 1, 0, 1, 0},
                                           Case{2, 2, 1, 0, 0, 1}, Case{3, 2, 0, 1, 1, 0},
                                           Case{2, 2, 0, 1, 0, 1}, Case{8, 1, 1, 0, 1, 0},
                                           Case{8, 3, 0, 1, 0, 1}, Case{6, 2, 1, 1, 0, 0},
                                           Case{12, 2, 1, 0, 0, 1}));

/// Masses on springs without a free length: free bodies, of which nothing is coupled.
Model swinging(double stiffness, int n)
{
    Model model({0, 0, 0});
    for (int b = 0; b < n; ++b) {
        const std::string name = std::to_string(b);
        model.add_body(point_mass("mass " + name, 1, {1.0 + b, 0.2, 0}));
        model.add_load(spring_damper("spring " + name, world, {}, b, {}, {stiffness, 0, 0}));
    }
    return model;
}

// Half a swing fits into an element: it may move inside of it while its ends rest. In the middle of one of
// degree 2 its mass makes 16 / (3 h) and its spring, where that node is seen by 2/3 at two Gauss points,
// -4/9 k h.
TEST(AlongJoints, TurnToDenseBlocksWhereAnElementMovesByItself)
{
    const double h = 0.13;   // of the first element of a window
    const Case c{2, 3, true, false, true, false};
    for (const double off : {0.0, 1e-9, 0.1}) {
        const Model model = swinging(12 / (h * h) * (1 + off), 6);
        Window window(model, c);
        ASSERT_TRUE(window.system.settle() && window.system.residual());
        ASSERT_TRUE(window.system.factorise());
        EXPECT_EQ(window.system.elimination()->is_whole(), off < 0.01) << off;
        std::vector<double> step(static_cast<std::size_t>(window.system.n_unknowns()));
        window.system.solve(step);   // the rows are linear
        ASSERT_TRUE(window.system.move(step, 1) && window.system.residual());
        EXPECT_LT(window.system.rows().size, 1e-9) << off;
    }
}

TEST(AlongJoints, PayForManyFreedomsAlone)
{
    const auto pays = [](const Model& model) {
        const Window window(model, {8, 2, true, false, true, false});
        return AlongJoints::pays(window.tables, window.stretch);
    };
    EXPECT_FALSE(pays(two_bricks()));
    EXPECT_FALSE(pays(everything()));   // a spring couples bodies that no joint does
    EXPECT_TRUE(pays(swinging(10, 6)));
}

// Where X is unknown at an end and P known, the row has the moment of P about a reference point that moves
// with nothing: its derivative is that of the other terms.
INSTANTIATE_TEST_SUITE_P(Lobatto, TangentOf,
                         ::testing::Values(Case{1, 1, 1, 1, 0, 0}, Case{2, 1, 1, 1, 0, 0},
                                           Case{3, 1, 1, 1, 0, 0}, Case{5, 1, 1, 1, 0, 0},
                                           Case{1, 3, 1, 1, 0, 0}, Case{2, 3, 1, 1, 0, 0},
                                           Case{3, 2, 1, 0, 1, 0}, Case{1, 4, 1, 0, 1, 0},
                                           Case{2, 2, 1, 0, 0, 1}, Case{3, 2, 0, 1, 1, 0},
                                           Case{2, 2, 0, 1, 0, 1}));

/// Increments with the same factors are what a step is judged by. Off a solution the null spaces and axes of
/// nodes turn with a step, and rows in turned coordinates would not shrink, however short it is.
TEST_P(TangentOf, ShortStepsShrinkTheNextIncrement)
{
    const Case c = GetParam();
    const Model model = everything();
    if (c.X_first && c.P_first) return;   // of marches single elements are solved, from near guesses
    for (const double off : {0.1, 0.3}) {
        Window window(model, c, off);
        NodalSystem& system = window.system;
        ASSERT_TRUE(system.settle());
        ASSERT_TRUE(system.residual());
        system.keep();
        ASSERT_TRUE(system.factorise());
        std::vector<double> step(static_cast<std::size_t>(system.n_unknowns())), next(step);
        system.solve(step);
        const double damping = 1e-4 / system.size_of(step);
        ASSERT_TRUE(system.move(step, damping) && system.residual());
        system.solve(next);
        double gap = 0, size = 0;
        for (std::size_t i = 0; i < step.size(); ++i) {
            gap += std::pow(next[i] - (1 - damping) * step[i], 2);
            size += std::pow(step[i], 2);
        }
        // What is left is of second order in what nodes move, 1e-4 lengths or radians.
        EXPECT_LT(std::sqrt(gap / size), 0.01 * damping) << off;
    }
}

TEST(Newton, ConvergesQuadraticallyOnceClose)
{
    // one tangent an element and about two iterations, as the guess is of half the degree
    const Model model = two_bricks();
    SolveOptions options;
    options.tolerance = 1e-12;
    options.by_newton = true;
    const Solution s = solve(model, {model.start()}, make_time_mesh(0, 1, 20), Lobatto{6}, options);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_LE(s.report.most_iterations, 5);
    EXPECT_LE(static_cast<double>(s.report.newton_iterations) / s.report.n_elements, 3.5);
    EXPECT_LE(static_cast<double>(s.report.factorisations) / s.report.n_elements, 1.1);
}

TEST(Newton, HighDegreesConvergeOnLongElements)
{
    const Model model = two_bricks();
    SolveOptions options;
    options.by_newton = true;
    for (int degree : {8, 12, 16}) {
        const Solution s = solve(model, {model.start()}, make_time_mesh(0, 2, 20), Lobatto{degree}, options);
        ASSERT_TRUE(s.report.converged()) << s.report.message;
        EXPECT_LE(s.report.most_iterations, 10) << "degree " << degree;
    }
}

}   // namespace
}   // namespace livens::tangent_test
