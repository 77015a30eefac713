// SPDX-License-Identifier: BSD-3-Clause
// The only source that includes tinyxml2, which expands the five entities of XML and numbers of characters,
// opens nothing, and stops at elements nested deeper than 100. What it is too lenient for is checked here.
#include "livens/io/scenario/text/xml.h"

#include <algorithm>

#include <tinyxml2.h>

#include "livens/io/json.h"

namespace livens::inline io_internal {

namespace {

/// Line of a place in a text, from 1.
int line_at(std::string_view text, std::size_t at)
{
    return 1 +
           static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

/// Markup that is neither a comment nor CDATA, as <!DOCTYPE: its entities may name other files, and may be
/// made of each other until no memory holds them.
bool refuse_document_types(std::string_view text, Findings& findings)
{
    for (std::size_t at = text.find("<!"); at != std::string_view::npos; at = text.find("<!", at)) {
        const bool is_comment = text.substr(at).starts_with("<!--");
        if (!is_comment && !text.substr(at).starts_with("<![CDATA["))
            return findings.error({line_at(text, at), 1, 1}, "xml-syntax",
                                  "document types and entities (<!DOCTYPE ..>) are not read",
                                  {"they may name other files and grow without bound", "leave them out"});
        at = text.find(is_comment ? "-->" : "]]>", at);
        if (at == std::string_view::npos) break;   // the parser says so
    }
    return true;
}

bool scan_xml(std::string_view text, Findings& findings)
{
    for (std::size_t i = 0; i < text.size();) {
        const int length = utf8_length(text.substr(i));
        const unsigned char byte = static_cast<unsigned char>(text[i]);
        if (length == 0)
            return findings.error({line_at(text, i), 1, 1}, "not-text", "this byte is not UTF-8",
                                  {"", "save the file with that encoding"});
        if ((byte < 0x20 && byte != '\n' && byte != '\r' && byte != '\t') || byte == 0x7f)
            return findings.error({line_at(text, i), 1, 1}, "not-text",
                                  "control characters are not allowed in XML");
        i += static_cast<std::size_t>(length);
    }
    // Every element begins with one, so that their number bounds what the parser makes of it.
    if (std::count(text.begin(), text.end(), '<') > 2 * max_xml_elements)
        return findings.error({}, "resource-limit",
                              "the file has more than " + std::to_string(max_xml_elements) + " elements");
    return refuse_document_types(text, findings);
}

/// Of tinyxml2's errors, for people.
std::string in_words(const tinyxml2::XMLDocument& document)
{
    switch (document.ErrorID()) {
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
        return "this end does not belong to the element that is open here";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
        return "an attribute is not of the form name=\"value\"";
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
        return "elements are nested deeper than 100 levels";
    case tinyxml2::XML_ERROR_EMPTY_DOCUMENT:
        return "the file has no element";
    case tinyxml2::XML_ERROR_PARSING_COMMENT:
        return "a comment does not end";
    case tinyxml2::XML_ERROR_PARSING_CDATA:
        return "a CDATA section does not end";
    case tinyxml2::XML_ERROR_PARSING_DECLARATION:
        return "a declaration <? .. ?> does not end, or does not stand first";
    default:
        return "this is not well-formed XML";
    }
}

bool refuse_twice(const XmlElement& element, Findings& findings)
{
    std::vector<std::string_view> names;
    for (const XmlAttribute& attribute : element.attributes) names.push_back(attribute.name);
    std::ranges::sort(names);
    const auto twice = std::ranges::adjacent_find(names);
    return twice == names.end() ||
           findings.error(element.place, "xml-syntax",
                          "<" + element.name + "> has the attribute '" + std::string(*twice) + "' twice",
                          {"nobody can say which of them counts", "leave one of them out"});
}

/// Where lines of a text begin.
class Lines {
public:
    explicit Lines(std::string_view text) : text_(text)
    {
        for (std::size_t at = 0; at != std::string_view::npos; at = next_line(at)) begins_.push_back(at);
    }

    /// Of the first `<name` in a line, in which the parser says that there is one.
    SourceLocation place(int line, std::string_view name) const
    {
        SourceLocation place{line, 1, static_cast<int>(name.size()) + 1};
        if (line < 1 || line > static_cast<int>(begins_.size())) return place;
        constexpr std::size_t most_looked_at = 400;   // of a file that is one line
        std::string_view text = text_.substr(begins_[line - 1], most_looked_at);
        text = text.substr(0, text.find('\n'));
        const std::size_t at = text.find("<" + std::string(name));
        if (at == std::string_view::npos) return place;
        for (const char c : text.substr(0, at))   // characters, not bytes
            place.column += (static_cast<unsigned char>(c) & 0xc0) != 0x80 ? 1 : 0;
        return place;
    }

private:
    std::size_t next_line(std::size_t at) const
    {
        const std::size_t end = text_.find('\n', at);
        return end == std::string_view::npos ? end : end + 1;
    }

    std::string_view text_;
    std::vector<std::size_t> begins_;
};

/// As deep as tinyxml2 has read, which is bounded.
bool convert(const tinyxml2::XMLElement& from, const Lines& lines, XmlElement& to, Findings& findings)
{
    to.name = from.Name();
    to.place = lines.place(from.GetLineNum(), to.name);
    for (const tinyxml2::XMLAttribute* a = from.FirstAttribute(); a != nullptr; a = a->Next())
        to.attributes.push_back({a->Name(), a->Value()});
    if (!refuse_twice(to, findings)) return false;
    for (const tinyxml2::XMLNode* node = from.FirstChild(); node != nullptr; node = node->NextSibling()) {
        if (const tinyxml2::XMLText* text = node->ToText()) to.text += text->Value();
        if (const tinyxml2::XMLElement* child = node->ToElement())
            if (!convert(*child, lines, to.children.emplace_back(), findings)) return false;
    }
    return true;
}

/// One element, and beside it nothing but declarations and comments.
bool check_root(const tinyxml2::XMLDocument& document, Findings& findings)
{
    int n_roots = 0;
    for (const tinyxml2::XMLNode* node = document.FirstChild(); node != nullptr; node = node->NextSibling())
        if (node->ToElement() != nullptr && ++n_roots > 1)
            return findings.error({node->GetLineNum(), 1, 1}, "xml-syntax",
                                  "a second element stands beside the first",
                                  {"a file of XML is one element", ""});
    return n_roots == 1 || findings.error({}, "xml-syntax", "the file has no element");
}

}   // namespace

const std::string* XmlElement::find(std::string_view attribute) const
{
    const auto found = std::ranges::find(attributes, attribute, &XmlAttribute::name);
    return found == attributes.end() ? nullptr : &found->value;
}

std::optional<XmlElement> parse_xml(std::string_view text, Findings& findings)
{
    if (!scan_xml(text, findings)) return {};
    tinyxml2::XMLDocument document(true, tinyxml2::COLLAPSE_WHITESPACE);
    if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
        findings.error({document.ErrorLineNum(), 1, 1}, "xml-syntax", in_words(document));
        return {};
    }
    XmlElement root;
    if (!check_root(document, findings) || !convert(*document.RootElement(), Lines(text), root, findings))
        return {};
    return root;
}

}   // namespace livens::inline io_internal
