// SPDX-License-Identifier: BSD-3-Clause
// Unknown numbers of a model: as many more conditions at both ends of time decide them.
#include <memory>
#include <numbers>

#include "convergence/studies.h"
#include "livens/base/error.h"
#include "livens/multibody/loads/load_laws.h"
#include "livens/multibody/state_quantities.h"

namespace livens::tests::unknowns_test {
namespace {

using At = Condition::At;

/// A point on a rod in the plane y = 0, whose air drags it: phi'' = -g/l sin phi - c phi' for 1 kg.
struct Pendulum {
    double length = 1, drag = 0.3, mass = 1, end = 2;
};

std::shared_ptr<const Model> model_of(const Pendulum& p)
{
    Model model({0, 0, -9.81});
    const int bob = model.add_body(point_mass("bob", p.mass, {p.length, 0, 0}));
    model.add_joint(rod("rod", world, bob, {}, p.length));
    model.add_joint(point_in_plane("plane", world, bob, JointFrame{{}, {}, {0, 1, 0}, {0, 1, 0}}));
    std::vector<Matrix34> X;
    for (const Body& body : model.bodies()) X.push_back(body.X);
    model.add_load(drag("air", bob, {}, Drag{p.drag, 0}, X));
    return std::make_shared<const Model>(std::move(model));
}

using Made = std::function<Pendulum(std::span<const double>)>;

/// Let go at the horizontal, and after two seconds 30 degrees off the vertical.
Rebuilt rebuilt(const Pendulum& p)
{
    const auto model = model_of(p);
    const auto q = [&](const char* name) { return state_quantities(*model, name).at(0); };
    return {model,
            {{q("bob.z"), 0, At::start}, {q("bob.vz"), 0, At::start}, {q("bob.x"), p.length / 2, At::end}},
            0,
            p.end};
}

Problem problem_of(const std::vector<UnknownNumber>& numbers, const Made& made)
{
    std::vector<double> guesses;
    for (const UnknownNumber& number : numbers) guesses.push_back(number.guess);
    const Rebuilt first = rebuilt(made(guesses));
    Problem problem{{first.model->start(), Known::nothing, {}, Known::nothing, first.components}};
    problem.unknowns = {numbers, [=](std::span<const double> values) {
                            Rebuilt none;
                            try {
                                return rebuilt(made(values));
                            } catch (const InputError& error) {
                                none.refused = error.complaint();
                            }
                            return none;
                        }};
    return problem;
}

Solution solve_for(const std::vector<UnknownNumber>& numbers, const Made& made, int n = 20)
{
    const Problem problem = problem_of(numbers, made);
    std::vector<double> guesses;
    for (const UnknownNumber& number : numbers) guesses.push_back(number.guess);
    const Rebuilt first = problem.unknowns.rebuild(guesses);
    SolveOptions options;
    options.tolerance = 1e-14;
    return solve(*first.model, problem, make_time_mesh(first.start, first.end, n), Lobatto{8, 0}, options);
}

/// A march with the number that was found, from the start that was found: it shares nothing with columns.
void expect_march_arrives(const Solution& s)
{
    SolveOptions options;
    options.tolerance = 1e-14;
    const Motion march =
        solve(*s.numbers.rebuilt.model, {{s.motion.at_end(0)}}, s.motion.mesh, Lobatto{8}, options).motion;
    const int n = s.motion.n_elements();
    EXPECT_LE(distance(march.at_end(n), s.motion.at_end(n)).X, 1e-9);
}

TEST(UnknownNumbers, DampingThatArrivesIsFound)
{
    const Solution s = solve_for({{"damping", 0.3}}, [](std::span<const double> c) {
        return Pendulum{1, c[0]};
    });
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    tell("damping off by, iterations " + std::to_string(s.report.newton_iterations),
         s.numbers.values[0] - 0.763693631412843);
    EXPECT_NEAR(s.numbers.values[0], 0.763693631412843, 1e-11);
    expect_march_arrives(s);
}

TEST(UnknownNumbers, LengthThatArrivesIsFound)
{
    const Solution s = solve_for({{"length", 1}}, [](std::span<const double> l) { return Pendulum{l[0]}; });
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    tell("length off by, iterations " + std::to_string(s.report.newton_iterations),
         s.numbers.values[0] - 1.113745597915364);
    EXPECT_NEAR(s.numbers.values[0], 1.113745597915364, 1e-11);
    expect_march_arrives(s);
}

TEST(UnknownNumbers, DurationIsFound)
{
    const Solution s = solve_for({{"duration", 1.8, 0.1, 3}}, [](std::span<const double> T) {
        return Pendulum{1, 0.763693631412843, 1, T[0]};
    });
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    tell("duration off by, iterations " + std::to_string(s.report.newton_iterations),
         s.numbers.values[0] - 2);
    EXPECT_NEAR(s.numbers.values[0], 2, 1e-11);
    EXPECT_EQ(s.motion.end(), s.numbers.values[0]);
    expect_march_arrives(s);
}

TEST(UnknownNumbers, TwoAreFoundTogether)
{
    const Made made = [](std::span<const double> v) { return Pendulum{v[0], v[1]}; };
    Problem problem = problem_of({{"length", 1}, {"damping", 0.3, 0, 5}}, made);
    const auto with_more = [made](std::span<const double> v) {
        Rebuilt all = rebuilt(made(v));
        all.components.push_back({state_quantities(*all.model, "bob.vx").at(0), 1.3, At::end});
        return all;
    };
    problem.unknowns.rebuild = with_more;
    const Rebuilt first = with_more(std::vector{1.0, 0.3});
    problem.conditions.components = first.components;
    SolveOptions options;
    options.tolerance = 1e-14;
    const Solution s = solve(*first.model, problem, make_time_mesh(0, 2, 20), Lobatto{8, 0}, options);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    tell("length", s.numbers.values[0]);
    tell("damping", s.numbers.values[1]);
    expect_march_arrives(s);
}

std::string code_of(const std::vector<UnknownNumber>& numbers, const Made& made)
{
    try {
        return "solved: " + solve_for(numbers, made).report.message;
    } catch (const InputError& error) {
        EXPECT_NE(error.complaint().path, "");
        return error.complaint().code;
    }
}

TEST(UnknownNumbers, ThatNothingShowsAreRefused)
{
    // without air nothing depends on the mass
    const Made mass = [](std::span<const double> m) { return Pendulum{1, 0, m[0]}; };
    EXPECT_EQ(code_of({{"mass", 1, 0.1, 10}}, mass), "unknown-unseen");
    EXPECT_EQ(code_of({{"mass", 1}}, mass), "unknown-unseen");
    const Made with_air = [](std::span<const double> m) { return Pendulum{1, 0.7, m[0]}; };
    EXPECT_EQ(code_of({{"mass", 1}}, with_air).substr(0, 7), "solved:");
}

TEST(UnknownNumbers, WrongOnesAreRefused)
{
    const Made damping = [](std::span<const double> c) { return Pendulum{1, c[0]}; };
    EXPECT_EQ(code_of({{"damping", 0.3, 1, 0}}, damping), "unknown-bounds");
    EXPECT_EQ(code_of({{"damping", 0.3, 0.4, 1}}, damping), "unknown-guess");
    // one condition for two of them
    EXPECT_EQ(code_of({{"damping", 0.3}, {"length", 1}},
                      [](std::span<const double> v) {
                          return Pendulum{v.size() > 1 ? v[1] : 1, v[0]};
                      }),
              "conditions-too-few");
    Problem march = problem_of({{"damping", 0.3}}, damping);
    march.conditions.components.clear();
    march.conditions.at_start = Known::state;
    const Rebuilt first = march.unknowns.rebuild(std::vector{0.3});
    EXPECT_THROW(
        try {
            solve(*first.model, march, make_time_mesh(0, 2, 20), Lobatto{8});
        } catch (const InputError& e) {
            EXPECT_EQ(e.complaint().code, "unknown-march");
            throw;
        },
        InputError);
}

TEST(UnknownNumbers, AtABoundThatDoesNotSufficeAreNamed)
{
    const Solution s = solve_for({{"damping", 0.3, 0, 0.5}}, [](std::span<const double> c) {
        return Pendulum{1, c[0]};
    });
    EXPECT_FALSE(s.report.converged());
    EXPECT_NE(s.report.message.find("'damping' has come to its upper bound 0.5"), std::string::npos)
        << s.report.message;
}

TEST(UnknownNumbers, BeginAtZeroAndAtBounds)
{
    const Solution s = solve_for({{"damping", 0, 0}}, [](std::span<const double> c) {
        return Pendulum{1, c[0]};
    });
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_NEAR(s.numbers.values[0], 0.763693631412843, 1e-11);
}

}   // namespace
}   // namespace livens::tests::unknowns_test
