// What shows that a result file is as it was written.
#pragma once

#include <string>
#include <string_view>

#include "livens/io/results.h"

namespace livens {

/// 64 bits over everything that version 1.`minor` of the format brought, as 16 hexadecimal digits. Each minor
/// version has a digest of its own, so that readers who do not know it can check what they know.
std::string digest_of_minor(const Run& run, int minor);
/// Over everything.
std::string digest(const Run& run);
/// Name of the attribute that holds digest_of_minor().
std::string digest_name(int minor);

/// The image with 24 bytes behind it that hold a checksum of all before: "\nlivens " and 16 hexadecimal
/// digits. Programs that read HDF5 do not look there.
std::string sealed(std::string image);
/// Throws IoError if there is a seal and it does not fit. Damage must not reach the HDF5 library, whose old
/// versions crash on some of it. Files that other tools have rewritten have no seal.
void check_seal(std::string_view bytes);

}   // namespace livens
