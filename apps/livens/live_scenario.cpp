// SPDX-License-Identifier: BSD-3-Clause
#include "live_scenario.h"

#include <algorithm>
#include <chrono>
#include <ctime>

#include <fmt/format.h>
#include <unistd.h>

#include "console.h"
#include "failure.h"
#include "livens/io/json.h"
#include "livens/io/solve_scenario.h"
#include "memory.h"
#include "summary.h"

namespace livens::program {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int quick = 1;   // compression: what stays on this machine is made soon, not small

std::string time_of_day()
{
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    ::localtime_r(&now, &parts);
    return fmt::format("{:02}:{:02}:{:02} ", parts.tm_hour, parts.tm_min, parts.tm_sec);
}

std::string member(const char* key, const std::string& text)
{
    JsonWriter json;
    return fmt::format(",\"{}\":{}", key, json.value(text).text());
}

}   // namespace

LiveScenario::LiveScenario(const std::string& file, const Common& common, Served& served)
    : file_(file), common_(common), served_(served)
{
    std::error_code error;
    if (!std::filesystem::is_regular_file(file_, error))
        if (ScenarioResult result = read_scenario(file_, common_.parameters); !result.scenario)
            throw failure_of(std::move(result));
    files_.watch({file_});
    served_.has_events = true;
    served_.page = std::make_shared<std::string>(live_page(name(), nullptr, 0));
}

LiveScenario::~LiveScenario()
{
    is_cancelled_ = true;
    if (worker_.joinable()) worker_.join();
}

std::string LiveScenario::name() const { return file_.stem().string(); }

std::shared_ptr<const std::string> LiveScenario::event(const char* kind, const std::string& members) const
{
    std::string text = fmt::format("event: {}\ndata: {{\"number\":{}{}", kind, number_,
                                   member("file", plain(file_.filename().string())));
    for (const char c : members)   // JSON may have several lines
        if (c == '\n')
            text += "\ndata: ";
        else
            text += c;
    return std::make_shared<std::string>(text + "}\n\n");
}

void LiveScenario::go_on()
{
    if (files_.have_changed()) is_wanted_ = true;
    if (is_solving() && (is_wanted_ || files_.are_changing())) is_cancelled_ = true;
    if (is_solving() && is_done_) {
        worker_.join();
        if (!is_cancelled_) tell(std::move(outcome_));
    }
    if (is_wanted_ && !is_solving()) begin();
}

void LiveScenario::begin()
{
    is_wanted_ = is_done_ = is_cancelled_ = false;
    ++number_;
    served_.events[1] = {number_, event("solving", "")};
    worker_ = std::thread([this] {
        outcome_ = solved();
        is_done_ = true;
    });
}

/// On the thread of its own: it touches nothing but what it returns.
LiveScenario::Outcome LiveScenario::solved() const
{
    Outcome out;
    try {
        const Clock::time_point begin = Clock::now();
        ScenarioResult read = read_scenario(file_, common_.parameters);
        out.meshes = read.mesh_files;
        if (!read.scenario) throw failure_of(std::move(read));
        if (!read.diagnostics.empty())
            out.warnings = text_of({exit_ok, "", std::move(read.diagnostics), std::move(read.text)});
        const Scenario& scenario = *read.scenario;
        check_memory({&scenario});
        const auto goes_on = [this] { return !is_cancelled_.load(); };
        SolveOptions options = scenario.options;
        options.most_bytes = std::min(options.most_bytes, 0.5 * memory_left());
        options.progress = [&](const Progress&) { return goes_on(); };
        SolvedScenario motion =
            in_file_of(scenario, [&] { return solve_scenario(scenario, options, scenario.prepared); });
        if (motion.solution.motion.mesh.ends.empty())
            throw failure(exit_not_converged, motion.solution.report.message);
        if (motion.found != nullptr) read.scenario = *motion.found;
        const Run run = judged_run(scenario, std::move(motion), goes_on);
        out.headline = headline_of(run, run.motion.end());
        out.reasons = reasons_of(run);
        out.run = reported({scenario, run, name()}, {.level = quick});
        out.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    } catch (...) {
        out.failure = std::current_exception();
    }
    return out;
}

void LiveScenario::tell(Outcome&& outcome)
{
    std::vector<std::filesystem::path> files = std::move(outcome.meshes);
    files.push_back(file_);
    files_.watch(files);
    ++number_;
    if (outcome.run)
        tell_run(outcome);
    else
        tell_failure(outcome);
}

void LiveScenario::tell_run(const Outcome& outcome)
{
    const ReportedRun& run = *outcome.run;
    served_.events = {Event{number_, event("run", member("said", outcome.warnings) + ",\"run\":" + run.meta +
                                                      ",\"numbers\":\"" + run.numbers + "\"")},
                      Event{}};
    served_.page = std::make_shared<std::string>(live_page(run.title, &run, number_));
    if (common_.quiet) return;
    Summary summary(terminal_of(STDERR_FILENO));
    summary.headline(outcome.headline, fmt::format(" ({:.2g} s)", outcome.seconds));
    for (const std::string& reason : outcome.reasons) summary.figure("because", plain(reason));
    say_raw(outcome.warnings + time_of_day() + summary.text());
}

void LiveScenario::tell_failure(const Outcome& outcome)
{
    try {
        std::rethrow_exception(outcome.failure);
    } catch (...) {
        const Failure failure = current_failure();
        keep_memory_for_report();
        show(failure, common_);
        served_.events[1] = {number_, event("fault", member("said", text_of(failure)))};
    }
}

}   // namespace livens::program
