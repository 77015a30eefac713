// SPDX-License-Identifier: BSD-3-Clause
#include "summary.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "console.h"

namespace livens::program {

namespace {

std::string number(double x)
{
    if (x == 0) return "0";
    return std::isfinite(x) ? fmt::format("{:.1e}", x) : "not known";
}

const char* sign_of(const Terminal& terminal, Ink ink)
{
    if (ink == Ink::good) return terminal.signs ? "\u2713" : "+";
    if (ink == Ink::doubtful) return "?";
    return terminal.signs ? "\u2717" : "x";
}

Ink ink_of(Grade grade)
{
    return grade == Grade::good ? Ink::good : grade == Grade::doubtful ? Ink::doubtful : Ink::bad;
}

constexpr int name_width = 18;        // of figures, two spaces before it not counted
constexpr int narrow_terminal = 60;   // text goes below its name
}   // namespace

void Summary::headline(Ink ink, std::string_view word, std::string_view rest)
{
    const std::string first = std::string(sign_of(terminal_, ink)) + " " + std::string(word);
    text_ += painted(terminal_, ink, first) + ": " +
             wrapped(rest, terminal_.columns, 2, width_of(first) + 2) + "\n";
}

void Summary::headline(const Headline& h, std::string_view behind)
{
    headline(ink_of(h.grade), h.word, h.lead + (h.rest.empty() ? "" : ", " + h.rest) + std::string(behind));
}

void Summary::figure(std::string_view name, std::string_view text)
{
    const bool is_narrow = terminal_.columns > 0 && terminal_.columns < narrow_terminal;
    const int indent = is_narrow ? 4 : 2 + name_width;
    text_ += "  " + painted(terminal_, Ink::dim, fmt::format("{:<{}}", name, is_narrow ? 0 : name_width));
    text_ += (is_narrow ? "\n    " : "") + wrapped(text, terminal_.columns, indent, indent) + "\n";
}

void Summary::aside(std::string_view text) { text_ += painted(terminal_, Ink::dim, text) + "\n"; }

void add_verdict(Summary& summary, const Run& run, double end)
{
    summary.headline(headline_of(run, end));
    for (const std::string& reason : reasons_of(run)) summary.figure("because", plain(reason));
    if (!run.title.empty()) summary.figure("title", plain(run.title));
}

/// The resolved options are livens' own JSON.
const char* witness_of(const Run& run)
{
    const bool is_local = run.resolved.find("\"estimate\": \"local\"") != std::string::npos;
    return is_local ? "what the elements lose, and how that grows" : "a second solution";
}

void add_figures(Summary& summary, const Run& run, bool verbose)
{
    const Verdict& s = run.verdict;
    const SolveReport& report = run.report;
    const bool is_weak = s.max_weak_violation > 0;
    if (run.report.n_elements == 0) return;   // there is nothing to measure
    if (std::isfinite(s.estimated_error))
        summary.figure("estimated error",
                       fmt::format("{} at most at element ends ({}, {:.3g} m), at {:.6g} s; by {}{}",
                                   number(s.estimated_error), judged_figure("estimated_error").meaning,
                                   run.estimate.length, s.estimated_error_time, witness_of(run),
                                   report.converged() || !(s.good_digits > 0)
                                       ? ""
                                       : "; " + digits_through(s.good_digits, s.good_until)));
    summary.figure(judged_figure("max_constraint_violation").name,
                   fmt::format("error {} at most{} (velocity level {} 1/s)",
                               number(s.max_constraint_violation),
                               is_weak ? ", in the mean " + number(s.max_weak_violation) : "",
                               number(s.max_velocity_violation)));
    const auto balance = [&](const char* figure, double drift) {
        const JudgedFigure& of = judged_figure(figure);
        summary.figure(of.name, drift == 0 ? std::string("balanced to rounding")
                                           : fmt::format("error {} ({})", number(drift), of.meaning));
    };
    balance("energy_drift", s.energy_drift);
    balance("angular_momentum_drift", s.angular_momentum_drift);
    if (verbose) {
        summary.figure("zig-zag",
                       fmt::format("{} in positions, {} in momenta (0: smooth, 1: from node to node)",
                                   number(s.zigzag_positions), number(s.zigzag_momenta)));
        summary.figure("residual", number(report.residual_norm));
    }
    if (report.arrival > 0)
        summary.figure("arrival",
                       fmt::format("a rate at the start that is off by 1 mm/s moves it by {:.3g} mm at most",
                                   report.arrival));
    if (report.condition_1 > 0)
        summary.figure("condition", fmt::format("{} in the 1-norm, {} in the 2-norm; {} as it is factorised",
                                                number(report.condition_1), number(report.condition_2),
                                                number(report.scaled_condition)));
}

void add_notes(Summary& summary, const Run& run)
{
    const std::vector<std::string> shown = reasons_of(run);
    for (const std::string& note : run.notes)
        if (std::ranges::find(shown, note) == shown.end()) summary.figure("note", plain(note));
}

std::string quoted(const std::string& argument)
{
    const auto is_harmless = [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
               std::string_view("_-./+:@%=,").find(c) != std::string_view::npos ||
               static_cast<unsigned char>(c) >= 0x80;
    };
    if (!argument.empty() && std::ranges::all_of(argument, is_harmless)) return argument;
    std::string out = "'";
    for (const char c : argument) out += c == '\'' ? "'\\''" : std::string(1, c);
    return out + "'";
}

std::string next_step(const Run& run, const std::string& file)
{
    if (!run.report.reached_end() || run.body_names.empty()) return "next: livens info " + quoted(file);
    return fmt::format("next: livens sample {} --body {} --at {:.6g}", quoted(file),
                       quoted(run.body_names.front()), run.motion.end());
}

}   // namespace livens::program
