// SPDX-License-Identifier: BSD-3-Clause
// Integrals over meshes against closed forms.
#include "unit/geometry/shapes.h"

namespace livens::moments_test {

namespace {

using namespace test;

double gap(const Matrix3& a, const Matrix3& b) { return norm(a - b) / norm(b); }

Matrix3 diagonal(double a, double b, double c) { return {a, 0, 0, 0, b, 0, 0, 0, c}; }

/// int (x - c)(x - c)^T of a box.
Matrix3 second_of_box(const Vector3& e)
{
    const double V = e[0] * e[1] * e[2];
    return V / 12 * diagonal(e[0] * e[0], e[1] * e[1], e[2] * e[2]);
}

void expect_moments(const Moments& m, double volume, const Vector3& centroid, const Matrix3& second,
                    double bound)
{
    EXPECT_NEAR(m.volume, volume, bound * volume);
    EXPECT_LE(norm(m.centroid - centroid), bound * std::cbrt(volume) + 1e-15 * norm(centroid));
    EXPECT_LE(gap(m.second, second), bound);
}

constexpr auto unchanged = [](double u, double v, double w) { return Vector3{u, 2 * v, 3 * w}; };

TEST(Moments, OfABoxAreExactFromEveryKindOfElement)
{
    const Vector3 edges{1, 2, 3}, centre{0.5, 1, 1.5};
    const Matrix3 second = second_of_box(edges);
    expect_moments(moments(box_surface({}, edges)), 6, centre, second, 1e-15);
    expect_moments(moments(box_surface({}, edges, 7)), 6, centre, second, 2e-15);
    for (const ElementKind kind :
         {ElementKind::tetrahedron, ElementKind::hexahedron, ElementKind::tetrahedron10})
        for (const int n : {1, 3}) {
            SCOPED_TRACE(name_of(kind));
            const Mesh mesh = volume_over({n, n, n}, kind, unchanged);
            EXPECT_TRUE(faults_of(mesh).empty());
            expect_moments(moments(mesh), 6, centre, second, 2e-15);
            expect_moments(moments(boundary_of(mesh)), 6, centre, second, 2e-15);
        }
}

/// The control sums about the origin and shifts afterwards, as is often done.
TEST(Moments, OfABoxFarAwayLoseNothing)
{
    const Mesh here = box_surface({}, {1, 2, 3}, 4);
    const Vector3 away{1e6, -1e6, 1e6};
    const Mesh far = changed(here, [&](const Vector3& p) { return p + away; });
    const Matrix3 exact = second_of_box({1, 2, 3});
    EXPECT_LE(gap(moments(far).second, exact), 1e-15);
    EXPECT_EQ(moments(far).centroid, (Vector3{0.5, 1, 1.5} + away));
    double volume = 0;
    Vector3 first{};
    Matrix3 second{};
    for (std::int64_t e = 0; e < far.blocks[0].size(); ++e) {
        const std::int32_t* n = far.blocks[0].element(e);
        const Vector3 a = far.points[n[0]], b = far.points[n[1]], c = far.points[n[2]], s = a + b + c;
        const double six = dot(a, cross(b, c));
        volume += six / 6;
        first += six / 24 * s;
        second += six / 120 * (outer(s, s) + outer(a, a) + outer(b, b) + outer(c, c));
    }
    EXPECT_GT(gap(second - 1 / volume * outer(first, first), exact), 0.5);
}

TEST(Moments, OfARotatedMeshAreRotated)
{
    const Mesh mesh = changed(torus(12, 2, 0.5), [](const Vector3& p) {
        return Vector3{p[0], 0.5 * p[1] + 0.1 * p[2], p[2]};
    });
    const Moments m = moments(mesh);
    const double c = std::cos(0.7), s = std::sin(0.7);
    const Matrix3 R = Matrix3{c, s, 0, -s, c, 0, 0, 0, 1} * Matrix3{1, 0, 0, 0, s, -c, 0, c, s};
    const Vector3 d{1, -2, 3};
    const Moments turned_mesh = moments(changed(mesh, [&](const Vector3& p) { return R * p + d; }));
    const Moments turned_moments = moved(m, R, d);
    EXPECT_NEAR(turned_mesh.volume, m.volume, 1e-14 * m.volume);
    EXPECT_LE(gap(turned_mesh.second, R * m.second * transpose(R)), 1e-14);
    EXPECT_LE(gap(turned_mesh.second, turned_moments.second), 1e-14);
    EXPECT_LE(norm(turned_mesh.centroid - turned_moments.centroid), 1e-14);
    EXPECT_GT(gap(turned_mesh.second, m.second), 0.1) << "the rotation changes nothing";
}

struct Solid {
    const char* name;
    Mesh (*mesh)(int n);
    double volume;
    Vector3 centroid;
    Matrix3 second;
    double order;
};

std::vector<Solid> curved_solids()
{
    const double ball_second = 4 * pi / 15, cone_V = pi * 2 / 3;
    const double R = 2, r = 0.5, torus_V = 2 * pi * pi * R * r * r;
    const double torus_x = torus_V * (R * R / 2 + 3 * r * r / 8), torus_z = torus_V * r * r / 4;
    const double tube_V = pi * (4 - 1) * 1.5, tube_x = tube_V * (4 + 1) / 4, tube_z = tube_V * 1.5 * 1.5 / 12;
    return {
        {"ball",
         [](int n) { return ball(2 * n); },
         4 * pi / 3,
         {},
         diagonal(ball_second, ball_second, ball_second),
         2},
        {"torus",
         [](int n) { return torus(2 * n, 2, 0.5); },
         torus_V,
         {},
         diagonal(torus_x, torus_x, torus_z),
         2},
        {"cone",
         [](int n) {
             return turned(4 * n, {{0, 0}, {1, 0}, {0, 2}});
         },
         cone_V,
         {0, 0, 0.5},
         diagonal(cone_V * 3 / 20, cone_V * 3 / 20, cone_V * 4 * 3 / 80),
         2},
        {"tube",
         [](int n) { return tube(n, ElementKind::tetrahedron, 1, 2, 1.5); },
         tube_V,
         {0, 0, 0.75},
         diagonal(tube_x, tube_x, tube_z),
         2},
        {"tube of bricks",
         [](int n) { return tube(n, ElementKind::hexahedron, 1, 2, 1.5); },
         tube_V,
         {0, 0, 0.75},
         diagonal(tube_x, tube_x, tube_z),
         2},
        {"curved tube",
         [](int n) { return tube(n, ElementKind::tetrahedron10, 1, 2, 1.5); },
         tube_V,
         {0, 0, 0.75},
         diagonal(tube_x, tube_x, tube_z),
         4},
    };
}

TEST(Moments, LONG_OfCurvedSolidsConvergeWithTheirOrder)
{
    for (const Solid& solid : curved_solids()) {
        SCOPED_TRACE(solid.name);
        std::vector<double> of_volume, of_second;
        for (const int n : {2, 4, 8}) {
            const Mesh mesh = solid.mesh(n);
            const std::vector<Complaint> faults = faults_of(mesh);
            ASSERT_TRUE(faults.empty()) << faults.front().message;
            const Moments m = moments(mesh);
            EXPECT_LE(norm(m.centroid - solid.centroid), 1e-14);
            of_volume.push_back(std::abs(m.volume / solid.volume - 1));
            of_second.push_back(gap(m.second, solid.second));
        }
        for (const auto& errors : {of_volume, of_second}) {
            EXPECT_NEAR(std::log2(errors[1] / errors[2]), solid.order, 0.15);
            EXPECT_GT(errors[2], 1e-12) << "too fine to tell an order";
        }
    }
}

TEST(Moments, OfASurfaceAreThoseOfItsVolume)
{
    for (const ElementKind kind :
         {ElementKind::tetrahedron, ElementKind::hexahedron, ElementKind::tetrahedron10}) {
        SCOPED_TRACE(name_of(kind));
        const Mesh volume = tube(3, kind, 0.7, 2, 1.5);
        const Mesh surface = boundary_of(volume);
        ASSERT_TRUE(faults_of(surface).empty()) << faults_of(surface).front().message;
        const Moments v = moments(volume), s = moments(surface);
        EXPECT_NEAR(s.volume, v.volume, 1e-14 * v.volume);
        EXPECT_LE(gap(s.second, v.second), 1e-14);
        EXPECT_LE(norm(s.centroid - v.centroid), 1e-14);
    }
}

/// Files that Gmsh wrote: a plate of 4 x 2 x 0.5 about the origin with a bore of radius 0.5 along z at x =
/// 0.5.
TEST(Moments, OfGmshsBracketAreTheSameFromAllItsFormats)
{
    const std::string folder = LIVENS_SOURCE_DIR "/tests/unit/geometry/data/";
    const double bore = pi * 0.25 * 0.5, V = 4 - bore;
    const Vector3 centroid{-0.5 * bore / V, 0, 0};
    const Matrix3 second = second_of_box({4, 2, 0.5}) -
                           bore * diagonal(0.25 / 4 + 0.25, 0.25 / 4, 0.25 / 12) -
                           V * outer(centroid, centroid);
    const Moments first = moments(read_mesh_file(folder + "bracket_41_ascii.msh"));
    expect_moments(first, V, centroid, second, 1e-3);
    for (const char* file : {"bracket_41_binary.msh", "bracket_22_ascii.msh", "bracket_22_binary.msh"}) {
        SCOPED_TRACE(file);
        const Mesh mesh = read_mesh_file(folder + file);
        EXPECT_TRUE(faults_of(mesh).empty());
        EXPECT_EQ(mesh.n_elements(3), mesh.block(ElementKind::tetrahedron10)->size());
        expect_moments(moments(mesh), first.volume, first.centroid, first.second, 1e-15);
        const Mesh surface = boundary_of(mesh);
        EXPECT_TRUE(faults_of(surface).empty());
        expect_moments(moments(surface), first.volume, first.centroid, first.second, 1e-14);
        bool has_hole = false, has_steel = false;
        for (const Region& region : mesh.regions) {
            has_hole |= region.names == std::vector<std::string>{"hole"} && region.dimension == 2;
            has_steel |= region.names == std::vector<std::string>{"steel"} && region.dimension == 3;
        }
        EXPECT_TRUE(has_hole && has_steel);
    }
    const Mesh flat = read_mesh_file(folder + "bracket.stl");
    EXPECT_TRUE(faults_of(flat).empty());
    expect_moments(moments(flat), V, centroid, second, 0.02);
}

TEST(Moments, OfRegionsAreTheirOwn)
{
    for (const char* file : {"two_bricks_41.msh", "two_bricks_22.msh"}) {
        SCOPED_TRACE(file);
        const Mesh mesh = read_mesh_file(std::string(LIVENS_SOURCE_DIR "/tests/unit/geometry/data/") + file);
        EXPECT_EQ(n_pieces(mesh), 1);
        const std::vector<Moments> of = region_moments(mesh);
        std::vector<double> densities(of.size(), 0);
        for (std::size_t r = 0; r < of.size(); ++r) {
            if (mesh.regions[r].dimension != 3) continue;
            const bool is_light = mesh.regions[r].names.front() == "light";
            expect_moments(of[r], is_light ? 1 : 2, {is_light ? 0.5 : 2, 0.5, 0.5},
                           second_of_box({is_light ? 1. : 2., 1, 1}), 3e-15);
            densities[r] = is_light ? 1 : 5;
        }
        const Moments whole = combined(of, densities);
        EXPECT_NEAR(whole.volume, 11, 1e-14);
        EXPECT_NEAR(whole.centroid[0], (0.5 + 20) / 11, 1e-15);
        EXPECT_NEAR(whole.second(0, 0), 1. / 12 + 0.25 + 5 * (8. / 12 + 8) - 20.5 * 20.5 / 11, 1e-13);
    }
}

TEST(Moments, FollowTheUnit)
{
    const Moments m = scaled(moments(box_surface({}, {1000, 2000, 3000})), 1e-3);
    expect_moments(m, 6, {0.5, 1, 1.5}, second_of_box({1, 2, 3}), 1e-15);
}

TEST(Moments, OfUnionsKeepTheirDigitsFarAway)
{
    const Vector3 away{1e6, 0, 0};
    const Moments block = moved(moments(box_surface({-2, -1, -1}, {2, 1, 1})), identity<3>(), away);
    const Moments hole = moved(moments(box_surface({-1, -0.5, -1}, {1, 0.5, 1})), identity<3>(), away);
    const Moments parts[] = {block, hole};
    const double weights[] = {2, -2};
    const Moments m = combined(parts, weights);
    EXPECT_EQ(m.centroid, away);
    EXPECT_LE(gap(m.second, 2 * (second_of_box({4, 2, 2}) - second_of_box({2, 1, 2}))), 1e-15);
}

}   // namespace

}   // namespace livens::moments_test
