// SPDX-License-Identifier: BSD-3-Clause
// What the keys of a [[load]] have to be together.
// The schema says what each key may be; rules that concern several keys are here. They are checked before
// anything is made, so that messages speak of keys.
#include <string>

#include "livens/io/scenario/builder.h"
#include "livens/io/scenario/loads/load_makers.h"

namespace livens::inline io_internal {

/// One of several keys that say how large a load is.
bool check_value(const Section& load)
{
    if (!load.at_most_one({"value", "table", "expression"}, "load-value")) return false;
    if (!load.has("expression"))
        return load.refuse({"inputs", "breaks"}, "load-value", "there is no 'expression'") &&
               (load.has("value") || load.has("table") ||
                load.error("", "load-value",
                           load.label() + " has neither 'value' nor 'table' nor 'expression'",
                           {"", "give 'value' for a constant, 'table' for a function of time, 'expression' "
                                "for a formula"}));
    return true;
}

/// A field that may be linear in the place.
bool check_field(const Section& load)
{
    if (load.has("gradient") && load.has("inputs"))
        return load.error("inputs", "load-value",
                          "'inputs' and 'gradient' of " + load.label() + " stand together",
                          {"a formula that looks at the motion is the same all over the surface",
                           "give the gradient to a load of its own, with value = 0"});
    if (load.has("gradient") && !load.has("value") && !load.has("table") && !load.has("expression"))
        return true;
    return check_value(load);
}

namespace {

/// A force that does not look at the elongation: that of a damper, or a constant one.
// A damper and a constant force have no length without force to be stated.
bool is_without_spring(const Section& load)
{
    const bool is_soft = !load.has("stiffness") || load.number("stiffness") == 0;
    return load.text("law") == "linear" && is_soft && (load.has("damping") || load.has("preload"));
}

/// The bodies or the joint, and where there is no force.
bool check_place(const Section& load)
{
    if (load.has("joint"))
        return load.refuse({"points", "free_length"}, "spring-place", "it acts on a joint: give 'rest'");
    if (!load.refuse({"rest", "coordinate"}, "spring-place",
                     "it acts between two points, and its length without force is 'free_length'"))
        return false;
    return load.has("free_length") || is_without_spring(load) ||
           load.error("", "spring-place", load.label() + " lacks 'free_length'",
                      {"", "give the length at which it has no force"});
}

bool check_law(const Section& load)
{
    const std::string law = load.text("law");
    const auto needs = [&](std::string_view key, const std::string& help) {
        return load.has(key) ||
               load.error("", "spring-law", load.label() + " lacks '" + std::string(key) + "'", {"", help});
    };
    const std::string of_law = "its law is " + law;
    if (law == "table")
        return needs("table", of_law) &&
               load.refuse({"stiffness", "cubic"}, "spring-law", "its law is a table");
    const bool has_force =
        is_without_spring(load) ||
        needs("stiffness",
              law == "linear" ? "give its 'stiffness', or 'damping' for a damper alone" : of_law);
    return has_force && load.refuse({"table"}, "spring-law", of_law) &&
           (law == "progressive" ? needs("cubic", of_law)
                                 : load.refuse({"cubic"}, "spring-law", "its law is linear"));
}

}   // namespace

/// Between two points, or on a joint; linear, or by a law. All that is missing is told.
bool check_spring(const Section& load)
{
    if (const Value* points = load.find("points"); points != nullptr && points->numbers.empty())
        return false;   // names of no points, which was told
    if (!load.at_most_one({"between", "joint", "over"}, "spring-place")) return false;
    if (!load.has("joint") && !load.has("between") && !load.has("over"))
        return load.error(
            "", "spring-place", load.label() + " has neither 'between' nor 'joint' nor 'over'",
            {"", "give 'between', the two bodies it connects, 'joint', the joint it acts on, or 'over', the "
                 "points that it runs over"});
    // Both are evaluated, so that all findings of a spring come in one run.
    const bool is_placed = check_place(load), has_law = check_law(load);
    return is_placed && has_law;
}

}   // namespace livens::inline io_internal
