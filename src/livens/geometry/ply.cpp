// SPDX-License-Identifier: BSD-3-Clause
// PLY: elements with properties as its header lists them; vertices and faces count, all others are passed
// over.
// The header tells sizes and types; two fast ways for rows of one length and for plain triangles read what
// nearly all files have, with the same result as the general one.
#include <algorithm>
#include <array>
#include <cmath>

#include "livens/geometry/detail/cursor.h"
#include "livens/geometry/detail/workers.h"

namespace livens::inline geometry_internal {

namespace {

enum class Number { i8, u8, i16, u16, i32, u32, f32, f64 };
constexpr int sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
constexpr std::pair<std::string_view, Number> words[] = {
    {"char", Number::i8},   {"uchar", Number::u8},   {"short", Number::i16},   {"ushort", Number::u16},
    {"int", Number::i32},   {"uint", Number::u32},   {"float", Number::f32},   {"double", Number::f64},
    {"int8", Number::i8},   {"uint8", Number::u8},   {"int16", Number::i16},   {"uint16", Number::u16},
    {"int32", Number::i32}, {"uint32", Number::u32}, {"float32", Number::f32}, {"float64", Number::f64}};

struct Property {
    std::string_view name;
    Number type = Number::f32;
    bool is_list = false;
    Number count_type = Number::u8;
};
struct Rows {
    std::string_view name;
    std::int64_t count = 0;
    std::vector<Property> properties = {};

    int find(std::initializer_list<std::string_view> names) const
    {
        for (std::size_t i = 0; i < properties.size(); ++i)
            if (std::ranges::find(names, properties[i].name) != names.end()) return static_cast<int>(i);
        return -1;
    }
};

class PlyReader {
public:
    PlyReader(std::string_view bytes, Mesh& mesh) : cursor_(bytes, mesh.name), builder_(mesh), mesh_(mesh) {}

    void read()
    {
        read_header();
        builder_.region(2, "");
        for (const Rows& rows : rows_) {
            // Counts of the header are held against the bytes left before memory is reserved for them.
            if (rows.properties.empty()) continue;   // any number of them takes no byte
            cursor_.require(rows.count, least_bytes(rows), std::string(rows.name).c_str());
            if (rows.name == "vertex")
                read_vertices(rows);
            else if (rows.name == "face")
                read_faces(rows);
            else if (rows.name == "tristrips")
                cursor_.fail("strips of triangles are not read; export faces");
            else
                for (std::int64_t i = 0; i < rows.count; ++i)
                    for (const Property& p : rows.properties) skip(p);
        }
    }

private:
    void read_header()
    {
        cursor_.expect("ply");
        cursor_.expect("format");
        const std::string_view format = cursor_.word();
        is_text_ = format == "ascii";
        const bool is_big = format == "binary_big_endian";
        if (!is_text_ && !is_big && format != "binary_little_endian")
            cursor_.fail("an unknown format of PLY");
        // Numbers are swapped where file and machine order their bytes differently.
        is_swapped_ = is_big != (std::endian::native == std::endian::big);
        mesh_.format = is_text_ ? "PLY, ASCII" : is_big ? "PLY, binary, big endian" : "PLY, binary";
        cursor_.expect("1.0");
        while (true) {
            const std::string_view word = cursor_.word();
            if (word == "end_header") break;
            if (word == "comment" || word == "obj_info")
                cursor_.line();
            else if (word == "element")
                read_element();
            else if (word == "property")
                read_property();
            else
                cursor_.fail("the header has element, property, comment and end_header");
        }
        cursor_.line();
        if (!is_text_) cursor_.go_binary();
    }

    void read_element()
    {
        const std::string_view name = cursor_.word();
        for (const Rows& rows : rows_)
            if (rows.name == name) cursor_.fail("an element that occurs twice in the header");
        rows_.push_back({name, cursor_.integer(0, INT32_MAX, "the number of elements")});
    }

    Number type(std::string_view word)
    {
        for (const auto& [name, number] : words)
            if (name == word) return number;
        cursor_.fail("an unknown type of number");
    }

    void read_property()
    {
        if (rows_.empty()) cursor_.fail("a property without an element");
        Property p;
        std::string_view word = cursor_.word();
        if (word == "list") {
            p.is_list = true;
            p.count_type = type(cursor_.word());
            if (p.count_type == Number::f32 || p.count_type == Number::f64)
                cursor_.fail("the length of a list must be a whole number");
            word = cursor_.word();
        }
        p.type = type(word);
        p.name = cursor_.word();
        rows_.back().properties.push_back(p);
    }

    /// Of one row. In a text each value is a digit and a blank, but for the last.
    std::uint64_t least_bytes(const Rows& rows) const
    {
        std::uint64_t bytes = 0;
        for (const Property& p : rows.properties)
            bytes += sizes[static_cast<int>(p.is_list ? p.count_type : p.type)];
        return is_text_ ? std::max<std::uint64_t>(1, 2 * rows.properties.size() - 1) : bytes;
    }

    double value(Number type)
    {
        if (is_text_) return cursor_.number("a value");
        switch (type) {
        case Number::i8:
            return cursor_.raw<std::int8_t>(is_swapped_);
        case Number::u8:
            return cursor_.raw<std::uint8_t>(is_swapped_);
        case Number::i16:
            return cursor_.raw<std::int16_t>(is_swapped_);
        case Number::u16:
            return cursor_.raw<std::uint16_t>(is_swapped_);
        case Number::i32:
            return cursor_.raw<std::int32_t>(is_swapped_);
        case Number::u32:
            return cursor_.raw<std::uint32_t>(is_swapped_);
        case Number::f32:
            return cursor_.raw<float>(is_swapped_);
        default:
            return cursor_.raw<double>(is_swapped_);
        }
    }
    /// All whole numbers of PLY are doubles to the bit.
    std::int64_t whole(Number type, std::int64_t low, std::int64_t high, const char* what)
    {
        const double x = value(type);
        if (!(x >= static_cast<double>(low) && x <= static_cast<double>(high)) || x != std::floor(x))
            cursor_.fail(std::string(what) + " must be a whole number from " + std::to_string(low) + " to " +
                         std::to_string(high));
        return static_cast<std::int64_t>(x);
    }
    std::int64_t list_length(const Property& p)
    {
        const std::int64_t n = whole(p.count_type, 0, INT32_MAX, "the length of a list");
        cursor_.require(n, is_text_ ? 1 : sizes[static_cast<int>(p.type)], "list");
        return n;
    }
    void skip(const Property& p)
    {
        for (std::int64_t n = p.is_list ? list_length(p) : 1; n > 0; --n) value(p.type);
    }

    void read_vertices(const Rows& rows)
    {
        const std::array<int, 3> at{rows.find({"x"}), rows.find({"y"}), rows.find({"z"})};
        for (const int i : at)
            if (i < 0 || rows.properties[i].is_list) cursor_.fail("vertices need x, y and z");
        reserve(mesh_.points, rows.count);
        mesh_.points.resize(rows.count);
        if (read_plain_vertices(rows, at)) return;
        for (Vector3& point : mesh_.points)
            for (int i = 0; i < static_cast<int>(rows.properties.size()); ++i) {
                const auto axis = std::ranges::find(at, i);
                if (axis == at.end()) {
                    skip(rows.properties[i]);
                    continue;
                }
                const double x = value(rows.properties[i].type);
                if (!std::isfinite(x)) cursor_.fail("a coordinate is not finite");
                point[static_cast<int>(axis - at.begin())] = x;
            }
    }

    /// Rows of one length with coordinates of one type, as nearly all files have: false if these are none.
    bool read_plain_vertices(const Rows& rows, const std::array<int, 3>& at)
    {
        const Number type = rows.properties[at[0]].type;
        if (is_text_ || (type != Number::f32 && type != Number::f64)) return false;
        for (const int i : at)
            if (rows.properties[i].type != type) return false;
        std::array<std::size_t, 3> offsets{};
        std::size_t row = 0;
        for (int i = 0; i < static_cast<int>(rows.properties.size()); ++i) {
            if (rows.properties[i].is_list) return false;
            for (int k = 0; k < 3; ++k)
                if (at[k] == i) offsets[k] = row;
            row += sizes[static_cast<int>(rows.properties[i].type)];
        }
        type == Number::f32 ? read_rows<float>(row, offsets) : read_rows<double>(row, offsets);
        return true;
    }

    template <class Real>
    void read_rows(std::size_t row, const std::array<std::size_t, 3>& offsets)
    {
        const bool is_swapped = is_swapped_;
        for (Vector3& point : mesh_.points) {
            const char* bytes = cursor_.ahead().data();
            cursor_.skip(row);   // that all are there is known
            for (int k = 0; k < 3; ++k) {
                point[k] = number_at<Real>(bytes + offsets[k], is_swapped);
                if (!std::isfinite(point[k])) cursor_.fail("a coordinate is not finite");
            }
        }
    }

    void read_faces(const Rows& rows)
    {
        const int corners = rows.find({"vertex_indices", "vertex_index"});
        if (corners < 0 || !rows.properties[corners].is_list)
            cursor_.fail("faces need a list vertex_indices");
        // Indices are checked as they are read, which needs the number of points.
        if (mesh_.points.empty()) cursor_.fail("vertices must come before the faces");
        ElementBlock& block = builder_.block(ElementKind::triangle);
        reserve(block.nodes, 3 * static_cast<std::size_t>(rows.count));
        reserve(block.regions, rows.count);
        std::vector<std::int32_t> face;
        for (std::int64_t f = read_plain_triangles(rows, block); f < rows.count; ++f)
            for (int i = 0; i < static_cast<int>(rows.properties.size()); ++i)
                if (i == corners)
                    read_face(rows.properties[i], face);
                else
                    skip(rows.properties[i]);
    }

    /// Of faces that are nothing but a list, with a byte and whole numbers of four, the triangles that stand
    /// first, in most files all; their number.
    std::int64_t read_plain_triangles(const Rows& rows, ElementBlock& block)
    {
        const Property& p = rows.properties.front();
        // Scans have millions of plain triangles, which are read here without a call for each number.
        if (is_text_ || rows.properties.size() > 1 || p.count_type != Number::u8 ||
            (p.type != Number::i32 && p.type != Number::u32))
            return 0;
        // One byte that says 3, and three indices of four bytes.
        constexpr std::size_t bytes = 13;
        const std::string_view ahead = cursor_.ahead();
        const std::size_t n = std::min<std::size_t>(rows.count, ahead.size() / bytes);
        const auto n_points = static_cast<std::uint32_t>(mesh_.points.size());
        const bool is_swapped = is_swapped_;
        block.nodes.resize(3 * n);
        std::size_t f = 0;
        for (const char* at = ahead.data(); f < n && *at == 3; ++f, at += bytes) {
            bool is_there = true;
            for (int k = 0; k < 3; ++k) {
                const auto node = number_at<std::uint32_t>(at + 1 + 4 * k, is_swapped);
                is_there &= node < n_points;
                block.nodes[3 * f + k] = static_cast<std::int32_t>(node);
            }
            if (!is_there) break;   // what is wrong is said where it is read again
        }
        cursor_.skip(bytes * f);
        block.nodes.resize(3 * f);
        block.regions.resize(f, 0);
        return static_cast<std::int64_t>(f);
    }

    void read_face(const Property& p, std::vector<std::int32_t>& face)
    {
        const std::int64_t n = list_length(p);
        if (n < 3) cursor_.fail("a face has at least three corners");
        face.clear();
        const auto last = static_cast<std::int64_t>(mesh_.points.size()) - 1;
        for (std::int64_t k = 0; k < n; ++k)
            face.push_back(static_cast<std::int32_t>(whole(p.type, 0, last, "the index of a vertex")));
        builder_.add_polygon(face, 0, cursor_);
    }

    Cursor cursor_;
    MeshBuilder builder_;
    Mesh& mesh_;
    std::vector<Rows> rows_;
    bool is_text_ = true, is_swapped_ = false;
};

}   // namespace

void read_ply(std::string_view bytes, Mesh& mesh) { PlyReader(bytes, mesh).read(); }

}   // namespace livens::inline geometry_internal
