// SPDX-License-Identifier: BSD-3-Clause
// What the motion decides: [[event]], and conditions in the place of instants.
#pragma once

#include "livens/io/scenario/builder.h"

namespace livens::inline io_internal {

/// What events set, before them: `set` of [[event]]. Controllers must be there. Reports all it finds.
void read_changes(Builder& builder);

/// `from` and `until` of joints, drives and loads that are conditions, and [[event]]; of the run also `until`
/// of [time]. All that conditions name must be there. Reports all it finds.
void read_events(Builder& builder, bool is_run);

}   // namespace livens::inline io_internal
