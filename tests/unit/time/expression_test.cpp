// SPDX-License-Identifier: BSD-3-Clause
#include "livens/time/expression.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "livens/base/error.h"

namespace livens::expression_test {
namespace {

double value(const std::string& text, double t = 0, std::vector<double> x = {})
{
    return Expression(text, {"x", "y", "z"})(t, x.empty() ? std::vector<double>{0.3, -1.2, 2} : x);
}

TEST(Expression, ReadsAsMathematicsDoes)
{
    EXPECT_EQ(value("1 + 2*3"), 7);
    EXPECT_EQ(value("(1 + 2)*3"), 9);
    EXPECT_EQ(value("8 - 3 - 2"), 3);
    EXPECT_EQ(value("8/4/2"), 1);
    EXPECT_EQ(value("2^3^2"), 512);
    EXPECT_EQ(value("-2^2"), -4);
    EXPECT_EQ(value("2^-1"), 0.5);
    EXPECT_EQ(value("(-2)^3"), -8);
    EXPECT_EQ(value("- - 3"), 3);
    EXPECT_EQ(value("1e-3 + .5 + 2.e1"), 20.501);
    EXPECT_EQ(value("pi"), std::acos(-1.0));
    EXPECT_EQ(value(" x *\t y "), 0.3 * -1.2);
    EXPECT_EQ(value("min(x, y) + max(x, y)*10"), -1.2 + 3);
    EXPECT_EQ(value("abs(y)"), 1.2);
    EXPECT_EQ(value("t", 0.7), 0.7);
    EXPECT_DOUBLE_EQ(value("atan2(y, x)"), std::atan2(-1.2, 0.3));
    EXPECT_DOUBLE_EQ(value("tanh(z)"), std::tanh(2.0));
    EXPECT_DOUBLE_EQ(value("tanh(1e-9)"), 1e-9);
    EXPECT_EQ(value("tanh(-1000)"), -1);
    EXPECT_DOUBLE_EQ(value("log(exp(x)) + sqrt(z)^2 + tan(x) - sin(x)/cos(x)"), 2.3);
}

/// By central differences of order 4 of the value alone.
double difference(const std::function<double(double)>& f, double h)
{
    return (8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h);
}

TEST(Expression, HasExactDerivatives)
{
    for (const std::string text :
         {"sin(x*t)*y^3", "x^y", "exp(-z*t)/(1 + x^2)", "atan2(x + t, y)", "tanh(x*y - t)",
          "sqrt(x + z)*log(z)", "abs(y)*tan(x)", "min(x, z)^2*max(y, t)", "z^2.5 + x^0 + (y)^2",
          "cos(x)^2 + t^3*x", "-x/(y*z)", "asin(x*t) + acos(x^2)*y", "atan(y*t)*sinh(x) - cosh(z*t)",
          "step(x, 0.2, y, 1.4, z*t) + step(x)*y", "sign(x)*y + floor(3*x)*z"}) {
        const Expression of(text, {"x", "y", "z"});
        const std::array<double, 3> at{0.7, 1.3, 1.9};
        const double t = 0.4;
        std::array<double, 3> slopes{};
        EXPECT_EQ(of(t, at, slopes), of(t, at));
        for (std::size_t k = 0; k < 3; ++k) {
            const auto moved = [&](double h) {
                std::array<double, 3> x = at;
                x[k] += h;
                return of(t, x);
            };
            EXPECT_NEAR(slopes[k], difference(moved, 1e-3), 1e-9) << text << ", symbol " << k;
        }
        const TimeValue rates = of.by_time(t, at);
        EXPECT_NEAR(rates.first, difference([&](double h) { return of(t + h, at); }, 1e-3), 1e-9) << text;
        EXPECT_NEAR(rates.second, difference([&](double h) { return of.by_time(t + h, at).first; }, 1e-3),
                    1e-8)
            << text;
    }
}

TEST(Expression, HasSlopesWhereTermsOfThemHaveNone)
{
    std::array<double, 3> slopes{};
    Expression("x^2 + y^1", {"x", "y", "z"})(0, std::array<double, 3>{0, 0, 0}, slopes);
    EXPECT_EQ(slopes[0], 0);
    EXPECT_EQ(slopes[1], 1);
    // The root does not move with z, so its infinite slope is nobody's.
    Expression("sqrt(x) + z", {"x", "y", "z"})(0, std::array<double, 3>{0, 0, 0}, slopes);
    EXPECT_EQ(slopes[2], 1);
}

std::string code_of(const std::string& text, const std::vector<std::string>& symbols,
                    std::string* where = nullptr)
{
    try {
        const Expression of(text, symbols);
    } catch (const InputError& error) {
        if (where != nullptr) *where = error.complaint().value;
        return error.complaint().code;
    }
    return "";
}

TEST(Expression, RefusesWhatIsNone)
{
    for (const char* text : {"", "1 +", "(1", "1)", "2 x", "sin x", "sin()", "sin(1, 2)", "atan2(1)",
                             "1 ** 2", "*", "1e", "1e999", ".", "x y", "#", "1; 2", "x = 2", "\xc3\xa9"})
        EXPECT_EQ(code_of(text, {"x", "y"}), "expression-syntax") << text;
    std::string where;
    EXPECT_EQ(code_of("1 + foo(2)", {"x"}, &where), "expression-name");
    EXPECT_NE(where.find("column 5"), std::string::npos) << where;
    EXPECT_EQ(code_of("1 + 2/(3 - 3)", {}, &where), "expression-value");
    EXPECT_EQ(where, "division by 0 at column 6");
    for (const char* text : {"log(-1)", "log(0)", "sqrt(-2)", "10^1000", "(-2)^0.5", "exp(1e6)"})
        EXPECT_EQ(code_of(text, {}), "expression-value") << text;
    EXPECT_EQ(code_of("1/x", {"x"}), "");   // not known yet
    for (const char* symbol : {"", "t", "pi", "sin", "step", "1a", "a b"})
        EXPECT_EQ(code_of("1", {symbol}), "expression-name") << symbol;
    EXPECT_EQ(code_of(std::string(1001, '1'), {}), "expression-size");
    EXPECT_EQ(code_of(std::string(65, '(') + "1" + std::string(65, ')'), {}), "expression-size");
    EXPECT_EQ(code_of(std::string(62, '(') + "1" + std::string(62, ')'), {}), "");
    EXPECT_EQ(code_of("1", std::vector<std::string>(65, "a")), "expression-size");
}

TEST(Expression, AnswersHabitsOfOtherLanguages)
{
    struct Habit {
        std::string text, answer;
    };
    for (const Habit& h : {Habit{"2t", "2*t"},
                           {"2(t + 1)", "2*t"},
                           {"(t)(t)", "2*t"},
                           {"t > 1", "step(t - 1)"},
                           {"t == 1", "step(t - 1)"},
                           {"t > 1 ? 2 : 3", "step(t - 1)"},
                           {"t % 2", "x - y*floor(x/y)"},
                           {"mod(t, 2)", "x - y*floor(x/y)"},
                           {"ceil(t)", "-floor(-x)"},
                           {"sin(30 deg)", "pi/180"},
                           {"2 rad", "left out"},
                           {"min(t, 1, 2)", "min(a, min(b, c))"},
                           {"1,5*t", "point"},
                           {"STEP5(t, 0, 0, 1, 1)", "'step'"},
                           {"t**2", "x^2"},
                           {"[t]", ""},
                           {"hypot(t, 1)", "sqrt"}})
        try {
            Expression(h.text, {});
            ADD_FAILURE() << h.text;
        } catch (const InputError& e) {
            EXPECT_NE(e.complaint().help.find(h.answer), std::string::npos) << h.text << ": " << e.what();
        }
}

TEST(Expression, HasFunctionsThatAreMadeOfOthers)
{
    for (const double x : {-1.0, -0.999999999, -0.3, 0.0, 1e-9, 0.7, 1.0}) {
        EXPECT_DOUBLE_EQ(value("asin(x)", 0, {x, 0, 0}), std::asin(x)) << x;
        EXPECT_DOUBLE_EQ(value("acos(x)", 0, {x, 0, 0}), std::acos(x)) << x;
        EXPECT_DOUBLE_EQ(value("atan(7*x)", 0, {x, 0, 0}), std::atan(7 * x)) << x;
        EXPECT_NEAR(value("sinh(x)", 0, {x, 0, 0}), std::sinh(x), 4e-16 * std::abs(x)) << x;
        EXPECT_DOUBLE_EQ(value("cosh(x)", 0, {x, 0, 0}), std::cosh(x)) << x;
        EXPECT_EQ(value("floor(10*x)", 0, {x, 0, 0}), std::floor(10 * x)) << x;
        EXPECT_EQ(value("sign(x)", 0, {x, 0, 0}), (x > 0) - (x < 0)) << x;
        EXPECT_EQ(value("step(x)", 0, {x, 0, 0}), 0.5 + 0.5 * ((x > 0) - (x < 0))) << x;
    }
    // As ADAMS has it: a cubic between two levels.
    EXPECT_EQ(value("step(t, 1, 5, 3, -3)", 0.5), 5);
    EXPECT_EQ(value("step(t, 1, 5, 3, -3)", 2), 1);
    EXPECT_DOUBLE_EQ(value("step(t, 1, 5, 3, -3)", 1.5), 5 - 8 * 0.25 * 0.25 * 2.5);
    EXPECT_EQ(value("step(t, 1, 5, 3, -3)", 4), -3);
    EXPECT_EQ(code_of("step(t, 1)", {}), "expression-syntax");
    EXPECT_EQ(code_of("asin(1.5)", {}), "expression-value");
    EXPECT_TRUE(std::isnan(value("sign(x)", 0, {std::nan(""), 0, 0})));
}

TEST(Expression, TakesNamesWithPoints)
{
    const std::string text = "2*shaft.angle + 'crank pin'.angle_rate/2.5e1 - shaft.angle^2 + t.x_1";
    const std::vector<std::string> names = names_with_points(text);
    EXPECT_EQ(names, (std::vector<std::string>{"shaft.angle", "crank pin.angle_rate", "t.x_1"}));
    const Expression of(text, names);
    EXPECT_DOUBLE_EQ(of(0, std::array<double, 3>{3, 50, 7}), 6 + 2 - 9 + 7);
    EXPECT_EQ(names_with_points("2.*x + 3.5/y.z1 - .5"), std::vector<std::string>{"y.z1"});
    EXPECT_TRUE(names_with_points("sin(t) + x").empty());
    std::string help;
    EXPECT_EQ(code_of("1 + 'open", {}, &help), "expression-syntax");
    EXPECT_EQ(code_of("1 + shaft.angle", {}, &help), "expression-name");
    EXPECT_NE(help.find("'shaft.angle' at column 5"), std::string::npos) << help;
}

TEST(Expression, SaysWhereItHasNoValue)
{
    const Expression of("1 + 3/(x - t)", {"x"});
    EXPECT_EQ(of.without_value(1, std::array<double, 1>{2}), "");
    EXPECT_EQ(of.without_value(2, std::array<double, 1>{2}), "division by 0 at column 6");
    EXPECT_EQ(Expression("sqrt(x)", {"x"}).without_value(0, std::array<double, 1>{-2}),
              "sqrt(-2) at column 1");
}

TEST(Expression, KnowsWhereTimeAloneMakesItJumpOrBend)
{
    const auto events = [](const std::string& text) { return Expression(text, {"x"}).events(0, 4); };
    const auto expect = [&](const std::string& text, const std::vector<double>& wanted) {
        const std::vector<double> found = events(text);
        ASSERT_EQ(found.size(), wanted.size()) << text;
        for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], wanted[i], 1e-14) << text;
    };
    expect("x*abs(t - 1.348)", {1.348});
    // A short ramp is fenced in like a pulse; nothing lies beside the bends themselves.
    const std::vector<double> ramp = events("x*max(0, min(1, 10*(t - 1)))");
    for (const double bend : {1.0, 1.1}) {
        const auto near = [bend](double t) { return std::abs(t - bend) < 1e-3; };
        ASSERT_EQ(std::ranges::count_if(ramp, near), 1) << bend;
        EXPECT_NEAR(*std::ranges::find_if(ramp, near), bend, 1e-14);
    }
    expect("x*abs(t - 2)/(t - 2)", {2});
    expect("x + min(sin(t), 0.5)", {std::asin(0.5), std::acos(-1.0) - std::asin(0.5)});
    expect("max(x, t)", {});
    // atan2(y, x) jumps on the negative half of its axis and through the origin, and nowhere else.
    const auto ends_at = [&](const std::string& text, double instant) {   // beside its fences
        const std::vector<double> found = events(text);
        return std::ranges::count_if(found, [&](double t) { return std::abs(t - instant) < 1e-14; }) == 1;
    };
    EXPECT_TRUE(ends_at("x*atan2(sin(t), cos(t))", std::acos(-1.0)));
    for (const double jump : {1.3, 1.9, 3.8}) EXPECT_TRUE(ends_at("x + sign(t - 1.3)*floor(t/1.9)", jump));
    for (const std::string x : {"-1", "t - 1", "1 - t", "0"})
        EXPECT_TRUE(ends_at("atan2(t - 1, " + x + ")", 1));
    expect("x*atan2(0.1*sin(10*t), sqrt(1 - 0.01*sin(10*t)^2))", {});
    expect("atan2(sin(t - 1), 2 + cos(t))", {});
    expect("sin(3*t)*exp(-t) + t^2", {});
    EXPECT_TRUE(events("abs(sin(3000*t))").empty()) << "an oscillation";
    // Pulses are fenced in.
    const std::vector<double> fence = events("50*exp(-((t - 1.237)*2000)^2)");
    ASSERT_GE(fence.size(), 3u);
    EXPECT_LT(fence.front(), 1.236);
    EXPECT_GT(fence.back(), 1.238);
    EXPECT_EQ(Expression("1 + max(x, 0)", {"x"}).kink_by_symbols(), "max at column 5");
    EXPECT_EQ(Expression("max(t, 0)*x", {"x"}).kink_by_symbols(), "");
}

/// Values and slopes at any place of a way are within what is enclosed, on pieces of any width.
TEST(Expression, OverAWayEnclosesWhatItDoes)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(0, 1);
    for (const char* text :
         {"-3*x - 0.2*v", "exp(-((x - 1)/0.1)^2)", "tanh(40*v)*x", "sin(7*x + t)/(2 + cos(3*v))", "abs(x)*v",
          "max(x, v) - min(x*x, t)", "atan2(x - 1, v - 1)", "sqrt(1.5 + x) + log(2 + v*v)", "(2 + x)^v",
          "tan(0.3*x) + x^3 - v^-2", "x^2*v^4 - 2^x", "asin(0.3*x) + acos(0.2*v - 0.3)", "sinh(x)*cosh(v)",
          "step(x, 0, v, 1, 2)", "sign(x + 2)*v + floor(0.1*v)"}) {
        const Expression f(text, {"x", "v"});
        for (int i = 0; i < 200; ++i) {
            const double t0 = 3 * any(random), dt = any(random), x0 = 2 * any(random) - 0.5, dx = any(random),
                         v0 = 2 * any(random) + 0.1, dv = any(random);
            const auto at = [&](double s) {
                const double numbers[] = {x0 + s * dx, v0 + s * dv};
                return f(t0 + s * dt, numbers);
            };
            const double first = any(random), last = first + any(random) * (1 - first);
            const auto over = [&](double from, double by) {
                return EnclosedValue{{from + first * by, from + last * by}, {by, by}};
            };
            const EnclosedValue numbers[] = {over(x0, dx), over(v0, dv)};
            const EnclosedValue found = f.over(over(t0, dt), numbers);
            for (int k = 0; k < 5; ++k) {
                const double s = first + any(random) * (last - first), e = 1e-6 * (last - first);
                const double slack = 1e-9 * (1 + std::abs(at(s)));
                EXPECT_GE(at(s), found.value.low - slack) << text;
                EXPECT_LE(at(s), found.value.high + slack) << text;
                if (s - e < first || s + e > last) continue;
                const double slope = (at(s + e) - at(s - e)) / (2 * e), rounding = 1e-15 / e + 1e-6;
                EXPECT_GE(slope, found.slope.low - rounding * (1 + std::abs(slope))) << text;
                EXPECT_LE(slope, found.slope.high + rounding * (1 + std::abs(slope))) << text;
            }
        }
    }
    // far from a needle nothing can be hidden
    const Expression needle("100*exp(-((x - 2)/0.01)^2)", {"x"});
    const EnclosedValue far[] = {{{0, 1.8}, {1.8, 1.8}}}, near[] = {{{1.8, 2.2}, {0.4, 0.4}}};
    EXPECT_LT(needle.over({}, far).slope.size(), 1e-100);
    EXPECT_GT(needle.over({}, near).slope.size(), 1000);
}

TEST(Expression, KnowsWhetherItIsLinearInItsSymbols)
{
    const auto is_affine = [](const char* text) { return Expression(text, {"x", "v"}).is_affine(); };
    for (const char* text : {"-3*x - 0.2*v + sin(2*t)", "(x - v)/3 - -x", "2", "exp(t)*t - x", "pi*(x + 1)"})
        EXPECT_TRUE(is_affine(text)) << text;
    for (const char* text : {"x*v", "sin(x)", "t*x", "1/x", "x^2", "max(x, 0)", "x/t"})
        EXPECT_FALSE(is_affine(text)) << text;
}

TEST(Expression, HasGuardsWhereTheMotionDecides)
{
    const Expression f("abs(x) + max(v, t) + atan2(x, v) + abs(t)", {"x", "v"});
    ASSERT_EQ(f.guards().size(), 3u);
    double numbers[3];
    const double at[] = {-2, 3};
    f.guarded(1, at, numbers);
    EXPECT_EQ(numbers[0], -2);
    EXPECT_EQ(numbers[1], 2);
    EXPECT_NEAR(numbers[2], std::atan2(-2.0, 3.0), 1e-15);
    const Guard& angle = f.guards()[2];
    EXPECT_EQ(angle.piece_at(0.1).high, std::numbers::pi);
    EXPECT_EQ(angle.piece_at(0.1).low, -std::numbers::pi);
    EXPECT_NEAR(angle.following(-3, 3.2), 2 * std::numbers::pi - 3, 1e-15);
    const Expression jumps("sign(2*x) + floor(v)", {"x", "v"});
    ASSERT_EQ(jumps.guards().size(), 2u);
    jumps.guarded(0, at, numbers);
    EXPECT_EQ(numbers[0], -4);
    EXPECT_EQ(numbers[1], 3);
    EXPECT_EQ(jumps.guards()[1].piece_at(3.5).high, 4);
}

TEST(Guard, HasItsPiecesBetweenItsPlaces)
{
    const Guard guard{{-1, 2, 5}};
    EXPECT_EQ(guard.piece_at(2).high, 2) << "a place belongs to the piece below";
    EXPECT_EQ(guard.piece_at(2.1).low, 2);
    EXPECT_TRUE(std::isinf(guard.piece_at(6).high));
    EXPECT_EQ(guard.piece_at(3).margin(4.5), 0.5);
    EXPECT_EQ(guard.piece_at(3).margin(1), -1);
    const Guard round{{0, 1, 3}, 4};
    EXPECT_EQ(round.piece_at(3.5).high, 4) << "the seam";
    EXPECT_EQ(round.piece_at(9.5).low, 9);
    EXPECT_EQ(round.piece_at(-0.5).low, -1);
}

TEST(Expression, IsOnTheSideOfABreakThatIsMeant)
{
    const TimeFunction sign = expression_of_time(Expression("abs(t - 1)/(t - 1)", {}), {1});
    EXPECT_EQ(sign({1, Side::left}).value, -1);
    EXPECT_EQ(sign({1, Side::right}).value, 1);
}

/// Texts of all kinds are read or refused, and what is read is evaluated.
TEST(Expression, StandsAnyText)
{
    std::mt19937 random(7);
    const std::string seeds[] = {"sin(x)*exp(-t)", "atan2(y, x)^2/(1 + abs(t))",
                                 "-3*x - 0.2*y + min(x, max(y, 1))",
                                 "step(x, 0, 1, 2, y) + floor(asin('x'.y))"};
    const std::string letters = "0123456789.eE+-*/^(),xytpisncoaqrlgbmhd \t_#\"";
    int read = 0;
    for (int n = 0; n < 110000; ++n) {
        const auto which = random() % 10;
        std::string text = seeds[which < 9 ? which % 3 : 3];
        for (unsigned changes = 1 + random() % 4; changes > 0; --changes) {
            const std::size_t at = random() % (text.size() + 1);
            const char letter = letters[random() % letters.size()];
            if (random() % 3 == 0)
                text.insert(at, 1, letter);
            else if (random() % 2 == 0 && at < text.size())
                text[at] = letter;
            else if (at < text.size())
                text.erase(at, 1);
        }
        try {
            const Expression of(text, {"x", "y"});
            std::array<double, 2> slopes{};
            of(0.3, std::array<double, 2>{0.5, -0.7}, slopes);
            ++read;
        } catch (const InputError& error) {
            EXPECT_EQ(error.complaint().code.rfind("expression-", 0), 0u);
        }
    }
    EXPECT_GT(read, 5000);   // else it was no test of what can be read
}

}   // namespace
}   // namespace livens::expression_test
