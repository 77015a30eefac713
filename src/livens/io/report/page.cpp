// SPDX-License-Identifier: BSD-3-Clause
// The page as it is shipped, with the data of runs put into it.
// The page may run its own script alone, by a hash in its head; data are JSON and text, which no browser
// executes (docs/program.md).
#include <cstdint>
#include <string_view>

#include "livens/base/version.h"
#include "livens/io/report.h"
#include "livens/io/report/parts.h"

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

/// Stands in the shipped page once, where data belong.
constexpr std::string_view place_of_data = "<!--data-->", place_of_title = "<!--title-->";

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

void write_head(JsonWriter& json, const ReportInput& input)
{
    const Run& run = input.run;
    json.member("name", input.name).member("title", run.title);
    json.member("status", to_string(run.report.status)).member("message", run.report.message);
    json.member("converged", run.report.reached_end());
    write_strings(json, "notes", run.notes);
    json.member("method", run.method).member("version", run.version);
    json.member("constraints_hold_at", to_string(run.motion.constraints_hold));
    json.member("scenario", run.scenario_text);
    json.key("options").raw(run.resolved.starts_with('{') ? run.resolved : "null");
    json.key("figures").begin_object();
    write_figures(json, run);
    json.end_object();
    json.member("start", run.motion.start()).member("end", run.motion.end());
    json.member("wanted_end", end_of(input.scenario.time));
}

/// Two elements of a page: what the numbers of a run are, and the numbers.
std::string elements_of(const ReportInput& input, const ReportOptions& options)
{
    JsonWriter json;
    Payload payload;
    ReportData data{json, payload};
    json.begin_object();
    write_head(json, input);
    write_poses(data, input.run, options.most_bytes);
    write_scene(data, input.scenario, input.run);
    write_curves(data, input.scenario, input.run);
    write_quality(data, input.scenario, input.run);
    json.key("arrays");
    payload.write_table(json);
    json.end_object();
    return "<script type=\"application/json\" class=\"run\">" + for_html(json.text()) +
           "</script>\n<script type=\"text/plain\" class=\"numbers\">" + payload.encoded() + "</script>\n";
}

}   // namespace

std::string report_page(const ReportInput& run, const ReportInput* other, const ReportOptions& options)
{
    const std::string_view page = shipped_page();
    const std::size_t title = page.find(place_of_title), data = page.find(place_of_data);
    std::string out(page.substr(0, title));
    out += html_text(run.run.title.empty() ? run.name : run.run.title);
    const std::size_t after = title + place_of_title.size();
    out += page.substr(after, data - after);
    out += "<script type=\"application/json\" id=\"program\">{\"version\":\"" + for_html(version) +
           "\"}</script>\n";
    out += elements_of(run, options);
    if (other != nullptr) out += elements_of(*other, options);
    out += page.substr(data + place_of_data.size());
    return out;
}

bool begins_as_report(std::string_view head)
{
    return head.starts_with("<!doctype html>\n<html lang=\"en\">\n<head>") &&
           head.substr(0, 1024).find("default-src 'none'; script-src 'sha256-") != std::string_view::npos;
}

}   // namespace livens
