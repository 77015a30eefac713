// SPDX-License-Identifier: BSD-3-Clause
// Collecting what is wrong with a file, all of it, and putting it in order.
#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "livens/io/diagnostic.h"

namespace livens::inline io_internal {

/// Where something stands in a file; line and column count characters from 1, line 0 is the whole file.
struct SourceLocation {
    int line = 0;
    int column = 0;
    int length = 1;
    int file = 0;     ///< 0: the one that is read, or else one that it includes, by Findings::add_file()
    int origin = 0;   ///< of a copy: see Findings::add_origin()
};

/// What to say beside the message.
struct Advice {
    std::string note;
    std::string help;
};

class Findings {
public:
    /// Returns false, what readers then return.
    bool error(const SourceLocation& place, std::string_view code, std::string message, Advice advice = {});
    void warning(const SourceLocation& place, std::string_view code, std::string message, Advice advice = {});

    /// A file that is included, for places in it.
    int add_file(const std::string& name, std::string_view text);
    /// What was found of that file before its places knew it.
    void adopt(const Findings& of_file, int file);
    /// A copy of what stands in the file: findings at places of this origin have the words as a note, and
    /// those that other copies of the place have as well are told once.
    int add_origin(std::string words);

    /// Errors so far: a reader compares before and after to learn whether a part was in order.
    int n_errors() const { return n_errors_; }

    /// At most 20, errors first if there are more, in the order of the file, those of files that it includes
    /// behind its own; the last one says how many are missing. `file`: of the one that is read.
    std::vector<Diagnostic> take(const std::string& file);

private:
    void add(Severity severity, const SourceLocation& place, std::string_view code, std::string message,
             Advice advice);

    struct File {
        std::string name, text;
    };
    struct Found {
        Diagnostic told;
        int file = 0;
    };
    std::vector<Found> found_;
    std::vector<File> files_;
    std::vector<std::string> origins_;
    std::set<std::tuple<int, int, int, std::string>> told_of_copies_;   ///< file, line, column, code
    int n_errors_ = 0;
    int n_dropped_ = 0;
};

/// A line of a text, without its end.
std::string_view find_line(std::string_view source, int line);

/// What of a text deceives eye or terminal: "control characters, here U+009B"; empty if nothing does.
std::string first_invisible(std::string_view text);

/// The candidate that `word` is most likely a misspelling of: nearest by insertions, deletions, replacements
/// and exchanges of neighbours, at most a third of its length (at least 1, and 2 from four letters on) away;
/// else empty.
std::string_view closest(std::string_view word, std::span<const std::string_view> candidates);

/// "did you mean 'position'?", or else what is allowed.
std::string suggest(std::string_view word, std::span<const std::string_view> candidates);

}   // namespace livens::inline io_internal
