// SPDX-License-Identifier: BSD-3-Clause
// What stands where something is to be written.
// Files are replaced silently only if their beginning shows that livens wrote them; what cannot be read
// counts as somebody else's.
#include <algorithm>
#include <string>
#include <system_error>

#include "livens/io/results.h"
#include "livens/io/results/atomic_file.h"

namespace livens {

bool begins_as_run(std::string_view head)
{
    return head.starts_with("CDF") && head.find("livens_format") != std::string_view::npos;
}

bool is_occupied(const std::filesystem::path& file, bool (*is_own)(std::string_view head))
{
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) return false;
    try {
        const InputFile in(file);
        std::string head(std::min<std::uint64_t>(in.size(), telling_bytes), '\0');
        in.read(0, head);
        return !head.empty() && !is_own(head);
    } catch (const IoError&) {
        return true;
    }
}

}   // namespace livens
