// SPDX-License-Identifier: BSD-3-Clause
// Result files taken apart and put together again, with whatever header and with checksums that fit: what
// somebody who means harm can do with little work.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "livens/io/results/classic_netcdf_bytes.h"

namespace livens::test {

inline ByteSource source_in(const std::string& bytes)
{
    return {bytes.size(), [&bytes](std::uint64_t offset, std::span<char> out) {
                if (offset > bytes.size() || out.size() > bytes.size() - offset) std::abort();
                bytes.copy(out.data(), out.size(), offset);
            }};
}

class Crafted {
public:
    struct Variable {
        std::string name;
        std::vector<std::uint32_t> dimensions{};   ///< by number
        std::vector<Attribute> attributes{};
        std::uint32_t type = 6;
        std::string data{};
        std::optional<std::uint64_t> begin{};   ///< where it says that it begins; none: where it does
    };

    std::vector<ClassicDimension> dimensions;
    std::vector<Attribute> attributes;
    std::vector<Variable> variables;

    /// Of a file that livens wrote.
    explicit Crafted(const std::string& file)
    {
        const ClassicReader reader(source_in(file));
        attributes = without(reader.attributes(), checksum_name);
        for (const ClassicVariable& v : reader.variables()) {
            Variable& own = variables.emplace_back();
            own.name = v.name;
            own.type = static_cast<std::uint32_t>(v.type);
            own.attributes = without(v.attributes, "checksum");
            own.data = file.substr(v.begin, v.n_bytes);
            for (const std::string& name : v.dimensions) {
                if (named(dimensions, name) == nullptr) dimensions.push_back({name, reader.dimension(name)});
                own.dimensions.push_back(number_of(name));
            }
        }
    }

    std::uint32_t number_of(const std::string& dimension) const
    {
        return static_cast<std::uint32_t>(named(dimensions, dimension) - dimensions.data());
    }
    Variable* find(const std::string& variable)
    {
        const auto found = std::ranges::find(variables, variable, &Variable::name);
        return found == variables.end() ? nullptr : &*found;
    }
    /// A dimension before or behind all others.
    void add(const ClassicDimension& dimension, bool is_first)
    {
        dimensions.insert(is_first ? dimensions.begin() : dimensions.end(), dimension);
        for (Variable& v : variables)
            for (std::uint32_t& number : v.dimensions) number += is_first ? 1 : 0;
    }

    std::string bytes() const
    {
        std::string header;
        std::uint64_t begin = 0;
        for (int round = 0; round < 2; ++round) {   // places follow from the size of the header
            begin = header.size();
            header = header_at(begin);
        }
        Checksum checksum;
        checksum.add(header);
        const std::size_t place = header.find(no_checksum, header.find(checksum_name));
        header.replace(place, no_checksum.size(), checksum.text());
        for (const Variable& v : variables) header += v.data;
        return header;
    }

private:
    static std::vector<Attribute> without(std::vector<Attribute> all, std::string_view name)
    {
        std::erase_if(all, [&](const Attribute& a) { return a.name == name; });
        return all;
    }
    static void put(std::string& out, std::uint32_t word)
    {
        word = big_endian(word);
        out.append(reinterpret_cast<const char*>(&word), sizeof word);
    }
    static void put(std::string& out, const std::string& text)
    {
        put(out, static_cast<std::uint32_t>(text.size()));
        out += text;
        out.resize(padded(out.size()));
    }
    static void put(std::string& out, const Attribute& attribute)
    {
        put(out, attribute.name);
        if (const int* integer = std::get_if<int>(&attribute.value)) {
            for (const std::uint32_t word : {4u, 1u, static_cast<std::uint32_t>(*integer)}) put(out, word);
        } else if (const double* real = std::get_if<double>(&attribute.value)) {
            const auto bits = std::bit_cast<std::uint64_t>(*real);
            for (const std::uint64_t word : {std::uint64_t{6}, std::uint64_t{1}, bits >> 32, bits})
                put(out, static_cast<std::uint32_t>(word));
        } else {
            put(out, 2u);
            const auto* text = std::get_if<std::string>(&attribute.value);
            put(out, text == nullptr ? std::string() : *text);
        }
    }
    static void put(std::string& out, std::vector<Attribute> all, std::string_view name, std::string_view sum)
    {
        put(out, attribute_tag);
        put(out, static_cast<std::uint32_t>(all.size() + 1));
        for (const Attribute& attribute : all) put(out, attribute);
        put(out, Attribute{std::string(name), std::string(sum)});
    }

    std::string header_at(std::uint64_t begin) const
    {
        std::string out = "CDF\2";
        put(out, 0u);
        put(out, dimensions.empty() ? 0u : dimension_tag);
        put(out, static_cast<std::uint32_t>(dimensions.size()));
        for (const ClassicDimension& dimension : dimensions) {
            put(out, dimension.name);
            put(out, static_cast<std::uint32_t>(dimension.length));
        }
        put(out, attributes, checksum_name, no_checksum);
        put(out, variables.empty() ? 0u : variable_tag);
        put(out, static_cast<std::uint32_t>(variables.size()));
        for (const Variable& v : variables) {
            put(out, v.name);
            put(out, static_cast<std::uint32_t>(v.dimensions.size()));
            for (const std::uint32_t number : v.dimensions) put(out, number);
            Checksum checksum;
            checksum.add(v.data);
            put(out, v.attributes, "checksum", checksum.text());
            put(out, v.type);
            put(out, static_cast<std::uint32_t>(v.data.size()));
            const std::uint64_t place = v.begin.value_or(begin);
            put(out, static_cast<std::uint32_t>(place >> 32));
            put(out, static_cast<std::uint32_t>(place));
            begin += v.data.size();
        }
        return out;
    }
};

}   // namespace livens::test
