// SPDX-License-Identifier: BSD-3-Clause
// Bytes as a program that edits a result file: first the file, then edits of four bytes each, what is done
// and to what. Checksums fit at the end, so that nothing keeps the reader from looking.
#pragma once

#include <filesystem>
#include <fstream>
#include <limits>

#include "fuzz/crafted.h"

namespace livens::test {

/// Those that are edited: each has its name before, sorted.
inline std::vector<std::string> result_files()
{
    std::vector<std::filesystem::path> paths;
    for (const auto& entry :
         std::filesystem::directory_iterator(LIVENS_SOURCE_DIR "/tests/fuzz/corpus_results"))
        paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    std::vector<std::string> all;
    for (const std::filesystem::path& path : paths) {
        std::ifstream in(path, std::ios::binary);
        all.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    }
    return all;
}

class Edits {
public:
    Edits(std::string_view program, const std::vector<std::string>& files)
        : rest_(program), file_(files[next() % files.size()])
    {}

    std::string bytes()
    {
        while (!rest_.empty()) {
            const unsigned what = next(), a = next(), b = next(), c = next();
            edit(what, a, b, c);
        }
        return file_.bytes();
    }

private:
    using Variable = Crafted::Variable;

    unsigned next()
    {
        if (rest_.empty()) return 0;
        const unsigned char byte = static_cast<unsigned char>(rest_.front());
        rest_.remove_prefix(1);
        return byte;
    }
    static std::uint64_t length(unsigned i)
    {
        constexpr std::uint64_t odd[] = {0, 1, 2, 3, 4, 9, 12, 0x10000, 0x7fffffff, 0xfffffffc, 0xffffffff};
        return i < std::size(odd) ? odd[i] : i;
    }
    static double number(unsigned i)
    {
        constexpr double odd[] = {0, -0.0, 1, -1, 33, 0.5, 1e308, -1e308, 5e-324, 2147483647, -2147483648.0};
        return i < std::size(odd) ? odd[i] : i == 255 ? std::numeric_limits<double>::quiet_NaN() : i;
    }
    static std::string name(const std::string& other, unsigned i)
    {
        return i == 0 ? std::string(300, 'n') : i == 1 ? std::string(400'000, 'n') : i == 2 ? "" : other;
    }
    template <class Entries>
    static auto& any(Entries& entries, unsigned i)
    {
        return entries[i % entries.size()];
    }

    /// A dimension of another length, and all that lies along it.
    void resize(std::uint32_t number, std::uint64_t length)
    {
        constexpr std::size_t most = std::size_t{1} << 22;
        const std::uint64_t old = file_.dimensions[number].length;
        file_.dimensions[number].length = length;
        for (Variable& v : file_.variables)
            for (const std::uint32_t id : v.dimensions)
                if (id == number && old > 0)
                    v.data.resize(std::min(most, padded(v.data.size() / old * length)), '\1');
    }
    void put(std::string& data, unsigned place, unsigned i)
    {
        if (data.size() < 8) return;
        const auto word = big_endian(std::bit_cast<std::uint64_t>(number(i)));
        std::memcpy(data.data() + data.size() / 8 * place / 256 * 8, &word, sizeof word);
    }
    AttributeValue value(unsigned i) const
    {
        if (i % 3 == 0) return static_cast<int>(length(i / 3));
        return i % 3 == 1 ? AttributeValue(number(i / 3)) : AttributeValue(name("text", i / 3));
    }

    void edit(unsigned what, unsigned a, unsigned b, unsigned c)
    {
        if (file_.variables.empty() || file_.dimensions.empty()) return;
        Variable& v = any(file_.variables, a);
        ClassicDimension& d = any(file_.dimensions, a);
        const auto n_dimensions = static_cast<std::uint32_t>(file_.dimensions.size());
        switch (what % 16) {
        case 0:
            file_.add({d.name, length(b)}, c % 2 == 0);
            break;
        case 1:
            d.length = length(b);
            break;
        case 2:
            resize(a % n_dimensions, b < 64 ? b : length(b - 64) % 4096);
            break;
        case 3:
            d.name = name(any(file_.dimensions, b).name, c);
            break;
        case 4:
            v.dimensions.assign(c == 1 ? 100'000 : b % 16, c % n_dimensions);
            break;
        case 5:
            if (!v.dimensions.empty()) any(v.dimensions, b) = c % n_dimensions;
            break;
        case 6:
            v.name = name(any(file_.variables, b).name, c);
            break;
        case 7:
            file_.variables.push_back(Variable(any(file_.variables, b)));
            break;
        case 8:
            file_.variables.erase(file_.variables.begin() + a % file_.variables.size());
            break;
        case 9:
            v.type = b;
            break;
        case 10:
            v.begin = 8 * (b + 256ull * c);
            break;
        case 11:
            v.data.resize(4 * (b + 256 * (c % 16)));
            break;
        case 12:
            put(v.data, b, c);
            break;
        case 13:
            any(file_.attributes, a).value = value(b);
            break;
        case 14:
            any(v.attributes, b).value = value(c);
            break;
        default:
            (b % 2 == 0 ? file_.attributes : v.attributes).push_back(any(v.attributes, c));
            break;
        }
    }

    std::string_view rest_;
    Crafted file_;
};

}   // namespace livens::test
