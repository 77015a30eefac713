// SPDX-License-Identifier: BSD-3-Clause
// Whether what is stated suits a coordinate: units, and how far an angle goes.
#include <cmath>
#include <numbers>

#include "livens/base/text.h"
#include "livens/io/scenario/joints/joints.h"

namespace livens::inline io_internal {

void check_driven_angle(const JointReference& of, const TimeFunction& law,
                        const std::array<double, 2>& during, const std::string& path)
{
    const CoordinateKind kind = of.coordinate->coordinate.kind;
    const bool is_of_rotation = kind == CoordinateKind::rotation_component;
    if (kind != CoordinateKind::arc_sine && !is_of_rotation) return;
    const double most = is_of_rotation ? widest_rotation : 0.5 * std::numbers::pi;
    constexpr int n_looks = 1000;   // what passes between them is no number, see driven_coordinate()
    for (int i = 0; i <= n_looks; ++i) {
        const double t = during[0] + (during[1] - during[0]) * i / n_looks, q = law({t}).value;
        if (std::abs(q) < most) continue;
        const std::string name = "'" + of.joint->name + "." + of.coordinate->name + "'",
                          value = to_text(q) + " rad at t = " + to_text(t, 6) + " s";
        if (is_of_rotation)
            throw InputError({"drive-angle", path, name + " is driven to 175 degrees or beyond", value,
                              "less than 175 degrees either way",
                              "at half a turn a rotation vector begins again on the other side",
                              "drive an angle instead: 'angles' of the joint, or a joint with one axis"});
        throw InputError({"drive-angle", path, name + " is driven to a quarter turn or beyond", value,
                          "less than 90 degrees either way",
                          "there the other two angles of the joint are one",
                          "choose other 'angles' of the joint, so that this axis comes first or last"});
    }
}

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
