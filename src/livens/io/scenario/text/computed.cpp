// SPDX-License-Identifier: BSD-3-Clause
// Texts that are computed while a file is read. The expressions of `time` give value, precedence and
// refusals; what stands behind a number is its unit, and each step gets its dimension here. A unit is as long
// as it can be: in "3 N/m*L" it is N/m.
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/io/scenario/text/parameters.h"

namespace livens::inline io_internal {

namespace {

using Operation = Expression::Operation;

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_decimal(char c) { return c >= '0' && c <= '9'; }
bool is_of_word(char c) { return is_letter(c) || is_decimal(c) || c == '_'; }

std::size_t end_of_word(std::string_view text, std::size_t at)
{
    while (at < text.size() && is_of_word(text[at])) ++at;
    return at;
}

constexpr std::size_t longest_unit = 60;

/// Where units may end that begin at `at`, behind a number: behind words, all of them units, their exponents
/// and parentheses.
std::vector<std::size_t> ends_of_units(std::string_view text, std::size_t at)
{
    std::vector<std::size_t> ends;
    const std::size_t begin = at;
    char before = text.substr(at, 2) == "1/" ? text[at++] : ' ';   // "3 1/s"
    for (int n_open = 0; at < text.size() && at - begin < longest_unit;) {
        const char c = text[at];
        const std::size_t end = end_of_word(text, at);
        std::string reason;
        if (is_letter(c) && (text.substr(end, 1) != "(" && parse_unit(text.substr(at, end - at), reason))) {
            ends.push_back(at = end);
        } else if (c == '^' && before != '*' && before != '/') {
            const std::size_t digit = at + (text.substr(at + 1, 1) == "-" ? 2 : 1);
            if (digit >= text.size() || !is_decimal(text[digit]) || end_of_word(text, digit) != digit + 1)
                break;
            ends.push_back(at = digit + 1);
        } else if (c == '*' || c == '/' || is_blank(c) || (c == '(' && before == '/' && ++n_open > 0)) {
            ++at;
        } else if (c == ')' && n_open-- > 0) {
            ends.push_back(++at);
        } else {
            break;
        }
        if (!is_blank(c)) before = c;
    }
    return ends;
}

/// Where the longest unit ends that begins here, behind a number; `begin` if there is none.
std::size_t end_of_unit(std::string_view text, std::size_t begin, Unit& unit)
{
    const std::size_t first = std::min(text.find_first_not_of(" \t", begin), text.size());
    const std::vector<std::size_t> ends = ends_of_units(text, first);
    for (auto end = ends.rbegin(); end != ends.rend(); ++end) {
        std::string reason;
        const std::optional<Unit> found = parse_unit(text.substr(first, *end - first), reason);
        if (!found) continue;
        unit = *found;
        return *end;
    }
    return begin;
}

/// A unit that is multiplied or divided by another one, which has the name of a parameter that measures the
/// same: nobody knows which is meant. Else empty.
std::string ambiguous_name(std::string_view unit, const Parameters& parameters)
{
    for (std::size_t at = unit.find_first_of("*/"); at < unit.size(); at = unit.find_first_of("*/", at + 1)) {
        const std::size_t begin = std::min(unit.find_first_not_of(" \t(", at + 1), unit.size());
        const std::string_view name = unit.substr(begin, end_of_word(unit, begin) - begin);
        std::string reason;
        const std::optional<Unit> alone = parse_unit(name, reason);
        const Parameters::One* one = name.empty() ? nullptr : parameters.find(name);
        if (one == nullptr || !alone) continue;
        if (one->state == Parameters::One::State::waits) throw Waiting{one};
        const Amount as_unit = amount_of(1, *alone);
        if (one->amount.powers == as_unit.powers) return std::string(name);
    }
    return {};
}

/// Thrown inside of expressions; caught below.
struct Refusal {
    Computed found;
};

[[noreturn]] void refuse_text(const std::string& code, const std::string& error, const std::string& help = {})
{
    throw Refusal{{{}, code, error, help}};
}

/// Reads a text once: which amounts stand where.
class Reading {
public:
    Reading(std::string text, const Parameters& parameters) : text_(std::move(text)), parameters_(parameters)
    {}

    /// While the text is parsed, words and units leave their amounts by column; then the steps, each behind
    /// its arguments, take them from there. So the grammar stands in Expression alone.
    Amount read()
    {
        const ExpressionWords words{[&](std::string_view name, int column) { return constant(name, column); },
                                    [&](std::string_view text, std::size_t end, int column, double& number) {
                                        return unit(text, end, column, number);
                                    }};
        const Expression expression(text_, {}, words);
        const std::vector<Expression::Step>& steps = expression.steps();
        const std::vector<double> values = expression.values(0, {});
        std::vector<Amount> amounts;
        for (std::size_t i = 0; i < steps.size(); ++i) {
            amounts.push_back(amount(steps[i], amounts));
            amounts.back().value = values[i];
        }
        return amounts.back();
    }

private:
    std::optional<double> constant(std::string_view name, int column)
    {
        const Parameters::One* one = parameters_.find(name);
        if (one == nullptr) return std::nullopt;
        if (one->state == Parameters::One::State::waits) throw Waiting{one};
        if (one->state == Parameters::One::State::is_wrong) refuse_text("parameter", "");
        amounts_[column] = one->amount;
        return one->amount.value;
    }

    std::size_t unit(std::string_view text, std::size_t end, int column, double& number)
    {
        Unit found;
        const std::size_t behind = end_of_unit(text, end, found);
        if (behind == end) {
            amounts_[column].is_zero = number == 0;
            return end;
        }
        const std::string_view word = text.substr(end, behind - end);
        const std::string doubtful = ambiguous_name(word, parameters_);
        if (!doubtful.empty())
            refuse_text(
                "unit", "'" + doubtful + "' may be the unit or the parameter",
                "for the unit write a blank and a power, as in m^-1; for the parameter put number and "
                "unit in parentheses");
        if (behind < text.size() && text[behind] == '^')
            refuse_text("unit", "an exponent of a unit is a whole number from -9 to 9",
                        "a quantity to a power has parentheses: (2 m)^n");
        amounts_[column] = amount_of(number, found);
        number = amounts_[column].value;
        if (!std::isfinite(number)) refuse_text("expression-value", "the number does not fit into 64 bits");
        return behind;
    }

    Amount amount(const Expression::Step& step, const std::vector<Amount>& amounts) const
    {
        Amount result;
        if (step.operation == Operation::time)
            refuse_text("expression-name",
                        "'t' at column " + std::to_string(step.column) +
                            ": a number of the file does not change with time",
                        "formulas of time are the 'expression' of loads and drives");
        if (step.operation == Operation::number) {
            const auto found = amounts_.find(step.column);
            if (found != amounts_.end()) return found->second;
            result.has_pi = step.number == std::numbers::pi;
            return result;
        }
        const Amount& first = amounts[static_cast<std::size_t>(step.first)];
        const Amount& second = step.second < 0 ? first : amounts[static_cast<std::size_t>(step.second)];
        const std::string fault = combine(step.operation, first, second, result);
        if (!fault.empty())
            refuse_text("unit", fault + " at column " + std::to_string(step.column),
                        first.has_unit == second.has_unit ? ""
                                                          : "a number without a unit is a plain number here: "
                                                            "write its unit");
        return result;
    }

    std::string text_;
    const Parameters& parameters_;
    std::map<int, Amount> amounts_;   ///< by the columns of steps
};

/// What is in the first pair of quotes: "'l' at column 3".
std::string_view word_in_quotes(std::string_view value)
{
    const std::size_t open = value.find('\''), close = value.find('\'', open + 1);
    return close < value.size() ? value.substr(open + 1, close - open - 1) : std::string_view();
}

/// Where the table could not be read the word may be one of its names, which is no second error.
Computed unknown_word(const Complaint& complaint, const Parameters& parameters)
{
    if (parameters.lacks_some()) return {{}, complaint.code, "", ""};
    const std::string_view word = word_in_quotes(complaint.value);
    const std::vector<std::string_view> names = parameters.names();
    const std::string near = std::string(closest(word, names));
    std::string help = near.empty() ? complaint.help : "did you mean '" + near + "'?";
    std::string reason;
    if (near.empty() && parse_unit(word, reason))
        help = "a unit stands behind a number: 1 " + std::string(word);
    else if (near.empty() && !help.starts_with("did you mean"))
        help = names.empty() ? "numbers have names in the table [parameters]" : suggest(word, names);
    return {{}, complaint.code, "there is no parameter " + complaint.value, help};
}

}   // namespace

ExpressionWords words_of_formulas(const Parameters& parameters)
{
    const auto constant = [&parameters](std::string_view name, int) -> std::optional<double> {
        const Parameters::One* one = parameters.find(name);
        return one == nullptr ? std::nullopt : std::optional(one->amount.value);
    };
    const auto unit = [](std::string_view text, std::size_t end, int, double& number) {
        Unit found;
        const std::size_t behind = end_of_unit(text, end, found);
        if (behind != end) number = in_si(number, found);
        return behind;
    };
    return {constant, unit};
}

bool is_computed(std::string_view given, const Parameters& parameters)
{
    const std::string text = in_ascii(given);
    std::string_view rest = text;
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    if (!rest.empty() && (rest[0] == '+' || rest[0] == '-')) rest.remove_prefix(1);
    if (rest.empty() || !(is_decimal(rest[0]) || rest[0] == '.')) return !rest.empty();
    double number = 0;
    const char* const end = std::from_chars(rest.data(), rest.data() + rest.size(), number).ptr;
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
    const std::size_t next = std::min(rest.find_first_not_of(" \t"), rest.size());
    if (next < rest.size() && (rest[next] == '*' || rest[next] == '/' || rest[next] == '^')) return true;
    // A number with a unit has no other numbers but exponents, and no names but those of units.
    for (std::size_t at = 0; at < rest.size(); ++at) {
        const char before = at > 0 ? rest[at - 1] : ' ';
        if (rest[at] == '+' || (rest[at] == '-' && before != '^')) return true;
        if (!is_of_word(rest[at]) || is_of_word(before)) continue;
        const std::string_view word = rest.substr(at, end_of_word(rest, at) - at);
        const bool is_one = word == "1" && rest.find_first_not_of(" \t") == at;   // "3 1/s"
        if (is_decimal(word[0]) && before != '^' && before != '-' && !is_one) return true;
        if (is_word_of_expressions(word) && word != "t") return true;
        std::string reason;
        if (!parse_unit(word, reason) && parameters.find(word) != nullptr) return true;
    }
    return false;
}

Computed compute(std::string_view text, const Parameters& parameters)
{
    try {
        return {Reading(in_ascii(text), parameters).read(), "", "", ""};
    } catch (const Refusal& refusal) {
        return refusal.found;
    } catch (const InputError& error) {
        const Complaint& c = error.complaint();
        if (c.code == "expression-name") return unknown_word(c, parameters);
        std::string said = c.message + (c.value.empty() ? "" : ": " + c.value);
        if (!c.bound.empty()) said += ", where there may be " + c.bound;
        // An expression that is quoted by its help is quoted by the message already.
        return {{}, c.code, said, c.help.starts_with("in '") ? "" : c.help};
    }
}

Computed compute(std::string_view text, std::string_view si_unit, const Parameters& parameters)
{
    Computed found = compute(text, parameters);
    if (!found.code.empty()) return found;
    const std::string fault = misfit(found.amount, si_unit);
    if (fault.empty()) return found;
    return {found.amount, "unit", fault, si_unit.empty() ? "" : "it is measured in " + std::string(si_unit)};
}

std::string with_numbers(std::string_view text, const Parameters& parameters)
{
    std::string result;
    for (std::size_t at = 0; at < text.size();) {
        const bool is_in_number = at > 0 && (text[at - 1] == '.' || is_decimal(text[at - 1]));   // "2.5e3"
        const std::string_view word = text.substr(at, std::max<std::size_t>(1, end_of_word(text, at) - at));
        const Parameters::One* one = is_plain_name(word) && !is_in_number ? parameters.find(word) : nullptr;
        if (one == nullptr) {
            result += word;
        } else {
            const std::string number = to_text(one->amount.value);
            result += one->amount.value < 0 ? "(" + number + ")" : number;
        }
        at += word.size();
    }
    return result;
}

}   // namespace livens::inline io_internal
