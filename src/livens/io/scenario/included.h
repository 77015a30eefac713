// SPDX-License-Identifier: BSD-3-Clause
// [[include]]: texts of other files that a scenario takes in.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "livens/io/scenario.h"

namespace livens::inline io_internal {

/// Texts by their paths from the scenario's folder on. What a run has kept wins over the files.
class IncludedTexts {
public:
    explicit IncludedTexts(MeshSource source);

    /// Throws InputError: `include-path`, `include-file`, and `include-limit` where all that was asked for,
    /// each time, is more than a scenario may have.
    const std::string& find(const std::string& path);
    /// All that was asked for, as MeshSource::kept.
    std::string kept() const;
    /// That were read.
    const std::vector<std::filesystem::path>& files() const { return files_; }

private:
    std::string read(const std::string& path);

    MeshSource source_;
    std::map<std::string, std::string> known_, kept_;
    std::vector<std::filesystem::path> files_;
    std::size_t n_bytes_ = 0;
};

}   // namespace livens::inline io_internal
