// SPDX-License-Identifier: BSD-3-Clause
// A file in which parameters have the values that were set: so a run holds a text from which it can be made
// again. Everything else stays as it stands, comments as well.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "livens/base/text.h"
#include "livens/io/scenario/text/parameters.h"

namespace livens::inline io_internal {

namespace {

/// Of a place that counts characters.
std::size_t byte_at(std::string_view text, const SourceLocation& place)
{
    std::size_t at = text.starts_with("\xef\xbb\xbf") ? 3 : 0;   // byte order mark
    for (int line = 1; line < place.line && at < text.size(); ++line)
        at = std::min(text.find('\n', at), text.size() - 1) + 1;
    for (int column = 1; column < place.column && at < text.size(); ++column) do
            ++at;
        while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80);
    return at;
}

/// Behind the number or string on one line that begins there.
/// Of a run of quotes the last three close a string between triple ones: it may end with quotes of its own.
std::size_t end_of_value(std::string_view text, std::size_t at)
{
    const char quote = text[at];
    if (quote != '"' && quote != '\'') return std::min(text.find_first_of(",}# \t\r\n", at), text.size());
    const std::string_view triple = quote == '"' ? "\"\"\"" : "'''";
    const bool is_triple = text.substr(at, 3) == triple;
    for (std::size_t i = at + (is_triple ? 3 : 1); i < text.size(); ++i) {
        if (text[i] == '\\' && quote == '"')
            ++i;
        else if (is_triple ? text.substr(i, 3) == triple && text.substr(i + 1, 3) != triple
                           : text[i] == quote)
            return i + (is_triple ? 3 : 1);
    }
    return text.size();
}

/// What was set: a number as such, with the unit of the file's own value; everything else as a string.
std::string in_toml(const Parameters::One& one)
{
    const std::string& given = one.set_by.text;
    double number = 0;
    const char* const end = given.data() + given.size();
    const auto [rest, error] = std::from_chars(given.data(), end, number);
    const bool is_number = error == std::errc() && rest == end;
    const std::string unit = si_unit_of(one.amount);
    std::string reason;
    if (one.is_in_unit_of_file && parse_unit(unit, reason))
        return '"' + to_text(one.amount.value) + " " + unit + '"';
    if (is_number) return to_text(number);
    std::string text = "\"";
    for (const char c : given) text += (c == '"' || c == '\\' ? "\\" : "") + std::string(1, c);
    return text + "\"";
}

}   // namespace

std::string with_values_at(std::string text, std::span<const std::pair<SourceLocation, std::string>> values)
{
    // From the end on, so that places before stay where they are.
    for (auto one = values.rbegin(); one != values.rend(); ++one) {
        const std::size_t begin = byte_at(text, one->first);
        if (begin < text.size()) text.replace(begin, end_of_value(text, begin) - begin, one->second);
    }
    return text;
}

std::string with_set_values(std::string text, const Parameters& parameters)
{
    std::vector<std::pair<SourceLocation, std::string>> set;
    for (const Parameters::One& one : parameters.all())
        if (one.is_set && !one.set_by.text.empty()) set.emplace_back(one.place, in_toml(one));
    return with_values_at(std::move(text), set);
}

}   // namespace livens::inline io_internal
