// SPDX-License-Identifier: BSD-3-Clause
// Writing JSON: the one writer of everything that livens prints for machines.
#pragma once

#include <concepts>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "livens/base/text.h"

namespace [[gnu::visibility("default")]] livens {

/// Appends one JSON value (RFC 8259) to a text. Calls must nest properly and every value of an object needs
/// its key: both are asserted.
///
/// Numbers are the shortest text that reads back to the same double; nan and infinities, which JSON cannot
/// say, are null. Strings are escaped, all that is_invisible() too; bytes that are not UTF-8 become U+FFFD,
/// so that the result is always valid.
class JsonWriter {
public:
    /// indent 0: everything on one line; else that many spaces a level (arrays of numbers stay on one line).
    explicit JsonWriter(int indent = 0) : indent_(indent) {}

    JsonWriter& begin_object();
    JsonWriter& end_object();
    JsonWriter& begin_array();
    JsonWriter& end_array();
    JsonWriter& key(std::string_view name);

    JsonWriter& value(std::string_view text);
    JsonWriter& value(const char* text) { return value(std::string_view(text)); }
    JsonWriter& value(const std::string& text) { return value(std::string_view(text)); }
    JsonWriter& value(double number);
    JsonWriter& value(std::same_as<bool> auto truth) { return raw(truth ? "true" : "false"); }
    template <std::integral Integer>
    requires(!std::same_as<Integer, bool>) JsonWriter& value(Integer number)
    {
        return raw(std::to_string(number));
    }
    JsonWriter& value(std::span<const double> numbers);   ///< an array on one line
    JsonWriter& null() { return raw("null"); }
    /// A value that is JSON already.
    JsonWriter& raw(std::string_view json);

    /// key() and value() in one.
    template <class Value>
    JsonWriter& member(std::string_view name, const Value& v)
    {
        key(name);
        return value(v);
    }

    /// What has been written so far.
    const std::string& text() const { return text_; }

private:
    struct Level {
        bool is_object;
        bool is_empty = true;
    };

    void before_value();
    void new_line();
    JsonWriter& end(char bracket);

    std::string text_;
    std::vector<Level> levels_;
    int indent_ = 0;
    bool has_key_ = false;
};

/// Whether a text is one JSON value (RFC 8259), nested at most 64 deep.
bool is_json(std::string_view text);

/// Length in bytes of the UTF-8 sequence at the start of `text`, 0 if there is none (overlong forms,
/// surrogates and code points above U+10FFFF are none). `text` is not empty.
int utf8_length(std::string_view text);

/// Of the sequence at the start of `text`; U+FFFD for a byte that is none.
std::uint32_t code_point(std::string_view text);

/// What a terminal obeys or an eye does not see: control and format characters (Unicode's Cc and Cf, but for
/// the joiners U+200C and U+200D, which words and signs are made with), separators of lines and paragraphs.
bool is_invisible(std::uint32_t code);

}   // namespace gnu::visibility("default")]]livens
