// SPDX-License-Identifier: BSD-3-Clause
// Collada 1.4 and 1.5: geometries are lists of numbers with indices into them, a scene is a tree of nodes
// that place them [Khronos, COLLADA 1.4.1 specification]. The scene is walked; all of a stranger's counts,
// indices, references and depths are held against what is there.
#include "livens/io/scenario/bodies/collada.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "livens/base/error.h"
#include "livens/io/scenario/text/xml.h"
#include "livens/multibody/body.h"

namespace livens::inline io_internal {

namespace {

constexpr int deepest = 100;                         // of nodes that instantiate each other
constexpr std::size_t most_triangles = 10'000'000;   // of all instances
constexpr std::size_t most_visits = 1'000'000;       // of nodes, with or without faces

/// x -> A x + b.
struct Place {
    Matrix3 A = identity<3>();
    Vector3 b{};

    Place of(const Place& inner) const { return {A * inner.A, A * inner.b + b}; }
};

/// Where a primitive keeps its corners' indices among those of all its inputs.
struct Layout {
    int stride = 0, of_vertex = -1;
    const std::vector<Vector3>* points = nullptr;
};

class ColladaReader {
public:
    ColladaReader(const XmlElement& root, Mesh& mesh) : root_(root), mesh_(mesh)
    {
        collect(root);
        mesh_.regions.push_back({});
        mesh_.blocks.push_back({ElementKind::triangle, {}, {}});
    }

    void read()
    {
        const Place unit{unit_of_file() * identity<3>(), {}};
        const XmlElement* scene = child(root_, "scene");
        const XmlElement* instance = scene != nullptr ? child(*scene, "instance_visual_scene") : nullptr;
        if (instance != nullptr) return add_nodes(referred(*instance), unit, 0);
        for (const auto& [id, element] : known_)
            if (element->name == "geometry") add_geometry(*element, unit);
    }

private:
    [[noreturn]] void fail(const XmlElement& at, const std::string& why) const
    {
        throw InputError({"mesh-format", "",
                          mesh_.name + ", line " + std::to_string(at.place.line) + ": " + why, "", "", "",
                          ""});
    }

    void collect(const XmlElement& element)
    {
        if (const std::string* id = element.find("id")) known_.try_emplace(*id, &element);
        for (const XmlElement& inner : element.children) collect(inner);
    }

    static const XmlElement* child(const XmlElement& of, std::string_view name)
    {
        for (const XmlElement& one : of.children)
            if (one.name == name) return &one;
        return nullptr;
    }
    const XmlElement& needed(const XmlElement& of, std::string_view name) const
    {
        const XmlElement* found = child(of, name);
        if (found == nullptr) fail(of, "<" + of.name + "> has no <" + std::string(name) + ">");
        return *found;
    }
    const std::string& needed_attribute(const XmlElement& of, std::string_view name) const
    {
        const std::string* found = of.find(name);
        if (found == nullptr) fail(of, "<" + of.name + "> has no attribute '" + std::string(name) + "'");
        return *found;
    }
    /// By `url` or `source`. Other files are not opened.
    const XmlElement& referred(const XmlElement& of, std::string_view attribute = "url") const
    {
        const std::string& url = needed_attribute(of, attribute);
        const auto found = url.starts_with('#') ? known_.find(url.substr(1)) : known_.end();
        if (found == known_.end())
            fail(of, "it refers to '" + url.substr(0, 60) + "', which is not in the file");
        return *found->second;
    }

    double unit_of_file() const
    {
        const XmlElement* asset = child(root_, "asset");
        const XmlElement* unit = asset != nullptr ? child(*asset, "unit") : nullptr;
        const std::string* metres = unit != nullptr ? unit->find("meter") : nullptr;
        if (metres == nullptr) return 1;
        const std::vector<double> number = numbers<double>(*metres, *unit);
        if (number.size() != 1 || !(number[0] > 0)) fail(*unit, "its unit is no length");
        return number[0];
    }

    /// Of a text, with blanks between them.
    template <class Number>
    std::vector<Number> numbers(const std::string& text, const XmlElement& at) const
    {
        std::vector<Number> all;
        const char *here = text.data(), *const end = here + text.size();
        while (true) {
            while (here != end && (*here == ' ' || *here == '\n' || *here == '\t' || *here == '\r')) ++here;
            if (here == end) return all;
            if (*here == '+') ++here;   // which people write and from_chars does not know
            Number x{};
            const auto [rest, error] = std::from_chars(here, end, x);
            if (error != std::errc{} || !std::isfinite(static_cast<double>(x)))
                fail(at, "this is no number: '" +
                             std::string(here, std::min<std::ptrdiff_t>(end - here, 20)) + "'");
            here = rest;
            all.push_back(x);
        }
    }
    int count(const XmlElement& of, const char* attribute, int otherwise, int least) const
    {
        const std::string* text = of.find(attribute);
        if (text == nullptr) return otherwise;
        const std::vector<int> number = numbers<int>(*text, of);
        if (number.size() != 1 || number[0] < least || number[0] > 1000)
            fail(of, std::string("its ") + attribute + " is wrong");
        return number[0];
    }

    std::vector<double> read_transform(const XmlElement& element, std::size_t n) const
    {
        std::vector<double> x = numbers<double>(element.text, element);
        if (x.size() != n) fail(element, "<" + element.name + "> needs " + std::to_string(n) + " numbers");
        return x;
    }
    /// Transformations of a node apply one after the other, the last first.
    Place place_of(const XmlElement& node) const
    {
        Place place;
        for (const XmlElement& one : node.children) {
            Place next;
            if (one.name == "matrix") {
                const std::vector<double> m = read_transform(one, 16);
                for (int i = 0; i < 3; ++i) {
                    for (int j = 0; j < 3; ++j) next.A(i, j) = m[static_cast<std::size_t>(4 * i + j)];
                    next.b[i] = m[static_cast<std::size_t>(4 * i + 3)];
                }
            } else if (one.name == "translate") {
                const std::vector<double> v = read_transform(one, 3);
                next.b = {v[0], v[1], v[2]};
            } else if (one.name == "scale") {
                const std::vector<double> v = read_transform(one, 3);
                for (int i = 0; i < 3; ++i) next.A(i, i) = v[static_cast<std::size_t>(i)];
            } else if (one.name == "rotate") {
                const std::vector<double> v = read_transform(one, 4);
                const Vector3 axis{v[0], v[1], v[2]};
                const double size = norm(axis);
                if (size > 0)
                    next.A = directors_from_rotation_vector(v[3] * std::numbers::pi / 180 / size * axis);
            } else if (one.name == "lookat" || one.name == "skew") {
                fail(one, "<" + one.name + "> is not read");
            } else {
                continue;
            }
            place = place.of(next);
        }
        return place;
    }

    /// Of a scene or a node.
    void add_nodes(const XmlElement& parent, const Place& place, int depth)
    {
        if (depth > deepest) fail(parent, "nodes refer to each other without end");
        if (++visits_ > most_visits) fail(parent, "the scene has too many nodes");
        for (const XmlElement& one : parent.children) {
            if (one.name == "node") add_nodes(one, place.of(place_of(one)), depth + 1);
            if (one.name == "instance_node") {
                const XmlElement& node = referred(one);
                add_nodes(node, place.of(place_of(node)), depth + 1);
            }
            if (one.name == "instance_geometry") add_geometry(referred(one), place);
        }
    }

    void add_geometry(const XmlElement& geometry, const Place& place)
    {
        const XmlElement* mesh = child(geometry, "mesh");
        if (mesh == nullptr) return;   // splines, convex meshes
        first_points_.clear();
        for (const XmlElement& one : mesh->children) {
            if (one.name == "triangles" || one.name == "polylist" || one.name == "polygons" ||
                one.name == "trifans" || one.name == "tristrips")
                add_faces(one, layout_of(one), place);
        }
    }

    /// Numbers of <vertices>' POSITION, read once.
    const std::vector<Vector3>& points_of(const XmlElement& vertices)
    {
        const auto known = points_.find(&vertices);
        if (known != points_.end()) return known->second;
        const XmlElement* position = nullptr;
        for (const XmlElement& input : vertices.children)
            if (const std::string* meaning = input.find("semantic");
                meaning != nullptr && *meaning == "POSITION")
                position = &input;
        if (position == nullptr) fail(vertices, "no input is called POSITION");
        const XmlElement& source = referred(*position, "source");
        const XmlElement& list = needed(source, "float_array");
        const XmlElement* technique = child(source, "technique_common");
        const XmlElement* accessor = technique != nullptr ? child(*technique, "accessor") : nullptr;
        const auto stride =
            static_cast<std::size_t>(accessor != nullptr ? count(*accessor, "stride", 3, 3) : 3);
        const std::vector<double> x = numbers<double>(list.text, list);
        std::vector<Vector3>& points = points_[&vertices];
        for (std::size_t i = 0; i + 2 < x.size(); i += stride) points.push_back({x[i], x[i + 1], x[i + 2]});
        return points;
    }

    Layout layout_of(const XmlElement& faces)
    {
        Layout layout;
        for (const XmlElement& input : faces.children) {
            if (input.name != "input") continue;
            const int offset = count(input, "offset", 0, 0);
            layout.stride = std::max(layout.stride, offset + 1);
            if (needed_attribute(input, "semantic") != "VERTEX") continue;
            layout.of_vertex = offset;
            layout.points = &points_of(referred(input, "source"));
        }
        if (layout.points == nullptr) fail(faces, "no input is called VERTEX");
        return layout;
    }

    /// One polygon, fan or strip after the other, each as long as <vcount> or its own <p> says.
    void add_faces(const XmlElement& faces, const Layout& layout, const Place& place)
    {
        const auto stride = static_cast<std::size_t>(layout.stride);
        const XmlElement* lengths = child(faces, "vcount");
        std::vector<int> sizes;
        if (lengths != nullptr) sizes = numbers<int>(lengths->text, *lengths);
        for (const XmlElement& list : faces.children) {
            if (list.name == "ph") fail(list, "polygons with holes are not read");
            if (list.name != "p") continue;
            const std::vector<int> all = numbers<int>(list.text, list);
            if (all.size() % stride != 0) fail(list, "it ends within a corner");
            std::vector<std::int32_t> corners;
            for (std::size_t i = 0; i < all.size(); i += stride)
                corners.push_back(
                    corner(list, layout, all[i + static_cast<std::size_t>(layout.of_vertex)], place));
            if (faces.name == "triangles") sizes.assign(corners.size() / 3, 3);
            if (faces.name != "triangles" && faces.name != "polylist")
                sizes = {static_cast<int>(corners.size())};
            std::size_t first = 0;
            for (const int size : sizes) {
                if (size < 0 || static_cast<std::size_t>(size) > corners.size() - first)
                    fail(list, "it has fewer corners than its faces");
                add_polygon(faces, {corners.data() + first, static_cast<std::size_t>(size)});
                first += static_cast<std::size_t>(size);
            }
        }
    }

    /// The index of a point of this geometry, where this instance of it has it.
    std::int32_t corner(const XmlElement& at, const Layout& layout, int index, const Place& place)
    {
        if (index < 0 || static_cast<std::size_t>(index) >= layout.points->size())
            fail(at, "there is no point " + std::to_string(index));
        auto [first, is_new] =
            first_points_.try_emplace(layout.points, static_cast<std::int32_t>(mesh_.points.size()));
        if (is_new) {
            if (mesh_.points.size() + layout.points->size() > 3 * most_triangles) fail(at, too_many);
            for (const Vector3& x : *layout.points) {
                mesh_.points.push_back(place.A * x + place.b);
                if (!std::isfinite(norm(mesh_.points.back())))
                    fail(at, "its points are too far away to compute with");
            }
        }
        return first->second + index;
    }

    void add_polygon(const XmlElement& faces, std::span<const std::int32_t> corners)
    {
        ElementBlock& block = mesh_.blocks.front();
        for (std::size_t i = 2; i < corners.size(); ++i) {
            if (block.regions.size() >= most_triangles) fail(faces, too_many);
            // Every second triangle of a strip faces the other way.
            const bool is_strip = faces.name == "tristrips";
            const std::int32_t a = is_strip ? corners[i - (i % 2 == 0 ? 2 : 1)] : corners[0],
                               b = is_strip && i % 2 == 1 ? corners[i - 2] : corners[i - 1];
            for (const std::int32_t of : {a, b, corners[i]}) block.nodes.push_back(of);
            block.regions.push_back(0);
        }
    }

    static constexpr const char* too_many = "the scene has more than 10 million triangles";

    const XmlElement& root_;
    Mesh& mesh_;
    std::map<std::string, const XmlElement*> known_;   ///< by id
    std::map<const XmlElement*, std::vector<Vector3>> points_;
    std::map<const std::vector<Vector3>*, std::int32_t> first_points_;   ///< of this instance
    std::size_t visits_ = 0;
};

}   // namespace

bool is_collada(const std::string& name)
{
    constexpr std::string_view ending = ".dae";
    return name.size() > ending.size() &&
           std::ranges::equal(name.substr(name.size() - ending.size()), ending,
                              [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; });
}

Mesh read_collada(std::string_view bytes, const std::string& name)
{
    Findings findings;
    const std::optional<XmlElement> root = parse_xml(bytes, findings);
    Mesh mesh;
    mesh.name = name;
    mesh.format = "Collada";
    if (!root) {
        const Diagnostic first = findings.take(name).front();
        throw InputError({"mesh-format", "",
                          name + ", line " + std::to_string(first.line) + ": " + first.message, "", "", "",
                          first.help});
    }
    if (root->name != "COLLADA")
        throw InputError({"mesh-format", "",
                          name + ": its first element is <" + root->name + ">, not <COLLADA>", "", "", "",
                          ""});
    ColladaReader(*root, mesh).read();
    return mesh;
}

}   // namespace livens::inline io_internal
