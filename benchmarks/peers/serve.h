// SPDX-License-Identifier: BSD-3-Clause
// An engine is a process: it reads a mechanism, then lines "solve SETTING REPEATS", and answers each by a
// line of JSON with the median of the processor times of the repeats and where the compared points end.
#pragma once

#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <utility>

#include "mechanism.h"

namespace peers {

inline double processor_seconds()
{
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

using Points = std::vector<Vec>;

inline std::vector<std::string> parts_of(const std::string& setting)
{
    std::vector<std::string> parts;
    std::istringstream in(setting);
    for (std::string part; std::getline(in, part, ':');) parts.push_back(part);
    return parts;
}

inline void answer(double seconds, const Points& points)
{
    std::printf("{\"seconds\": %.9g, \"points\": [", seconds);
    const char* comma = "";
    for (const Vec& p : points) {
        std::printf("%s[%.17g, %.17g, %.17g]", comma, p[0], p[1], p[2]);
        comma = ", ";
    }
    std::printf("]}\n");
}

inline void answer(const std::exception& failure)
{
    std::string what = std::string(failure.what()).substr(0, 200);
    for (char& c : what)
        if (c == '"' || c == '\\' || c < ' ') c = ' ';
    std::printf("{\"failed\": \"%s\"}\n", what.c_str());
}

/// The median of the repeats, at least one, as long as they take under ten seconds.
template <class Solve>
double median_of(int repeats, const Solve& solve, Points& points)
{
    std::vector<double> taken;
    for (double total = 0; taken.empty() || (static_cast<int>(taken.size()) < repeats && total < 10);
         total += taken.back()) {
        const double start = processor_seconds();
        points = solve();
        taken.push_back(processor_seconds() - start);
    }
    std::sort(taken.begin(), taken.end());
    return (taken[taken.size() / 2] + taken[(taken.size() - 1) / 2]) / 2;
}

/// prepare(mechanism, setting) returns a callable that solves once and returns the points: it alone is timed.
template <class Prepare>
int serve(const Prepare& prepare)
{
    auto mechanism = std::make_shared<Mechanism>();
    for (std::string line; std::getline(std::cin, line);) {
        std::istringstream words(line);
        std::string order, setting;
        int repeats = 1;
        words >> order >> setting >> repeats;
        if (order.empty()) continue;
        try {
            if (order == "mechanism") {
                mechanism = std::make_shared<Mechanism>(read_mechanism(std::cin));
                continue;
            }
            Points points;
            const auto solve = prepare(std::as_const(*mechanism), parts_of(setting));
            const double median = median_of(repeats, solve, points);
            for (const Vec& p : points)
                if (!std::isfinite(dot(p, p))) throw std::runtime_error("not finite");
            answer(median, points);
        } catch (const std::exception& failure) {
            answer(failure);
        }
        std::fflush(stdout);
    }
    return 0;
}

}   // namespace peers
