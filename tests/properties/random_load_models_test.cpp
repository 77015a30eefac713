// SPDX-License-Identifier: BSD-3-Clause
// Loads of random mechanisms, trees and loops of every joint that has coordinates, in lanes against one by
// one: to 1e-14 of what a force is made of, at every number of lanes on every set of instructions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "livens/multibody/loads/load_laws.h"
#include "livens/multibody/loads/load_tape.h"
#include "livens/multibody/model.h"
#include "livens/solvers/instructions.h"
#include "properties/joint_kit.h"
#include "properties/load_kit.h"

namespace livens::random_load_models_test {
namespace {

constexpr double bound = 1e-14;

struct Mechanism {
    Model model;
    std::vector<Matrix34> X;
};

/// Those that have coordinates; `made`: how many so far, so that each has its turn.
Joint any_joint(Random& random, const Mechanism& of, int first, int second, std::size_t& made)
{
    const std::string name = std::to_string(of.model.joints().size());
    const Matrix34 X_first = first == world ? world_configuration : of.X[first];
    for (;;) {
        const JointCase& kind = joint_cases()[made++ % joint_cases().size()];
        const JointFrame frame = kind.place(random, X_first, of.X[second]);
        Joint joint = kind.make(first, second, frame, X_first, of.X[second]);
        joint.name = name;
        if (!joint.coordinates.empty()) return joint;
    }
}

/// One to six bodies, each on one before it or on the world, and sometimes one more joint that closes a loop.
Mechanism any_mechanism(Random& random, std::size_t& made)
{
    Mechanism m;
    const int n = 1 + static_cast<int>(3 * (1 + random.number()));
    for (int b = 0; b < n; ++b) {
        m.X.push_back(random.rigid());
        const MassProperties mass = with_center(box(1, {1, 1.2, 0.9}), random.vector());
        m.model.add_body(rigid_body(std::to_string(b), mass, {}));
        const int first = static_cast<int>(0.5 * (b + 1) * (1 + random.number())) - 1;   // the world is -1
        m.model.add_joint(any_joint(random, m, first < 0 ? world : first, b, made));
    }
    if (n > 2 && random.number() > 0) m.model.add_joint(any_joint(random, m, 0, n - 1, made));
    return m;
}

/// A load of one kind or another along a coordinate.
Load along(Random& random, const NamedCoordinate& q, const Configurations& X, int kind)
{
    const double a = 5 + 4 * random.number(), b = 2 + random.number(), c = random.number();
    if (kind == 0) return joint_spring("l", q, {a, b, c, random.number()}, X);
    if (kind == 1) return joint_spring("l", q, {0, b, c, 0, progressive_spring(a, b)}, X);
    if (kind == 2) return actuator("l", q, TimeFunction(a), X);
    LoadParts parts;
    parts.units = {unit_along("l", q.coordinate, X)};
    parts.coordinates = {{q.coordinate, q.at_stated}};
    // terms of one sign: where they cancel, the force is smaller than what it is made of
    const std::vector<Expression> of{
        Expression("sin(q)^2*abs(w) + q^2*cos(t)^2 + abs(q)*max(w, q)^2 + 1", {"q", "w"})};
    parts.law = [of](const LawArguments& at, std::span<double> factors, std::span<double> slopes) {
        const std::array<double, 2> x{at.values[0], at.rates[0]};
        std::array<double, 2> by{};
        factors[0] = of[0](at.at.t, x, by);
        std::copy_n(by.begin(), slopes.size(), slopes.begin());
    };
    parts.recorded_law = recorded_law(of, {{0, false}, {0, true}}, {}, 1.0);
    parts.depends_on_rates = true;
    return modulated("l", "actuator", parts, X);
}

/// A mechanism with one load more, which is its only one.
Model with(Model model, const Load& load)
{
    model.add_load(load);
    return model;
}

/// Near where the bodies are stated, a little deformed.
LoadArguments near_start(Random& random, const Load& load, const Mechanism& of)
{
    LoadArguments at(load.bodies.size());
    at.at.t = random.number();
    for (std::size_t side = 0; side < load.bodies.size(); ++side) {
        if (load.bodies[side] == world) continue;
        const Matrix34& X = of.X[load.bodies[side]];
        const Matrix3 R = directors_from_rotation_vector(0.8 * random.vector());
        at.X[side] = configuration(X.column(0) + 0.5 * random.vector(), R * directors(X)) +
                     0.1 * random.matrix<3, 4>();
        at.V[side] = random.matrix<3, 4>();
    }
    return at;
}

/// A case of the kit, on other bodies.
Load moved(Load load, const std::vector<int>& to)
{
    const auto move = [&](int& body) {
        if (body != world) body = to[static_cast<std::size_t>(body)];
    };
    for (int& body : load.bodies) move(body);
    for (JointCoordinate& angle : load.angles)
        for (PairForm& form : angle.forms) {
            move(form.body_i);
            move(form.body_j);
        }
    return load;
}

template <class Look>
void for_random_loads(int n_models, const Look& look)
{
    Random random(34);
    std::size_t n_joints = 0, n_cases = 0;
    for (int i = 0; i < n_models; ++i) {
        Mechanism of = any_mechanism(random, n_joints);
        const int n_points = 1 + i % 18;
        for (const Joint& joint : std::vector<Joint>(of.model.joints()))
            for (const NamedCoordinate& q : joint.coordinates) {
                const Model model = with(of.model, along(random, q, of.X, i % 4));
                std::vector<LoadArguments> at;
                for (int c = 0; c < n_points; ++c) at.push_back(near_start(random, model.loads()[0], of));
                look(LoadAtPoints(model, at), n_points, joint.type + " " + q.name);
            }
        if (of.model.n_bodies() < 3) continue;
        for (int k = 0; k < 2; ++k) {
            const LoadCase& load_case = load_cases()[n_cases++ % load_cases().size()];
            const int n = of.model.n_bodies(), first = n_points % n;
            const Load made = load_case.make(random);
            if (std::ranges::max(made.bodies) >= n) continue;
            std::vector<int> to;
            for (int b = 0; b < n; ++b) to.push_back((first + b) % n);
            const Load load = moved(made, to);
            const Model model = with(of.model, load);
            std::vector<LoadArguments> at;
            for (int c = 0; c < n_points; ++c) at.push_back(random_arguments(random, load, load_case));
            look(LoadAtPoints(model, at), n_points, load_case.what);
        }
    }
}

TEST(LoadsOfRandomModels, AreTheSameInLanes)
{
    const Instructions before = instructions();
    int n_loads = 0;
    for_random_loads(of_states(1000), [&](const LoadAtPoints& points, int n, const std::string& what) {
        ++n_loads;
        for (const Instructions set : {Instructions::sse2, Instructions::avx2, Instructions::avx512})
            if (use_instructions(set)) {
                EXPECT_LT(points.difference(), bound) << what << ", " << n << " lanes, " << to_string(set);
            }
    });
    use_instructions(before);
    EXPECT_GT(n_loads, of_states(2000));
}

TEST(LoadsOfRandomModels, AFaultInOneLaneIsFound)
{
    int lane = 0;
    for_random_loads(50, [&](const LoadAtPoints& points, int n, const std::string& what) {
        lane = (lane + 1) % n;
        const auto spoil = [&](AlignedDoubles& F, int width) {
            double largest = 0;
            std::size_t at = 0;
            for (std::size_t i = static_cast<std::size_t>(lane); i < F.size();
                 i += static_cast<std::size_t>(width))
                if (std::abs(F[i]) > largest) largest = std::abs(F[i]), at = i;
            F[at] *= 1 + 1e-11;
        };
        if (what == "nothing") return;
        EXPECT_GT(points.difference(spoil), bound) << what << ", lane " << lane << " of " << n;
    });
}

}   // namespace
}   // namespace livens::random_load_models_test
