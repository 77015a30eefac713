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

Key body_key() { return Key{"body", types::text, "The body on which the load acts."}.needed(); }

/// Of what acts at a point.
Key body_of_point()
{
    return Key{"body", types::text,
               "The body on which the load acts. Not needed with the name of a point in `point`."}
        .needed_without("point");
}

Key reaction_key()
{
    return {"reaction", types::text,
            "Another body, which takes the opposite torque: a couple between the two. Default: none, or "
            "`\"world\"`."};
}

Key interpolation_key()
{
    return choice("interpolation", {"linear", "spline"},
                  "Piecewise linear, or a cubic spline with two continuous derivatives (not-a-knot).");
}

Key times_key()
{
    return Key{"times", types::list,
               "Two or more times, ascending. Two equal times make a jump (linear interpolation only).", "s"}
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
    return {{"from", types::number_or_condition,
             "Time, or condition, at which the load begins to act. Default: always active.", "s"},
            {"until", types::number_or_condition,
             "Time, or condition, at which the load ceases to act. Default: never.", "s"}};
}

/// A constant, a table of values over time or a formula, and when it acts.
std::vector<Key> keys_on_body(const std::string& what, std::string_view unit, const std::vector<Key>& more)
{
    const Key table = Key{"table", types::table, "Values as a function of time."}.holding(
        {"table of a " + what,
         "Values are interpolated between the times and constant before and after.",
         {times_key(), Key{"values", types::rows, "One value per time.", unit}.needed(),
          interpolation_key()}});
    return joined({more.empty() || more.front().name != "point" ? body_key() : body_of_point()}, more,
                  std::vector<Key>{
                      Key{"value", types::vector3, "Constant value. Excludes `table` and `expression`.", unit}
                          .or_formulas(formulas_for_value),
                      table},
                  expression_keys(true),
                  std::vector<Key>{choice<Frame>(
                      "frame", "Axes of the values: fixed in the world, or rotating with the body.")},
                  interval_keys());
}

std::vector<Key> keys_of_spring()
{
    const Key table = Key{"table", types::table, "Force over elongation, for the law `table`."}.holding(
        {"table of a spring",
         "Forces are interpolated between the rows and continued by straight lines beyond them.",
         {Key{"elongations", types::list,
              "Elongation from `free_length` or `rest`: two or more values, ascending.", "m"}
              .or_in("rad")
              .needed(),
          Key{"forces", types::list,
              "One force per elongation, positive in the direction in which a stretched spring pulls.", "N"}
              .or_in("N m")
              .needed(),
          interpolation_key()}});
    return {
        Key{"between", types::names,
            "Names of the two bodies, first and second; one of them may be `\"world\"`. Not needed with "
            "names "
            "of points in `points`."},
        Key{"joint", types::text, "Joint along whose coordinate the spring acts; instead of `between`."},
        coordinate_key(),
        over_key(),
        Key{"points", types::two_points,
            "Attachment point on each body, in that body's coordinates. Default: the reference points (for "
            "the world: its origin).",
            "m"},
        choice("law", {"linear", "progressive", "table"},
               "Elastic force as a function of the elongation e, measured from `free_length` or `rest`. "
               "linear: stiffness e; progressive: stiffness e + cubic e^3; table: interpolated in `table`."),
        Key{"stiffness", types::number,
            "Force per metre of elongation, or torque per radian. Needed, except with the law `table` and "
            "for a pure damper or preload.",
            "N/m"}
            .or_in("N m/rad")
            .within(not_negative),
        Key{"cubic", types::number, "Coefficient of e^3 in the law `progressive`.", "N/m^3"}
            .or_in("N m/rad^3")
            .within(not_negative),
        table,
        Key{"damping", types::number, "Force per m/s of elongation rate, or torque per rad/s.", "N s/m", "0"}
            .or_in("N m s/rad")
            .within(not_negative),
        Key{"free_length", types::number,
            "Unloaded length, for a spring with `between` or `over`. Needed if it has a stiffness or a law.",
            "m"}
            .within(not_negative),
        Key{"rest", types::number, "Unloaded value of the coordinate, for a spring with `joint`.", "m", "0"}
            .or_in("rad"),
        Key{"preload", types::number,
            "Constant force or torque in the direction in which a stretched spring pulls.", "N", "0"}
            .or_in("N m")};
}

std::vector<Key> keys_of_actuator()
{
    const Key table = Key{"table", types::table, "Values as a function of time."}.holding(
        {"table of an actuator",
         "Values are interpolated between the times and constant before and after.",
         {times_key(), Key{"values", types::list, "One value per time.", "N"}.or_in("N m").needed(),
          interpolation_key()}});
    return joined({Key{"joint", types::text, "Name of the joint."}.needed(), coordinate_key(),
                   Key{"value", types::number, "Constant value. Excludes `table` and `expression`.", "N"}
                       .or_in("N m")
                       .or_formulas(formulas_for_value),
                   table},
                  expression_keys(false), interval_keys());
}

Key surface_key()
{
    return {"surface", types::text,
            "Name of the surface. In a mesh file: a physical group (MSH), a solid (STL) or object/group "
            "(OBJ); in a union: the name of a part. Default: the whole surface, if the body is one solid."};
}

std::vector<Key> keys_of_pressure()
{
    const Key table = Key{"table", types::table, "Values as a function of time."}.holding(
        {"table of a pressure",
         "Values are interpolated between the times and constant before and after.",
         {times_key(), Key{"values", types::list, "One value per time.", "Pa"}.needed(),
          interpolation_key()}});
    const Key gradient{
        "gradient", types::vector3,
        "Adds gradient . x to the pressure at world position x, over the whole surface; for water `[0, 0, "
        "-9810]`. The water has no free surface: where the total is negative, the load pulls.",
        "Pa/m"};
    return joined(
        {body_key(), surface_key(), gradient,
         Key{"value", types::number, "Constant value. Excludes `table` and `expression`.", "Pa"}.or_formulas(
             formulas_for_value),
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
        "per unit of u, where u holds three displacements in m and a rotation vector in rad: the six "
        "diagonal entries of the stiffness matrix, or all 36 entries of a symmetric matrix row by row, in "
        "N/m "
        "and N m/rad, or as strings with units. Valid for rotations up to 175 degrees: at half a turn the "
        "rotation vector changes sign, and a motion that comes closer is reported as suspect.";
    return {
        Key{"between", types::names,
            "Names of the two bodies, first and second; one of them may be `\"world\"`."}
            .needed(),
        Key{"at", types::point,
            "Initial position in the world; the axes of both frames are then initially the world axes.", "m"},
        frames_key("frame of a bushing",
                   "Two frames between which the bushing acts, one on each body and in that body's "
                   "coordinates, instead of `at`. Displacements and rotations are those of the second frame "
                   "relative to the first, in axes of the first."),
        Key{"stiffness", types::list, "Force and torque " + of_u}
            .each_in(units_of_bushing("N/m", "N/rad", "N m/m", "N m/rad"))
            .needed(),
        Key{"damping", types::list,
            "Damping in the same form, for the rate of u. Its last three components are rates of the "
            "rotation vector: they equal the relative angular velocity for small rotations and for rotations "
            "about one axis, but not for large rotations about several axes; see `damping_by`."}
            .each_in(units_of_bushing("N s/m", "N s/rad", "N m s/m", "N m s/rad")),
        choice("damping_by", {"rotation_vector", "angular_velocity"},
               "Quantity that the last three components of the damping act on: the rate of the rotation "
               "vector, or the "
               "relative angular velocity in axes of the first frame."),
        Key{"preload", types::list,
            "Three forces in N and three torques in N m that do not depend on u, with the sign of the "
            "elastic ones at positive u."}
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

Load make_rotational_damper(const LoadSources& p)
{
    return rotational_damper(p.name, p.first, p.second, p.section.number("damping"), places(p.builder));
}

Load make_attraction(const LoadSources& p)
{
    return attraction(p.name, p.first, p.builder.model().bodies()[p.first],
                      {p.section.vector("point"), p.section.number("mu"), p.section.truth("gradient")},
                      places(p.builder));
}

std::vector<Key> keys_of_attraction()
{
    return {body_key(),
            Key{"point", types::point, "Position of the attracting point in the world.", "m", "[0, 0, 0]"},
            Key{"mu", types::number, "Gravitational parameter: gravitational constant times attracting mass.",
                "m^3/s^2"}
                .needed()
                .within(positive),
            Key{"gradient", types::truth,
                "Whether to include the next term of the potential: the gravity gradient, which exerts a "
                "torque on an extended body.",
                "", "false"}};
}

}   // namespace

namespace {

LoadKind torque_kind()
{
    return {{"torque", "acts on a body, or as a couple between two",
             keys_on_body("torque", "N m", {reaction_key()})},
            make_torque,
            check_value};
}

}   // namespace

const std::vector<LoadKind>& load_kinds()
{
    const Key point{"point", types::point, "Point of application, in body coordinates.", "m", "[0, 0, 0]"};
    static const std::vector<LoadKind> all{
        {{"force", "acts at a point of a body", keys_on_body("force", "N", {point})},
         make_force,
         check_value},
        torque_kind(),
        {{"spring",
          "acts along the line between two points, along a rope over several points, or along a joint "
          "coordinate, "
          "with a damper",
          keys_of_spring()},
         make_spring,
         check_spring},
        {{"actuator", "force or torque along a joint coordinate, between the two bodies of the joint",
          keys_of_actuator()},
         make_actuator,
         check_value},
        {{"bushing", "stiffness and damping against all relative displacements and rotations of two frames",
          keys_of_bushing()},
         make_bushing,
         check_bushing},
        {{"rotational_damper",
          "torque against the relative angular velocity of two bodies, for rotations of any kind",
          {Key{"between", types::names,
               "Names of the two bodies, first and second; one of them may be `\"world\"`."}
               .needed(),
           Key{"damping", types::number, "Damping torque per rad/s.", "N m s/rad"}.needed().within(
               not_negative)}},
         make_rotational_damper},
        {{"drag",
          "resistance (linear + quadratic abs(v)) v against the velocity v of a point relative to the medium",
          {body_of_point(), point,
           Key{"linear", types::number, "Coefficient of the linear part.", "N s/m", "0"}.within(not_negative),
           Key{"quadratic", types::number, "Coefficient of the quadratic part.", "N s^2/m^2", "0"}.within(
               not_negative),
           Key{"medium", types::vector3, "Velocity of the medium, world axes.", "m/s", "[0, 0, 0]"}}},
         make_drag,
         check_drag},
        {{"attraction", "gravitational attraction toward a point: mu mass / r^2 at the centre of mass",
          keys_of_attraction()},
         make_attraction},
        {{"traction", "force per unit area on a surface of the body's shape",
          keys_on_body("traction", "Pa",
                       {surface_key(), Key{"gradient", types::triple,
                                           "Adds gradient theta to the traction at body coordinates theta; "
                                           "one row per component of the traction.",
                                           "Pa/m"}})},
         make_traction,
         check_field},
        {{"pressure", "acts on a surface of the body's shape, normal to it as the body moves",
          keys_of_pressure()},
         make_pressure,
         check_field},
        {{"body_force", "force per unit mass over the whole body", keys_on_body("body_force", "m/s^2", {})},
         make_body_force,
         check_value}};
    return all;
}

}   // namespace livens::inline io_internal
