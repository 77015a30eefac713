// SPDX-License-Identifier: BSD-3-Clause
// The writer of the classic NetCDF format, and its checksum.
// Header first with places for checksums, data one variable after the other, checksums last: a file can be
// written without being held in memory (docs/results.md).
#include <cassert>

#include "livens/io/results.h"
#include "livens/io/results/classic_netcdf_bytes.h"

namespace livens::inline io_internal {

namespace {

template <class Word>
void put_word(std::string& out, Word x)
{
    x = big_endian(x);
    out.append(reinterpret_cast<const char*>(&x), sizeof x);
}

}   // namespace

namespace {

/// A round of FNV-1a on a word instead of a byte, and its high half folded down.
inline std::uint64_t checksum_round(std::uint64_t state, const char* place, std::size_t n)
{
    std::uint64_t word = 0;
    std::memcpy(&word, place, n);
    if constexpr (std::endian::native == std::endian::big) word = __builtin_bswap64(word);
    state = (state ^ word) * 0x100000001b3u;
    return state ^ (state >> 29);
}

}   // namespace

void Checksum::add(std::string_view bytes)
{
    const char *place = bytes.data(), *const end = place + bytes.size();
    std::uint64_t state = state_;
    for (; end - place >= 32; place += 32) {   // nothing but such rounds: counting would take a third more
        state = checksum_round(state, place, 8);
        state = checksum_round(state, place + 8, 8);
        state = checksum_round(state, place + 16, 8);
        state = checksum_round(state, place + 24, 8);
    }
    for (; end - place >= 8; place += 8) state = checksum_round(state, place, 8);
    if (place != end) state = checksum_round(state, place, static_cast<std::size_t>(end - place));
    state_ = state;
}

void Checksum::add(std::span<const double> numbers, char* out)
{
    std::uint64_t state = state_;
    const auto put = [&](double number) {
        swap_numbers(&number, 1, out);
        state = checksum_round(state, out, sizeof number);
        out += sizeof number;
    };
    std::size_t i = 0;
    for (; i + 4 <= numbers.size(); i += 4) {
        put(numbers[i]);
        put(numbers[i + 1]);
        put(numbers[i + 2]);
        put(numbers[i + 3]);
    }
    for (; i < numbers.size(); ++i) put(numbers[i]);
    state_ = state;
}

void Checksum::add(std::span<const int> numbers, char* out)
{
    swap_numbers(numbers.data(), numbers.size(), out);
    add({out, numbers.size_bytes()});
}

std::string Checksum::text() const
{
    static constexpr char digits[] = "0123456789abcdef";
    std::string s;
    for (int shift = 60; shift >= 0; shift -= 4) s += digits[(state_ >> shift) & 15];
    return s;
}

const AttributeValue* find_attribute(const std::vector<Attribute>& attributes, std::string_view name)
{
    const Attribute* found = named(attributes, name);
    return found == nullptr ? nullptr : &found->value;
}

std::uint64_t ClassicWriter::dimension(const std::string& name) const { return size_in(dimensions_, name); }

void ClassicWriter::dimension(const std::string& name, std::uint64_t length)
{
    assert(length > 0 && dimension(name) == 0);
    dimensions_.push_back({name, length});
}

int ClassicWriter::variable(ClassicVariable variable)
{
    variable.n_values = 1;
    for (const std::string& name : variable.dimensions) variable.n_values *= dimension(name);
    assert(variable.n_values > 0);
    variable.n_bytes = padded(variable.n_values * size_of(static_cast<std::uint64_t>(variable.type)));
    variables_.push_back(std::move(variable));
    return static_cast<int>(variables_.size()) - 1;
}

void ClassicWriter::put_count(std::uint64_t n)
{
    is_wide_ ? put_word(header_, n) : put_word(header_, static_cast<std::uint32_t>(n));
}

void ClassicWriter::put_name(const std::string& name)
{
    put_count(name.size());
    header_ += name;
    header_.resize(padded(header_.size()));
}

/// Those given and one for the checksum, whose place is returned.
std::size_t ClassicWriter::put_attributes(const std::vector<Attribute>& attributes, const char* checksum)
{
    const auto put_head = [&](const std::string& name, NumberType type, std::size_t n) {
        put_name(name);
        put_word(header_, static_cast<std::uint32_t>(type));
        put_count(n);
    };
    put_word(header_, attribute_tag);
    put_count(attributes.size() + 1);
    for (const Attribute& attribute : attributes) {
        if (const auto* text = std::get_if<std::string>(&attribute.value)) {
            put_head(attribute.name, NumberType::text, text->size());
            header_ += *text;
            header_.resize(padded(header_.size()));
        } else if (const int* integer = std::get_if<int>(&attribute.value)) {
            put_head(attribute.name, NumberType::integer, 1);
            put_word(header_, static_cast<std::uint32_t>(*integer));
        } else {
            put_head(attribute.name, NumberType::real, 1);
            put_word(header_, std::bit_cast<std::uint64_t>(std::get<double>(attribute.value)));
        }
    }
    put_head(checksum, NumberType::text, no_checksum.size());
    header_ += no_checksum;
    return header_.size() - no_checksum.size();
}

void ClassicWriter::put_header()
{
    const auto wide = [&](std::uint64_t n) { return n > largest_; };
    // CDF-2 where sizes fit into 32 bits, since every reader knows it; CDF-5 only where it must be.
    is_wide_ = std::ranges::any_of(variables_, wide, &ClassicVariable::n_bytes) ||
               std::ranges::any_of(dimensions_, wide, &ClassicDimension::length);
    header_ = is_wide_ ? "CDF\5" : "CDF\2";
    put_count(0);   // no records
    put_word(header_, dimensions_.empty() ? 0 : dimension_tag);
    put_count(dimensions_.size());
    for (const ClassicDimension& dimension : dimensions_) {
        put_name(dimension.name);
        put_count(dimension.length);
    }
    checksum_place_ = put_attributes(attributes_, checksum_name.data());
    put_word(header_, variables_.empty() ? 0 : variable_tag);
    put_count(variables_.size());
    std::vector<std::size_t> begins;
    for (const ClassicVariable& variable : variables_) {
        put_name(variable.name);
        put_count(variable.dimensions.size());
        for (const std::string& name : variable.dimensions) {
            put_count(static_cast<std::uint64_t>(named(dimensions_, name) - dimensions_.data()));
        }
        progress_[static_cast<std::size_t>(&variable - variables_.data())].checksum_place =
            put_attributes(variable.attributes, "checksum");
        put_word(header_, static_cast<std::uint32_t>(variable.type));
        put_count(variable.n_bytes);
        begins.push_back(header_.size());
        put_word(header_, std::uint64_t{0});
    }
    std::uint64_t begin = header_.size();
    for (std::size_t i = 0; i < variables_.size(); ++i) {
        // The length of the header is known only now; offsets fill the places that were left for them.
        variables_[i].begin = begin;
        swap_numbers(&begin, 1, header_.data() + begins[i]);
        begin += variables_[i].n_bytes;
    }
}

/// Dimensions get their whole lengths, and variables their parts.
void ClassicWriter::divide()
{
    std::vector<std::optional<Slab>> slabs;
    std::vector<std::uint64_t> lengths;
    for (ClassicDimension& dimension : dimensions_) {
        lengths.push_back(dimension.length);
        slabs.push_back(shared_->slab(dimension.name, dimension.length));
        if (slabs.back()) dimension.length = slabs.back()->total;
    }
    for (std::size_t i = 0; i < variables_.size(); ++i) {
        ClassicVariable& variable = variables_[i];
        WrittenSoFar& progress = progress_[i];
        const auto front =
            static_cast<std::size_t>(named(dimensions_, variable.dimensions.front()) - dimensions_.data());
        progress.expected = shared_->is_first() ? variable.n_bytes : 0;
        if (!slabs[front]) continue;
        assert(variable.type == NumberType::real);
        const Slab& slab = *slabs[front];
        const std::uint64_t in_one = variable.n_values / lengths[front];
        progress.is_divided = true;
        progress.left_out = static_cast<std::size_t>(slab.skipped * in_one);
        progress.expected = (lengths[front] - slab.skipped) * in_one * sizeof(double);
        progress.offset = slab.before * in_one * sizeof(double);
        variable.n_values = slab.total * in_one;
        variable.n_bytes = variable.n_values * sizeof(double);
    }
}

/// The checksum of a variable whose part is complete.
void ClassicWriter::pass_on(int variable)
{
    WrittenSoFar& progress = progress_[variable];
    if (!progress.is_divided || progress.is_passed_on || progress.done < progress.expected) return;
    if (progress.expected == 0) progress.checksum.go_on_from(shared_->state_before(variable));
    shared_->pass_on(variable, progress.checksum.state());
    progress.is_passed_on = true;
}

void ClassicWriter::begin(ByteSink sink)
{
    buffer_.resize(buffer_size);
    progress_.resize(variables_.size());
    for (std::size_t i = 0; i < variables_.size(); ++i) progress_[i].expected = variables_[i].n_bytes;
    if (shared_ != nullptr) divide();
    put_header();
    sink_ = std::move(sink);
    if (shared_ == nullptr || shared_->is_first()) sink_(0, header_);
}

/// put(checksum) returns the next bytes of the variable.
template <class Put>
void ClassicWriter::write(int variable, std::size_t n_bytes, const Put& put)
{
    WrittenSoFar& progress = progress_[variable];
    // The checksum takes words of eight bytes, so pieces may end elsewhere only at the very end.
    assert(progress.done % 8 == 0 && progress.done + n_bytes <= progress.expected);
    if (progress.is_divided && progress.done == 0)
        progress.checksum.go_on_from(shared_->state_before(variable));
    sink_(variables_[variable].begin + progress.offset + progress.done, put(progress.checksum));
    progress.done += n_bytes;
    pass_on(variable);
}

void ClassicWriter::write(int variable, std::string_view bytes)
{
    write(variable, bytes.size(), [&](Checksum& checksum) {
        checksum.add(bytes);
        return bytes;
    });
}

template <class Number>
void ClassicWriter::append_swapped(int variable, std::span<const Number> values)
{
    assert(size_of(static_cast<std::uint64_t>(variables_[variable].type)) == sizeof(Number));
    if (progress_[variable].expected == 0) return;   // the first part has it
    const std::size_t out = std::min(progress_[variable].left_out, values.size());
    progress_[variable].left_out -= out;
    values = values.subspan(out);
    constexpr std::size_t most = buffer_size / sizeof(Number);
    for (std::size_t i = 0; i < values.size(); i += most) {
        const std::span<const Number> some = values.subspan(i, std::min(most, values.size() - i));
        write(variable, some.size_bytes(), [&](Checksum& checksum) {
            checksum.add(some, buffer_.data());
            return std::string_view(buffer_.data(), some.size_bytes());
        });
    }
}

template void ClassicWriter::append_swapped(int, std::span<const double>);
template void ClassicWriter::append_swapped(int, std::span<const int>);

void ClassicWriter::append(int variable, std::string_view bytes)
{
    assert(bytes.size() == variables_[variable].n_values);
    if (progress_[variable].expected == 0) return;
    const std::size_t whole = bytes.size() & ~std::size_t{7};
    write(variable, bytes.substr(0, whole));
    // Bytes that fill the variable up to four belong to it, and to its checksum.
    std::string rest(bytes.substr(whole));
    rest.resize(padded(rest.size()));
    if (!rest.empty()) write(variable, rest);
}

void ClassicWriter::finish()
{
    for (std::size_t i = 0; shared_ != nullptr && i < variables_.size(); ++i) pass_on(static_cast<int>(i));
    for (WrittenSoFar& progress : progress_)
        if (progress.is_divided) progress.checksum.go_on_from(shared_->last_state(progress.checksum.state()));
    if (shared_ != nullptr && !shared_->is_first()) return;
    for (std::size_t i = 0; i < variables_.size(); ++i) {
        assert(progress_[i].done == progress_[i].expected);
        header_.replace(progress_[i].checksum_place, no_checksum.size(), progress_[i].checksum.text());
    }
    Checksum of_header;
    // The header's own checksum covers those of the variables, so that none can be exchanged unseen.
    of_header.add(header_);
    header_.replace(checksum_place_, no_checksum.size(), of_header.text());
    sink_(0, header_);
}

}   // namespace livens::inline io_internal
