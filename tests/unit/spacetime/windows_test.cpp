// SPDX-License-Identifier: BSD-3-Clause
// The driver of windows, tried with a family that is no mechanics; and guesses.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "livens/spacetime/guess.h"
#include "livens/spacetime/march/window_notes.h"
#include "livens/spacetime/march/windows.h"
#include "unit/spacetime/mechanisms.h"

namespace livens::windows_test {
namespace {

/// One unknown a window: x = its number of elements, from x = 0; windows longer than `longest` have no root,
/// and so has the element `broken`.
class Counting final : public Window, private ElementMonitor {
public:
    Counting() : Window(static_cast<ElementMonitor&>(*this)) {}
    bool open(int first, int last, SolveReport& report) override
    {
        if (refuses == first) {
            report.status = SolveStatus::singular;
            report.message = "refused";
            return false;
        }
        opened.push_back({first, last});
        problem_.goal = last - first;
        problem_.has_root = last - first <= longest && !(first <= broken && broken < last);
        problem_.x = problem_.kept = 0;
        return true;
    }
    NewtonProblem& equations() override { return problem_; }
    bool start_from(const Guess& guess) override
    {
        if (!guess) return has_own_guess;
        problem_.has_root = problem_.has_root || guess(0).t == 1;
        return true;
    }
    AcceptedElements close(const AcceptanceCriteria& criteria, SolveReport&) override
    {
        if (!can_close) return {};
        const auto [first, last] = opened.back();
        if (criteria.full_rank && first == singular && --singular_times >= 0)
            return {0, true, 0, singular_inside ? RankLoss::inside : RankLoss::at_end};
        if (first <= refused && refused < last && last - first > 1) {
            if (refused > first) closed.push_back({first, refused});
            const int good = refused - first;
            if (refused == last - 1) refused = -1;   // it is divided at once, and its halves are good
            return {good, true};
        }
        if (first == refused) {
            refused = -1;
            return {0, true};
        }
        closed.push_back(opened.back());
        return {last - first, false};
    }
    State at(int) const override { return {0, {Matrix34{1, 0, 0}}, {}}; }
    WorstResidual worst() const override { return {"joint 'elbow' (row 'x')", 0.5, ""}; }
    void describe(SolveReport& report) const override { report.unknowns = 1; }
    Motion take_motion() override { return {}; }

    int longest = 100, broken = -1, refuses = -1, refused = -1;
    int singular = -1, singular_times = 1;
    bool has_own_guess = true, can_close = true, singular_inside = false;
    std::vector<std::pair<int, int>> opened, closed;
    std::vector<int> divisions;

private:
    void divided(int element) override { divisions.push_back(element); }

    struct Problem final : NewtonProblem {
        double x = 0, kept = 0, goal = 1;
        bool has_root = true;
        double f() const { return has_root ? x - goal : 1 + x * x; }
        int n_unknowns() const override { return 1; }
        bool residual() override { return true; }
        bool factorise() override { return has_root || x != 0; }
        void solve(std::span<double> dx) override { dx[0] = has_root ? -f() : -f() / (2 * x); }
        bool move(std::span<const double> dx, double damping) override
        {
            x = kept + damping * dx[0];
            return true;
        }
        void keep() override { kept = x; }
        double size_of(std::span<const double> dx) const override { return std::abs(dx[0]); }
        Rows rows() const override { return {std::abs(f()), 1, 0, false, 0}; }
    } problem_;
};

using Pairs = std::vector<std::pair<int, int>>;

SolveReport run(Counting& window, WindowOptions options, int n = 6)
{
    SolveReport report;
    TimeMesh mesh = make_time_mesh(0, n, n);
    solve_windows(window, mesh, options, report);
    return report;
}

TEST(Windows, FollowEachOtherFromEitherEnd)
{
    Counting forwards, backwards;
    WindowOptions options;
    options.length = 4;
    EXPECT_TRUE(run(forwards, options).converged());
    EXPECT_EQ(forwards.closed, (Pairs{{0, 4}, {4, 6}}));
    options.direction = -1;
    const SolveReport report = run(backwards, options);
    EXPECT_EQ(backwards.closed, (Pairs{{4, 6}, {0, 4}}));
    EXPECT_EQ(report.n_elements, 6);
    EXPECT_EQ(report.iterations.size(), 2u);
}

TEST(Windows, DivideTheMeshButNotShorterThanTheyCanBe)
{
    EXPECT_EQ(divide(10, 4, 1), (std::vector<int>{0, 4, 8, 10}));
    EXPECT_EQ(divide(10, 4, 3), (std::vector<int>{0, 4, 10}));
    EXPECT_EQ(divide(10, 0, 1), (std::vector<int>{0, 10}));
    EXPECT_EQ(divide(3, 7, 1), (std::vector<int>{0, 3}));
}

TEST(Windows, AreSplitWhereTheyFailAsAWhole)
{
    Counting window;
    window.longest = 2;
    WindowOptions options;
    options.length = 0;
    const SolveReport report = run(window, options);
    EXPECT_TRUE(report.converged()) << report.message;
    EXPECT_EQ(window.closed, (Pairs{{0, 1}, {1, 3}, {3, 4}, {4, 6}}));
    ASSERT_EQ(report.notes.size(), 1u);
    EXPECT_NE(report.notes[0].find("3 windows failed"), std::string::npos) << report.notes[0];
    EXPECT_EQ(report.n_elements, 6);
    Counting whole;
    whole.longest = 2;
    options.may_split = false;
    EXPECT_EQ(run(whole, options).status, SolveStatus::singular);
    EXPECT_TRUE(whole.closed.empty());
}

WindowOptions guarded(int direction)
{
    WindowOptions options;
    options.direction = direction;
    options.may_divide = true;
    options.criteria.full_rank = true;
    return options;
}

TEST(Windows, EndsMoveOffSingularPositions)
{
    for (const int direction : {1, -1}) {
        Counting window;
        window.singular = 2;
        TimeMesh mesh = make_time_mesh(0, 6, 6);
        SolveReport report;
        solve_windows(window, mesh, guarded(direction), report);
        EXPECT_TRUE(report.converged()) << report.message;
        const int end = direction > 0 ? 3 : 2;
        EXPECT_EQ(mesh.ends[end], end - 0.1 * direction);
        EXPECT_EQ(mesh.n_elements(), 6);
        EXPECT_EQ(report.shifted, 1);
        EXPECT_EQ(report.shifted_at, end);
        EXPECT_EQ(report.divided, 0);
        ASSERT_EQ(report.notes.size(), 1u);
        EXPECT_NE(report.notes[0].find("singular position"), std::string::npos) << report.notes[0];
    }
}

TEST(Windows, EndsThatMustStayDoAndNoneMovesForEver)
{
    for (const bool is_required : {true, false}) {
        Counting window;
        window.singular = 2;
        window.singular_times = 100;
        const std::vector<double> required{3};
        TimeMesh mesh = is_required ? make_time_mesh(0, 6, 6, required) : make_time_mesh(0, 6, 6);
        SolveReport report;
        solve_windows(window, mesh, guarded(1), report);
        EXPECT_TRUE(report.converged()) << report.message;
        EXPECT_EQ(report.shifted, is_required ? 0 : 3);
        EXPECT_NEAR(mesh.ends[3], is_required ? 3 : 2 + 0.9 * 0.9 * 0.9, 1e-14);
        EXPECT_EQ(report.n_elements, 6);
    }
    Counting last;   // the end of time stays as well
    last.singular = 5;
    TimeMesh mesh = make_time_mesh(0, 6, 6);
    SolveReport report;
    solve_windows(last, mesh, guarded(1), report);
    EXPECT_TRUE(report.converged());
    EXPECT_EQ(mesh.end(), 6);
}

TEST(Windows, AnInnerNodeInASingularPositionDividesItsElementUnevenly)
{
    Counting window;
    window.singular = 2;
    window.singular_inside = true;
    const std::vector<double> required{1, 2, 3, 4, 5};
    TimeMesh mesh = make_time_mesh(0, 6, 6, required);
    SolveReport report;
    solve_windows(window, mesh, guarded(1), report);
    EXPECT_TRUE(report.converged()) << report.message;
    EXPECT_EQ(window.divisions, (std::vector<int>{2}));
    EXPECT_EQ(mesh.ends[3], 2.4);
    EXPECT_EQ(report.n_elements, 7);
    EXPECT_EQ(report.shifted, 1);
    EXPECT_EQ(report.divided, 0);
}

TEST(Windows, RefusedElementsAreSolvedAloneAndDivided)
{
    for (const int direction : {1, -1}) {
        Counting window;
        window.refused = direction > 0 ? 2 : 3;
        WindowOptions options;
        options.length = direction > 0 ? 3 : 1;
        options.direction = direction;
        options.may_divide = true;
        const SolveReport report = run(window, options);
        EXPECT_TRUE(report.converged()) << report.message;
        EXPECT_EQ(window.divisions, (std::vector<int>{direction > 0 ? 2 : 3}));
        EXPECT_EQ(report.divided, 1);
        EXPECT_EQ(report.divided_at, direction > 0 ? 2 : 4);
        EXPECT_EQ(report.n_elements, 7);
        if (direction > 0)
            EXPECT_EQ(window.closed, (Pairs{{0, 2}, {2, 3}, {3, 4}, {4, 7}}));
        else
            EXPECT_EQ(window.closed, (Pairs{{5, 6}, {4, 5}, {4, 5}, {3, 4}, {2, 3}, {1, 2}, {0, 1}}));
    }
}

TEST(Windows, AnElementThatFailsIsDividedUntilItVanishes)
{
    Counting window;
    window.broken = 0;
    WindowOptions options;
    options.may_divide = true;
    const SolveReport report = run(window, options);
    EXPECT_FALSE(report.converged());
    EXPECT_GE(report.divided, 25);
    EXPECT_LE(report.divided, 40);
    EXPECT_TRUE(window.closed.empty());
}

TEST(Windows, NameWhereTheyFailedAndWhatToTry)
{
    Counting window;
    window.broken = 3;
    const SolveReport report = run(window, {});
    EXPECT_EQ(report.status, SolveStatus::singular);
    EXPECT_EQ(report.failed_at, 3);
    EXPECT_EQ(report.n_elements, 3);
    EXPECT_NE(report.message.find("element 3 (t = 3 to 4 s)"), std::string::npos) << report.message;
    EXPECT_NE(report.message.find("joint 'elbow' (row 'x') near t = 0.5 s"), std::string::npos)
        << report.message;
    EXPECT_NE(report.message.find("try: "), std::string::npos) << report.message;
    Counting refusing;
    refusing.refuses = 2;
    const SolveReport refused = run(refusing, {});
    EXPECT_EQ(refused.message, "refused");
    EXPECT_EQ(refused.failed_at, 2);
}

TEST(Windows, TryOneGuessAfterTheOtherAndCountAllIterations)
{
    Counting window;
    window.broken = 1;
    std::vector<int> attempts;
    WindowOptions options;
    options.propose = [&](int, int, int attempt) -> WindowOptions::Proposal {
        attempts.push_back(attempt);
        if (attempt > 2) return {};
        return {[attempt](double) {
                    return State{attempt == 2 ? 1.0 : 0.0, {Matrix34{1, 0, 0}}, {Matrix34{}}};
                },
                false};
    };
    const SolveReport report = run(window, options);
    EXPECT_TRUE(report.converged()) << report.message;
    EXPECT_EQ(attempts, (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(report.rescued, 1);
}

TEST(Windows, AreNotCountedWhereTheyCannotBeClosed)
{
    Counting window;
    window.broken = 0;
    window.can_close = false;
    WindowOptions options;
    options.propose = [&](int, int, int attempt) -> WindowOptions::Proposal {
        if (attempt > 0) return {};
        return {[](double) { return State{1.0, {Matrix34{1, 0, 0}}, {Matrix34{}}}; }, false};
    };
    const SolveReport report = run(window, options);
    EXPECT_EQ(report.rescued, 0);
    EXPECT_TRUE(report.iterations.empty());
    EXPECT_TRUE(report.notes.empty()) << "1 window of 0 needed a guess: " << report.notes.front();
}

TEST(Windows, TellProgressInOneWay)
{
    for (const int direction : {1, -1}) {
        Counting window;
        std::vector<int> done;
        std::vector<double> times;
        WindowOptions options;
        options.direction = direction;
        options.length = 2;
        options.solve.progress = [&](const Progress& progress) {
            EXPECT_EQ(progress.n_elements, 6);
            done.push_back(progress.done);
            times.push_back(progress.t);
            return progress.done < 6;   // nothing is left to stop after the last window
        };
        const SolveReport report = run(window, options);
        EXPECT_EQ(report.status, SolveStatus::converged);
        EXPECT_EQ(done, (std::vector<int>{0, 2, 2, 4, 4, 6}));
        for (std::size_t i = 0; i < done.size(); ++i)
            EXPECT_EQ(times[i], direction > 0 ? done[i] : 6 - done[i]);
    }
}

TEST(Windows, StopBetweenAndWithinThemselves)
{
    for (const int calls : {2, 3}) {   // after the first window, within the second
        Counting window;
        int n = 0;
        WindowOptions options;
        options.length = 3;
        options.solve.progress = [&](const Progress&) { return ++n < calls; };
        const SolveReport report = run(window, options);
        EXPECT_EQ(report.status, SolveStatus::cancelled);
        EXPECT_EQ(report.n_elements, 3);
        EXPECT_EQ(report.failed_at, 3);
        EXPECT_NE(report.message.find("as asked"), std::string::npos) << report.message;
    }
}

TEST(Windows, CompareWithTheMarchTheyStartedFrom)
{
    Counting window;
    window.has_own_guess = false;
    WindowOptions options;
    options.length_of_model = 4;
    options.propose = [](int, int, int) -> WindowOptions::Proposal {
        return {[](double t) { return State{t, {Matrix34{1 + t, 0, 0}}, {Matrix34{}}}; }, true};
    };
    const SolveReport report = run(window, options);
    EXPECT_DOUBLE_EQ(report.guess_distance, 6.0 / 4);
    EXPECT_EQ(report.guess_distance_time, 1);
}

TEST(Guess, MarchesFromAStateInEitherDirection)
{
    const Model model = testing_models::two_bricks();
    const std::vector<double> times{0, 0.1, 0.2, 0.3, 0.4}, back{0.4, 0.3, 0.2, 0.1, 0};
    const MarchGuess there = guess_from_state(model, model.start(), times);
    EXPECT_EQ(there.reached, 0.4);
    const State end = there.motion(0.4);
    const MarchGuess here = guess_from_state(model, end, back);
    EXPECT_EQ(here.reached, 0);
    for (int b = 0; b < model.n_bodies(); ++b) {
        EXPECT_LT(norm(here.motion(0).X[b] - model.start().X[b]), 1e-9);
        EXPECT_GT(norm(end.X[b] - model.start().X[b]), 0.1);
    }
}

TEST(Guess, BetweenPlacesIsSteady)
{
    const Model model = testing_models::two_bricks();
    State first = model.start(), last = first;
    last.t = 2;
    for (Matrix34& X : last.X)
        X = configuration(X.column(0) + Vector3{2, 0, 0},
                          directors_from_rotation_vector({0, 0, 1}) * directors(X));
    const Guess guess = guess_between(first, last);
    for (int b = 0; b < model.n_bodies(); ++b) {
        EXPECT_LT(norm(guess(2).X[b] - last.X[b]), 1e-14);
        const Matrix34 middle =
            configuration(first.X[b].column(0) + Vector3{1, 0, 0},
                          directors_from_rotation_vector({0, 0, 0.5}) * directors(first.X[b]));
        EXPECT_LT(norm(guess(1).X[b] - middle), 1e-14);
    }
}

/// What is known at both ends is met, and stated rates are followed in between.
TEST(Guess, FromBothEndsMeetsWhatIsKnown)
{
    const Model model = testing_models::two_bricks();
    const std::vector<double> times{0, 0.1, 0.2, 0.3};
    const Guess march = guess_from_state(model, model.start(), times).motion;
    Ends ends;
    ends.at_start = ends.at_end = Known::positions;
    ends.start = model.start();
    ends.end = march(0.3);
    ends.end.t = 0.3;
    for (Matrix34& V : ends.end.V) V = {};
    const Guess still = guesses_from_ends(model, ends, {times}, 0)[0].motion;
    ends.start.V[1] = rate(ends.start.X[1], {0, 0, 0}, {0.1, 0, 0});
    const Guess moving = guesses_from_ends(model, ends, {times}, 0)[0].motion;
    for (const Guess& guess : {still, moving})
        for (int b = 0; b < model.n_bodies(); ++b) EXPECT_LT(norm(guess(0.3).X[b] - ends.end.X[b]), 1e-12);
    EXPECT_LT(norm(moving(0.15).X[0] - march(0.15).X[0]), norm(still(0.15).X[0] - march(0.15).X[0]));
}

/// Marches are made from the end that moves, and from the other one where it is asked for more.
TEST(Guess, EndsOfTimeTakeTurns)
{
    const Model model = testing_models::two_bricks();
    const std::vector<double> times{0, 0.1, 0.2, 0.3};
    Ends ends;
    ends.at_start = ends.at_end = Known::positions;
    ends.start = ends.end = model.start();
    ends.end.t = 0.3;
    const auto from_starts = [&] {
        std::vector<int> found;
        for (int turn = 0;; ++turn) {
            const std::vector<GuessFromEnds> guesses = guesses_from_ends(model, ends, {times}, turn);
            if (guesses.empty()) return found;
            for (const GuessFromEnds& guess : guesses) found.push_back(guess.from_start ? 1 : 0);
        }
    };
    using Turns = std::vector<int>;
    EXPECT_EQ(from_starts(), Turns{1}) << "a steady motion, since nothing moves";
    ends.end.V[1] = rate(ends.end.X[1], {0, 0, 0}, {0.1, 0, 0});
    EXPECT_EQ(from_starts(), Turns{0});
    ends.start.V = ends.end.V;
    EXPECT_EQ(from_starts(), (Turns{1, 0}));
    for (Matrix34& V : ends.start.V) V = {};
    ends.at_end = Known::momenta;
    EXPECT_EQ(from_starts(), (Turns{0, 1, 1})) << "what moves, then let go at rest or with the other's rates";
}

std::vector<double> equal_times(double duration, int n)
{
    std::vector<double> times;
    for (int i = 0; i <= n; ++i) times.push_back(duration * i / n);
    return times;
}

/// Elements that are long for the motion are divided; without that a march of as many arrives elsewhere.
TEST(Guess, OfManyInstantsIsAsGoodWithFewerElements)
{
    const Model model = testing_models::two_bricks();
    for (const double duration : {0.5, 4.0, 12.0}) {
        const std::vector<double> times = equal_times(duration, 240);
        const Guess exact = guess_from_state(model, model.start(), equal_times(duration, 960), 8).motion;
        const auto off = [&](const MarchGuess& guess) {
            double largest = 0;
            for (const double t : times)
                largest = std::max(largest, distance_between(guess.motion(t).X, exact(t).X, model.length()));
            return largest;
        };
        EXPECT_LT(off(guess_over_many(model, model.start(), times, 6)), 1e-6) << "over " << duration << " s";
        if (duration > 10) {
            EXPECT_GT(off(guess_from_state(model, model.start(), equal_times(duration, 60), 6)), 1e-3);
        }
    }
}

/// Of rates that are stated much too small.
TEST(Guess, FromManySizesOfRatesArrivesNearest)
{
    const Model model = testing_models::two_bricks();
    const std::vector<double> times{0, 0.1, 0.2, 0.3, 0.4, 0.5};
    State start = model.start();
    start.V[0] = rate(start.X[0], {}, {0.5, -2, 1});
    start.V[1] = rate(start.X[1], start.V[0] * point({1, 0, 0}), {-1, 1, 2});
    Ends ends;
    ends.at_start = ends.at_end = Known::positions;
    ends.end = guess_from_state(model, start, times, 6).motion(0.5);
    ends.end.t = 0.5;
    for (Matrix34& V : ends.end.V) V = {};
    ends.start = start;
    for (Matrix34& V : ends.start.V) V = 0.6 * V;
    const std::vector<GuessFromEnds> all = nearest_marches(model, ends, {times, 6});
    ASSERT_FALSE(all.empty());
    EXPECT_LE(all.size(), 4u);
    EXPECT_NEAR(std::stod(all[0].rates), 1 / 0.6, 0.04);
    for (const GuessFromEnds& one : all)
        for (int b = 0; b < model.n_bodies(); ++b)
            EXPECT_LT(norm(one.motion(0.5).X[b] - ends.end.X[b]), 1e-12);
}

/// Digits enough to tell where an element begins and ends, however short it is.
TEST(WindowNotes, ShortElementsHaveTwoEnds)
{
    TimeMesh mesh;
    mesh.ends = {0, 0.25, 0.157902 + 0.25, 0.157902 + 0.25 + 3e-9, 0.157902 + 0.25 + 2e-8};
    EXPECT_EQ(window_at(mesh, 0, 1), "element 0 (t = 0 to 0.25 s)");
    EXPECT_EQ(window_at(mesh, 1, 2), "element 1 (t = 0.25 to 0.407902 s)");
    EXPECT_EQ(window_at(mesh, 2, 3), "element 2 (t = 0.407902 to 0.407902003 s)");
    EXPECT_EQ(window_at(mesh, 2, 4), "the window of elements 2 to 3 (t = 0.407902 to 0.40790202 s)");
}

}   // namespace
}   // namespace livens::windows_test
