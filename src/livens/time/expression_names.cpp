// SPDX-License-Identifier: BSD-3-Clause
#include "livens/time/detail/expression_names.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

namespace livens::inline time_internal {

namespace {

using Operation = Expression::Operation;

constexpr std::array functions{
    Function{"sin", Operation::sine, 1},          Function{"cos", Operation::cosine, 1},
    Function{"tan", Operation::tangent, 1},       Function{"tanh", Operation::hyperbolic_tangent, 1},
    Function{"exp", Operation::exponential, 1},   Function{"log", Operation::logarithm, 1},
    Function{"sqrt", Operation::root, 1},         Function{"abs", Operation::absolute, 1},
    Function{"sign", Operation::sign, 1},         Function{"floor", Operation::floor, 1},
    Function{"atan2", Operation::arc_tangent, 2}, Function{"min", Operation::least, 2},
    Function{"max", Operation::greatest, 2}};

// Functions that are made of those above.
constexpr std::array<std::string_view, 6> composed{"asin", "acos", "atan", "sinh", "cosh", "step"};

// Names that other programs have for the same: a refusal proposes the one that is known here.
constexpr std::array<std::pair<std::string_view, std::string_view>, 32> other_names{
    {{"time", "t"},
     {"TIME", "t"},
     {"T", "t"},
     {"Pi", "pi"},
     {"PI", "pi"},
     {"ln", "log"},
     {"arctan2", "atan2"},
     {"arctan", "atan"},
     {"arcsin", "asin"},
     {"arccos", "acos"},
     {"sgn", "sign"},
     {"signum", "sign"},
     {"fabs", "abs"},
     {"pow", "x^y"},
     {"clip", "min(max(x, a), b)"},
     {"clamp", "min(max(x, a), b)"},
     {"heaviside", "step"},
     {"ceil", "-floor(-x)"},
     {"ceiling", "-floor(-x)"},
     {"round", "floor(x + 0.5)"},
     {"mod", "x - y*floor(x/y)"},
     {"fmod", "x - y*floor(x/y)"},
     {"hypot", "sqrt(x^2 + y^2)"},
     {"log10", "log(x)/log(10)"},
     {"log2", "log(x)/log(2)"},
     {"cbrt", "sign(x)*abs(x)^(1/3)"},
     {"tau", "2*pi"},
     {"STEP5", "step"},
     {"maximum", "max"},
     {"minimum", "min"},
     {"IF", "step(x)*a + (1 - step(x))*b"},
     {"if", "step(x)*a + (1 - step(x))*b"}}};

/// What to write for names of other languages that are no function here.
struct Instead {
    std::string_view word, help;
};
constexpr std::string_view no_prefix = "functions have no prefix, as in sin(t)";
constexpr std::string_view no_branch = "step(x)*a + (1 - step(x))*b is a where x > 0, else b";
constexpr std::string_view no_power = "a power is written x^2";
constexpr std::string_view in_radians = "angles are in rad: 30 deg is 30*pi/180";
constexpr std::string_view no_unit = "angles are in rad, so that the unit is left out";
constexpr std::string_view an_input =
    "coordinates and their rates are read by name, as in shaft.angle and shaft.angle_rate";
constexpr std::string_view no_comparison = "there are no comparisons: step(t - 1) is 1 where t > 1 and 0 "
                                           "before, step(x)*a + (1 - step(x))*b chooses";
constexpr std::array<Instead, 17> instead{{
    {"np", no_prefix},
    {"numpy", no_prefix},
    {"math", no_prefix},
    {"Math", no_prefix},
    {"where", no_branch},
    {"power", no_power},
    {"e", "exp(1) is e, exp(x) a power of it"},
    {"deg", in_radians},
    {"degrees", in_radians},
    {"rad", no_unit},
    {"radians", in_radians},
    {"AX", an_input},
    {"AZ", an_input},
    {"DZ", an_input},
    {"WZ", an_input},
    {"VARVAL", an_input},
    {"q", an_input},
}};

/// Letters without their case.
bool is_same_but_for_case(std::string_view a, std::string_view b)
{
    return std::ranges::equal(a, b, [](char x, char y) { return (x | 0x20) == (y | 0x20); });
}

}   // namespace

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool begins_name(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

const Function* find_function(std::string_view name)
{
    const auto found = std::ranges::find(functions, name, &Function::name);
    return found == functions.end() ? nullptr : &*found;
}

bool is_composed(std::string_view name) { return std::ranges::find(composed, name) != composed.end(); }

std::string known_names(std::string_view word, const std::vector<std::string>& symbols)
{
    const std::string_view last = word.substr(word.rfind('.') + 1);   // "np.sin"
    std::string meant;
    for (const auto& [other, own] : other_names)
        if (last == other) meant = own;
    const auto propose = [&](std::string_view name) {
        if (meant.empty() && is_same_but_for_case(last, name)) meant = name;
    };
    for (const Function& f : functions) propose(f.name);
    for (const std::string_view name : composed) propose(name);
    std::string known = meant.empty() ? "" : "did you mean '" + meant + "'? ";
    for (const Instead& other : instead)
        if (word == other.word || word.starts_with(std::string(other.word) + "."))
            known += std::string(other.help) + "; ";
    known += "known are t, pi";
    for (const Function& f : functions) known += ", " + std::string(f.name);
    for (const std::string_view name : composed) known += ", " + std::string(name);
    for (const std::string& symbol : symbols) known += ", " + symbol;
    return known;
}

std::string_view habit_at(std::string_view text, std::size_t at)
{
    if (at >= text.size()) return {};
    const char c = text[at], before = at > 0 ? text[at - 1] : ' ';
    if (c == '*' && before == '*') return no_power;
    if (c == '>' || c == '<' || c == '=' || c == '?' || c == '!' || c == '&' || c == '|')
        return no_comparison;
    if (c == '%') return "the rest of x/y is x - y*floor(x/y)";
    if (c == ',') return "min and max take two arguments: min(a, min(b, c)); decimals have a point: 1.5";
    if (c == '[' || c == '{') return "parentheses are round";
    if (c != '(' && c != '\'' && !begins_name(c) && !is_digit(c)) return {};
    const std::string_view word = text.substr(at, name_at(text, at).end - at);
    if (word == "deg" || word == "degrees") return in_radians;
    return word == "rad" ? no_unit : "a product is written with *, as in 2*t";
}

Name name_at(std::string_view text, std::size_t at)
{
    const auto end_of_word = [&](std::size_t i) {
        while (i < text.size() && (begins_name(text[i]) || is_digit(text[i]))) ++i;
        return i;
    };
    std::size_t end = 0;
    std::string word;
    if (text[at] == '\'') {
        const std::size_t close = text.find('\'', at + 1);
        if (close == std::string_view::npos) return {"", text.size(), true};
        word = text.substr(at + 1, close - at - 1);
        end = close + 1;
    } else {
        end = end_of_word(at);
        word = text.substr(at, end - at);
    }
    while (end + 1 < text.size() && text[end] == '.' && begins_name(text[end + 1])) {
        const std::size_t next = end_of_word(end + 1);
        word += text.substr(end, next - end);
        end = next;
    }
    return {word, end};
}

}   // namespace livens::inline time_internal

namespace livens {

bool is_word_of_expressions(std::string_view word)
{
    return word == "t" || word == "pi" || is_composed(word) || find_function(word) != nullptr;
}

bool is_plain_name(std::string_view word)
{
    return !word.empty() && begins_name(word[0]) &&
           std::ranges::all_of(word, [](char c) { return begins_name(c) || is_digit(c); });
}

std::vector<std::string> names_with_points(std::string_view text)
{
    std::vector<std::string> names;
    for (std::size_t at = 0; at < text.size();) {
        if (is_digit(text[at])) {   // "2.5e3" is no name
            double value = 0;
            const char* const first = text.data() + at;
            const auto end = std::from_chars(first, text.data() + text.size(), value).ptr;
            at += std::max<std::size_t>(1, static_cast<std::size_t>(end - first));
            continue;
        }
        if (!begins_name(text[at]) && text[at] != '\'') {
            ++at;
            continue;
        }
        Name name = name_at(text, at);
        at = name.end;
        const bool has_point = name.word.find('.') != std::string::npos;
        if (has_point && std::ranges::find(names, name.word) == names.end())
            names.push_back(std::move(name.word));
    }
    return names;
}

}   // namespace livens
