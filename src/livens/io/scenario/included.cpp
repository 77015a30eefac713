// SPDX-License-Identifier: BSD-3-Clause
// Files that a scenario includes are read as meshes are: from its folder on, bounded in size, and kept in the
// run's file, so that a run can be read again without them.
#include "livens/io/scenario/included.h"

#include <algorithm>
#include <fstream>

#include "livens/base/error.h"
#include "livens/io/scenario/bodies/meshes.h"

namespace livens::inline io_internal {

/// Of what a run has kept two lines a file, as kept() writes them: `include PATH`, `content TEXT`. Lines
/// of meshes stand among them, which MeshStore reads.
IncludedTexts::IncludedTexts(MeshSource source) : source_(std::move(source))
{
    std::string path;
    for (std::string_view text = source_.kept; !text.empty();) {
        const std::string_view line = text.substr(0, std::min(text.find('\n'), text.size()));
        if (line.starts_with("include ")) path = out_of_line(line.substr(8));
        if (line.starts_with("content ") && !path.empty()) kept_[path] = out_of_line(line.substr(8));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
    }
}

const std::string& IncludedTexts::find(const std::string& path)
{
    auto known = known_.find(path);
    if (known == known_.end()) {
        const auto kept = kept_.find(path);
        known = known_.emplace(path, kept != kept_.end() ? kept->second : read(path)).first;
    }
    // At each call: a text that is included many times becomes as many parts.
    n_bytes_ += known->second.size();
    if (n_bytes_ > max_scenario_bytes)
        throw InputError({"include-limit", "",
                          "all that is included has more than " + std::to_string(max_scenario_bytes) +
                              " bytes, each time counted",
                          "", "", "", "include fewer or shorter files"});
    return known->second;
}

/// At most one byte more than a scenario may have, by which find() refuses a longer file.
std::string IncludedTexts::read(const std::string& path)
{
    const std::filesystem::path file = find_file(source_, path, "include");
    const auto refuse = [&](const std::string& why) {
        throw InputError({"include-file", "", "the file '" + path + "' " + why, "", "", "",
                          "paths begin in the folder of the file that includes"});
    };
    std::error_code error;
    if (!std::filesystem::exists(file, error)) refuse("does not exist");
    if (!std::filesystem::is_regular_file(file, error)) refuse("is no file");
    std::ifstream stream(file, std::ios::binary);
    std::string text(max_scenario_bytes + 1, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    if (stream.bad() || (!stream.eof() && stream.fail())) refuse("cannot be read");
    text.shrink_to_fit();
    files_.push_back(file);
    return text;
}

std::string IncludedTexts::kept() const
{
    std::string all;
    for (const auto& [path, text] : known_) all += "include " + in_line(path) + "content " + in_line(text);
    return all;
}

}   // namespace livens::inline io_internal
