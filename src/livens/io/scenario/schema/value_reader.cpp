// SPDX-License-Identifier: BSD-3-Clause
// Values by the types of their keys. A text where a number is wanted is a quantity, "5 mm", or computed,
// "2*L".
#include "livens/io/scenario/schema/value_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "livens/base/text.h"
#include "livens/io/scenario/schema/other_words.h"
#include "livens/io/scenario/schema/value_help.h"
#include "livens/io/scenario/text/units.h"

namespace livens::inline io_internal {

namespace {

using NodeKind = Node::Kind;

/// Reads the value of one key, and reports it once if it does not fit.
class ValueReader {
public:
    ValueReader(Value& value, const std::string& label, Findings& findings, const Parameters& parameters)
        : value_(value), key_(*value.key), label_(label), findings_(findings), parameters_(parameters)
    {}

    bool read()
    {
        const Node& node = *value_.node;
        return read(is_of_other_form(node) ? key_.type.other : key_.type.form, node);
    }

private:
    bool is_of_other_form(const Node& node) const
    {
        if (node.is_unknown) return false;
        switch (key_.type.other) {
        case Form::choice:
            return node.kind == NodeKind::text && index_of(key_.choices, node.text()) >= 0;
        case Form::text:
            return node.kind == NodeKind::text;
        case Form::condition:
            return node.kind == NodeKind::text && node.text().find_first_of("<>") != std::string::npos;
        case Form::names:
            return node.kind == NodeKind::array &&
                   (key_.type.form != Form::rows ||
                    (!node.items().empty() && node.items().front().kind == NodeKind::text));
        case Form::row:
        case Form::tables:
            return node.kind == NodeKind::array;
        case Form::rows:
            return node.kind == NodeKind::array && !node.items().empty() &&
                   node.items().front().kind == NodeKind::array;
        case Form::table:
            return node.kind == NodeKind::table;
        default:
            return false;
        }
    }

    bool read(Form form, const Node& node)
    {
        if (node.is_unknown && form != Form::number) return takes_no_unknown(node);
        switch (form) {
        case Form::flag:
            return read_flag(node);
        case Form::truth:
            return node.kind == NodeKind::truth ? keep(node.number) : wrong_type(node);
        case Form::integer:
            return read_integer(node);
        case Form::number:
            return read_number(node);
        case Form::condition:
            if (node.kind == NodeKind::text && node.text().find_first_not_of(" \t") == std::string::npos)
                return wrong_type(node);
            [[fallthrough]];
        case Form::text:
            return read_text(node, value_.text);
        case Form::choice:
            return read_choice(node);
        case Form::names:
            return read_each(node, key_.type.count,
                             [&](const Node& item) { return read_text(item, value_.texts.emplace_back()); });
        case Form::named_texts:
            return read_named_texts(node);
        case Form::factors:
        case Form::quantities:
            return read_factors(node);
        case Form::row:
            return read_row(node, key_.type.count);
        case Form::rows:
            return read_each(node, key_.type.count, [&](const Node& item) { return read_row(item, 3); });
        case Form::model:
        case Form::named_numbers:
            return node.kind == NodeKind::table || wrong_type(node);   // what is in it was read before
        case Form::templates:
            return node.kind == NodeKind::array ||
                   wrong_type(node, "as in [[repeat." + std::string(key_.name) + "]]");
        case Form::table:
            return read_table(node);
        case Form::tables:
            return read_tables(node);
        case Form::none:
            break;
        }
        return false;
    }

    std::string subject() const { return "'" + std::string(key_.name) + "' of " + label_; }
    std::string demand() const { return subject() + " must be " + describe_type(key_); }

    bool wrong_type(const Node& node, std::string help = {})
    {
        if (help.empty()) help = help_with_form(key_, node);
        return findings_.error(
            node.place, "wrong-type", demand() + ", not " + std::string(describe(node.kind)),
            {node.kind == NodeKind::text ? std::string(key_.formulas) : "", std::move(help)});
    }

    bool keep(double x)
    {
        value_.numbers.push_back(x);
        return true;
    }

    bool read_flag(const Node& node)
    {
        if (node.kind != NodeKind::truth) return wrong_type(node);
        return node.number == 1 ||
               findings_.error(node.place, "out-of-range", subject() + " can only be true",
                               {"", "leave the key out"});
    }

    bool read_number(const Node& node)
    {
        if (node.kind == NodeKind::integer || node.kind == NodeKind::number) {
            if (std::isfinite(node.number) || (key_.may_be_infinite && !std::isnan(node.number)))
                return accept(node, node.number);
            return findings_.error(node.place, "not-finite",
                                   subject() + " must be finite, not " + to_text(node.number));
        }
        if (node.kind != NodeKind::text) return wrong_type(node);
        double x = 0;
        if (key_.may_be_infinite && is_infinite(node.text(), x)) return accept(node, x);
        const bool is_read =
            is_computed(node.text(), parameters_) ? read_expression(node, x) : read_quantity(node, x);
        return is_read && accept(node, x);
    }

    /// In quotes, as people write it beside numbers with units.
    static bool is_infinite(std::string_view text, double& x)
    {
        x = text.starts_with('-') ? -std::numeric_limits<double>::infinity()
                                  : std::numeric_limits<double>::infinity();
        if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
        return text == "inf";
    }

    bool read_integer(const Node& node)
    {
        if (node.kind == NodeKind::integer) return accept(node, node.number);
        if (node.kind != NodeKind::text || !is_computed(node.text(), parameters_)) return wrong_type(node);
        double x = 0;
        if (!read_expression(node, x)) return false;
        // What is computed may miss a whole number by its rounding: 0.3/0.1 is 3 to 16 digits.
        const double whole = std::round(x);
        if (std::abs(x - whole) <= 1e-12 * std::abs(whole) && std::abs(whole) < 1e15)
            return accept(node, whole);
        return findings_.error(node.place, "wrong-type",
                               demand() + ", not " + quoted(node) + " = " + to_text(x));
    }

    static std::string quoted(const Node& node) { return '"' + node.text() + '"'; }

    /// A number with a unit.
    bool read_quantity(const Node& node, double& x)
    {
        if (unit_.empty()) return wrong_type(node);
        const Quantity other = parse_quantity(node.text(), key_.other_unit);
        Quantity quantity = parse_quantity(node.text(), unit_);
        const bool is_other = !key_.other_unit.empty() && other.error.empty();
        if (is_other || quantity.error.empty()) {
            (is_other ? value_.has_other_unit : value_.has_unit) = true;
            x = is_other ? other.value : quantity.value;
            // In "3 N/m" the m may be a parameter.
            const Computed doubt =
                parameters_.has_names_of_units() ? compute(node.text(), parameters_) : Computed();
            return doubt.code.empty() || refuse_expression(node, doubt);
        }
        if (!key_.other_unit.empty() && quantity.help.starts_with("it is measured in"))
            quantity.help += " or " + std::string(key_.other_unit);
        return findings_.error(node.place, "unit",
                               subject() + " cannot be " + quoted(node) + ": " + quantity.error,
                               {std::string(key_.formulas), quantity.help});
    }

    bool read_expression(const Node& node, double& x)
    {
        Computed found = compute(node.text(), parameters_);
        if (!found.code.empty()) return refuse_expression(node, found);
        x = found.amount.value;
        const bool is_plain = !found.amount.has_unit;
        const std::string fault = misfit(found.amount, unit_);
        if (!is_plain && !key_.other_unit.empty() && misfit(found.amount, key_.other_unit).empty())
            return value_.has_other_unit = true;
        value_.has_unit = value_.has_unit || (fault.empty() && !is_plain);
        if (fault.empty()) return true;
        found.code = "unit";
        found.error = fault;
        if (!key_.other_unit.empty())
            found.help = "it is measured in " + std::string(unit_) + " or " + std::string(key_.other_unit);
        return refuse_expression(node, found);
    }

    bool refuse_expression(const Node& node, const Computed& found)
    {
        if (found.error.empty()) return false;   // a parameter that was told of
        // A word where a number is wanted, in a file without parameters, is no attempt to compute one.
        const bool is_word = found.code == "expression-name" || found.code == "expression-syntax";
        if (is_word && parameters_.is_empty() && (unit_.empty() || key_.type.other == Form::choice))
            return wrong_type(node);
        return findings_.error(node.place, found.code,
                               subject() + " cannot be " + quoted(node) + ": " + found.error,
                               {std::string(key_.formulas), found.help});
    }

    bool accept(const Node& node, double x)
    {
        keep(x);
        if (key_.range.holds(x)) return true;
        const bool is_version = key_.name == "format";
        const std::string unit = key_.unit.empty() ? "" : " " + std::string(key_.unit);
        return findings_.error(node.place, is_version ? "format-version" : "out-of-range",
                               subject() + " must be " + key_.range.text() + unit + ", not " + to_text(x),
                               {"", is_version ? "this version of livens reads format = 1" : ""});
    }

    bool takes_no_unknown(const Node& node)
    {
        return findings_.error(node.place, "unknown-place",
                               subject() + " takes no number that could be unknown",
                               {"it must be " + describe_type(key_), "give the value itself"});
    }

    bool read_text(const Node& node, std::string& text)
    {
        if (node.is_unknown) return takes_no_unknown(node);
        if (node.kind != NodeKind::text) return wrong_type(node, "strings are written in quotes");
        text = node.text();
        return true;
    }

    bool read_choice(const Node& node)
    {
        if (!read_text(node, value_.text)) return false;
        if (index_of(key_.choices, value_.text) >= 0) return true;
        const std::string other = in_other_words(value_.text, key_.choices);
        return findings_.error(node.place, "unknown-choice", demand() + ", not \"" + value_.text + "\"",
                               {"", other.empty() ? suggest(value_.text, key_.choices) : other});
    }

    /// A list of so many (0: of any number but none).
    template <class ReadItem>
    bool read_each(const Node& node, int count, ReadItem read_item)
    {
        if (node.kind != NodeKind::array) return wrong_type(node);
        const std::vector<Node>& items = node.items();
        if (count == 0 ? items.empty() : items.size() != static_cast<std::size_t>(count))
            return findings_.error(node.place, "wrong-type",
                                   demand() + ", not " + std::to_string(items.size()),
                                   {"", help_with_form(key_, node)});
        return std::all_of(items.begin(), items.end(), read_item);
    }

    bool read_named_texts(const Node& node)
    {
        if (node.kind != NodeKind::table) return wrong_type(node);
        return std::ranges::all_of(node.entries(), [&](const Entry& entry) {
            if (entry.value.kind == NodeKind::text)
                return read_text(entry.value, value_.texts.emplace_back());
            return findings_.error(entry.value.place, "wrong-type",
                                   "'" + entry.key + "' in " + subject() + " must be a string, not " +
                                       std::string(describe(entry.value.kind)),
                                   {"", "strings are written in quotes"});
        });
    }

    /// Numbers, also computed and with units, of which whoever asks for them knows.
    bool read_factors(const Node& node)
    {
        if (node.kind != NodeKind::table) return wrong_type(node);
        return std::ranges::all_of(node.entries(), [&](const Entry& entry) {
            const bool is_list = key_.type.form == Form::quantities && entry.value.kind == NodeKind::array;
            if (!is_list) return read_factor(entry, entry.value);
            return read_each(entry.value, 3, [&](const Node& item) { return read_factor(entry, item); });
        });
    }

    bool read_factor(const Entry& entry, const Node& given)
    {
        const std::string of = "'" + entry.key + "' in " + subject();
        if (given.kind == NodeKind::text) {
            const Computed found = compute(given.text(), parameters_);
            keep(found.amount.value);
            return found.code.empty() ||
                   (!found.error.empty() &&
                    findings_.error(given.place, found.code,
                                    of + " cannot be " + quoted(given) + ": " + found.error,
                                    {"", found.help}));
        }
        if (given.kind != NodeKind::integer && given.kind != NodeKind::number)
            return findings_.error(given.place, "wrong-type",
                                   of + " must be a number, not " + std::string(describe(given.kind)),
                                   {"", given.kind == NodeKind::table && !given.entries().empty()
                                            ? "names with a point are written in quotes: \"" + entry.key +
                                                  "." + given.entries()[0].key + "\" = ..."
                                            : ""});
        return std::isfinite(given.number)
                   ? keep(given.number)
                   : findings_.error(given.place, "not-finite",
                                     of + " must be finite, not " + to_text(given.number));
    }

    bool read_row(const Node& node, int count)
    {
        ++value_.n_rows;
        std::size_t i = 0;
        return read_each(node, count, [&](const Node& item) {
            unit_ = key_.unit_of(i++, node.items().size());
            return read_number(item);
        });
    }

    bool read_table(const Node& node)
    {
        const std::string name(key_.name);
        if (node.kind != NodeKind::table) return wrong_type(node);
        const bool is_top = find_key(root_table().keys_of(any_kind), name) == &key_;
        value_.sections.emplace_back(node, *key_.child, is_top ? "[" + name + "]" : name + " of " + label_,
                                     findings_, parameters_);
        return value_.sections.back().is_valid();
    }

    bool read_tables(const Node& node)
    {
        const std::string name(key_.name);
        const bool is_inside = key_.type.form == Form::table;   // one table may stand instead
        const std::string help = is_inside ? "write " + name + " = [{ " +
                                                 std::string(key_.child->keys.front().name) + " = ... }, ...]"
                                           : "each " + name + " begins with a line [[" + name + "]]";
        if (node.kind != NodeKind::array) return wrong_type(node, help);
        value_.sections.reserve(node.items().size());
        bool is_valid = true;
        for (const Node& item : node.items()) {
            if (item.kind != NodeKind::table) return wrong_type(item, help);
            const Node* title = item.find("name");
            const bool is_named = title != nullptr && title->kind == NodeKind::text && !title->text().empty();
            const std::string label =
                is_named ? "'" + title->text() + "'" : std::to_string(value_.sections.size() + 1);
            value_.sections.emplace_back(item, *key_.child,
                                         name + " " + label + (is_inside ? " of " + label_ : ""), findings_,
                                         parameters_);
            is_valid = value_.sections.back().is_valid() && is_valid;
        }
        return is_valid;
    }

    Value& value_;
    const Key& key_;
    const std::string& label_;
    Findings& findings_;
    const Parameters& parameters_;
    std::string_view unit_ = key_.unit;   ///< of the number that is read
};

}   // namespace

bool read_value(Value& value, const std::string& label, Findings& findings, const Parameters& parameters)
{
    return ValueReader(value, label, findings, parameters).read();
}

}   // namespace livens::inline io_internal
