// SPDX-License-Identifier: BSD-3-Clause
// A word that is nearly one that may stand in an element is an error, as what is misspelt would have no
// effect; any other is told as lost. Numbers are read as a whole or not at all.
#include "livens/io/import/urdf_elements.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "livens/base/text.h"

namespace livens::inline io_internal {

namespace {

/// Words between blanks.
std::vector<std::string_view> between_blanks(std::string_view text)
{
    std::vector<std::string_view> words;
    constexpr std::string_view blanks = " \t\r\n";
    for (std::size_t at = text.find_first_not_of(blanks); at != std::string_view::npos;) {
        const std::size_t end = std::min(text.find_first_of(blanks, at), text.size());
        words.push_back(text.substr(at, end - at));
        at = text.find_first_not_of(blanks, end);
    }
    return words;
}

/// The whole word as a finite number.
bool read_number(std::string_view word, double& value)
{
    // from_chars() knows no plus sign, and stops where a number ends, which has to be the end of the word.
    if (word.starts_with('+')) word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc{} && end == word.data() + word.size() && std::isfinite(value);
}

std::string counted(std::size_t n) { return n == 1 ? "a number" : std::to_string(n) + " numbers"; }

/// Files in the language of macros that URDFs are made from.
std::string help_of_macros(std::string_view word)
{
    const bool is_macro = word.starts_with("xacro:") || word.find("${") != std::string_view::npos ||
                          word.find("$(") != std::string_view::npos;
    return is_macro ? "this is xacro: make a URDF of it first, xacro robot.urdf.xacro > robot.urdf" : "";
}

}   // namespace

std::string in_marks(std::string_view name) { return "'" + std::string(name) + "'"; }

/// In this order: words that count, those that are known not to, macros, and last whether it is nearly one
/// of both. What other programs add (`is_free`) may be near to a word by chance.
void UrdfElements::check_word(const XmlElement& e, const XmlElement& child, const ElementContent& content,
                              const std::string& owner)
{
    const std::string_view name = child.name;
    if (std::ranges::find(content.children, name) != content.children.end()) return;
    const auto known = std::ranges::find(content.uncounted, name, &UncountedWord::word);
    if (known != content.uncounted.end()) return losses_.add(*known->loss, child.place, owner, child.name);
    if (const std::string help = help_of_macros(name); !help.empty()) {
        findings_.error(child.place, "urdf-tag", "<" + child.name + "> is no tag of URDF", {"", help});
        return;
    }
    UrdfWords all = content.children;
    for (const UncountedWord& u : content.uncounted) all.push_back(u.word);
    if (const std::string_view meant = closest(name, all); !meant.empty() && !content.is_free)
        findings_.error(
            child.place, "urdf-tag", "<" + child.name + "> in <" + e.name + "> is no tag of URDF",
            {"what is misspelt would be left out in silence", "did you mean <" + std::string(meant) + ">?"});
    else
        losses_.add(losses::extension, child.place, owner, child.name);
}

void UrdfElements::check(const XmlElement& e, const ElementContent& content, const std::string& owner)
{
    if (!e.text.empty())
        findings_.error(e.place, "urdf-tag", "words stand between the tags of <" + e.name + ">",
                        {"URDF says all in tags and attributes", ""});
    for (const XmlElement& child : e.children) check_word(e, child, content, owner);
    for (const XmlAttribute& a : e.attributes) {
        if (std::ranges::find(content.attributes, a.name) != content.attributes.end()) continue;
        if (a.name.starts_with("xmlns")) continue;   // names spaces of tags, says nothing itself
        if (const std::string_view meant = closest(a.name, content.attributes); !meant.empty())
            findings_.error(e.place, "urdf-tag", "<" + e.name + "> has no attribute '" + a.name + "'",
                            {"what is misspelt would be left out in silence",
                             "did you mean '" + std::string(meant) + "'?"});
        else
            losses_.add(losses::attribute, e.place, owner, in_marks(a.name) + " of <" + e.name + ">");
    }
}

const XmlElement* UrdfElements::only(const XmlElement& e, std::string_view name)
{
    const XmlElement* found = nullptr;
    for (const XmlElement& child : e.children) {
        if (child.name != name) continue;
        if (found != nullptr)
            findings_.error(child.place, "urdf-tag",
                            "<" + e.name + "> has <" + child.name + "> twice, first in line " +
                                std::to_string(found->place.line),
                            {"nobody can say which of them counts", "leave one of them out"});
        else
            found = &child;
    }
    return found;
}

std::string UrdfElements::text(const XmlElement& e, std::string_view attribute)
{
    const std::string* value = e.find(attribute);
    if (value == nullptr || value->empty())
        findings_.error(e.place, "urdf-tag",
                        "<" + e.name + "> needs the attribute '" + std::string(attribute) + "'");
    return value == nullptr ? std::string() : *value;
}

std::string UrdfElements::name_of(const XmlElement& e) { return text(e, "name"); }

bool UrdfElements::numbers(const XmlElement& e, std::string_view attribute, std::span<double> values)
{
    const std::string* given = e.find(attribute);
    if (given == nullptr) return false;
    const std::vector<std::string_view> words = between_blanks(*given);
    std::vector<double> read(words.size());
    bool is_right = words.size() == values.size();
    for (std::size_t i = 0; is_right && i < words.size(); ++i) is_right = read_number(words[i], read[i]);
    if (!is_right)
        return findings_.error(e.place, "urdf-value",
                               "'" + std::string(attribute) + "' of <" + e.name + "> is \"" +
                                   given->substr(0, 80) + "\", not " + counted(values.size()),
                               {"", help_of_macros(*given)});
    std::ranges::copy(read, values.begin());
    return true;
}

double UrdfElements::number(const XmlElement& e, std::string_view attribute, double otherwise)
{
    numbers(e, attribute, {&otherwise, 1});
    return otherwise;
}

/// Not negative.
double UrdfElements::bounded(const XmlElement& e, std::string_view attribute, double otherwise)
{
    const double value = number(e, attribute, otherwise);
    if (value < 0)
        findings_.error(e.place, "urdf-value",
                        "'" + std::string(attribute) + "' of <" + e.name +
                            "> is negative: " + to_text(value));
    return value;
}

/// Needed; of what is drawn alone, so that 0 is no error.
double UrdfElements::size(const XmlElement& e, std::string_view attribute)
{
    text(e, attribute);
    return bounded(e, attribute, 1);
}

Pose UrdfElements::pose(const XmlElement& e, const std::string& owner)
{
    const XmlElement* origin = only(e, "origin");
    if (origin == nullptr) return {};
    check(*origin, {{"xyz", "rpy"}, {}}, owner);
    Pose pose;
    Vector3 rpy{};
    numbers(*origin, "xyz", pose.origin.a);
    if (numbers(*origin, "rpy", rpy.a))   // about the fixed axes x, y, z, in this order
        pose.axes = turn({0, 0, 1}, rpy[2]) * turn({0, 1, 0}, rpy[1]) * turn({1, 0, 0}, rpy[0]);
    return pose;
}

}   // namespace livens::inline io_internal
