// SPDX-License-Identifier: BSD-3-Clause
// Classic NetCDF, the formats CDF-1, CDF-2 and CDF-5, without any library: a header of names, dimensions and
// attributes, and behind it arrays, highest byte first. [NetCDF classic format specification]
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace livens::inline io_internal {

/// As the format numbers them; files of others may hold further ones, which are passed over.
enum class NumberType : int { byte = 1, text = 2, integer = 4, real = 6 };

/// Empty: of a type or a size that is not read.
using AttributeValue = std::variant<std::monostate, std::string, int, double>;
struct Attribute {
    std::string name;
    AttributeValue value;
};

struct ClassicDimension {
    std::string name;
    std::uint64_t length;
};

struct ClassicVariable {
    std::string name;
    std::vector<std::string> dimensions;
    NumberType type = NumberType::real;
    std::vector<Attribute> attributes{};
    // Of the place in the file; writers need not know them.
    std::uint64_t n_values = 0;
    std::uint64_t begin = 0;
    std::uint64_t n_bytes = 0;   ///< a multiple of 4: filled up with zeros
};

/// A number that changes if a bit of what was added does: a guard against damage, not against malice. Pieces
/// may be of any size if all but the last are multiples of 8 bytes.
class Checksum {
public:
    void add(std::string_view bytes);
    /// Of numbers, which are put into `out` as the file has them.
    void add(std::span<const double> numbers, char* out);
    void add(std::span<const int> numbers, char* out);
    std::string text() const;   ///< 16 hexadecimal digits
    /// Between those who go on with each other's.
    std::uint64_t state() const { return state_; }
    void go_on_from(std::uint64_t state) { state_ = state; }

private:
    std::uint64_t state_ = 0xcbf29ce484222325u;
};

/// Where the bytes of a new file go; the pieces cover it, each byte once, but for the header, which comes
/// first without checksums and last with them.
using ByteSink = std::function<void(std::uint64_t offset, std::string_view bytes)>;

/// Where values of a part of a dimension are among all, and how many of them the part before has, too.
struct Slab {
    std::uint64_t before = 0, total = 0, skipped = 0;
};

/// What writers of one file know of each other. Each has declared the same, appends its own values of
/// variables whose first dimension is divided, real ones, and puts them where they belong; the first writes
/// all others.
class SharedFile {
public:
    virtual ~SharedFile() = default;
    virtual bool is_first() const = 0;
    /// Of a dimension that has `here` values in this part; none: it is not divided.
    virtual std::optional<Slab> slab(const std::string& dimension, std::uint64_t here) = 0;
    /// Checksum of what the parts before have of a variable.
    virtual std::uint64_t state_before(int variable) = 0;
    virtual void pass_on(int variable, std::uint64_t state) = 0;
    /// Those of the last part, for the first one.
    virtual std::uint64_t last_state(std::uint64_t own) = 0;
};

/// How far a variable is written.
struct WrittenSoFar {
    std::uint64_t done = 0;   ///< bytes
    Checksum checksum{};
    std::size_t checksum_place = 0;   ///< in the header
    // Of what is shared: bytes that this part has, how many the parts before have, numbers to be left
    // out.
    std::uint64_t expected = 0, offset = 0;
    std::size_t left_out = 0;
    bool is_divided = false, is_passed_on = false;
};

/// Declare everything, begin(), append() the values of every variable, of several in turns if need be,
/// finish(). What is kept in memory is the header and a buffer of fixed size. Every byte of the file is under
/// a checksum: each variable's has the attribute `checksum`, the header, with these, the global attribute
/// `livens_checksum`. Same calls, same bytes.
class ClassicWriter {
public:
    /// CDF-2 is written where no variable is larger than this, else CDF-5, which fewer programs read.
    static constexpr std::uint64_t largest_in_cdf2 = (std::uint64_t{1} << 31) - 4;
    explicit ClassicWriter(std::uint64_t largest = largest_in_cdf2) : largest_(largest) {}

    std::uint64_t dimension(const std::string& name) const;   ///< 0: there is none
    void dimension(const std::string& name, std::uint64_t length);
    void attribute(const std::string& name, AttributeValue value) { attributes_.push_back({name, value}); }
    /// All dimensions are there. Returns the number by which append() knows it.
    int variable(ClassicVariable variable);

    /// Before begin(); must outlive this.
    void share(SharedFile& shared) { shared_ = &shared; }
    void begin(ByteSink sink);
    void append(int variable, std::span<const double> values) { append_swapped(variable, values); }
    void append(int variable, std::span<const int> values) { append_swapped(variable, values); }
    void append(int variable, std::string_view bytes);   ///< text, or numbers of one byte; all at once
    void finish();

private:
    void divide();
    void pass_on(int variable);

    void write(int variable, std::string_view bytes);
    template <class Put>
    void write(int variable, std::size_t n_bytes, const Put& put);
    template <class Number>
    void append_swapped(int variable, std::span<const Number> values);
    void put_count(std::uint64_t n);
    void put_name(const std::string& name);
    std::size_t put_attributes(const std::vector<Attribute>& attributes, const char* checksum);
    void put_header();

    std::uint64_t largest_;
    bool is_wide_ = false;
    std::vector<ClassicDimension> dimensions_;
    std::vector<Attribute> attributes_;
    std::vector<ClassicVariable> variables_;
    std::vector<WrittenSoFar> progress_;
    std::string header_;
    std::size_t checksum_place_ = 0;
    ByteSink sink_;
    std::vector<char> buffer_;
    SharedFile* shared_ = nullptr;
};

/// A file to be read: regular, or bytes in memory.
struct ByteSource {
    std::uint64_t size = 0;
    std::function<void(std::uint64_t offset, std::span<char> out)> read;
};

/// Reads the header when made, and variables when they are asked for. Every count, length and place is
/// checked against the size of the file before memory is asked for: what is taken and done is at most
/// proportional to it. Names are unique within dimensions, variables and the attributes of one of them; they
/// have 256 bytes at most, variables 8 dimensions; variables have no byte in common. Throws IoError:
/// `io-foreign` if it is no classic NetCDF file, `io-truncated` if it ends too early, `io-damaged`.
class ClassicReader {
public:
    /// Without `verify` checksums are not looked at: for tests of what comes after them.
    explicit ClassicReader(ByteSource source, bool verify = true);

    /// Throws if the header has no checksum, or another one.
    void verify_header() const;

    std::uint64_t dimension(std::string_view name) const;           ///< 0: there is none
    const AttributeValue* attribute(std::string_view name) const;   ///< global; nullptr: there is none
    std::optional<double> number(std::string_view attribute) const;
    const ClassicVariable* variable(std::string_view name) const;
    const std::vector<Attribute>& attributes() const { return attributes_; }
    const std::vector<ClassicVariable>& variables() const { return variables_; }

    /// The values of a variable of this type; `out` has its size. Throw if the checksum is not theirs.
    void read(const ClassicVariable& variable, std::span<double> out) const { read_swapped(variable, out); }
    void read(const ClassicVariable& variable, std::span<int> out) const { read_swapped(variable, out); }
    std::string bytes(const ClassicVariable& variable) const;   ///< text, or numbers of one byte
    /// Looks at the checksum alone, whatever the type.
    void verify(const ClassicVariable& variable) const;

private:
    class Header;

    std::vector<Attribute> read_attributes(Header& header) const;
    void read_variable(Header& header);
    void fetch(const ClassicVariable& variable, std::span<char> out) const;
    void compare(const ClassicVariable& variable, const Checksum& checksum) const;
    template <class Number>
    void read_swapped(const ClassicVariable& variable, std::span<Number> out) const;

    ByteSource source_;
    bool verify_;
    std::vector<ClassicDimension> dimensions_;
    std::vector<Attribute> attributes_;
    std::vector<ClassicVariable> variables_;
    std::string header_;
};

/// Of the attribute, nullptr if there is none.
const AttributeValue* find_attribute(const std::vector<Attribute>& attributes, std::string_view name);

}   // namespace livens::inline io_internal
