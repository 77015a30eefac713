// SPDX-License-Identifier: BSD-3-Clause
// For view --watch: a scenario that is solved again whenever it is saved.
#pragma once

#include <atomic>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "commands.h"
#include "livens/io/report.h"
#include "livens/io/verdict_words.h"
#include "visitors.h"
#include "watched_files.h"

namespace livens::program {

/// Solves on a thread of its own; a solution of what was saved over meanwhile is broken off. The scenario and
/// the meshes that it names are watched. The last run that could be had stays on the page.
class LiveScenario {
public:
    /// What is new is told in `served`, which outlives this. Throws what happens where there is no file.
    LiveScenario(const std::string& file, const Common& common, Served& served);
    ~LiveScenario();
    LiveScenario(const LiveScenario&) = delete;
    LiveScenario& operator=(const LiveScenario&) = delete;

    /// Looks at the files and the solution; in short intervals, by the thread that serves.
    void go_on();
    bool is_solving() const { return worker_.joinable(); }

private:
    struct Outcome {
        std::optional<ReportedRun> run;   ///< or else a failure
        std::exception_ptr failure{};
        std::vector<std::filesystem::path> meshes{};
        Headline headline{};
        std::vector<std::string> reasons{};
        std::string warnings{};
        double seconds = 0;
    };

    void begin();
    Outcome solved() const;
    void tell(Outcome&& outcome);
    void tell_run(const Outcome& outcome);
    void tell_failure(const Outcome& outcome);
    /// `members`: of JSON, with a comma before them.
    std::shared_ptr<const std::string> event(const char* kind, const std::string& members) const;
    std::string name() const;

    std::filesystem::path file_;
    const Common& common_;
    Served& served_;
    WatchedFiles files_;
    long number_ = 0;   // of the last event
    bool is_wanted_ = true;
    std::thread worker_;
    std::atomic<bool> is_done_ = false, is_cancelled_ = false;
    Outcome outcome_;
};

}   // namespace livens::program
