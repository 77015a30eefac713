// SPDX-License-Identifier: BSD-3-Clause
#include "livens/io/scenario/shapes.h"

#include <algorithm>
#include <cmath>

#include "livens/base/text.h"
#include "livens/io/scenario/primitives.h"
#include "livens/io/scenario/units.h"

namespace livens {

namespace {

/// Of the mesh's numbers, m.
double unit_of(const Section& shape)
{
    return (shape.has("scale") ? shape.number("scale") : 1) * unit_of_length(shape.text("unit"));
}

std::vector<Key> mesh_keys(bool is_part)
{
    std::vector<Key> keys{
        {"mesh", types::text,
         "A file of the solid: STL, OBJ or PLY (its closed surface), Gmsh's MSH (elements of volume, or a "
         "closed "
         "surface); a path from the scenario's folder on, which it does not leave. Its coordinates are those "
         "of the body."},
        {"unit", types::text, "Of the mesh's numbers, a length such as `\"mm\"`; a mesh needs it."},
        Key{"scale", types::number, "The mesh is made so many times larger.", "", "1"}.within(positive),
        {"turn", types::flag,
         "Faces of the mesh that look inwards, and elements that are inside out, are turned instead of "
         "refused."}};
    if (!is_part)
        keys.push_back(
            {"density_field", types::text,
             "The mesh's density in kg/m^3 as an expression in `x`, `y` and `z`, the place in m in the "
             "mesh's "
             "axes after `unit` and `scale`: `\"2000 + 300*z\"`; instead of `density` and `mass`. Any "
             "expression for a mesh with elements of volume, a linear one for a surface."});
    if (!is_part)
        keys.push_back(
            {"densities", types::named_texts,
             "Of the mesh's regions of volume by their names in the file, each a text with a unit: "
             "`{ steel = \"7850 kg/m^3\" }`; all of them, instead of `density` and `mass`."});
    return keys;
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

bool check_mesh(const Section& shape)
{
    if (!shape.has("mesh"))
        return shape.refuse({"unit", "scale", "turn", "density_field", "densities"}, "shape",
                            "the shape is no mesh");
    if (!shape.has("unit"))
        return shape.error(
            "mesh", "mesh-unit", shape.label() + " has a mesh without 'unit'",
            {"files of meshes do not say what their numbers mean", "add unit = \"mm\", or \"m\""});
    if (shape.takes("densities") && !shape.at_most_one({"density_field", "densities"}, "mass-conflict"))
        return false;
    if (unit_of_length(shape.text("unit")) > 0) return true;
    return shape.error("unit", "mesh-unit",
                       "'unit' of " + shape.label() + " must be a unit of length, not \"" +
                           shape.text("unit") + "\"");
}

/// A solid in its own coordinates, by its moments at density 1.
struct Part {
    Moments moments;
    Outline outline;
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
    outline.points = mesh.points;
    outline.triangles = mesh.triangles;
    outline.stretch = {unit, unit, unit};
    return outline;
}

Part read_part(const Section& shape, MeshStore& meshes)
{
    const Key& key = *kind_of(shape);
    if (key.name == "mesh") {
        const ReducedMesh& mesh = meshes.find(shape.text("mesh"), shape.has("turn"));
        return {scaled(mesh.whole, unit_of(shape)), outline_of(mesh, unit_of(shape)),
                surfaces_of(mesh, unit_of(shape))};
    }
    const Primitive& p = *find_primitive(key.name);
    return {moments(p.make(1, shape)), p.outline(shape)};
}

Solid read_union(const Section& shape, double density, MeshStore& meshes)
{
    std::vector<Moments> parts;
    std::vector<double> densities;
    Solid solid;
    solid.has_own_origin = true;
    for (const Section& section : shape.sections("parts")) {
        Part part = read_part(section, meshes);
        const Matrix3 axes = read_orientation(section);
        parts.push_back(moved(part.moments, axes, section.vector("position")));
        densities.push_back(section.number("density"));
        solid.volume += std::copysign(parts.back().volume, densities.back());
        if (densities.back() < 0) continue;   // a picture cannot take away, and a hole has another surface
        add_surfaces(solid.surfaces, part, section.has("name") ? section.text("name") : "", axes,
                     section.vector("position"));
        part.outline.axes = axes;
        part.outline.place = parts.back().centroid;
        solid.outline.parts.push_back(std::move(part.outline));
    }
    double mass = 0, size = 0;
    for (std::size_t k = 0; k < parts.size(); ++k) {
        mass += densities[k] * parts[k].volume;
        size += std::abs(densities[k]) * parts[k].volume;
    }
    if (!(mass > 1e-12 * size))
        throw InputError({"shape", "body.shape", "the parts leave no mass", to_text(mass), "> 0",
                          "parts with a negative density are holes in others", ""});
    const Moments whole = combined(parts, densities);
    solid.properties = livens::solid(density, whole);
    for (Outline& part : solid.outline.parts) part.place -= whole.centroid;
    return solid;
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
        const Quantity density = parse_quantity(value.texts[i], "kg/m^3");
        if (!density.error.empty() || !(density.value > 0))
            throw InputError({"unit", "body.shape",
                              "the density of '" + entries[i].key + "' cannot be \"" + value.texts[i] + "\"" +
                                  (density.error.empty() ? "" : ": " + density.error),
                              "", "> 0 kg/m^3", "", density.help});
        bool is_found = false;
        for (std::size_t r = 0; r < mesh.regions.size(); ++r)
            if (mesh.regions[r].first == entries[i].key) densities[r] = density.value, is_found = true;
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

Table shape_table()
{
    Table part{
        "parts of shape",
        "Solids that are united, each with exactly one of the shapes. They must not overlap, but for holes.",
        {}};
    for (const Primitive& p : primitives()) part.keys.push_back(p.key);
    for (const Key& key : mesh_keys(true)) part.keys.push_back(key);
    part.keys.push_back(
        {"name", types::text,
         "Of the part: loads find the whole surface of its mesh by that, and a surface of it as "
         "`name/surface`."});
    part.keys.push_back(
        {"position", types::vector3, "Of the part's origin in body coordinates.", "m", "[0, 0, 0]"});
    for (const Key& key : orientation_keys()) part.keys.push_back(key);
    part.keys.push_back({"density", types::number,
                         "Relative to that of the body; -1 for holes in parts of density 1.", "", "1"});
    Table shape{"shape of [[body]]",
                "Exactly one of the shapes. Axes of revolution lie along d3. Primitives have their origin at "
                "their centre of mass.",
                {}};
    for (const Primitive& p : primitives()) shape.keys.push_back(p.key);
    shape.keys.push_back(
        Key{"point", types::flag, "A point mass: no orientation, no inertia; needs `mass`."});
    for (const Key& key : mesh_keys(false)) shape.keys.push_back(key);
    shape.keys.push_back(Key{"parts", types::tables, "A union of shapes."}.holding(part));
    return shape;
}

bool is_point_mass(const Section& body)
{
    const Section* shape = only_section(body, "shape");
    return shape != nullptr && shape->has("point");
}

bool check_shape(const Section& shape)
{
    const Key* kind = kind_of(shape);
    if (kind == nullptr || !shape.is_valid() || !check_mesh(shape)) return false;
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

Solid read_shape(const Section& body, MeshStore& meshes)
{
    const Section* shape = only_section(body, "shape");
    if (shape == nullptr || is_point_mass(body)) return {};
    const double density = body.has("density") ? body.number("density") : 1;
    try {
        const Key& key = *kind_of(*shape);
        if (key.name == "parts") return read_union(*shape, density, meshes);
        if (const Primitive* p = find_primitive(key.name))
            return {p->make(density, *shape), false, p->outline(*shape), {}, p->make(1, *shape).mass};
        const ReducedMesh& mesh = meshes.find(shape->text("mesh"), shape->has("turn"));
        const double unit = unit_of(*shape);
        MassProperties properties = solid(density, scaled(mesh.whole, unit));
        if (shape->has("densities")) properties = solid(1, weighted(*shape, mesh, unit));
        if (shape->has("density_field"))
            properties = solid(1, meshes.weighted(shape->text("mesh"), shape->has("turn"), unit,
                                                  shape->text("density_field")));
        return {properties, true, outline_of(mesh, unit), surfaces_of(mesh, unit),
                scaled(mesh.whole, unit).volume};
    } catch (const InputError& error) {
        Complaint complaint = error.complaint();
        if (complaint.path.empty()) complaint.path = "body.shape";
        throw InputError(complaint);
    }
}

}   // namespace livens
