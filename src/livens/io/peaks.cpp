// SPDX-License-Identifier: BSD-3-Clause
#include "livens/io/peaks.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "livens/base/error.h"
#include "livens/io/scenario/text/findings.h"
#include "livens/spacetime/solve.h"

namespace livens {

namespace {

[[noreturn]] void refuse_name(const Quantities& quantities, const std::string& name)
{
    std::vector<std::string> known;
    std::vector<std::string_view> parts, of_part;
    for (const NamedQuantity& q : quantities.all()) {
        known.push_back(q.name());
        for (int i = 0; q.size > 1 && i < q.size; ++i) known.push_back(q.name() + "." + component_of(q, i));
        if (!q.part.empty() && std::ranges::find(parts, q.part) == parts.end()) parts.push_back(q.part);
        if (!q.part.empty() && name == q.part) of_part.push_back(q.what);
    }
    std::string help = "there are ";
    if (of_part.empty()) {
        const std::vector<std::string_view> all(known.begin(), known.end());
        help = closest(name, all).empty()
                   ? "write a part and what of it, as in \"pivot.force\"; parts " + suggest("", parts)
                   : suggest(name, all);
    } else {
        for (std::size_t i = 0; i < of_part.size(); ++i)
            help += (i > 0 ? ", '" : "'") + name + "." + std::string(of_part[i]) + "'";
    }
    throw InputError(
        {"quantity-unknown", "", "the motion has no number of this name", "'" + name + "'", "", "", help});
}

}   // namespace

QuantitySeries find_series(const Quantities& quantities, const std::string& name)
{
    std::vector<QuantitySeries> found;
    for (const NamedQuantity& q : quantities.all()) {
        if (q.is_repeated) continue;
        if (name == q.name()) found.push_back({q, -1});
        for (int i = 0; q.size > 1 && i < q.size; ++i)
            if (name == q.name() + "." + component_of(q, i)) found.push_back({q, i});
    }
    if (found.empty()) refuse_name(quantities, name);
    if (found.size() > 1)
        throw InputError({"quantity-unknown", "", "several parts have a number of this name",
                          "'" + name + "'", "", "", "give one of them another name"});
    if (found[0].component < 0 && found[0].quantity.size == 4)
        throw InputError({"quantity-unknown", "", "a quaternion has no magnitude", "'" + name + "'", "", "",
                          "ask for a component, as in \"" + name + ".w\""});
    return found[0];
}

namespace {

/// What mechanisms are judged by; where bodies are is asked for by name.
std::vector<QuantitySeries> usual_series(const Quantities& quantities)
{
    std::vector<QuantitySeries> all;
    for (const NamedQuantity& q : quantities.all())
        if (q.of != QuantityOf::body && q.of != QuantityOf::model && !q.is_repeated &&
            q.what != "limit_stiffness")
            all.push_back({q});
    for (const NamedQuantity& q : quantities.all())
        if (q.of == QuantityOf::model) all.push_back({q});
    return all;
}

}   // namespace

std::vector<Extremes> find_peaks(const Run& run, const Scenario& scenario, const Method& method,
                                 std::span<const std::string> names)
{
    const Quantities quantities(scenario.model, run.motion, run.body_names);
    std::vector<QuantitySeries> series;
    for (const std::string& name : names) series.push_back(find_series(quantities, name));
    if (names.empty()) series = usual_series(quantities);
    const ExactSampler exact(scenario.model, run.motion, method, scenario.options);
    const BetterState better = [&](double t) -> std::optional<BetterSample> {
        try {
            ExactSample sample = exact.at(t);
            if (!sample.report.converged()) return {};
            return BetterSample{std::move(sample.state), std::move(sample.joints)};
        } catch (const InputError&) {   // where an element cannot begin, the polynomials tell
            return {};
        }
    };
    const bool has_one = !std::holds_alternative<Mixed>(method);
    return find_extremes(quantities, run.motion, series, has_one ? better : BetterState());
}

}   // namespace livens
