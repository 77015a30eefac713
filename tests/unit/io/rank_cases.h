// SPDX-License-Identifier: BSD-3-Clause
// Motions that several ranks solve, from scenarios, and how they are held against those of one.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "livens/io/solve_scenario.h"
#include "livens/spacetime/on_ranks.h"
#include "sanitized.h"
#include "unit/io/scenario_text.h"

namespace livens::of_ranks {

using test::read;
using test::replaced;
using test::shown;

inline Scenario scenario_of(const std::string& text)
{
    ScenarioResult result = read("format = 1\n" + text);
    if (!result.scenario) throw std::logic_error(shown(result));
    return std::move(*result.scenario);
}

inline Problem problem_of(const Scenario& scenario)
{
    Problem problem{scenario.conditions};
    problem.unknowns = scenario.unknowns;
    return problem;
}

inline Solution alone(const std::string& text)
{
    const Scenario s = scenario_of(text);
    return solve(s.model, problem_of(s), s.time, s.method, s.options);
}

struct Part {
    Solution solution;
    RankWork work;
};

inline std::vector<Part> by_ranks(const std::string& text, int n_ranks)
{
    std::vector<Part> parts(static_cast<std::size_t>(n_ranks));
    const Scenario s = scenario_of(text);
    run_as_ranks(n_ranks, [&](Ranks& ranks) {
        Part& part = parts[static_cast<std::size_t>(ranks.rank())];
        part.solution = solve_on_ranks(s.model, problem_of(s), s.time, s.method, s.options, ranks, part.work);
    });
    return parts;
}

inline std::string body(const std::string& name, const std::string& place)
{
    return "[[body]]\nname = \"" + name + "\"\nmass = 2\ninertia = [0.1, 0.2, 0.25]\nposition = " + place +
           "\n";
}
inline std::string joint(const std::string& type, const std::string& name, const std::string& bodies,
                         const std::string& at, const std::string& axis)
{
    return "[[joint]]\ntype = \"" + type + "\"\nname = \"" + name + "\"\nbetween = " + bodies +
           "\nat = " + at + (axis.empty() ? "" : "\naxis = " + axis) + "\n";
}
inline std::string time_of(const std::string& time, int degree)
{
    return "[time]\n" + time +
           "\n[method]\nestimate = \"none\"\nfamily = \"mixed\"\ndegree = " + std::to_string(degree) + "\n";
}

inline const std::string gravity = "gravity = [0, 0, -9.81]\n";
/// Two bodies on hinges whose axes are not parallel, with a damper.
inline const std::string chain =
    gravity + body("upper", "[0.5, 0, 0]") + body("lower", "[1.5, 0, 0]") +
    joint("revolute", "j1", "[\"world\", \"upper\"]", "[0, 0, 0]", "[0, 1, 0.2]") +
    joint("revolute", "j2", "[\"upper\", \"lower\"]", "[1, 0, 0]", "[0.3, 1, 0]") +
    "[[load]]\ntype = \"spring\"\nname = \"s\"\njoint = \"j2\"\nstiffness = 3\ndamping = 0.4\n";
inline const std::string cart =
    body("cart", "[0, 0, 0]") +
    joint("prismatic", "rail", "[\"world\", \"cart\"]", "[0, 0, 0]", "[1, 0, 0]") +
    "[[load]]\ntype = \"spring\"\nname = \"s\"\njoint = \"rail\"\nstiffness = 8\n"
    "damping = 1\n[[load]]\ntype = \"actuator\"\nname = \"f\"\njoint = \"rail\"\n";
inline const std::string pendulum =
    gravity + body("bob", "[0, 0, -1]") +
    joint("revolute", "pivot", "[\"world\", \"bob\"]", "[0, 0, 0]", "[0, 1, 0]");

struct Case {
    const char* what;
    std::string text;
};

inline const Case by_component[] = {
    {"angles at both ends, and a rate",
     chain +
         "[start]\nknown = { \"j1.angle\" = 0.1, \"j2.angle\" = -0.2, \"j2.angle_rate\" = 0.5 }\n"
         "[end]\nknown = { \"j1.angle\" = 0.9 }\n" +
         time_of("end = 0.5\nelements = 41", 2)},
    {"a place of the tip at the end",
     chain +
         "[[sensor]]\ntype = \"point\"\nname = \"tip\"\nbody = \"lower\"\npoint = [0.5, 0, 0]\n"
         "[start]\nknown = { \"j1.angle\" = 0, \"j2.angle\" = 0 }\n"
         "[end]\nknown = { \"tip.z\" = -0.9, \"tip.x\" = 1.6 }\n" +
         time_of("end = 0.6\nelements = 66", 1)},
    {"nothing but the end", chain +
                                "[end]\nknown = { \"j1.angle\" = 0.9, \"j2.angle\" = 0.2, \"j1.angle_rate\" "
                                "= 1, \"j2.angle_rate\" = -1 }\n" +
                                time_of("end = 0.4\nelements = 40", 2)},
    {"lower multipliers",
     replaced(chain +
                  "[start]\nknown = { \"j1.angle\" = 0.1, \"j2.angle\" = -0.2, \"j2.angle_rate\" = 0.5, "
                  "\"j1.angle_rate\" = 0 }\n" +
                  time_of("end = 0.4\nelements = 40", 2),
              "degree = 2", "degree = 2\nmultipliers = \"lower\"")},
    {"angles that turn more than once",
     pendulum +
         "rate = 9\n[start]\nknown = { \"pivot.angle\" = 0 }\n[end]\nknown = { \"pivot.angle\" = 14 "
         "}\n" +
         time_of("end = 1.5\nelements = 90", 2)},
    {"a ball joint and a free body",
     gravity + body("top", "[0.3, 0.2, 0.5]") + body("free", "[2, 0, 0]") +
         joint("spherical", "ball", "[\"world\", \"top\"]", "[0, 0, 0]", "") +
         "[start]\nknown = { \"top.x\" = 0.3, \"top.y\" = 0.2, \"ball.rotation_vector_z\" = 0.1, \"free.x\" "
         "= 2, \"free.y\" = 0, \"free.z\" = 0, \"free.rotation_x\" = 0, \"free.rotation_y\" = 0, "
         "\"free.rotation_z\" = 0 }\n[end]\nknown = { \"top.x\" = 0.4, \"top.y\" = 0.3, "
         "\"ball.rotation_vector_z\" = 0.4, \"free.x\" = 3, \"free.y\" = 1, \"free.z\" = 0.5, "
         "\"free.rotation_x\" = 0.3, \"free.rotation_y\" = 0.4, \"free.rotation_z\" = -0.2 }\n" +
         time_of("end = 0.4\nelements = 40", 2)},
};

inline const Case periodic[] = {
    {"driven, damped",
     cart + "expression = \"3*cos(pi*t)\"\n" + time_of("end = 2\nelements = 40\nperiodic = true", 2)},
};

inline const Case numbered_cases[] = {
    {"a damper, of a rate at the end",
     replaced(chain, "damping = 0.4", "damping = { unknown = 0.3, low = 0 }") +
         "[start]\nknown = { \"j1.angle\" = 0.1, \"j2.angle\" = -0.2, \"j2.angle_rate\" = 0.5, "
         "\"j1.angle_rate\" = 0 }\n[end]\nknown = { \"j2.angle\" = -0.24 }\n" +
         time_of("end = 0.4\nelements = 40", 2)},
    {"how long it takes", pendulum +
                              "[start]\nknown = { \"pivot.angle\" = 0, \"pivot.angle_rate\" = 2 }\n"
                              "[end]\nknown = { \"pivot.angle\" = 0.5 }\n" +
                              time_of("end = { unknown = 0.3, low = 0.05, high = 0.8 }\nelements = 40", 2)},
    {"the period of a swing, which keeps its energy",
     pendulum + "[start]\nknown = { \"pivot.angle\" = 1, \"pivot.angle_rate\" = 0 }\n" +
         time_of("end = { unknown = 2.3 }\nelements = 60\nperiodic = true", 2)},
};

/// Largest difference of places, rates and momenta at element ends, by the largest number of the kind.
inline double distance(const Motion& whole, const Motion& part, int first)
{
    double off = 0, sizes[3] = {1, 1, 1};
    const auto n = static_cast<std::size_t>(part.n_bodies);
    const auto compare = [&](int kind, const Matrix34& a, const Matrix34& b) {
        for (int c = 0; c < 12; ++c) {
            sizes[kind] = std::max(sizes[kind], std::abs(a.a[c]));
            off = std::max(off, std::abs(a.a[c] - b.a[c]) / sizes[kind]);
        }
    };
    for (int e = 0; e <= part.n_elements(); ++e) {
        const State a = whole.at_end(first + e), b = part.at_end(e);
        const auto at = static_cast<std::size_t>(first + e) * n, here = static_cast<std::size_t>(e) * n;
        off = std::max(off, std::abs(whole.mesh.ends[first + e] - part.mesh.ends[e]));
        for (std::size_t i = 0; i < n; ++i) {
            compare(0, a.X[i], b.X[i]);
            compare(1, a.V[i], b.V[i]);
            compare(2, whole.momenta[at + i], part.momenta[here + i]);
        }
    }
    return off;
}

/// How many there are: with sanitizers, which take ten times as long, four alone.
inline std::vector<int> ranks(std::vector<int> all)
{
    if (is_sanitized) all = {4};
    return all;
}

inline void expect_the_same(const Case& one, const std::vector<int>& of_ranks)
{
    SCOPED_TRACE(one.what);
    const Solution serial = alone(one.text);
    ASSERT_TRUE(serial.report.converged()) << serial.report.message;
    for (const int n : of_ranks) {
        SCOPED_TRACE(n);
        int next = 0;
        for (const Part& part : by_ranks(one.text, n)) {
            const Solution& s = part.solution;
            ASSERT_TRUE(s.report.converged()) << s.report.message;
            EXPECT_EQ(part.work.first, next);
            EXPECT_EQ(part.work.n_formed, part.work.last - part.work.first);
            EXPECT_EQ(s.motion.n_elements(), part.work.n_formed);
            EXPECT_LT(distance(serial.motion, s.motion, next), 1e-12);
            EXPECT_EQ(s.report.unknowns, serial.report.unknowns);
            // the last steps are at rounding, of which each order of sums has its own
            EXPECT_LE(std::abs(s.report.newton_iterations - serial.report.newton_iterations), 2);
            ASSERT_EQ(s.numbers.values.size(), serial.numbers.values.size());
            for (std::size_t i = 0; i < s.numbers.values.size(); ++i)
                EXPECT_NEAR(s.numbers.values[i], serial.numbers.values[i], 1e-12);
            next = part.work.last;
        }
        EXPECT_EQ(next, serial.motion.n_elements());
    }
}

}   // namespace livens::of_ranks
