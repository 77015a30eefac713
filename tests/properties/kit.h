// SPDX-License-Identifier: BSD-3-Clause
// What the conformance kits share: a kit says what is wrong with a case, one sentence each, and runs over a
// registry that no file of its folder escapes.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "sanitized.h"

namespace livens {

/// Empty if nothing is wrong.
using Failures = std::vector<std::string>;

inline std::string joined(const Failures& failures)
{
    std::string text;
    for (const std::string& failure : failures) text += failure + "\n";
    return text;
}

inline std::string number(double x)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", x);
    return text;
}

/// The name of a test from what a case is: "spring and damper" is spring_and_damper.
inline std::string test_name(std::string what)
{
    for (char& c : what)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    return what;
}

/// Of `states`, what a study goes through: a twentieth under sanitizers, where the code is walked through but the
/// figures are those of every other build.
constexpr int of_states(int states) { return is_sanitized ? (states + 10) / 20 : states; }

/// Every source of a folder, `apart` from what they share, is called by the type of a case; `fewest` of them.
template <typename Cases>
void expect_sources_in(const Cases& cases, const std::string& folder, const std::vector<std::string>& apart,
                       int fewest)
{
    int files = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(LIVENS_SOURCE_DIR) / folder)) {
        const std::string type = entry.path().stem().string();
        if (entry.path().extension() != ".cpp" || std::ranges::find(apart, type) != apart.end()) continue;
        if (std::filesystem::exists(std::filesystem::path(entry.path()).replace_extension(".h"))) continue;   // a tool
        ++files;
        EXPECT_TRUE(std::ranges::any_of(cases, [&](const auto& c) { return c.type == type; })) << type;
    }
    EXPECT_GE(files, fewest);
}

}   // namespace livens
