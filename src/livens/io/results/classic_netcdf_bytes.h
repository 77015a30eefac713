// SPDX-License-Identifier: BSD-3-Clause
// What writer and reader of the classic NetCDF format share: sizes, tags, the order of bytes.
#pragma once

#include <algorithm>
#include <bit>
#include <cstring>

#include "livens/io/results/classic_netcdf.h"

namespace livens::inline io_internal {

inline constexpr std::uint32_t dimension_tag = 10, variable_tag = 11, attribute_tag = 12;
inline constexpr std::size_t buffer_size = 128u << 10;
inline constexpr std::string_view checksum_name = "livens_checksum", no_checksum = "0000000000000000";

inline std::uint64_t padded(std::uint64_t n) { return (n + 3) & ~std::uint64_t{3}; }

/// Bytes of a number of each type of the format; those from 7 on exist in CDF-5 only.
inline std::uint64_t size_of(std::uint64_t type)
{
    constexpr std::uint64_t sizes[] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    return type < std::size(sizes) ? sizes[type] : 0;
}

/// Between the machine's order and the file's, either way.
template <class Word>
Word big_endian(Word x)
{
    if constexpr (std::endian::native == std::endian::big) return x;
    else if constexpr (sizeof x == 8) return __builtin_bswap64(x);
    else return __builtin_bswap32(x);
}

template <class Number>
using WordOf = std::conditional_t<sizeof(Number) == 8, std::uint64_t, std::uint32_t>;

template <class Number>
void swap_numbers(const Number* in, std::size_t n, char* out)
{
    for (std::size_t i = 0; i < n; ++i) {
        const auto word = big_endian(std::bit_cast<WordOf<Number>>(in[i]));
        std::memcpy(out + i * sizeof word, &word, sizeof word);
    }
}

/// nullptr: there is none.
template <class Entry>
const Entry* named(const std::vector<Entry>& entries, std::string_view name)
{
    const auto found = std::ranges::find(entries, name, &Entry::name);
    return found == entries.end() ? nullptr : &*found;
}

inline std::uint64_t size_in(const std::vector<ClassicDimension>& dimensions, std::string_view name)
{
    const ClassicDimension* found = named(dimensions, name);
    return found == nullptr ? 0 : found->length;
}

}   // namespace livens::inline io_internal
