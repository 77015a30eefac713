// SPDX-License-Identifier: BSD-3-Clause
// Conditions by component: quantities at the start, at the end and alike at both, in place of what is known
// of all bodies.
#include <algorithm>
#include <complex>
#include <limits>
#include <numbers>

#include "convergence/studies.h"
#include "livens/base/error.h"
#include "livens/multibody/state_quantities.h"
#include "livens/time/time_laws.h"

namespace livens::tests::components_test {
namespace {

using At = Condition::At;
constexpr double degree = std::numbers::pi / 180;

/// A motion solved forwards from a state that moves, and guesses at both ends that are about right.
struct Sample {
    std::string title;
    Model model;
    double duration;
    int n;
    State start{};
    Motion motion{};

    double value(const std::string& name, At at) const
    {
        const StateQuantity q = state_quantities(model, name).at(0);
        std::vector<Matrix34> stated;
        for (const Body& body : model.bodies()) stated.push_back(body.X);
        // angles turn on from node to node
        const auto in = [&](int e) {
            const State state = motion.at_end(e);
            double now = value_of(q, stated, state.X, state.V);
            if (!q.counts_turns()) return now;
            now = value_of(q, stated, motion.at_end(0).X, {});
            for (int i = 0; i <= 8 * e; ++i)
                now = turned_to(
                    value_of(q, stated, motion.at(motion.start() + i * motion.mesh.length(0) / 8).X, {}),
                    now);
            return now;
        };
        const int n_elements = motion.n_elements();
        return at == At::start ? in(0) : at == At::end ? in(n_elements) : in(n_elements)-in(0);
    }
    Condition condition(const std::string& name, At at) const
    {
        return {state_quantities(model, name).at(0), value(name, at), at};
    }
    std::vector<Condition> conditions(const std::vector<std::string>& at_start,
                                      const std::vector<std::string>& at_end) const
    {
        std::vector<Condition> all;
        for (const std::string& name : at_start) all.push_back(condition(name, At::start));
        for (const std::string& name : at_end) all.push_back(condition(name, At::end));
        return all;
    }
};

SolveOptions exact()
{
    SolveOptions options;
    options.tolerance = 1e-14;
    return options;
}

/// From where the model is after `before` seconds.
Sample run(const std::string& name, const Model& model, double before, double end, int n)
{
    Sample made{name, model, end, n};
    State start = last(solve_evenly(model, before, 20, 8));
    start.t = 0;
    const Solution s = solve(model, {{start}}, make_time_mesh(0, end, n), Lobatto{6}, exact());
    EXPECT_TRUE(s.report.converged()) << name << ": " << s.report.message;
    made.motion = s.motion;
    made.start = s.motion.at_end(0);
    return made;
}

/// Rates are 10 % off, and nothing is said of the end.
Solution solve_for(const Sample& run, const std::vector<Condition>& conditions, double rates = 1.1)
{
    State guess = run.start;
    for (Matrix34& V : guess.V) V *= rates;
    Problem problem{{guess, Known::nothing, {}, Known::nothing, conditions}};
    return solve(run.model, problem, make_time_mesh(0, run.duration, run.n), Lobatto{6, 0}, exact());
}

double largest_difference(const Motion& l, const Motion& r)
{
    EXPECT_EQ(l.X.values.size(), r.X.values.size());
    if (l.X.values.size() != r.X.values.size()) return 1e300;
    double largest = 0;
    for (std::size_t i = 0; i < l.X.values.size(); ++i)
        largest = std::max(largest, std::abs(l.X.values[i] - r.X.values[i]));
    return largest;
}

void expect_found(const Sample& run, const std::vector<Condition>& conditions, const std::string& what)
{
    const Solution s = solve_for(run, conditions);
    ASSERT_TRUE(s.report.converged()) << run.title << ", " << what << ": " << s.report.message;
    const double off = largest_difference(s.motion, run.motion);
    tell(run.title + ", " + what + ", iterations " + std::to_string(s.report.newton_iterations), off);
    EXPECT_LE(off, 1e-11) << run.title << ", " << what;
    for (int e = 0; e <= run.n; ++e)
        EXPECT_LE(distance(s.motion.at_end(e), run.motion.at_end(e)).V, 1e-9) << run.title << ", " << what;
}

Sample box_run() { return run("box", free_box({0.3, -0.2, 1}), 0.5, 1, 20); }
Sample bricks_run() { return run("two bricks", two_bricks(), 0.2, 0.2, 10); }
Sample links_run() { return run("hinged links", hinged_links(), 0.2, 0.5, 20); }
Sample four_bar_run() { return run("four-bar", four_bar(), 0.2, 1, 40); }

const std::vector<std::string> box_places{"box.x",          "box.y",          "box.z",
                                          "box.rotation_x", "box.rotation_y", "box.rotation_z"},
    box_rates{"box.vx",
              "box.vy",
              "box.vz",
              "box.angular_velocity_x",
              "box.angular_velocity_y",
              "box.angular_velocity_z"},
    brick_places{"upper.rotation_x", "upper.rotation_y", "upper.rotation_z",
                 "lower.rotation_x", "lower.rotation_y", "lower.rotation_z"},
    brick_rates{"upper.angular_velocity_x", "upper.angular_velocity_y", "upper.angular_velocity_z",
                "lower.angular_velocity_x", "lower.angular_velocity_y", "lower.angular_velocity_z"},
    link_places{"shoulder.angle", "elbow.angle"}, link_rates{"shoulder.angle_rate", "elbow.angle_rate"};

TEST(Components, OfPlacesAndRatesFindTheMotionTheyAreTakenFrom)
{
    const auto all_four = [](const Sample& r, const std::vector<std::string>& places,
                             const std::vector<std::string>& rates) {
        expect_found(r, r.conditions(places, places), "places, places");
        expect_found(r, r.conditions(places, rates), "places, rates");
        expect_found(r, r.conditions(rates, places), "rates, places");
        std::vector<std::string> state = places;
        state.insert(state.end(), rates.begin(), rates.end());
        expect_found(r, r.conditions(state, {}), "state at the start");
        expect_found(r, r.conditions({}, state), "state at the end");
    };
    all_four(box_run(), box_places, box_rates);
    all_four(bricks_run(), brick_places, brick_rates);
    all_four(links_run(), link_places, link_rates);
    all_four(four_bar_run(), {"crank shaft.angle"}, {"rocker shaft.angle_rate"});
}

/// What is found keeps to the conditions, and a march from its start confirms it.
void expect_met(const Sample& run, const std::vector<Condition>& conditions, const std::string& what)
{
    const Solution s = solve_for(run, conditions);
    ASSERT_TRUE(s.report.converged()) << run.title << ", " << what << ": " << s.report.message;
    const Solution march =
        solve(run.model, {{s.motion.at_end(0)}}, make_time_mesh(0, run.duration, run.n), Lobatto{6}, exact());
    ASSERT_TRUE(march.report.converged()) << march.report.message;
    tell(run.title + ", " + what + ", iterations " + std::to_string(s.report.newton_iterations),
         largest_difference(s.motion, march.motion));
    EXPECT_LE(largest_difference(s.motion, march.motion), 1e-10) << run.title << ", " << what;
    Sample found = run;
    found.motion = s.motion;
    for (const Condition& one : conditions)
        EXPECT_NEAR(found.value(one.quantity.name, one.at), one.value, 1e-11) << one.quantity.name;
}

TEST(Components, MayBeOfAnyKindAtEitherEnd)
{
    const Sample links = links_run();
    expect_met(links, links.conditions({"shoulder.angle", "shoulder.angle_rate", "elbow.angle"}, {"lower.x"}),
               "three and one");
    expect_met(links, links.conditions({"lower.vx"}, {"elbow.angle", "lower.x", "shoulder.angle_rate"}),
               "one and three");
    const Sample bricks = bricks_run();
    expect_met(bricks,
               bricks.conditions({"lower.x", "lower.y", "upper.rotation_x", "lower.vx", "lower.vz",
                                  "lower.angular_velocity_y", "lower.rotation_z"},
                                 {"lower.z", "lower.rotation_y", "upper.angular_velocity_z",
                                  "lower.angular_velocity_z", "upper.rotation_x"}),
               "seven and five");
}

/// The complaint that a solution throws.
Complaint refused(const Sample& run, const std::vector<Condition>& conditions)
{
    try {
        solve_for(run, conditions);
    } catch (const InputError& error) {
        return error.complaint();
    }
    ADD_FAILURE() << "nothing was refused";
    return {};
}

void expect_refused(const Sample& run, const std::vector<Condition>& conditions, const std::string& code,
                    const std::string& path, const std::string& says)
{
    const Complaint c = refused(run, conditions);
    const std::string all = c.message + "; " + c.value + "; " + c.bound + "; " + c.note + "; " + c.help;
    EXPECT_EQ(c.code, code) << all;
    EXPECT_EQ(c.path, path) << all;
    EXPECT_NE(all.find(says), std::string::npos) << all;
}

TEST(Components, ThatDoNotDetermineAMotionAreRefusedByName)
{
    const Sample links = links_run();
    const auto expect = [&](const std::vector<std::string>& start, const std::vector<std::string>& end,
                            const std::string& code, const std::string& path, const std::string& says) {
        expect_refused(links, links.conditions(start, end), code, path, says);
    };
    expect(link_places, {"elbow.angle"}, "conditions-too-few", "start.known", "'shoulder.angle' at the end");
    expect(link_places, {"elbow.angle", "shoulder.angle", "elbow.angle_rate"}, "conditions-too-many",
           "end.known[elbow.angle_rate]", "leave out 1");
    // the elbow goes with the upper link
    expect({"shoulder.angle", "elbow.angle", "lower.x"}, {"elbow.angle"}, "conditions-dependent",
           "start.known[lower.x]", "a function of 'shoulder.angle' at the start");
    expect({"shoulder.angle", "elbow.angle", "elbow.angle"}, {"elbow.angle"}, "conditions-twice",
           "start.known[elbow.angle]", "given twice");
    expect({"shoulder.angle", "upper.z", "elbow.angle_rate"}, {"elbow.angle"}, "conditions-joints",
           "start.known[upper.z]", "so that it is no condition");
    std::vector<Condition> contradictory =
        links.conditions({"shoulder.angle", "upper.z", "elbow.angle_rate"}, {"elbow.angle"});
    contradictory[1].value = 0.25;
    expect_refused(links, contradictory, "conditions-joints", "start.known[upper.z]",
                   "contradicts the joints");
    // of bodies, where joints have no coordinates
    const Sample bricks = bricks_run();
    std::vector<std::string> some = brick_places;
    some.pop_back();
    expect_refused(bricks, bricks.conditions(some, brick_places), "conditions-too-few", "start.known",
                   "give for instance 'upper.");
    // redundant rows are no free motions
    const Sample bar = four_bar_run();
    expect_refused(bar, bar.conditions({"crank shaft.angle", "rocker shaft.angle"}, {}),
                   "conditions-dependent", "start.known[rocker shaft.angle]",
                   "'crank shaft.angle' at the start");
}

TEST(Components, AreNamedByJointsSensorsAndBodies)
{
    Model model = hinged_links();
    std::vector<Matrix34> stated{model.bodies()[0].X, model.bodies()[1].X};
    model.add_sensor(point_sensor("tip", 1, {1, 0, 0}, stated));
    model.add_sensor(energy_sensor("effort", 1));
    EXPECT_EQ(state_quantities(model, "lower.velocity").size(), 3u);
    EXPECT_EQ(state_quantities(model, "lower.position")[2].name, "lower.z");
    EXPECT_EQ(state_quantities(model, "elbow.angle_rate").at(0).unit, "rad s-1");
    EXPECT_EQ(value_of(state_quantities(model, "tip.x").at(0), stated, stated, {}), 2);
    for (const auto& [name, code] : {std::pair{"tip.ax", "conditions-not-smooth"},
                                     {"effort.kinetic", "conditions-not-smooth"},
                                     {"elbow.force_x", "conditions-not-smooth"},
                                     {"elbow.angel", "conditions-unknown"},
                                     {"tip", "conditions-unknown"},
                                     {"wrist.angle", "conditions-unknown"},
                                     {"", "conditions-unknown"}})
        try {
            state_quantities(model, name);
            ADD_FAILURE() << name;
        } catch (const InputError& error) {
            EXPECT_EQ(error.complaint().code, code) << name;
        }
}

Model pendulum(const Vector3& gravity = {0, -9.81, 0})
{
    Model model(gravity);
    const int bar = model.add_body(rigid_body("bar", {1, {1, 0, 0}, identity<3>()}));
    model.add_joint(revolute("pivot", world, bar, {}));
    return model;
}

Sample at_rest(const Model& model, double duration, int n)
{
    const std::vector<Matrix34> X{model.bodies()[0].X}, V{model.bodies()[0].V};
    return {"pendulum", model, duration, n, {0, X, V}, {}};
}

Condition known(const Model& model, const std::string& name, double value, At at)
{
    return {state_quantities(model, name).at(0), value, at};
}

/// An angle at the end says how often it has turned on the way.
TEST(Components, CountTurns)
{
    const Model model = pendulum();
    Sample sample = at_rest(model, 1, 16);
    for (const double turns : {0.0, 1.0, -1.0, 2.0}) {
        sample.start.V[0] = rate(sample.start.X[0], {}, {0, 0, 6 * turns});
        const Solution s = solve_for(sample,
                                     {known(model, "pivot.angle", -90 * degree, At::start),
                                      known(model, "pivot.angle", (-90 + 360 * turns) * degree, At::end)},
                                     1);
        ASSERT_TRUE(s.report.converged()) << turns << ": " << s.report.message;
        sample.motion = s.motion;
        EXPECT_NEAR(sample.value("pivot.angle", At::both), 360 * turns * degree, 1e-11) << turns;
    }
}

/// A damped pendulum that is driven round: after a while the motion repeats itself, and alike at both ends it
/// is found at once. Its state at the start is neither stated nor near.
TEST(Components, AlikeAtBothEndsArePeriodicMotions)
{
    Model model = pendulum({0, 0, 0});
    const double period = 2 * std::numbers::pi / 3;
    const NamedCoordinate angle = model.joints()[0].coordinates[0];
    const std::vector<Matrix34> X{model.bodies()[0].X};
    model.add_load(joint_spring("hold", angle, {4, 0.8}, X));
    model.add_load(actuator("push", angle, harmonic(1.5, 3 / (2 * std::numbers::pi), 0.4), X));
    const Sample sample = at_rest(model, period, 16);
    const Solution s = solve_for(
        sample, {known(model, "pivot.angle", 0, At::both), known(model, "pivot.angle_rate", 0, At::both)});
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    // a(t) = Re(A e^(3 i t)) of 2 a'' + 0.8 a' + 4 a = 1.5 sin(3 t + 0.4)
    const std::complex<double> i(0, 1), A = 1.5 * std::exp(0.4 * i) / (4.0 - 2 * 9.0 + 0.8 * 3 * i);
    Sample found = sample;
    found.motion = s.motion;
    EXPECT_NEAR(found.value("pivot.angle", At::start), A.imag(), 1e-11);
    EXPECT_NEAR(found.value("pivot.angle_rate", At::start), (3.0 * i * A).imag(), 1e-11);
}

/// Places that are stated are exact, and say nothing of the motion's error: velocities there do.
TEST(Components, HaveErrorsWherePlacesAreStated)
{
    const Sample links = links_run();
    State guess = links.start;
    SolveOptions options = exact();
    options.judge = false;
    const Problem problem{
        {guess, Known::nothing, {}, Known::nothing, links.conditions(link_places, link_places)}};
    Solution s = solve(links.model, problem, make_time_mesh(0, links.duration, 1), Lobatto{6, 0}, options);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    estimate(links.model, problem, s.method, options, s);
    const double off = distance(s.motion.at_end(1), links.motion.at_end(links.n)).V * links.duration;
    EXPECT_GT(off, 1e-9);   // else it shows nothing
    EXPECT_GT(s.estimate.largest, 0.1 * off);
}

/// Places of all bodies at one end, as they are given, beside components at the other.
TEST(Components, StandBesidePlacesOfAllBodies)
{
    for (const Sample& run : {links_run(), bricks_run(), four_bar_run(), box_run()}) {
        std::vector<Condition> rates;
        const int n = run.model.n_bodies();
        if (run.title == "four-bar")
            rates = run.conditions({}, {"crank shaft.angle_rate"});
        else if (run.title == "hinged links")
            rates = run.conditions({}, {"shoulder.angle_rate", "elbow.angle"});
        else if (n == 1)
            rates = run.conditions({}, box_rates);
        else
            rates = run.conditions({}, {"lower.x", "lower.y", "upper.rotation_x", "lower.vx", "lower.vz",
                                        "lower.angular_velocity_y"});
        State guess = run.start;
        for (Matrix34& V : guess.V) V *= 1.1;
        const Problem problem{{guess, Known::positions, {}, Known::nothing, rates}};
        const Solution s =
            solve(run.model, problem, make_time_mesh(0, run.duration, run.n), Lobatto{6, 0}, exact());
        ASSERT_TRUE(s.report.converged()) << run.title << ": " << s.report.message;
        EXPECT_LE(largest_difference(s.motion, run.motion), 1e-11) << run.title;
        // places that are not met are told, of all bodies
        for (int b = 0; b < n; ++b) {
            Solution off = s;
            off.motion.X.coefficient(0, 0)[static_cast<std::size_t>(12 * b)] += 1e-6;
            judge(run.model, problem, exact(), off);
            const bool is_told = std::ranges::any_of(off.verdict.reasons, [](const std::string& reason) {
                return reason.starts_with("what is given at the start is not met");
            });
            EXPECT_TRUE(is_told) << run.title << ", body " << b << ": " << off.report.message;
        }
    }
}

/// Elements are found for an accuracy, as between places and momenta.
TEST(Components, AreMetToAnAccuracy)
{
    for (const Sample& run : {links_run(), ::livens::tests::components_test::run("four-bar", four_bar(), 0.2, 1, 160)}) {
        const bool is_loop = run.title == "four-bar";
        const std::vector<Condition> conditions =
            is_loop ? run.conditions({"crank shaft.angle_rate"}, {"rocker shaft.angle"})
                    : run.conditions({"shoulder.angle", "lower.vx"}, {"elbow.angle", "lower.y"});
        State guess = run.start;
        for (Matrix34& V : guess.V) V *= 1.05;
        const Problem problem{{guess, Known::nothing, {}, Known::nothing, conditions}};
        for (const double accuracy : {1e-5, 1e-9}) {
            const Solution s = solve(run.model, problem, Span{0, run.duration, accuracy}, Lobatto{0});
            ASSERT_TRUE(s.report.converged()) << run.title << ": " << s.report.message;
            double error = 0;
            for (int e = 0; e <= s.motion.n_elements(); ++e)
                error = std::max(error, distance(s.motion.at_end(e), run.motion.at(s.motion.mesh.ends[e])).X);
            tell(run.title + ": elements", s.motion.n_elements());
            tell(run.title + ": true error", error);
            EXPECT_LE(error, accuracy * run.model.length()) << run.title;
            EXPECT_LE(s.verdict.estimated_error, accuracy) << run.title;
            EXPECT_LE(s.motion.n_elements(), 20) << run.title << ", " << accuracy;
        }
    }
}

/// Speeds and energies in place of rates: a march from what is found has them.
TEST(Components, AreSpeedsAndEnergies)
{
    const Sample links = links_run();
    for (const std::vector<std::string>& names :
         {std::vector<std::string>{"lower.speed"}, {"energy"}, {"upper.kinetic_energy"}, {"lower.energy"}}) {
        std::vector<Condition> conditions = links.conditions(link_places, {});
        for (const Condition& one : links.conditions({"shoulder.angle_rate"}, {})) conditions.push_back(one);
        for (const Condition& one : links.conditions({}, names)) conditions.push_back(one);
        expect_found(links, conditions, names[0]);
    }
    // that of all bodies is that of the parts, and what is stored in springs comes to it
    Model model = links.model;
    const State& at = links.start;
    std::vector<Matrix34> stated;
    for (const Body& body : model.bodies()) stated.push_back(body.X);
    const auto value = [&](const std::string& name) {
        return value_of(state_quantities(model, name).at(0), stated, at.X, at.V);
    };
    const double parts = value("upper.energy") + value("lower.energy");
    EXPECT_NEAR(value("energy"), parts, 1e-12 * std::abs(parts));
    model.add_load(spring_damper("spring", world, {0, 3, 0}, 1, {}, {100, 0, 0.5, 0, {}}));
    const double length = norm(at.X[1].column(0) - Vector3{0, 3, 0});
    EXPECT_NEAR(value("energy") - parts, 50 * (length - 0.5) * (length - 0.5), 1e-9);
}

/// A rotation vector says nothing at half a turn; at the other end nobody asks.
TEST(Components, NeedNoValueWhereTheyAreNotStated)
{
    Model model;
    model.add_body(rigid_body("box", {1, {}, identity<3>()}));
    Sample sample = at_rest(model, 1, 8);
    std::vector<Condition> conditions;
    const auto add = [&](const std::string& name, double value, At at) {
        conditions.push_back(known(model, "box." + name, value, at));
    };
    for (const char* axis : {"x", "y", "z"}) {
        add(axis, 0, At::start);
        add(std::string("rotation_") + axis, 0, At::start);
        add(std::string("v") + axis, 1, At::end);
        add(std::string("angular_velocity_") + axis, axis[0] == 'y' ? std::numbers::pi : 0, At::end);
    }
    const Solution s = solve_for(sample, conditions);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_NEAR(s.motion.at_end(8).X[0](0, 1), -1, 1e-12);
}

/// Small swings take as long as they are wide: half a period brings every one of them to the other side.
TEST(Components, ThatLeaveAMotionFreeAreSingular)
{
    const Model model = pendulum({0, -8, 0});
    const double half = std::numbers::pi * std::sqrt(2.0 / 8);   // about -90 degrees: 2 a'' = -8 a
    const auto solve_over = [&](double duration) {
        Sample sample = at_rest(model, duration, 8);
        sample.start.X[0] = configuration({}, directors_from_rotation_vector({0, 0, -90 * degree}));
        return solve_for(sample,
                         {known(model, "pivot.angle", -90 * degree, At::start),
                          known(model, "pivot.angle", -90 * degree, At::end)},
                         1)
            .report;
    };
    const SolveReport at_conjugate = solve_over(half);
    EXPECT_EQ(at_conjugate.status, SolveStatus::singular) << at_conjugate.message;
    EXPECT_NE(at_conjugate.message.find("'bar'"), std::string::npos) << at_conjugate.message;
    EXPECT_TRUE(solve_over(0.9 * half).converged());
}

/// What was stated is compared with what was found, whatever the iteration says.
TEST(Components, ThatAreNotMetAreSuspect)
{
    const Sample links = links_run();
    std::vector<Condition> conditions = links.conditions(link_places, link_rates);
    Solution s = solve_for(links, conditions);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    conditions[3].value += 1e-6;
    judge(links.model, {{links.start, Known::nothing, {}, Known::nothing, conditions}}, exact(), s);
    EXPECT_EQ(s.report.status, SolveStatus::suspect);
    EXPECT_NE(s.report.message.find("'elbow.angle_rate' at the end"), std::string::npos) << s.report.message;
}

TEST(Components, AreRefusedWhereTheyCannotBeSolvedFor)
{
    const Sample links = links_run();
    const std::vector<Condition> conditions = links.conditions(link_places, link_places);
    const Problem problem{{links.start, Known::nothing, {}, Known::nothing, conditions}};
    const TimeMesh mesh = make_time_mesh(0, links.duration, links.n);
    const auto code = [&](const Problem& of, const Time& time, const Method& method, const Model& model) {
        try {
            solve(model, of, time, method);
        } catch (const InputError& error) {
            return error.complaint().code;
        }
        return std::string("none");
    };
    Mixed strong;
    strong.start = Mixed::Start::strong;
    for (const Method& method : std::vector<Method>{Radau{4}, strong, Midpoint{}, Endpoint{}})
        EXPECT_EQ(code(problem, mesh, method, links.model), "conditions-method") << name_of(method);
    Problem mixed = problem;
    mixed.conditions.at_start = Known::positions;
    EXPECT_EQ(code(mixed, mesh, Lobatto{6, 0}, links.model), "boundary-conditions");
    mixed.conditions.components = links.conditions({}, link_places);
    EXPECT_EQ(code(mixed, mesh, Lobatto{6, 0}, links.model), "none");
    mixed.conditions.at_start = Known::momenta;
    EXPECT_EQ(code(mixed, mesh, Lobatto{6, 0}, links.model), "none");
    mixed.conditions.at_start = Known::state;
    EXPECT_EQ(code(mixed, mesh, Lobatto{6, 0}, links.model), "conditions-too-many");
    for (const char* name : {"upper.speed", "lower.kinetic_energy"}) {
        Problem still = problem;
        still.conditions.components[1] = {state_quantities(links.model, name).at(0), 0, At::start};
        EXPECT_EQ(code(still, mesh, Lobatto{6, 0}, links.model), "conditions-value") << name;
    }
    Problem infinite = problem;
    infinite.conditions.components[0].value = std::numeric_limits<double>::infinity();
    EXPECT_EQ(code(infinite, mesh, Lobatto{6, 0}, links.model), "not-finite");
    EXPECT_EQ(code(problem, mesh, Lobatto{6, 0}, links.model), "none");
}

}   // namespace
}   // namespace livens::tests::components_test
