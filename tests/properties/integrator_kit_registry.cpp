// SPDX-License-Identifier: BSD-3-Clause
// Every method of the library, and what is stated of it: the kit runs over this list.
#include "properties/integrator_kit.h"

#include "mixed_problems.h"

#include "livens/multibody/events.h"

namespace livens {

namespace {

using namespace tests;

using Orders = std::array<StatedOrder, n_problems>;

IntegratorCase lobatto_case(int degree, const Orders& orders)
{
    IntegratorCase c = integrator_case(Lobatto{degree});
    c.orders = orders;
    c.reversal = Reversal::always;
    c.keeps_linear_momentum = c.keeps_angular_momentum = true;
    c.holds = Holds::nodes;
    c.is_stable = true;   // but not with preload: constraints hold at nodes, and so does what they bear
    return c;
}

/// Order 2p; degrees above six are at rounding before rates settle.
IntegratorCase lobatto_case(int degree)
{
    const double order = 2 * degree;
    if (degree <= 4) return lobatto_case(degree, {{{order}, {order}, {order}}});
    if (degree <= 6) return lobatto_case(degree, {{{order, 0.3}, {}, {}}});
    return lobatto_case(degree, {});
}

/// Order 2p - 1; what stiffness makes of it is damped, also that of constraint forces.
IntegratorCase radau_case(int degree)
{
    IntegratorCase c = integrator_case(Radau{degree});
    const double order = 2 * degree - 1;
    if (degree <= 4) c.orders = {{{order}, {order}, {order}}};
    c.keeps_linear_momentum = true;
    c.is_stable = c.is_stable_with_preload = true;
    if (degree > 2) c.seen = 0;
    return c;
}

IntegratorCase midpoint_case()
{
    IntegratorCase c = integrator_case(Midpoint{});
    c.orders = {{{2}, {2}, {2}}};
    c.reversal = Reversal::points;   // the momenta it carries need not be tangent, those handed over are
    c.keeps_linear_momentum = c.keeps_angular_momentum = true;
    c.is_stable = c.is_stable_with_preload = true;
    return c;
}

IntegratorCase endpoint_case()
{
    IntegratorCase c = integrator_case(Endpoint{});
    c.orders = {{{1}, {1}, {1}}};
    c.keeps_linear_momentum = true;
    c.is_stable = c.is_stable_with_preload = true;
    return c;
}

/// Momenta and (without constraints) reversal are those of the natural start: Hamilton's law with all its
/// rows. None is stable but strong ones of Lagrange degree 1 and 2, which damp.
IntegratorCase mixed_case(const Pairing& pairing, const Orders& orders)
{
    IntegratorCase c = integrator_case(mixed(pairing));
    c.orders = orders;
    c.reversal = pairing.start == natural ? Reversal::points : Reversal::never;
    c.keeps_linear_momentum = true;
    c.keeps_angular_momentum = pairing.start == natural;
    c.holds = Holds::weakly;
    c.n_smallest = pairing.basis == lagrange ? 1 : pairing.degree + 1;
    c.is_stable = pairing.basis == lagrange && pairing.start == strong && pairing.degree <= 2;
    c.is_stable_with_preload = c.is_stable;
    return c;
}

/// With as many Gauss points as the degree the strong start is Gauss collocation.
IntegratorCase collocation_case(int degree)
{
    Mixed method;
    method.degree = method.gauss_points = degree;
    method.start = strong;
    IntegratorCase c = integrator_case(method, "p Gauss points");
    c.orders = {{{2}, {}, {}}};
    c.reversal = Reversal::points;
    c.keeps_linear_momentum = c.keeps_angular_momentum = true;
    c.holds = Holds::weakly;
    c.is_stable = c.is_stable_with_preload = true;
    return c;
}

std::vector<IntegratorCase> all_integrators()
{
    std::vector<IntegratorCase> cases{midpoint_case(), endpoint_case(), collocation_case(1),
                                      collocation_case(2)};
    for (int degree = 1; degree <= 16; ++degree) cases.push_back(lobatto_case(degree));
    for (int degree = 1; degree <= 8; ++degree) cases.push_back(radau_case(degree));
    // No rate is stated where an error of another order still wins (the hinged brick with the natural start),
    // where Newton may fail (two bricks with the strong start), and, of some pairings, to save time.
    for (const auto& [pairing, orders] : std::vector<std::pair<Pairing, Orders>>{
             {{lagrange, 1, natural, equal}, {{{2}, {2}, {}}}},
             {{lagrange, 2, natural, equal}, {{{3}, {3}, {}}}},
             {{lagrange, 3, natural, equal}, {{{4}, {}, {4}}}},
             {{lagrange, 2, natural, lower}, {{{2}, {}, {2}}}},
             {{lagrange, 3, natural, lower}, {{{4}, {}, {}}}},
             {{lagrange, 2, strong, equal}, {{{2}, {}, {2}}}},
             {{lagrange, 3, strong, equal}, {{{4}, {}, {}}}},
             {{lagrange, 2, strong, lower}, {{{2}, {}, {}}}},
             {{bspline, 2, natural, equal}, {{{3}, {3}, {}}}},
             {{bspline, 2, natural, lower}, {{{3}, {}, {}}}},
             {{bspline, 2, strong, equal}, {{{3, 0.3}, {}, {3}}}},
             {{bspline, 2, strong, lower}, {{{3}, {}, {}}}},
             {{nurbs, 2, natural, equal}, {{{3}, {}, {}}}},
             {{nurbs, 2, natural, lower}, {}},
             {{nurbs, 2, strong, equal}, {}},
             {{nurbs, 2, strong, lower}, {}}})
        cases.push_back(mixed_case(pairing, orders));
    return cases;
}

}   // namespace

const std::vector<IntegratorCase>& integrator_cases()
{
    static const std::vector<IntegratorCase> cases = all_integrators();
    return cases;
}

}   // namespace livens
