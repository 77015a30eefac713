// SPDX-License-Identifier: BSD-3-Clause
// What the conformance kits share: a kit says what is wrong with a case, one sentence each, and runs over a
// registry that no file of its folder escapes.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace livens {

/// Empty if nothing is wrong.
using Failures = std::vector<std::string>;

inline std::string joined(const Failures& failures)
{
    std::string text;
    for (const std::string& failure : failures) text += failure + "\n";
    return text;
}

/// Every source of a folder, `apart` from what they share, is called by the type of a case; `fewest` of them.
template <typename Cases>
void expect_sources_in(const Cases& cases, const std::string& folder, const std::string& apart, int fewest)
{
    int files = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(LIVENS_SOURCE_DIR) / folder)) {
        const std::string type = entry.path().stem().string();
        if (entry.path().extension() != ".cpp" || type == apart) continue;
        ++files;
        EXPECT_TRUE(std::ranges::any_of(cases, [&](const auto& c) { return c.type == type; })) << type;
    }
    EXPECT_GE(files, fewest);
}

}   // namespace livens
