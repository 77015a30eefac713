// SPDX-License-Identifier: BSD-3-Clause
// Whether a surface meets itself, against all pairs of edges and faces.
#include <algorithm>
#include <array>
#include <random>

#include "unit/geometry/shapes.h"

namespace livens::contacts_test {

namespace {

using namespace test;
using Corners = std::array<std::int32_t, 3>;

/// Six times the volume of a tetrahedron, with more digits than the library has.
long double six_volumes(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d)
{
    std::array<std::array<long double, 3>, 3> m;
    for (int i = 0; i < 3; ++i) {
        m[0][i] = static_cast<long double>(b[i]) - a[i];
        m[1][i] = static_cast<long double>(c[i]) - a[i];
        m[2][i] = static_cast<long double>(d[i]) - a[i];
    }
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

bool contains(const Corners& t, std::int32_t point) { return std::ranges::find(t, point) != t.end(); }

/// Of points in general position, as random ones are: the edge has an end on each side of the plane, and
/// passes the three sides of the triangle on one side of each.
bool crosses(const std::vector<Vector3>& p, std::int32_t from, std::int32_t to, const Corners& t)
{
    if (contains(t, from) || contains(t, to)) return false;   // straight lines meet planes once
    const auto side = [&](int i, int j) { return six_volumes(p[from], p[to], p[t[i]], p[t[j]]) > 0; };
    const bool above = six_volumes(p[t[0]], p[t[1]], p[t[2]], p[from]) > 0;
    return above != (six_volumes(p[t[0]], p[t[1]], p[t[2]], p[to]) > 0) && side(0, 1) == side(1, 2) &&
           side(1, 2) == side(2, 0);
}

bool meets_itself(const Mesh& mesh)
{
    const std::vector<std::int32_t>& nodes = mesh.blocks[0].nodes;
    for (std::size_t a = 0; a < nodes.size(); a += 3)
        for (std::size_t b = 0; b < nodes.size(); b += 3)
            for (int i = 0; i < 3; ++i)
                if (a != b && crosses(mesh.points, nodes[a + i], nodes[a + (i + 1) % 3],
                                      {nodes[b], nodes[b + 1], nodes[b + 2]}))
                    return true;
    return false;
}

bool is_refused(const Mesh& mesh)
{
    for (const Complaint& fault : faults_of(mesh))
        if (fault.message.find("touch or cross") != std::string::npos) return true;
    return false;
}

class Contacts : public ::testing::Test {
protected:
    void compare(const Mesh& mesh, const std::string& what)
    {
        const bool expected = meets_itself(mesh);
        ++n_[expected];
        ASSERT_EQ(is_refused(mesh), expected) << what;
    }
    Vector3 any(double size)
    {
        std::uniform_real_distribution<double> number(-size, size);
        return {number(random_), number(random_), number(random_)};
    }
    void expect_both_often() const { EXPECT_GT(std::min(n_[0], n_[1]), 12) << n_[0] << " and " << n_[1]; }

    std::mt19937 random_{3};
    std::array<int, 2> n_{};
};

TEST_F(Contacts, LONG_OfSurfacesWithMovedPointsAreThoseOfAllPairs)
{
    for (const Mesh& mesh : {ball(6), torus(8, 2, 0.5), box_surface({}, {1, 1, 1}, 3)})
        for (const double size : {0.05, 0.1, 0.15, 0.2, 0.3})
            for (int k = 0; k < 20; ++k)
                compare(changed(mesh, [&](const Vector3& p) { return p + any(size); }), std::to_string(size));
    expect_both_often();
}

/// One point far from where it was: its neighbours become needles and spikes through what lies there.
TEST_F(Contacts, LONG_OfSurfacesWithASpikeAreThoseOfAllPairs)
{
    for (const Mesh& mesh : {ball(8), torus(9, 2, 0.7)})
        for (int k = 0; k < 80; ++k) {
            Mesh spike = changed(mesh, [&](const Vector3& p) { return p + any(1e-3); });
            spike.points[random_() % spike.points.size()] += any(2.5);
            compare(spike, std::to_string(k));
        }
    expect_both_often();
}

/// Of very different sizes, near each other and apart.
TEST_F(Contacts, LONG_OfPiecesAreThoseOfAllPairs)
{
    for (int k = 0; k < 150; ++k) {
        const double size = std::pow(10, -(k % 5));
        const auto small = changed(ball(5), [&](const Vector3& p) { return size * (p + any(0.01)); });
        const Vector3 off = any(1), place = (1 + any(1.5 * size)[0]) / norm(off) * off;
        const Mesh mesh = joined(changed(ball(6), [&](const Vector3& p) { return p + any(1e-3); }),
                                 changed(small, [&](const Vector3& p) { return p + place; }));
        compare(mesh, std::to_string(k));
    }
    expect_both_often();
}

/// A block in a block, whose upper side comes through that of the outer one with a low dome: both look up.
/// They meet where a point of the dome lies above the flat side. A ball far above, for nothing is proved of
/// sheets at the rim of all.
TEST_F(Contacts, OfSheetsThatLieCloseAreWhereADomeComesThrough)
{
    const Mesh outer =
        joined(box_surface({-1, -1, -1}, {1, 1, 1e-3}, 40), changed(ball(3), [](const Vector3& p) {
                   return p + Vector3{0, 0, 5};
               }));
    for (const double height : {0.1e-3, 0.5e-3, 0.99e-3, 1.01e-3, 1.1e-3, 1.5e-3, 3e-3}) {
        const Mesh inner = changed(box_surface({-0.9, -0.9, -0.9}, {0.9, 0.9, 0}, 40), [&](const Vector3& p) {
            const double dome = height * std::exp(-8 * (p[0] * p[0] + p[1] * p[1]));
            return p + Vector3{0, 0, p[2] == 0 ? dome : 0};
        });
        EXPECT_EQ(is_refused(joined(outer, inner)), height > 1e-3) << height;
    }
}

/// A thin plate with waves whose upper side dips in places down to the lower one, and through it.
TEST_F(Contacts, LONG_OfAThinPlateAreThoseOfAllPairs)
{
    const Mesh plate = box_surface({-1, -1, -0.02}, {1, 1, 0.02}, 7);
    for (int k = 0; k < 80; ++k) {
        const Vector3 at = any(0.9);
        const double depth = 0.01 + 0.05 * std::abs(any(1)[0]), width = 0.2 + 0.2 * std::abs(any(1)[0]);
        compare(changed(plate,
                        [&](const Vector3& p) {
                            const double r = std::hypot(p[0] - at[0], p[1] - at[1]) / width;
                            const double dip = p[2] > 0 ? depth * std::exp(-r * r) : 0;
                            const double wave = 0.2 * std::sin(2 * p[0] + p[1]);
                            return Vector3{p[0], p[1], p[2] - dip + wave} + any(1e-5);
                        }),
                std::to_string(k));
    }
    expect_both_often();
}

/// A flat ring that goes round twice before it closes, like a staircase: seen from above it lies over itself,
/// and its turns cross where they are close.
TEST_F(Contacts, LONG_OfAStaircaseAreThoseOfAllPairs)
{
    for (int k = 0; k < 80; ++k) {
        const double height = 0.05 * std::abs(any(1)[0]);
        compare(surface_over(32, 8,
                             [&](double u, double v) {
                                 const double a = 4 * pi * u, b = 2 * pi * v;
                                 const double r = 1 + 0.3 * std::cos(a / 2) + 0.2 * std::cos(b);
                                 return Vector3{r * std::cos(a), r * std::sin(a),
                                                height * std::sin(a / 2) + 0.02 * std::sin(b)};
                             }),
                std::to_string(k));
    }
    expect_both_often();
}

/// Two pyramids over a pentagram: at their tips all faces turn the same way, but go round twice.
TEST_F(Contacts, AreSeenInAFanThatGoesRoundTwice)
{
    for (const int rounds : {1, 2}) {
        Mesh star = empty_mesh(ElementKind::triangle);
        for (int k = 0; k < 5; ++k) {
            const double angle = 2 * pi * rounds * k / 5;
            star.points.push_back({std::cos(angle), std::sin(angle), 0.01 * k});
        }
        star.points.insert(star.points.end(), {{0, 0, 1}, {0, 0, -1}});
        for (std::int32_t k = 0; k < 5; ++k) {
            add(star, {k, (k + 1) % 5, 5});
            add(star, {(k + 1) % 5, k, 6});
        }
        compare(star, std::to_string(rounds));
    }
    EXPECT_EQ(n_[0], 1);
    EXPECT_EQ(n_[1], 1);
}

}   // namespace

}   // namespace livens::contacts_test
