// SPDX-License-Identifier: BSD-3-Clause
// Lengths of ropes, and what no rope can be.
#include "livens/multibody/rope.h"

#include <algorithm>
#include <cmath>

#include "livens/base/error.h"
#include "livens/multibody/wording.h"

namespace livens {

double rope_length(const std::vector<BodyPoint>& over, const Configurations& X)
{
    double sum = 0;
    for (std::size_t k = 1; k < over.size(); ++k)
        sum += norm(X[over[k].body] * point(over[k].point) - X[over[k - 1].body] * point(over[k - 1].point));
    return sum;
}

double constant_length(const std::vector<BodyPoint>& over)
{
    double sum = 0;
    for (std::size_t k = 1; k < over.size(); ++k)
        if (over[k].body == over[k - 1].body) sum += norm(over[k].point - over[k - 1].point);
    return sum;
}

void check_rope(const std::string& path, const std::vector<BodyPoint>& over, const Configurations& X)
{
    const auto refuse = [&](const std::string& message, const std::string& value, const std::string& help) {
        throw InputError({"rope-points", path, message, value, "", "", help});
    };
    if (over.size() < 2) refuse("a rope needs two points or more", std::to_string(over.size()), "");
    for (const BodyPoint& at : over) require_finite(at.point, path, "a point of a rope");
    const bool moves =
        std::ranges::any_of(over, [&](const BodyPoint& at) { return at.body != over[0].body; });
    if (!moves)
        refuse(over[0].body == world ? "all points of the rope are fixed"
                                     : "all points of the rope are on one body",
               "", "at least one must move against another");
    double longest = 0;
    const auto span = [&](std::size_t k) { return rope_length({over[k - 1], over[k]}, X); };
    for (std::size_t k = 1; k < over.size(); ++k) longest = std::max(longest, span(k));
    for (std::size_t k = 1; k < over.size(); ++k)
        if (!(span(k) > 1e-9 * longest))
            throw InputError({"rope-span", path,
                              "two points of the rope that follow each other are in one place",
                              "points " + std::to_string(k) + " and " + std::to_string(k + 1), "",
                              "a span without length has no direction to pull along",
                              "leave one of them out, or move it"});
}

}   // namespace livens
