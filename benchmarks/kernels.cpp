// SPDX-License-Identifier: BSD-3-Clause
#include "kernels.h"

#include <cmath>
#include <limits>

#include "livens/multibody/model.h"

namespace livens::benchmarks {
namespace {

constexpr Vector3 gravity{0, 0, -9.81};

Placement at_rest(const Vector3& position, const Matrix3& directors = identity<3>())
{
    return {.position = position, .directors = directors, .velocity = {}, .angular_velocity = {}};
}

Kernel pendulum_kernel(const std::string& name, int degree, double end, int n_elements)
{
    Kernel kernel{.name = name,
                  .model = centred_double_pendulum(),
                  .mesh = make_time_mesh(0, end, n_elements),
                  .method = Lobatto{degree}};
    kernel.body = 1;
    return kernel;
}

}   // namespace

Model centred_double_pendulum()
{
    const double s = 4 / std::sqrt(2.0);
    Model model(gravity);
    const int upper = model.add_body(rigid_body("upper", box(1.5, {1, 1, 1}), at_rest({s, 0, s})));
    const int lower =
        model.add_body(rigid_body("lower", box(1.5, {0.8, 0.8, 0.8}), at_rest({2 * s, 0, 2 * s})));
    model.add_joint(rod("upper rod", world, upper, {}, 4));
    model.add_joint(rod("lower rod", upper, lower, {}, 4));
    return model;
}

Model two_bricks()
{
    const Vector3 tip{1, 0, 0};
    const MassProperties brick = with_center(box(50, {1, 0.2, 0.1}), {0.5, 0, 0});   // 1 kg
    const Matrix3 quarter_turn{0, 1, 0, -1, 0, 0, 0, 0, 1};
    Model model(gravity);
    const int first = model.add_body(rigid_body("first", brick, at_rest({0, 0, 0})));
    const int second = model.add_body(rigid_body("second", brick, at_rest(tip, quarter_turn)));
    model.add_joint(spherical("shoulder", world, first, {}));
    model.add_joint(spherical("elbow", first, second, {.point_first = tip, .point_second = {}}));
    return model;
}

Kernel bricks_kernel(const std::string& name, const Method& method, int n_elements)
{
    Kernel kernel{
        .name = name, .model = two_bricks(), .mesh = make_time_mesh(0, 2, n_elements), .method = method};
    kernel.body = 1;
    kernel.point = {1, 0, 0};
    // Two independent codes agree to 3e-12.
    kernel.reference = {0.644182606655, -0.291228917392, -1.136547655061};
    return kernel;
}

std::vector<Kernel> counted_kernels()
{
    Kernel linear = pendulum_kernel("linear_element", 1, 1, 1000);
    linear.reference = {6.899775770320609, 0, 1.9924719898496916};
    linear.largest_error = 1e-4;
    Kernel centred = pendulum_kernel("centred_6", 6, 10, 100);
    centred.reference = {-6.7326004102136245, 0, 4.313086350053254};
    centred.largest_error = 2e-8;
    Kernel bricks_6 = bricks_kernel("bricks_6", Lobatto{6}, 80);
    bricks_6.largest_error = 1e-9;
    Kernel bricks_8 = bricks_kernel("bricks_8", Lobatto{8}, 80);
    bricks_8.largest_error = 3e-12;
    return {linear, centred, bricks_6, bricks_8};
}

Model brick_chain(int n, const std::string& kind)
{
    const bool on_hinges = kind == "hinges", is_ring = kind == "ring";
    const MassProperties brick = with_center(box(50, {1, 0.2, 0.1}), {0.5, 0, 0});   // 1 kg
    const double corner = 2 * std::acos(-1.0) / n;                                   // of a ring
    const double whirl = 2.0 / n;                                                    // rad/s
    Model model(gravity);
    Vector3 x{};
    for (int b = 0; b < n; ++b) {
        const double angle = is_ring ? corner * b : std::acos(0.0) * (b % 2);
        const Vector3 along{std::cos(angle), std::sin(angle), 0};
        Placement placement = at_rest(x, Matrix3{along[0], along[1], 0, -along[1], along[0], 0, 0, 0, 1});
        if (on_hinges) {
            placement.velocity = {-whirl * x[1], whirl * x[0], 0};
            placement.angular_velocity = {0, 0, whirl};
        }
        const std::string name = std::to_string(b);
        model.add_body(rigid_body(name, brick, placement));
        JointFrame frame{.point_first = {b > 0 ? 1.0 : 0.0, 0, 0}, .point_second = {}};
        if (on_hinges && b % 2 == 1) {   // across the one before
            frame.axis_first = {-1, 0, 0};
            frame.axis_second = {0, 1, 0};
        }
        model.add_joint(on_hinges ? revolute(name, b - 1, b, frame) : spherical(name, b - 1, b, frame));
        x = x + along;
    }
    if (is_ring) model.add_joint(spherical("last", n - 1, 0, {.point_first = {1, 0, 0}, .point_second = {}}));
    return model;
}

Kernel chain_kernel(int n, const std::string& kind, int n_elements)
{
    const double h = kind == "balls" ? 0.015 : n <= 200 ? 0.0075 : 0.0035;
    return {.name = kind,
            .model = brick_chain(n, kind),
            .mesh = make_time_mesh(0, h * n_elements, n_elements),
            .method = Lobatto{8},
            .tolerance = 1e-14};
}

Solution run(const Kernel& kernel)
{
    SolveOptions options;
    options.judge = options.divide = false;   // what is counted is the solution
    options.estimate = SolveOptions::Estimate::none;
    options.tolerance = kernel.tolerance;
    const Problem problem{{kernel.model.start()}, {}, nullptr, kernel.prepared};
    return solve(kernel.model, problem, kernel.mesh, kernel.method, options);
}

double error(const Kernel& kernel, const Solution& solution)
{
    if (!solution.report.converged()) return std::numeric_limits<double>::infinity();
    const State end = solution.motion.at_end(solution.motion.n_elements());
    return norm(end.X[kernel.body] * point(kernel.point) - kernel.reference);
}

}   // namespace livens::benchmarks
