// SPDX-License-Identifier: BSD-3-Clause
// Numbers as text of a page: named arrays, compressed together.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "livens/io/json.h"

namespace livens::inline io_internal {

enum class Precision { whole, single, full };   ///< 4 bytes unsigned, 4 and 8 bytes of a real number

/// Channels of equally many numbers, one after the other, as whole multiples of a step that is 2^-bits of the
/// range of each.
struct Stepped {
    /// What is not finite has no multiple. A step is at least `least` of the largest number of its channel.
    Stepped(std::span<const double> values, std::size_t n_channels, int bits, double least = 0);

    std::vector<double> lows, steps;       ///< of each channel
    std::vector<std::int32_t> multiples;   ///< -1: not a number

    /// As whoever reads it has them.
    std::vector<double> values() const;
};

/// Arrays are stored one after the other, the first bytes of all numbers of an array before the second ones:
/// bytes of one significance are alike, which makes them compress.
class Payload {
public:
    void add(std::string name, Precision precision, std::span<const double> values);
    /// Of smooth series, as differences of first or second order along each channel, which are small where
    /// neighbours are alike; lows and steps as arrays `name`_low and `name`_step before it.
    void add(const std::string& name, const Stepped& stepped, int order);

    /// {"name": [kind, count]}, kind "f8", "f4", "u4", or "d1", "d2" of differences, in the order of the
    /// bytes.
    void write_table(JsonWriter& json) const;
    /// See packed().
    std::string encoded(int level) const;
    std::size_t n_bytes() const { return bytes_.size(); }

private:
    struct Entry {
        std::string name;
        const char* kind;
        std::size_t count;
    };
    std::vector<Entry> entries_;
    std::string bytes_;
};

std::string base64(std::string_view bytes);
/// zlib's format in base64; `level`: from 1, quick, to 9, small.
std::string packed(std::string_view bytes, int level);

}   // namespace livens::inline io_internal
