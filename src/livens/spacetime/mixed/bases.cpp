// SPDX-License-Identifier: BSD-3-Clause
// The functions M_A of time that X and P are made of (P17): Lagrange polynomials on equidistant nodes,
// B-splines and NURBS (docs/theory.md, "The elements of the paper"). One more basis is one more entry.
#include "livens/spacetime/mixed/bases.h"

namespace livens::mixed {

namespace {

std::vector<double> knots_of(const Mixed& method, const std::vector<double>& ends,
                             const std::vector<double>& kinks)
{
    return method.knots.empty() ? clamped_knots(method.degree, ends, kinks) : method.knots;
}

constexpr Basis table[] = {
    {"lagrange", "continuous polynomials with equidistant nodes", false, false,
     [](const Mixed& method, const std::vector<double>& ends, const std::vector<double>&) {
         return TimeSpace::lagrange(ends, method.degree);
     }},
    {"bspline", "B-splines, as smooth as the knots allow", true, false,
     [](const Mixed& method, const std::vector<double>& ends, const std::vector<double>& kinks) {
         return TimeSpace::bspline(method.degree, knots_of(method, ends, kinks));
     }},
    {"nurbs", "B-splines with `weights`", true, true,
     [](const Mixed& method, const std::vector<double>& ends, const std::vector<double>& kinks) {
         return TimeSpace::nurbs(method.degree, knots_of(method, ends, kinks), method.weights);
     }},
};

}   // namespace

std::span<const Basis> bases() { return table; }

}   // namespace livens::mixed
