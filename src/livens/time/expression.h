// SPDX-License-Identifier: BSD-3-Clause
// Expressions: functions of time and of named numbers, with exact derivatives, read from a text.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "livens/time/enclosure.h"
#include "livens/time/guard.h"
#include "livens/time/time_function.h"

namespace [[gnu::visibility("default")]] livens {

class Expression;

/// What else the text of an expression may hold. Columns are those of steps.
struct ExpressionWords {
    /// The number that a name stands for; empty: for none. Symbols come first.
    std::function<std::optional<double>(std::string_view name, int column)> constant = {};
    /// Of `text` from `end` on, where the number at `column` has ended: where its unit ends, if it has one,
    /// and the number with it.
    std::function<std::size_t(std::string_view text, std::size_t end, int column, double& number)> unit = {};
    /// The formula that a name stands for, of the same symbols; null: for none. They come last.
    std::function<const Expression*(std::string_view name)> formula = {};
};

/// `-3*phi - 0.2*w + sin(2*pi*t)`: numbers, `+ - * / ^`, parentheses, `pi`, `t` (s), symbols, and
///
///     sin cos tan asin acos atan sinh cosh tanh exp log sqrt abs sign floor   of one argument
///     atan2 min max                                                           of two
///     step(x, x0, h0, x1, h1)   from h0 before x0 to h1 behind x1, with a continuous slope
///     step(x)                   0, 1/2 and 1 where x is negative, zero and positive
///
/// A symbol with points may stand as it is, `shaft.angle`, with blanks in quotes: `'crank pin'.angle`.
/// `^` binds closest and from the right, a sign before it less: -x^2 is -(x^2). Nothing is executed: a text
/// becomes a list of operations whose size is bounded. Where an operation has no value (1/0, log(-1)) the
/// value is no number; where it has no derivative (|x| at 0) it has one from one side.
class Expression {
public:
    static constexpr std::size_t longest = 1000;   ///< characters
    static constexpr int deepest = 64;             ///< of parentheses, signs and powers
    static constexpr std::size_t most_symbols = 64;

    enum class Operation : std::uint8_t {
        number,
        time,
        symbol,
        negative,
        plus,
        minus,
        times,
        divided,
        power,
        sine,
        cosine,
        tangent,
        hyperbolic_tangent,
        exponential,
        logarithm,
        root,
        absolute,
        arc_tangent,
        least,
        greatest,
        sign,
        floor
    };
    /// Operands are earlier steps.
    struct Step {
        Operation operation = Operation::number;
        int first = -1, second = -1;   ///< places of the operands; `first` of a symbol is its number
        int column = 0;                ///< in the text, from 1
        double number = 0;
    };

    /// Throws InputError (`expression-size`, `expression-syntax`, `expression-name`, `expression-value`) with
    /// the column in the text; and what `words` throw.
    Expression(std::string_view text, std::vector<std::string> symbols, const ExpressionWords& words = {});

    const std::string& text() const { return text_; }
    /// What it is made of; the last is the value.
    const std::vector<Step>& steps() const { return steps_; }
    /// The same of other symbols: number k becomes places[k].
    Expression renumbered(std::span<const int> places) const;
    /// Whether the value may change with a symbol.
    bool depends_on(std::size_t symbol) const;

    /// The value, and its derivatives by the symbols unless `slopes` is empty; one number for each symbol.
    double operator()(double t, std::span<const double> symbols, std::span<double> slopes = {}) const;
    /// Of all steps.
    std::vector<double> values(double t, std::span<const double> symbols) const;
    /// Value and two derivatives by time, where symbols do not change.
    TimeValue by_time(double t, std::span<const double> symbols = {}) const;
    /// Value and two derivatives by the only symbol, at t = 0.
    TimeValue by_symbol(double symbol) const;
    /// "division by 0 at column 5": the first operation that has no value there; empty if all have.
    std::string without_value(double t, std::span<const double> symbols) const;

    /// Instants in between at which an operation on time alone jumps or bends (abs, min, max, atan2, sign,
    /// floor, a division by what passes zero), and around what comes and goes faster than a hundredth of the
    /// time: an element that steps over these sees nothing of them. Pulses shorter than a 4096th may be
    /// overlooked.
    std::vector<double> events(double from, double until) const;
    /// Of operations that jump or bend where symbols decide: abs and sign at 0, min and max where both are
    /// alike, atan2 at half a turn, floor at whole numbers.
    const std::vector<Guard>& guards() const { return guards_; }
    /// These operations, places in steps().
    const std::vector<int>& guarded_steps() const { return guarded_; }
    /// Their numbers.
    void guarded(double t, std::span<const double> symbols, std::span<double> numbers) const;
    /// Where time and symbols are within ranges, and their slopes by the share of a way: bounds of the value
    /// and of its slope, wider than they are where a symbol stands more than once.
    EnclosedValue over(const EnclosedValue& t, std::span<const EnclosedValue> symbols) const;
    /// A sum of numbers times symbols, and of what time alone decides.
    bool is_affine() const;
    /// "max at column 5": the first operation that may jump or bend where symbols decide; empty: none does.
    std::string kink_by_symbols() const;

private:
    std::vector<bool> steps_with_symbols() const;
    void find_guards();
    std::vector<TimeValue> evaluate(double t, std::span<const double> symbols, int direction) const;

    std::string text_;
    std::vector<Step> steps_;    ///< the last is the value
    std::vector<int> guarded_;   ///< of these, which jump or bend where symbols decide
    std::vector<Guard> guards_;
};

/// Whether a word means something in every expression: t, pi and the functions.
bool is_word_of_expressions(std::string_view word);
/// Letters, digits and _, no digit first.
bool is_plain_name(std::string_view word);

/// Names with points that stand in a text, each once, without their quotes; they need not be known.
std::vector<std::string> names_with_points(std::string_view text);

/// A function of time alone; `breaks` are instants where it jumps or bends, on either side of which it has
/// the value beside them.
TimeFunction expression_of_time(const Expression& expression, std::vector<double> breaks = {});
/// The instant that an expression is asked with: beside a break, on the side that is meant.
double beside_breaks(Instant at, const std::vector<double>& breaks);

}   // namespace gnu::visibility("default")]]livens
