// The pages of all codes.
#pragma once

#include <string>

namespace livens {

/// docs/diagnostics.md; a test compares.
std::string diagnostics_markdown();

}   // namespace livens
