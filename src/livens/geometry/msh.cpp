// SPDX-License-Identifier: BSD-3-Clause
// Gmsh's MSH, versions 2.2 and 4.1, ASCII and binary [Gmsh manual, File formats].
// Physical names become regions; the elements that are read are those with shape functions in elements.cpp.
// All counts are held against the bytes left before anything is reserved.
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>

#include "livens/geometry/detail/cursor.h"

namespace livens::inline geometry_internal {

namespace {

struct GmshKind {
    int type, n_nodes, dimension;
    int kind;   ///< of ElementKind; -1: points and lines, which bound nothing
};
constexpr GmshKind gmsh_kinds[] = {{1, 2, 1, -1},  {8, 3, 1, -1}, {26, 4, 1, -1}, {27, 5, 1, -1},
                                   {15, 1, 0, -1}, {2, 3, 2, 0},  {3, 4, 2, 1},   {9, 6, 2, 2},
                                   {4, 4, 3, 3},   {5, 8, 3, 4},  {11, 10, 3, 5}};

/// Tags of nodes to indices. Most files count from one number on; for these there is no table.
class NodeTags {
public:
    /// False if the tag has been there.
    bool add(std::int64_t tag)
    {
        if (n_ == 0) first_ = tag;
        if (table_.empty() && tag == first_ + n_) return ++n_, true;
        if (table_.empty())
            for (std::int32_t i = 0; i < n_; ++i) table_.emplace(first_ + i, i);
        return table_.emplace(tag, n_++).second;
    }
    std::int32_t find(std::int64_t tag) const
    {
        if (table_.empty())
            return tag >= first_ && tag - first_ < n_ ? static_cast<std::int32_t>(tag - first_) : -1;
        const auto found = table_.find(tag);
        return found == table_.end() ? -1 : found->second;
    }

private:
    std::int64_t first_ = 0;
    std::int32_t n_ = 0;
    std::unordered_map<std::int64_t, std::int32_t> table_;
};

class MshReader {
public:
    MshReader(std::string_view bytes, Mesh& mesh) : cursor_(bytes, mesh.name), builder_(mesh), mesh_(mesh) {}

    void read()
    {
        read_format();
        while (!cursor_.is_at_end()) {
            const std::string_view section = cursor_.word();
            if (!section.starts_with('$') || section.size() > 100)
                cursor_.fail("a section, '$Name', is expected");
            const std::string end = "$End" + std::string(section.substr(1));
            if (section == "$PhysicalNames")
                read_names();
            else if (section == "$Entities" && is_new_)
                read_entities();
            else if (section == "$Nodes")
                is_new_ ? read_new_nodes() : read_old_nodes();
            else if (section == "$Elements")
                is_new_ ? read_new_elements() : read_old_elements();
            else if (section == "$PartitionedEntities")
                cursor_.fail("a partitioned mesh is not read; save it unpartitioned");
            else {
                // Sections that say nothing of the shape are passed over, so that files of newer programs are
                // read as well.
                cursor_.skip_behind(end);
                continue;
            }
            cursor_.expect(end);
        }
    }

private:
    void read_format()
    {
        cursor_.expect("$MeshFormat");
        const std::string_view version = cursor_.word();
        is_new_ = version == "4.1";
        if (!is_new_ && version != "2.2" && version != "2" && version != "2.1")
            cursor_.fail("MSH 2.2 and 4.1 are read, not this version; gmsh -save -format msh41 writes it");
        is_text_ = cursor_.integer(0, 1, "the type of file") == 0;
        cursor_.integer(8, 8, "the size of numbers");
        mesh_.format = std::string("MSH ") + (is_new_ ? "4.1" : "2.2") + (is_text_ ? ", ASCII" : ", binary");
        if (!is_text_) {
            cursor_.line();
            // Binary files begin with the number 1, by which the order of bytes is told.
            const auto one = cursor_.raw<std::int32_t>(false);
            is_swapped_ = one == 0x01000000;
            if (one != 1 && !is_swapped_) cursor_.fail("the number that tells the order of bytes is not 1");
            cursor_.go_binary();
        }
        cursor_.expect("$EndMeshFormat");
    }

    // Numbers of either kind of file.
    double real()
    {
        return is_text_ ? cursor_.number("a number") : checked(cursor_.raw<double>(is_swapped_));
    }
    double checked(double x) const
    {
        if (!std::isfinite(x)) cursor_.fail("a number is not finite");
        return x;
    }
    std::int64_t number(std::int64_t low, std::int64_t high, const char* what)   // int
    {
        return is_text_ ? cursor_.integer(low, high, what)
                        : within(cursor_.raw<std::int32_t>(is_swapped_), low, high, what);
    }
    std::int64_t large(std::int64_t low, std::int64_t high, const char* what)   // size_t
    {
        return is_text_ ? cursor_.integer(low, high, what)
                        : within(cursor_.raw<std::int64_t>(is_swapped_), low, high, what);
    }
    std::int64_t within(std::int64_t x, std::int64_t low, std::int64_t high, const char* what) const
    {
        if (x < low || x > high)
            cursor_.fail(std::string(what) + " is " + std::to_string(x) + ", not " + std::to_string(low) +
                         " to " + std::to_string(high));
        return x;
    }
    /// Of things that take at least so many numbers each.
    std::int64_t count(std::int64_t n, int numbers_each, int bytes_each, const char* what) const
    {
        // In a text a number takes at least a digit and a blank, but for the last one.
        const int least = is_text_ ? std::max(1, 2 * numbers_each - 1) : bytes_each;
        cursor_.require(n, least, what);
        return n;
    }
    /// A binary section begins behind the line of its name.
    void begin()
    {
        if (!is_text_) cursor_.line();
    }
    Vector3 point()
    {
        Vector3 p;
        for (int i = 0; i < 3; ++i) p[i] = real();
        return p;
    }

    void read_names()   // a text in binary files, too
    {
        const std::int64_t n = cursor_.integer(0, 1'000'000, "the number of names");
        for (std::int64_t i = 0; i < n; ++i) {
            const int dimension = static_cast<int>(cursor_.integer(0, 3, "a dimension"));
            const std::int64_t tag = cursor_.integer(INT32_MIN, INT32_MAX, "a physical tag");
            const std::string_view name = cursor_.line();
            if (name.size() < 2 || name.front() != '"' || name.back() != '"')
                cursor_.fail("a name in quotes is expected");
            names_[{dimension, tag}] = std::string(name.substr(1, name.size() - 2));
        }
    }

    std::string physical_name(int dimension, std::int64_t tag) const
    {
        const auto found = names_.find({dimension, tag});
        return found != names_.end() ? found->second : std::to_string(tag);
    }

    // 4.1

    void read_entities()
    {
        begin();
        std::array<std::int64_t, 4> n;
        for (int d = 0; d < 4; ++d) n[d] = large(0, INT32_MAX, "the number of entities");
        for (int d = 0; d < 4; ++d) {
            count(n[d], d == 0 ? 5 : 8, d == 0 ? 36 : 60, "entities");
            for (std::int64_t i = 0; i < n[d]; ++i) read_entity(d);
        }
    }

    void read_entity(int dimension)
    {
        const std::int64_t tag = number(INT32_MIN, INT32_MAX, "the tag of an entity");
        point();
        if (dimension > 0) point();   // a box around it
        const std::int64_t n = count(large(0, INT32_MAX, "a number of tags"), 1, 4, "physical tags");
        Region region{dimension, {}};
        for (std::int64_t i = 0; i < n; ++i) {
            const std::int64_t physical = number(INT32_MIN, INT32_MAX, "a physical tag");
            // A negative physical tag reverses the orientation only, which the elements say themselves.
            region.names.push_back(physical_name(dimension, std::abs(physical)));
        }
        if (dimension > 0)
            for (std::int64_t k = count(large(0, INT32_MAX, "a number of tags"), 1, 4, "bounding entities");
                 k > 0; --k)
                number(INT32_MIN, INT32_MAX, "a tag");
        entities_[{dimension, tag}] = std::move(region);
    }

    /// That of an entity; entities with the same names are one region.
    std::int32_t region_of(int dimension, std::int64_t tag)
    {
        const auto [known, is_new] = regions_.try_emplace({dimension, tag}, 0);
        if (!is_new) return known->second;
        const auto entity = entities_.find({dimension, tag});
        const std::vector<std::string> names =
            entity == entities_.end() ? std::vector<std::string>{} : entity->second.names;
        return known->second = builder_.region(dimension, names);
    }

    void add_point(std::int64_t tag, const Vector3& p)
    {
        if (!tags_.add(tag)) cursor_.fail("node " + std::to_string(tag) + " is given twice");
        mesh_.points.push_back(p);
    }

    void read_new_nodes()
    {
        begin();
        const std::int64_t n_blocks = large(0, INT32_MAX, "the number of blocks");
        const std::int64_t n = large(0, INT32_MAX, "the number of nodes");
        count(n, 4, 32, "nodes");
        mesh_.points.reserve(mesh_.points.size() + n);
        large(0, INT64_MAX, "the smallest tag");
        large(0, INT64_MAX, "the largest tag");
        count(n_blocks, 4, 20, "blocks of nodes");
        std::vector<std::int64_t> tags;
        for (std::int64_t b = 0; b < n_blocks; ++b) {
            const int dimension = static_cast<int>(number(0, 3, "a dimension"));
            number(INT32_MIN, INT32_MAX, "the tag of an entity");
            const int n_parameters = number(0, 1, "the word on parameters") == 1 ? dimension : 0;
            tags.resize(count(large(0, INT32_MAX, "the number of nodes"), 4, 32, "nodes"));
            for (std::int64_t& tag : tags) tag = large(1, INT64_MAX, "the tag of a node");
            for (const std::int64_t tag : tags) {
                add_point(tag, point());
                for (int k = 0; k < n_parameters; ++k) real();
            }
        }
        if (static_cast<std::int64_t>(mesh_.points.size()) != n)
            cursor_.fail("the blocks have another number of nodes than their head");
    }

    void read_new_elements()
    {
        begin();
        const std::int64_t n_blocks = large(0, INT32_MAX, "the number of blocks");
        const std::int64_t n = large(0, INT32_MAX, "the number of elements");
        count(n, 2, 16, "elements");
        large(0, INT64_MAX, "the smallest tag");
        large(0, INT64_MAX, "the largest tag");
        count(n_blocks, 4, 20, "blocks of elements");
        std::int64_t n_read = 0;
        for (std::int64_t b = 0; b < n_blocks; ++b) {
            const int dimension = static_cast<int>(number(0, 3, "a dimension"));
            const std::int64_t entity = number(INT32_MIN, INT32_MAX, "the tag of an entity");
            const GmshKind& kind = kind_of(number(0, INT32_MAX, "the type of elements"));
            if (kind.dimension != dimension) cursor_.fail("elements of another dimension than their entity");
            const std::int64_t n_here = count(large(0, INT32_MAX, "the number of elements"), 1 + kind.n_nodes,
                                              8 * (1 + kind.n_nodes), "elements");
            const std::int32_t region = kind.kind < 0 ? 0 : region_of(dimension, entity);
            for (std::int64_t e = 0; e < n_here; ++e) {
                large(1, INT64_MAX, "the tag of an element");
                add_element(kind, region, [&] { return large(1, INT64_MAX, "the tag of a node"); });
            }
            n_read += n_here;
        }
        // A count that disagrees is a sign of a truncated or edited file.
        if (n_read != n) cursor_.fail("the blocks have another number of elements than their head");
    }

    const GmshKind& kind_of(std::int64_t type) const
    {
        for (const GmshKind& kind : gmsh_kinds)
            if (kind.type == type) return kind;
        cursor_.fail(
            "elements of type " + std::to_string(type) +
            " are not read; tetrahedra with 4 or 10 nodes, hexahedra with 8, triangles with 3 or 6 and "
            "quadrilaterals with 4 are");
    }

    template <class Next>
    void add_element(const GmshKind& kind, std::int32_t region, Next next_tag)
    {
        std::array<std::int32_t, 10> nodes;
        for (int k = 0; k < kind.n_nodes; ++k) {
            const std::int64_t tag = next_tag();
            nodes[k] = tags_.find(tag);
            if (nodes[k] < 0)
                cursor_.fail("an element has node " + std::to_string(tag) + ", which is not there");
        }
        if (kind.kind >= 0) builder_.add(static_cast<ElementKind>(kind.kind), nodes.data(), region);
    }

    // 2.2

    void read_old_nodes()
    {
        const std::int64_t n = cursor_.integer(0, INT32_MAX, "the number of nodes");
        begin();
        count(n, 4, 28, "nodes");
        mesh_.points.reserve(mesh_.points.size() + n);
        for (std::int64_t i = 0; i < n; ++i) {
            const std::int64_t tag = number(1, INT32_MAX, "the tag of a node");
            add_point(tag, point());
        }
    }

    void read_old_elements()
    {
        const std::int64_t n = cursor_.integer(0, INT32_MAX, "the number of elements");
        begin();
        count(n, 3, 8, "elements");
        for (std::int64_t e = 0; e < n;) {
            std::int64_t n_here = 1, n_tags = 0;
            if (is_text_) number(1, INT32_MAX, "the tag of an element");
            const GmshKind& kind = kind_of(number(0, INT32_MAX, "the type of an element"));
            if (!is_text_)
                n_here = within(number(1, INT32_MAX, "the number of elements"), 1, n - e,
                                "the number of elements");
            n_tags = number(0, 1000, "the number of tags");
            for (std::int64_t k = 0; k < n_here; ++k) {
                // In binary files of version 2 the head is shared by a run of elements, and each has its own
                // tag.
                if (!is_text_) number(1, INT32_MAX, "the tag of an element");
                read_old_element(kind, n_tags);
            }
            e += n_here;
        }
    }

    void read_old_element(const GmshKind& kind, std::int64_t n_tags)
    {
        std::int64_t physical = 0;
        for (std::int64_t t = 0; t < n_tags; ++t) {
            const std::int64_t tag = number(INT32_MIN, INT32_MAX, "a tag of an element");
            if (t == 0) physical = std::abs(tag);
        }
        std::int32_t region = 0;
        if (kind.kind >= 0) {
            const auto [known, is_new] = regions_.try_emplace({kind.dimension, physical}, 0);
            if (is_new)
                known->second = builder_.region(kind.dimension,
                                                physical == 0 ? "" : physical_name(kind.dimension, physical));
            region = known->second;
        }
        add_element(kind, region, [&] { return number(1, INT32_MAX, "the tag of a node"); });
    }

    using Key = std::pair<int, std::int64_t>;   // dimension, tag

    Cursor cursor_;
    MeshBuilder builder_;
    Mesh& mesh_;
    bool is_new_ = true, is_text_ = true, is_swapped_ = false;
    std::map<Key, std::string> names_;
    std::map<Key, Region> entities_;
    std::map<Key, std::int32_t> regions_;
    NodeTags tags_;
};

}   // namespace

void read_msh(std::string_view bytes, Mesh& mesh) { MshReader(bytes, mesh).read(); }

}   // namespace livens::inline geometry_internal
