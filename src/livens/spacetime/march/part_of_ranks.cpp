// SPDX-License-Identifier: BSD-3-Clause
// How elements are divided among ranks.
#include "livens/spacetime/march/part_of_ranks.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace livens::inline spacetime_internal {

std::vector<int> parts_of_ranks(const Model& model, const TimeMesh& mesh, int n_ranks, const Method& method)
{
    const std::vector<double> breaks = model.load_breaks();
    const double reach = 1e-9 * (mesh.end() - mesh.start());   // as in tears_of()
    // Of mixed those in the middle carry both of their ends along, in memory and in work.
    const double at_ends = std::holds_alternative<Mixed>(method) ? 1.4 : 1;
    const double all = n_ranks - 2 + 2 * at_ends;
    std::vector<int> parts{0};
    for (int rank = 1; rank < n_ranks; ++rank) {
        int e = static_cast<int>(mesh.n_elements() * (rank - 1 + at_ends) / all);
        e = std::max(e, parts.back() + 1);
        const auto is_near = [&](double t) { return std::abs(t - mesh.ends[e]) <= reach; };
        while (e < mesh.n_elements() && std::ranges::any_of(breaks, is_near)) ++e;
        parts.push_back(e);
    }
    parts.push_back(mesh.n_elements());
    return parts;
}

std::string said_by_first(const std::string& own, Ranks& ranks)
{
    constexpr double nobody = 1e9;
    const double first = -ranks.largest(own.empty() ? -nobody : -ranks.rank());
    if (first >= nobody) return "";
    const int speaker = static_cast<int>(first);
    double size = static_cast<double>(own.size());
    ranks.broadcast(speaker, {&size, 1});
    std::vector<double> letters(static_cast<std::size_t>(size));
    if (ranks.rank() == speaker) std::ranges::copy(own, letters.begin());
    ranks.broadcast(speaker, letters);
    std::string words;
    for (const double letter : letters) words += static_cast<char>(letter);
    return words;
}

}   // namespace livens::inline spacetime_internal
