// SPDX-License-Identifier: BSD-3-Clause
// Numbers with units, as in "5 mm" or "30 deg" (docs/scenario.md, Numbers and units). A unit is a quotient, a
// power of ten and a dimension. The three stay apart until the number is known, so that "5 mm" is 5/1000,
// rounded once.
#include "livens/io/scenario/text/units.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "livens/base/text.h"

namespace livens::inline io_internal {

namespace {

struct Symbol {
    std::string_view name;
    Unit unit;
    bool takes_prefix = true;
};

constexpr double pi = std::numbers::pi;
constexpr double pound_force = 44482216152605;   // 1e-13 N
// Numerator, denominator, power of ten, and the powers of length, mass, time and angle.
constexpr std::array symbols{
    Symbol{"1", {}, false}, Symbol{"m", {1, 1, 0, {1, 0, 0, 0}}}, Symbol{"g", {1, 1, -3, {0, 1, 0, 0}}},
    Symbol{"s", {1, 1, 0, {0, 0, 1, 0}}}, Symbol{"N", {1, 1, 0, {1, 1, -2, 0}}},
    Symbol{"J", {1, 1, 0, {2, 1, -2, 0}}}, Symbol{"W", {1, 1, 0, {2, 1, -3, 0}}},
    Symbol{"Pa", {1, 1, 0, {-1, 1, -2, 0}}}, Symbol{"Hz", {1, 1, 0, {0, 0, -1, 0}}},
    Symbol{"rad", {1, 1, 0, {0, 0, 0, 1}}}, Symbol{"bar", {1, 1, 5, {-1, 1, -2, 0}}},
    Symbol{"Nm", {1, 1, 0, {2, 1, -2, 0}}}, Symbol{"t", {1, 1, 3, {0, 1, 0, 0}}, false},
    Symbol{"min", {60, 1, 0, {0, 0, 1, 0}}, false}, Symbol{"h", {3600, 1, 0, {0, 0, 1, 0}}, false},
    Symbol{"deg", {pi, 180, 0, {0, 0, 0, 1}}, false}, Symbol{"degree", {pi, 180, 0, {0, 0, 0, 1}}, false},
    Symbol{"degrees", {pi, 180, 0, {0, 0, 0, 1}}, false}, Symbol{"rev", {2 * pi, 1, 0, {0, 0, 0, 1}}, false},
    Symbol{"rpm", {2 * pi, 60, 0, {0, 0, -1, 1}}, false},
    // Inch, foot, yard, mile, pound and ounce by the international agreement of 1959; forces with the
    // standard gravity of 9.80665 m/s^2 (NIST SP 811, appendix B). All are exact.
    Symbol{"in", {254, 1, -4, {1, 0, 0, 0}}, false}, Symbol{"inch", {254, 1, -4, {1, 0, 0, 0}}, false},
    Symbol{"mil", {254, 1, -7, {1, 0, 0, 0}}, false}, Symbol{"ft", {3048, 1, -4, {1, 0, 0, 0}}, false},
    Symbol{"yd", {9144, 1, -4, {1, 0, 0, 0}}, false}, Symbol{"mi", {1609344, 1, -3, {1, 0, 0, 0}}, false},
    Symbol{"lb", {45359237, 1, -8, {0, 1, 0, 0}}, false},
    Symbol{"lbm", {45359237, 1, -8, {0, 1, 0, 0}}, false},
    Symbol{"oz", {28349523125, 1, -12, {0, 1, 0, 0}}, false},
    Symbol{"slug", {pound_force, 3048, -9, {0, 1, 0, 0}}, false},   // lbf s^2 / ft
    Symbol{"lbf", {pound_force, 1, -13, {1, 1, -2, 0}}, false},
    Symbol{"kip", {pound_force, 1, -10, {1, 1, -2, 0}}, false},
    Symbol{"ozf", {pound_force, 16, -13, {1, 1, -2, 0}}, false},
    Symbol{"kgf", {980665, 1, -5, {1, 1, -2, 0}}, false}, Symbol{"g0", {980665, 1, -5, {1, 0, -2, 0}}, false},
    Symbol{"psi", {pound_force, 64516, -5, {-1, 1, -2, 0}}, false},   // lbf / in^2
    Symbol{"ksi", {pound_force, 64516, -2, {-1, 1, -2, 0}}, false},
    Symbol{"mph", {1609344, 3600, -3, {1, 0, -1, 0}}, false},
    Symbol{"kn", {1852, 3600, 0, {1, 0, -1, 0}}, false},
    Symbol{"hp", {550 * 3048 * pound_force, 1, -17, {2, 1, -3, 0}}, false},   // 550 ft lbf/s
};

struct Prefix {
    std::string_view name;
    int power_of_ten;
};
constexpr std::array prefixes{Prefix{"n", -9}, Prefix{"u", -6}, Prefix{"m", -3}, Prefix{"c", -2},
                              Prefix{"d", -1}, Prefix{"da", 1}, Prefix{"h", 2},  Prefix{"k", 3},
                              Prefix{"M", 6},  Prefix{"G", 9}};
constexpr int largest_exponent = 9;
constexpr std::string_view known_units =
    "units are m, g, s, N, J, W, Pa, bar, Hz, rad with the prefixes n u m c d da h k M G; t, min, h, deg or "
    "\xc2\xb0, rev, rpm; in, ft, yd, mi, mil, lb, oz, slug, lbf, ozf, kip, kgf, psi, ksi, mph, kn, hp; "
    "g0 = 9.80665 m/s^2";

/// Signs of typeset text, as data sheets have them, and what a keyboard has instead. An exponent follows a
/// caret: see in_ascii().
struct Sign {
    std::string_view typeset, plain;
    bool is_exponent = false;
};
// Middle dot, dot operator and times; minus; slashes of fractions and division; blanks of typesetting; micro
// and mu; degree and the ordinal sign that is taken for it; raised digits and their minus.
constexpr std::array signs{
    Sign{"\xc2\xb7", "*"},           Sign{"\xe2\x8b\x85", "*"},       Sign{"\xc3\x97", "*"},
    Sign{"\xe2\x88\x92", "-"},       Sign{"\xe2\x81\x84", "/"},       Sign{"\xe2\x88\x95", "/"},
    Sign{"\xc2\xa0", " "},           Sign{"\xe2\x80\x87", " "},       Sign{"\xe2\x80\x89", " "},
    Sign{"\xe2\x80\xaf", " "},       Sign{"\xc2\xb5", "u"},           Sign{"\xce\xbc", "u"},
    Sign{"\xc2\xb0", "deg"},         Sign{"\xc2\xba", "deg"},         Sign{"\xe2\x81\xbb", "-", true},
    Sign{"\xe2\x81\xb0", "0", true}, Sign{"\xc2\xb9", "1", true},     Sign{"\xc2\xb2", "2", true},
    Sign{"\xc2\xb3", "3", true},     Sign{"\xe2\x81\xb4", "4", true}, Sign{"\xe2\x81\xb5", "5", true},
    Sign{"\xe2\x81\xb6", "6", true}, Sign{"\xe2\x81\xb7", "7", true}, Sign{"\xe2\x81\xb8", "8", true},
    Sign{"\xe2\x81\xb9", "9", true}};

}   // namespace

std::string in_ascii(std::string_view text)
{
    std::string plain;
    bool is_raised = false;
    while (!text.empty()) {
        const auto* sign =
            std::ranges::find_if(signs, [&](const Sign& s) { return text.starts_with(s.typeset); });
        const bool is_sign = sign != signs.end();
        if (is_sign && sign->is_exponent && !is_raised) plain += '^';
        is_raised = is_sign && sign->is_exponent;
        plain += is_sign ? sign->plain : text.substr(0, 1);
        text.remove_prefix(is_sign ? sign->typeset.size() : 1);
    }
    return plain;
}

namespace {

/// A symbol that people write otherwise.
std::string other_spelling(std::string_view name)
{
    static constexpr std::array spellings{
        std::pair{"inches", "in"},   std::pair{"feet", "ft"},      std::pair{"foot", "ft"},
        std::pair{"lbs", "lb"},      std::pair{"pounds", "lb"},    std::pair{"sec", "s"},
        std::pair{"second", "s"},    std::pair{"seconds", "s"},    std::pair{"hour", "h"},
        std::pair{"hours", "h"},     std::pair{"hr", "h"},         std::pair{"minutes", "min"},
        std::pair{"meter", "m"},     std::pair{"meters", "m"},     std::pair{"metre", "m"},
        std::pair{"metres", "m"},    std::pair{"Kg", "kg"},        std::pair{"KG", "kg"},
        std::pair{"kgs", "kg"},      std::pair{"tonne", "t"},      std::pair{"newton", "N"},
        std::pair{"hz", "Hz"},       std::pair{"HZ", "Hz"},        std::pair{"radian", "rad"},
        std::pair{"radians", "rad"}, std::pair{"rads", "rad"},     std::pair{"RPM", "rpm"},
        std::pair{"rps", "rev/s"},   std::pair{"MM", "mm"},        std::pair{"Nmm", "N mm"},
        std::pair{"kNm", "kN m"},    std::pair{"lbfin", "lbf in"}, std::pair{"kph", "km/h"},
        std::pair{"kmh", "km/h"},    std::pair{"kmph", "km/h"},    std::pair{"knots", "kn"},
        std::pair{"kts", "kn"},      std::pair{"HP", "hp"},        std::pair{"PSI", "psi"},
        std::pair{"turn", "rev"},    std::pair{"turns", "rev"},    std::pair{"watt", "W"}};
    for (const auto& [other, ours] : spellings)
        if (name == other) return std::string(": write ") + ours;
    return {};
}

/// What a quantity of one dimension is taken for where one of another is wanted.
std::string_view mistaken(const Dimension& given, const Dimension& wanted)
{
    struct Pair {
        Dimension given, wanted;
        std::string_view hint;
    };
    static constexpr Dimension mass{0, 1, 0, 0}, force{1, 1, -2, 0}, torque{2, 1, -2, 0},
        frequency{0, 0, -1, 0}, rate{0, 0, -1, 1}, angle{0, 0, 0, 1}, pure{};
    static constexpr std::array pairs{
        Pair{mass, force, "that is a mass; a force is in N, kgf or lbf"},
        Pair{force, mass, "that is a force; a mass is in kg or lb"},
        Pair{frequency, rate, "that is a frequency; an angular velocity is in rad/s, deg/s, rev/s or rpm"},
        Pair{rate, frequency, "that is an angular velocity; a frequency is in Hz: 60 rpm are 1 Hz"},
        Pair{force, torque, "that is a force; a torque has a length, too: N m, lbf in"},
        Pair{torque, force, "that is a torque; along a length it is a force: N, lbf"},
        Pair{{0, 1, -2, 0},
             {2, 1, -2, -1},
             "that is the stiffness of a length; of an angle it is in N m/rad or N m/deg"},
        Pair{torque, {2, 1, -2, -1}, "a stiffness of an angle is for each radian or degree: N m/rad"},
        Pair{{2, 1, -1, 0}, {2, 1, -1, -1}, "a damping of an angle is for each rad/s: N m s/rad"},
        Pair{angle, rate, "that is an angle; its rate is for each second: deg/s"},
        Pair{pure, angle, "angles have a unit: rad, deg or rev"},
        Pair{{0, 1, 0, 0}, {2, 1, 0, 0}, "that is a mass; a moment of inertia is in kg m^2"}};
    for (const Pair& p : pairs)
        if (p.given == given && p.wanted == wanted) return p.hint;
    return {};
}

std::optional<Unit> find_symbol(std::string_view name)
{
    for (const Symbol& s : symbols)
        if (s.name == name) return s.unit;
    // Whole symbols are tried before prefixes: "m" alone is a metre, "min" a minute.
    for (const Prefix& p : prefixes) {
        if (name.substr(0, p.name.size()) != p.name) continue;
        for (const Symbol& s : symbols) {
            if (!s.takes_prefix || s.name != name.substr(p.name.size())) continue;
            Unit unit = s.unit;
            unit.power_of_ten += p.power_of_ten;
            return unit;
        }
    }
    return std::nullopt;
}

/// Numerators by numerators: quotients would be rounded factor by factor.
void multiply(Unit& unit, const Unit& factor, int exponent)
{
    for (int i = 0; i < std::abs(exponent); ++i) {
        unit.numerator *= exponent > 0 ? factor.numerator : factor.denominator;
        unit.denominator *= exponent > 0 ? factor.denominator : factor.numerator;
    }
    unit.power_of_ten += exponent * factor.power_of_ten;
    for (std::size_t i = 0; i < unit.dimension.size(); ++i)
        unit.dimension[i] += exponent * factor.dimension[i];
}

/// Of a text without typeset signs, see in_ascii().
/// unit = product [ "/" ( factor | "(" product ")" ) ];  product = factor { (" " | "*") factor };
/// factor = symbol [ "^" [ "-" ] digit ]
class UnitParser {
public:
    explicit UnitParser(std::string_view text) : rest_(text) {}

    std::optional<Unit> parse(std::string& reason)
    {
        Unit unit;
        product(unit, 1);
        // At most one slash: a/b/c and a/b c are read in two ways by people.
        if (reason_.empty() && take("/")) quotient(unit);
        skip_blanks();
        if (reason_.empty() && !rest_.empty())
            reason_ = "'" + std::string(rest_) + "' cannot be read as a unit";
        reason = reason_;
        return reason_.empty() ? std::optional(unit) : std::nullopt;
    }

private:
    void skip_blanks()
    {
        while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\t')) rest_.remove_prefix(1);
    }
    bool take(std::string_view word)
    {
        skip_blanks();
        if (rest_.substr(0, word.size()) != word) return false;
        rest_.remove_prefix(word.size());
        return true;
    }
    bool ends_product()
    {
        skip_blanks();
        return rest_.empty() || rest_.front() == '/' || rest_.front() == ')';
    }

    void product(Unit& unit, int sign)
    {
        factor(unit, sign);
        while (reason_.empty() && (take("*") || !ends_product())) factor(unit, sign);
    }

    void quotient(Unit& unit)
    {
        if (take("(")) {
            product(unit, -1);
            if (reason_.empty() && !take(")")) reason_ = "a parenthesis is not closed";
        } else {
            factor(unit, -1);
        }
        skip_blanks();
        if (reason_.empty() && !rest_.empty())
            reason_ = "what a slash divides by is ambiguous: put it in parentheses, as in kg/(m s)";
    }

    void factor(Unit& unit, int sign)
    {
        skip_blanks();
        const std::size_t length = std::min(rest_.find_first_of(" \t*/^()"), rest_.size());
        const std::string_view name = rest_.substr(0, length);
        const std::optional<Unit> found = find_symbol(name);
        if (!found) {
            reason_ = name.empty() ? missing_factor()
                                   : "'" + std::string(name) + "' is no unit known here" + meant(name);
            return;
        }
        rest_.remove_prefix(length);
        int exponent = 1;
        if (!rest_.empty() && rest_.front() == '^') {
            const std::from_chars_result r =
                std::from_chars(rest_.data() + 1, rest_.data() + rest_.size(), exponent);
            if (r.ec != std::errc() || exponent < -largest_exponent || exponent > largest_exponent) {
                reason_ = "an exponent is a whole number from -9 to 9";
                return;
            }
            rest_.remove_prefix(static_cast<std::size_t>(r.ptr - rest_.data()));
        }
        multiply(unit, *found, sign * exponent);
    }

    std::string missing_factor() const
    {
        return rest_.starts_with('*') ? "powers are written with ^, as in m^2" : "a unit is missing";
    }
    /// Another spelling of a symbol, or a power without its caret.
    static std::string meant(std::string_view name)
    {
        const std::size_t digits = name.find_last_not_of("0123456789-") + 1;
        const std::string symbol(name.substr(0, digits));
        if (digits == name.size() || !find_symbol(symbol)) return other_spelling(name);
        return ": write " + symbol + "^" + std::string(name.substr(digits));
    }

    std::string_view rest_;
    std::string reason_;
};

}   // namespace

double in_si(double number, const Unit& unit)
{
    // Dividing by 10^3 rounds once; multiplying with 1e-3, which is no double, rounds twice.
    const double ten = std::pow(10.0, std::abs(unit.power_of_ten));   // exact up to 10^22
    return unit.power_of_ten < 0 ? number * unit.numerator / (unit.denominator * ten)
                                 : number * unit.numerator * ten / unit.denominator;
}

std::optional<Unit> parse_unit(std::string_view text, std::string& reason)
{
    const std::string plain = in_ascii(text);
    return UnitParser(plain).parse(reason);
}

Quantity parse_quantity(std::string_view given, std::string_view si_unit)
{
    const std::string wanted(si_unit), text = in_ascii(given);
    std::string_view rest = text;
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    // `from_chars` knows no plus sign, which people write; "+-5" stays an error.
    if (rest.size() > 1 && rest[0] == '+' && rest[1] != '-') rest.remove_prefix(1);
    double number = 0;
    const std::from_chars_result r = std::from_chars(rest.data(), rest.data() + rest.size(), number);
    if (r.ec == std::errc::result_out_of_range) return {0, "the number does not fit into 64 bits", ""};
    if (r.ec != std::errc())
        return {0, "it does not begin with a number", "write it like \"1.5 " + wanted + "\""};
    if (!std::isfinite(number)) return {0, "the number is not finite", ""};
    rest.remove_prefix(static_cast<std::size_t>(r.ptr - rest.data()));
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    if (rest.empty())
        return {0, "the unit is missing",
                "leave out the quotes for " + wanted + ", or write \"" + to_text(number) + " " + wanted +
                    "\""};
    std::string reason;
    const std::optional<Unit> unit = parse_unit(rest, reason);
    if (!unit) return {0, reason, std::string(known_units)};
    const std::optional<Unit> expected = parse_unit(si_unit, reason);
    if (!expected || unit->dimension != expected->dimension) {
        const std::string_view hint = expected ? mistaken(unit->dimension, expected->dimension) : "";
        return {0, "'" + std::string(rest) + "' is not a unit of this quantity",
                "it is measured in " + wanted + (hint.empty() ? "" : "; " + std::string(hint))};
    }
    const double value = in_si(number, *unit);
    if (!std::isfinite(value)) return {0, "the number does not fit into 64 bits", ""};
    return {value, "", ""};
}

}   // namespace livens::inline io_internal
