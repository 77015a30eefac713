// SPDX-License-Identifier: BSD-3-Clause
// What users of other programs write, and what it is called here.
#pragma once

#include <string>
#include <string_view>

#include "livens/io/scenario/schema/schema.h"
#include "livens/io/scenario/text/document.h"

namespace livens::inline io_internal {

/// The choice that a word means which is none of `choices`, and with what; empty: nothing is known of it.
std::string_view in_other_words(std::string_view word, const Words& choices, std::string_view& with);
/// The same as help: livens calls it "revolute".
std::string in_other_words(std::string_view word, const Words& choices);

/// The line to write for the kind that is not stated, if only one has all keys of the node; else empty.
std::string type_told_by_keys(const Node& node, const Table& table);

}   // namespace livens::inline io_internal
