// SPDX-License-Identifier: BSD-3-Clause
// Parameters of a file, and what is computed from them: "2*L", "L/2 + 30 mm".
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "livens/io/scenario/text/amount.h"
#include "livens/io/scenario/text/document.h"
#include "livens/io/scenario/text/findings.h"

namespace livens::inline io_internal {

class Parameters;

/// What a text comes to.
struct Computed {
    Amount amount;
    std::string code;    ///< of what is wrong; empty: nothing is
    std::string error;   ///< empty beside a code: a parameter that it needs is wrong itself, which was told
    std::string help;
};

/// An expression of numbers with or without units and of parameters. It depends on no time.
Computed compute(std::string_view text, const Parameters& parameters);
/// The same of a text that is to have the dimension of `si_unit` (empty: to be a plain number).
Computed compute(std::string_view text, std::string_view si_unit, const Parameters& parameters);
/// What formulas have beside symbols: parameters, and numbers with units, in SI. Parameters must outlive it.
ExpressionWords words_of_formulas(const Parameters& parameters);
/// Whether it is more than a number with a unit: a text that is not is refused as such.
bool is_computed(std::string_view text, const Parameters& parameters);

/// A value that a parameter has instead of the file's, because the program or another file says so.
struct Override {
    std::string name;
    std::string text = {};   ///< a number or an expression of this file's parameters; empty: `amount` counts
    Amount amount = {};
    SourceLocation place = {};   ///< where that is written
    std::string said_by = {};    ///< "--set L=0.4", for messages
};

/// The parameters of one file: names and numbers, each of which may be computed from others. Whoever reads a
/// file of another one (an include) makes those of that file by overrides, computed from its own.
class Parameters {
public:
    static constexpr std::size_t most = 10000;

    Parameters() = default;
    /// Of the table [parameters] (null: there is none). What is wrong goes to `findings`; a parameter that is
    /// wrong is known, so that it is told of once.
    Parameters(const Node* table, std::span<const Override> overrides, Findings& findings);

    struct One {
        enum class State : std::uint8_t { waits, is_known, is_wrong };

        std::string name;
        SourceLocation place = {};    ///< of its value
        std::string text = {};        ///< from which it is computed; empty: it is a number
        std::string file_text = {};   ///< likewise, by the file itself
        Amount amount = {};
        State state = State::waits;
        bool is_set = false;               ///< by an override
        bool is_in_unit_of_file = false;   ///< it was set to a plain number, which has the file's unit
        bool is_like_written = false;      ///< likewise, and near to the one in the file
        Override set_by = {};
        mutable bool is_used = false;
    };

    bool is_empty() const { return all_.empty(); }
    const std::vector<One>& all() const { return all_; }   ///< in the order of the file
    /// The parameter of that name, which counts as used; null: there is none.
    const One* find(std::string_view name) const;
    std::vector<std::string_view> names() const;
    /// Whether a unit has the name of a parameter, so that "3 N/m" might mean either.
    bool has_names_of_units() const { return has_names_of_units_; }
    /// Some are missing, since the table could not be read: an unknown name may be one of them.
    bool lacks_some() const { return lacks_some_; }

    /// Warns of those that nothing has asked for.
    void warn_of_unused(Findings& findings) const;

private:
    void add(const Entry& entry, Findings& findings);
    void set(const Override& one, Findings& findings);
    Computed settled(One& one) const;
    void compute_one(std::size_t first, Findings& findings);
    void tell_ring(const std::vector<std::size_t>& waiting, std::size_t wanted, Findings& findings);

    std::vector<One> all_;
    std::map<std::string, std::size_t, std::less<>> places_;
    bool has_names_of_units_ = false;
    bool lacks_some_ = false;
};

/// The text of a file, with the values of overrides that are texts instead of its own.
std::string with_set_values(std::string text, const Parameters& parameters);

/// The same with what is to stand where values begin, which must be in the order of the text.
std::string with_values_at(std::string text, std::span<const std::pair<SourceLocation, std::string>> values);

/// Of a file without any.
inline const Parameters& no_parameters()
{
    static const Parameters none;
    return none;
}

/// Thrown by compute() where a parameter is needed that has not been computed: seen by Parameters alone.
struct Waiting {
    const Parameters::One* needed;
};

/// A text of numbers and names in which each parameter is replaced by its number, in parentheses where it is
/// negative: for formulas that are kept as texts.
std::string with_numbers(std::string_view text, const Parameters& parameters);

}   // namespace livens::inline io_internal
