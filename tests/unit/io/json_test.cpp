// SPDX-License-Identifier: BSD-3-Clause
#include "livens/io/json.h"

#include <gtest/gtest.h>

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace livens::json_test {

namespace {

TEST(Json, WritesNestedValuesOnOneLine)
{
    JsonWriter json;
    json.begin_object()
        .member("a", 1)
        .key("b")
        .begin_array()
        .value(true)
        .value("x")
        .value(0.5)
        .null()
        .end_array();
    json.key("c").begin_object().end_object().key("d").begin_array().end_array().end_object();
    EXPECT_EQ(json.text(), R"({"a": 1, "b": [true, "x", 0.5, null], "c": {}, "d": []})");
}

TEST(Json, IndentsObjectsAndArraysButNotRowsOfNumbers)
{
    JsonWriter json(2);
    constexpr std::array row{1.0, 2.5};
    json.begin_object()
        .member("row", std::span<const double>(row))
        .key("list")
        .begin_array()
        .value(1)
        .value(2);
    json.end_array().end_object();
    EXPECT_EQ(json.text(), "{\n  \"row\": [1, 2.5],\n  \"list\": [\n    1,\n    2\n  ]\n}");
}

TEST(Json, NumbersReadBackToTheSameBits)
{
    for (const double x : {0.1, 1.0 / 3, 1e-300, 5e-324, 1.7976931348623157e308, -0.0, 123456789.0, 1e21}) {
        JsonWriter json;
        json.value(x);
        double back = 0;
        const std::string& text = json.text();
        const std::from_chars_result r = std::from_chars(text.data(), text.data() + text.size(), back);
        EXPECT_EQ(r.ptr, text.data() + text.size()) << text;
        EXPECT_EQ(std::signbit(back), std::signbit(x));
        EXPECT_EQ(back, x);
    }
}

TEST(Json, NumbersThatJsonCannotSayAreNull)
{
    const std::array odd{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                         1.0};
    JsonWriter json;
    json.begin_array().value(odd[0]).value(-odd[1]).value(std::span<const double>(odd)).end_array();
    EXPECT_EQ(json.text(), "[null, null, [null, null, 1]]");
}

TEST(Json, StringsAreEscapedAndAlwaysUtf8)
{
    const auto written = [](std::string_view text) {
        JsonWriter json;
        json.value(text);
        return json.text();
    };
    EXPECT_EQ(written("a\"b\\c\n\t"), R"("a\"b\\c\n\t")");
    EXPECT_EQ(written(std::string_view("\x00\x1b\x7f", 3)), R"("\u0000\u001b\u007f")");
    EXPECT_EQ(written("\xc3\xbc \xf0\x9f\x8c\x8d"), "\"\xc3\xbc \xf0\x9f\x8c\x8d\"");
    EXPECT_EQ(written("\xff"), R"("\ufffd")");
    EXPECT_EQ(written("\xc0\x80"), R"("\ufffd\ufffd")");             // overlong zero
    EXPECT_EQ(written("\xed\xa0\x80"), R"("\ufffd\ufffd\ufffd")");   // surrogate
    EXPECT_EQ(written("\xe2\x82"), R"("\ufffd\ufffd")");             // cut off
}

TEST(Json, IntegersAreNotRounded)
{
    JsonWriter json;
    json.begin_array()
        .value(std::numeric_limits<long long>::min())
        .value(std::numeric_limits<unsigned long>::max());
    json.end_array();
    EXPECT_EQ(json.text(), "[-9223372036854775808, 18446744073709551615]");
}

#ifndef NDEBUG
TEST(JsonDeathTest, MisuseIsAsserted)
{
    EXPECT_DEATH(JsonWriter().begin_object().value(1), "");   // no key
    EXPECT_DEATH(JsonWriter().begin_array().key("a"), "");    // no object
    EXPECT_DEATH(JsonWriter().begin_array().end_object(), "");
}
#endif

}   // namespace

}   // namespace livens::json_test
