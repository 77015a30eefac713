// SPDX-License-Identifier: BSD-3-Clause
// Numbers of a report, compressed into its page. Bytes of one place stand together (shuffling), since
// neighbours of a series share their leading bytes and compress far better so.
#include "livens/io/report/payload.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <new>

#include <zlib.h>

namespace livens::inline io_internal {

namespace {

/// Byte k of all numbers, then byte k + 1.
template <class Bits, class Value, class Convert>
void append_shuffled(std::string& out, std::span<const Value> values, Convert convert)
{
    const std::size_t n = values.size(), start = out.size();
    out.resize(start + n * sizeof(Bits));
    for (std::size_t i = 0; i < n; ++i) {
        const Bits bits = convert(values[i]);
        for (std::size_t k = 0; k < sizeof(Bits); ++k)
            out[start + k * n + i] = static_cast<char>(bits >> (8 * k) & 0xff);
    }
}

/// Differences of neighbours in place, order after order; the first is one to zero. Modulo 2^32.
void difference(std::span<std::uint32_t> numbers, int order)
{
    for (int round = 0; round < order; ++round)
        for (std::size_t i = numbers.size(); i-- > 1;) numbers[i] -= numbers[i - 1];
}

const char* kind_of(Precision precision)
{
    return precision == Precision::full ? "f8" : precision == Precision::single ? "f4" : "u4";
}

}   // namespace

/// The step of a channel that does not change may be 0, by which nothing is divided: its multiples are 0.
Stepped::Stepped(std::span<const double> values, std::size_t n_channels, int bits, double least)
{
    const std::size_t n = n_channels == 0 ? 0 : values.size() / n_channels;
    for (std::size_t c = 0; c < n_channels; ++c) {
        const std::span<const double> channel = values.subspan(c * n, n);
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const double x : channel)
            if (std::isfinite(x)) low = std::min(low, x), high = std::max(high, x);
        if (!(low <= high)) low = high = 0;
        const double step =
            std::max(std::ldexp(high - low, -bits), least * std::max(std::abs(low), std::abs(high)));
        lows.push_back(low);
        steps.push_back(step);
        for (const double x : channel)
            multiples.push_back(!std::isfinite(x) ? -1
                                : step > 0        ? static_cast<std::int32_t>(std::lround((x - low) / step))
                                                  : 0);
    }
}

std::vector<double> Stepped::values() const
{
    std::vector<double> all;
    all.reserve(multiples.size());
    for (const std::int32_t k : multiples) {
        const std::size_t channel = all.size() / (multiples.size() / lows.size());
        all.push_back(k < 0 ? std::numeric_limits<double>::quiet_NaN() : lows[channel] + k * steps[channel]);
    }
    return all;
}

void Payload::add(std::string name, Precision precision, std::span<const double> values)
{
    entries_.push_back({std::move(name), kind_of(precision), values.size()});
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

void Payload::add(const std::string& name, const Stepped& stepped, int order)
{
    add(name + "_low", Precision::full, stepped.lows);
    add(name + "_step", Precision::full, stepped.steps);
    std::vector<std::uint32_t> numbers(stepped.multiples.begin(), stepped.multiples.end());
    const std::size_t n = stepped.lows.empty() ? 0 : numbers.size() / stepped.lows.size();
    for (std::size_t c = 0; c < stepped.lows.size(); ++c)
        difference(std::span(numbers).subspan(c * n, n), order);
    entries_.push_back({name, order == 1 ? "d1" : "d2", numbers.size()});
    // The sign goes to the lowest bit, so that what is small has few bytes either way.
    append_shuffled<std::uint32_t>(bytes_, std::span<const std::uint32_t>(numbers), [](std::uint32_t x) {
        return x << 1 ^ (x >> 31 != 0 ? 0xffffffffu : 0u);
    });
}

void Payload::write_table(JsonWriter& json) const
{
    json.begin_object();
    for (const Entry& e : entries_) {
        json.key(e.name).begin_array();
        json.value(e.kind).value(e.count).end_array();
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
