// SPDX-License-Identifier: BSD-3-Clause
// What is refused of a mesh, and that sound ones pass.
#include <random>

#include "unit/geometry/shapes.h"

namespace livens::soundness_test {

namespace {

using namespace test;

/// "code: message", or empty.
std::string fault(const Mesh& mesh)
{
    const std::vector<Complaint> faults = faults_of(mesh);
    return faults.empty() ? "" : faults.front().code + ": " + faults.front().message;
}

::testing::AssertionResult is_refused(const Mesh& mesh, const std::string& code, const std::string& words)
{
    const std::string found = fault(mesh);
    if (found.starts_with(code + ":") && found.find(words) != std::string::npos)
        return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << (found.empty() ? "no fault" : found);
}

const Mesh cube = box_surface({}, {1, 1, 1});

Mesh shifted(const Mesh& mesh, const Vector3& d)
{
    return changed(mesh, [&](const Vector3& p) { return p + d; });
}

TEST(Soundness, PassesSolids)
{
    EXPECT_EQ(fault(cube), "");
    EXPECT_EQ(fault(box_surface({}, {1, 2, 3}, 9)), "");
    EXPECT_EQ(fault(ball(12)), "");
    EXPECT_EQ(fault(torus(12, 2, 0.5)), "");
    EXPECT_EQ(fault(joined(cube, shifted(cube, {2, 0, 0}))), "") << "two pieces";
    EXPECT_EQ(n_pieces(joined(cube, shifted(cube, {2, 0, 0}))), 2);
    const Mesh hollow = changed(cube, [](const Vector3& p) { return 0.5 * p + Vector3{0.25, 0.25, 0.25}; });
    EXPECT_EQ(fault(joined(cube, inside_out(hollow))), "");
    const Mesh core = changed(cube, [](const Vector3& p) { return 0.1 * p + Vector3{0.45, 0.45, 0.45}; });
    EXPECT_EQ(fault(joined(joined(cube, inside_out(hollow)), core)), "") << "a stone in the hollow";
}

/// Flat sides make triples of points that are almost on one line and quadruples almost in one plane.
TEST(Soundness, PassesFlatSidesInAnyDirection)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-1, 1);
    for (int k = 0; k < 20; ++k) {
        const Vector3 axis{any(random), any(random), any(random)};
        const double angle = 3 * any(random), c = std::cos(angle), s = std::sin(angle);
        const Vector3 u = 1 / norm(axis) * axis;
        const Matrix3 R = c * identity<3>() + s * cross_matrix(u) + (1 - c) * outer(u, u);
        const Vector3 d = (k % 2 == 0 ? 1 : 1e5) * axis;
        const Mesh mesh =
            changed(box_surface({}, {1, 2, 0.01}, 8), [&](const Vector3& p) { return R * p + d; });
        EXPECT_EQ(fault(mesh), "") << k;
    }
}

TEST(Soundness, NamesTheOpenEdge)
{
    Mesh open = cube;
    for (int k = 0; k < 3; ++k) open.blocks[0].nodes.pop_back();
    open.blocks[0].regions.pop_back();
    EXPECT_TRUE(is_refused(open, "mesh-open", "the edge from (0, 0, 1) to (0, 1, 1) of triangle 1"));
    EXPECT_TRUE(is_refused(open, "mesh-open", "(and 2 more)"));
    EXPECT_THROW(require_sound(open), InputError);
    Mesh torn = cube;   // a corner that misses by one bit
    torn.points.push_back({1, 1, std::nextafter(1.0, 0.0)});
    torn.blocks[0].nodes.back() = static_cast<std::int32_t>(torn.points.size()) - 1;
    EXPECT_TRUE(is_refused(torn, "mesh-open", "the surface is open"));
}

TEST(Soundness, NamesWhatIsInsideOutAndTurnsIt)
{
    EXPECT_TRUE(is_refused(inside_out(cube), "mesh-inverted", "is turned inside out"));
    Mesh one = cube;
    std::swap(one.blocks[0].nodes[3], one.blocks[0].nodes[4]);
    EXPECT_TRUE(is_refused(one, "mesh-inverted", "triangle 2"));
    const Mesh hollow = changed(cube, [](const Vector3& p) { return 0.5 * p + Vector3{0.25, 0.25, 0.25}; });
    EXPECT_TRUE(is_refused(joined(inside_out(cube), hollow), "mesh-inverted", "turned inside out"));
    EXPECT_TRUE(is_refused(joined(cube, hollow), "mesh-self-contact", "would count twice"));
    EXPECT_TRUE(is_refused(joined(cube, shifted(inside_out(cube), {3, 0, 0})), "mesh-inverted", "no hollow"));
    for (Mesh mesh : {inside_out(cube), one, joined(inside_out(cube), hollow), joined(cube, hollow)}) {
        turn_outwards(mesh);
        EXPECT_EQ(fault(mesh), "");
        const bool is_hollow = mesh.blocks[0].size() > 12;
        EXPECT_DOUBLE_EQ(moments(mesh).volume, is_hollow ? 0.875 : 1);
    }
}

TEST(Soundness, NamesEdgesOfMoreThanTwoFaces)
{
    // Two cubes with one edge in common.
    Mesh both = joined(cube, shifted(cube, {1, 1, 0}));
    for (std::int32_t& node : both.blocks[0].nodes)
        for (std::int32_t k = 0; k < 8; ++k)
            if (both.points[node] == cube.points[k]) node = k;
    EXPECT_TRUE(is_refused(both, "mesh-non-manifold", "belongs to 4 faces"));
    Mesh twice = cube;
    twice.blocks[0].nodes[1] = twice.blocks[0].nodes[0];
    EXPECT_TRUE(is_refused(twice, "mesh-non-manifold", "twice"));
}

TEST(Soundness, NamesWhereASurfaceMeetsItself)
{
    Mesh corner = joined(cube, shifted(cube, {1, 1, 1}));   // one point in common
    for (std::int32_t& node : corner.blocks[0].nodes)
        for (std::int32_t k = 0; k < 8; ++k)
            if (corner.points[node] == cube.points[k]) node = k;
    EXPECT_TRUE(is_refused(corner, "mesh-self-contact", "touch at a point"));
    EXPECT_TRUE(
        is_refused(joined(cube, shifted(cube, {0.5, 0.3, 0.2})), "mesh-self-contact", "touch or cross"));
    EXPECT_TRUE(is_refused(joined(cube, shifted(cube, {1, 0.3, 0.2})), "mesh-self-contact", "touch or cross"))
        << "face on face";
    EXPECT_TRUE(is_refused(joined(cube, shifted(cube, {1, 1, 1})), "mesh-self-contact", "touch or cross"))
        << "a point of its own on a point";
    EXPECT_EQ(fault(joined(cube, shifted(cube, {1 + 1e-9, 0.3, 0.2}))), "") << "a gap";
    // A dent through the opposite side: connected, closed, and crossing itself.
    Mesh dent = box_surface({}, {1, 1, 1}, 2);
    for (Vector3& p : dent.points)
        if (p == Vector3{0.5, 0.5, 1}) p[2] = -0.2;
    EXPECT_TRUE(is_refused(dent, "mesh-self-contact", "touch or cross"));
    // Folded onto itself: two neighbours in one plane, on the same side of their edge.
    Mesh flat = empty_mesh(ElementKind::triangle);
    flat.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, 0}};
    for (const auto& f : {std::array{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}})
        add(flat, {f[0], f[1], f[2]});
    EXPECT_TRUE(is_refused(flat, "mesh-self-contact", "touch or cross"));
}

TEST(Soundness, OfVolumesLooksAtJacobiansAndFaces)
{
    const auto grid = [](double u, double v, double w) { return Vector3{u, v, w}; };
    for (const ElementKind kind :
         {ElementKind::tetrahedron, ElementKind::hexahedron, ElementKind::tetrahedron10}) {
        SCOPED_TRACE(name_of(kind));
        const Mesh good = volume_over({2, 2, 2}, kind, grid);
        EXPECT_EQ(fault(good), "");
        EXPECT_EQ(n_pieces(good), 1);
        const auto mirror = [](const Vector3& p) { return Vector3{-p[0], p[1], p[2]}; };
        Mesh mirrored = changed(good, mirror);
        EXPECT_TRUE(is_refused(mirrored, "mesh-inverted", "1 is turned inside out"));
        turn_outwards(mirrored);
        EXPECT_EQ(fault(mirrored), "");
        EXPECT_NEAR(moments(mirrored).volume, 1, 1e-14);
        Mesh twice = good;
        const int n = n_nodes(kind);
        twice.blocks[0].nodes.insert(twice.blocks[0].nodes.end(), good.blocks[0].nodes.begin(),
                                     good.blocks[0].nodes.begin() + n);
        twice.blocks[0].regions.push_back(0);
        EXPECT_TRUE(is_refused(twice, "mesh-non-manifold", "face"));
    }
    Mesh folded = volume_over({1, 1, 1}, ElementKind::tetrahedron10, grid);
    folded.points[folded.blocks[0].nodes[4]] = folded.points[folded.blocks[0].nodes[2]];
    EXPECT_TRUE(is_refused(folded, "mesh-inverted", "is folded"));
}

}   // namespace

}   // namespace livens::soundness_test
