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

const Key at{"at", types::point, "The joint's point at the start, in the world.", "m"};
const Key axis{"axis", types::vector3, "With `at`: the axis at the start, world axes, of any length."};
const Key points{"points", types::two_points,
                 "The joint's point on each body, in its coordinates. A rod's default: the reference points, "
                 "for the world its origin.",
                 "m"};
const Key axes{
    "axes", types::pair,
    "One direction for each body, of any length, in its coordinates, or with `at` in the world: the "
    "common axis (with `points`), or the two axes of joints that have one on each body: a universal joint "
    "turns about both, which stand at right angles."};
const Key line{
    "axis", types::vector3,
    "Direction of the line, or normal of the plane, on the first body, of any length: with `at` in the "
    "world at the start, with `points` in coordinates of the first body."};
const Key free_axis{"axis", types::vector3, "The axis at the start, world axes, of any length; or `axes`."};
const Key angle{"coordinate", types::number, "What the joint's angle is called where the bodies are stated.",
                "rad", "0"};
const Key joints{"joints", types::names, "Two joints by name: the driving one and the one that follows."};
const Key displacement{"coordinate", types::number,
                       "What the joint's displacement is called where the bodies are stated.", "m", "0"};
const Key angle_rate{"rate", types::number, "Of the angle at the start; see also `[[start.coordinates]]`.",
                     "rad/s"};
const Key displacement_rate{"rate", types::number,
                            "Of the displacement at the start; see also `[[start.coordinates]]`.", "m/s"};

Key frames_of_joint()
{
    return frames_key("frame of a joint",
                      "Instead of all others: one frame for each body, in its coordinates. The third axis is "
                      "the joint's. The first axes are held the same way by weld, prismatic and "
                      "constant_velocity, and by a screw where its displacement is zero; others do not look "
                      "at them.");
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
Joint make_constant_angle(const JointParts& p)
{
    // What is not stated is as the bodies stand, so that the joint is closed at the start.
    const double value = p.section.has("angle") ? p.section.number("angle") : p.angle();
    return constant_angle(p.name, p.first, p.second, p.frame, value, p.scale);
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
        {{"weld", "nothing moves (6 rows)", {at, points, frames}}, Location::at_point, as_it_stands<weld>},
        {{"revolute", "turns about one axis (5)", {at, axis, points, axes, frames, angle, angle_rate}},
         Location::on_axis,
         by_frame<revolute>},
        {{"prismatic",
          "slides along one axis (5)",
          {at, axis, points, axes, frames, displacement, displacement_rate}},
         Location::on_axis,
         as_it_stands<prismatic>},
        {{"cylindrical", "turns about one axis and slides along it (4)", {at, axis, points, axes, frames}},
         Location::on_axis,
         by_frame<cylindrical>},
        {{"screw",
          "turns about one axis and slides along it in step (5)",
          {at, axis, points, axes, frames,
           Key{"pitch", types::number, "Metres a turn; positive: right-handed.", "m"}.needed()}},
         Location::on_axis,
         make_screw},
        {{"planar",
          "slides in a plane, whose normal is the axis, and turns in it (3)",
          {at, axis, points, axes, frames, angle, angle_rate}},
         Location::on_axis,
         by_frame<planar>}};
}

/// What holds points, or the directions of two axes.
std::vector<JointKind> kinds_of_points_and_axes()
{
    static const Key frames = frames_of_joint();
    return {{{"universal", "turns about two perpendicular axes (4)", {at, points, axes, frames}},
             Location::on_two_axes,
             by_frame<universal>},
            {{"constant_velocity",
              "two shafts that turn equally, however they are bent (4)",
              {at, points, axes, frames}},
             Location::on_two_axes,
             as_it_stands<constant_velocity>},
            {{"spherical", "one common point (3)", {at, points}}, Location::at_point, by_frame<spherical>},
            {{"point_on_line",
              "a point of the second body on a line of the first (2)",
              {at, line, points, frames, displacement, displacement_rate}},
             Location::on_line,
             by_frame<point_on_line>},
            {{"point_in_plane",
              "a point of the second body in a plane of the first (1)",
              {at, line, points, frames}},
             Location::on_line,
             by_frame<point_in_plane>},
            {{"parallel_axes",
              "an axis of each that stay parallel (2)",
              {free_axis, axes, frames, angle, angle_rate}},
             Location::along_axis,
             by_frame<parallel_axes>},
            {{"perpendicular_axes", "an axis of each that stay perpendicular (1)", {at, axes, frames}},
             Location::along_two_axes,
             by_frame<perpendicular_axes>},
            {{"constant_angle",
              "an axis of each at a constant angle (1)",
              {at, axes, frames,
               Key{"angle", types::number, "Between the axes. Default: what it is at the start.", "rad"}}},
             Location::along_two_axes,
             make_constant_angle}};
}

std::vector<JointKind> kinds_of_curves_and_distances()
{
    return {
        {{"slot",
          "a point of the second body on a curve of the first (2); for a straight one point_on_line, or "
          "point_in_plane where nothing has to hold it sideways",
          {Key{"curve", types::table, "Where the point slides."}.needed().holding(
               {"curve of a slot",
                "A cubic spline through points, straight on beyond its ends.",
                {Key{"points", types::rows, "Two or more, in coordinates of the first body.", "m"}.needed(),
                 Key{"closed", types::truth, "Whether it comes back from the last point to the first.", "",
                     "false"}}}),
           Key{"point", types::point, "What slides, in coordinates of the second body.", "m", "[0, 0, 0]"}}},
         Location::on_curve,
         make_slot},
        {{"rod",
          "fixed distance (1)",
          {points, Key{"length", types::number, "Default: the distance of its points at the start.", "m"}
                       .within(positive)}},
         Location::at_points,
         make_rod}};
}

/// What couples the coordinates of others.
std::vector<JointKind> kinds_of_coordinates()
{
    return {
        {{"gear",
          "the angle of one joint follows that of another (1)",
          {joints, Key{"ratio", types::number,
                       "Turns of the second joint for one turn of the first; negative for "
                       "wheels that mesh outside, with axes that point the same way."}
                       .needed()}},
         Location::of_joints,
         [](const JointParts& p) { return gear(p.name, *p.one, *p.other, p.section.number("ratio"), p.X); }},
        {{"rack_and_pinion",
          "the displacement of one joint follows the angle of another (1)",
          {joints, Key{"radius", types::number,
                       "Displacement of the second joint for a turn of the first by one "
                       "radian; of either sign.",
                       "m"}
                       .needed()}},
         Location::of_joints,
         [](const JointParts& p) {
             return rack_and_pinion(p.name, *p.one, *p.other, p.section.number("radius"), p.X, p.scale);
         }}};
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

Key frames_key(const std::string& heading, const std::string& doc)
{
    std::vector<Key> keys{{"point", types::point, "In coordinates of the body.", "m", "[0, 0, 0]"}};
    for (const Key& key : orientation_keys()) keys.push_back(key);
    return Key{"frames", types::tables, doc}.holding({heading, "Point and axes.", keys});
}

}   // namespace livens::inline io_internal
