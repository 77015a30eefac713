// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace [[gnu::visibility("default")]] livens {

inline constexpr const char* version = "0.3.0";

}   // namespace livens
