// SPDX-License-Identifier: BSD-3-Clause
// The arithmetic of dimensions. They are exponents, which products add and powers multiply; sums demand equal
// ones. No value is computed here but that of a lone quantity.
#include "livens/io/scenario/text/amount.h"

#include <cmath>

#include "livens/base/text.h"

namespace livens::inline io_internal {

namespace {

using Operation = Expression::Operation;

struct KnownQuantity {
    Dimension powers;
    std::string_view words;
};
// By powers of length, mass, time and angle.
constexpr KnownQuantity known_quantities[] = {
    {{1, 0, 0, 0}, "a length"},     {{2, 0, 0, 0}, "an area"},
    {{3, 0, 0, 0}, "a volume"},     {{0, 1, 0, 0}, "a mass"},
    {{0, 0, 1, 0}, "a time"},       {{0, 0, 0, 1}, "an angle"},
    {{1, 0, -1, 0}, "a velocity"},  {{1, 0, -2, 0}, "an acceleration"},
    {{0, 0, -1, 0}, "a frequency"}, {{0, 0, -1, 1}, "an angular velocity"},
    {{-3, 1, 0, 0}, "a density"},   {{2, 1, 0, 0}, "a moment of inertia"},
    {{1, 1, -2, 0}, "a force"},     {{2, 1, -2, 0}, "a torque or an energy"},
    {{-1, 1, -2, 0}, "a pressure"}, {{0, 1, -2, 0}, "a stiffness"},
};

bool are_alike(double a, double b) { return std::abs(a - b) < 1e-9; }   // of roots and their powers

bool measure_alike(const Amount& a, const Amount& b)
{
    return are_alike(a.powers[0], b.powers[0]) && are_alike(a.powers[1], b.powers[1]) &&
           are_alike(a.powers[2], b.powers[2]);
}

/// "a force"; empty: it has no name.
std::string_view words_for(const Amount& amount)
{
    const auto is_it = [&](const KnownQuantity& known) {
        for (std::size_t i = 0; i < 4; ++i)
            if (!are_alike(amount.powers[i], known.powers[i])) return false;
        return true;
    };
    for (const KnownQuantity& known : known_quantities)
        if (is_it(known)) return known.words;
    return {};
}

/// By name and unit.
std::string described_in(const Amount& amount, const std::string& unit)
{
    const std::string words(words_for(amount));
    return words.empty() ? "a quantity in " + unit : words + " (" + unit + ")";
}

bool has_length_or_mass(const Amount& a) { return a.powers[0] != 0 || a.powers[1] != 0; }

std::string_view verb_of(Operation operation)
{
    switch (operation) {
    case Operation::plus:
        return "is added to";
    case Operation::minus:
        return "is subtracted from";
    default:
        return "is compared with";
    }
}

/// Sums, the lesser, the greater, and the two arguments of atan2.
std::string alike(Operation operation, const Amount& a, const Amount& b, Amount& result)
{
    if (a.is_zero || b.is_zero) {
        result.powers = a.is_zero ? b.powers : a.powers;
        return {};
    }
    if (!measure_alike(a, b))
        return described(b) + " " + std::string(verb_of(operation)) + " " + described(a);
    // 3 Hz and 60 rpm are both 1/s, and one of them lacks 2 pi.
    const bool is_turned = !are_alike(a.powers[3], b.powers[3]) && !has_length_or_mass(a);
    if (is_turned && (a.has_hertz || b.has_hertz) && !(a.has_pi || b.has_pi))
        return described(b) + " " + std::string(verb_of(operation)) + " " + described(a);
    result.powers = a.powers;
    result.powers[3] = a.powers[3] != 0 ? a.powers[3] : b.powers[3];
    return {};
}

/// Functions of a pure number, whose values are such.
std::string of_number(const Amount& a, Amount& result)
{
    if (!a.is_pure()) return "a function of a plain number or an angle is asked for that of " + described(a);
    result.powers = {};
    result.has_unit = result.has_hertz = false;
    return {};
}

/// By the exponent's value: what L^n measures follows from the number that n is.
std::string raised(const Amount& base, const Amount& exponent, Amount& result)
{
    if (!exponent.is_pure()) return "an exponent is a plain number, not " + described(exponent);
    for (double& power : result.powers) power *= exponent.value;
    result.has_unit = base.has_unit;
    return {};
}

}   // namespace

std::string si_unit_of(const Amount& amount)
{
    constexpr std::string_view symbols[] = {"m", "kg", "s", "rad"};
    std::string above, below;
    int n_below = 0;
    for (const std::size_t i : {1u, 0u, 2u, 3u}) {   // kg first, as in kg m/s
        const double power = amount.powers[i];
        if (power == 0) continue;
        std::string& side = power > 0 ? above : below;
        n_below += power < 0 ? 1 : 0;
        const double size = std::abs(power);
        side +=
            (side.empty() ? "" : " ") + std::string(symbols[i]) + (size == 1 ? "" : "^" + to_text(size, 4));
    }
    if (below.empty()) return above;
    return (above.empty() ? "1" : above) + "/" + (n_below > 1 ? "(" + below + ")" : below);
}

std::string described(const Amount& amount)
{
    if (amount.is_pure() && amount.powers[3] == 0) return amount.has_unit ? "a ratio" : "a plain number";
    return described_in(amount, si_unit_of(amount));
}

Amount amount_of(double number, const Unit& unit)
{
    Amount amount;
    amount.value = in_si(number, unit);
    for (std::size_t i = 0; i < 4; ++i) amount.powers[i] = unit.dimension[i];
    amount.has_unit = true;
    amount.has_hertz = unit.dimension == Dimension{0, 0, -1, 0};
    return amount;
}

std::string combine(Operation operation, const Amount& first, const Amount& second, Amount& result)
{
    const bool is_of_one = operation == Operation::negative || operation == Operation::absolute;
    result = first;
    result.is_zero = is_of_one && first.is_zero;
    if (is_of_one) return {};
    result.has_unit = first.has_unit || second.has_unit;
    result.has_hertz = first.has_hertz || second.has_hertz;
    result.has_pi = first.has_pi || second.has_pi;
    switch (operation) {
    case Operation::plus:
    case Operation::minus:
    case Operation::least:
    case Operation::greatest:
        return alike(operation, first, second, result);
    case Operation::times:
    case Operation::divided:
        for (std::size_t i = 0; i < 4; ++i)
            result.powers[i] += operation == Operation::times ? second.powers[i] : -second.powers[i];
        return {};
    case Operation::power:
        return raised(first, second, result);
    case Operation::root:
        result = first;
        for (double& power : result.powers) power /= 2;
        return {};
    case Operation::arc_tangent: {
        const std::string fault = alike(operation, first, second, result);
        result.powers = {};
        result.has_unit = result.has_hertz = false;
        return fault;
    }
    case Operation::sign:
        result = {};
        return {};
    default:   // sine, cosine, tangent, tanh, exp, log, floor
        result = first;
        result.is_zero = false;
        return of_number(first, result);
    }
}

std::string misfit(const Amount& amount, std::string_view si_unit)
{
    if (!amount.has_unit && amount.is_pure() && amount.powers[3] == 0) return {};
    std::string reason;
    const std::optional<Unit> unit = parse_unit(si_unit.empty() ? "1" : si_unit, reason);
    const Amount wanted = amount_of(1, unit.value_or(Unit{}));
    const bool is_of_time_alone = !has_length_or_mass(wanted);
    const bool has_no_angle = are_alike(amount.powers[3], 0);
    const bool is_turned =
        are_alike(amount.powers[3], wanted.powers[3]) || (has_no_angle && !amount.has_hertz) || amount.has_pi;
    if (measure_alike(amount, wanted) && (is_turned || !is_of_time_alone)) return {};
    const std::string demand =
        si_unit.empty() ? "a plain number" : described_in(wanted, std::string(si_unit));
    return "it is " + described(amount) + ", and " + demand + " is wanted";
}

}   // namespace livens::inline io_internal
