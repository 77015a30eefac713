// SPDX-License-Identifier: BSD-3-Clause
// Reads the text of an expression into steps by recursive descent; grammar and precedence stand in
// expression.h. Length, depth and number of symbols are bounded, so that no text can exhaust stack or time,
// and nothing is executed.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/time/detail/expression_reader.h"

namespace livens::inline time_internal {

namespace {

using Operation = Expression::Operation;

struct Function {
    std::string_view name;
    Operation operation;
    int n_arguments;
};

constexpr std::array functions{
    Function{"sin", Operation::sine, 1},          Function{"cos", Operation::cosine, 1},
    Function{"tan", Operation::tangent, 1},       Function{"tanh", Operation::hyperbolic_tangent, 1},
    Function{"exp", Operation::exponential, 1},   Function{"log", Operation::logarithm, 1},
    Function{"sqrt", Operation::root, 1},         Function{"abs", Operation::absolute, 1},
    Function{"atan2", Operation::arc_tangent, 2}, Function{"min", Operation::least, 2},
    Function{"max", Operation::greatest, 2}};

// Names that other programs have for the same: a refusal proposes the one that is known here.
constexpr std::array<std::pair<std::string_view, std::string_view>, 6> other_names{
    {{"time", "t"}, {"T", "t"}, {"Pi", "pi"}, {"PI", "pi"}, {"ln", "log"}, {"arctan2", "atan2"}}};

/// What to write for names of other languages that are no function here.
struct Instead {
    std::string_view word, help;
};
constexpr std::string_view no_prefix = "functions have no prefix, as in sin(t)";
constexpr std::string_view no_branch =
    "there is no IF: max(x, 0), min and abs switch at zero; what changes over "
    "time is a table";
constexpr std::string_view no_power = "a power is written x^2";
constexpr std::string_view in_radians = "angles are in rad: 30 deg is 30*pi/180";
constexpr std::string_view an_input = "coordinates and their rates are inputs, under a symbol of your choice";
constexpr std::array<Instead, 18> instead{{
    {"np", no_prefix},
    {"numpy", no_prefix},
    {"math", no_prefix},
    {"Math", no_prefix},
    {"IF", no_branch},
    {"if", no_branch},
    {"where", no_branch},
    {"pow", no_power},
    {"power", no_power},
    {"e", "exp(1) is e, exp(x) a power of it"},
    {"deg", in_radians},
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

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool begins_name(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

/// By descent: sum, product, sign, power, atom.
class Reader {
public:
    Reader(std::string_view text, const std::vector<std::string>& symbols) : text_(text), symbols_(symbols) {}

    std::vector<Expression::Step> read()
    {
        if (text_.size() > Expression::longest)
            refuse("expression-size", "an expression is too long", std::to_string(text_.size()),
                   "at most " + std::to_string(Expression::longest) + " characters");
        if (symbols_.size() > Expression::most_symbols)
            refuse("expression-size", "an expression has too many inputs", std::to_string(symbols_.size()),
                   "at most " + std::to_string(Expression::most_symbols));
        for (const std::string& symbol : symbols_) check_symbol(symbol);
        sum();
        skip_blanks();
        if (at_ < text_.size()) refuse_here("an operator or the end");
        return std::move(steps_);
    }

private:
    [[noreturn]] void refuse(const std::string& code, const std::string& message, const std::string& value,
                             const std::string& bound, const std::string& help = "") const
    {
        throw InputError({code, "expression", message, value, bound, "",
                          help.empty() ? "in '" + std::string(text_.substr(0, 100)) + "'" : help});
    }

    [[noreturn]] void refuse_here(const std::string& expected) const
    {
        const std::string column = " at column " + std::to_string(at_ + 1);
        // x**2 is what many languages write; the refusal says how a power is written here.
        const bool is_power = at_ > 0 && at_ < text_.size() && text_[at_] == '*' && text_[at_ - 1] == '*';
        refuse("expression-syntax", "an expression cannot be read",
               (at_ < text_.size() ? "'" + character() + "'" : "it ends") + column, expected,
               is_power ? "a power is written x^2" : "");
    }

    /// UTF-8: with what continues it.
    std::string character() const
    {
        std::size_t end = at_ + 1;
        while (end < text_.size() && (static_cast<unsigned char>(text_[end]) & 0xC0) == 0x80) ++end;
        return std::string(text_.substr(at_, end - at_));
    }

    void check_symbol(const std::string& symbol) const
    {
        const bool is_name =
            !symbol.empty() && begins_name(symbol[0]) &&
            std::ranges::all_of(symbol, [](char c) { return begins_name(c) || is_digit(c); });
        const bool is_taken =
            symbol == "t" || symbol == "pi" ||
            std::ranges::any_of(functions, [&](const Function& f) { return f.name == symbol; });
        if (is_name && !is_taken) return;
        refuse("expression-name",
               is_taken ? "an input has the name of something else" : "an input is no name",
               "'" + symbol + "'", "letters, digits and _, no digit first",
               is_taken ? "call it differently; t, pi and the functions are taken" : "");
    }

    void skip_blanks()
    {
        while (at_ < text_.size() &&
               (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r'))
            ++at_;
    }

    bool take(char c)
    {
        skip_blanks();
        if (at_ >= text_.size() || text_[at_] != c) return false;
        ++at_;
        return true;
    }

    void expect(char c)
    {
        if (!take(c)) refuse_here("'" + std::string(1, c) + "'");
    }

    int add(const Expression::Step& step)
    {
        steps_.push_back(step);
        return static_cast<int>(steps_.size()) - 1;
    }

    int column() const { return static_cast<int>(at_); }   // of what was just taken

    int sum()
    {
        int value = product();
        for (;;) {
            const bool is_plus = take('+');
            if (!is_plus && !take('-')) return value;
            const int place = column(), second = product();
            value = add({is_plus ? Operation::plus : Operation::minus, value, second, place});
        }
    }

    int product()
    {
        int value = sign();
        for (;;) {
            const bool is_times = take('*');
            if (!is_times && !take('/')) return value;
            const int place = column(), second = sign();
            value = add({is_times ? Operation::times : Operation::divided, value, second, place});
        }
    }

    int sign()
    {
        // Every recursion passes here: parentheses by atom(), signs and exponents directly. One bound
        // therefore holds for all.
        const Deeper deeper(*this);
        if (take('-')) {
            const int place = column(), value = sign();
            return add({Operation::negative, value, -1, place});
        }
        if (take('+')) return sign();
        const int base = atom();
        if (!take('^')) return base;
        // The exponent is read by sign(), not atom(): so powers bind from the right, and 2^-1 needs no
        // parentheses.
        const int place = column(), exponent = sign();
        return add({Operation::power, base, exponent, place});
    }

    int atom()
    {
        skip_blanks();
        if (at_ >= text_.size()) refuse_here("a number, a name or '('");
        if (take('(')) {
            const int value = sum();
            expect(')');
            return value;
        }
        if (is_digit(text_[at_]) || text_[at_] == '.') return number();
        if (begins_name(text_[at_])) return name();
        refuse_here("a number, a name or '('");
    }

    int number()
    {
        double value = 0;
        const char* const first = text_.data() + at_;
        // from_chars does not look at the locale, where a decimal comma may be set.
        const auto [end, error] = std::from_chars(first, text_.data() + text_.size(), value);
        if (error != std::errc() || !std::isfinite(value)) refuse_here("a number");
        const int place = column() + 1;
        at_ += static_cast<std::size_t>(end - first);
        return add({Operation::number, -1, -1, place, value});
    }

    int name()
    {
        const std::size_t first = at_;
        while (at_ < text_.size() && (begins_name(text_[at_]) || is_digit(text_[at_]))) ++at_;
        const std::string_view word = text_.substr(first, at_ - first);
        const int place = static_cast<int>(first) + 1;
        if (word == "t") return add({Operation::time, -1, -1, place});
        if (word == "pi") return add({Operation::number, -1, -1, place, std::numbers::pi});
        for (const Function& f : functions)
            if (f.name == word) return call(f, place);
        const auto symbol = std::ranges::find(symbols_, word);
        if (symbol != symbols_.end())
            return add({Operation::symbol, static_cast<int>(symbol - symbols_.begin()), -1, place});
        std::string known;
        for (const auto& [other, own] : other_names)
            if (word == other) known = "did you mean '" + std::string(own) + "'? ";
        for (const Function& f : functions)
            if (known.empty() && is_same_but_for_case(word, f.name))
                known = "did you mean '" + std::string(f.name) + "'? ";
        for (const Instead& other : instead)
            if (word == other.word) known += std::string(other.help) + "; ";
        known += "known are t, pi";
        for (const Function& f : functions) known += ", " + std::string(f.name);
        for (const std::string& symbol_name : symbols_) known += ", " + symbol_name;
        refuse("expression-name", "an expression has an unknown name",
               "'" + std::string(word) + "' at column " + std::to_string(place), "", known);
    }

    int call(const Function& f, int place)
    {
        expect('(');
        const int first = sum();
        int second = -1;
        if (f.n_arguments == 2) {
            expect(',');
            second = sum();
        }
        expect(')');
        return add({f.operation, first, second, place});
    }

    /// One level deeper, while it lives.
    struct Deeper {
        explicit Deeper(Reader& reader) : of(reader)
        {
            if (++of.depth_ > Expression::deepest)
                of.refuse("expression-size", "an expression is too deep",
                          "at column " + std::to_string(of.at_ + 1),
                          "at most " + std::to_string(Expression::deepest) + " levels");
        }
        ~Deeper() { --of.depth_; }
        Deeper(const Deeper&) = delete;
        Deeper& operator=(const Deeper&) = delete;
        Reader& of;
    };

    std::string_view text_;
    const std::vector<std::string>& symbols_;
    std::vector<Expression::Step> steps_;
    std::size_t at_ = 0;
    int depth_ = 0;
};

}   // namespace

std::vector<Expression::Step> read_expression(std::string_view text, const std::vector<std::string>& symbols)
{
    return Reader(text, symbols).read();
}

}   // namespace livens::inline time_internal
