// SPDX-License-Identifier: BSD-3-Clause
// How deep pieces lie in each other, against the solid angles of all faces; and where there are too many.
#include <ctime>
#include <random>

#include "livens/geometry/detail/depths.h"
#include "sanitized.h"
#include "unit/geometry/shapes.h"

namespace livens::depths_test {

namespace {

using namespace test;

/// The definition: faces seen from a point, piece by piece.
int depth_by_views(const Facets& f, const Pieces& pieces, const Vector3& p, std::int32_t own,
                   bool as_if_outwards)
{
    std::vector<double> seen(pieces.n, 0.0);
    for (std::int32_t face = 0; face < f.n_faces(); ++face)
        seen[pieces.of(face)] += share_of_view(f, face, p);
    double depth = 0;
    for (std::int32_t k = 0; k < pieces.n; ++k)
        if (k != own) depth += as_if_outwards ? std::abs(seen[k]) : seen[k];
    return static_cast<int>(std::lround(depth));
}

class DepthsOf : public ::testing::Test {
protected:
    double number(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
    Vector3 any(double size) { return {number(-size, size), number(-size, size), number(-size, size)}; }

    void compare(const Mesh& mesh, const std::vector<Vector3>& points, const std::string& what)
    {
        const Facets f(mesh);
        const Pieces pieces = pieces_of(f);
        const Triangles triangles(f);
        Depths depths(f, triangles, pieces);
        for (const Vector3& p : points)
            for (const bool as_if_outwards : {false, true}) {
                const auto own = static_cast<std::int32_t>(random_() % static_cast<unsigned>(pieces.n));
                const int expected = depth_by_views(f, pieces, p, own, as_if_outwards);
                ASSERT_EQ(depths.of(p, own, as_if_outwards), expected) << what;
                deepest_ = std::max(deepest_, std::abs(expected));
            }
        EXPECT_FALSE(depths.is_beyond());
    }

    std::mt19937 random_{5};
    int deepest_ = 0;
};

TEST_F(DepthsOf, PiecesAnywhereAreThoseOfSolidAngles)
{
    for (int k = 0; k < 40; ++k) {
        Mesh mesh = empty_mesh(ElementKind::triangle);
        for (int n = 0; n < 12; ++n) {
            const double size = std::pow(10, number(-1, 0.5));
            const Vector3 at = any(1);
            const Mesh one = changed(n % 3 == 0 ? torus(6, 1, 0.4) : ball(5),
                                     [&](const Vector3& p) { return size * p + at; });
            mesh = joined(std::move(mesh), n % 4 == 1 ? inside_out(one) : one);
        }
        std::vector<Vector3> points;
        for (int n = 0; n < 30; ++n) points.push_back(any(1.5));
        compare(mesh, points, std::to_string(k));
    }
    EXPECT_GT(deepest_, 4);
}

/// Lines through corners and along edges and faces say nothing.
TEST_F(DepthsOf, BlocksInAGridAreThoseOfSolidAngles)
{
    Mesh mesh = empty_mesh(ElementKind::triangle);
    for (int n = 1; n < 5; ++n) {
        const double size = 2 * n;
        const Mesh block = box_surface({-size, -size, -size}, {size, size, size}, 2 * n);
        mesh = joined(std::move(mesh), n % 2 == 0 ? block : inside_out(block));
    }
    for (int i = 0; i < 3; ++i)
        mesh = joined(std::move(mesh), box_surface({20, 4. * i, 0}, {22, 4. * i + 2, 2}));
    std::vector<Vector3> points;
    for (int n = 0; n < 300;
         ++n) {   // in the middle of two walls, as for all else right in line with corners
        Vector3 p = any(1);
        for (int i = 0; i < 3; ++i) p[i] = std::round(8 * p[i]);
        p[static_cast<int>(random_() % 3)] = number(0, 1) < 0.5 ? 1 : 5;
        const double out = std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
        if (out != std::round(out / 2) * 2) points.push_back(p);
    }
    ASSERT_GT(points.size(), 30U);
    compare(mesh, points, "grid");
}

TEST_F(DepthsOf, OpenPiecesAreThoseOfSolidAngles)
{
    Mesh open = changed(ball(6), [](const Vector3& p) { return 2 * p; });
    for (int k = 0; k < 3; ++k) open.blocks[0].nodes.pop_back();
    open.blocks[0].regions.pop_back();
    std::vector<Vector3> points;
    for (int n = 0; n < 100; ++n) points.push_back(any(2.5));
    compare(joined(open, ball(4)), points, "open");
}

Mesh nested(int n)
{
    Mesh tetrahedron = empty_mesh(ElementKind::triangle);
    tetrahedron.points = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    for (const auto& f : {std::array{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}})
        add(tetrahedron, {f[0], f[1], f[2]});
    Mesh mesh = empty_mesh(ElementKind::triangle);
    mesh.name = "shells.stl";
    for (int k = 0; k < n; ++k)
        mesh = joined(std::move(mesh),
                      changed(tetrahedron, [&](const Vector3& p) { return (1 + 1.0 * k / n) * p; }));
    return mesh;
}

/// 20,000 triangles: 12.5 million pairs of pieces and 200 million of faces, which took 12 s of CPU time, and
/// the turning of them 5 s.
TEST(Nested, ShellsAreRefusedByTheirNumberInNoTime)
{
    if (is_sanitized) GTEST_SKIP() << study;
    Mesh mesh = nested(5000);
    const std::clock_t begin = std::clock();
    turn_outwards(mesh);
    const std::vector<Complaint> faults = faults_of(mesh);
#ifdef NDEBUG   // as it is used, without sanitizers
    EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 5);
#else
    static_cast<void>(begin);
#endif
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_EQ(faults[0].code, "mesh-self-contact");
    EXPECT_NE(faults[0].message.find("shells.stl: more than 61000000 pairs of its 20000 faces"),
              std::string::npos)
        << faults[0].message;
}

TEST(Nested, ShellsAreFoundToBeSoundWhereTheyAreFew)
{
    Mesh mesh = nested(300);
    turn_outwards(mesh);
    EXPECT_EQ(faults_of(mesh).size(), 0U);
    std::swap(mesh.blocks[0].nodes[12 * 150], mesh.blocks[0].nodes[12 * 150 + 1]);
    EXPECT_GT(faults_of(mesh).size(), 0U);
}

}   // namespace

}   // namespace livens::depths_test
