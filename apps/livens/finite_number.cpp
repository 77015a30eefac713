// SPDX-License-Identifier: BSD-3-Clause
#include "finite_number.h"

#include <charconv>
#include <cmath>

#include "failure.h"

namespace livens::program {

double finite_number(const std::string& text, std::string_view option, std::string_view what)
{
    std::string_view digits = text;
    if (digits.starts_with('+')) digits.remove_prefix(1);
    double number = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(number))
        throw failure(exit_usage,
                      std::string(option) + " wants " + std::string(what) + ", not '" + text + "'");
    return number;
}

}   // namespace livens::program
