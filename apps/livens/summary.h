// SPDX-License-Identifier: BSD-3-Clause
// A run in words for people: the verdict first, then figures.
#pragma once

#include <string>
#include <string_view>

#include "livens/io/results.h"
#include "livens/io/verdict_words.h"
#include "terminal.h"

namespace livens::program {

/// Text in lines for one terminal. A figure is a dim name and words beside it, wrapped to the width.
class Summary {
public:
    explicit Summary(const Terminal& terminal) : terminal_(terminal) {}

    /// A sign and a word in its colour, then the rest of the sentence.
    void headline(Ink ink, std::string_view word, std::string_view rest);
    /// That of a run, and what may stand behind it.
    void headline(const Headline& headline, std::string_view behind = "");
    void figure(std::string_view name, std::string_view text);
    /// A line in dim letters, such as what to do next.
    void aside(std::string_view text);

    const std::string& text() const { return text_; }

private:
    Terminal terminal_;
    std::string text_;
};

/// The verdict, the title, and for a run that is not as it should be, why. `end`: of its motion, s.
void add_verdict(Summary& summary, const Run& run, double end);

/// Constraints, energy, momentum; if `verbose`, zig-zag and residual too; condition numbers where the run has
/// them.
void add_figures(Summary& summary, const Run& run, bool verbose);

/// Notes of the run that add_verdict() has not shown.
void add_notes(Summary& summary, const Run& run);

/// An argument as a shell takes it.
std::string quoted(const std::string& argument);
/// What to do with a result of this kind, in this file.
std::string next_step(const Run& run, const std::string& file);

}   // namespace livens::program
