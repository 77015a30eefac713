// SPDX-License-Identifier: BSD-3-Clause
// Numbers of a report, compressed into its page. Bytes of one place stand together (shuffling), since
// neighbours of a series share their leading bytes and compress far better so.
#include "livens/io/report/payload.h"

#include <bit>
#include <new>

#include <zlib.h>

namespace livens::inline io_internal {

namespace {

/// Byte k of all numbers, then byte k + 1.
template <class Bits, class Convert>
void append_shuffled(std::string& out, std::span<const double> values, Convert convert)
{
    const std::size_t n = values.size(), start = out.size();
    out.resize(start + n * sizeof(Bits));
    for (std::size_t i = 0; i < n; ++i) {
        const Bits bits = convert(values[i]);
        for (std::size_t k = 0; k < sizeof(Bits); ++k)
            out[start + k * n + i] = static_cast<char>(bits >> (8 * k) & 0xff);
    }
}

}   // namespace

void Payload::add(std::string name, Precision precision, std::span<const double> values)
{
    entries_.push_back({std::move(name), precision, values.size()});
    if (precision == Precision::full)
        append_shuffled<std::uint64_t>(bytes_, values,
                                       [](double x) { return std::bit_cast<std::uint64_t>(x); });
    else if (precision == Precision::single)
        append_shuffled<std::uint32_t>(
            bytes_, values, [](double x) { return std::bit_cast<std::uint32_t>(static_cast<float>(x)); });
    else
        append_shuffled<std::uint32_t>(bytes_, values,
                                       [](double x) { return static_cast<std::uint32_t>(x); });
}

void Payload::write_table(JsonWriter& json) const
{
    json.begin_object();
    for (const Entry& e : entries_) {
        json.key(e.name).begin_array();
        json.value(e.precision == Precision::full ? "f8" : e.precision == Precision::single ? "f4" : "u4");
        json.value(e.count).end_array();
    }
    json.end_object();
}

std::string Payload::encoded(int level) const { return packed(bytes_, level); }

std::string base64(std::string_view bytes)
{
    constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 3; ++k)
            three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            out += i + k <= bytes.size() ? letters[three >> (18 - 6 * k) & 63] : '=';
    }
    return out;
}

std::string packed(std::string_view bytes, int level)
{
    uLongf size = ::compressBound(bytes.size());
    std::string out(size, '\0');
    // Only memory can fail: the buffer is large enough by compressBound().
    if (::compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                    bytes.size(), level) != Z_OK)
        throw std::bad_alloc();
    out.resize(size);
    return base64(out);
}

}   // namespace livens::inline io_internal
