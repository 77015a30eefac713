// The only source that includes toml++: it compiles slowly, and its errors and positions are translated here.
#include <algorithm>
#include <cctype>
#include <tuple>

#include "livens/io/detail/document.h"

namespace livens {

/// Thrown by the parser's assertions: version 3.3 has some that a file can break, "[#]" is one. Aborting is
/// no answer to a file, nor is going on as if they held.
struct ParserFault {};

[[noreturn]] static void stop_parser() { throw ParserFault(); }

}   // namespace livens

// Syntax errors as a value, not an exception; decimal numbers by from_chars: correctly rounded in every
// locale. Without assertions (NDEBUG) toml++ takes TOML_ASSERT away again and lets Clang assume the
// condition.
#pragma push_macro("NDEBUG")
#undef NDEBUG
#define TOML_ASSERT(condition) (static_cast<bool>(condition) ? void() : ::livens::stop_parser())
#define TOML_EXCEPTIONS 0
#define TOML_FLOAT_CHARCONV 1
#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

namespace livens {

namespace {

Place place_of(const toml::source_region& region)
{
    Place place{static_cast<int>(region.begin.line), static_cast<int>(region.begin.column), 1};
    if (region.end.line == region.begin.line && region.end.column > region.begin.column)
        place.length = static_cast<int>(region.end.column - region.begin.column);
    return place;
}

Node convert(const toml::node& node);

Node convert_table(const toml::table& table)
{
    Node result;
    result.content = std::make_unique<NodeContent>();
    std::vector<Entry>& entries = result.content->entries;
    for (const auto& [key, value] : table)
        entries.push_back({std::string(key.str()), place_of(key.source()), convert(value)});
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
        return std::tie(a.place.line, a.place.column) < std::tie(b.place.line, b.place.column);
    });
    return result;
}

Node convert_content(const toml::node& node)
{
    Node result;
    if (const toml::value<bool>* truth = node.as_boolean()) {
        result.kind = Node::Kind::truth;
        result.number = **truth ? 1 : 0;
    } else if (const toml::value<std::int64_t>* integer = node.as_integer()) {
        result.kind = Node::Kind::integer;
        result.number = static_cast<double>(**integer);
    } else if (const toml::value<double>* number = node.as_floating_point()) {
        result.kind = Node::Kind::number;
        result.number = **number;
    } else if (const toml::value<std::string>* text = node.as_string()) {
        result.kind = Node::Kind::text;
        result.content = std::make_unique<NodeContent>();
        result.content->text = **text;
    } else if (const toml::array* array = node.as_array()) {
        result.kind = Node::Kind::array;
        result.content = std::make_unique<NodeContent>();
        result.content->items.reserve(array->size());
        for (const toml::node& item : *array) result.content->items.push_back(convert(item));
    } else if (const toml::table* table = node.as_table()) {
        result = convert_table(*table);
    } else {
        result.kind = Node::Kind::date;
    }
    return result;
}

Node convert(const toml::node& node)
{
    Node result = convert_content(node);
    result.place = place_of(node.source());
    return result;
}

std::string_view line_of(std::string_view text, int line)
{
    if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);
    for (int i = 1; i < line; ++i) {
        const std::size_t end = text.find('\n');
        if (end == std::string_view::npos) return {};
        text.remove_prefix(end + 1);
    }
    return text.substr(0, text.find('\n'));
}

/// The word inside the last pair of single quotes of a parser's message.
std::string_view quoted(std::string_view description)
{
    const std::size_t end = description.rfind('\'');
    if (end == std::string_view::npos || end == 0) return {};
    const std::size_t begin = description.rfind('\'', end - 1);
    return begin == std::string_view::npos ? std::string_view{}
                                           : description.substr(begin + 1, end - begin - 1);
}

/// toml++ points behind `key =`; the key itself is wanted.
Place place_of_key_before(const Place& place, std::string_view line)
{
    const auto is_in_key = [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.';
    };
    // Columns count characters; a key before which others than ASCII stand is found at its value.
    if (std::any_of(line.begin(), line.end(), [](unsigned char c) { return c >= 0x80; })) return place;
    int end = std::min(place.column - 1, static_cast<int>(line.size()));
    const auto before = [&](int i) { return line[static_cast<std::size_t>(i - 1)]; };
    while (end > 0 && (before(end) == ' ' || before(end) == '\t')) --end;
    if (end == 0 || before(end) != '=') return place;
    for (--end; end > 0 && (before(end) == ' ' || before(end) == '\t');) --end;
    int begin = end;
    while (begin > 0 && is_in_key(static_cast<unsigned char>(before(begin)))) --begin;
    return begin < end ? Place{place.line, begin + 1, end - begin} : place;
}

/// What a person probably meant where a value is followed by something.
std::string help_after_value(std::string_view line, const Place& place, std::string_view seen)
{
    const std::size_t column = static_cast<std::size_t>(std::max(1, place.column)) - 1;
    const std::string_view before = line.substr(0, std::min(column, line.size()));
    const std::size_t last = before.find_last_not_of(" \t");
    if (last == std::string_view::npos || std::isdigit(static_cast<unsigned char>(before[last])) == 0)
        return {};
    if (seen == ",") return "decimal numbers have a point, not a comma";
    return "a number with a unit stands in quotes: \"5 mm\"";
}

void report(const toml::parse_error& error, std::string_view text, Findings& findings)
{
    const std::string_view description = error.description();
    const auto says = [&](std::string_view words) {
        return description.find(words) != std::string_view::npos;
    };
    const std::string_view word = quoted(description);
    Place place = place_of(error.source());
    const std::string_view line = line_of(text, place.line);
    if (says("cannot redefine")) {
        if (!says("table header")) place = place_of_key_before(place, line);
        findings.error(
            place, "duplicate-key", "'" + std::string(word) + "' is given a second time",
            {"a key may be given once in its table",
             says("array-of-tables") ? "write [[" + std::string(word) + "]] with two brackets everywhere"
                                     : ""});
    } else if (says("not representable")) {
        const int width = static_cast<int>(word.size());
        if (place.column > width) place = {place.line, place.column - width, width};
        findings.error(place, "number-overflow",
                       "the number " + std::string(word) + " does not fit into 64 bits");
    } else {
        constexpr std::string_view prefix = "Error while ";
        std::string message(
            description.substr(description.substr(0, prefix.size()) == prefix ? prefix.size() : 0));
        const std::string help = says("expected a comment or whitespace")
                                     ? help_after_value(line, place, word)
                                     : "";
        findings.error(place, "toml-syntax", std::move(message),
                       {"reading stops at the first syntax error", help});
    }
}

/// Where the parser met something it had not reckoned with: a header that begins with what is no key.
void report_fault(std::string_view text, Findings& findings)
{
    int number = 1;
    for (std::size_t begin = 0; begin < text.size(); ++number) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::string_view line = text.substr(begin, end - begin);
        const std::size_t bracket = line.find_first_not_of(" \t");
        const std::size_t key = bracket == std::string_view::npos ? bracket
                                                                  : line.find_first_not_of("[ \t", bracket);
        const bool is_header = bracket != std::string_view::npos && line[bracket] == '[';
        const bool has_key = key != std::string_view::npos &&
                             (std::isalnum(static_cast<unsigned char>(line[key])) != 0 ||
                              std::string_view("_-\"']").find(line[key]) != std::string_view::npos);
        if (is_header && !has_key) {
            findings.error({number, static_cast<int>(bracket) + 1, 1}, "toml-syntax",
                           "this table header names no table",
                           {"reading stops at the first syntax error", ""});
            return;
        }
        begin = end + 1;
    }
    findings.error({}, "toml-syntax", "this is not TOML, in a way that the parser cannot explain");
}

}   // namespace

const Node* Node::find(std::string_view key) const
{
    for (const Entry& entry : entries())
        if (entry.key == key) return &entry.value;
    return nullptr;
}

std::optional<Node> parse_toml(std::string_view text, Findings& findings)
{
    try {
        const toml::parse_result result = toml::parse(text);
        if (result) return convert(result.table());
        report(result.error(), text, findings);
    } catch (const ParserFault&) {
        report_fault(text, findings);
    }
    return std::nullopt;
}

}   // namespace livens
