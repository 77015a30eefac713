// SPDX-License-Identifier: BSD-3-Clause
// What must hold for any bytes: they are refused by a code that has a page, or make a run that can be used in
// full.
#pragma once

#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>

#include "fuzz/crafted.h"
#include "livens/base/error.h"
#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/sample.h"
#include "livens/io/json.h"
#include "livens/io/report.h"
#include "livens/io/results/layout.h"
#include "livens/io/scenario.h"

namespace livens::test {

/// All numbers of the motion, bit by bit, and the texts that say what they are.
inline bool is_same(const Run& a, const Run& b)
{
    const auto bits = [](const std::vector<double>& x, const std::vector<double>& y) {
        return x.size() == y.size() &&
               (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(double)) == 0);
    };
    const auto matrices = [](const std::vector<Matrix34>& x, const std::vector<Matrix34>& y) {
        return x.size() == y.size() &&
               (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(Matrix34)) == 0);
    };
    return bits(a.motion.X.values, b.motion.X.values) && bits(a.motion.P.values, b.motion.P.values) &&
           bits(a.motion.X.denominators, b.motion.X.denominators) &&
           bits(a.motion.P.denominators, b.motion.P.denominators) &&
           bits(a.motion.rigidity.values, b.motion.rigidity.values) &&
           bits(a.motion.load_angles, b.motion.load_angles) && bits(a.growth, b.growth) &&
           bits(a.motion.mesh.ends, b.motion.mesh.ends) && bits(a.output, b.output) &&
           bits(a.motion.multipliers.values, b.motion.multipliers.values) &&
           bits(a.motion.end_multipliers, b.motion.end_multipliers) &&
           matrices(a.motion.momenta, b.motion.momenta) &&
           matrices(a.motion.velocities, b.motion.velocities) &&
           matrices(a.motion.accelerations, b.motion.accelerations) && a.title == b.title &&
           a.notes == b.notes && a.report.notes == b.report.notes && a.report.message == b.report.message &&
           a.motion.block_ends == b.motion.block_ends && a.scenario_text == b.scenario_text &&
           a.meshes == b.meshes && bits(a.estimate.position, b.estimate.position) &&
           bits(a.estimate.velocity, b.estimate.velocity) &&
           bits(a.estimate.orientation, b.estimate.orientation) &&
           bits(a.estimate.reaction, b.estimate.reaction) && a.body_names == b.body_names &&
           a.report.status == b.report.status && a.method == b.method;
}

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
        JointCoordinates(scenario->model, run.motion).at(t);
        SensorReadings(scenario->model, run.motion).at(t);
    }
    report_page({*scenario, run, "a run"});
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
    try {
        Run run = read_run_from(source_in(bytes), verify);
        use(run);
        return run;
    } catch (const IoError& error) {
        if (!error.code().starts_with("io") || explain(error.code()).empty() || error.what()[0] == '\0')
            std::abort();
    } catch (const InputError& error) {   // of one who uses it, see with_runs() of the program
        if (explain(error.complaint().code).empty()) std::abort();
    }
    return {};
}

}   // namespace livens::test
