// SPDX-License-Identifier: BSD-3-Clause
// Shapes of bodies: primitives, meshes and unions of them, reduced to moments and surfaces (theory.md, Bodies
// from meshes). Unions are combined about the centroid of one part; a hole is a part of negative density.
#include "livens/io/scenario/bodies/shapes.h"

#include <algorithm>
#include <cmath>

#include "livens/base/text.h"
#include "livens/io/scenario/bodies/bodies.h"
#include "livens/io/scenario/bodies/collada.h"
#include "livens/io/scenario/bodies/density_fields.h"
#include "livens/io/scenario/bodies/primitives.h"
#include "livens/io/scenario/builder.h"
#include "livens/io/scenario/text/units.h"

namespace livens {

namespace {

std::vector<Key> mesh_keys(bool is_part)
{
    std::vector<Key> keys{
        {"mesh", types::text,
         "Mesh file of the solid: STL, OBJ or PLY (a closed surface), or Gmsh MSH (volume elements or a "
         "closed surface). The path is relative to the scenario's folder and must stay inside it. Mesh "
         "coordinates are body coordinates."},
        {"unit", types::text,
         "Length unit of the numbers in the mesh file, such as `\"mm\"`. Needed for a mesh."},
        Key{"scale", types::number, "Scale factor for the mesh.", "", "1"}.within(positive),
        {"turn", types::flag,
         "Flips faces that point inwards and inverted elements of the mesh, which are errors otherwise."}};
    if (!is_part)
        keys.push_back(
            {"densities", types::named_texts,
             "Density of each volume region of the mesh by its name in the file, as a string with a unit: `{ "
             "steel = \"7850 kg/m^3\" }`. Every region needs one. Excludes `density` and `mass`."});
    return keys;
}

Key density_field_key(bool is_part)
{
    return {
        "density_field", types::text,
        std::string("Density in kg/m^3 as an expression in `x`, `y` and `z`, the position in m along the ") +
            (is_part ? "part's own axes, before `position` and orientation apply" : "axes of the shape") +
            " (for a mesh after `unit` and `scale`): `\"2000 + 300*z\"`. " +
            (is_part ? "It is multiplied by `density`, whose sign makes a hole, and not by the density of "
                       "the body."
                     : "Excludes `density` and `mass`; in a union it belongs to each part.") +
            " A surface mesh accepts linear expressions only."};
}

/// The key that says what a shape or part is; null after an error.
const Key* kind_of(const Section& shape)
{
    const Key* first = nullptr;
    std::string known;
    const auto is_kind = [](std::string_view name) {
        return name == "point" || name == "mesh" || name == "parts" || find_primitive(name) != nullptr;
    };
    for (const Value& v : shape.values()) {
        if (!is_kind(v.key->name)) continue;
        // Two shapes in one table contradict each other; a union says so by `parts`.
        if (first != nullptr) return shape.at_most_one({first->name, v.key->name}, "shape"), nullptr;
        first = v.key;
    }
    if (first != nullptr || !shape.is_valid()) return first;
    for (const Primitive& p : primitives())
        known += (known.empty() ? "give one of " : ", ") + std::string(p.key.name);
    known += shape.takes("parts") ? ", point, mesh, parts" : ", mesh";
    shape.error("", "shape", shape.label() + " is empty", {"", known});
    return nullptr;
}

bool check_density_field(const Section& shape, std::string_view kind)
{
    if (kind == "point") return shape.refuse({"density_field"}, "shape", "a point mass has no extent");
    if (kind == "parts") return shape.refuse({"density_field"}, "shape", "it stands at the parts of a union");
    return true;
}

bool check_mesh(const Section& shape)
{
    if (!shape.has("mesh"))
        return shape.refuse({"unit", "scale", "turn", "densities"}, "shape", "the shape is no mesh");
    if (!shape.has("unit"))
        return shape.error(
            "mesh", "mesh-unit", shape.label() + " has a mesh without 'unit'",
            {"files of meshes do not say what their numbers mean", "add unit = \"mm\", or \"m\""});
    if (shape.takes("densities") && !shape.at_most_one({"density_field", "densities"}, "mass-conflict"))
        return false;
    const double unit = unit_of_length(shape.text("unit"));
    if (is_collada(shape.text("mesh")) && unit > 0 && unit != 1)
        return shape.error("unit", "mesh-unit",
                           "'unit' of " + shape.label() + " is \"m\" for DAE files, not \"" +
                               shape.text("unit") + "\"",
                           {"a DAE file states its own unit, by which its numbers are converted to metres",
                            "write unit = \"m\"; for another size add scale = .."});
    if (unit > 0) return true;
    return shape.error("unit", "mesh-unit",
                       "'unit' of " + shape.label() + " must be a unit of length, not \"" +
                           shape.text("unit") + "\"");
}

/// A solid in its own coordinates.
struct Part {
    Moments moments;    ///< at density 1
    Moments weighted;   ///< by its density if it states that, else likewise
    Outline outline;    ///< about the centroid
    std::vector<NamedSurface> surfaces = {};
};

std::vector<NamedSurface> surfaces_of(const ReducedMesh& mesh, double unit)
{
    std::vector<NamedSurface> surfaces = mesh.surfaces;
    for (NamedSurface& s : surfaces) s.moments = scaled(s.moments, unit);
    return surfaces;
}

void add_surface(std::vector<NamedSurface>& to, const std::string& name, const SurfaceMoments& m)
{
    const auto known = std::ranges::find(to, name, &NamedSurface::name);
    if (known == to.end())
        to.push_back({name, m});
    else
        known->moments = known->moments + m;
}

/// Those of a part; surfaces with one name become one, and the whole of a union is not known. A part with a
/// name has its whole surface by that, and those with names as name/surface besides.
void add_surfaces(std::vector<NamedSurface>& to, const Part& part, const std::string& name,
                  const Matrix3& axes, const Vector3& place)
{
    for (const NamedSurface& s : part.surfaces) {
        const SurfaceMoments m = moved(s.moments, axes, place);
        if (!s.name.empty()) add_surface(to, s.name, m);
        if (!name.empty()) add_surface(to, s.name.empty() ? name : name + "/" + s.name, m);
    }
}

Outline outline_of(const ReducedMesh& mesh, double unit)
{
    Outline outline;
    outline.points = mesh.picture.points;
    outline.triangles = mesh.picture.triangles;
    outline.n_left_out = mesh.picture.n_left_out;
    outline.moved = mesh.picture.moved;
    outline.stretch = {unit, unit, unit};
    return outline;
}

/// With the numbers of parameters, by which meshes are kept.
std::string density_field_of(const Section& shape)
{
    for (const std::string_view place : {"x", "y", "z"})
        if (shape.parameters().find(place) != nullptr)
            throw InputError({"parameter-name", "body.shape",
                              "a density field reads the place " + std::string(place) +
                                  ", and a parameter has this name, too",
                              "", "", "", "call the parameter otherwise"});
    return with_numbers(shape.text("density_field"), shape.parameters());
}

double density_of_region(const Section& shape, const std::string& region, const std::string& text)
{
    const Parameters& parameters = shape.parameters();
    Quantity density;
    if (is_computed(text, parameters)) {
        const Computed found = compute(text, "kg/m^3", parameters);
        density = {found.amount.value, found.error, found.help};
        if (!found.code.empty() && found.error.empty()) density.error = "a parameter is wrong";
    } else {
        density = parse_quantity(text, "kg/m^3");
    }
    if (density.error.empty() && density.value > 0) return density.value;
    throw InputError({"unit", "body.shape",
                      "the density of '" + region + "' cannot be \"" + text + "\"" +
                          (density.error.empty() ? "" : ": " + density.error),
                      "", "> 0 kg/m^3", "", density.help});
}

/// With the densities of its regions, which must all be stated.
Moments weighted(const Section& shape, const ReducedMesh& mesh, double unit)
{
    const Value& value = *shape.find("densities");
    const std::vector<Entry>& entries = value.node->entries();
    std::vector<Moments> parts;
    std::vector<double> densities(mesh.regions.size(), -1);
    std::string known;
    for (const auto& [name, m] : mesh.regions) {
        parts.push_back(scaled(m, unit));
        known += (known.empty() ? "'" : ", '") + name + "'";
    }
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const double density = density_of_region(shape, entries[i].key, value.texts[i]);
        // Names of regions are those of the file; both misspelt and forgotten ones are errors, since a region
        // without a density would weigh nothing.
        bool is_found = false;
        for (std::size_t r = 0; r < mesh.regions.size(); ++r)
            if (mesh.regions[r].first == entries[i].key) densities[r] = density, is_found = true;
        if (!is_found)
            throw InputError({"mesh-region", "body.shape",
                              "the mesh has no region of volume '" + entries[i].key + "'", "", "",
                              known.empty() ? "it has no regions of volume" : "it has " + known, ""});
    }
    for (std::size_t r = 0; r < densities.size(); ++r)
        if (densities[r] < 0)
            throw InputError({"mesh-region", "body.shape",
                              "the region '" + mesh.regions[r].first + "' of the mesh has no density", "", "",
                              "", "'densities' states those of all regions"});
    return combined(parts, densities);
}

Part read_mesh_part(const Section& shape, MeshStore& meshes)
{
    const ReducedMesh& mesh = meshes.find(shape.text("mesh"), shape.has("turn"));
    const double unit = mesh_unit(shape);
    const Moments whole = scaled(mesh.whole, unit);
    Part part{whole, whole, outline_of(mesh, unit), surfaces_of(mesh, unit)};
    if (shape.has("density_field"))
        part.weighted = meshes.weighted(shape.text("mesh"), shape.has("turn"), unit, density_field_of(shape));
    else if (shape.takes("densities") && shape.has("densities"))
        part.weighted = weighted(shape, mesh, unit);
    return part;
}

Part read_part(const Section& shape, MeshStore& meshes, bool with_surfaces)
{
    const Key& key = *kind_of(shape);
    if (key.name == "mesh") return read_mesh_part(shape, meshes);
    const Primitive& p = *find_primitive(key.name);
    const Moments whole = moments(p.make(1, shape));
    Part part{whole, whole, p.outline(shape)};
    if (shape.has("density_field"))
        part.weighted = weighted_by_field(p.solid(shape), density_field_of(shape));
    if (with_surfaces) part.surfaces = {{"", surface_moments(p.solid(shape), whole)}};
    return part;
}

Solid read_union(const Section& shape, double density, MeshStore& meshes, bool with_surfaces)
{
    std::vector<Moments> parts;
    std::vector<double> densities;
    Solid solid;
    solid.has_own_origin = true;
    double mass = 0, size = 0;
    for (const Section& section : shape.sections("parts")) {
        Part part = read_part(section, meshes, with_surfaces);
        const std::string name = section.has("name") ? section.text("name") : "";
        const Matrix3 axes = read_orientation(section);
        const Vector3 place = section.vector("position");
        const double factor = section.number("density");
        parts.push_back(moved(part.weighted, axes, place));
        // A field is a density by itself; other parts have a factor to that of the body.
        densities.push_back(section.has("density_field") ? factor : density * factor);
        mass += densities.back() * parts.back().volume;
        // The mass must exceed 1e-12 of the sum of absolute values: what is less is rounding of parts and
        // holes.
        size += std::abs(densities.back()) * parts.back().volume;
        solid.volume += std::copysign(part.moments.volume, factor);
        solid.parts.push_back({name, densities.back() * parts.back().volume, parts.back().centroid});
        if (factor < 0) continue;   // a picture cannot take away, and a hole has another surface
        add_surfaces(solid.surfaces, part, name, axes, place);
        part.outline.axes = axes;
        part.outline.place = moved(part.moments, axes, place).centroid;
        solid.outline.parts.push_back(std::move(part.outline));
    }
    if (!(mass > 1e-12 * size))
        throw InputError({"shape", "body.shape", "the parts leave no mass", to_text(mass), "> 0",
                          "parts with a negative density are holes in others", ""});
    const Moments whole = combined(parts, densities);
    solid.properties = livens::solid(1, whole);
    // Pictures are drawn about the centre of mass, which is known after all parts.
    for (Outline& part : solid.outline.parts) part.place -= whole.centroid;
    return solid;
}

/// Where the density is not the same all over, the centre of mass is not the centroid.
Outline about(const Vector3& center_of_mass, const Part& part)
{
    Outline whole;
    whole.parts = {part.outline};
    whole.parts.front().place = part.moments.centroid - center_of_mass;
    return whole;
}

}   // namespace

double unit_of_length(const std::string& text)
{
    std::string reason;
    const std::optional<Unit> unit = parse_unit(text, reason);
    if (!unit || unit->dimension != Dimension{1, 0, 0, 0}) return 0;
    const double ratio = unit->numerator / unit->denominator,
                 power = std::pow(10, std::abs(unit->power_of_ten));
    return unit->power_of_ten < 0 ? ratio / power : ratio * power;   // 1e-3 is no double, 1e3 is
}

Table io_internal::shape_table()
{
    Table part{"parts of shape",
               "Parts of a union, each with exactly one of these shapes. Parts must not overlap, except for "
               "holes (negative density).",
               {}};
    for (const Primitive& p : primitives()) part.keys.push_back(p.key);
    for (const Key& key : mesh_keys(true)) part.keys.push_back(key);
    part.keys.push_back(density_field_key(true));
    part.keys.push_back({"name", types::text,
                         "Name of the part. Loads refer to its whole surface by this name, and to a surface "
                         "of its mesh as `name/surface`; `livens mass` lists its mass."});
    part.keys.push_back(
        {"position", types::vector3, "Position of the part's origin in body coordinates.", "m", "[0, 0, 0]"});
    for (const Key& key : orientation_keys()) part.keys.push_back(key);
    part.keys.push_back({"density", types::number,
                         "Density relative to that of the body; -1 makes a hole in parts of density 1.", "",
                         "1"});
    Table shape{"shape of [[body]]",
                "Exactly one of these shapes. Axes of revolution are along d3. The origin of a primitive is "
                "its centre of mass.",
                {}};
    for (const Primitive& p : primitives()) shape.keys.push_back(p.key);
    shape.keys.push_back(Key{"point", types::flag, "Point mass: no orientation, no inertia. Needs `mass`."});
    for (const Key& key : mesh_keys(false)) shape.keys.push_back(key);
    shape.keys.push_back(density_field_key(false));
    shape.keys.push_back(Key{"parts", types::tables, "Union of shapes."}.holding(part));
    return shape;
}

double io_internal::mesh_unit(const Section& shape)
{
    return (shape.has("scale") ? shape.number("scale") : 1) * unit_of_length(shape.text("unit"));
}

bool io_internal::is_point_mass(const Section& body)
{
    const Section* shape = only_section(body, "shape");
    return shape != nullptr && shape->has("point");
}

bool io_internal::check_shape(const Section& shape)
{
    const Key* kind = kind_of(shape);
    if (kind == nullptr || !shape.is_valid() || !check_mesh(shape)) return false;
    if (!check_density_field(shape, kind->name)) return false;
    const Section* tube = kind->name == "cylinder" ? only_section(shape, "cylinder") : nullptr;
    if (tube != nullptr && tube->number("inner_radius") >= tube->number("radius"))
        return tube->error("inner_radius", "size-inner-radius",
                           "'inner_radius' of " + tube->label() + " must be smaller than its radius");
    if (kind->name != "parts") return true;
    if (shape.sections("parts").empty())
        return shape.error("parts", "shape", shape.label() + " has no parts");
    return std::ranges::all_of(shape.sections("parts"), [](const Section& part) {
        return (part.number("density") != 0 ||
                part.error("density", "out-of-range", "'density' of " + part.label() + " must not be 0")) &&
               check_orientation(part) && check_shape(part);
    });
}

DensityBy io_internal::density_by(const Section& shape)
{
    const auto has_field = [](const Section& s) { return s.has("density_field"); };
    if (shape.has("densities") || has_field(shape)) return DensityBy::shape;
    const auto parts = shape.sections("parts");
    if (!std::ranges::any_of(parts, has_field)) return DensityBy::body;
    return std::ranges::all_of(parts, has_field) ? DensityBy::shape : DensityBy::both;
}

Solid io_internal::read_shape(const Section& body, MeshStore& meshes, bool with_surfaces)
{
    const Section* shape = only_section(body, "shape");
    if (shape == nullptr || is_point_mass(body)) return {};
    const double density = body.has("density") ? body.number("density") : 1;
    try {
        const Key& key = *kind_of(*shape);
        if (key.name == "parts") return read_union(*shape, density, meshes, with_surfaces);
        const Part part = read_part(*shape, meshes, with_surfaces);
        const bool has_density = density_by(*shape) == DensityBy::shape;
        Solid whole{solid(has_density ? 1 : density, part.weighted),
                    true,
                    part.outline,
                    part.surfaces,
                    {},
                    part.moments.volume};
        if (has_density) whole.outline = about(whole.properties.center_of_mass, part);
        const Primitive* p = find_primitive(key.name);
        if (p == nullptr || has_density) return whole;
        whole.properties = p->make(density, *shape);
        whole.has_own_origin = false;
        return whole;
    } catch (const InputError& error) {
        Complaint complaint = error.complaint();
        if (complaint.path.empty()) complaint.path = "body.shape";
        throw InputError(complaint);
    }
}

}   // namespace livens
