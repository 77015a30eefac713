// SPDX-License-Identifier: BSD-3-Clause
// The table of the kinds of joints: words, keys and makers. From it follow the reader, the page
// docs/scenario.md and the JSON Schema, so none of them can lack a kind. Rows of each kind are in
// docs/joints.md and theory.md, Joints are quadratic forms.
#include "livens/io/scenario/joints/joint_kinds.h"

#include <cmath>

#include "livens/io/scenario/bodies/bodies.h"
#include "livens/io/scenario/joints/joints.h"
#include "livens/multibody/joints/spline_curve.h"

namespace livens::inline io_internal {

namespace {

const Key at{"at", types::point, "Position of the joint in the world, where `[[body]]` places the bodies.",
             "m"};
const Key axis{"axis", types::vector3,
               "Direction of the joint axis in the world, of any length; goes with `at`."};
const Key points{"points", types::two_points,
                 "The joint point on each body, in that body's coordinates. Default for a rod: the reference "
                 "points (for the world: its origin).",
                 "m"};
const Key axes{"axes", types::pair,
               "One direction per body, of any length: in body coordinates with `points`, in the world with "
               "`at`. For a joint with one common axis, this axis on each body. For a joint with an axis on "
               "each body, these two axes; those of a universal joint are perpendicular."};
const Key line{"axis", types::vector3,
               "Direction of the line, or normal of the plane, on the first body, of any length: in the "
               "world with `at`, in coordinates of the first body with `points`."};
const Key free_axis{"axis", types::vector3,
                    "Direction of the axis in the world, of any length. Excludes `axes`."};
const Key angle{"coordinate", types::number, "Value of the joint angle where `[[body]]` places the bodies.",
                "rad", "0"};
const Key joints{"joints", types::names, "Names of two joints: first the driving one, then the driven one."};
const Key displacement{"coordinate", types::number,
                       "Value of the joint displacement where `[[body]]` places the bodies.", "m", "0"};
const Key angle_rate{"rate", types::number, "Initial rate of the angle; see also `[[start.coordinates]]`.",
                     "rad/s"};
const Key displacement_rate{"rate", types::number,
                            "Initial rate of the displacement; see also `[[start.coordinates]]`.", "m/s"};

Key frames_of_joint()
{
    return frames_key(
        "frame of a joint",
        "Two frames that the joint keeps together, one on each body and in that body's coordinates. They say "
        "all about the placement: `at`, `axis`, `points` and `axes` are left out. The third axis of a frame "
        "is "
        "the joint axis. The first axis counts where a joint prevents the turn about the third: weld, "
        "prismatic, constant_velocity, and screw at zero displacement align the first axes of both frames; "
        "other types ignore them.");
}

const Key angles{
    "angles",
    types::choice,
    "Axes of three angles of the rotation, which become the coordinates angle_1, angle_2, angle_3: "
    "first about an axis on the first body, last about one on the second. The second angle stays "
    "within 90 degrees, near which the others are not unique. Default: no angles.",
    "",
    "",
    false,
    {"xyz", "xzy", "yxz", "yzx", "zxy", "zyx"}};

Key frames_of_ball()
{
    return frames_key(
        "frame of a joint",
        "Two frames, one on each body and in that body's coordinates, that meet in one point: "
        "`at` and `points` are left out. The rotation of the joint is that from the first frame "
        "to the second, and angles are zero where both coincide. Default: axes of the first "
        "body, which those of the second are parallel to where `[[body]]` places the bodies.");
}

/// A kind of the library with a maker that takes a frame.
template <Joint make(const std::string&, int, int, const JointFrame&, double)>
Joint by_frame(const JointParts& p)
{
    return make(p.name, p.first, p.second, p.frame, p.scale);
}
/// Likewise, with the configurations that it holds.
template <Joint make(const std::string&, int, int, const JointFrame&, const Matrix34&, const Matrix34&,
                     double)>
Joint as_it_stands(const JointParts& p)
{
    return make(p.name, p.first, p.second, p.frame, p.X_first, p.X_second, p.scale);
}

Joint make_screw(const JointParts& p)
{
    return screw(p.name, p.first, p.second, p.frame, p.X_first, p.X_second, p.section.number("pitch"),
                 p.scale);
}
/// Matrices are stored column by column: these are the columns first, second, third.
Matrix3 triad_of(const Vector3& third, const Vector3& first)
{
    const Vector3 second = cross(third, first);
    return {first[0], first[1], first[2], second[0], second[1], second[2], third[0], third[1], third[2]};
}

Joint make_constant_angle(const JointParts& p)
{
    // What is not stated is as the bodies stand, so that the joint is closed at the start.
    const double value = p.section.has("angle") ? p.section.number("angle") : p.angle();
    return constant_angle(p.name, p.first, p.second, p.frame, value, p.scale);
}
Joint make_spherical(const JointParts& p)
{
    const std::string about = p.section.text("angles");
    if (p.has_point_mass && !about.empty())
        throw InputError({"joint-angles", "joint[" + p.name + "].angles",
                          "a point mass has no axes, and a ball joint on it no angles", "", "", "",
                          "leave 'angles' out, or give the body a shape or an inertia"});
    if (p.has_point_mass) return spherical(p.name, p.first, p.second, p.frame, p.scale);
    TriadPair triads;
    if (p.section.has("frames"))
        triads = {triad_of(p.frame.axis_first, p.frame.across_first),
                  triad_of(p.frame.axis_second, p.frame.across_second)};
    else
        // Axes of the first body, in coordinates of the second: nothing is turned where they stand.
        triads.second = transpose(directors(p.X_second)) * directors(p.X_first);
    return spherical(p.name, p.first, p.second, p.frame, {triads, about}, p.X_first, p.X_second, p.scale);
}

Joint make_rod(const JointParts& p)
{
    const double length = p.section.has("length") ? p.section.number("length") : p.distance();
    return rod(p.name, p.first, p.second, p.frame, length);
}

Joint make_slot(const JointParts& p)
{
    const Section& curve = *only_section(p.section, "curve");
    std::vector<Vector3> places;
    for (int i = 0; i < curve.find("points")->n_rows; ++i)
        // Points are stated along the directors, which may be skew; the model has the nearest triad.
        places.push_back(p.stretch_first * curve.row("points", i));
    return slot(p.name, p.first, p.second, spline_curve(places, curve.truth("closed")),
                p.frame.point_second + p.stretch_second * p.section.vector("point"), p.X_first, p.X_second,
                p.scale);
}

/// What turns about one axis, slides along it, or neither.
std::vector<JointKind> kinds_of_one_axis()
{
    const Key frames = frames_of_joint();
    return {
        {{"weld", "rigid connection (6 constraints)", {at, points, frames}},
         Location::at_point,
         as_it_stands<weld>},
        {{"revolute", "hinge: rotation about one axis (5 constraints)",
          and_along_angle({at, axis, points, axes, frames, angle, angle_rate})},
         Location::on_axis,
         by_frame<revolute>},
        {{"prismatic", "slider: translation along one axis (5 constraints)",
          and_along_displacement({at, axis, points, axes, frames, displacement, displacement_rate})},
         Location::on_axis,
         as_it_stands<prismatic>},
        {{"cylindrical", "rotation about one axis and translation along it (4 constraints)",
          and_along_both({at, axis, points, axes, frames})},
         Location::on_axis,
         by_frame<cylindrical>},
        {{"screw", "rotation about one axis with proportional translation along it (5 constraints)",
          and_along_both(
              {at, axis, points, axes, frames,
               Key{"pitch", types::number, "Displacement per turn; positive for a right-handed thread.", "m"}
                   .needed()})},
         Location::on_axis,
         make_screw},
        {{"planar", "translation in a plane and rotation about its normal, the joint axis (3 constraints)",
          and_along_angle({at, axis, points, axes, frames, angle, angle_rate})},
         Location::on_axis,
         by_frame<planar>}};
}

/// What holds points, or the directions of two axes.
std::vector<JointKind> kinds_of_points_and_axes()
{
    static const Key frames = frames_of_joint();
    return {
        {{"universal",
          "Cardan joint: rotation about two perpendicular axes (4 constraints)",
          {at, points, axes, frames, table_along_angle("angle_1", "the angle about the first body's axis"),
           table_along_angle("angle_2", "the angle about the second body's axis")}},
         Location::on_two_axes,
         by_frame<universal>},
        {{"constant_velocity",
          "two shafts that turn by equal angles, at any angle between them (4 constraints)",
          {at, points, axes, frames}},
         Location::on_two_axes,
         as_it_stands<constant_velocity>},
        {{"spherical", "ball joint: one common point (3 constraints)",
          and_against_turns({at, points, frames_of_ball(), angles})},
         Location::at_point,
         make_spherical},
        {{"point_on_line", "a point of the second body stays on a line of the first (2 constraints)",
          and_along_displacement({at, line, points, frames, displacement, displacement_rate})},
         Location::on_line,
         by_frame<point_on_line>},
        {{"point_in_plane",
          "a point of the second body stays in a plane of the first (1 constraint)",
          {at, line, points, frames}},
         Location::on_line,
         by_frame<point_in_plane>},
        {{"parallel_axes", "an axis of each body; the two stay parallel (2 constraints)",
          and_along_angle({free_axis, axes, frames, angle, angle_rate})},
         Location::along_axis,
         by_frame<parallel_axes>},
        {{"perpendicular_axes",
          "an axis of each body; the two stay perpendicular (1 constraint)",
          {at, axes, frames}},
         Location::along_two_axes,
         by_frame<perpendicular_axes>},
        {{"constant_angle",
          "an axis of each body, at a constant angle to each other (1 constraint)",
          {at, axes, frames,
           Key{"angle", types::number,
               "Angle between the axes. Default: their angle where `[[body]]` places the bodies.", "rad"}}},
         Location::along_two_axes,
         make_constant_angle}};
}

std::vector<JointKind> kinds_of_curves_and_distances()
{
    return {
        {{"slot",
          "a point of the second body stays on a curve of the first (2 constraints); for a straight slot use "
          "point_on_line, or point_in_plane if other joints hold the point sideways",
          {Key{"curve", types::table, "The curve, on the first body."}.needed().holding(
               {"curve of a slot",
                "A cubic spline through points, continued by straight lines beyond its ends.",
                {Key{"points", types::rows, "Two or more points, in coordinates of the first body.", "m"}
                     .needed(),
                 Key{"closed", types::truth, "Whether the curve continues from the last point to the first.",
                     "", "false"}}}),
           Key{"point", types::point, "The point that slides, in coordinates of the second body.", "m",
               "[0, 0, 0]"}}},
         Location::on_curve,
         make_slot},
        {{"rod",
          "constant distance between two points, or a rope over several points: the sum of its spans is "
          "constant "
          "(1 constraint)",
          {points, over_key(),
           Key{"length", types::number,
               "Length of the rod: the distance of its points, or of a rope the sum of its spans. Default: "
               "what it is where `[[body]]` places the bodies.",
               "m"}
               .within(positive)}},
         Location::at_points,
         make_rod}};
}

/// What couples the coordinates of others.
std::vector<JointKind> kinds_of_coordinates()
{
    return {
        {{"gear",
          "the angle of one joint is proportional to that of another (1 constraint)",
          {joints, Key{"ratio", types::number,
                       "Turns of the second joint per turn of the first; negative for external gears whose "
                       "axes point the same way."}
                       .needed()}},
         Location::of_joints,
         [](const JointParts& p) {
             return gear(p.name, *p.coupled[0].joint, *p.coupled[1].joint, p.section.number("ratio"), p.X);
         }},
        {{"rack_and_pinion",
          "the displacement of one joint is proportional to the angle of another (1 constraint)",
          {joints, Key{"radius", types::number,
                       "Displacement of the second joint per radian of the first: the pinion's radius, of "
                       "either sign.",
                       "m"}
                       .needed()}},
         Location::of_joints,
         [](const JointParts& p) {
             return rack_and_pinion(p.name, *p.coupled[0].joint, *p.coupled[1].joint,
                                    p.section.number("radius"), p.X, p.scale);
         }},
        {{"coupling",
          "a weighted sum of coordinates of any joints is constant, or a function of one more (1 constraint)",
          {Key{"terms", types::factors,
               "The factor of each coordinate in the sum, under its name in quotes, as in `{ \"left.angle\" "
               "= "
               "1, \"slide.displacement\" = \"-2 1/m\" }`. Angles are in rad, displacements in m; where "
               "factors have units, all terms must have one."}
               .needed(),
           law_key()}},
         Location::of_joints,
         make_coupling}};
}

}   // namespace

const std::vector<JointKind>& joint_kinds()
{
    static const std::vector<JointKind> all = [] {
        std::vector<JointKind> kinds = kinds_of_one_axis();
        for (const std::vector<JointKind>& more :
             {kinds_of_points_and_axes(), kinds_of_curves_and_distances(), kinds_of_coordinates()})
            kinds.insert(kinds.end(), more.begin(), more.end());
        return kinds;
    }();
    return all;
}

Key over_key()
{
    return Key{
        "over", types::tables,
        "A rope instead of a line between two points: the points over which it runs freely, two or more, "
        "in this order, on any bodies or the world. It replaces `between` and `points`."}
        .holding(
            {"point of a rope",
             "A place that the rope ends at or runs over, without friction or size, as an eye or a small "
             "pulley.",
             {Key{"body", types::text, body_or_world_or_point}.needed_without("point"),
              Key{"point", types::point, "Its place, in coordinates of that body.", "m", "[0, 0, 0]"}}});
}

Key frames_key(const std::string& heading, const std::string& doc)
{
    std::vector<Key> keys{
        {"point", types::point, "Origin of the frame, in body coordinates.", "m", "[0, 0, 0]"}};
    for (const Key& key : orientation_keys()) keys.push_back(key);
    return Key{"frames", types::tables, doc}.holding(
        {heading, "Origin and axes of a frame on a body.", keys});
}

}   // namespace livens::inline io_internal
