// SPDX-License-Identifier: BSD-3-Clause
// What laws of loads do inside of an element that its load points do not see.
#pragma once

#include <array>
#include <vector>

#include "livens/diagnostics/estimate.h"
#include "livens/spacetime/nodal/way.h"

namespace livens {

class InstantSystem;
struct InstantState;

/// Compares, along the polynomials of a solved element, the impulse of every law that need not be smooth with
/// what the element's quadrature took of it (docs/theory.md, "Looks at laws"). The way is divided where a law
/// may be steeper than what is seen of it, by bounds over ranges, so that what is narrow costs a number of
/// looks that grows as the logarithm of its width.
class InsideLaws {
public:
    /// References must outlive it.
    InsideLaws(const Tables& tables, const ElementRule& rule);

    /// Of element e, whose end state is `end`, prepared by `instant`: how what was not seen would have kicked
    /// the bodies, and the load that kicks most. `angles`: at its first node, see Turns.
    Unseen look(const Stretch& stretch, const Nodes& nodes, int e, const std::vector<double>& angles,
                InstantSystem& instant, InstantState& end);

private:
    /// Legendre polynomials on the element, by which what was not seen is weighed: of degree 0, 1, 2.
    static constexpr std::size_t n_moments = 3;
    struct Law {
        int load = 0;
        std::vector<int> bodies;
        LawInside inside;
        std::vector<double> mobility;   // of each unit: what it accelerates, in lengths or rad
    };
    /// Points of Gauss, and weights by which these, the middle one left out, and both ends tell whether their
    /// integral can be trusted: [end, points.., end].
    struct CheckedRule {
        Quadrature gauss;
        std::vector<double> check;

        explicit CheckedRule(int n_points);
    };
    /// A piece of the way, and integrals over it: of factor k with the polynomial m at [m * n_factors + k].
    struct Panel {
        double first = 0, last = 1;
        double doubt = 0;   // of what may be hidden in it, lengths or rad
        std::vector<double> moments;
    };

    void weigh(Law& law) const;
    bool is_calm(const Law& law, const Stretch& stretch, const Nodes& nodes, int e);
    void follow(const Law& law, const Stretch& stretch, const Nodes& nodes, int e,
                const std::vector<double>& angles);
    void factors_at(const Law& law, double share, double* factors);
    EnclosedValue range(std::size_t number, std::size_t n, const Panel& panel) const;
    double steepness_doubt(const Law& law, const Panel& panel, const std::vector<double>& seen);
    double quadrature_doubt(const Law& law, const CheckedRule& rule, const Panel& panel,
                            const std::vector<double>& seen) const;
    void integrate(const Law& law, const CheckedRule& rule, Panel& panel);
    void divide(const Law& law, std::vector<Panel>& panels);
    std::vector<double> unseen(const Law& law);

    const Tables& tables_;
    const ElementRule& rule_;
    std::vector<Law> laws_;
    Way way_;
    LagrangeBasis basis_;       // on which the numbers of a law are known
    CheckedRule fine_, some_;   // of the whole way, and of its pieces
    // Of the law at hand: its numbers at the nodes of basis_, and bounds of their derivatives.
    std::vector<double> numbers_, slopes_, second_, third_;
    std::vector<double> work_, at_;
    double start_ = 0, h_ = 0;
};

}   // namespace livens
