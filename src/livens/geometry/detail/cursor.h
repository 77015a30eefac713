// SPDX-License-Identifier: BSD-3-Clause
// A place in the bytes of a file: words and numbers of texts, raw numbers of binary files.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "livens/geometry/mesh.h"

namespace livens::inline geometry_internal {

/// From its bytes, in the order of this machine or turned round.
template <class Number>
Number number_at(const char* bytes, bool is_swapped)
{
    char buffer[sizeof(Number)];
    std::memcpy(buffer, bytes, sizeof buffer);
    if (is_swapped) std::reverse(std::begin(buffer), std::end(buffer));
    return std::bit_cast<Number>(buffer);
}

class Cursor {
public:
    Cursor(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(&name) {}

    /// What is read from here on is no text: places are bytes, no lines.
    void go_binary() { is_binary_ = true; }
    std::uint64_t left() const { return bytes_.size() - at_; }
    /// Nothing but blanks follows.
    bool is_at_end();
    /// Throws InputError `mesh-format` with the place of what was read last.
    [[noreturn]] void fail(const std::string& message) const;

    /// Up to a blank; empty at the end.
    std::string_view word();
    /// What is left of the line, without the blanks around it.
    std::string_view line();
    bool is_at_line_end();
    /// Throws unless the next word is this.
    void expect(std::string_view what);
    /// A finite number.
    double number(const char* what) { return to_number(word(), what); }
    std::int64_t integer(std::int64_t low, std::int64_t high, const char* what)
    {
        return to_integer(word(), low, high, what);
    }
    double to_number(std::string_view text, const char* what) const;
    std::int64_t to_integer(std::string_view text, std::int64_t low, std::int64_t high,
                            const char* what) const;

    /// Throws unless there is room for `count` things of at least so many bytes each.
    void require(std::uint64_t count, std::uint64_t bytes_each, const char* what) const;
    /// What is not read yet.
    std::string_view ahead() const { return bytes_.substr(at_); }
    void skip(std::size_t n_bytes) { start_ = at_, at_ += n_bytes; }
    template <class Number>
    Number raw(bool is_swapped)
    {
        if (left() < sizeof(Number)) require(1, sizeof(Number), "numbers");
        skip(sizeof(Number));
        return number_at<Number>(bytes_.data() + start_, is_swapped);
    }
    std::string_view raw_bytes(std::uint64_t n);
    /// Moves behind the next occurrence of `what`; throws where there is none.
    void skip_behind(std::string_view what);

private:
    void skip_blanks();

    std::string_view bytes_;
    const std::string* name_;
    std::size_t at_ = 0;
    std::size_t start_ = 0;   ///< of what was read last
    bool is_binary_ = false;
};

/// Adds elements to the block of their kind, which is made if it is missing.
class MeshBuilder {
public:
    explicit MeshBuilder(Mesh& mesh) : mesh_(mesh) {}

    ElementBlock& block(ElementKind kind);
    void add(ElementKind kind, const std::int32_t* nodes, std::int32_t region);
    /// Of that dimension and name; an empty one has no name.
    std::int32_t region(int dimension, const std::string& name);
    std::int32_t region(int dimension, const std::vector<std::string>& names);
    /// A polygon as triangles around its first corner. It must be flat to 1e-6 of its size, else it is not
    /// known which surface is meant. Throws by `cursor`.
    void add_polygon(const std::vector<std::int32_t>& corners, std::int32_t region, const Cursor& cursor);

private:
    Mesh& mesh_;
    std::map<std::pair<int, std::vector<std::string>>, std::int32_t> regions_;
};

void read_stl(std::string_view bytes, Mesh& mesh);
void read_obj(std::string_view bytes, Mesh& mesh);
void read_ply(std::string_view bytes, Mesh& mesh);
void read_msh(std::string_view bytes, Mesh& mesh);

}   // namespace livens::inline geometry_internal
