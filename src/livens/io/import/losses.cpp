// SPDX-License-Identifier: BSD-3-Clause
// Sentences of what was lost: a count, the first names, and where the first one stands.
#include "livens/io/import/losses.h"

#include <algorithm>

namespace livens::inline io_internal {

namespace {

constexpr std::size_t most_named = 6;
constexpr std::size_t most_listed = 200;   // where all are to be named
constexpr std::size_t most_losses = 64;    // of a file with a thousand unknown words

/// With a word for each `@`.
std::string with_word(std::string_view text, const std::string& word)
{
    std::string all;
    for (const char c : text)
        if (c == '@')
            all += word;
        else
            all += c;
    return all;
}

/// " ('a', 'b' and 3 more)". Of more names than are kept nobody knows how many there are.
std::string listed(const std::vector<std::string>& names, std::size_t most)
{
    if (names.empty()) return {};
    std::string text;
    for (std::size_t i = 0; i < std::min(names.size(), most); ++i) text += (i > 0 ? ", " : "") + names[i];
    if (names.size() > most)
        text += std::string(names.size() > most_listed ? " and at least " : " and ") +
                std::to_string(names.size() - most) + " more";
    return " (" + text + ")";
}

}   // namespace

/// One entry for each kind, which is the constant of `losses` itself, and word. Words of a stranger's file
/// may be any number: beyond the bound they become one entry of their kind.
void Losses::add(const LossKind& kind, const SourceLocation& place, std::string name, std::string word)
{
    const auto same = [&](const Loss& l) { return l.kind == &kind && l.word == word; };
    auto found = std::ranges::find_if(all_, same);
    if (found == all_.end() && all_.size() >= most_losses && !word.empty()) {
        word = "and others";
        found = std::ranges::find_if(all_, same);
    }
    if (found == all_.end()) {
        all_.push_back({&kind, std::move(word), place, {}, 0});
        found = std::prev(all_.end());
    }
    ++found->count;
    if (!name.empty() && std::ranges::find(found->names, name) == found->names.end() &&
        found->names.size() <= most_listed)
        found->names.push_back(std::move(name));
}

void Losses::report(bool is_strict, Findings& findings) const
{
    for (const Loss& l : all_) {
        const LossKind& kind = *l.kind;
        const std::string message = with_word(kind.message, l.word) + ": " + std::to_string(l.count) + " " +
                                    std::string(l.count == 1 ? kind.one : kind.many) +
                                    listed(l.names, kind.names_all ? most_listed : most_named);
        const Advice advice{"", with_word(kind.help, l.word)};
        if (is_strict && kind.changes_motion)
            findings.error(l.first, kind.code, message, advice);
        else
            findings.warning(l.first, kind.code, message, advice);
    }
}

}   // namespace livens::inline io_internal
