// SPDX-License-Identifier: BSD-3-Clause
// What all readers of texts need: the text itself, within bounds, and exceptions as findings.
#pragma once

#include <exception>
#include <filesystem>
#include <new>
#include <string>

#include "livens/io/scenario/text/findings.h"

namespace livens::inline io_internal {

/// Reads a file to its end or to one byte over the limit of scenarios. False after an error.
bool read_text(const std::filesystem::path& file, std::string& text, Findings& findings);

/// Runs `work` so that nothing is thrown, but std::bad_alloc where not even a finding has room.
template <class Work>
void shield(Findings& findings, Work work)
{
    try {
        work();
    } catch (const std::bad_alloc&) {
        findings.error({}, "resource-limit", "there is not enough memory to read this file");
    } catch (const std::exception& e) {
        // Whoever embeds the reader gets findings and no exception, even of a fault of the reader itself.
        findings.error({}, "internal", std::string("this should not happen: ") + e.what());
    }
}

}   // namespace livens::inline io_internal
