// SPDX-License-Identifier: BSD-3-Clause
// What users of other programs write, and what it is called here.
#pragma once

#include <string>
#include <string_view>

#include "livens/io/scenario/schema/schema.h"
#include "livens/io/scenario/text/document.h"

namespace livens::inline io_internal {

/// Help for a word that is none of `choices`; empty: nothing is known of it.
std::string in_other_words(std::string_view word, const Words& choices);
/// Help for a key that the kind does not have; empty, likewise.
std::string instead_of_key(std::string_view kind, std::string_view key);

/// The line to write for the kind that is not stated, if only one has all keys of the node; else empty.
std::string type_told_by_keys(const Node& node, const Table& table);

}   // namespace livens::inline io_internal
