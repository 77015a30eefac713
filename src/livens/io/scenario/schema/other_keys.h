// SPDX-License-Identifier: BSD-3-Clause
// Keys that users of other programs write, and what to type instead.
#pragma once

#include <string>
#include <string_view>

#include "livens/io/scenario/schema/schema.h"

namespace livens::inline io_internal {

struct KeyAdvice {
    std::string_view meant;   ///< the key of this table that it stands for; empty: none does
    std::string help;         ///< empty: nothing is known of it
};

/// Of a key that the table does not have for this kind (an index, or any_kind); `name` is that of the part.
KeyAdvice instead_of_key(const Table& table, int kind, std::string_view key, std::string_view name);

/// "timeStep", "time_step" and "Time-Step" alike: "timestep".
std::string without_case(std::string_view word);

}   // namespace livens::inline io_internal
