// SPDX-License-Identifier: BSD-3-Clause
// What must hold for any bytes: they are refused by a code that has a page, or make a run that can be used in
// full.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

#include "livens/base/error.h"
#include "livens/diagnostics/sample.h"
#include "livens/io/json.h"
#include "livens/io/results/layout.h"
#include "livens/io/scenario.h"

namespace livens::test {

/// Samples, reactions, figures and another file: what the program makes of a run. The last scenario is kept,
/// as most files have the same.
inline void use(const Run& run)
{
    static std::optional<Scenario> scenario;
    if (!scenario || scenario->text != run.scenario_text)
        scenario = parse_scenario(run.scenario_text, "").scenario;
    if (!scenario) return;
    check_model(scenario->model, run);
    for (const double share : {0.0, 0.3, 1.0}) {
        const double t = run.motion.start() + share * (run.motion.end() - run.motion.start());
        if (!(t >= run.motion.start() && t <= run.motion.end())) continue;   // which rounding may do
        sample_bodies(scenario->model, run.motion, t);
        sample_joints(scenario->model, run.motion, t);
    }
    if (!run.estimate.empty()) run.estimate.good(run.motion.mesh);
    for (int b = 0; b < run.motion.n_bodies; ++b)
        ErrorEstimate::at(run.estimate.position, run.motion.n_bodies, b, run.motion.mesh, run.motion.end());
    JsonWriter json;
    json.begin_object();
    write_figures(json, run);
    json.end_object();
    write_run_to([](std::uint64_t, std::string_view) {}, scenario->model, run);
}

/// The run, or nothing if the bytes were refused. `verify`: whether checksums are looked at. Anything but a
/// refusal with a known code ends the program.
inline std::optional<Run> answer_to(const std::string& bytes, bool verify)
{
    const ByteSource source{bytes.size(), [&bytes](std::uint64_t offset, std::span<char> out) {
                                if (offset > bytes.size() || out.size() > bytes.size() - offset) std::abort();
                                bytes.copy(out.data(), out.size(), offset);
                            }};
    try {
        Run run = read_run_from(source, verify);
        use(run);
        return run;
    } catch (const IoError& error) {
        if (!error.code().starts_with("io") || explain(error.code()).empty() || error.what()[0] == '\0')
            std::abort();
    }
    return {};
}

}   // namespace livens::test
