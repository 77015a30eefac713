// SPDX-License-Identifier: BSD-3-Clause
// Quantities by the names that people write, and their extremes: polynomials tell where, and elements that
// are solved anew up to there tell how large (theory.md, "Extremes").
#include "livens/io/peaks.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "livens/base/error.h"
#include "livens/io/scenario/text/findings.h"
#include "livens/spacetime/solve.h"

namespace livens {

namespace {

/// The longest name of a part with which a name begins; empty: there is none.
std::string part_of(const Quantities& quantities, const std::string& name)
{
    std::string part;
    for (const NamedQuantity& q : quantities.all())
        if (q.part.size() > part.size() && (name == q.part || name.starts_with(q.part + "."))) part = q.part;
    return part;
}

[[noreturn]] void refuse_name(const Quantities& quantities, const std::string& name)
{
    // What the part has, where the part is meant beyond doubt.
    const std::string part = part_of(quantities, name);
    std::vector<std::string> known, quoted;
    std::vector<std::string_view> parts;
    for (const NamedQuantity& q : quantities.all()) {
        if (std::ranges::find(parts, q.part) == parts.end() && !q.part.empty()) parts.push_back(q.part);
        if (!part.empty() && q.part != part) continue;
        known.push_back(q.name());
        quoted.push_back("'" + q.name() + "'");
        for (int i = 0; q.size > 1 && i < q.size; ++i) known.push_back(q.name() + "." + component_of(q, i));
    }
    const std::vector<std::string_view> all(known.begin(), known.end());
    std::string help = suggest(name, all);
    if (!part.empty() && (name == part || closest(name, all).empty())) {
        help = "there are ";
        for (std::size_t i = 0; i < quoted.size(); ++i) help += (i > 0 ? ", " : "") + quoted[i];
    } else if (closest(name, all).empty()) {
        help = "write a part and what of it, as in \"pivot.force\"; parts " + suggest("", parts);
    }
    throw InputError(
        {"quantity-unknown", "", "the motion has no number of this name", "'" + name + "'", "", "", help});
}

}   // namespace

QuantitySeries find_series(const Quantities& quantities, const std::string& name)
{
    std::vector<QuantitySeries> found;
    // A point may have the name of a body, which is meant then.
    for (const bool is_on_request : {false, true})
        for (const NamedQuantity& q : quantities.all()) {
            if (q.is_repeated || q.is_on_request != is_on_request || (is_on_request && !found.empty()))
                continue;
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
        if (q.of != QuantityOf::body && q.of != QuantityOf::model && !q.is_repeated && !q.is_on_request &&
            !q.what.starts_with("limit_"))
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
