// Files read with a bound; replace_file() of results.h is defined beside.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace livens {

/// The bytes of a regular file. Throws IoError: missing, a directory, a device, no permission, larger than
/// `limit`.
std::string read_file(const std::filesystem::path& file, std::uintmax_t limit);

}   // namespace livens
