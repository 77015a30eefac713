// SPDX-License-Identifier: BSD-3-Clause
// The size of a file is asked before anything is read, and counted again while reading, as the file may grow.
#include "livens/io/scenario/text/reading.h"

#include <cerrno>
#include <fstream>

#include "livens/io/scenario.h"

namespace livens::inline io_internal {

bool read_text(const std::filesystem::path& file, std::string& text, Findings& findings)
{
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status)) return findings.error({}, "io-not-found", "there is no such file");
    if (std::filesystem::is_directory(status))
        return findings.error({}, "io-directory", "this is a directory, not a file");
    const bool is_regular = std::filesystem::is_regular_file(status);
    const std::uintmax_t size = is_regular ? std::filesystem::file_size(file, error) : 0;
    if (!error && size > max_scenario_bytes)
        return findings.error({}, "resource-limit",
                              "the file has " + std::to_string(size) + " bytes, more than " +
                                  std::to_string(max_scenario_bytes));
    errno = 0;
    std::ifstream stream(file, std::ios::binary);
    if (!stream.is_open() && errno == ENOMEM) throw std::bad_alloc();   // of the stream's own
    constexpr std::size_t portion = 1u << 16;
    while (stream && text.size() <= max_scenario_bytes) {   // pipes have no size to ask for
        const std::size_t before = text.size();
        text.resize(before + portion);
        stream.read(text.data() + before, portion);
        text.resize(before + static_cast<std::size_t>(stream.gcount()));
    }
    return (stream.is_open() && !stream.bad()) ||
           findings.error({}, "io-unreadable", "the file cannot be read");
}

}   // namespace livens::inline io_internal
