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
    Function{"sign", Operation::sign, 1},         Function{"floor", Operation::floor, 1},
    Function{"atan2", Operation::arc_tangent, 2}, Function{"min", Operation::least, 2},
    Function{"max", Operation::greatest, 2}};

// Functions that are made of those above.
constexpr std::array<std::string_view, 6> composed{"asin", "acos", "atan", "sinh", "cosh", "step"};

// Names that other programs have for the same: a refusal proposes the one that is known here.
constexpr std::array<std::pair<std::string_view, std::string_view>, 21> other_names{
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
     {"maximum", "max"},
     {"minimum", "min"},
     {"IF", "step(x)*a + (1 - step(x))*b"},
     {"if", "step(x)*a + (1 - step(x))*b"}}};

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool begins_name(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

/// A name with all its points, and where it ends in the text.
struct Name {
    std::string word;
    std::size_t end;
    bool is_open = false;   ///< a quote is not closed
};

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
            symbol == "t" || symbol == "pi" || std::ranges::find(composed, symbol) != composed.end() ||
            std::ranges::any_of(functions, [&](const Function& f) { return f.name == symbol; });
        if ((is_name && !is_taken) || symbol.find('.') != std::string::npos) return;
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
        if (begins_name(text_[at_]) || text_[at_] == '\'') return name();
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
        const int place = static_cast<int>(at_) + 1;
        const Name read = name_at(text_, at_);
        if (read.is_open)
            refuse("expression-syntax", "an expression cannot be read", "a name in quotes is not closed", "",
                   "as in 'crank pin'.angle");
        at_ = read.end;
        const std::string& word = read.word;
        if (word == "t") return add({Operation::time, -1, -1, place});
        if (word == "pi") return add({Operation::number, -1, -1, place, std::numbers::pi});
        for (const Function& f : functions)
            if (f.name == word) return call(f, place);
        if (std::ranges::find(composed, word) != composed.end()) return call_composed(word, place);
        const auto symbol = std::ranges::find(symbols_, word);
        if (symbol != symbols_.end())
            return add({Operation::symbol, static_cast<int>(symbol - symbols_.begin()), -1, place});
        refuse("expression-name", "an expression has an unknown name",
               "'" + word + "' at column " + std::to_string(place), "", known_names(word));
    }

    std::string known_names(const std::string& word) const
    {
        std::string known;
        const std::string last = word.substr(word.rfind('.') + 1);   // "np.sin"
        std::string lower = last;
        for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        const auto is_function = [](std::string_view name) {
            return std::ranges::find(composed, name) != composed.end() ||
                   std::ranges::any_of(functions, [&](const Function& f) { return f.name == name; });
        };
        for (const auto& [other, own] : other_names)
            if (last == other) known = "did you mean '" + std::string(own) + "'? ";
        if (known.empty() && is_function(lower)) known = "did you mean '" + lower + "'? ";
        known += "known are t, pi";
        for (const Function& f : functions) known += ", " + std::string(f.name);
        for (const std::string_view name : composed) known += ", " + std::string(name);
        for (const std::string& symbol_name : symbols_) known += ", " + symbol_name;
        return known;
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

    int add_number(double value, int place) { return add({Operation::number, -1, -1, place, value}); }

    /// Their derivatives, jumps and bends are those of what they are made of.
    int call_composed(std::string_view name, int place)
    {
        const auto made = [&](Operation operation, int a, int b = -1) {
            return add({operation, a, b, place});
        };
        using enum Operation;
        expect('(');
        const int x = sum();
        if (name == "step") return step(x, place);
        expect(')');
        const int one = add_number(1, place);
        if (name == "atan") return made(arc_tangent, x, one);
        if (name == "sinh" || name == "cosh") {
            const int rising = made(exponential, x), falling = made(exponential, made(negative, x));
            const int cosh = made(times, add_number(0.5, place), made(plus, rising, falling));
            // Their difference has few digits where x is small.
            return name == "cosh" ? cosh : made(times, made(hyperbolic_tangent, x), cosh);
        }
        // sqrt(1 - x^2) by factors, which keep their digits near 1
        const int rest = made(root, made(times, made(minus, one, x), made(plus, one, x)));
        return name == "asin" ? made(arc_tangent, x, rest) : made(arc_tangent, rest, x);
    }

    /// step(x), or step(x, x0, h0, x1, h1) = h0 + (h1 - h0) s^2 (3 - 2 s), s = (x - x0) / (x1 - x0) within 0
    /// and 1.
    int step(int x, int place)
    {
        const auto made = [&](Operation operation, int a, int b = -1) {
            return add({operation, a, b, place});
        };
        const auto constant = [&](double value) { return add_number(value, place); };
        using enum Operation;
        if (take(')')) return made(times, constant(0.5), made(plus, constant(1), made(Operation::sign, x)));
        int of[4];
        for (int& one : of) {
            expect(',');
            one = sum();
        }
        expect(')');
        const int share = made(divided, made(minus, x, of[0]), made(minus, of[2], of[0]));
        const int s = made(least, made(greatest, share, constant(0)), constant(1));
        const int rise =
            made(times, made(times, s, s), made(minus, constant(3), made(times, constant(2), s)));
        return made(plus, of[1], made(times, made(minus, of[3], of[1]), rise));
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

namespace livens {

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
