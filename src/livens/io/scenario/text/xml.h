// SPDX-License-Identifier: BSD-3-Clause
// An XML file as a tree of elements that know their lines. The only source that sees tinyxml2 is xml.cpp.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "livens/io/scenario/text/findings.h"

namespace livens::inline io_internal {

struct XmlAttribute {
    std::string name, value;
};

struct XmlElement {
    std::string name;
    SourceLocation place;   ///< of its first tag
    std::vector<XmlAttribute> attributes;
    std::vector<XmlElement> children;
    std::string text;   ///< between its children

    const std::string* find(std::string_view attribute) const;   ///< null if there is none
};

/// Most elements in a file.
inline constexpr int max_xml_elements = 200'000;

/// The root. Refused are: what is not UTF-8 text, document types (whose entities name other files and grow
/// without bound), two roots, an attribute that stands twice, nesting deeper than 100. Empty after an error.
std::optional<XmlElement> parse_xml(std::string_view text, Findings& findings);

}   // namespace livens::inline io_internal
