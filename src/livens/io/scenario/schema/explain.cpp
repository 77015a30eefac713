// SPDX-License-Identifier: BSD-3-Clause
// Pages on codes of findings, one for each, from docs/diagnostics.md, which is compiled into the library: the
// program explains what the page says, word for word.
#include <algorithm>

#include "livens/io/diagnostic.h"
#include "livens/io/scenario/schema/explain.h"
#include "livens/io/scenario/text/findings.h"

namespace livens {

namespace {

struct Page {
    std::string_view code;
    std::string_view text;   ///< without blank lines around it
};

std::string_view trimmed(std::string_view text)
{
    while (text.starts_with('\n')) text.remove_prefix(1);
    while (text.ends_with('\n')) text.remove_suffix(1);
    return text;
}

std::vector<Page> divided(std::string_view text)
{
    constexpr std::string_view opening = "\n## ";
    std::vector<Page> pages;
    for (std::size_t at = text.find(opening); at != std::string_view::npos;) {
        // A page reaches from its heading of second level to the next; the heading is the code.
        text.remove_prefix(at + opening.size());
        at = text.find(opening);
        const std::string_view page = text.substr(0, at);
        const std::size_t end = page.find('\n');
        pages.push_back({page.substr(0, end), trimmed(page.substr(end))});
    }
    return pages;
}

const std::vector<Page>& pages()
{
    static const std::vector<Page> all = divided(diagnostics_markdown());
    return all;
}

}   // namespace

std::string_view explain(std::string_view code)
{
    const auto found = std::ranges::find(pages(), code, &Page::code);
    return found == pages().end() ? std::string_view() : found->text;
}

std::vector<std::string_view> diagnostic_codes()
{
    std::vector<std::string_view> codes;
    for (const Page& page : pages()) codes.push_back(page.code);
    return codes;
}

}   // namespace livens
