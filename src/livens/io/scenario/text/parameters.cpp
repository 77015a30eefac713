// SPDX-License-Identifier: BSD-3-Clause
// The table [parameters]. Values may stand in any order: what needs another one waits for it on a list, and
// who finds himself on that list is in a ring. Nothing recurses, so that no chain can exhaust the stack.
#include "livens/io/scenario/text/parameters.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "livens/base/text.h"

namespace livens::inline io_internal {

namespace {

using ParameterState = Parameters::One::State;

bool is_name_of_unit(std::string_view name)
{
    std::string reason;
    return parse_unit(name, reason).has_value();
}

/// Told where it stands.
bool check_parameter_name(const Entry& entry, Findings& findings)
{
    const std::string named = "the parameter '" + entry.key + "'";
    if (entry.value.kind == Node::Kind::table)
        return findings.error(entry.place, "parameter-name",
                              "'" + entry.key + "' is a table: parameters are not nested",
                              {"", "name them apart, as in " + entry.key + "_length = 0.4"});
    if (is_word_of_expressions(entry.key))
        return findings.error(entry.place, "parameter-name",
                              named + " hides what expressions call '" + entry.key + "'",
                              {entry.key == "t" ? "t is the time" : "", "call it differently"});
    return is_plain_name(entry.key) ||
           findings.error(entry.place, "parameter-name", named + " cannot be named in an expression",
                          {"", "names have letters of ASCII, digits and _, no digit first"});
}

}   // namespace

/// Overrides before anything is computed: others follow from what they set.
Parameters::Parameters(const Node* table, std::span<const Override> overrides, Findings& findings)
{
    lacks_some_ = table != nullptr && table->kind != Node::Kind::table;
    if (table != nullptr && !lacks_some_) {
        if (table->entries().size() > most) {
            findings.error(table->place, "resource-limit",
                           "there are more than " + std::to_string(most) + " parameters");
            return;
        }
        for (const Entry& entry : table->entries()) add(entry, findings);
    }
    for (const Override& one : overrides) set(one, findings);
    for (const One& one : all_) has_names_of_units_ = has_names_of_units_ || is_name_of_unit(one.name);
    for (std::size_t i = 0; i < all_.size(); ++i) compute_one(i, findings);
}

void Parameters::add(const Entry& entry, Findings& findings)
{
    const Node& value = entry.value;
    One one{.name = entry.key, .place = value.place};
    const std::string named = "the parameter '" + entry.key + "'";
    const bool is_number = value.kind == Node::Kind::integer || value.kind == Node::Kind::number;
    bool is_right = check_parameter_name(entry, findings);
    lacks_some_ = lacks_some_ || !is_right;
    if (!is_right) {
        // told
    } else if (is_number) {
        is_right = std::isfinite(value.number) ||
                   findings.error(value.place, "not-finite",
                                  named + " must be finite, not " + to_text(value.number));
    } else if (value.kind != Node::Kind::text) {
        is_right =
            findings.error(value.place, "wrong-type",
                           named + " must be a number or a string, not " + std::string(describe(value.kind)),
                           {"", "a string has a unit or is an expression: \"400 mm\", \"2*L\""});
    } else if (value.text().find_first_of("\n\r") != std::string::npos) {
        is_right = findings.error(value.place, "expression-syntax", named + " must stand on one line");
    } else {
        one.text = one.file_text = value.text();
        is_right = !one.text.empty() || findings.error(value.place, "expression-syntax", named + " is empty");
    }
    if (is_number) one.amount.value = value.number;
    if (!is_right)
        one.state = ParameterState::is_wrong;
    else if (is_number)
        one.state = ParameterState::is_known;
    places_.emplace(one.name, all_.size());
    all_.push_back(std::move(one));
}

void Parameters::set(const Override& given, Findings& findings)
{
    const std::string said = given.said_by.empty() ? "" : " (" + given.said_by + ")";
    const auto found = places_.find(given.name);
    if (found == places_.end()) {
        const std::vector<std::string_view> known = names();
        findings.error(
            given.place, "parameter-set", "there is no parameter '" + given.name + "' to set" + said,
            {"", known.empty() ? "the file has no table [parameters]" : suggest(given.name, known)});
        return;
    }
    One& one = all_[found->second];
    if (one.is_set) {
        findings.error(given.place, "parameter-set", "the parameter '" + given.name + "' is set twice" + said,
                       {"", "one value is enough"});
        return;
    }
    if (one.state == ParameterState::is_wrong) return;
    one.is_set = true;
    one.set_by = given;
    one.text = given.text;
    one.amount = given.amount;
    // A plain number is one of the file's unit, so that the file's own value has to be known, too.
    one.state = ParameterState::waits;
}

namespace {

/// "400 mm" is 0.4 m, and 500 is nearer to 400 than to 0.4.
/// Nearer by ratio, hence the logarithms: units differ by factors.
bool is_like_written(const std::string& file_text, double in_file, double value)
{
    double written = 0;
    const char* const end = file_text.data() + file_text.size();
    if (std::from_chars(file_text.data(), end, written).ec != std::errc() || written == in_file) return false;
    const double to_written = std::abs(std::log(std::abs(value / written))),
                 to_value = std::abs(std::log(std::abs(value / in_file)));
    return to_written < to_value;
}

void warn_of_unit(const Parameters::One& one, Findings& findings)
{
    const std::string unit = si_unit_of(one.amount), value = to_text(one.amount.value);
    findings.warning(one.set_by.place, "parameter-unit",
                     "the parameter '" + one.name + "' is set to " + value + " " + unit +
                         ", and the file has \"" + one.file_text + "\"",
                     {"a plain number is in the SI unit of the parameter",
                      "write the unit, as in \"" + value + " " + unit + "\" or that of the file"});
}

}   // namespace

/// What an override makes of it: a plain number has the unit of the file's own value.
Computed Parameters::settled(One& one) const
{
    // A number with a unit needs no other parameter, whatever units are called.
    const bool is_number = one.text.empty();
    Computed found = is_number ? Computed{one.amount, "", "", ""}
                               : compute(one.text, is_computed(one.text, *this) ? *this : no_parameters());
    if (!found.code.empty() || !one.is_set || one.file_text.empty()) return found;
    const Computed own = compute(one.file_text, *this);
    if (!own.code.empty()) return own;
    const bool is_plain = !found.amount.has_unit && found.amount.is_pure();
    if (is_plain) {
        const double value = found.amount.value;
        found.amount = own.amount;
        found.amount.value = value;
        one.is_in_unit_of_file = own.amount.has_unit;
        one.is_like_written = own.amount.has_unit && is_like_written(one.file_text, own.amount.value, value);
    } else if (own.amount.has_unit && own.amount.powers != found.amount.powers) {
        return {{},
                "unit",
                "it is " + described(found.amount) + ", and " + described(own.amount) + " in the file",
                ""};
    }
    return found;
}

/// It, and before it what it needs.
void Parameters::compute_one(std::size_t first, Findings& findings)
{
    std::vector<std::size_t> waiting{first};
    while (!waiting.empty()) {
        One& one = all_[waiting.back()];
        if (one.state != ParameterState::waits) {
            waiting.pop_back();
            continue;
        }
        try {
            const Computed found = settled(one);
            one.amount = found.amount;
            one.amount.is_zero = false;   // a name is no literal: it will have other values
            one.state = found.code.empty() ? ParameterState::is_known : ParameterState::is_wrong;
            const bool is_of_file = !one.is_set;
            const std::string said =
                is_of_file || one.set_by.said_by.empty() ? "" : " (" + one.set_by.said_by + ")";
            if (one.is_like_written) warn_of_unit(one, findings);
            if (!found.code.empty() && !found.error.empty())
                findings.error(is_of_file ? one.place : one.set_by.place, found.code,
                               "the parameter '" + one.name + "' cannot be \"" + one.text + "\"" + said +
                                   ": " + found.error,
                               {"", found.help});
        } catch (const Waiting& other) {
            const auto needed = static_cast<std::size_t>(other.needed - all_.data());
            if (std::ranges::find(waiting, needed) == waiting.end())
                waiting.push_back(needed);
            else
                tell_ring(waiting, needed, findings);
        }
    }
}

/// All in the ring become wrong, by which compute_one() comes to its end.
void Parameters::tell_ring(const std::vector<std::size_t>& waiting, std::size_t wanted, Findings& findings)
{
    std::string ring;
    const auto begin = std::ranges::find(waiting, wanted);
    for (auto at = begin; at != waiting.end(); ++at) {
        One& one = all_[*at];
        one.state = ParameterState::is_wrong;
        constexpr std::ptrdiff_t most_named = 10;
        if (at - begin < most_named) ring += one.name + " needs ";
    }
    ring += all_[wanted].name;
    const One& one = all_[wanted];
    const bool is_alone = waiting.back() == wanted;
    findings.error(one.place, "parameter-ring",
                   is_alone ? "the parameter '" + one.name + "' needs itself"
                            : "parameters need each other: " + ring,
                   {"", "one of them has to be a number"});
}

const Parameters::One* Parameters::find(std::string_view name) const
{
    const auto found = places_.find(name);
    if (found == places_.end()) return nullptr;
    const One& one = all_[found->second];
    one.is_used = true;
    return &one;
}

std::vector<std::string_view> Parameters::names() const
{
    std::vector<std::string_view> all;
    for (const One& one : all_) all.push_back(one.name);
    return all;
}

void Parameters::warn_of_unused(Findings& findings) const
{
    for (const One& one : all_)
        if (!one.is_used)
            findings.warning(one.place, "parameter-unused", "nothing uses the parameter '" + one.name + "'",
                             {"", "leave it out, or see whether it is spelled otherwise elsewhere"});
}

}   // namespace livens::inline io_internal
