// SPDX-License-Identifier: BSD-3-Clause
// Order 2p under loads of every kind, against Newton's and Euler's equations with quaternions.
#include "convergence/studies.h"
#include "livens/multibody/loads/surface_loads.h"
#include "newton_euler.h"

namespace livens::tests::loads_test {
namespace {

struct Loaded {
    std::string name;
    Model model;
    Pushes pushes;   ///< the same loads, for the witness
};

TimeFunction cosine(double amplitude, double rate)
{
    return {[=](Instant at) {
                return TimeValue{amplitude * std::cos(rate * at.t), -amplitude * rate * std::sin(rate * at.t),
                                 -amplitude * rate * rate * std::cos(rate * at.t)};
            },
            {}};
}

/// Reference point off the centre of mass, moving and turning.
Model flying_brick()
{
    Placement placement;
    placement.position = {0.2, 0.1, -0.3};
    placement.directors = directors_from_rotation_vector({0.3, -0.4, 0.8});
    placement.velocity = {0.5, -0.2, 0.4};
    placement.angular_velocity = {0.6, 1.1, -0.7};
    Model model({0, 0, -9.81});
    model.add_body(
        rigid_body("brick", with_center(with_mass(box(1, {1, 0.6, 0.4}), 2), {0.3, 0.1, -0.05}), placement));
    return model;
}

/// From a world point to a point of the brick, in the model and for the witness.
Loaded on_springs(const std::string& name, const std::vector<SpringDamper>& laws)
{
    const std::vector<Vector3> posts{{0.4, 0.3, 1.4}, {-1.3, 0.2, 0.5}};
    const std::vector<Vector3> eyes{{0.8, 0.1, 0.2}, {-0.2, 0.2, 0.1}};
    Loaded loaded{name, flying_brick(), {}};
    for (std::size_t i = 0; i < laws.size(); ++i)
        loaded.model.add_load(
            spring_damper("spring " + std::to_string(i), world, posts[i], 0, eyes[i], laws[i]));
    loaded.pushes = [=](double, Movers& bodies) {
        Mover& brick = bodies[0];
        for (std::size_t i = 0; i < laws.size(); ++i)
            brick.push(eyes[i], spring_pull(brick.at(eyes[i]), brick.velocity(eyes[i]), posts[i], {},
                                            laws[i].stiffness, laws[i].damping, laws[i].free_length));
    };
    return loaded;
}

Loaded under_a_follower_force()
{
    Loaded loaded{"a force that turns with the body", flying_brick(), {}};
    const Vector3 eye{0.8, -0.2, 0.1}, force{3, -5, 8};
    loaded.model.add_load(point_force("jet", 0, eye, {force[0], force[1], force[2]}, Frame::body_fixed));
    loaded.pushes = [=](double, Movers& bodies) { bodies[0].push(eye, bodies[0].R * force); };
    return loaded;
}

Loaded under_a_torque(Frame frame)
{
    const bool is_fixed = frame == Frame::body_fixed;
    Loaded loaded{is_fixed ? "a torque in body axes that varies in time" : "a torque that varies in time",
                  flying_brick(),
                  {}};
    loaded.model.add_load(torque("motor", 0, {cosine(1.5, 4), 0.4, cosine(-0.8, 7)}, frame));
    loaded.pushes = [=](double t, Movers& bodies) {
        const Vector3 mu{1.5 * std::cos(4 * t), 0.4, -0.8 * std::cos(7 * t)};
        bodies[0].torque += is_fixed ? bodies[0].R * mu : mu;
    };
    return loaded;
}

/// Pressures on five sides of the brick, which grow with the depth; the witness takes them at points of the
/// sides.
Loaded under_water()
{
    Loaded loaded{"pressure that follows five sides", flying_brick(), {}};
    Mesh mesh;
    const Vector3 c{0.3, 0.1, -0.05}, half{0.5, 0.3, 0.2}, gradient{3, -5, -40};
    for (int k = 0; k < 8; ++k) {
        Vector3 corner = c;
        for (int i = 0; i < 3; ++i) corner[i] += (k >> i & 1) != 0 ? half[i] : -half[i];
        mesh.points.push_back(corner);
    }
    const double value = 12;
    mesh.regions.resize(1);
    mesh.blocks = {{ElementKind::quadrilateral,
                    {0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4, 2, 6, 7, 3, 0, 2, 3, 1},
                    std::vector<std::int32_t>(5, 0)}};
    loaded.model.add_load(pressure("water", 0, surface_moments(mesh)[0].moments, value,
                                   {gradient[0], gradient[1], gradient[2]}));
    loaded.pushes = [=](double, Movers& bodies) {
        Mover& brick = bodies[0];
        for (int side = 0; side < 5; ++side) {
            const int i = side / 2, j = (i + 1) % 3, k = (i + 2) % 3;
            Vector3 normal{};
            normal[i] = side == 1 || side == 3 ? 1 : -1;
            for (const double u : {-1., 1.})
                for (const double v : {-1., 1.}) {   // Gauss
                    Vector3 theta = c + half[i] * normal;
                    theta[j] += u * half[j] / std::sqrt(3.);
                    theta[k] += v * half[k] / std::sqrt(3.);
                    const double p = value + dot(gradient, brick.at(theta));
                    brick.push(theta, -p * half[j] * half[k] * (brick.R * normal));
                }
        }
    };
    return loaded;
}

/// All of them on two bodies that a spring joins.
Loaded under_everything()
{
    Loaded loaded{"everything on two bodies", flying_brick(), {}};
    Placement placement;
    placement.position = {1.5, 0.4, 0.2};
    placement.angular_velocity = {-0.5, 0.3, 1.2};
    loaded.model.add_body(rigid_body("other", with_mass(box(1, {0.5, 0.5, 0.8}), 1), placement));
    const SpringDamper law{60, 1.2, 0.6}, hook{80, 0, 0};
    const Vector3 from{0.8, 0.2, 0}, to{-0.2, 0.1, 0.3}, post{1.4, 0.2, 1.1}, eye{0.1, 0.1, 0.4};
    const Vector3 force{0, 2, 1};
    loaded.model.add_load(spring_damper("strut", 0, from, 1, to, law));
    loaded.model.add_load(spring_damper("hook", world, post, 1, eye, hook));
    loaded.model.add_load(point_force("jet", 1, eye, {force[0], force[1], force[2]}, Frame::body_fixed));
    loaded.model.add_load(torque("motor", 0, {0.3, cosine(1, 5), 0}, Frame::body_fixed));
    loaded.pushes = [=](double t, Movers& bodies) {
        Mover &first = bodies[0], &second = bodies[1];
        const Vector3 pull = spring_pull(first.at(from), first.velocity(from), second.at(to),
                                         second.velocity(to), law.stiffness, law.damping, law.free_length);
        first.push(from, pull);
        second.push(to, -pull);
        second.push(eye, spring_pull(second.at(eye), {}, post, {}, hook.stiffness, 0, 0));
        second.push(eye, second.R * force);
        first.torque += first.R * Vector3{0.3, std::cos(5 * t), 0};
    };
    return loaded;
}

/// Rates of X and V over the last two of five meshes, both sides; the errors stand above the witness' own.
void expect_order_2p(const Loaded& loaded, int fineness = 1)
{
    const double end = 1;
    const NewtonEuler witness(loaded.model, loaded.pushes);
    Fine reference{witness.run(0, end, 60), {}};
    reference.floor = distance(witness.run(0, end, 40), reference.end);
    EXPECT_LE(reference.floor.V, 1e-11) << loaded.name;
    for (const auto& [degree, n] : {std::pair{1, std::vector{150, 180, 216, 260, 312}},
                                    {2, {48, 58, 70, 84, 101}},
                                    {3, {26, 31, 37, 44, 53}}}) {
        std::vector<int> meshes = n;
        for (int& elements : meshes) elements *= fineness;
        const Study s = lobatto_study(loaded.model, end, reference, degree, meshes);
        for (const auto part : {&Distance::X, &Distance::V}) {
            const double floor = std::max(1e-13, 50 * reference.floor.*part);
            EXPECT_GE(n_above(s, part, floor), 5u) << loaded.name << ", lobatto(" << degree << ")";
            EXPECT_NEAR(last_rate(s, part, floor), 2 * degree, 0.15)
                << loaded.name << ", lobatto(" << degree << "), last error " << s.error.back().*part;
        }
    }
}

TEST(LobattoLoads, HaveOrder2PWithSprings)
{
    expect_order_2p(on_springs("one spring", {{40, 0, 0.7}}));
    expect_order_2p(on_springs("a spring without free length", {{40, 0, 0}}));
}

TEST(LobattoLoads, HaveOrder2PWithDampers)
{
    expect_order_2p(on_springs("one damper", {{0, 3, 0}}));
    expect_order_2p(on_springs("spring and damper", {{40, 3, 0.7}}));
}

TEST(LobattoLoads, HaveOrder2PForABodyBetweenTwoSprings)
{
    expect_order_2p(on_springs("two springs", {{90, 0, 0.9}, {120, 0, 0.5}}), 2);
    expect_order_2p(on_springs("two springs with dampers", {{90, 1, 0.9}, {120, 4, 0.5}}), 2);
}

TEST(LobattoLoads, HaveOrder2PWithForcesThatTurnWithTheBody) { expect_order_2p(under_a_follower_force()); }

TEST(LobattoLoads, HaveOrder2PWithPressuresThatFollowTheBody) { expect_order_2p(under_water()); }

TEST(LobattoLoads, HaveOrder2PWithTorquesThatVaryInTime)
{
    expect_order_2p(under_a_torque(Frame::inertial));
    expect_order_2p(under_a_torque(Frame::body_fixed));
}

TEST(LobattoLoads, HaveOrder2PWithAllOfThemOnTwoBodies) { expect_order_2p(under_everything()); }

}   // namespace
}   // namespace livens::tests::loads_test
