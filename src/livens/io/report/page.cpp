// SPDX-License-Identifier: BSD-3-Clause
// The page as it is shipped, with the data of runs put into it.
// The page may run its own script alone, by a hash in its head; data are JSON and text, which no browser
// executes (docs/program.md).
#include <cstdint>
#include <string_view>

#include "livens/base/version.h"
#include "livens/io/report.h"
#include "livens/io/report/parts.h"
#include "livens/io/verdict_words.h"

// The page with script and style in it is made in the folder `report` of the project, see there.
asm(".pushsection .rodata\n"
    "livens_report_page:\n"
    ".incbin \"" LIVENS_REPORT_PAGE "\"\n"
    "livens_report_page_end:\n"
    ".byte 0\n"
    ".popsection\n");
extern "C" {
[[gnu::visibility("hidden")]] extern const char livens_report_page[];
[[gnu::visibility("hidden")]] extern const char livens_report_page_end[];
}

namespace livens {

namespace {

/// These stand in the shipped page once: where title and data belong, before the script, and in the policy.
constexpr std::string_view place_of_data = "<!--data-->", place_of_title = "<!--title-->",
                           before_code = "<script type=\"text/plain\" id=\"code\">",
                           no_address = "default-src 'none'";

std::string_view shipped_page()
{
    return {livens_report_page, static_cast<std::size_t>(livens_report_page_end - livens_report_page)};
}

/// JSON that cannot end the element that it stands in, nor begin another: `<`, `>` and `&` occur in strings
/// alone, where they can be escaped.
std::string for_html(std::string_view json)
{
    std::string out;
    out.reserve(json.size());
    for (const char c : json)
        if (c == '<')
            out += "\\u003c";
        else if (c == '>')
            out += "\\u003e";
        else if (c == '&')
            out += "\\u0026";
        else
            out += c;
    return out;
}

/// Text between tags.
std::string html_text(std::string_view text)
{
    std::string out;
    for (const char c : text)
        if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '&')
            out += "&amp;";
        else if (c != '\0')
            out += c;
    return out;
}

void write_strings(JsonWriter& json, const char* key, const std::vector<std::string>& strings)
{
    json.key(key).begin_array();
    for (const std::string& s : strings) json.value(s);
    json.end_array();
}

void write_verdict(JsonWriter& json, const Run& run)
{
    constexpr const char* grades[] = {"good", "doubtful", "bad"};
    const Headline h = headline_of(run, run.motion.end());
    json.key("verdict").begin_object().member("grade", grades[static_cast<int>(h.grade)]);
    json.member("word", h.word).member("lead", h.lead).member("rest", h.rest);
    write_strings(json, "reasons", reasons_of(run));
    json.key("figures").begin_array();
    for (const JudgedFigure& of : judged_figures())
        json.begin_object()
            .member("figure", of.figure)
            .member("name", of.name)
            .member("meaning", of.meaning)
            .end_object();
    json.end_array().end_object();
}

void write_head(JsonWriter& json, const ReportInput& input)
{
    const Run& run = input.run;
    json.member("name", input.name).member("title", run.title);
    json.member("status", to_string(run.report.status)).member("message", run.report.message);
    json.member("converged", run.report.reached_end());
    write_verdict(json, run);
    write_strings(json, "notes", run.notes);
    json.member("method", run.method).member("version", run.version);
    json.member("constraints_hold_at", to_string(run.motion.constraints_hold));
    json.member("scenario", run.scenario_text);
    json.key("options").raw(run.resolved.starts_with('{') ? run.resolved : "null");
    json.key("figures").begin_object();
    write_figures(json, run);
    json.end_object();
    json.member("start", run.motion.start()).member("end", run.motion.end());
}

/// Two elements of a page: what the numbers of a run are, and the numbers.
std::string elements_of(const ReportedRun& run)
{
    return "<script type=\"application/json\" class=\"run\">" + for_html(run.meta) +
           "</script>\n<script type=\"text/plain\" class=\"numbers\">" + run.numbers + "</script>\n";
}

/// The shipped page in pieces: before and behind the policy's first word, the title, the data and the script,
/// which is compressed, so that a page takes half of the room.
struct Pieces {
    std::string_view head, policy, middle;
    std::string code, tail;
};

const Pieces& pieces()
{
    static const Pieces all = [] {
        const std::string_view page = shipped_page();
        const std::size_t policy = page.find(no_address) + no_address.size(),
                          title = page.find(place_of_title), data = page.find(place_of_data),
                          code = page.find(before_code) + before_code.size(),
                          end = page.find("</script>", code), after_title = title + place_of_title.size(),
                          after_data = data + place_of_data.size();
        Pieces found{page.substr(0, policy), page.substr(policy, title - policy),
                     page.substr(after_title, data - after_title), "", std::string(page.substr(end))};
        found.code = std::string(page.substr(after_data, code - after_data));
        found.code += packed(page.substr(code, end - code), 6);
        return found;
    }();
    return all;
}

/// `program`: members of what the script is told beside the runs.
std::string page_of(const std::string& title, const std::string& program, const std::string& policy,
                    const std::vector<const ReportedRun*>& runs)
{
    const Pieces& page = pieces();
    std::string out(page.head);
    out.append(policy).append(page.policy).append(html_text(title)).append(page.middle);
    out += "<script type=\"application/json\" id=\"program\">{\"version\":\"" + for_html(version) + "\"" +
           program + "}</script>\n";
    for (const ReportedRun* run : runs) out += elements_of(*run);
    return out.append(page.code).append(page.tail);
}

}   // namespace

ReportedRun reported(const ReportInput& input, const ReportOptions& options)
{
    JsonWriter json;
    Payload payload;
    ReportData data{json, payload};
    json.begin_object();
    write_head(json, input);
    write_poses(data, input.run, options.most_bytes);
    write_scene(data, input.scenario, input.run);
    write_curves(data, input.scenario, input.run, options.most_bytes);
    write_events(data, input.scenario, input.run);
    write_quality(data, input.scenario, input.run);
    json.key("arrays");
    payload.write_table(json);
    json.end_object();
    return {input.run.title.empty() ? input.name : input.run.title, json.text(),
            payload.encoded(options.level)};
}

std::string report_page(const ReportInput& run, const ReportInput* other, const ReportOptions& options)
{
    const ReportedRun first = reported(run, options);
    if (other == nullptr) return page_of(first.title, "", "", {&first});
    const ReportedRun second = reported(*other, options);
    return page_of(first.title, "", "", {&first, &second});
}

std::string live_page(const std::string& title, const ReportedRun* run, long number)
{
    std::vector<const ReportedRun*> runs;
    if (run != nullptr) runs.push_back(run);
    return page_of(title, ",\"live\":" + std::to_string(number), "; connect-src 'self'", runs);
}

bool begins_as_report(std::string_view head)
{
    return head.starts_with("<!doctype html>\n<html lang=\"en\">\n<head>") &&
           head.substr(0, 1024).find("default-src 'none'; script-src 'sha256-") != std::string_view::npos;
}

}   // namespace livens
