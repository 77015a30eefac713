// SPDX-License-Identifier: BSD-3-Clause
// Tables of the functions M_A, M_A' and L_A that the integrals of (P23) need. They depend on time alone and
// are made once a block, so that Newton's iteration multiplies and adds (docs/theory.md, "The elements of the
// paper": Quadrature says how many points, "Loads that jump" what a tear is).
#include "livens/spacetime/mixed/functions.h"

#include <algorithm>
#include <span>
#include <utility>

#include "livens/time/quadrature.h"

namespace livens::mixed {

BlockFunctions::BlockFunctions(TimeSpace space, TimeSpace multipliers, int gauss_points,
                               const std::vector<int>& tears)
    : space_(std::move(space)), multipliers_(std::move(multipliers))
{
    const Quadrature rule = gauss(gauss_points);
    places_ = rule.points;
    weights_ = rule.weights;
    const std::size_t n_points = static_cast<std::size_t>(n_elements()) * rule.points.size();
    M_.resize(n_points * n_local());
    D_.resize(M_.size());
    L_.resize(n_points * n_local_multipliers());
    std::vector<double> unused(static_cast<std::size_t>(n_local_multipliers()));
    std::vector<int> n_of(static_cast<std::size_t>(space_.size()), 0);   // elements of each function
    lengths_.assign(n_of.size(), 0.0);
    centres_.assign(n_of.size(), 0.0);
    for (int e = 0, n_tears = 0; e < n_elements(); ++e) {
        n_tears += std::binary_search(tears.begin(), tears.end(), e);
        n_tears_.push_back(n_tears);
        for (int g = 0; g < n_gauss(); ++g) {
            const std::size_t at = static_cast<std::size_t>(e) * rule.points.size() + g;
            const auto part = [&](std::vector<double>& table, int n) {
                return std::span<double>(table).subspan(at * n, n);
            };
            space_.evaluate(e, rule.points[g], part(M_, n_local()), part(D_, n_local()));
            multipliers_.evaluate(e, rule.points[g], part(L_, n_local_multipliers()), unused);
        }
        for (int a = 0; a < n_local(); ++a) {
            ++n_of[first(e) + a];
            lengths_[first(e) + a] += space_.length(e);
            centres_[first(e) + a] += space_.ends()[e] + 0.5 * space_.length(e);
        }
    }
    for (std::size_t A = 0; A < n_of.size(); ++A) {
        lengths_[A] /= n_of[A];
        centres_[A] /= n_of[A];
    }
}

/// Of multipliers of a lower degree one more on both sides.
std::pair<int, int> BlockFunctions::elements_of(int begin, int end) const
{
    int low = 0, high = n_elements();
    const int p = n_local() - 1;
    // functions ascend with elements
    while (high > low) {
        const int middle = (low + high) / 2;
        if (first(middle) + p < begin)
            low = middle + 1;
        else
            high = middle;
    }
    int last = low;
    while (last < n_elements() && first(last) < end) ++last;
    return {std::max(low - p, 0), std::min(last + p, n_elements())};
}

void BlockFunctions::go_on(double before, double behind)
{
    if (before > 0) lengths_.front() = 0.5 * (lengths_.front() + before);
    if (behind > 0) lengths_.back() = 0.5 * (lengths_.back() + behind);
}

}   // namespace livens::mixed
