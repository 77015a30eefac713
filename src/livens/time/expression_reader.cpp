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
#include "livens/time/detail/expression_names.h"
#include "livens/time/detail/expression_reader.h"

namespace livens::inline time_internal {

namespace {

using Operation = Expression::Operation;

/// By descent: sum, product, sign, power, atom.
class Reader {
public:
    Reader(std::string_view text, const std::vector<std::string>& symbols, const ExpressionWords& words)
        : text_(text), symbols_(symbols), words_(words)
    {}

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
        refuse("expression-syntax", "an expression cannot be read",
               (at_ < text_.size() ? "'" + character() + "'" : "it ends") + column, expected,
               std::string(habit_at(text_, at_)));
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
        const bool is_taken = is_word_of_expressions(symbol);
        if ((is_plain_name(symbol) && !is_taken) || symbol.find('.') != std::string::npos) return;
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
        if (words_.unit) at_ = words_.unit(text_, at_, place, value);
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
        if (const Function* f = find_function(word)) return call(*f, place);
        if (is_composed(word)) return call_composed(word, place);
        const auto symbol = std::ranges::find(symbols_, word);
        if (symbol != symbols_.end())
            return add({Operation::symbol, static_cast<int>(symbol - symbols_.begin()), -1, place});
        if (const std::optional<double> value = words_.constant ? words_.constant(word, place) : std::nullopt)
            return add_number(*value, place);
        if (const Expression* formula = words_.formula ? words_.formula(word) : nullptr)
            return inlined(*formula, place);
        refuse("expression-name", "an expression has an unknown name",
               "'" + word + "' at column " + std::to_string(place), "", known_names(word, symbols_));
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

    /// Steps of a formula of the same symbols.
    int inlined(const Expression& formula, int place)
    {
        const int before = static_cast<int>(steps_.size());
        for (Expression::Step step : formula.steps()) {
            const bool is_symbol = step.operation == Operation::symbol;
            if (!is_symbol && step.first >= 0) step.first += before;
            if (step.second >= 0) step.second += before;
            step.column = place;
            steps_.push_back(step);
        }
        return static_cast<int>(steps_.size()) - 1;
    }

    int add_number(double value, int place) { return add({Operation::number, -1, -1, place, value}); }

    /// Their derivatives, jumps and bends are those of what they are made of.
    int call_composed(std::string_view name, int place)
    {
        const auto made = [&](Operation operation, int a, int b = -1) {
            return add({operation, a, b, place});
        };
        expect('(');
        const int x = sum();
        if (name == "step") return step(x, place);
        expect(')');
        const int one = add_number(1, place);
        if (name == "atan") return made(Operation::arc_tangent, x, one);
        if (name == "sinh" || name == "cosh") {
            const int rising = made(Operation::exponential, x),
                      falling = made(Operation::exponential, made(Operation::negative, x));
            const int cosh =
                made(Operation::times, add_number(0.5, place), made(Operation::plus, rising, falling));
            // Their difference has few digits where x is small.
            return name == "cosh" ? cosh
                                  : made(Operation::times, made(Operation::hyperbolic_tangent, x), cosh);
        }
        // sqrt(1 - x^2) by factors, which keep their digits near 1
        const int rest = made(Operation::root, made(Operation::times, made(Operation::minus, one, x),
                                                    made(Operation::plus, one, x)));
        return name == "asin" ? made(Operation::arc_tangent, x, rest) : made(Operation::arc_tangent, rest, x);
    }

    /// step(x), or step(x, x0, h0, x1, h1) = h0 + (h1 - h0) s^2 (3 - 2 s), s = (x - x0) / (x1 - x0) within 0
    /// and 1.
    int step(int x, int place)
    {
        const auto made = [&](Operation operation, int a, int b = -1) {
            return add({operation, a, b, place});
        };
        const auto constant = [&](double value) { return add_number(value, place); };
        if (take(')'))
            return made(Operation::times, constant(0.5),
                        made(Operation::plus, constant(1), made(Operation::sign, x)));
        int of[4];
        for (int& one : of) {
            expect(',');
            one = sum();
        }
        expect(')');
        const int share =
            made(Operation::divided, made(Operation::minus, x, of[0]), made(Operation::minus, of[2], of[0]));
        const int s = made(Operation::least, made(Operation::greatest, share, constant(0)), constant(1));
        const int rise = made(Operation::times, made(Operation::times, s, s),
                              made(Operation::minus, constant(3), made(Operation::times, constant(2), s)));
        return made(Operation::plus, of[1],
                    made(Operation::times, made(Operation::minus, of[3], of[1]), rise));
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
    const ExpressionWords& words_;
    std::vector<Expression::Step> steps_;
    std::size_t at_ = 0;
    int depth_ = 0;
};

}   // namespace

std::vector<Expression::Step> read_expression(std::string_view text, const std::vector<std::string>& symbols,
                                              const ExpressionWords& words)
{
    return Reader(text, symbols, words).read();
}

}   // namespace livens::inline time_internal
