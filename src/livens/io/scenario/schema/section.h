// SPDX-License-Identifier: BSD-3-Clause
// A table of the scenario after the schema has been applied: known keys with values in SI units.
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "livens/base/linear.h"
#include "livens/io/scenario/schema/schema.h"
#include "livens/io/scenario/text/document.h"
#include "livens/io/scenario/text/findings.h"
#include "livens/io/scenario/text/parameters.h"

namespace livens::inline io_internal {

class Section;

/// What one key was given; which member counts follows from the key's type.
struct Value {
    const Key* key = nullptr;
    const Node* node = nullptr;
    bool is_valid = false;
    std::vector<double> numbers;      ///< SI; rows one after the other; truth: 0 or 1
    int n_rows = 0;                   ///< 0: a plain number
    bool has_unit = false;            ///< it was a text with the key's unit
    bool has_other_unit = false;      ///< it was one with the key's other unit
    std::string text;                 ///< text, choice
    std::vector<std::string> texts;   ///< names
    std::vector<Section> sections;    ///< table, tables, number_or_table
};

class Section {
public:
    /// Applies the schema: unknown, misplaced, mistyped, missing keys and values out of range go to
    /// `findings`. `label` names the table in messages: "body 'upper'". Its numbers may be computed from
    /// `parameters`, which outlive it.
    Section(const Node& node, const Table& table, std::string label, Findings& findings,
            const Parameters& parameters = no_parameters());

    const std::string& label() const { return label_; }
    SourceLocation place() const { return node_->place; }
    /// Nothing was wrong with this table and those inside it.
    bool is_valid() const { return is_valid_; }
    /// Of the file that it stands in.
    const Parameters& parameters() const { return *parameters_; }
    /// Index of its kind in the schema's table, or of the kind that a word of another program means; any_kind
    /// if there is none.
    int kind() const { return kind_; }
    /// Whether its kind has the key, given or not.
    bool takes(std::string_view key) const { return key_of(key) != nullptr; }
    /// The schema's entry for a key of its kind; null: it has none.
    const Key* key_of(std::string_view key) const { return find_key(table_->keys_of(kind_), key); }

    /// The key stands in the file, in order or not, or another word that means it.
    bool has(std::string_view key) const { return value(key) != nullptr || is_meant(key); }
    /// The key's value; null if it is missing or not valid.
    const Value* find(std::string_view key) const;
    /// Of the value; of the table if the key is missing.
    SourceLocation place(std::string_view key) const;

    // Values, or the schema's fallback (zero without one) where the key is missing or not valid.
    double number(std::string_view key) const;
    int integer(std::string_view key) const { return static_cast<int>(number(key)); }
    bool truth(std::string_view key) const { return number(key) != 0; }
    std::string text(std::string_view key) const;
    Vector3 vector(std::string_view key) const { return row(key, 0); }
    Vector3 row(std::string_view key, int i) const;
    /// Rows of the value as the columns of a matrix: [d1, d2, d3].
    Matrix3 columns(std::string_view key) const;
    /// The enumerator that stands where the word does among the key's choices.
    template <class Enum>
    Enum pick(std::string_view key) const
    {
        return static_cast<Enum>(index_of(key_of(key)->choices, text(key)));
    }
    std::span<const Section> sections(std::string_view key) const;

    std::span<Section> sections(std::string_view key);
    // What the names of points stand for, once bodies are known.
    /// Numbers take the place of names.
    void tell(std::string_view key, const std::vector<double>& numbers);
    /// Texts of a key that is not there, whose places are those of another value.
    void imply(std::string_view key, const std::vector<std::string>& texts, const Value& told_by);
    /// Of a key that imply() has put there.
    bool is_implied(std::string_view key) const;
    void spoil() { is_valid_ = false; }

    /// All keys with values, for the table of places.
    const std::vector<Value>& values() const { return values_; }

    // What else may be wrong. All return false after an error.
    /// An error at the value of a key, or at the table without one.
    bool error(std::string_view key, std::string_view code, std::string message, Advice advice = {}) const;
    /// Reports the second of those keys that stands here.
    bool at_most_one(std::initializer_list<std::string_view> keys, std::string_view code) const;
    /// Reports all of those keys that stand here, with the reason.
    bool refuse(std::initializer_list<std::string_view> keys, std::string_view code,
                const std::string& reason) const;

private:
    const Value* value(std::string_view key) const;
    std::vector<double> numbers(std::string_view key) const;
    void read(const Entry& entry, const std::vector<const Key*>& keys);
    void report_unknown(const Entry& entry, const std::vector<const Key*>& keys);
    bool is_meant(std::string_view key) const;

    const Table* table_;
    const Node* node_;
    std::string label_;
    Findings* findings_;
    const Parameters* parameters_;
    int kind_;
    std::vector<Value> values_;
    Words meant_;   ///< keys that unknown ones stand for: what lacks them has been told of
    bool is_valid_ = true;
};

/// Whether names of points stand where they say a body, or two; or files that may have what is needed.
bool is_told_otherwise(const Key& key, const Node& node);

/// What a key states as a condition; empty: it does not.
inline std::string condition_of(const Section& section, std::string_view key)
{
    const Value* value = section.takes(key) ? section.find(key) : nullptr;
    return value != nullptr && value->numbers.empty() ? value->text : std::string();
}
/// It states a number.
inline bool has_number(const Section& section, std::string_view key)
{
    return section.has(key) && condition_of(section, key).empty();
}

/// The table `key` of a section; null if it is not there.
inline const Section* only_section(const Section& section, std::string_view key)
{
    const std::span<const Section> sections = section.sections(key);
    return sections.empty() ? nullptr : &sections.front();
}

}   // namespace livens::inline io_internal
