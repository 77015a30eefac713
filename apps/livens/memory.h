// SPDX-License-Identifier: BSD-3-Clause
// Whether the machine has the memory that a run will need.
#pragma once

#include <string>
#include <vector>

#include "livens/io/scenario.h"

namespace livens::program {

/// Bytes that this process may still take: by the machine's free memory and swap, by its own limits (ulimit
/// -v) and by those of the group it runs in. Infinite where nobody tells.
double memory_left();

/// "284 MB", "1.2 GB".
std::string bytes_in_words(double bytes);

/// Throws what ends in exit code 5 if a run, or the largest of those that are solved at a time, would need
/// more, before anything is solved.
void check_memory(const std::vector<const Scenario*>& scenarios, int at_a_time = 1);

}   // namespace livens::program
