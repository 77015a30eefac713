// SPDX-License-Identifier: BSD-3-Clause
// Files: what each format states, and what is refused of it.
#include <fstream>
#include <iterator>
#include <random>

#include "unit/geometry/shapes.h"

namespace livens::readers_test {

namespace {

using namespace test;

struct File {
    std::string name, bytes;
};

std::string ply_of(const Mesh& mesh, const std::string& format)
{
    const ElementBlock& b = mesh.blocks[0];
    std::string s =
        "ply\nformat " + format + " 1.0\ncomment made here\nelement vertex " +
        std::to_string(mesh.points.size()) +
        "\nproperty double x\nproperty float quality\nproperty double y\nproperty double z\nelement face " +
        std::to_string(b.size()) +
        "\nproperty list uchar int vertex_indices\nproperty uchar red\nelement edge 1\nproperty short "
        "a\nend_header\n";
    const bool is_text = format == "ascii", is_big = format == "binary_big_endian";
    const auto value = [&](auto x) {
        if (is_text)
            s += std::to_string(x) + " ";
        else
            put(s, x, is_big);
    };
    for (const Vector3& p : mesh.points) value(p[0]), value(1.5f), value(p[1]), value(p[2]);
    for (std::int64_t e = 0; e < b.size(); ++e) {
        value(std::uint8_t{3});
        for (int k = 0; k < 3; ++k) value(b.element(e)[k]);
        value(std::uint8_t{7});
    }
    value(std::int16_t{3});
    return s;
}

std::string text_stl_of(const Mesh& mesh)
{
    std::string s = "solid a part\n";
    const ElementBlock& b = mesh.blocks[0];
    for (std::int64_t e = 0; e < b.size(); ++e) {
        s += " facet normal 0 0 nan\n  outer loop\n";
        for (int k = 0; k < 3; ++k) {
            s += "   vertex";
            for (int i = 0; i < 3; ++i) s += " " + std::to_string(mesh.points[b.element(e)[k]][i]);
            s += "\r\n";
        }
        s += "  endloop\n endfacet\n";
    }
    return s + "endsolid a part\n";
}

std::string obj_of(const Mesh& mesh)
{
    std::string s = "# a part\nmtllib a.mtl\no part\nvn 0 0 1\n";
    for (const Vector3& p : mesh.points)
        s += "v " + std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]) + "\n";
    s += "g sides\ns off\n";
    const ElementBlock& b = mesh.blocks[0];
    for (std::int64_t e = 0; e < b.size(); ++e) {
        const std::int32_t* n = b.element(e);
        const auto back = static_cast<std::int32_t>(mesh.points.size());
        s += "f " + std::to_string(n[0] + 1) + "//1 \\\n " + std::to_string(n[1] - back) + " " +
             std::to_string(n[2] + 1) + "/1\n";
    }
    return s;
}

const Vector3 edges{1, 2, 3};

std::vector<File> files_of_a_box()
{
    const Mesh box = box_surface({}, edges, 2);
    std::vector<File> files{{"a.stl", stl_of(box)}, {"b.STL", text_stl_of(box)}, {"c.obj", obj_of(box)}};
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"})
        files.push_back({std::string(format) + ".ply", ply_of(box, format)});
    return files;
}

std::vector<File> all_files()
{
    std::vector<File> files = files_of_a_box();
    for (const char* name : {"two_bricks_41.msh", "two_bricks_22.msh", "bracket_41_binary.msh"}) {
        std::ifstream stream(std::string(LIVENS_SOURCE_DIR "/tests/unit/geometry/data/") + name,
                             std::ios::binary);
        files.push_back({name, {std::istreambuf_iterator<char>(stream), {}}});
    }
    return files;
}

TEST(Readers, GiveTheSameBoxFromEveryFormat)
{
    for (const File& file : files_of_a_box()) {
        SCOPED_TRACE(file.name);
        const Mesh mesh = read_mesh(file.bytes, file.name);
        EXPECT_EQ(mesh.points.size(), 26u);
        EXPECT_EQ(mesh.n_elements(2), 48);
        EXPECT_TRUE(faults_of(mesh).empty());
        const Moments m = moments(mesh);
        EXPECT_NEAR(m.volume, 6, 1e-14);
        EXPECT_LE(norm(m.centroid - 0.5 * edges), 1e-15);
        EXPECT_NEAR(m.second(2, 2), 6 * 9 / 12., 1e-14);
    }
    EXPECT_EQ(read_mesh(files_of_a_box()[1].bytes, "b.stl").regions[0].names,
              std::vector<std::string>{"a part"});
    EXPECT_EQ(read_mesh(files_of_a_box()[2].bytes, "b.obj").regions[0].names,
              std::vector<std::string>{"part/sides"});
}

/// What is wrong with a text, as the reader says it.
std::string refusal(const std::string& bytes, const std::string& name)
{
    try {
        read_mesh(bytes, name);
    } catch (const InputError& error) {
        return error.complaint().code + " " + error.complaint().message;
    }
    return "";
}

TEST(Readers, SayWhereAFileIsWrong)
{
    EXPECT_EQ(refusal("v 0 0 0\nv 1 0 zero\n", "a.obj"),
              "mesh-format a.obj:2: a coordinate must be a finite number, not 'zero'");
    EXPECT_EQ(refusal("v 0 0 0\nv 1 0 0\nf 1 2 3\n", "a.obj"),
              "mesh-format a.obj:3: the index of a point is 3, not -2 to 2");
    EXPECT_EQ(refusal("v 0 0 1e999\n", "a.obj"),
              "mesh-format a.obj:1: a coordinate must be a finite number, not '1e999'");
    EXPECT_NE(refusal("v 0 0 0\nf 0 0 0\n", "a.obj").find("count from 1"), std::string::npos);
    EXPECT_NE(refusal("v 0 0 0\nv 1 0 0\nv 1 1 1\nv 0 1 0\nf 1 2 3 4\n", "a.obj").find("is not flat"),
              std::string::npos);
    EXPECT_NE(refusal("surf 0 1\n", "a.obj").find("'surf'"), std::string::npos);
    EXPECT_EQ(refusal("", "a.stl"), "mesh-file the mesh 'a.stl' is empty");
    EXPECT_NE(refusal("abc", "a.step").find("ends in none of"), std::string::npos);
    EXPECT_EQ(refusal("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n", "a.stl"),
              "mesh-format a.stl:5: a coordinate must be a finite number, not the end of the file");
    EXPECT_EQ(refusal("solid a\nendsolid\n", "a.stl"),
              "mesh-format a.stl: the file has no faces and no elements of volume");
    const std::string stl = stl_of(box_surface({}, edges));
    EXPECT_EQ(refusal(stl.substr(0, 200), "a.stl"),
              "mesh-format a.stl, byte 80: a binary STL of 12 triangles has 684 bytes, not 200");
    std::string infinite = stl;
    infinite.replace(84 + 12, 4, "\x00\x00\x80\x7f", 4);
    EXPECT_EQ(refusal(infinite, "a.stl"),
              "mesh-format a.stl, byte 96: a coordinate of triangle 1 is not finite");
    EXPECT_NE(
        refusal("$MeshFormat\n4.0 0 8\n$EndMeshFormat\n", "a.msh").find("a.msh:2: MSH 2.2 and 4.1 are read"),
        std::string::npos);
}

/// Counts are compared with what is there before anything is made of that size.
TEST(Readers, BelieveNoCount)
{
    const std::string ply =
        "ply\nformat binary_little_endian 1.0\nelement vertex 2000000000\nproperty double x\n"
        "property double y\nproperty double z\nend_header\n";
    EXPECT_NE(refusal(ply, "a.ply").find("the file ends before its vertex: 2000000000 of at least 24 bytes"),
              std::string::npos)
        << refusal(ply, "a.ply");
    EXPECT_NE(refusal("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2000000000\n1 0 0 0\n", "a.msh")
                  .find("ends before its nodes"),
              std::string::npos);
    EXPECT_NE(refusal("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 2000000000 1 9\n", "a.msh")
                  .find("ends before its nodes"),
              std::string::npos);
    const std::string nothing =
        "ply\nformat ascii 1.0\nelement ghost 2000000000\nend_header\n";   // takes no byte
    EXPECT_NE(refusal(nothing, "a.ply").find("no faces"), std::string::npos);
}

/// What holds for any bytes: they are refused, or make a mesh whose indices all exist.
void expect_answer(const std::string& bytes, const std::string& name)
{
    try {
        const Mesh mesh = read_mesh(bytes, name);
        for (const ElementBlock& b : mesh.blocks) {
            ASSERT_EQ(b.nodes.size(), b.regions.size() * static_cast<std::size_t>(n_nodes(b.kind)));
            for (const std::int32_t node : b.nodes)
                ASSERT_LT(static_cast<std::size_t>(node), mesh.points.size());
            for (const std::int32_t region : b.regions)
                ASSERT_LT(static_cast<std::size_t>(region), mesh.regions.size());
        }
        faults_of(mesh);
        moments(mesh);
    } catch (const InputError& error) {
        ASSERT_TRUE(error.complaint().code.starts_with("mesh-"));
    }
}

TEST(Readers, SurviveFilesThatEndAnywhere)
{
    for (const File& file : all_files()) {
        SCOPED_TRACE(file.name);
        const std::size_t step = file.bytes.size() > 10000 ? 97 : 1;
        for (std::size_t n = 0; n < file.bytes.size(); n += step)
            expect_answer(file.bytes.substr(0, n), file.name);
    }
}

TEST(Readers, SurviveDamage)
{
    std::mt19937 random(1);
    const auto below = [&](std::size_t n) {
        return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
    };
    const std::vector<File> files = all_files();
    for (int k = 0; k < 3000; ++k) {
        File file = files[below(files.size() - 1)];   // the last is large
        for (std::size_t n = 1 + below(3); n > 0; --n) {
            const std::size_t at = below(file.bytes.size());
            switch (below(4)) {
            case 0:
                file.bytes[at] = static_cast<char>(below(256));
                break;
            case 1:
                file.bytes.erase(at, 1 + below(8));
                break;
            case 2:
                file.bytes.insert(at, file.bytes.substr(below(file.bytes.size()), 1 + below(30)));
                break;
            default:
                file.bytes.replace(at, 4, "\xff\xff\xff\x7f", 4);
            }
        }
        SCOPED_TRACE("damage " + std::to_string(k) + " to " + file.name);
        expect_answer(file.bytes, file.name);
    }
}

TEST(Readers, SayWhatIsNoFile)
{
    EXPECT_THROW(read_mesh_file("no-such-file.stl"), InputError);
    EXPECT_THROW(read_mesh_file("."), InputError);
}

}   // namespace

}   // namespace livens::readers_test
