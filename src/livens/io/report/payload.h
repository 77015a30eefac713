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

/// Arrays are stored one after the other, the first bytes of all numbers of an array before the second ones:
/// bytes of one significance are alike, which makes them compress.
class Payload {
public:
    void add(std::string name, Precision precision, std::span<const double> values);

    /// {"name": [kind, count]}, kind "f8", "f4" or "u4", in the order of the bytes.
    void write_table(JsonWriter& json) const;
    /// See packed().
    std::string encoded(int level) const;
    std::size_t n_bytes() const { return bytes_.size(); }

private:
    struct Entry {
        std::string name;
        Precision precision;
        std::size_t count;
    };
    std::vector<Entry> entries_;
    std::string bytes_;
};

std::string base64(std::string_view bytes);
/// zlib's format in base64; `level`: from 1, quick, to 9, small.
std::string packed(std::string_view bytes, int level);

}   // namespace livens::inline io_internal
