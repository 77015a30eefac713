// SPDX-License-Identifier: BSD-3-Clause
// The system of a block of the elements `mixed`: as many rows as unknowns, and a matrix that is its
// derivative.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "livens/base/error.h"
#include "livens/dynamics/start/consistent_start.h"
#include "livens/spacetime/mixed/tangent.h"
#include "unit/spacetime/mechanisms.h"

namespace livens::mixed_equations_test {
namespace {

using mixed::Equations;
using mixed::Fields;
using mixed::Given;
using mixed::Numbering;

struct Case {
    std::string name;
    Mixed::Start start;
    Mixed::Multipliers multipliers;
    Given given;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

const Given all_conditions[] = {
    {true, true, false, false}, {false, false, true, true}, {true, false, true, false},
    {true, false, false, true}, {false, true, true, false}, {false, true, false, true},
};

std::vector<Case> cases()
{
    std::vector<Case> result;
    for (const auto start : {Mixed::Start::natural, Mixed::Start::strong})
        for (const auto multipliers : {Mixed::Multipliers::equal, Mixed::Multipliers::lower})
            for (const Given& given : all_conditions) {
                std::string name = start == Mixed::Start::natural ? "Natural" : "Strong";
                name += multipliers == Mixed::Multipliers::equal ? "Equal" : "Lower";
                for (const auto& [is_given, word] : {std::pair{given.X_at_start, "X0"},
                                                     {given.P_at_start, "P0"},
                                                     {given.X_at_end, "XT"},
                                                     {given.P_at_end, "PT"}})
                    if (is_given) name += word;
                result.push_back({name, start, multipliers, given});
            }
    return result;
}

class MixedEquations : public ::testing::TestWithParam<Case> {};
/// Those of the same degree as positions: the others jump between elements by themselves.
class TornMultipliers : public MixedEquations {};

/// Everything that a block needs, with fields that are no motion at all.
struct Block {
    Block(const Model& model, const Case& c, const TimeSpace& space, std::vector<int> tears = {})
        : tables(model, consistent_start(model, model.start(), StartPolicy::check).independent, true),
          coordinates(tables), equations(equations_of(model, c, space, tears)), tangent(equations),
          fields(unknown().zero())
    {
        fields.X0 = coordinates.gather(model.start().X);
        std::mt19937_64 engine(7);
        const auto stir = [&engine](std::vector<double>& values, double size) {
            for (double& v : values) v += size * (2 * (static_cast<double>(engine() >> 11) * 0x1p-53) - 1);
        };
        stir(fields.x, 0.1);
        stir(fields.P, 1);
        stir(fields.lambda, 5);
        unknown().tie(fields);
    }

    const mixed::FieldSpace& unknown() const { return equations.space(); }

    static std::vector<int> firsts(const TimeSpace& space, const std::vector<int>& elements)
    {
        std::vector<int> functions;
        for (const int e : elements) functions.push_back(space.first(e));
        return functions;
    }

    Equations equations_of(const Model& model, const Case& c, const TimeSpace& space,
                           const std::vector<int>& tears) const
    {
        mixed::EndMomentum known{std::vector<Matrix34>(model.bodies().size(), Matrix34{}), {}}, turning;
        for (const Body& body : model.bodies()) {
            const Matrix34 V = body.is_point ? Matrix34{1, 2, 3} : rate(body.X, {1, 2, 3}, {0.5, -1, 2});
            turning.turning.emplace_back(body, body.X, V);
        }
        const Numbering numbering(c.given, c.start, c.multipliers, space.size(), coordinates.size,
                                  coordinates.n_rows(), firsts(space, tears));
        const TimeSpace multipliers = c.multipliers == Mixed::Multipliers::equal ? space : space.lower();
        const mixed::BlockFunctions functions(space, multipliers, 4, tears);
        return {{coordinates, functions, numbering, c.start, Mixed::EndMultiplier::smooth},
                c.given.X_at_start ? known : turning,
                c.given.X_at_end ? known : turning};
    }

    ModelTables tables;
    mixed::Coordinates coordinates;
    Equations equations;
    mixed::Tangent tangent;
    Fields fields;
};

double largest(const std::vector<double>& values)
{
    double result = 0;
    for (const double v : values) result = std::max(result, std::abs(v));
    return result;
}

/// Largest difference between J d and the central difference of the residual along d, over the largest |J d|.
double tangent_error(Block& block, SparseMatrix& J, unsigned seed)
{
    std::mt19937_64 engine(seed);
    const std::size_t n = static_cast<std::size_t>(block.unknown().size());
    std::vector<double> direction(n), product(n), ahead, behind;
    for (double& v : direction) v = 2 * (static_cast<double>(engine() >> 11) * 0x1p-53) - 1;
    block.tangent.evaluate(block.fields, J);
    J.multiply(direction, product);
    constexpr double eps = 1e-5;
    Fields moved = block.fields;
    block.unknown().add(moved, direction, eps);
    block.equations.residual(moved, ahead);
    block.unknown().add(moved, direction, -2 * eps);
    block.equations.residual(moved, behind);
    const double scale = largest(product);
    for (std::size_t i = 0; i < n; ++i) product[i] -= (ahead[i] - behind[i]) / (2 * eps);
    return largest(product) / scale;
}

TEST_P(MixedEquations, HaveTheMatrixOfTheirResidual)
{
    for (const TimeSpace& space :
         {TimeSpace::lagrange({0, 0.2, 0.5}, 2),
          TimeSpace::bspline(2, clamped_knots(2, std::vector<double>{0, 0.2, 0.5, 0.6})),
          TimeSpace::nurbs(2, {0, 0, 0, 0.3, 0.6, 0.6, 0.6}, {1, 1.3, 0.8, 1.1})}) {
        const Model model = testing_models::everything();
        Block block(model, GetParam(), space);
        SparseMatrix J;
        for (unsigned seed = 1; seed <= 3; ++seed) EXPECT_LT(tangent_error(block, J, seed), 1e-8);
    }
}

std::vector<double> even_times(int n)
{
    std::vector<double> times;
    for (int e = 0; e <= n; ++e) times.push_back(0.01 * e);
    return times;
}

/// Most of them are left out where places of entries are sorted; tears and repeated knots part them.
TEST_P(MixedEquations, HaveTheMatrixOfTheirResidualWithManyElements)
{
    const Model model = testing_models::everything();
    std::vector<double> knots = clamped_knots(2, even_times(34));
    knots.insert(knots.begin() + 18, knots[18]);
    for (const TimeSpace& space : {TimeSpace::lagrange(even_times(40), 1),
                                   TimeSpace::lagrange(even_times(33), 3), TimeSpace::bspline(2, knots)}) {
        Block block(model, GetParam(), space);
        SparseMatrix J;
        EXPECT_LT(tangent_error(block, J, 1), 1e-8);
        for (int c = 0; c < J.size; ++c)
            EXPECT_TRUE(std::is_sorted(J.rows.begin() + J.column_starts[c],
                                       J.rows.begin() + J.column_starts[c + 1], std::less_equal<>()))
                << c;
    }
}

TEST_P(TornMultipliers, HaveTheTangentOfManyElements)
{
    const Model model = testing_models::everything();
    Block block(model, GetParam(), TimeSpace::lagrange(even_times(50), 2), {2, 30, 31});
    SparseMatrix J;
    EXPECT_LT(tangent_error(block, J, 1), 1e-8);
}

TEST_P(TornMultipliers, HaveTheTangentOfTheirEquations)
{
    const Model model = testing_models::everything();
    for (const TimeSpace& space : {TimeSpace::lagrange({0, 0.2, 0.5, 0.6}, 2),
                                   TimeSpace::nurbs(2, {0, 0, 0, 0.2, 0.2, 0.5, 0.5, 0.6, 0.6, 0.6},
                                                    {1, 1.3, 0.8, 1.1, 0.9, 1, 1.2})}) {
        Block whole(model, GetParam(), space), block(model, GetParam(), space, {1, 2});
        EXPECT_EQ(block.unknown().size(), whole.unknown().size());
        EXPECT_EQ(block.fields.lambda.size() - whole.fields.lambda.size(), 2u * block.coordinates.n_rows());
        SparseMatrix J;
        for (unsigned seed = 1; seed <= 3; ++seed) EXPECT_LT(tangent_error(block, J, seed), 1e-8);
        // left and right of a tear they differ, and nowhere else
        std::vector<double> left(static_cast<std::size_t>(block.coordinates.n_rows())), right(left);
        block.unknown().evaluate_multipliers(block.fields, 0, 1, left.data());
        block.unknown().evaluate_multipliers(block.fields, 1, 0, right.data());
        EXPECT_GT(std::abs(left[0] - right[0]), 1e-3);
    }
}

TEST_P(MixedEquations, AreAsManyAsTheirUnknowns)
{
    const Model model = testing_models::everything();
    Block block(model, GetParam(), TimeSpace::lagrange({0, 0.1, 0.2, 0.3}, 3));
    std::vector<double> r;
    block.equations.residual(block.fields, r);
    EXPECT_EQ(static_cast<int>(r.size()), block.unknown().size());
    SparseMatrix J;
    EXPECT_TRUE(block.tangent.evaluate(block.fields, J));
    EXPECT_FALSE(block.tangent.evaluate(block.fields, J)) << "the pattern is kept";
    ASSERT_EQ(J.size, block.unknown().size());
    // Every row and every column has entries: none is missing by construction.
    std::vector<int> in_row(static_cast<std::size_t>(J.size), 0);
    for (int c = 0; c < J.size; ++c) {
        EXPECT_LT(J.column_starts[c], J.column_starts[c + 1]) << "column " << c;
        for (int k = J.column_starts[c]; k < J.column_starts[c + 1]; ++k) ++in_row[J.rows[k]];
    }
    EXPECT_EQ(std::count(in_row.begin(), in_row.end(), 0), 0);
}

std::vector<Case> cases_with_equal_multipliers()
{
    std::vector<Case> equal = cases();
    std::erase_if(equal, [](const Case& c) { return c.multipliers == Mixed::Multipliers::lower; });
    return equal;
}

INSTANTIATE_TEST_SUITE_P(AllPairings, MixedEquations, ::testing::ValuesIn(cases()),
                         [](const auto& of) { return of.param.name; });
INSTANTIATE_TEST_SUITE_P(AllPairings, TornMultipliers, ::testing::ValuesIn(cases_with_equal_multipliers()),
                         [](const auto& of) { return of.param.name; });

TEST(MixedEquationsPattern, GrowsWhenALoadBeginsToAct)
{
    Model model;
    const int body = model.add_body(rigid_body("box", box(1, {1, 2, 3})));
    // Stiff against turning only where it has been turned already: no entry at the start.
    Load late;
    late.name = "late";
    late.bodies = {body, world};
    late.depends_on_X = true;
    late.needs_directors[0] = true;
    late.forces = [](const LoadArguments& a, LoadForces& F) { F[0](0, 1) = a.X[0](1, 1) * a.X[0](1, 1); };
    late.tangent = [](const LoadArguments& a, LoadTangent& T) { T.X[0][0](3, 4) = 2 * a.X[0](1, 1); };
    model.add_load(late);
    const Case c{"", Mixed::Start::natural, Mixed::Multipliers::equal, {}};
    Block block(model, c, TimeSpace::lagrange({0, 0.1, 0.2}, 1));
    std::fill(block.fields.x.begin(), block.fields.x.end(), 0.0);
    SparseMatrix J;
    block.tangent.evaluate(block.fields, J);
    const int before = J.n_entries();
    block.fields.x[12 + 4] = 0.3;
    EXPECT_TRUE(block.tangent.evaluate(block.fields, J)) << "a new pattern";
    EXPECT_GT(J.n_entries(), before);
    EXPECT_LT(tangent_error(block, J, 1), 1e-8);
}

TEST(MixedEquationsResidual, NamesTheLoadThatIsNotFinite)
{
    Model model;
    const int body = model.add_body(rigid_body("box", box(1, {1, 2, 3})));
    Load broken;
    broken.name = "broken";
    broken.bodies = {body, world};
    broken.forces = [](const LoadArguments&, LoadForces& F) { F[0](0, 0) = std::nan(""); };
    model.add_load(broken);
    Block block(model, {"", Mixed::Start::natural, Mixed::Multipliers::equal, {}},
                TimeSpace::lagrange({0, 0.1}, 1));
    std::vector<double> r;
    EXPECT_EQ(block.equations.residual(block.fields, r), "the load 'broken' is not finite");
}

TEST(MixedCoordinates, RefusesASingularMassByTheBodysName)
{
    Model model;
    model.add_body(rigid_body("lamina", {1, {}, Matrix3{1, 0, 0, 0, 2, 0, 0, 0, 3}}));
    try {
        const ModelTables tables(model, {}, true);
        const mixed::Coordinates coordinates(tables);
        FAIL() << "a lamina has no inertia across its plane";
    } catch (const InputError& error) {
        EXPECT_EQ(error.complaint().code, "mass-singular");
        EXPECT_NE(error.complaint().message.find("'lamina'"), std::string::npos);
    }
}

}   // namespace
}   // namespace livens::mixed_equations_test
