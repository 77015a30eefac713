// SPDX-License-Identifier: BSD-3-Clause
// The table of the kinds of loads: words, keys, checks and makers, from which the reader, docs/scenario.md
// and the JSON Schema follow. Units stand at the keys; what acts on a joint has two, one for angles and one
// for displacements.
#include "livens/io/scenario/loads/load_kinds.h"

#include "livens/io/scenario/joints/expressions.h"
#include "livens/io/scenario/joints/joints.h"
#include "livens/io/scenario/loads/load_makers.h"

namespace livens::inline io_internal {

namespace {

Key body_key() { return Key{"body", types::text, "On which body it acts."}.needed(); }

/// Of what acts at a point.
Key body_of_point()
{
    return Key{"body", types::text, "On which body it acts; a name as `point` says it as well."}
        .needed_without("point");
}

Key interpolation_key()
{
    return choice("interpolation", {"linear", "spline"},
                  "Straight lines, or a cubic spline with two continuous derivatives (not-a-knot).");
}

Key times_key()
{
    return Key{"times", types::list, "Ascending, two or more; two equal ones are a jump (linear only).", "s"}
        .needed();
}

template <class... More>
std::vector<Key> joined(std::vector<Key> keys, const More&... more)
{
    (keys.insert(keys.end(), more.begin(), more.end()), ...);
    return keys;
}

std::vector<Key> interval_keys()
{
    return {{"from", types::number, "Acts from then on; default: always.", "s"},
            {"until", types::number, "Acts until then; default: for ever.", "s"}};
}

/// A constant, a table of values over time or a formula, and when it acts.
std::vector<Key> keys_on_body(const std::string& what, std::string_view unit, const std::vector<Key>& more)
{
    const Key table = Key{"table", types::table, "As a function of time."}.holding(
        {"table of a " + what,
         "Values between the times; constant before and after.",
         {times_key(), Key{"values", types::rows, "One for each time.", unit}.needed(),
          interpolation_key()}});
    return joined(
        {more.empty() || more.front().name != "point" ? body_key() : body_of_point()}, more,
        std::vector<Key>{Key{"value", types::vector3, "Constant; instead of `table`.", unit}.or_formulas(
                             formulas_for_value),
                         table},
        expression_keys(true),
        std::vector<Key>{
            choice<Frame>("frame", "Axes of the values: fixed in the world, or turning with the body.")},
        interval_keys());
}

std::vector<Key> keys_of_spring()
{
    const Key table = Key{"table", types::table, "With the law `table`."}.holding(
        {"table of a spring",
         "Forces between the rows; straight on before and after.",
         {Key{"elongations", types::list, "From `free_length` or `rest`; ascending, two or more.", "m"}
              .or_in("rad")
              .needed(),
          Key{"forces", types::list, "One for each; positive where it pulls back.", "N"}
              .or_in("N m")
              .needed(),
          interpolation_key()}});
    return {
        Key{"between", types::names,
            "The two bodies it connects; one may be `\"world\"`; names in `points` say them as well."},
        Key{"joint", types::text, "Instead of `between`: the joint along whose coordinate it acts."},
        coordinate_key(),
        Key{"points", types::two_points,
            "Its ends on each body, in the body's coordinates. Default: the reference points, for the "
            "world its origin.",
            "m"},
        choice(
            "law", {"linear", "progressive", "table"},
            "Force by elongation e, from `free_length` or `rest`: stiffness e, stiffness e + cubic e^3, or "
            "`table`."),
        Key{"stiffness", types::number,
            "Force for each metre of elongation, or torque for each radian; needed but by the law `table` "
            "and "
            "by what has `damping` or `preload` alone.",
            "N/m"}
            .or_in("N m/rad")
            .within(not_negative),
        Key{"cubic", types::number, "With the law `progressive`.", "N/m^3"}
            .or_in("N m/rad^3")
            .within(not_negative),
        table,
        Key{"damping", types::number, "Force for each m/s of elongation, or torque for each rad/s.", "N s/m",
            "0"}
            .or_in("N m s/rad")
            .within(not_negative),
        Key{"free_length", types::number,
            "With `between`, and needed there if there is a stiffness or a law: length without force.", "m"}
            .within(not_negative),
        Key{"rest", types::number, "With `joint`: the coordinate without force.", "m", "0"}.or_in("rad"),
        Key{"preload", types::number, "A constant force or torque, which pulls back at any elongation.", "N",
            "0"}
            .or_in("N m")};
}

std::vector<Key> keys_of_actuator()
{
    const Key table = Key{"table", types::table, "As a function of time."}.holding(
        {"table of an actuator",
         "Values between the times; constant before and after.",
         {times_key(), Key{"values", types::list, "One for each time.", "N"}.or_in("N m").needed(),
          interpolation_key()}});
    return joined({Key{"joint", types::text, "The joint."}.needed(), coordinate_key(),
                   Key{"value", types::number, "Constant; instead of `table`.", "N"}.or_in("N m").or_formulas(
                       formulas_for_value),
                   table},
                  expression_keys(false), interval_keys());
}

Key surface_key()
{
    return {
        "surface", types::text,
        "By its name: of a mesh in its file, a physical group (MSH), a solid (STL), object/group (OBJ); of "
        "a union that of a part. Default: all of a body that is one solid."};
}

std::vector<Key> keys_of_pressure()
{
    const Key table = Key{"table", types::table, "As a function of time."}.holding(
        {"table of a pressure",
         "Values between the times; constant before and after.",
         {times_key(), Key{"values", types::list, "One for each time.", "Pa"}.needed(),
          interpolation_key()}});
    const Key gradient{"gradient", types::vector3,
                       "What is added is gradient . x at the place x in the world, on all of the surface: of "
                       "water, `[0, 0, -9810]`. There is no surface of the water: where the sum is negative, "
                       "it pulls.",
                       "Pa/m"};
    return joined(
        {body_key(), surface_key(), gradient,
         Key{"value", types::number, "Constant; instead of `table`.", "Pa"}.or_formulas(formulas_for_value),
         table},
        expression_keys(false), interval_keys());
}

/// Of forces and torques by displacements and rotations, as the matrix of a bushing has them.
Words units_of_bushing(std::string_view force_by_length, std::string_view force_by_angle,
                       std::string_view torque_by_length, std::string_view torque_by_angle)
{
    Words all;
    for (int i = 0; i < 36; ++i) {
        const bool is_torque = i >= 18, is_angle = i % 6 >= 3;
        all.push_back(is_torque ? (is_angle ? torque_by_angle : torque_by_length)
                                : (is_angle ? force_by_angle : force_by_length));
    }
    return all;
}

std::vector<Key> keys_of_bushing()
{
    const std::string of_u =
        "of u, three displacements in m and a rotation vector in rad: six numbers, or 36 "
        "of a symmetric matrix row by row, in N/m and N m/rad, or strings with units of their own. Up to 175 "
        "degrees: at half a "
        "turn the vector changes its sign, and a motion that gets there is suspect.";
    return {
        Key{"between", types::names, "The two bodies it connects; one may be `\"world\"`."}.needed(),
        Key{"at", types::point, "Its point at the start, in the world, whose axes it has there.", "m"},
        frames_key("frame of a bushing", "Instead of `at`: one frame for each body, in its coordinates; "
                                         "displacements and rotations are those of the second in axes "
                                         "of the first."),
        Key{"stiffness", types::list, "Force and torque " + of_u}
            .each_in(units_of_bushing("N/m", "N/rad", "N m/m", "N m/rad"))
            .needed(),
        Key{"damping", types::list,
            "Likewise of the rate of u, whose last three are the rates of the rotation vector: the relative "
            "angular velocity for small turns and for turns about one axis, not for large ones about "
            "several."}
            .each_in(units_of_bushing("N s/m", "N s/rad", "N m s/m", "N m s/rad")),
        Key{"preload", types::list, "Three forces in N, three torques in N m, against u wherever it is."}
            .each_in({"N", "N", "N", "N m", "N m", "N m"})};
}

bool check_drag(const Section& load)
{
    return load.has("linear") || load.has("quadratic") ||
           load.error("", "load-value", load.label() + " has neither 'linear' nor 'quadratic'",
                      {"", "give at least one of them"});
}

Load make_drag(const LoadSources& p)
{
    const Section& s = p.section;
    return drag(p.name, p.first, point_of(p), {s.number("linear"), s.number("quadratic"), s.vector("medium")},
                places(p.builder));
}

Load make_attraction(const LoadSources& p)
{
    return attraction(p.name, p.first, p.builder.model().bodies()[p.first],
                      {p.section.vector("point"), p.section.number("mu"), p.section.truth("gradient")},
                      places(p.builder));
}

}   // namespace

const std::vector<LoadKind>& load_kinds()
{
    const Key point{"point", types::point, "Where it acts, in body coordinates.", "m", "[0, 0, 0]"};
    static const std::vector<LoadKind> all{
        {{"force", "at a point of a body", keys_on_body("force", "N", {point})}, make_force, check_value},
        {{"torque", "on a body", keys_on_body("torque", "N m", {})}, make_torque, check_value},
        {{"spring", "with a damper, along the line between two points or on a joint", keys_of_spring()},
         make_spring,
         check_spring},
        {{"actuator", "a force or torque along a coordinate of a joint, between its bodies",
          keys_of_actuator()},
         make_actuator,
         check_value},
        {{"bushing", "springs and dampers against all displacements and rotations of two frames",
          keys_of_bushing()},
         make_bushing,
         check_bushing},
        {{"drag",
          "against the velocity v of a point, (linear + quadratic |v|) v",
          {body_of_point(), point, Key{"linear", types::number, "", "N s/m", "0"}.within(not_negative),
           Key{"quadratic", types::number, "", "N s^2/m^2", "0"}.within(not_negative),
           Key{"medium", types::vector3, "Velocity of the medium, world axes.", "m/s", "[0, 0, 0]"}}},
         make_drag,
         check_drag},
        {{"attraction",
          "gravity toward a point, mu mass / r^2 at the centre of mass",
          {body_key(), Key{"point", types::point, "The attracting point, in the world.", "m", "[0, 0, 0]"},
           Key{"mu", types::number, "Constant of gravity times the attracting mass.", "m^3/s^2"}
               .needed()
               .within(positive),
           Key{"gradient", types::truth,
               "Also what the body's extent does, which turns it: the next term of the potential.", "",
               "false"}}},
         make_attraction},
        {{"traction", "force per area on a surface of the body's shape",
          keys_on_body("traction", "Pa",
                       {surface_key(),
                        Key{"gradient", types::triple,
                            "What is added is gradient theta at the place theta in the body: a row for each "
                            "component of the traction.",
                            "Pa/m"}})},
         make_traction,
         check_field},
        {{"pressure", "against a surface of the body's shape, which it follows", keys_of_pressure()},
         make_pressure,
         check_field},
        {{"body_force", "force per unit mass on all of a body", keys_on_body("body_force", "m/s^2", {})},
         make_body_force,
         check_value}};
    return all;
}

}   // namespace livens::inline io_internal
