// SPDX-License-Identifier: BSD-3-Clause
// The tables of everything that a scenario may say: the reader walks them, schema_json() and
// schema_markdown() print them, a test mutates every entry. Those of kinds stand beside their makers.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace livens::inline io_internal {

/// One form of a value in the file.
enum class Form : std::uint8_t {
    none,
    flag,    ///< true
    truth,   ///< true or false
    integer,
    number,   ///< or a text with a unit, where the key has one
    text,
    choice,        ///< one of the key's words
    names,         ///< `count` texts
    named_texts,   ///< a table of texts under names of the user's choice
    row,           ///< `count` numbers
    rows,          ///< `count` rows of 3 numbers
    table,
    tables,          ///< array of tables
    templates,       ///< array of tables of the root's key of that name, with braces: see without_repeats()
    named_numbers,   ///< a table of numbers and expressions under names of the user's choice: see Parameters
    model,           ///< a table that holds what a file would, read by itself
    factors,         ///< a table of numbers of any unit under names of the user's choice
    condition,       ///< a text with < or >, see read_events()
    quantities       ///< the same, of which each may be three numbers
};

struct KeyType {
    std::string_view words;   ///< "three numbers", for messages and pages
    Form form = Form::none;
    int count = 0;             ///< 0: any number of them, at least one
    Form other = Form::none;   ///< what may stand there instead, with as many

    friend constexpr bool operator==(const KeyType&, const KeyType&) = default;
};

namespace types {
inline constexpr KeyType flag{"true", Form::flag};
inline constexpr KeyType truth{"true or false", Form::truth};
inline constexpr KeyType truth_or_table{"true or false or a table", Form::truth, 0, Form::table};
inline constexpr KeyType integer{"a whole number", Form::integer};
inline constexpr KeyType integer_or_choice{"a whole number", Form::integer, 0, Form::choice};
inline constexpr KeyType number{"a number", Form::number};
inline constexpr KeyType number_or_condition{"a number or a condition", Form::number, 0, Form::condition};
inline constexpr KeyType condition{"a condition", Form::condition};
inline constexpr KeyType text{"a string", Form::text};
inline constexpr KeyType choice{"", Form::choice};
inline constexpr KeyType interval{"two numbers", Form::row, 2};
inline constexpr KeyType vector3{"three numbers", Form::row, 3};
inline constexpr KeyType vector4{"four numbers", Form::row, 4};
inline constexpr KeyType principal_or_full{"three numbers or three rows of three numbers", Form::row, 3,
                                           Form::rows};
inline constexpr KeyType triple{"three rows of three numbers", Form::rows, 3};
inline constexpr KeyType pair{"two rows of three numbers", Form::rows, 2};
inline constexpr KeyType point{"the name of a point or three numbers", Form::row, 3, Form::text};
inline constexpr KeyType two_points{"two names of points or two rows of three numbers", Form::rows, 2,
                                    Form::names};
inline constexpr KeyType names{"two strings", Form::names, 2};
inline constexpr KeyType text_or_list{"a string or a list of strings", Form::text, 0, Form::names};
inline constexpr KeyType named_texts{"a table of strings", Form::named_texts};
inline constexpr KeyType named_numbers{"a table of numbers and strings", Form::named_numbers};
inline constexpr KeyType factors{"a table of numbers", Form::factors};
inline constexpr KeyType quantities{"a table of numbers", Form::quantities};
inline constexpr KeyType list{"a list of numbers", Form::row};
inline constexpr KeyType rows{"rows of three numbers", Form::rows};
inline constexpr KeyType number_or_list{"a number or a list of numbers", Form::number, 0, Form::row};
inline constexpr KeyType number_or_table{"a number or a table", Form::number, 0, Form::table};
inline constexpr KeyType table{"a table", Form::table};
inline constexpr KeyType model{"a table", Form::model};
inline constexpr KeyType tables{"tables", Form::tables};
inline constexpr KeyType templates{"tables", Form::templates};
inline constexpr KeyType table_or_tables{"a table or a list of tables", Form::table, 0, Form::tables};
inline constexpr KeyType color{"a string or three numbers", Form::text, 3, Form::row};
inline constexpr KeyType later{"", Form::none};   ///< known, but not part of this version
}   // namespace types

/// low <= x <= high, or low < x with `above`.
struct Range {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool above = false;

    bool holds(double x) const { return (above ? x > low : x >= low) && x <= high; }
    bool is_limited() const { return *this != Range(); }
    std::string text() const;   ///< "> 0", "1 to 16", ">= 0"
    friend constexpr bool operator==(const Range&, const Range&) = default;
};
inline constexpr Range positive{.low = 0, .above = true};
inline constexpr Range not_negative{.low = 0};

using Words = std::vector<std::string_view>;
struct Table;

// What names of points need not repeat.
inline constexpr const char* two_bodies_or_points = "Names of two different bodies, first and second; one of "
                                                    "them may be `\"world\"`. Not needed with names of "
                                                    "points in `points`.";
inline constexpr const char* body_or_point =
    "Name of the body. Not needed with the name of a point in `point`.";

inline constexpr const char* body_or_world_or_point =
    "Name of the body, or `\"world\"`. Not needed with the name of a point in `point`.";

inline constexpr std::string_view formulas_for_value =
    "a formula is given as 'expression', instead of 'value'";

struct Key {
    std::string_view name;
    KeyType type;
    std::string doc;
    std::string_view unit = {};       ///< SI; empty: a pure number. Texts must have its dimension
    std::string_view fallback = {};   ///< as in TOML, a choice without quotes; empty: none
    bool required = false;
    Words choices = {};                 ///< where an enum says the same, in its order: see Section::pick()
    Range range = {};                   ///< for every number of the value
    std::string_view other_unit = {};   ///< SI; what texts may have instead, along angles
    std::shared_ptr<const Table> child = {};   ///< of a table, or tables
    std::string_view formulas = {};            ///< where formulas stand instead; empty: nowhere
    std::string_view told_by = {};   ///< keys of points or files that may say it as well, with blanks between
    bool may_be_infinite = false;    ///< inf and -inf are numbers of it
    /// SI, where the numbers of a list differ: of a matrix row by row, whose diagonal may stand alone.
    Words units = {};

    // One property each, so that an entry of a table reads as a sentence.
    Key needed() && { return required = true, std::move(*this); }
    Key each_in(Words u) && { return units = std::move(u), std::move(*this); }
    Key or_in(std::string_view u) && { return other_unit = u, std::move(*this); }
    Key or_formulas(std::string_view where) && { return formulas = where, std::move(*this); }
    Key or_infinite() && { return may_be_infinite = true, std::move(*this); }
    Key within(const Range& r) && { return range = r, std::move(*this); }
    Key needed_without(std::string_view other) &&
    {
        return required = true, told_by = other, std::move(*this);
    }
    Key holding(Table t) &&;

    bool takes_units() const { return !unit.empty() || !units.empty(); }
    /// Of number i of n; empty where there is none.
    std::string_view unit_of(std::size_t i, std::size_t n) const;
};

/// A kind of joint, load or method: the word for it and the keys that it has beyond those of all kinds.
struct Kind {
    std::string_view word, doc;
    std::vector<Key> keys;
};
inline constexpr int any_kind = -1;

struct Table {
    std::string heading;   ///< "[[body]]"
    std::string_view doc;
    std::vector<Key> keys;           ///< of all kinds
    std::string_view chooser = {};   ///< the key that says the kind, "type"; empty: there are no kinds
    std::vector<Kind> kinds = {};

    /// A table with kinds: words and meanings of the chooser are theirs.
    Table with_kinds(std::string_view choosing_key, std::vector<Kind> all) &&;
    /// The keys that belong to a kind (an index), or with any_kind all that belong to some.
    std::vector<const Key*> keys_of(int kind) const;
};

/// One of some words, by default the first.
Key choice(std::string_view name, Words words, const std::string& doc);

/// Of an enum with words beside it, see word_of(), for Section::pick().
template <class Enum>
Key choice(std::string_view name, const std::string& doc)
{
    constexpr auto words = words_of(Enum{});
    return choice(name, Words(words.begin(), words.end()), doc);
}

inline constexpr int max_elements = 10'000'000;
inline constexpr int max_bodies = 10000;
inline constexpr int max_includes = 1000, max_include_depth = 8;

// Made once, for root_table(), which holds all others.
Table body_table();
Table world_table();
Table joint_table();
Table drive_table();
Table stop_table();
Table load_table();
Table controller_table();
Table event_table();
Table sensor_table();
Table point_table();
Table include_table();
Table start_table();
Table end_table();
Table method_table();
Table repeat_table();
const Table& root_table();
/// The same of what is included, where nothing is needed.
const Table& part_table();
/// All, from the root on, each before those inside it.
std::vector<const Table*> schema_tables();

const Key* find_key(const std::vector<const Key*>& keys, std::string_view name);
/// "a", "b" or "c"
std::string quoted_alternatives(const Words& words);
/// Of `word`, or -1.
int index_of(const Words& words, std::string_view word);
/// "three numbers in m, each > 0": for messages and pages.
std::string describe_type(const Key& key);
/// The numbers of a fallback: "[0, 0, 0]" -> 0, 0, 0.
std::vector<double> fallback_numbers(const Key& key);

}   // namespace livens::inline io_internal
