// SPDX-License-Identifier: BSD-3-Clause
// Numbers as messages and files spell them.
#pragma once

#include <charconv>
#include <string>

namespace [[gnu::visibility("default")]] livens {

/// The shortest text that reads back as the same double: "0.1", "1e-12", "nan". Independent of the locale.
inline std::string to_text(double value)
{
    char buffer[32];
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

/// To so many significant digits, for figures that were measured.
inline std::string to_text(double value, int digits)
{
    char buffer[64];
    constexpr auto general = std::chars_format::general;
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value, general, digits).ptr};
}

}   // namespace livens
