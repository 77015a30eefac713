// SPDX-License-Identifier: BSD-3-Clause
// The format itself: bytes made by hand from the specification, and everything that hostile bytes can say.
#include "livens/io/results/classic_netcdf.h"

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "livens/io/results.h"
#include "unit/io/sample_run.h"

namespace livens::classic_netcdf_test {
namespace {

const std::string hash = "CHECKSUMCHECKSUM";   // stands for 16 digits

/// Two dimensions, an attribute of each kind, a variable of each kind.
std::string small_file(std::uint64_t largest = ClassicWriter::largest_in_cdf2)
{
    std::string image;
    ClassicWriter file(largest);
    file.dimension("t", 3);
    file.dimension("xy", 2);
    file.attribute("title", "hello");
    file.attribute("n", -2);
    file.attribute("x", 0.5);
    const int real = file.variable({"real", {"t", "xy"}, NumberType::real, {{"units", "m"}}});
    const int text = file.variable({"text", {"t"}, NumberType::text});
    const int whole = file.variable({"whole", {"xy"}, NumberType::integer});
    file.begin(into(image));
    file.append(real, std::vector<double>{1, -2, 3, 0.5});
    file.append(whole, std::vector<int>{1, -1});
    file.append(text, std::string_view("abc"));
    file.append(real, std::vector<double>{std::numeric_limits<double>::infinity(), 0});
    file.finish();
    return image;
}

/// Big-endian numbers and padded names; `count` is 4 bytes wide, in CDF-5 8.
class ByHand {
public:
    explicit ByHand(int count) : count_(count) {}
    ByHand& number(std::uint64_t n, int size)
    {
        for (int shift = 8 * (size - 1); shift >= 0; shift -= 8) bytes += static_cast<char>(n >> shift);
        return *this;
    }
    ByHand& tag(int n) { return number(static_cast<std::uint64_t>(n), 4); }
    ByHand& count(std::uint64_t n) { return number(n, count_); }
    ByHand& text(const std::string& s)
    {
        count(s.size());
        bytes += s;
        while (bytes.size() % 4 != 0) bytes += '\0';
        return *this;
    }
    ByHand& text_attribute(const std::string& name, const std::string& value)
    {
        return text(name).tag(2).text(value);
    }
    std::string bytes;

private:
    int count_;
};

std::string small_file_by_hand(int version)
{
    ByHand h(version == 5 ? 8 : 4);
    h.bytes = std::string("CDF") + static_cast<char>(version);
    h.count(0);                                                    // records
    h.tag(0x0a).count(2).text("t").count(3).text("xy").count(2);   // dimensions
    h.tag(0x0c).count(4).text_attribute("title", "hello");         // global attributes
    h.text("n").tag(4).count(1).number(0xfffffffe, 4);
    h.text("x").tag(6).count(1).number(0x3fe0000000000000, 8).text_attribute("livens_checksum", hash);
    const std::size_t header = version == 5 ? 592 : 432;
    h.tag(0x0b).count(3);
    h.text("real").count(2).count(0).count(1);
    h.tag(0x0c).count(2).text_attribute("units", "m").text_attribute("checksum", hash);
    h.tag(6).count(48).number(header, 8);
    h.text("text").count(1).count(0).tag(0x0c).count(1).text_attribute("checksum", hash);
    h.tag(2).count(4).number(header + 48, 8);
    h.text("whole").count(1).count(1).tag(0x0c).count(1).text_attribute("checksum", hash);
    h.tag(4).count(8).number(header + 52, 8);
    EXPECT_EQ(h.bytes.size(), header);
    constexpr std::uint64_t real[] = {0x3ff0000000000000, 0xc000000000000000, 0x4008000000000000,
                                      0x3fe0000000000000, 0x7ff0000000000000, 0};
    for (const std::uint64_t x : real) h.number(x, 8);
    h.bytes += std::string("abc\0", 4);
    h.number(1, 4).number(0xffffffff, 4);
    return h.bytes;
}

/// With the sixteen digits of every checksum replaced.
std::string without_checksums(std::string image)
{
    for (std::size_t at = 0; (at = image.find("checksum", at)) != std::string::npos; at += 8) {
        const std::size_t digits = image.find_first_of("0123456789abcdef", at + 8);
        image.replace(digits, hash.size(), hash);
    }
    return image;
}

TEST(ClassicNetcdf, BytesAreThoseOfTheSpecification)
{
    EXPECT_EQ(without_checksums(small_file()), small_file_by_hand(2));
    EXPECT_EQ(without_checksums(small_file(40)), small_file_by_hand(5)) << "a variable is larger than 40";
}

void expect_small_file(const ClassicReader& file)
{
    file.verify_header();
    EXPECT_EQ(file.dimension("t"), 3u);
    EXPECT_EQ(file.dimension("none"), 0u);
    EXPECT_EQ(*file.attribute("title"), AttributeValue("hello"));
    EXPECT_EQ(file.number("n"), -2);
    EXPECT_EQ(file.number("x"), 0.5);
    EXPECT_EQ(file.number("title"), std::nullopt);
    EXPECT_EQ(file.variable("none"), nullptr);
    std::vector<double> real(6);
    file.read(*file.variable("real"), real);
    EXPECT_EQ(real, (std::vector<double>{1, -2, 3, 0.5, std::numeric_limits<double>::infinity(), 0}));
    std::vector<int> whole(2);
    file.read(*file.variable("whole"), whole);
    EXPECT_EQ(whole, (std::vector<int>{1, -1}));
    EXPECT_EQ(file.bytes(*file.variable("text")), "abc");
    EXPECT_EQ(file.variable("real")->dimensions, (std::vector<std::string>{"t", "xy"}));
    EXPECT_EQ(*find_attribute(file.variable("real")->attributes, "units"), AttributeValue("m"));
}

TEST(ClassicNetcdf, WhatIsWrittenIsReadInBothFormats)
{
    for (const std::uint64_t largest : {ClassicWriter::largest_in_cdf2, std::uint64_t{40}}) {
        const std::string image = small_file(largest);
        expect_small_file(ClassicReader(source_of(image)));
    }
}

/// CDF-1, which others write: places are 4 bytes wide. And what livens never writes: records, short numbers.
TEST(ClassicNetcdf, FilesOfOthersAreRead)
{
    ByHand h(4);
    h.bytes = "CDF\1";
    h.count(7).tag(0x0a).count(1).text("t").count(0);
    h.tag(0x0c).count(2).text("shorts").tag(3).count(3).number(0x00010002, 4).number(0x00030000, 4);
    h.text("pair").tag(4).count(2).number(1, 4).number(2, 4);
    h.tag(0x0b).count(1).text("records").count(1).count(0).tag(0).count(0).tag(5).count(4).number(0, 4);
    h.number(h.bytes.size(), 0);
    for (int shift = 24, i = 4; i > 0; --i, shift -= 8)
        h.bytes[h.bytes.size() - static_cast<std::size_t>(i)] = static_cast<char>(h.bytes.size() >> shift);
    const ClassicReader file(source_of(h.bytes));
    EXPECT_EQ(file.attributes().size(), 2u);
    EXPECT_EQ(*file.attribute("shorts"), AttributeValue{});
    EXPECT_EQ(*file.attribute("pair"), AttributeValue{});
    EXPECT_EQ(file.variables().size(), 1u);
    EXPECT_THROW(file.verify_header(), IoError);
}

std::string code_of(const std::string& image)
{
    try {
        const ClassicReader file(source_of(image));
    } catch (const IoError& error) {
        return error.code();
    }
    return "";
}

TEST(ClassicNetcdf, SizesThatLieAreRefusedBeforeMemoryIsAskedFor)
{
    const std::string image = small_file_by_hand(2), wide = small_file_by_hand(5);
    EXPECT_EQ(code_of(image), "");
    const auto with = [](std::string bytes, std::size_t place, const std::string& other) {
        return code_of(bytes.replace(place, other.size(), other));
    };
    const std::string most("\x7f\xff\xff\xff", 4), negative("\xff\xff\xff\xff", 4);
    EXPECT_EQ(with(image, 12, most), "io-damaged") << "dimensions";
    EXPECT_EQ(with(image, 12, negative), "io-damaged") << "a negative number of dimensions";
    EXPECT_EQ(with(image, 16, most), "io-damaged") << "length of a name";
    EXPECT_EQ(with(image, 24, most), "io-truncated") << "length of a dimension";
    EXPECT_EQ(with(image, 8, std::string(4, '\0')), "io-damaged") << "no list, and yet of two";
    EXPECT_EQ(with(image, 8, std::string("\0\0\0\x0b", 4)), "io-damaged") << "another list";
    const std::size_t value = image.find("title") + 8;
    EXPECT_EQ(with(image, value, std::string("\0\0\0\x07", 4)), "io-damaged") << "a type of CDF-5";
    EXPECT_EQ(with(image, value + 4, most), "io-damaged") << "length of an attribute";
    EXPECT_EQ(with(image, image.find("real") + 8, std::string("\0\0\0\x02", 4)), "io-damaged")
        << "a dimension that does not exist";
    const std::size_t place = image.find("text") - 12;   // of `real`
    EXPECT_EQ(with(image, place, std::string(8, '\0')), "io-damaged") << "it begins within the header";
    EXPECT_EQ(with(image, place, std::string(8, '\xff')), "io-truncated");
    std::string empty = image;   // a length of zero, as that of records
    empty.replace(image.find("xy") + 4, 4, std::string(4, '\0'));
    EXPECT_EQ(with(empty, place, std::string(8, '\x7f')), "io-truncated") << "nothing, beyond the end";
    const std::string huge("\x7f\xff\xff\xff\xff\xff\xff\xff", 8);
    EXPECT_EQ(with(wide, wide.find("xy") - 16, huge), "io-damaged") << "t x xy overflows";
    EXPECT_EQ(with(wide, 16, huge), "io-damaged");
    EXPECT_EQ(with(wide, 24, huge), "io-damaged") << "length of a name";
}

TEST(ClassicNetcdf, DamageIsNamed)
{
    const std::string whole = small_file();
    const auto said = [&](std::size_t place, const char* variable) -> std::string {
        std::string image = whole;
        image[place] = static_cast<char>(image[place] ^ 4);
        const ClassicReader file(source_of(image));
        try {
            if (variable == nullptr)
                file.verify_header();
            else
                file.verify(*file.variable(variable));
        } catch (const IoError& error) {
            return error.code() + ": " + error.what();
        }
        return "nothing";
    };
    EXPECT_TRUE(said(whole.find("hello"), nullptr).starts_with("io-damaged: its header"));
    EXPECT_EQ(said(whole.size() - 1, nullptr), "nothing");
    EXPECT_TRUE(said(whole.size() - 1, "whole").starts_with("io-damaged: variable 'whole'"));
    EXPECT_EQ(said(whole.size() - 1, "real"), "nothing");
    EXPECT_TRUE(said(whole.size() - 9, "text").starts_with("io-damaged")) << "what fills it up counts";
    EXPECT_TRUE(said(whole.find("livens_checksum") + 30, nullptr).starts_with("io-damaged"));
}

/// 70,000 numbers are more than a buffer holds.
TEST(ClassicNetcdf, LargeVariablesArriveInPieces)
{
    std::vector<double> values(70'000);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = 1 / (1.0 + static_cast<double>(i));
    std::string image;
    std::size_t largest = 0;
    ClassicWriter file;
    file.dimension("n", values.size());
    const int variable = file.variable({"v", {"n"}});
    file.begin([&, sink = into(image)](std::uint64_t offset, std::string_view bytes) {
        largest = std::max(largest, bytes.size());
        sink(offset, bytes);
    });
    file.append(variable, std::span<const double>(values).first(3));
    file.append(variable, std::span<const double>(values).subspan(3));
    file.finish();
    EXPECT_LE(largest, 128u << 10);
    const ClassicReader reader(source_of(image));
    std::vector<double> back(values.size());
    reader.read(*reader.variable("v"), back);
    EXPECT_EQ(back, values);
}

}   // namespace
}   // namespace livens::classic_netcdf_test
