// SPDX-License-Identifier: BSD-3-Clause
// Findings of one reading, bounded in number, and suggestions for misspelt words. The distance of words is
// that of optimal string alignment: insertions, deletions, replacements and swaps of neighbours (Damerau,
// 1964), by dynamic programming.
#include "livens/io/scenario/text/findings.h"

#include <algorithm>
#include <cassert>
#include <tuple>

namespace livens::inline io_internal {

namespace {

constexpr int most_findings = 20;
constexpr int most_kept = 2000;            // of a file with a million mistakes
constexpr std::size_t longest_word = 64;   // the distance costs the product of the lengths

int distance(std::string_view a, std::string_view b)
{
    const std::size_t n = b.size() + 1;
    // A swap looks two rows back; three rows are enough, so that long words need no matrix.
    std::vector<int> rows(3 * n);
    const auto at = [&](std::size_t i, std::size_t j) -> int& { return rows[(i % 3) * n + j]; };
    for (std::size_t i = 0; i <= a.size(); ++i) {
        for (std::size_t j = 0; j < n; ++j) {
            if (i == 0 || j == 0) {
                at(i, j) = static_cast<int>(i + j);
                continue;
            }
            const int replaced = at(i - 1, j - 1) + (a[i - 1] == b[j - 1] ? 0 : 1);
            int d = std::min({replaced, at(i - 1, j) + 1, at(i, j - 1) + 1});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d = std::min(d, at(i - 2, j - 2) + 1);
            at(i, j) = d;
        }
    }
    return at(a.size(), b.size());
}

}   // namespace

std::string_view find_line(std::string_view source, int line)
{
    // A mark of the byte order counts as no column, as in editors.
    if (source.substr(0, 3) == "\xef\xbb\xbf") source.remove_prefix(3);
    for (int i = 1; i < line; ++i) {
        const std::size_t end = source.find('\n');
        if (end == std::string_view::npos) return {};
        source.remove_prefix(end + 1);
    }
    source = source.substr(0, source.find('\n'));
    if (!source.empty() && source.back() == '\r') source.remove_suffix(1);
    return source;
}

void Findings::add(Severity severity, const SourceLocation& place, std::string_view code, std::string message,
                   Advice advice)
{
    assert(!explain(code).empty() && "every code has a page");
    // Counted even where it is not kept or was told of another copy: readers compare counts.
    if (severity == Severity::error) ++n_errors_;
    if (place.origin > 0) {
        if (!told_of_copies_.emplace(place.file, place.line, place.column, code).second) return;
        const std::string& words = origins_[static_cast<std::size_t>(place.origin) - 1];
        advice.note += (advice.note.empty() ? "" : "; ") + words;
    }
    if (found_.size() >= most_kept) {
        ++n_dropped_;
        return;
    }
    found_.push_back({{severity,
                       std::string(code),
                       std::move(message),
                       {},
                       place.line,
                       place.column,
                       std::max(1, place.length),
                       std::move(advice.note),
                       std::move(advice.help)},
                      place.file});
}

int Findings::add_file(const std::string& name, std::string_view text)
{
    files_.push_back({name, std::string(text)});
    return static_cast<int>(files_.size());
}

void Findings::adopt(const Findings& of_file, int file)
{
    n_errors_ += of_file.n_errors_;
    n_dropped_ += of_file.n_dropped_;
    for (Found one : of_file.found_) {
        one.file = file;
        found_.push_back(std::move(one));
    }
}

int Findings::add_origin(std::string words)
{
    origins_.push_back(std::move(words));
    return static_cast<int>(origins_.size());
}

bool Findings::error(const SourceLocation& place, std::string_view code, std::string message, Advice advice)
{
    add(Severity::error, place, code, std::move(message), std::move(advice));
    return false;
}

void Findings::warning(const SourceLocation& place, std::string_view code, std::string message, Advice advice)
{
    add(Severity::warning, place, code, std::move(message), std::move(advice));
}

std::vector<Diagnostic> Findings::take(const std::string& file)
{
    const auto in_file = [](const Found& a, const Found& b) {
        return std::tie(a.file, a.told.line, a.told.column) < std::tie(b.file, b.told.line, b.told.column);
    };
    // A file that is included twice has its faults once.
    const auto is_same = [](const Found& a, const Found& b) {
        return a.file > 0 && a.file == b.file && a.told.line == b.told.line &&
               a.told.column == b.told.column && a.told.code == b.told.code &&
               a.told.message == b.told.message;
    };
    const auto by_severity = [](const Found& a, const Found& b) { return a.told.severity < b.told.severity; };
    std::stable_sort(found_.begin(), found_.end(), in_file);
    found_.erase(std::unique(found_.begin(), found_.end(), is_same), found_.end());
    // Errors stay before warnings where not all fit, but are shown in the order of the file.
    if (found_.size() > most_findings) {
        std::stable_sort(found_.begin(), found_.end(), by_severity);
        n_dropped_ += static_cast<int>(found_.size()) - most_findings;
        found_.resize(most_findings);
        std::stable_sort(found_.begin(), found_.end(), in_file);
        std::string& note = found_.back().told.note;
        note += (note.empty() ? "" : "; ") + std::to_string(n_dropped_) + " more are not shown";
    }
    std::vector<Diagnostic> all;
    for (Found& one : found_) {
        Diagnostic& d = all.emplace_back(std::move(one.told));
        const File* included = one.file > 0 ? &files_[static_cast<std::size_t>(one.file - 1)] : nullptr;
        d.file = included == nullptr ? file : included->name;
        if (included != nullptr && d.line > 0) d.source_line = find_line(included->text, d.line);
    }
    found_.clear();
    return all;
}

std::string_view closest(std::string_view word, std::span<const std::string_view> candidates)
{
    if (word.empty() || word.size() > longest_word) return {};
    std::string_view best;
    // A suggestion may differ by a third of the word: two letters at least, one in words below four.
    int least = std::max(word.size() < 4 ? 1 : 2, static_cast<int>(word.size()) / 3) + 1;
    for (const std::string_view candidate : candidates) {
        if (candidate.size() > longest_word) continue;
        const int d = distance(word, candidate);
        if (d < least) {
            least = d;
            best = candidate;
        }
    }
    return best;
}

std::string suggest(std::string_view word, std::span<const std::string_view> candidates)
{
    const std::string_view best = closest(word, candidates);
    if (!best.empty()) return "did you mean '" + std::string(best) + "'?";
    if (candidates.empty()) return {};
    constexpr std::size_t most_listed = 30;
    std::string text = "known here: ";
    for (std::size_t i = 0; i < std::min(candidates.size(), most_listed); ++i) {
        if (i > 0) text += ", ";
        text += candidates[i];
    }
    if (candidates.size() > most_listed) text += ", ...";
    return text;
}

}   // namespace livens::inline io_internal
