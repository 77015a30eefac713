// SPDX-License-Identifier: BSD-3-Clause
// Every family of functions of time in every degree: the kit runs over this list.
#include <numbers>

#include "properties/basis_kit.h"

namespace livens {

namespace {

using Numbers = std::vector<double>;

std::string of_degree(int p, const std::string& more = "")
{
    return "degree " + std::to_string(p) + (more.empty() ? more : ", " + more);
}

/// n elements that are all different, the longest about five times as long as the shortest.
Numbers uneven_ends(int n, double start)
{
    Numbers ends{start};
    for (int e = 0; e < n; ++e)
        ends.push_back(ends.back() + 0.03 + 0.13 * ((e * 7 + 3) % 5) / 4.0 + 0.001 * e);
    return ends;
}

struct Knots {
    Numbers knots;
    std::vector<int> smoothness;   // degree less the multiplicity of the knot
};

/// Inner ends stand as often as stated, in turn.
Knots knots_on(const Numbers& ends, int degree, const std::vector<int>& multiplicities)
{
    Knots made;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const bool inner = i > 0 && i + 1 < ends.size();
        const int times = inner ? multiplicities[i % multiplicities.size()] : degree + 1;
        made.knots.insert(made.knots.end(), static_cast<std::size_t>(times), ends[i]);
        if (inner) made.smoothness.push_back(degree - times);
    }
    return made;
}

std::vector<int> less_one(std::vector<int> smoothness)
{
    for (int& k : smoothness) --k;
    return smoothness;
}

void add_lagrange(std::vector<BasisCase>& cases, int p, double start)
{
    const Numbers ends = uneven_ends(4, start);
    const TimeSpace space = TimeSpace::lagrange(ends, p);
    cases.push_back(basis_case("lagrange", of_degree(p), space, p, {0, 0, 0}));
    cases.push_back(basis_case("lower", "of lagrange, " + of_degree(p), space.lower(), p - 1, {-1, -1, -1}));
}

void add_splines(std::vector<BasisCase>& cases, int p, const std::string& what, const Knots& made)
{
    const TimeSpace space = TimeSpace::bspline(p, made.knots);
    cases.push_back(basis_case("bspline", of_degree(p, what), space, p, made.smoothness));
    cases.push_back(basis_case("lower", "of bspline, " + of_degree(p, what), space.lower(), p - 1,
                               less_one(made.smoothness)));

    const std::size_t n = static_cast<std::size_t>(space.size());
    const TimeSpace equal = TimeSpace::nurbs(p, made.knots, Numbers(n, 1 / std::numbers::pi));
    cases.push_back(basis_case("nurbs", of_degree(p, what + ", equal weights"), equal, p, made.smoothness));
    Numbers weights;
    for (std::size_t a = 0; a < n; ++a)
        weights.push_back(0.7 + 0.9 * static_cast<double>((a * 5 + 2) % 7) / 6);
    const TimeSpace rational = TimeSpace::nurbs(p, made.knots, weights);
    cases.push_back(basis_case("nurbs", of_degree(p, what), rational, 0, made.smoothness));
    cases.push_back(basis_case("lower", "of nurbs, " + of_degree(p, what), rational.lower(), p - 1,
                               less_one(made.smoothness)));
}

std::vector<BasisCase> all_bases()
{
    std::vector<BasisCase> cases;
    for (int p = 1; p <= 8; ++p) {
        const Numbers ends = uneven_ends(8, 0), late = uneven_ends(8, 4096.25);
        add_lagrange(cases, p, 0);
        add_lagrange(cases, p, -4096.25);
        add_splines(cases, p, "smooth", knots_on(ends, p, {1}));
        add_splines(cases, p, "late", knots_on(late, p, {1}));
        add_splines(cases, p, "kinks everywhere", knots_on(ends, p, {p}));
        add_splines(cases, p, "mixed", knots_on(ends, p, {1, p, (p + 1) / 2}));
    }
    return cases;
}

}   // namespace

const std::vector<BasisCase>& basis_cases()
{
    static const std::vector<BasisCase> cases = all_bases();
    return cases;
}

}   // namespace livens
