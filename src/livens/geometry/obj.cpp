// SPDX-License-Identifier: BSD-3-Clause
// Wavefront OBJ: points and faces, with objects and groups as regions.
// Polygons are divided into triangles if they are flat (mesh.cpp); what bears on colour and light is passed
// over. Other statements are refused instead of ignored: a spline or a patch would be missing in the solid.
#include <set>

#include "livens/geometry/detail/cursor.h"

namespace livens::inline geometry_internal {

namespace {

/// What says nothing of the shape.
const std::set<std::string_view> ignored{"vn",       "vt",     "vp",     "s",         "mtllib", "usemtl",
                                         "l",        "p",      "mg",     "lod",       "bevel",  "c_interp",
                                         "d_interp", "maplib", "usemap", "shadow_obj"};

class ObjReader {
public:
    ObjReader(std::string_view bytes, Mesh& mesh) : cursor_(bytes, mesh.name), builder_(mesh), mesh_(mesh) {}

    void read()
    {
        mesh_.format = "OBJ";
        while (!cursor_.is_at_end()) {
            const std::string_view word = cursor_.word();
            if (word == "v")
                read_point();
            else if (word == "f")
                read_face();
            else if (word == "g" || word == "o")
                read_name(word == "o");
            else if (word.starts_with('#') || ignored.count(word) > 0)
                skip_line();
            else
                cursor_.fail("only points and flat faces are read, not the keyword '" + printable(word) +
                             "'");
        }
    }

private:
    static std::string printable(std::string_view word)
    {
        std::string text(word.substr(0, 20));
        for (char& c : text) c = c >= ' ' && c <= '~' ? c : '?';
        return text;
    }
    /// A line that ends in a backslash goes on.
    void skip_line()
    {
        while (cursor_.line().ends_with('\\')) {
        }
    }
    bool is_statement_end()
    {
        while (!cursor_.is_at_line_end()) {
            Cursor ahead = cursor_;
            if (ahead.word() != "\\") return false;
            cursor_ = ahead;
            cursor_.line();
        }
        return true;
    }

    void read_point()
    {
        Vector3 p;
        for (int i = 0; i < 3; ++i) {
            if (cursor_.is_at_line_end()) cursor_.fail("a point has three coordinates");
            p[i] = cursor_.number("a coordinate");
        }
        skip_line();   // a weight or a colour
        mesh_.points.push_back(p);
    }

    void read_name(bool is_object)
    {
        (is_object ? object_ : group_) = std::string(cursor_.line());
        if (is_object) group_.clear();
        region_ = -1;
    }

    void read_face()
    {
        corners_.clear();
        while (!is_statement_end()) {
            std::string_view word = cursor_.word();
            word = word.substr(0, word.find('/'));   // behind it: texture and normal
            const auto n = static_cast<std::int64_t>(mesh_.points.size());
            std::int64_t i = cursor_.to_integer(word, -n, n, "the index of a point");
            if (i == 0) cursor_.fail("indices of points count from 1");
            // Negative indices count back from the point that was read last.
            i = i < 0 ? n + i : i - 1;
            corners_.push_back(static_cast<std::int32_t>(i));
        }
        if (corners_.size() < 3) cursor_.fail("a face has at least three corners");
        if (region_ < 0)
            region_ = builder_.region(2, object_.empty() || group_.empty() ? object_ + group_
                                                                           : object_ + "/" + group_);
        builder_.add_polygon(corners_, region_, cursor_);
    }

    Cursor cursor_;
    MeshBuilder builder_;
    Mesh& mesh_;
    std::string object_, group_;
    std::int32_t region_ = -1;
    std::vector<std::int32_t> corners_;
};

}   // namespace

void read_obj(std::string_view bytes, Mesh& mesh) { ObjReader(bytes, mesh).read(); }

}   // namespace livens::inline geometry_internal
