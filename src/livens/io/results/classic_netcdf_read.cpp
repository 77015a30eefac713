// SPDX-License-Identifier: BSD-3-Clause
// The reader of the classic NetCDF format.
// Nothing of a header is believed: counts are bounded by the file's size, offsets checked against overlap,
// names against repetition, before any memory is taken (docs/results.md).
#include <cassert>
#include <limits>

#include "livens/io/results.h"
#include "livens/io/results/classic_netcdf_bytes.h"

namespace livens {

namespace {

// A title may be as long as a scenario, 16 MiB; all else that livens writes into a header is small.
constexpr std::uint64_t largest_header = 17u << 20, most_entries = 1u << 12;
constexpr std::uint64_t longest_name = 256, most_dimensions = 8;   // names: as in the format's own library
constexpr std::string_view hdf5_magic = "\x89HDF\r\n\x1a\n";

[[noreturn]] void damaged(const std::string& what)
{
    throw IoError(what + ": the file is damaged or was edited", "io-damaged");
}

}   // namespace

/// Goes through the header and fetches its bytes in pieces, as they are needed.
class ClassicReader::Header {
public:
    explicit Header(const ByteSource& source) : source_(source) {}

    void set_version(int version)
    {
        count_size_ = version == 5 ? 8 : 4;
        offset_size_ = version == 1 ? 4 : 8;
        n_types_ = version == 5 ? 11 : 6;
    }
    /// The next so many bytes, and what fills them up to a multiple of 4; valid until the next call.
    std::string_view bytes(std::uint64_t n)
    {
        if (n > source_.size || padded(n) > source_.size - at_)
            throw IoError("the file ends within its header: it was cut off", "io-truncated");
        if (at_ + padded(n) > largest_header) damaged("its header is larger than 17 MiB");
        const std::size_t end = static_cast<std::size_t>(at_ + padded(n)), have = text_.size();
        if (end > have) {
            // Memory grows with what is read, not with what a count claims.
            text_.resize(std::min<std::uint64_t>(std::max(end, have + buffer_size), source_.size));
            source_.read(have, std::span(text_).subspan(have));
        }
        const std::string_view found = std::string_view(text_).substr(at_, n);
        at_ = end;
        return found;
    }
    std::uint64_t integer(std::size_t size)
    {
        std::uint64_t x = 0;
        for (const char c : bytes(size)) x = x << 8 | static_cast<unsigned char>(c);
        return x;
    }
    std::uint64_t count()
    {
        const std::uint64_t n = integer(count_size_);
        // Counts are signed in the format.
        if (n >> (8 * count_size_ - 1) != 0) damaged("a count in its header is negative");
        return n;
    }
    std::uint64_t offset() { return integer(offset_size_); }
    std::uint64_t type()
    {
        const std::uint64_t type = integer(4);
        if (type < 1 || type > n_types_) damaged("its header names a type of numbers that does not exist");
        return type;
    }
    std::string name()
    {
        const std::uint64_t n = count();
        if (n == 0 || n > longest_name) damaged("a name in its header is empty or longer than 256 bytes");
        return std::string(bytes(n));
    }
    /// How many entries follow.
    std::uint64_t list(std::uint64_t tag)
    {
        const std::uint64_t found = integer(4), n = count();
        if ((found != tag && (found != 0 || n != 0)) || n > most_entries)
            damaged("a list in its header has the wrong mark or too many entries");
        return n;
    }
    std::string text() const { return text_.substr(0, at_); }

private:
    const ByteSource& source_;
    std::string text_;
    std::size_t at_ = 0;
    std::size_t count_size_ = 4, offset_size_ = 8;
    std::uint64_t n_types_ = 6;
};

namespace {

/// Whatever is looked up by its name is the one that counts were taken from.
template <class Entry>
void require_unique(const std::vector<Entry>& entries, const char* kind)
{
    std::vector<std::string_view> names;
    for (const Entry& entry : entries) names.push_back(entry.name);
    std::ranges::sort(names);
    const auto twice = std::ranges::adjacent_find(names);
    if (twice != names.end())
        damaged("two " + std::string(kind) + " in its header have the name '" + std::string(*twice) + "'");
}

/// The version of the format, by the first four bytes.
int version_of(const ByteSource& source)
{
    if (source.size == 0) throw IoError("the file is empty", "io-truncated");
    std::string start(std::min<std::uint64_t>(8, source.size), '\0');
    source.read(0, start);
    if (start.starts_with("CDF") && start.size() >= 4 && (start[3] == 1 || start[3] == 2 || start[3] == 5))
        return start[3];
    if (std::string_view("CDF").starts_with(start) || start == "CDF")
        throw IoError("the file ends after " + std::to_string(start.size()) + " bytes", "io-truncated");
    const bool is_hdf5 = start == hdf5_magic;
    throw IoError(is_hdf5 ? "it is HDF5, perhaps NetCDF-4; runs of livens are classic NetCDF"
                          : "it is no NetCDF file",
                  "io-foreign");
}

}   // namespace

ClassicReader::ClassicReader(ByteSource source, bool verify) : source_(std::move(source)), verify_(verify)
{
    const int version = version_of(source_);
    Header header(source_);
    header.set_version(version);
    header.bytes(4);
    header.integer(version == 5 ? 8 : 4);   // the number of records, which may be "not known"
    for (std::uint64_t n = header.list(dimension_tag); n > 0; --n) {
        std::string name = header.name();
        dimensions_.push_back({std::move(name), header.count()});
    }
    require_unique(dimensions_, "dimensions");
    attributes_ = read_attributes(header);
    for (std::uint64_t n = header.list(variable_tag); n > 0; --n) read_variable(header);
    require_unique(variables_, "variables");
    header_ = header.text();
    std::uint64_t left = source_.size - header_.size();   // where variables share bytes, reading has no end
    for (const ClassicVariable& v : variables_) {
        if (v.begin < header_.size()) damaged("variable '" + v.name + "' begins within the header");
        // Variables that fit between header and end by the sum of their sizes bound the work of reading them
        // all.
        if (v.n_bytes > left) damaged("its variables lie upon each other");
        left -= v.n_bytes;
    }
}

std::vector<Attribute> ClassicReader::read_attributes(Header& header) const
{
    std::vector<Attribute> attributes;
    for (std::uint64_t n = header.list(attribute_tag); n > 0; --n) {
        Attribute attribute{header.name(), {}};
        const std::uint64_t type = header.type(), count = header.count();
        if (count > source_.size) damaged("attribute '" + attribute.name + "' is larger than the file");
        const std::string_view bytes = header.bytes(count * size_of(type));
        if (type == static_cast<std::uint64_t>(NumberType::text)) {
            attribute.value = std::string(bytes);
        } else if (type == static_cast<std::uint64_t>(NumberType::integer) && count == 1) {
            int value = 0;
            std::memcpy(&value, bytes.data(), sizeof value);
            attribute.value = static_cast<int>(big_endian(static_cast<std::uint32_t>(value)));
        } else if (type == static_cast<std::uint64_t>(NumberType::real) && count == 1) {
            std::uint64_t value = 0;
            std::memcpy(&value, bytes.data(), sizeof value);
            attribute.value = std::bit_cast<double>(big_endian(value));
        }
        attributes.push_back(std::move(attribute));
    }
    require_unique(attributes, "attributes");
    return attributes;
}

void ClassicReader::read_variable(Header& header)
{
    ClassicVariable v;
    v.name = header.name();
    const std::uint64_t rank = header.count();
    if (rank > most_dimensions) damaged("variable '" + v.name + "' has more than 8 dimensions");
    v.n_values = 1;
    for (std::uint64_t i = 0; i < rank; ++i) {
        const std::uint64_t id = header.count();
        if (id >= dimensions_.size())
            damaged("variable '" + v.name + "' has a dimension that does not exist");
        const std::uint64_t length = dimensions_[id].length;
        v.dimensions.push_back(dimensions_[id].name);
        // The product of dimensions may overflow; it is divided instead.
        if (length != 0 && v.n_values > std::numeric_limits<std::uint64_t>::max() / 16 / length)
            damaged("variable '" + v.name + "' is larger than any file");
        v.n_values *= length;
    }
    v.attributes = read_attributes(header);
    const std::uint64_t type = header.type();
    v.type = static_cast<NumberType>(type);
    v.n_bytes = padded(v.n_values * size_of(type));
    header.count();   // the size, which follows from the rest, where it fits into this field at all
    v.begin = header.offset();
    // also where there is nothing to read, as of records that other programs write
    if (v.n_bytes > source_.size || v.begin > source_.size - v.n_bytes)
        throw IoError("the file ends within variable '" + v.name + "': it was cut off", "io-truncated");
    variables_.push_back(std::move(v));
}

void ClassicReader::verify_header() const
{
    if (!verify_) return;
    // Only runs of this format have one; the version was checked before, since other files have none.
    const AttributeValue* stored = attribute(checksum_name);
    const std::string* text = stored == nullptr ? nullptr : std::get_if<std::string>(stored);
    if (text == nullptr || text->size() != no_checksum.size())
        damaged("the checksum of its header is missing");
    std::string without = header_;
    const std::size_t name = without.find(checksum_name);
    const std::size_t place = name == std::string::npos ? name : without.find(*text, name);
    if (place == std::string::npos) damaged("the checksum of its header is misplaced");
    // The checksum of the header was made with zeros in its own place.
    without.replace(place, no_checksum.size(), no_checksum);
    Checksum checksum;
    checksum.add(without);
    if (checksum.text() != *text) damaged("its header does not fit the checksum in it");
}

std::uint64_t ClassicReader::dimension(std::string_view name) const { return size_in(dimensions_, name); }

const AttributeValue* ClassicReader::attribute(std::string_view name) const
{
    return find_attribute(attributes_, name);
}

std::optional<double> ClassicReader::number(std::string_view attribute_name) const
{
    const AttributeValue* value = attribute(attribute_name);
    if (value == nullptr) return std::nullopt;
    if (const int* integer = std::get_if<int>(value)) return *integer;
    if (const double* real = std::get_if<double>(value)) return *real;
    return std::nullopt;
}

const ClassicVariable* ClassicReader::variable(std::string_view name) const
{
    return named(variables_, name);
}

void ClassicReader::fetch(const ClassicVariable& variable, std::span<char> out) const
{
    assert(out.size() == variable.n_bytes);
    source_.read(variable.begin, out);
    if (!verify_) return;
    Checksum checksum;
    checksum.add({out.data(), out.size()});
    compare(variable, checksum);
}

void ClassicReader::verify(const ClassicVariable& variable) const
{
    if (!verify_) return;
    Checksum checksum;
    std::vector<char> buffer(std::min<std::uint64_t>(buffer_size, variable.n_bytes));
    for (std::uint64_t done = 0; done < variable.n_bytes; done += buffer.size()) {
        buffer.resize(std::min<std::uint64_t>(buffer.size(), variable.n_bytes - done));
        source_.read(variable.begin + done, buffer);
        checksum.add({buffer.data(), buffer.size()});
    }
    compare(variable, checksum);
}

void ClassicReader::compare(const ClassicVariable& variable, const Checksum& checksum) const
{
    const AttributeValue* stored = find_attribute(variable.attributes, "checksum");
    if (stored == nullptr || *stored != AttributeValue(checksum.text()))
        damaged("variable '" + variable.name + "' does not fit its checksum");
}

template <class Number>
void ClassicReader::read_swapped(const ClassicVariable& variable, std::span<Number> out) const
{
    const std::span<char> bytes(reinterpret_cast<char*>(out.data()), out.size_bytes());
    fetch(variable, bytes);
    swap_numbers(out.data(), out.size(), bytes.data());
}

template void ClassicReader::read_swapped(const ClassicVariable&, std::span<double>) const;
template void ClassicReader::read_swapped(const ClassicVariable&, std::span<int>) const;

std::string ClassicReader::bytes(const ClassicVariable& variable) const
{
    std::string text(variable.n_bytes, '\0');
    fetch(variable, text);
    text.resize(variable.n_values);
    return text;
}

}   // namespace livens
