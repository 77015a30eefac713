// SPDX-License-Identifier: BSD-3-Clause
// Units of keys along a joint coordinate, which is an angle or a displacement (docs/scenario.md, Numbers and
// units).
#include "livens/io/scenario/joints/joints.h"

namespace livens::inline io_internal {

void check_units(const Section& section, bool is_angle, const std::string& path)
{
    for (const Value& v : section.values()) {
        for (const Section& inner : v.sections)
            check_units(inner, is_angle, path + "." + std::string(v.key->name));
        if (v.key->other_unit.empty() || !(is_angle ? v.has_unit : v.has_other_unit)) continue;
        throw InputError({"unit", path + "." + std::string(v.key->name),
                          "'" + std::string(v.key->name) + "' of " + section.label() + " is along " +
                              (is_angle ? "an angle" : "a length"),
                          "", "", "",
                          "give it in " + std::string(is_angle ? v.key->other_unit : v.key->unit)});
    }
}

}   // namespace livens::inline io_internal
