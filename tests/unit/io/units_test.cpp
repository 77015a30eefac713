// SPDX-License-Identifier: BSD-3-Clause
#include "livens/io/scenario/text/units.h"

#include <gtest/gtest.h>

#include <numbers>

namespace livens::units_test {

namespace {

double si(std::string_view text, std::string_view unit)
{
    const Quantity q = parse_quantity(text, unit);
    EXPECT_EQ(q.error, "") << text;
    return q.value;
}

TEST(Units, DecimalPrefixesRoundOnce)
{
    EXPECT_EQ(si("5 mm", "m"), 0.005);   // 5 * 0.001 is one bit off for many others
    EXPECT_EQ(si("0.3 cm", "m"), 0.003);
    EXPECT_EQ(si("9 um", "m"), 9e-6);
    EXPECT_EQ(si("9 \xc2\xb5m", "m"), 9e-6);
    EXPECT_EQ(si("7 g", "kg"), 0.007);
    EXPECT_EQ(si("3 cm^2", "m^2"), 3e-4);
    for (int i = 1; i < 1000; ++i) EXPECT_EQ(si(std::to_string(i) + " ms", "s"), i / 1000.0);
}

TEST(Units, AnglesAreInRadians)
{
    EXPECT_EQ(si("180 deg", "rad"), std::numbers::pi);
    EXPECT_EQ(si("1 rev", "rad"), 2 * std::numbers::pi);
    EXPECT_DOUBLE_EQ(si("60 rpm", "rad/s"), 2 * std::numbers::pi);
    EXPECT_DOUBLE_EQ(si("360 deg/min", "rad/s"), std::numbers::pi / 30);
}

TEST(Units, OfInchesAndPoundsAreExact)
{
    EXPECT_EQ(si("1 in", "m"), 0.0254);
    EXPECT_EQ(si("3 ft", "m"), 0.9144);
    EXPECT_EQ(si("1 yd", "m"), 0.9144);
    EXPECT_EQ(si("1 mi", "m"), 1609.344);
    EXPECT_EQ(si("1 lb", "kg"), 0.45359237);
    EXPECT_EQ(si("16 oz", "kg"), 0.45359237);
    EXPECT_EQ(si("1 lbf", "N"), 4.4482216152605);
    EXPECT_EQ(si("1 kip", "N"), 4448.2216152605);
    EXPECT_EQ(si("16 ozf", "N"), 4.4482216152605);
    EXPECT_EQ(si("1 kgf", "N"), 9.80665);
    EXPECT_DOUBLE_EQ(si("1 psi", "Pa"), 6894.757293168361);   // NIST SP 811, B.8
    EXPECT_DOUBLE_EQ(si("1 slug", "kg"), 14.593902937206364);
    EXPECT_DOUBLE_EQ(si("1 lbf in", "N m"), 0.1129848290276167);
    EXPECT_DOUBLE_EQ(si("1 lbf/in", "N/m"), 175.12683524647636);
    EXPECT_EQ(si("1 mph", "m/s"), 0.44704);
    EXPECT_DOUBLE_EQ(si("1 hp", "W"), 745.6998715822702);
    EXPECT_EQ(si("2 bar", "Pa"), 2e5);
    EXPECT_EQ(si("2 mbar", "Pa"), 200);
    EXPECT_EQ(si("30\xc2\xb0", "rad"), si("30 deg", "rad"));
    EXPECT_EQ(si("30 \xc2\xb0/s", "rad/s"), si("30 deg/s", "rad/s"));
    EXPECT_EQ(si("7 Nm", "N m"), 7);
    EXPECT_NE(parse_quantity("3 inches", "m").error.find("write in"), std::string::npos);
    EXPECT_NE(parse_quantity("3 lb", "N").error, "") << "a mass is no force";
}

TEST(Units, ProductsQuotientsAndPowers)
{
    EXPECT_EQ(si("7850 kg/m^3", "kg/m^3"), 7850);
    EXPECT_EQ(si("3 N m", "N m"), 3);
    EXPECT_EQ(si("3 N*m", "kg m^2/s^2"), 3);
    EXPECT_EQ(si("3 J", "N m"), 3);
    EXPECT_EQ(si("2 kN/m", "N/m"), 2000);
    EXPECT_EQ(si("2 N/mm", "N/m"), 2000);
    EXPECT_EQ(si("1 g/cm^3", "kg/m^3"), 1000);
    EXPECT_EQ(si("4 N s/m", "N s/m"), 4);
}

TEST(Units, ParenthesesAndInverses)
{
    EXPECT_EQ(si("4 kg/(m s)", "Pa s"), 4);
    EXPECT_EQ(si("4 1/s", "1/s"), 4);
    EXPECT_EQ(si("4 s^-1", "1/s"), 4);
    EXPECT_EQ(si("36 m/h", "m/s"), 0.01);
    EXPECT_EQ(si("+1.5e2mm", "m"), 0.15);
    EXPECT_EQ(si("  -2 t", "kg"), -2000);
}

TEST(Units, TypesetSignsAreReadLikeThoseOfAKeyboard)
{
    EXPECT_EQ(si("7850 kg/m\u00b3", "kg/m^3"), 7850);
    EXPECT_EQ(si("9.81 m\u00b7s\u207b\u00b2", "m/s^2"), 9.81);
    EXPECT_EQ(si("7 N\u22c5m", "N m"), 7);
    EXPECT_EQ(si("7\u00a0N\u2009m", "N m"), 7);
    EXPECT_EQ(si("\u22125\u202fmm", "m"), -0.005);
    EXPECT_EQ(si("2 \u03bcm", "m"), 2e-6);
    EXPECT_EQ(si("2 kg\u00d7m\u00b2", "kg m^2"), 2);
    EXPECT_EQ(si("30\u00ba", "rad"), si("30 deg", "rad"));
    EXPECT_EQ(si("3 m\u2044s", "m/s"), 3);
    for (const char* text : {"1 m\u00b2\u00b2\u00b2", "1 \u00b2", "1 m\u207b", "1 \u00b0C", "1\u00b3 m",
                             "1 m\u00b2\u207b", "1 m\u207b\u00b9\u00b2"})
        EXPECT_NE(parse_quantity(text, "m").error, "") << text;
}

TEST(Units, OfStandardGravityAndOfSeldomPrefixes)
{
    EXPECT_EQ(si("1 g0", "m/s^2"), 9.80665);
    EXPECT_EQ(si("1000 mil", "m"), 0.0254);
    EXPECT_EQ(si("3 hPa", "Pa"), 300);
    EXPECT_EQ(si("3 daN", "N"), 30);
    EXPECT_EQ(si("2 h", "s"), 7200) << "an hour, no prefix";
}

TEST(Units, MistakenQuantitiesAreNamed)
{
    struct Mistake {
        std::string text, wanted, hint;
    };
    for (const Mistake& m : {Mistake{"5 kg", "N", "kgf or lbf"},
                             {"5 lbf", "kg", "a mass is in kg or lb"},
                             {"60 Hz", "rad/s", "rpm"},
                             {"60 rpm", "Hz", "60 rpm are 1 Hz"},
                             {"5 N", "N m", "torque"},
                             {"5 N/m", "N m/rad", "N m/rad or N m/deg"},
                             {"5 deg", "rad/s", "deg/s"},
                             {"5 N m", "N m/rad", "each radian"},
                             {"1 kg/m3", "kg/m^3", "units are"}}) {
        const Quantity q = parse_quantity(m.text, m.wanted);
        EXPECT_NE(q.error, "") << m.text;
        EXPECT_NE(q.help.find(m.hint), std::string::npos) << m.text << ": " << q.help;
    }
    EXPECT_NE(parse_quantity("1 kg/m3", "kg/m^3").error.find("write m^3"), std::string::npos);
    EXPECT_NE(parse_quantity("1 kg*m**2", "kg m^2").error.find("m^2"), std::string::npos);
}

TEST(Units, AmbiguousAndUnknownOnesAreRefused)
{
    for (const char* text :
         {"1 J/kg m", "1 m/s/s", "1 N/(m/s)", "1 m^", "1 m^1.5", "1 m^99", "1 M", "1 furlong", "1 mmm",
          "1 (m)", "1 m *", "1 m/", "1 kg/(m s", "1 m)", "1 \xc2", "1 kmin", "1 kt", "1 \xc3\xbc"}) {
        std::string reason;
        EXPECT_FALSE(parse_unit(std::string_view(text).substr(2), reason).has_value()) << text;
        EXPECT_NE(reason, "") << text;
        EXPECT_NE(parse_quantity(text, "m").error, "") << text;
    }
    for (const char* text : {"J/kg m", "m/s/s", "m^-1/s s"}) {
        std::string reason;
        parse_unit(text, reason);
        EXPECT_NE(reason.find("as in kg/(m s)"), std::string::npos) << text << ": " << reason;
    }
}

TEST(Units, OtherDimensionsAreRefused)
{
    EXPECT_NE(parse_quantity("1 s", "m").error, "");
    EXPECT_NE(parse_quantity("1 1/s", "rad/s").error, "") << "a frequency is not a spin";
    EXPECT_NE(parse_quantity("1 deg", "m").error, "");
}

TEST(Units, NumbersAreReadWholeAndFinite)
{
    for (const char* text : {"", " ", "m", "1,5 m", "nan m", "inf m", "-inf m", "1e999 m", "1e300 Mm^9",
                             "--1 m", "+-1 m", "0x10 m", "1 000 m", "1", "1_0 m", "1e m"})
        EXPECT_NE(parse_quantity(text, "m").error, "") << "\"" << text << "\"";
}

}   // namespace

}   // namespace livens::units_test
