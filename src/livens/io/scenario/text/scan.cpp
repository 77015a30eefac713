// SPDX-License-Identifier: BSD-3-Clause
// The first look at a text, before the parser: bytes that are none of UTF-8 text, the depth of nesting and
// the number of values. The parser recurses and allocates by these, so a hostile file must be refused before
// it (docs/program.md, Untrusted files).
#include <algorithm>

#include "livens/io/json.h"
#include "livens/io/scenario.h"
#include "livens/io/scenario/text/document.h"

namespace livens::inline io_internal {

namespace {

/// Walks a text character by character and knows line and column.
class Cursor {
public:
    explicit Cursor(std::string_view text) : rest_(text)
    {
        if (rest_.substr(0, 3) == "\xef\xbb\xbf") rest_.remove_prefix(3);   // byte order mark
    }

    bool at_end() const { return rest_.empty(); }
    char peek() const { return rest_.front(); }
    bool starts_with(std::string_view s) const { return rest_.substr(0, s.size()) == s; }
    SourceLocation place() const { return {line_, column_, 1}; }
    int length() const { return utf8_length(rest_); }

    void next()
    {
        const bool new_line = rest_.front() == '\n';
        rest_.remove_prefix(std::max(1, length()));
        line_ += new_line ? 1 : 0;
        column_ = new_line ? 1 : column_ + 1;
    }
    void skip(int n)
    {
        for (int i = 0; i < n && !at_end(); ++i) next();
    }

private:
    std::string_view rest_;
    int line_ = 1;
    int column_ = 1;
};

bool scan_characters(std::string_view text, Findings& findings)
{
    constexpr std::size_t head = 4096;
    // Zeros in the first block are the mark of a binary file; one sentence says more than a byte's place.
    if (text.substr(0, head).find('\0') != std::string_view::npos)
        return findings.error({1, 1, 1}, "not-text", "this is a binary file, not a scenario",
                              {"", "scenarios are TOML"});
    for (Cursor c(text); !c.at_end(); c.next()) {
        const unsigned char byte = static_cast<unsigned char>(c.peek());
        if (c.length() == 0)
            return findings.error(c.place(), "not-text", "this byte is not UTF-8",
                                  {"TOML files are UTF-8 text", "save the file with that encoding"});
        if ((byte < 0x20 && byte != '\n' && byte != '\r' && byte != '\t') || byte == 0x7f)
            return findings.error(c.place(), "not-text", "control characters are not allowed in TOML",
                                  {"", "in a string write it as \\u00.."});
    }
    return true;
}

/// Moves behind the string that starts here, or to the end of what cannot be one.
void skip_string(Cursor& c)
{
    const char quote = c.peek();
    const std::string_view triple = quote == '"' ? "\"\"\"" : "'''";
    const bool many_lines = c.starts_with(triple);
    c.skip(many_lines ? 3 : 1);
    while (!c.at_end()) {
        if (c.peek() == '\\' && quote == '"') {
            // An escape is passed as a whole: its second character may be a quote or a backslash.
            c.skip(2);
        } else if (many_lines && c.starts_with(triple)) {
            c.skip(3);
            while (!c.at_end() && c.peek() == quote) c.next();   // """"a"""" ends with a quote of its own
            return;
        } else if (!many_lines && (c.peek() == quote || c.peek() == '\n')) {
            c.next();
            return;
        } else {
            c.next();
        }
    }
}

/// How deep the tree of values gets where the cursor stands: brackets, and the parts of dotted keys before
/// them.
class Depth {
public:
    void see(char c)
    {
        if (c == '.') ++dots_;
        if (c == '[' || c == '{') {
            levels_.push_back(1 + key_dots_);
            open_ += levels_.back();
            key_dots_ = 0;
        }
        if ((c == ']' || c == '}') && !levels_.empty()) {
            open_ -= levels_.back();
            levels_.pop_back();
        }
        if (c == '=') key_dots_ = dots_;
        if (c == ',' || c == '\n') key_dots_ = 0;
        if (c == '[' || c == '{' || c == ',' || c == '=' || c == '\n') dots_ = 0;
    }

    /// The dots of a number count, too: two levels at most.
    bool is_excessive() const { return open_ + dots_ > max_scenario_depth; }

private:
    std::vector<int> levels_;   ///< of each open bracket
    int open_ = 0;              ///< their sum
    int dots_ = 0;              ///< of the word in hand
    int key_dots_ = 0;          ///< of the key whose value comes next
};

bool scan_structure(std::string_view text, Findings& findings)
{
    int values = 0;
    Depth depth;
    for (Cursor c(text); !c.at_end();) {
        const char byte = c.peek();
        if (byte == '"' || byte == '\'') {
            skip_string(c);
            continue;
        }
        if (byte == '#') {
            // Brackets in comments and strings open nothing.
            while (!c.at_end() && c.peek() != '\n') c.next();
            continue;
        }
        depth.see(byte);
        // Every value follows one of these characters, so their number bounds that of values from above.
        if (byte == '[' || byte == '{' || byte == ',' || byte == '=') ++values;
        if (depth.is_excessive())
            return findings.error(c.place(), "too-deep",
                                  "values are nested deeper than " + std::to_string(max_scenario_depth) +
                                      " levels");
        if (values > max_scenario_values)
            return findings.error(c.place(), "resource-limit",
                                  "the file has more than " + std::to_string(max_scenario_values) +
                                      " values");
        c.next();
    }
    return true;
}

}   // namespace

bool scan(std::string_view text, Findings& findings)
{
    return scan_characters(text, findings) && scan_structure(text, findings);
}

std::string_view describe(Node::Kind kind)
{
    switch (kind) {
    case Node::Kind::truth:
        return "true or false";
    case Node::Kind::integer:
        return "a whole number";
    case Node::Kind::number:
        return "a number";
    case Node::Kind::text:
        return "a string";
    case Node::Kind::array:
        return "a list";
    case Node::Kind::table:
        return "a table";
    case Node::Kind::date:
        return "a date or time";
    }
    return "";
}

}   // namespace livens::inline io_internal
