// SPDX-License-Identifier: BSD-3-Clause
// JSON is written and checked here without a library: results hold options of runs and travel into web pages,
// so what is written must be valid whatever names a scenario has. Strings are checked as UTF-8.
#include "livens/io/json.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace livens {

namespace {

void append_unit(std::string& out, std::uint32_t unit)
{
    static constexpr char digits[] = "0123456789abcdef";
    out += "\\u";
    for (int shift = 12; shift >= 0; shift -= 4) out += digits[unit >> shift & 15];
}

void append_escaped(std::string& out, std::string_view text)
{
    out += '"';
    while (!text.empty()) {
        const auto is_plain = [](char c) { return c >= ' ' && c < 0x7f && c != '"' && c != '\\'; };
        const std::size_t n_plain =
            static_cast<std::size_t>(std::ranges::find_if_not(text, is_plain) - text.begin());
        out.append(text.substr(0, n_plain));
        text.remove_prefix(n_plain);
        if (text.empty()) break;
        const int length = utf8_length(text);
        const unsigned char c = static_cast<unsigned char>(text.front());
        if (length == 0) {
            // A byte that is no UTF-8 becomes the replacement character: output stays valid whatever a name
            // holds.
            out += "\\ufffd";
        } else if (c == '"' || c == '\\') {
            out += '\\';
            out += static_cast<char>(c);
        } else if (c == '\n') {
            out += "\\n";
        } else if (c == '\t') {
            out += "\\t";
        } else if (const std::uint32_t code = code_point(text); !is_invisible(code)) {
            out.append(text.substr(0, length));
        } else if (code < 0x10000) {
            append_unit(out, code);
        } else {
            // Beyond the basic plane JSON escapes take two units of UTF-16.
            append_unit(out, 0xd800 + ((code - 0x10000) >> 10));
            append_unit(out, 0xdc00 + (code & 0x3ff));
        }
        text.remove_prefix(length > 0 ? length : 1);
    }
    out += '"';
}

/// Goes through one JSON value; each part says whether it was there.
class JsonReader {
public:
    explicit JsonReader(std::string_view text) : rest_(text) {}

    bool value(int depth)
    {
        skip_blanks();
        // A bound on the depth: brackets of a foreign file must not exhaust the stack.
        if (depth > 64 || rest_.empty()) return false;
        const char c = rest_.front();
        if (c == '{') return list('}', [&] { return text() && token(":") && value(depth + 1); });
        if (c == '[') return list(']', [&] { return value(depth + 1); });
        if (c == '"') return text();
        return word("true") || word("false") || word("null") || number();
    }
    bool at_end()
    {
        skip_blanks();
        return rest_.empty();
    }

private:
    void skip_blanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size())); }
    bool word(std::string_view what)
    {
        if (!rest_.starts_with(what)) return false;
        rest_.remove_prefix(what.size());
        return true;
    }
    bool token(std::string_view what)
    {
        skip_blanks();
        return word(what);
    }
    template <class Item>
    bool list(char end, Item item)
    {
        rest_.remove_prefix(1);
        const std::string_view last(&end, 1);
        if (token(last)) return true;
        do
            if (!item()) return false;
        while (token(","));
        return token(last);
    }
    bool text()
    {
        if (!token("\"")) return false;
        while (!rest_.empty() && rest_.front() != '"') {
            const int length = utf8_length(rest_);
            if (length == 0 || static_cast<unsigned char>(rest_.front()) < 0x20) return false;
            if (rest_.front() != '\\')
                rest_.remove_prefix(static_cast<std::size_t>(length));
            else if (!escape())
                return false;
        }
        return word("\"");
    }
    bool escape()
    {
        constexpr std::string_view hexadecimal = "0123456789abcdefABCDEF";
        rest_.remove_prefix(1);
        if (word("u")) {
            const bool is_whole = rest_.size() >= 4 &&
                                  rest_.substr(0, 4).find_first_not_of(hexadecimal) == std::string_view::npos;
            rest_.remove_prefix(is_whole ? 4 : 0);
            return is_whole;
        }
        if (rest_.empty() || std::string_view("\"\\/bfnrt").find(rest_.front()) == std::string_view::npos)
            return false;
        rest_.remove_prefix(1);
        return true;
    }
    bool digits()
    {
        const std::size_t n = std::min(rest_.find_first_not_of("0123456789"), rest_.size());
        rest_.remove_prefix(n);
        return n > 0;
    }
    bool number()
    {
        word("-");
        // JSON allows no leading zeros: after a zero only a point or an exponent may follow.
        if (!word("0") && !digits()) return false;
        if (word(".") && !digits()) return false;
        if (!word("e") && !word("E")) return true;
        if (!word("+")) word("-");
        return digits();
    }

    std::string_view rest_;
};

}   // namespace

bool is_json(std::string_view text)
{
    JsonReader reader(text);
    return reader.value(0) && reader.at_end();
}

/// A character has one sequence of bytes alone: overlong ones, surrogates and code points beyond U+10FFFF
/// have none.
int utf8_length(std::string_view text)
{
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char first = byte(0);
    if (first < 0x80) return 1;
    const int length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
    // Bytes c0, c1 and f5 to ff begin no character (RFC 3629).
    if (first < 0xc2 || first > 0xf4 || text.size() < static_cast<std::size_t>(length)) return 0;
    for (int i = 1; i < length; ++i)
        if ((byte(i) & 0xc0) != 0x80) return 0;
    if (first == 0xe0 && byte(1) < 0xa0) return 0;    // overlong
    if (first == 0xed && byte(1) >= 0xa0) return 0;   // surrogate
    if (first == 0xf0 && byte(1) < 0x90) return 0;    // overlong
    if (first == 0xf4 && byte(1) >= 0x90) return 0;   // beyond U+10FFFF
    return length;
}

std::uint32_t code_point(std::string_view text)
{
    const int length = utf8_length(text);
    const auto byte = [&](int i) { return static_cast<unsigned char>(text[i]); };
    if (length <= 1) return length == 0 ? 0xfffd : byte(0);
    std::uint32_t code = byte(0) & (0xff >> (length + 1));
    for (int i = 1; i < length; ++i) code = code << 6 | (byte(i) & 0x3f);
    return code;
}

bool is_invisible(std::uint32_t code)
{
    constexpr std::uint32_t ranges[][2] = {
        {0, 0x1f},          {0x7f, 0x9f},       {0xad, 0xad},       {0x600, 0x605},     {0x61c, 0x61c},
        {0x6dd, 0x6dd},     {0x70f, 0x70f},     {0x890, 0x891},     {0x8e2, 0x8e2},     {0x180e, 0x180e},
        {0x200b, 0x200b},   {0x200e, 0x200f},   {0x2028, 0x202e},   {0x2060, 0x206f},   {0xfeff, 0xfeff},
        {0xfff9, 0xfffb},   {0x110bd, 0x110bd}, {0x110cd, 0x110cd}, {0x13430, 0x1343f}, {0x1bca0, 0x1bca3},
        {0x1d173, 0x1d17a}, {0xe0000, 0xe007f}};
    return std::ranges::any_of(ranges, [&](const auto& r) { return code >= r[0] && code <= r[1]; });
}

void JsonWriter::new_line()
{
    if (indent_ == 0) return;
    text_ += '\n';
    text_.append(static_cast<std::size_t>(indent_) * levels_.size(), ' ');
}

void JsonWriter::before_value()
{
    if (levels_.empty()) {
        assert(text_.empty() && "one value only");
        return;
    }
    Level& level = levels_.back();
    assert(level.is_object == has_key_ && "values of an object need a key, those of an array have none");
    if (!level.is_object) {
        if (!level.is_empty) text_ += indent_ == 0 ? ", " : ",";
        new_line();
    }
    level.is_empty = false;
    has_key_ = false;
}

JsonWriter& JsonWriter::key(std::string_view name)
{
    assert(!levels_.empty() && levels_.back().is_object && !has_key_);
    if (!levels_.back().is_empty) text_ += indent_ == 0 ? ", " : ",";
    new_line();
    append_escaped(text_, name);
    text_ += ": ";
    has_key_ = true;
    return *this;
}

JsonWriter& JsonWriter::begin_object()
{
    before_value();
    text_ += '{';
    levels_.push_back({true});
    return *this;
}

JsonWriter& JsonWriter::begin_array()
{
    before_value();
    text_ += '[';
    levels_.push_back({false});
    return *this;
}

JsonWriter& JsonWriter::end(char bracket)
{
    assert(!levels_.empty() && levels_.back().is_object == (bracket == '}') && !has_key_);
    const bool is_empty = levels_.back().is_empty;
    levels_.pop_back();
    if (!is_empty) new_line();
    text_ += bracket;
    return *this;
}

JsonWriter& JsonWriter::end_object() { return end('}'); }
JsonWriter& JsonWriter::end_array() { return end(']'); }

JsonWriter& JsonWriter::value(std::string_view text)
{
    before_value();
    append_escaped(text_, text);
    return *this;
}

// JSON knows no nan and no infinity; null stands for both.
JsonWriter& JsonWriter::value(double number) { return std::isfinite(number) ? raw(to_text(number)) : null(); }

JsonWriter& JsonWriter::value(std::span<const double> numbers)
{
    before_value();
    text_ += '[';
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (i > 0) text_ += ", ";
        text_ += std::isfinite(numbers[i]) ? to_text(numbers[i]) : "null";
    }
    text_ += ']';
    return *this;
}

JsonWriter& JsonWriter::raw(std::string_view json)
{
    before_value();
    text_ += json;
    return *this;
}

}   // namespace livens
