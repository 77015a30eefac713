// SPDX-License-Identifier: BSD-3-Clause
// livens modes: how a mechanism vibrates about its rest, and its state matrices.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>
#include <unistd.h>

#include "commands.h"
#include "console.h"
#include "failure.h"
#include "interrupt.h"
#include "livens/io/known_state.h"
#include "rest.h"
#include "summary.h"

namespace livens::program {

namespace {

struct Rest {
    const Scenario& scenario;
    std::string at;   ///< "equilibrium" or "start"
    Linearisation linear;
    StabilityReport stability;
    std::vector<VibrationMode> modes;
    std::optional<StateMatrices> matrices;

    const Model& model() const { return scenario.model; }
};

double hertz(const VibrationMode& mode) { return mode.frequency() / (2 * std::numbers::pi); }

void add_complex(JsonWriter& json, const std::string& name, const std::array<std::complex<double>, 3>& v)
{
    json.key(name).value(std::array{v[0].real(), v[1].real(), v[2].real()});
    json.key(name + "_imaginary").value(std::array{v[0].imag(), v[1].imag(), v[2].imag()});
}

void add_mode(JsonWriter& json, const Rest& rest, const VibrationMode& mode)
{
    json.begin_object().member("frequency", mode.frequency()).member("hertz", hertz(mode));
    json.member("damping_ratio", mode.damping_ratio());
    json.member("real", mode.s.real()).member("imaginary", mode.s.imag());
    json.key("bodies").begin_array();
    for (int b = 0; b < rest.model().n_bodies(); ++b) {
        if (rest.model().bodies()[b].holds_states()) continue;
        json.begin_object().member("name", rest.model().body_name(b));
        add_complex(json, "displacement", mode.bodies[b].displacement);
        if (!rest.model().bodies()[b].is_point) add_complex(json, "rotation", mode.bodies[b].rotation);
        json.end_object();
    }
    json.end_array().key("joints").begin_array();
    for (const Joint& joint : rest.model().joints()) {
        if (joint.coordinates.empty()) continue;
        json.begin_object().member("name", joint.name);
        for (const NamedCoordinate& q : joint.coordinates) {
            const std::complex<double> a = amplitude(rest.linear, mode, q.coordinate);
            json.member(q.name, a.real()).member(q.name + "_imaginary", a.imag());
        }
        json.end_object();
    }
    json.end_array().end_object();
}

void add_matrix(JsonWriter& json, const char* name, const std::vector<double>& A, std::size_t n_rows)
{
    json.key(name).begin_array();
    const std::size_t n = n_rows == 0 ? 0 : A.size() / n_rows;
    for (std::size_t i = 0; i < n_rows; ++i) json.value(std::span(A.data() + i * n, n));
    json.end_array();
}

void add_matrices(JsonWriter& json, const Rest& rest)
{
    json.key("state_matrices");
    if (!rest.matrices) {
        json.null();
        return;
    }
    const StateMatrices& s = *rest.matrices;
    const auto n = static_cast<std::size_t>(s.n_states);
    json.begin_object();
    for (const auto& [key, names] : {std::pair{"inputs", &s.inputs}, {"outputs", &s.outputs}}) {
        json.key(key).begin_array();
        for (const std::string& name : *names) json.value(name);
        json.end_array();
    }
    add_matrix(json, "A", s.A, n);
    add_matrix(json, "B", s.B, n);
    add_matrix(json, "C", s.C, s.outputs.size());
    add_matrix(json, "D", s.D, s.outputs.size());
    json.end_object();
}

std::string json_of(const Rest& rest, const std::vector<Diagnostic>& warnings)
{
    JsonWriter json(2);
    json.begin_object().member("converged", true).member("status", to_string(rest.stability.stability));
    json.member("exit_code", static_cast<int>(exit_ok)).member("message", "");
    json.member("title", rest.scenario.title).member("at", rest.at).member("t", rest.linear.state.t);
    json.member("degrees_of_freedom", rest.linear.n);
    json.member("unstable_directions", rest.stability.n_unstable);
    json.member("neutral_directions", rest.stability.n_neutral);
    json.member("length", rest.linear.length);
    json.key("modes").begin_array();
    for (const VibrationMode& mode : rest.modes) add_mode(json, rest, mode);
    json.end_array();
    add_matrices(json, rest);
    json.key("warnings");
    write_diagnostics(json, warnings);
    json.key("errors").begin_array().end_array().end_object();
    return json.text() + "\n";
}

/// The body that goes farthest, by lengths or rad, in words.
std::string most_moved(const Rest& rest, const VibrationMode& mode)
{
    int most = 0;
    double largest = rest.linear.states.n() > 0 ? 0 : -1;
    const auto size = [](const std::array<std::complex<double>, 3>& v) {
        return std::sqrt(std::norm(v[0]) + std::norm(v[1]) + std::norm(v[2]));
    };
    for (int b = 0; b < rest.model().n_bodies(); ++b) {
        const BodyShape& shape = mode.bodies[b];
        const double moved = std::max(size(shape.displacement) / rest.linear.length, size(shape.rotation));
        if (moved <= largest * (1 + 1e-9)) continue;
        largest = moved;
        most = b;
    }
    if (largest == 0 && rest.linear.states.n() > 0) return "states of controllers";
    return "'" + plain(rest.model().body_name(most)) + "' most";
}

std::string words_of(const Rest& rest, const VibrationMode& mode)
{
    const std::string body = most_moved(rest, mode);
    const double zeta = mode.damping_ratio();
    if (mode.s == 0.0) return "not restored: " + body;
    if (mode.s.imag() == 0)
        return fmt::format("{} as e^({:.6g} t): {}", zeta < 0 ? "grows" : "dies", mode.s.real(), body);
    const std::string damped = zeta == 0  ? ""
                               : zeta < 0 ? fmt::format(", grows: damping ratio {:.4g}", zeta)
                                          : fmt::format(", damping ratio {:.4g}", zeta);
    return fmt::format("{:.6g} rad/s ({:.6g} Hz){}: {}", mode.frequency(), hertz(mode), damped, body);
}

std::string text_of(const Rest& rest, const std::string& file)
{
    Summary summary(terminal_of(STDOUT_FILENO));
    add_stability(summary, rest.stability, rest.linear.n);
    summary.figure("title", plain(rest.scenario.title));
    summary.figure("about", rest.at == "start" ? "the start" : "the equilibrium");
    for (std::size_t i = 0; i < rest.modes.size(); ++i)
        summary.figure("mode " + std::to_string(i + 1), words_of(rest, rest.modes[i]));
    if (rest.modes.empty()) summary.figure("modes", "none: the joints leave no degree of freedom");
    if (rest.matrices)
        summary.figure("state matrices",
                       fmt::format("{} states, {} inputs, {} outputs", rest.matrices->n_states,
                                   rest.matrices->inputs.size(), rest.matrices->outputs.size()));
    summary.aside("shapes and matrices: livens modes " + quoted(file) + " --json");
    return summary.text();
}

/// Where drives stand still, at a state in equilibrium; throws where there is none.
Linearisation linear_at_rest(const Scenario& scenario, bool is_start)
{
    if (is_start) return linearise(scenario.model, known_state(scenario).state);
    const InterruptWatch watch;
    const Equilibrium at = equilibrium_of(scenario);
    if (at.is_found) return linearise(frozen(scenario.model, {at.state.t}), at.state);
    if (const int signal = InterruptWatch::signal(); signal != 0)
        throw failure(exit_signal + signal, "stopped during the search for the equilibrium");
    throw failure(exit_not_converged, "no equilibrium was found: " + at.message);
}

}   // namespace

int modes_command(const ModesArguments& arguments, const Common& common)
{
    std::vector<Diagnostic> warnings;
    const Scenario scenario = as_it_rests(load_scenario(arguments.scenario, common, &warnings));
    Rest rest{scenario, arguments.at, {}, {}, {}, {}};
    rest.linear = linear_at_rest(scenario, arguments.at == "start");
    rest.stability = stability(rest.linear);
    rest.modes = vibration_modes(rest.linear);
    if (!arguments.inputs.empty() || !arguments.outputs.empty())
        rest.matrices = state_matrices(scenario.model, rest.linear, arguments.inputs, arguments.outputs);
    if (common.json)
        print(json_of(rest, warnings));
    else if (!common.quiet)
        print(text_of(rest, arguments.scenario));
    return exit_ok;
}

}   // namespace livens::program
