// SPDX-License-Identifier: BSD-3-Clause
#include "livens/io/shown_unit.h"

#include <algorithm>

#include "livens/base/error.h"
#include "livens/io/scenario/text/units.h"

namespace livens {

ShownUnit shown_unit(const std::string& unit, std::span<const std::string> wished)
{
    const std::size_t slash = unit.find('/');
    const std::string first = unit.substr(0, slash),
                      rest = slash == std::string::npos ? "" : unit.substr(slash);
    for (const std::string& wish : wished) {
        std::vector<std::string> ways{wish};
        if (!rest.empty() && (first == "rad" || first == "m")) ways.push_back(wish + rest);
        for (const std::string& way : ways)
            if (const Quantity q = parse_quantity("1 " + way, unit); q.error.empty())
                return {1 / q.value, way};
    }
    return {1, unit};
}

void check_shown_units(std::span<const std::string> wished, const std::vector<std::string>& units)
{
    for (const std::string& wish : wished) {
        const auto fits = [&](const std::string& unit) {
            return unit == wish || shown_unit(unit, {&wish, 1}).unit != unit;
        };
        if (std::ranges::any_of(units, fits)) continue;
        std::string kinds;
        for (std::size_t i = 0; i < units.size(); ++i)
            if (std::find(units.begin(), units.begin() + static_cast<std::ptrdiff_t>(i), units[i]) ==
                units.begin() + static_cast<std::ptrdiff_t>(i))
                kinds += (kinds.empty() ? "" : ", ") + units[i];
        throw InputError({"unit", "unit", "'" + wish + "' is no unit of what is shown, which is in " + kinds,
                          "", "", "",
                          "angles: 'deg', 'rev'; rates: 'deg', 'rpm'; lengths: 'mm'; forces: 'kN'"});
    }
}

}   // namespace livens
