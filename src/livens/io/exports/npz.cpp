// SPDX-License-Identifier: BSD-3-Clause
// NumPy archives: a zip of arrays, stored. [NumPy, NEP 1; PKWARE, APPNOTE 6.3.9]
// All variables of the result as arrays of one name each; units in an array beside them. Entries are stored
// and without date, so the same run gives the same bytes: docs/results.md.
#include <algorithm>
#include <cstdint>
#include <string_view>

#include <zlib.h>

#include "livens/io/exports/formats.h"
#include "livens/io/json.h"
#include "livens/io/results/atomic_file.h"
#include "livens/io/results/classic_netcdf.h"

namespace livens::inline io_internal {

namespace {

std::uint32_t checksum(std::string_view bytes)
{
    const auto* data = reinterpret_cast<const Bytef*>(bytes.data());
    return static_cast<std::uint32_t>(::crc32_z(0, data, bytes.size()));
}

/// Entries are stored as they are, with the first day that the format knows as their date: same input, same
/// bytes. Sizes and places are written with 64 bits where they need them, as `extra` fields.
class Zip {
public:
    Zip(const std::filesystem::path& file, std::uint64_t narrow) : out_(file), narrow_(narrow) {}

    void add(const std::string& name, const std::string& bytes)
    {
        const std::uint32_t crc = checksum(bytes);
        const std::uint64_t begin = end_, size = bytes.size();
        const bool is_wide = size >= narrow_;
        std::string extra;
        if (is_wide) extra = wide_field({size, size});
        std::string head;
        put(head, std::uint32_t{0x04034b50});
        put_entry(head, crc, size, name, extra);
        append(head + name + extra);
        append(bytes);

        std::vector<std::uint64_t> wide;
        if (is_wide) wide = {size, size};
        if (begin >= narrow_) wide.push_back(begin);
        extra = wide.empty() ? "" : wide_field(wide);
        put(directory_, std::uint32_t{0x02014b50});
        put(directory_, version);   // that made it
        put_entry(directory_, crc, size, name, extra);
        directory_.append(2 + 2 + 2 + 4, '\0');   // comment, disk, attributes
        put(directory_, clipped(begin));
        directory_ += name + extra;
        ++n_;
    }

    void commit()
    {
        const std::uint64_t begin = end_, size = directory_.size();
        append(directory_);
        std::string tail;
        if (begin >= narrow_ || n_ >= 0xffff) {
            put(tail, std::uint32_t{0x06064b50});
            put(tail, std::uint64_t{44});
            put(tail, version);
            put(tail, version);
            put(tail, std::uint64_t{0});   // disks
            for (const std::uint64_t x : {n_, n_, size, begin}) put(tail, x);
            put(tail, std::uint32_t{0x07064b50});
            put(tail, std::uint32_t{0});
            put(tail, begin + size);
            put(tail, std::uint32_t{1});
        }
        put(tail, std::uint32_t{0x06054b50});
        put(tail, std::uint32_t{0});
        for (int i = 0; i < 2; ++i)
            put(tail, static_cast<std::uint16_t>(std::min<std::uint64_t>(n_, 0xffff)));
        put(tail, clipped(size));
        put(tail, clipped(begin));
        put(tail, std::uint16_t{0});
        append(tail);
        out_.commit();
    }

private:
    static constexpr std::uint16_t version = 45;   // of the format, for 64 bits

    /// All ones, where the number stands elsewhere.
    std::uint32_t clipped(std::uint64_t x) const
    {
        return x >= narrow_ ? ~std::uint32_t{0} : static_cast<std::uint32_t>(x);
    }
    static std::string wide_field(const std::vector<std::uint64_t>& values)
    {
        std::string field;
        put(field, std::uint16_t{1});
        put(field, static_cast<std::uint16_t>(8 * values.size()));
        for (const std::uint64_t x : values) put(field, x);
        return field;
    }
    /// What stands alike before an entry and in the directory.
    void put_entry(std::string& out, std::uint32_t crc, std::uint64_t size, const std::string& name,
                   const std::string& extra) const
    {
        put(out, version);
        put(out, std::uint16_t{0x800});        // names are UTF-8
        put(out, std::uint16_t{0});            // stored
        put(out, std::uint32_t{0x00210000});   // 1980-01-01
        put(out, crc);
        put(out, clipped(size));
        put(out, clipped(size));
        put(out, static_cast<std::uint16_t>(name.size()));
        put(out, static_cast<std::uint16_t>(extra.size()));
    }
    void append(std::string_view bytes)
    {
        out_.write(end_, bytes);
        end_ += bytes.size();
    }

    AtomicFile out_;
    std::uint64_t narrow_, end_ = 0, n_ = 0;
    std::string directory_;
};

/// Head of an array in C order; what follows begins at a multiple of 64 bytes.
std::string array_head(const std::string& type, const std::vector<std::uint64_t>& shape)
{
    std::string text = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (";
    for (const std::uint64_t n : shape) text += std::to_string(n) + ", ";
    text += "), }";
    constexpr std::size_t before = 10;
    text.append(63 - (before + text.size()) % 64, ' ');
    text += '\n';
    std::string head("\x93NUMPY\1\0", 8);
    put(head, static_cast<std::uint16_t>(text.size()));
    return head + text;
}

std::u32string code_points(std::string_view text)
{
    std::u32string out;
    while (!text.empty()) {
        const int n = utf8_length(text);
        constexpr unsigned char masks[] = {0, 0x7f, 0x1f, 0x0f, 0x07};
        char32_t c = n == 0 ? 0xfffd : static_cast<unsigned char>(text[0]) & masks[n];
        for (int i = 1; i < n; ++i) c = c << 6 | (static_cast<unsigned char>(text[i]) & 0x3f);
        out += c;
        text.remove_prefix(static_cast<std::size_t>(std::max(n, 1)));
    }
    return out;
}

/// Texts of one length, filled up with zeros, which NumPy takes away again.
std::string array_of(const std::vector<std::string>& texts, const std::vector<std::uint64_t>& shape)
{
    std::vector<std::u32string> all;
    std::size_t width = 1;
    for (const std::string& text : texts) width = std::max(width, all.emplace_back(code_points(text)).size());
    std::string bytes = array_head("<U" + std::to_string(width), shape);
    for (std::u32string& text : all) {
        text.resize(width);
        for (const char32_t c : text) put(bytes, static_cast<std::uint32_t>(c));
    }
    return bytes;
}

template <class Number>
std::string array_of(const ClassicReader& file, const ClassicVariable& v, const char* type,
                     const std::vector<std::uint64_t>& shape)
{
    std::vector<Number> values(v.n_values);
    file.read(v, std::span<Number>(values));
    std::string bytes = array_head(type, shape);
    bytes.reserve(bytes.size() + values.size() * sizeof(Number));
    for (const Number x : values) put(bytes, x);
    return bytes;
}

/// A variable of text is one of its rows each, along the last dimension.
std::string array_of(const ClassicReader& file, const ClassicVariable& v)
{
    std::vector<std::uint64_t> shape;
    for (const std::string& dimension : v.dimensions) shape.push_back(file.dimension(dimension));
    switch (v.type) {
    case NumberType::real:
        return array_of<double>(file, v, "<f8", shape);
    case NumberType::integer:
        return array_of<int>(file, v, "<i4", shape);
    case NumberType::byte:
        return array_head("|i1", shape) + file.bytes(v);
    case NumberType::text:
        break;
    }
    const std::string bytes = file.bytes(v);
    const std::size_t width = shape.back();   // see is_own()
    shape.pop_back();
    std::vector<std::string> rows;
    for (std::size_t i = 0; i < bytes.size(); i += width) {
        const std::string row = bytes.substr(i, width);
        rows.push_back(row.substr(0, row.find_last_not_of('\0') + 1));
    }
    return array_of(rows, shape);
}

/// As livens writes them: what others may have added to a file is left out, as are names that a zip would
/// take for folders.
bool is_own(const ClassicVariable& v)
{
    const auto is_letter = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    };
    const bool is_known = v.type == NumberType::real || v.type == NumberType::integer ||
                          v.type == NumberType::byte || (v.type == NumberType::text && !v.dimensions.empty());
    return is_known && std::ranges::all_of(v.name, is_letter);
}

}   // namespace

void write_npz(const std::filesystem::path& path, const ExportInput& input, std::uint64_t narrow)
{
    const InputFile in(input.result);
    const ClassicReader file(
        {in.size(), [&](std::uint64_t offset, std::span<char> out) { in.read(offset, out); }});
    Zip zip(path, narrow);
    std::vector<std::string> names, units;
    for (const ClassicVariable& v : file.variables()) {
        if (!is_own(v)) continue;
        zip.add(v.name + ".npy", array_of(file, v));
        const AttributeValue* unit = find_attribute(v.attributes, "units");
        const std::string* text = unit == nullptr ? nullptr : std::get_if<std::string>(unit);
        names.push_back(v.name);
        units.push_back(text == nullptr ? "" : *text);
    }
    zip.add("variable.npy", array_of(names, {names.size()}));
    zip.add("unit.npy", array_of(units, {units.size()}));
    zip.commit();
}

}   // namespace livens::inline io_internal
