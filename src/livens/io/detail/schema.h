// The one table of everything that a scenario may say: the reader walks it, schema_json() and
// schema_markdown() print it, a test mutates every entry.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace livens {

/// The tables of a scenario; the tables of forces and torques differ in the unit of their values only.
enum class TableId : std::uint8_t {
    root,
    body,
    shape,
    sphere,
    cylinder,
    capsule,
    cone,
    joint,
    load,
    force_table,
    torque_table,
    time,
    method,
    start,
    end,
    body_end
};

enum class KeyType : std::uint8_t {
    flag,    ///< true
    truth,   ///< true or false
    integer,
    integer_or_choice,   ///< a whole number or one of `choices`
    number,
    text,
    choice,   ///< one of `choices`
    vector3,
    vector4,
    principal_or_full,   ///< 3 numbers or 3 x 3
    triple,              ///< 3 x 3 numbers
    pair,                ///< 2 x 3 numbers
    names,               ///< 2 texts
    list,                ///< numbers
    rows,                ///< any number of rows of 3 numbers
    number_or_list,
    number_or_table,   ///< one number or the table `child`
    table,
    tables,   ///< array of tables
    later     ///< known, but not part of this version
};

/// low <= x <= high, or low < x with `above`.
struct Range {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool above = false;

    bool holds(double x) const { return (above ? x > low : x >= low) && x <= high; }
    bool is_limited() const
    {
        return low > -std::numeric_limits<double>::infinity() ||
               high < std::numeric_limits<double>::infinity();
    }
    std::string text() const;   ///< "> 0", "1 to 16", ">= 0"
};

struct Key {
    TableId table;
    std::string_view name;
    KeyType type;
    std::string_view doc;
    std::string_view unit = "";       ///< SI; empty: a pure number. Strings must have its dimension
    std::string_view fallback = "";   ///< as in TOML, a choice without quotes; empty: none
    bool required = false;            ///< if the key belongs to the type in hand
    std::string_view only = "";   ///< types (of the discriminator) it belongs to, "force|torque"; empty: all
    std::string_view choices = "";   ///< "linear|spline"
    std::string_view later = "";     ///< further choices of later versions
    Range range = {};                ///< for every number of the value
    TableId child = TableId::root;   ///< of table, tables, number_or_table

private:
    template <class Member>
    constexpr Key with(Member Key::*member, const Member& value) const
    {
        Key key = *this;
        key.*member = value;
        return key;
    }

public:
    // One property each, so that an entry of the table reads as a sentence.
    constexpr Key in(std::string_view u) const { return with(&Key::unit, u); }
    constexpr Key otherwise(std::string_view f) const { return with(&Key::fallback, f); }
    constexpr Key needed() const { return with(&Key::required, true); }
    constexpr Key only_for(std::string_view types) const { return with(&Key::only, types); }
    constexpr Key one_of(std::string_view c, std::string_view l = "") const
    {
        return with(&Key::choices, c).with(&Key::later, l);
    }
    constexpr Key within(const Range& r) const { return with(&Key::range, r); }
    constexpr Key holding(TableId t) const { return with(&Key::child, t); }
};

struct Table {
    TableId id;
    std::string_view heading;         ///< "[[body]]"
    std::string_view discriminator;   ///< the key that decides which others belong: "type"; empty: none
    std::string_view doc;
};

inline constexpr int max_elements = 10'000'000;
inline constexpr int max_bodies = 1000;

std::span<const Key> schema_keys();
const Table& schema_table(TableId id);
std::span<const Table> schema_tables();

/// Is `word` one of the alternatives of "a|b|c"?
bool is_listed(std::string_view alternatives, std::string_view word);
std::vector<std::string_view> split_alternatives(std::string_view alternatives);
/// "a", "b" or "c"
std::string quoted_alternatives(std::string_view alternatives);

/// "three numbers in m, each > 0": for messages and pages.
std::string describe_type(const Key& key);

/// The numbers of a fallback: "[0, 0, 0]" -> 0, 0, 0.
std::vector<double> fallback_numbers(const Key& key);

}   // namespace livens
