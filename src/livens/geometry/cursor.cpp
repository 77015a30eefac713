// SPDX-License-Identifier: BSD-3-Clause
// One reader of bytes for all formats of meshes: words, lines, numbers and raw values, each checked against
// what the file still holds. Counts of a file are believed only when its bytes suffice for them, so that no
// header can make livens reserve memory for what is not there.
#include <charconv>
#include <cmath>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/geometry/detail/cursor.h"

namespace livens {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f'; }

/// A word of a file in a message: short, and nothing that steers a terminal.
std::string shown(std::string_view word)
{
    std::string text;
    for (const char c : word.substr(0, 30)) text += c >= ' ' && c <= '~' ? c : '?';
    return "'" + text + (word.size() > 30 ? "...'" : "'");
}

}   // namespace

void Cursor::fail(const std::string& message) const
{
    std::string place = *name_;
    if (is_binary_) {
        place += ", byte " + std::to_string(start_);
    } else {
        const auto lines =
            std::count(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(start_), '\n');
        place += ":" + std::to_string(lines + 1);
    }
    throw InputError({"mesh-format", "", place + ": " + message, "", "", "", ""});
}

void Cursor::skip_blanks()
{
    while (at_ < bytes_.size() && is_blank(bytes_[at_])) ++at_;
}

bool Cursor::is_at_end()
{
    skip_blanks();
    return at_ == bytes_.size();
}

bool Cursor::is_at_line_end()
{
    while (at_ < bytes_.size() && bytes_[at_] != '\n' && is_blank(bytes_[at_])) ++at_;
    return at_ == bytes_.size() || bytes_[at_] == '\n';
}

std::string_view Cursor::word()
{
    skip_blanks();
    start_ = at_;
    while (at_ < bytes_.size() && !is_blank(bytes_[at_])) ++at_;
    return bytes_.substr(start_, at_ - start_);
}

std::string_view Cursor::line()
{
    start_ = at_;
    const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
    std::string_view text = bytes_.substr(at_, end - at_);
    at_ = std::min(end + 1, bytes_.size());
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

void Cursor::expect(std::string_view what)
{
    const std::string_view found = word();
    if (found == what) return;
    fail("'" + std::string(what) + "' is expected, not " + (found.empty() ? "the end" : shown(found)));
}

double Cursor::to_number(std::string_view text, const char* what) const
{
    double value = 0;
    const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
    // from_chars knows no sign "+", which some programs write, and does not look at the locale.
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool is_read = error == std::errc{} && end == digits.data() + digits.size() && !text.empty();
    if (!is_read || !std::isfinite(value))
        fail(std::string(what) + " must be a finite number, not " +
             (text.empty() ? "the end of the file" : shown(text)));
    return value;
}

std::int64_t Cursor::to_integer(std::string_view text, std::int64_t low, std::int64_t high,
                                const char* what) const
{
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || text.empty())
        fail(std::string(what) + " must be a whole number, not " +
             (text.empty() ? "the end of the file" : shown(text)));
    if (value < low || value > high)
        fail(std::string(what) + " is " + std::to_string(value) + ", not " + std::to_string(low) + " to " +
             std::to_string(high));
    return value;
}

void Cursor::require(std::uint64_t count, std::uint64_t bytes_each, const char* what) const
{
    // Divided instead of multiplied: the product of two numbers of a file may overflow.
    if (count == 0 || count <= left() / bytes_each) return;
    fail("the file ends before its " + std::string(what) + ": " + std::to_string(count) + " of at least " +
         std::to_string(bytes_each) + " bytes are announced, " + std::to_string(left()) + " bytes are left");
}

std::string_view Cursor::raw_bytes(std::uint64_t n)
{
    require(n, 1, "data");
    start_ = at_;
    at_ += n;
    return bytes_.substr(start_, n);
}

void Cursor::skip_behind(std::string_view what)
{
    const std::size_t found = bytes_.find(what, at_);
    if (found == std::string_view::npos) fail("'" + std::string(what) + "' is missing");
    at_ = found + what.size();
}

}   // namespace livens
