// SPDX-License-Identifier: BSD-3-Clause
// What the writers of exports share.
#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "livens/io/exports.h"
#include "livens/io/surface.h"

namespace livens::inline io_internal {

/// Sizes and places from `narrow` on are written with 64 bits.
void write_npz(const std::filesystem::path& file, const ExportInput& input,
               std::uint64_t narrow = 0xffffffff);
void write_gltf(const std::filesystem::path& file, const ExportInput& input);
void write_pvd(const std::filesystem::path& file, const ExportInput& input);
/// `word`: of the format, "png", "svg", "webm" or "gif".
void write_picture(const std::filesystem::path& file, const ExportInput& input, std::string_view word);
/// That bodies turn back between its frames.
std::string doubt_of_video(const ExportInput& input, std::string_view word);

/// How a list of surfaces and a surface begin.
inline constexpr std::string_view pvd_head =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n";
inline constexpr std::string_view vtp_head =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
    "header_type=\"UInt64\">\n";

/// Appends a number, lowest byte first, whatever the machine.
template <class Number>
void put(std::string& out, Number number)
{
    using Bits = std::conditional_t<
        sizeof(Number) == 8, std::uint64_t,
        std::conditional_t<sizeof(Number) == 4, std::uint32_t,
                           std::conditional_t<sizeof(Number) == 2, std::uint16_t, std::uint8_t>>>;
    const Bits bits = std::bit_cast<Bits>(number);
    for (std::size_t i = 0; i < sizeof bits; ++i) out += static_cast<char>(bits >> (8 * i) & 0xff);
}

/// A surface at a place and in axes of its body or of the world.
struct Drawn {
    Surface surface;
    Vector3 place{};
    Matrix3 axes = identity<3>();
    std::optional<Vector3> color{};   ///< red, green, blue from 0 to 1, in sRGB
    double opacity = 1;
};

/// What is drawn of each body, then of the world: its visuals, else its shape, else, as a mark, an octahedron
/// at its centre of mass (a ball for point masses).
std::vector<std::vector<Drawn>> drawn_of(const Scenario& scenario);

/// Likewise, all of a body as one surface in its own coordinates.
Surface united(const std::vector<Drawn>& all);

/// The output times that the motion has reached.
std::vector<double> reached_times(const Run& run);

}   // namespace livens::inline io_internal
