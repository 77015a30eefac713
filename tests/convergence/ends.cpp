// SPDX-License-Identifier: BSD-3-Clause
// lobatto with what is given at either end of time, and in windows of any number of elements.
#include <numbers>
#include <regex>

#include "convergence/studies.h"
#include "livens/base/error.h"
#include "newton_euler.h"

namespace livens::tests::ends_test {
namespace {

template <typename L>
constexpr bool has_windows = requires(L method)
{
    method.window;
};

/// lobatto(degree) in windows of so many elements; 0: all.
template <typename L = Lobatto>
Method lobatto(int degree, int window = 0)
{
    L method{};
    method.degree = degree;
    if constexpr (has_windows<L>) method.window = window;
    return method;
}

Model hinged_brick()
{
    Model model({0, -9.81, 0});
    const int bar = model.add_body(rigid_body("bar", brick({})));
    model.add_joint(revolute("hinge", world, bar, {}));
    return model;
}

/// A motion solved forwards from a state that moves, as exactly as lobatto can.
struct Forward {
    std::string name;
    Model model;
    double end;
    int n;
    State start{}, finish{};
    Motion motion{};
};

constexpr int degree = 6;

/// From where the model is after `before` seconds.
Forward forward(const std::string& name, const Model& model, double before, double end, int n)
{
    Forward run{name, model, end, n};
    run.start = last(solve_evenly(model, before, 20, 8));
    run.start.t = 0;
    SolveOptions options;
    options.tolerance = 1e-14;
    const Solution s = solve(model, {run.start}, make_time_mesh(0, end, n), lobatto(degree, 1), options);
    EXPECT_TRUE(s.report.converged()) << name << ": " << s.report.message;
    run.motion = s.motion;
    run.start = s.motion.at_end(0);
    run.finish = last(s);
    return run;
}

/// One second, or less where conditions at both ends tell little of the motion. Smallest singular values of
/// what is sought by what is given (d X(T) / d V(0) T, d P(T) / d V(0) T, d X(T) / d X(0), d P(T) / d X(0);
/// m, 1, kg m/s, kg m^2/s), by differences of forward runs from the same starts:
///
///     box               1 s     0.78   0.35    0.42    0
///     two bricks        0.2 s   0.64   0.015   0.018   0.008   (1 s: 0.04 0.015 0.003 0.006)
///     offset pendulum   1 s     0.44   0.03    0.36    0       (a rod's cube may spin)
///     four-bar          1 s     0.33   2.2     0.51    9.2
///     hinged links      0.5 s   0.70   1.1     0.45    1.2     (1 s: 0.07 0.87 0.02 1.1)
///     hinged brick      0.4 s   0.71   1.2     0.33    1.6     (0.5 s: 0.56 0.77 0.02 1.5)
std::vector<Forward> runs_between_ends()
{
    return {forward("box", free_box(), 0.5, 1, 20),
            forward("two bricks", two_bricks(), 0.2, 0.2, 10),
            forward("offset pendulum", cubes_on_rods(0.1), 0.3, 1, 40),
            forward("four-bar", four_bar(), 0.2, 1, 40),
            forward("hinged links", hinged_links(), 0.2, 0.5, 20),
            forward("hinged brick", hinged_brick(), 0.2, 0.4, 10),
            forward("eight bricks", hanging_bricks(8), 0.2, 0.2, 10)};
}

State faster(State state, double factor)
{
    for (Matrix34& V : state.V) V *= factor;
    return state;
}

/// Where only positions are given, the velocity is 10 % off; where nothing is, all of it is.
State stated(const Forward& run, bool is_end, Known given)
{
    if (given == Known::nothing) return is_end ? run.start : run.finish;
    const State& state = is_end ? run.finish : run.start;
    return given == Known::positions ? faster(state, 1.1) : state;
}

Solution recover(const Forward& run, Known at_start, Known at_end, const Method& method, int n)
{
    SolveOptions options;
    options.tolerance = 1e-14;
    return solve(run.model, {stated(run, false, at_start), at_start, stated(run, true, at_end), at_end},
                 make_time_mesh(0, run.end, n), method, options);
}

/// Largest difference of X over all nodes of two motions on one mesh.
double largest_difference(const Motion& l, const Motion& r)
{
    EXPECT_EQ(l.X.values.size(), r.X.values.size());
    if (l.X.values.size() != r.X.values.size()) return 1e300;
    double largest = 0;
    for (std::size_t i = 0; i < l.X.values.size(); ++i)
        largest = std::max(largest, std::abs(l.X.values[i] - r.X.values[i]));
    return largest;
}

void expect_recovered(const Forward& run, Known at_start, Known at_end, double V_tolerance = 1e-9)
{
    const Solution s = recover(run, at_start, at_end, lobatto(degree), run.n);
    ASSERT_TRUE(s.report.converged()) << run.name << ": " << s.report.message;
    EXPECT_LE(largest_difference(s.motion, run.motion), 1e-11) << run.name;
    for (int e = 0; e <= run.n; ++e)
        EXPECT_LE(distance(s.motion.at_end(e), run.motion.at_end(e)).V, V_tolerance) << run.name << " " << e;
}

TEST(LobattoEnds, TheStateAtTheEndLeadsBack)
{
    for (const Forward& run :
         {forward("box", free_box(), 0.5, 1, 20), forward("two bricks", two_bricks(), 0.2, 1, 50),
          forward("offset pendulum", cubes_on_rods(0.1), 0.3, 1, 40),
          forward("four-bar", four_bar(), 0.2, 1, 40), forward("hinged links", hinged_links(), 0.2, 1, 40)})
        for (const int window : {0, 1}) {
            const Solution s = recover(run, Known::nothing, Known::state, lobatto(degree, window), run.n);
            ASSERT_TRUE(s.report.converged()) << run.name << ": " << s.report.message;
            EXPECT_LE(largest_difference(s.motion, run.motion), 1e-11) << run.name << " " << window;
            EXPECT_LE(distance(s.motion.at_end(0), run.start).V, 1e-9) << run.name << " " << window;
        }
}

/// The element that is solved first lies last: of what is known behind it some is written, some is not.
TEST(LobattoEnds, AgainstTimeTheFirstElementMayBeDivided)
{
    const Model model = hinged_brick();
    Conditions back;
    back.at_start = Known::nothing;
    back.at_end = Known::state;
    back.end = model.start();
    back.end.t = 1;
    back.end.V[0] = rate(back.end.X[0], {}, {0, 0, 30});
    const Solution fine = solve(model, {back}, make_time_mesh(0, 1, 80), lobatto(8, 1));
    ASSERT_TRUE(fine.report.converged()) << fine.report.message;
    for (const int window : {1, 2, 0}) {
        const Solution s = solve(model, {back}, make_time_mesh(0, 1, 3), lobatto(8, window));
        ASSERT_EQ(s.report.status, SolveStatus::converged) << window << ": " << s.report.message;
        EXPECT_GT(s.report.divided, 0) << window;
        EXPECT_LT(norm(s.motion.at(0).X[0] - fine.motion.at(0).X[0]), 1e-3) << window;
        EXPECT_LT(norm(s.motion.at(0.9).X[0] - fine.motion.at(0.9).X[0]), 1e-3) << window;
    }
}

TEST(LobattoEnds, PositionsAtBothEndsFindTheMotion)
{
    for (const Forward& run : runs_between_ends()) expect_recovered(run, Known::positions, Known::positions);
}

TEST(LobattoEnds, PositionsAtTheStartAndMomentaAtTheEndFindTheMotion)
{
    for (const Forward& run : runs_between_ends()) expect_recovered(run, Known::positions, Known::momenta);
}

TEST(LobattoEnds, MomentaAtTheStartAndPositionsAtTheEndFindTheMotion)
{
    for (const Forward& run : runs_between_ends()) expect_recovered(run, Known::momenta, Known::positions);
}

TEST(LobattoEnds, MomentaAtBothEndsFindTheMotionOfWhatIsHeld)
{
    for (const Forward& run : runs_between_ends())
        if (run.name == "four-bar" || run.name == "hinged links" || run.name == "hinged brick")
            expect_recovered(run, Known::momenta, Known::momenta);
}

/// Two seconds, in which the pendulum swings to the other side. Rates from 0.93 to 0.97 once stopped after
/// one step where those on both sides found the way: rows were made in coordinates that turned with the
/// nodes.
TEST(LobattoEnds, EveryRateNearbyFindsTheMotion)
{
    const Forward run = forward("offset pendulum", cubes_on_rods(0.1), 0.5, 2, 40);
    SolveOptions options;
    options.tolerance = 1e-14;
    for (const double factor : {1.0, 0.999, 0.99, 0.97, 0.95, 0.93, 0.9, 0.85, 0.8}) {
        const Solution s = solve(
            run.model, {faster(run.start, factor), Known::positions, faster(run.finish, 0), Known::positions},
            make_time_mesh(0, run.end, run.n), lobatto(degree), options);
        ASSERT_TRUE(s.report.converged()) << factor << ": " << s.report.message;
        EXPECT_EQ(s.report.rescued, 0) << factor << ": the first guess finds it";
        EXPECT_LE(largest_difference(s.motion, run.motion), 1e-9) << factor;
    }
}

/// Its start, marched on the same mesh, goes the same way.
void expect_confirmed(const Forward& run, const Solution& s)
{
    const Solution march =
        solve(run.model, {s.motion.at_end(0)}, make_time_mesh(0, run.end, run.n), lobatto(8, 1));
    ASSERT_TRUE(march.report.converged()) << run.name << ": " << march.report.message;
    EXPECT_LE(largest_difference(s.motion, march.motion), 1e-8) << run.name;
}

/// From rates 10 % off, where no guess leads Newton's iteration to a motion: the end is led from where a
/// march arrives.
TEST(LobattoEnds, AreFoundFromOtherRatesWhereNewtonFindsNoWay)
{
    for (const double end : {1.0, 1.5}) {
        const Forward run = forward("two bricks", two_bricks(), 0.5, end, 20);
        const Solution s = solve(
            run.model, {faster(run.start, 0.9), Known::positions, faster(run.finish, 0), Known::positions},
            make_time_mesh(0, run.end, run.n), lobatto(8));
        ASSERT_TRUE(s.report.converged()) << end << ": " << s.report.message;
        EXPECT_EQ(s.report.rescued, 1) << "control: the first guess alone does not find it";
        EXPECT_EQ(s.report.notes.back().rfind("found from the stated or steady rates times 1.11", 0), 0u)
            << s.report.notes.back();
        for (int b = 0; b < run.model.n_bodies(); ++b)
            EXPECT_LE(norm(s.motion.at_end(run.n).X[b] - run.finish.X[b]), 1e-12) << end;
        expect_confirmed(run, s);
    }
}

/// Momenta at a place that is guessed: a root that meets the part which joints leave to choose, and not the
/// rest, is left for one that meets all.
TEST(LobattoEnds, AllMomentaAreMetThatAreStated)
{
    for (const auto& [at_start, at_end] :
         {std::pair{Known::positions, Known::momenta}, {Known::momenta, Known::positions}})
        for (const double end : {1.0, 2.0}) {
            const Forward run = forward("four-bar", four_bar(), 0.5, end, 40);
            Solution s = recover(run, at_start, at_end, lobatto(8), run.n);
            ASSERT_TRUE(s.report.converged()) << end << ": " << s.report.message;
            expect_confirmed(run, s);
            const State& found = at_end == Known::momenta ? last(s) : s.motion.at_end(0);
            const State& given = at_end == Known::momenta ? run.finish : run.start;
            for (int b = 0; b < run.model.n_bodies(); ++b)
                EXPECT_LE(norm(found.V[b] - given.V[b]), 1e-6) << end;
        }
}

/// Linear momentum and moment of momentum about the reference point: N^T V m.
Numbers momentum_of(const Matrix4& mass, const Matrix34& X, const Matrix34& V)
{
    const Matrix34 P = V * mass;
    Vector3 moment{};
    for (int i = 1; i < 4; ++i) moment += cross(X.column(i), P.column(i));
    return {P(0, 0), P(1, 0), P(2, 0), moment[0], moment[1], moment[2]};
}

/// The rates that have these momenta at X.
Matrix34 rates_of(const Matrix4& mass, const Matrix34& X, const Numbers& momentum)
{
    Numbers by_twist(36);
    for (std::size_t c = 0; c < 6; ++c) {
        Vector3 v{}, w{};
        (c < 3 ? v : w)[static_cast<int>(c % 3)] = 1;
        const Numbers column = momentum_of(mass, X, rate(X, v, w));
        for (std::size_t r = 0; r < 6; ++r) by_twist[6 * r + c] = column[r];
    }
    const Numbers twist = solution_of(by_twist, momentum);
    return rate(X, {twist[0], twist[1], twist[2]}, {twist[3], twist[4], twist[5]});
}

/// The box elsewhere and turned, with the same momenta.
State displaced(const Model& model, State state)
{
    const Matrix4& mass = model.bodies()[0].mass;
    const Numbers momentum = momentum_of(mass, state.X[0], state.V[0]);
    state.X[0] = configuration(state.X[0].column(0) + Vector3{0.1, -0.2, 0.1},
                               directors_from_rotation_vector({0.1, 0.2, -0.1}) * directors(state.X[0]));
    state.V[0] = rates_of(mass, state.X[0], momentum);
    return state;
}

// Momenta are those of the X and V that are stated: another X with another V says the same.
TEST(LobattoEnds, MomentaMayBeStatedWithAnyPositions)
{
    const Forward run = forward("box", free_box(), 0.5, 1, 20);
    SolveOptions options;
    options.tolerance = 1e-14;
    const TimeMesh mesh = make_time_mesh(0, 1, 20);
    const Solution forth =
        solve(run.model,
              {faster(run.start, 1.1), Known::positions, displaced(run.model, run.finish), Known::momenta},
              mesh, lobatto(degree), options);
    ASSERT_TRUE(forth.report.converged()) << forth.report.message;
    EXPECT_LE(largest_difference(forth.motion, run.motion), 1e-11);
    const Solution back =
        solve(run.model,
              {displaced(run.model, run.start), Known::momenta, faster(run.finish, 0.9), Known::positions},
              mesh, lobatto(degree), options);
    ASSERT_TRUE(back.report.converged()) << back.report.message;
    EXPECT_LE(largest_difference(back.motion, run.motion), 1e-11);
}

// Of six momenta a body only as many can be chosen as the joints leave free at the place that is found: those
// of a faster motion make another one, which has some of them and not the rest. That is no solution.
TEST(LobattoEnds, MomentaThatJointsDoNotLetTheMotionHaveAreSuspect)
{
    for (const Forward& run : {forward("hinged brick", hinged_brick(), 0.2, 0.4, 10),
                               forward("four-bar", four_bar(), 0.2, 0.25, 10)}) {
        for (const bool at_start : {false, true}) {
            const State asked = faster(at_start ? run.start : run.finish, 1.1);
            Conditions given{run.start, Known::positions, asked, Known::momenta};
            if (at_start) given = {asked, Known::momenta, run.finish, Known::positions};
            const Solution s =
                solve(run.model, {given}, make_time_mesh(0, run.end, run.n), lobatto(degree), {});
            ASSERT_EQ(s.report.status, SolveStatus::suspect) << run.name << s.report.message;
            const State found = s.motion.at_end(at_start ? 0 : run.n);
            double off = 0;
            for (int b = 0; b < run.model.n_bodies(); ++b) {
                const Matrix4& mass = run.model.bodies()[b].mass;
                const Numbers p = momentum_of(mass, asked.X[b], asked.V[b]),
                              q = momentum_of(mass, found.X[b], found.V[b]);
                for (std::size_t k = 0; k < 6; ++k) off = std::max(off, std::abs(p[k] - q[k]));
            }
            EXPECT_GT(off, 1e-3) << run.name;
            const std::string where = at_start ? "start" : "end", &words = s.report.message;
            EXPECT_EQ(words.rfind("what is given at the " + where + " is not met: body '", 0), 0u) << words;
            EXPECT_NE(words.find("given is "), std::string::npos) << words;
            EXPECT_NE(words.find("its joints hold this direction"), std::string::npos) << words;
        }
    }
}

// Windows.

TEST(LobattoWindows, OfAnyLengthGiveTheMarch)
{
    EXPECT_TRUE(has_windows<Lobatto>);
    for (const auto& [name, model] : {std::pair{"box", free_box()},
                                      {"two bricks", two_bricks()},
                                      {"offset pendulum", cubes_on_rods(0.1)},
                                      {"four-bar", four_bar()},
                                      {"hinged links", hinged_links()}}) {
        const Forward run = forward(name, model, 0.2, 1, 50);
        for (const int window : {0, 4, 8, 50, 64}) {
            const Solution s = recover(run, Known::state, Known::nothing, lobatto(degree, window), 50);
            ASSERT_TRUE(s.report.converged()) << name << ": " << s.report.message;
            EXPECT_EQ(s.report.n_elements, 50);
            EXPECT_LE(largest_difference(s.motion, run.motion), 1e-11) << name << ", window " << window;
            EXPECT_LE(distance(last(s), run.finish).V, 1e-9) << name << ", window " << window;
        }
    }
}

// Orders.

struct Ends {
    std::string name;
    Known at_start, at_end;
};

/// Rates of X and V in the middle and at both ends, over the last two of five meshes.
void expect_order(const Forward& run, const Ends& given, int p, const std::vector<int>& n)
{
    const State middle = run.motion.at(0.5 * run.end);
    const Study s = study(n, [&](int elements) {
        const Solution solution = recover(run, given.at_start, given.at_end, lobatto(p), elements);
        EXPECT_TRUE(solution.report.converged())
            << run.name << ", " << given.name << ": " << solution.report.message;
        if (!solution.report.converged()) return Distance{1, 1};
        Distance worst;
        for (const auto& [end, there] :
             {std::pair{0, run.start}, {elements / 2, middle}, {elements, run.finish}}) {
            const Distance d = distance(solution.motion.at_end(end), there);
            worst = {std::max(worst.X, d.X), std::max(worst.V, d.V)};
        }
        return worst;
    });
    for (const auto part : {&Distance::X, &Distance::V}) {
        EXPECT_GE(n_above(s, part, 1e-11), 5u) << run.name << ", " << given.name << ", lobatto(" << p << ")";
        EXPECT_NEAR(last_rate(s, part, 1e-11), 2 * p, 0.15)
            << run.name << ", " << given.name << ", lobatto(" << p << "), last " << s.error.back().*part;
    }
}

TEST(LobattoEnds, HaveOrder2P)
{
    const Forward box = forward("box", free_box(), 0.5, 1, 20);
    const Forward bar = forward("hinged brick", hinged_brick(), 0.2, 0.4, 20);
    const Ends all[] = {{"backward", Known::nothing, Known::state},
                        {"positions at both ends", Known::positions, Known::positions},
                        {"positions, momenta", Known::positions, Known::momenta},
                        {"momenta, positions", Known::momenta, Known::positions},
                        {"momenta at both ends", Known::momenta, Known::momenta}};
    for (const Ends& given : all) {
        const bool is_null = given.at_start == Known::momenta && given.at_end == Known::momenta;
        if (!is_null) {
            expect_order(box, given, 1, {48, 60, 74, 92, 114});
            expect_order(box, given, 2, {20, 24, 30, 36, 44});
            expect_order(box, given, 3, {8, 10, 12, 14, 16});
        }
        expect_order(bar, given, 1, {48, 60, 74, 92, 114});
        expect_order(bar, given, 2, {14, 16, 20, 24, 30});
        expect_order(bar, given, 3, {8, 10, 12, 14, 16});
    }
}

/// Where places are given, two solutions agree: errors there are those of velocities, over the element
/// beside.
TEST(LobattoEnds, ErrorsOfOneElementAreToldWherePlacesAreGiven)
{
    for (const Forward& run :
         {forward("box", free_box(), 0.5, 1, 40), forward("hinged brick", hinged_brick(), 0.2, 0.4, 20)})
        for (const int n : {1, 2}) {
            SolveOptions options;
            options.estimate = SolveOptions::Estimate::second;
            const Solution s = solve(run.model,
                                     {stated(run, false, Known::positions), Known::positions,
                                      stated(run, true, Known::positions), Known::positions},
                                     make_time_mesh(0, run.end, n), lobatto(degree), options);
            ASSERT_TRUE(s.report.converged()) << run.name << ": " << s.report.message;
            double error = 0;
            for (const int end : {0, n}) {
                const State is = s.motion.at_end(end), was = end == 0 ? run.start : run.finish;
                const BodyGap gap = gap_between(is, was, run.model.bodies()[0], 0, run.model.length());
                error = std::max(
                    {error, gap.velocity * run.end / n / run.model.length(), gap.rate * run.end / n});
            }
            EXPECT_GT(error, 1e-10) << run.name;   // else it shows nothing
            EXPECT_GT(s.estimate.largest, 0.5 * error) << run.name << " " << n;
            EXPECT_LT(s.estimate.largest, 20 * error) << run.name << " " << n;
        }
}

// What does not determine a motion.

/// Why a problem is not solved: what is thrown, or the report's message; empty if it is solved.
std::string refusal(const Model& model, const Problem& boundary, double end, int n = 20)
{
    try {
        const Solution s = solve(model, boundary, make_time_mesh(0, end, n), lobatto(degree));
        if (s.report.converged()) return "";
        EXPECT_EQ(s.report.status, SolveStatus::singular) << s.report.message;
        return s.report.message;
    } catch (const InputError& error) {
        return error.what();
    }
}

bool says(const std::string& text, const std::string& pattern)
{
    return std::regex_search(text, std::regex(pattern, std::regex::icase));
}

TEST(LobattoEnds, MomentaAtBothEndsOfWhatIsFreeAreRefused)
{
    const Forward box = forward("box", free_box(), 0.5, 1, 20);
    const std::string free =
        refusal(box.model, {box.start, Known::momenta, box.finish, Known::momenta}, box.end);
    EXPECT_PRED2(says, free, "translat|displac") << "the null motion";
    EXPECT_PRED2(says, free, "box");
}

/// A brick that hangs at rest, and its half period: omega^2 = m g c / J about the hinge.
struct Hanging {
    Model model{{0, -9.81, 0}};
    State rest{};
    double half_period = 0;
};
Hanging hanging_brick()
{
    Hanging h;
    const int bar = h.model.add_body(rigid_body("bar", brick({}), {{}, {0, -1, 0, 1, 0, 0, 0, 0, 1}}));
    h.model.add_joint(revolute("hinge", world, bar, {}));
    h.rest = h.model.start();
    h.half_period = std::numbers::pi * std::sqrt((brick({}).inertia(2, 2) + 0.25) / (9.81 * 0.5));
    return h;
}

/// The same rest stated at both ends.
std::string refusal_at_rest(const Hanging& h, Known at_start, Known at_end, double end)
{
    State finish = h.rest;
    finish.t = end;
    return refusal(h.model, {h.rest, at_start, finish, at_end}, end);
}

/// A bob that shall be thrown from one side of its hook to another: from rest one step is not enough.
TEST(LobattoEnds, ThatAreNotFoundLeaveTheLastIterate)
{
    Model model({0, 0, -9.81});
    const int bob = model.add_body(point_mass("bob", 0.2, {0.8, 0, -0.6}));
    model.add_joint(rod("string", world, bob, {}, 1));
    State there = model.start();
    there.t = 2;
    there.X[0](0, 0) = 0, there.X[0](1, 0) = 0.6, there.X[0](2, 0) = -0.8;
    SolveOptions options;
    options.max_iterations = 1;
    const Solution s = solve(model, {model.start(), Known::positions, there, Known::positions},
                             make_time_mesh(0, 2, 60), lobatto(4), options);
    EXPECT_FALSE(s.report.converged());
    EXPECT_EQ(s.report.n_elements, 0);
    EXPECT_NE(s.report.message.find("the last iterate is kept"), std::string::npos) << s.report.message;
    ASSERT_EQ(s.motion.n_elements(), 60);
    EXPECT_EQ(s.motion.at_end(0).X[0](0, 0), 0.8);
    for (int e = 0; e <= 60; ++e) EXPECT_NEAR(norm(s.motion.at_end(e).X[0].column(0)), 1, 1e-6) << e;
    // which is near enough for a guess, without all that was tried before
    const auto found = [&](const std::function<State(double)>& guess) {
        livens::Problem problem{{model.start(), Known::positions, there, Known::positions}};
        problem.guess = guess;
        problem.is_only_guess = true;
        return solve(model, problem, make_time_mesh(0, 2, 60), lobatto(4)).report.converged();
    };
    EXPECT_TRUE(found([&](double t) { return s.motion.at(t); }));
}

TEST(LobattoEnds, ConjugateTimesOfAPendulumAreSingular)
{
    const Hanging h = hanging_brick();
    for (const Known given : {Known::positions, Known::momenta}) {
        EXPECT_PRED2(says, refusal_at_rest(h, given, given, h.half_period), "conjugate|focal");
        EXPECT_EQ(refusal_at_rest(h, given, given, 0.9 * h.half_period), "");
        EXPECT_EQ(refusal_at_rest(h, given, given, 1.1 * h.half_period), "");
    }
}

TEST(LobattoEnds, FocalTimesOfAPendulumAreSingular)
{
    const Hanging h = hanging_brick();
    for (const auto& [at_start, at_end] :
         {std::pair{Known::positions, Known::momenta}, {Known::momenta, Known::positions}}) {
        EXPECT_PRED2(says, refusal_at_rest(h, at_start, at_end, 0.5 * h.half_period), "conjugate|focal");
        EXPECT_EQ(refusal_at_rest(h, at_start, at_end, 0.4 * h.half_period), "");
        EXPECT_EQ(refusal_at_rest(h, at_start, at_end, 0.6 * h.half_period), "");
    }
}

/// A bob in oil that keeps e^-25 of its speed: its momentum at the end tells the one it had, to as many
/// digits as are stated.
TEST(LobattoEnds, AreMetByMotionsThatDecay)
{
    constexpr double damping = 12.5, end = 2;
    Model model;
    const int bob = model.add_body(point_mass("bob", 1, {}));
    model.add_load(spring_damper("oil", world, {-10, 0, 0}, bob, {}, {.damping = damping}));
    State start = model.start(), finish = start;
    finish.t = end;
    const double last = 3 * std::exp(-damping * end);
    finish.V[0](0, 0) = last;
    const Solution s = solve(model, {start, Known::positions, finish, Known::momenta},
                             make_time_mesh(0, end, 40), lobatto(8));
    EXPECT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_NEAR(s.motion.at_end(0).V[0](0, 0), 3, 1e-9);
}

/// A ball that spins once about its third axis in a second; what is between positions `end` seconds apart.
std::string refusal_of_spin(double end)
{
    Placement spinning;
    spinning.angular_velocity = {0, 0, 2 * std::numbers::pi};
    Model model;
    model.add_body(rigid_body("ball", sphere(1, 0.5), spinning));
    State finish{
        end, {configuration({}, directors_from_rotation_vector({0, 0, 2 * std::numbers::pi * end}))}, {}};
    finish.V = {rate(finish.X[0], {}, spinning.angular_velocity)};
    return refusal(model, {model.start(), Known::positions, finish, Known::positions}, end);
}

// Turned by 2 pi, its axis may be any.
TEST(LobattoEnds, AFreeSphereThatHasTurnedOnceIsSingular)
{
    EXPECT_PRED2(says, refusal_of_spin(1), "conjugate|focal");
    EXPECT_EQ(refusal_of_spin(0.8), "");
    EXPECT_EQ(refusal_of_spin(1.2), "");
}

}   // namespace
}   // namespace livens::tests::ends_test
