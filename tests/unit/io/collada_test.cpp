// SPDX-License-Identifier: BSD-3-Clause
// Faces of Collada files: where the scene has them, and what is refused of strangers' files.
#include "livens/io/scenario/bodies/collada.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "livens/base/error.h"

namespace livens::collada_test {

namespace {

using io_internal::read_collada;

const std::string corners =
    "<source id='x'><float_array id='n' count='12'>0 0 0  1 0 0  1 1 0  0 1 0</float_array><technique_common>"
    "<accessor source='#n' count='4' stride='3'/></technique_common></source>"
    "<vertices id='v'><input semantic='POSITION' source='#x'/></vertices>";
const std::string two_triangles =
    "<triangles count='2'><input semantic='VERTEX' source='#v' offset='0'/><p>0 1 2 0 2 3</p></triangles>";

std::string geometry(const std::string& faces)
{
    return "<library_geometries><geometry id='g'><mesh>" + corners + faces +
           "</mesh></geometry></library_geometries>";
}
std::string file(const std::string& inside)
{
    return "<?xml version='1.0'?>\n<COLLADA version='1.4.1'>" + inside + "</COLLADA>";
}
/// The square of two triangles, seen through nodes.
std::string scene(const std::string& nodes, const std::string& faces = two_triangles)
{
    return file(geometry(faces) + "<library_visual_scenes><visual_scene id='s'>" + nodes +
                "</visual_scene></library_visual_scenes><scene><instance_visual_scene url='#s'/></scene>");
}

Mesh read(const std::string& text) { return read_collada(text, "a.dae"); }

/// Corner k of triangle e.
Vector3 corner(const Mesh& mesh, std::size_t e, std::size_t k)
{
    return mesh.points[static_cast<std::size_t>(mesh.blocks.front().nodes[3 * e + k])];
}
/// Twice the vector area of all triangles.
Vector3 area(const Mesh& mesh)
{
    Vector3 sum{};
    for (std::size_t e = 0; e < mesh.blocks.front().regions.size(); ++e)
        sum += cross(corner(mesh, e, 1) - corner(mesh, e, 0), corner(mesh, e, 2) - corner(mesh, e, 0));
    return sum;
}

TEST(Collada, ReadsFacesOfEveryKind)
{
    const std::string input = "<input semantic='VERTEX' source='#v' offset='0'/>";
    const std::string with_normals = "<input semantic='NORMAL' source='#x' offset='0'/>"
                                     "<input semantic='VERTEX' source='#v' offset='1'/>";
    for (const std::string& faces :
         {two_triangles, "<polylist count='1'>" + input + "<vcount>4</vcount><p>0 1 2 3</p></polylist>",
          "<polylist count='2'>" + input + "<vcount>3 3</vcount><p>0 1 2 0 2 3</p></polylist>",
          "<polygons count='1'>" + input + "<p>0 1 2 3</p></polygons>",
          "<polygons count='2'>" + input + "<p>0 1 2</p><p>0 2 3</p></polygons>",
          "<trifans count='1'>" + input + "<p>0 1 2 3</p></trifans>",
          "<tristrips count='1'>" + input + "<p>0 1 3 2</p></tristrips>",
          "<triangles count='2'>" + with_normals + "<p>3 0 3 1 3 2 3 0 3 2 3 3</p></triangles>",
          "<lines count='1'>" + input + "<p>0 1</p></lines>" + two_triangles}) {
        const Mesh mesh = read(scene("<node><instance_geometry url='#g'/></node>", faces));
        EXPECT_EQ(mesh.n_elements(2), 2) << faces;
        EXPECT_EQ(norm(area(mesh) - Vector3{0, 0, 2}), 0) << faces;
    }
    EXPECT_EQ(read(file(geometry(two_triangles))).n_elements(2), 2) << "without a scene all geometries";
}

TEST(Collada, PlacesFacesByNodesInMetres)
{
    const auto expect = [](const std::string& text, const Vector3& first, const Vector3& second) {
        const Mesh mesh = read(text);
        ASSERT_GT(mesh.n_elements(2), 0) << text;
        EXPECT_LE(norm(corner(mesh, 0, 0) - first), 1e-15) << text;
        EXPECT_LE(norm(corner(mesh, 0, 1) - second), 1e-15) << text;
    };
    const std::string instance = "<instance_geometry url='#g'/>";
    expect(scene("<node><translate>1 2 3</translate>" + instance + "</node>"), {1, 2, 3}, {2, 2, 3});
    // The last of a node's transformations applies first.
    expect(scene("<node><translate>1 2 3</translate><rotate>0 0 2 90</rotate><scale>2 1 1</scale>" +
                 instance + "</node>"),
           {1, 2, 3}, {1, 4, 3});
    expect(scene("<node><matrix>0 -1 0 5  1 0 0 6  0 0 1 7  0 0 0 1</matrix>" + instance + "</node>"),
           {5, 6, 7}, {5, 7, 7});
    expect(
        scene("<node><scale>3 3 3</scale><node><translate>1 0 0</translate>" + instance + "</node></node>"),
        {3, 0, 0}, {6, 0, 0});
    const std::string inches = scene("<node>" + instance + "</node>");
    const std::size_t at = inches.find("<library_geometries>");
    expect(inches.substr(0, at) + "<asset><unit name='inch' meter='0.0254'/><up_axis>Y_UP</up_axis></asset>" +
               inches.substr(at),
           {0, 0, 0}, {0.0254, 0, 0});
    const std::string twice =
        "<library_nodes><node id='n2'><translate>0 0 1</translate>" + instance + "</node></library_nodes>";
    const std::string two = scene(
        "<node><translate>4 0 0</translate><instance_node url='#n2'/></node><node>" + instance + "</node>");
    const std::string both = two.substr(0, at) + twice + two.substr(at);
    expect(both, {4, 0, 1}, {5, 0, 1});
    EXPECT_EQ(read(both).n_elements(2), 4);
}

TEST(Collada, RefusesWhatItCannotReadWithTheLine)
{
    const std::string instance = "<node><instance_geometry url='#g'/></node>";
    const std::string input = "<input semantic='VERTEX' source='#v' offset='0'/>";
    const auto expect = [](const std::string& text, const std::string& words) {
        try {
            read(text);
            ADD_FAILURE() << text.substr(0, 300);
        } catch (const InputError& error) {
            EXPECT_EQ(error.complaint().code, "mesh-format");
            EXPECT_NE(error.complaint().message.find(words), std::string::npos) << error.complaint().message;
            EXPECT_NE(error.complaint().message.find("a.dae"), std::string::npos);
        }
    };
    const auto faces = [&](const std::string& p) {
        return scene(instance, "\n\n<triangles count='1'>" + input + p + "</triangles>");
    };
    expect(faces("<p>0 1 4</p>"), "line 4: there is no point 4");
    expect(faces("<p>0 -1 2</p>"), "no point -1");
    expect(faces("<p>0 x 2</p>"), "no number");
    expect(
        scene(
            instance,
            "<triangles count='1'><input semantic='VERTEX' source='#v' offset='1'/><p>0 1 2</p></triangles>"),
        "within a corner");
    expect(scene(instance, "<triangles count='1'><p>0 1 2</p></triangles>"), "VERTEX");
    expect(scene(instance, "<polylist count='1'>" + input + "<vcount>5</vcount><p>0 1 2 3</p></polylist>"),
           "fewer corners");
    expect(scene(instance, "<polylist count='1'>" + input + "<vcount>-1</vcount><p>0 1 2 3</p></polylist>"),
           "fewer");
    expect(scene(instance, "<polygons count='1'>" + input + "<ph><p>0 1 2</p><h>3 1 2</h></ph></polygons>"),
           "holes");
    expect(scene("<node><instance_geometry url='#nobody'/></node>"), "#nobody");
    expect(scene("<node><instance_geometry url='other.dae#g'/></node>"), "not in the file");
    expect(scene("<node><matrix>1 2 3</matrix></node>"), "16 numbers");
    expect(scene("<node><skew>1 1 1 1 1 1 1</skew></node>"), "<skew>");
    expect(scene("<node id='a'><instance_node url='#a'/></node>"), "without end");
    // Each node has two of the next one: 2^40 without a bound.
    std::string nodes;
    for (int i = 0; i < 40; ++i) {
        const std::string next = "<instance_node url='#k" + std::to_string(i + 1) + "'/>";
        nodes += "<node id='k" + std::to_string(i) + "'>" + next + next + "</node>";
    }
    expect(scene(nodes + "<node id='k40'/>"), "too many nodes");
    expect("<!DOCTYPE a><COLLADA/>", "document types");
    expect("<COLLADA><a></COLLADA>", "line 1");
    expect("<robot/>", "not <COLLADA>");
    const std::string bad_unit = scene(instance);
    const std::size_t at = bad_unit.find("<library_geometries>");
    expect(bad_unit.substr(0, at) + "<asset><unit meter='0'/></asset>" + bad_unit.substr(at), "no length");
}

}   // namespace

}   // namespace livens::collada_test
