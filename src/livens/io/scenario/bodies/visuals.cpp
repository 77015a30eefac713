// SPDX-License-Identifier: BSD-3-Clause
// Shapes that are looked at alone: they have no mass, may overlap, and stand for the shape of a body in all
// pictures where there are some.
#include "livens/io/scenario/bodies/visuals.h"

#include <algorithm>

#include "livens/io/scenario/bodies/bodies.h"
#include "livens/io/scenario/bodies/colors.h"
#include "livens/io/scenario/bodies/primitives.h"
#include "livens/io/scenario/bodies/shapes.h"

namespace livens::inline io_internal {

namespace {

bool check_color(const Section& section)
{
    const Value* given = section.find("color");
    if (given == nullptr || given->n_rows > 0 || parse_color(given->text)) return true;
    return section.error("color", "unknown-choice",
                         "'color' of " + section.label() + " cannot be \"" + given->text + "\"",
                         {"", color_help(given->text)});
}

void read_color(const Section& section, Outline& outline)
{
    const Value* given = section.find("color");
    if (given != nullptr)
        outline.color = given->n_rows > 0 ? section.vector("color") : parse_color(given->text);
    if (section.has("opacity")) outline.opacity = section.number("opacity");
}

Outline outline_of(const Section& visual, MeshStore& meshes)
{
    for (const Value& v : visual.values())
        if (const Primitive* p = find_primitive(v.key->name)) return p->outline(visual);
    const double unit = mesh_unit(visual);
    const Surface& picture = meshes.picture(visual.text("mesh"));
    Outline outline;
    outline.points = picture.points;
    outline.triangles = picture.triangles;
    outline.n_left_out = picture.n_left_out;
    outline.moved = picture.moved;
    outline.stretch = {unit, unit, unit};
    return outline;
}

}   // namespace

std::vector<Key> color_keys(const char* color, const char* opacity)
{
    return {Key{"color", types::color, color}.within({0, 1}),
            Key{"opacity", types::number, opacity}.within({0, 1, true})};
}

Key visual_key(const char* doc)
{
    Table visual{"visual",
                 "A shape that is drawn and has no mass: exactly one of these shapes, placed on the body or "
                 "in the world.",
                 {}};
    for (const Primitive& p : primitives()) visual.keys.push_back(p.key);
    visual.keys.push_back(
        {"mesh", types::text,
         "Mesh file: STL, OBJ, PLY, DAE (Collada) or Gmsh MSH. The path is relative to the scenario's "
         "folder and must stay inside it. The surface need not be closed."});
    visual.keys.push_back(
        {"unit", types::text,
         "Length unit of the numbers in the mesh file, such as `\"mm\"`. Needed for a mesh; `\"m\"` for DAE, "
         "whose numbers are converted by the unit that the file states."});
    visual.keys.push_back(
        Key{"scale", types::number, "Scale factor for the mesh.", "", "1"}.within(positive));
    visual.keys.push_back({"position", types::vector3,
                           "Position of the shape's origin, in body or world coordinates.", "m",
                           "[0, 0, 0]"});
    for (const Key& key : orientation_keys()) visual.keys.push_back(key);
    for (const Key& key :
         color_keys("Colour. Default: that of the body.", "Opacity; 1 is opaque. Default: that of the body."))
        visual.keys.push_back(key);
    return Key{"visual", types::table_or_tables, doc}.holding(visual);
}

Table world_table()
{
    return {"[world]",
            "Fixed surroundings: a floor, walls, the base of a robot. They are drawn and have no effect on "
            "the motion.",
            {visual_key("One shape or a list of shapes, in world coordinates.")}};
}

bool check_look(const Section& section)
{
    const Value* given = section.find("visual");
    bool is_right = !section.takes("color") || check_color(section);
    if (given != nullptr && given->sections.empty())
        return section.error("visual", "shape", "'visual' of " + section.label() + " has no shapes",
                             {"", "leave it out, or give a list of tables such as { box = [1, 1, 1] }"});
    for (const Section& visual : section.sections("visual"))
        is_right = check_orientation(visual) && check_shape(visual) && check_color(visual) && is_right;
    return is_right;
}

/// A visual has the colour and opacity of its body unless it says its own. One whose mesh cannot be read is
/// told at its key, and the body is read on.
void read_look(const Section& section, MeshStore& meshes, Outline& outline)
{
    if (section.takes("color")) read_color(section, outline);
    for (const Section& visual : section.sections("visual")) {
        try {
            Outline one = outline_of(visual, meshes);
            one.place = visual.vector("position");
            one.axes = read_orientation(visual);
            one.color = outline.color;
            one.opacity = outline.opacity;
            read_color(visual, one);
            outline.visuals.push_back(std::move(one));
        } catch (const InputError& error) {
            const Complaint& c = error.complaint();
            visual.error("mesh", c.code, c.message, {c.note, c.help});
        }
    }
}

}   // namespace livens::inline io_internal
