#pragma once

namespace livens {

inline constexpr const char* version = "0.1.0";

}   // namespace livens
