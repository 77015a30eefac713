// SPDX-License-Identifier: BSD-3-Clause
// [time], [method], [start] and [end] as options of the solution, and the same as JSON with all defaults
// filled in. That text goes into the run's file: a later version may have other defaults, and the run still
// says how it was solved.
#include "livens/io/json.h"
#include "livens/io/scenario/builder.h"
#include "livens/spacetime/mixed/bases.h"

namespace livens {

namespace {

const char* word(Known given)
{
    switch (given) {
    case Known::nothing:
        return "nothing";
    case Known::positions:
        return "positions";
    case Known::momenta:
        return "momenta";
    case Known::state:
        break;
    }
    return "state";
}

void write_window(JsonWriter& json, int window)
{
    json.key("window");
    if (window > 0)
        json.value(window);
    else
        json.value("all");
}

void write_mixed(JsonWriter& json, const Mixed& mixed)
{
    json.member("family", "mixed");
    json.member("basis", mixed::basis_of(mixed).word);
    json.member("degree", mixed.degree);
    json.member("momentum", mixed.start == Mixed::Start::natural ? "natural" : "strong");
    json.member("multipliers", mixed.multipliers == Mixed::Multipliers::equal ? "equal" : "lower");
    json.member("end_multiplier", mixed.end_multiplier == Mixed::EndMultiplier::smooth ? "smooth" : "zero");
    json.key("gauss_points");
    if (mixed.gauss_points > 0)
        json.value(mixed.gauss_points);
    else
        json.value("exact");
    write_window(json, mixed.window);
    json.member("interfaces", mixed.interfaces == Mixed::Interfaces::carry ? "carry" : "project");
    json.member("first_guess", mixed.first_guess == Mixed::FirstGuess::march ? "march" : "steady");
    if (!mixed.knots.empty()) json.member("knots", std::span<const double>(mixed.knots));
    if (!mixed.weights.empty()) json.member("weights", std::span<const double>(mixed.weights));
    json.member("linear_solver", mixed.linear_solver == SparseBackend::eigen ? "eigen" : "umfpack");
}

void write_degree(JsonWriter& json, int degree)
{
    json.key("degree");
    if (degree > 0)
        json.value(degree);
    else
        json.value("by accuracy");
}

void write_method(JsonWriter& json, const Method& method)
{
    if (const Mixed* mixed = std::get_if<Mixed>(&method))
        write_mixed(json, *mixed);
    else if (const Lobatto* lobatto = std::get_if<Lobatto>(&method)) {
        json.member("family", "lobatto");
        write_degree(json, lobatto->degree);
        write_window(json, lobatto->window);
    } else if (const Radau* radau = std::get_if<Radau>(&method)) {
        json.member("family", "radau");
        write_degree(json, radau->degree);
    } else if (const Auto* either = std::get_if<Auto>(&method)) {
        json.member("family", "auto");
        write_degree(json, either->degree);
    } else
        json.member("family", std::holds_alternative<Midpoint>(method) ? "midpoint" : "endpoint");
}

std::string resolve(const Builder& builder, const Section& time, const Scenario& scenario)
{
    const Vector3 gravity = builder.top().vector("gravity");
    const SolveOptions& options = scenario.options;
    JsonWriter json;
    json.begin_object().member("format", 1).member("title", scenario.title);
    json.member("gravity", std::span<const double>(gravity.a));
    json.key("time").begin_object();
    json.member("start", start_of(scenario.time)).member("end", end_of(scenario.time));
    if (const auto* mesh = std::get_if<TimeMesh>(&scenario.time))
        json.member("elements", time.has("elements") ? time.integer("elements") : mesh->n_elements());
    else
        json.member("accuracy", std::get<Span>(scenario.time).accuracy);
    json.key("output");
    const Value* output = time.find("output");
    if (output == nullptr)
        json.value("element ends");
    else if (output->n_rows == 1)
        json.value(std::span<const double>(output->numbers));
    else
        json.value(output->numbers.front());
    json.member("breaks", time.text("breaks")).end_object();
    json.key("method").begin_object();
    write_method(json, scenario.method);
    json.member("tolerance", options.tolerance).member("max_iterations", options.max_iterations);
    constexpr const char* of_estimate[] = {"second", "local", "none"};
    json.member("estimate", of_estimate[static_cast<int>(options.estimate)]);
    json.member("growth", options.growth).member("looks", options.look_at_laws);
    json.member("condition", options.condition).end_object();
    json.key("start").begin_object().member("given", word(scenario.conditions.at_start));
    json.member("initial", options.initial == StartPolicy::check ? "check" : "project").end_object();
    json.key("end").begin_object().member("given", word(scenario.conditions.at_end)).end_object();
    return json.end_object().text();
}

/// Complaints about what the file leaves to its defaults point at what comes nearest.
/// What is not stated follows from the accuracy.
void leave_open(Method& method, bool has_family, bool has_degree)
{
    auto* lobatto = std::get_if<Lobatto>(&method);
    // Degree 0 leaves the degree to the accuracy (theory.md, To an accuracy).
    if (!has_family && lobatto != nullptr)
        method = Auto{has_degree ? lobatto->degree : 0};
    else if (lobatto != nullptr && !has_degree)
        lobatto->degree = 0;
    else if (auto* radau = std::get_if<Radau>(&method); radau != nullptr && !has_degree)
        radau->degree = 0;
}

void remember_defaults(Builder& builder)
{
    const Section* time = only_section(builder.top(), "time");
    const Section* start = only_section(builder.top(), "start");
    const Section* end = only_section(builder.top(), "end");
    // A complaint about a table that the file does not have points at the condition that asks for it.
    if (end != nullptr) {
        if (start == nullptr) builder.remember("start", end->place("given"));
        builder.remember("method", end->place("given"));
    } else if (start != nullptr) {
        builder.remember("end", start->place("given"));
        builder.remember("method", start->place("given"));
    }
    if (time != nullptr) builder.remember("method", time->place());
}

}   // namespace

void read_run(Builder& builder, Scenario& scenario)
{
    const Section* time = only_section(builder.top(), "time");
    const Section* method = only_section(builder.top(), "method");
    const Section* start = only_section(builder.top(), "start");
    scenario.title = builder.top().text("title");
    scenario.method = read_method(method, builder.findings());
    const bool is_to_accuracy = time != nullptr && follows_accuracy(*time, scenario.method);
    const auto states = [&](const char* key) { return method != nullptr && method->has(key); };
    // The family is read before, since its knots decide whether elements follow from an accuracy.
    if (is_to_accuracy) leave_open(scenario.method, states("family"), states("degree"));
    scenario.options.growth = states("growth") ? method->truth("growth") : is_to_accuracy;
    if (method != nullptr && method->has("tolerance"))
        scenario.options.tolerance = method->number("tolerance");
    if (method != nullptr && method->has("max_iterations"))
        scenario.options.max_iterations = method->integer("max_iterations");
    if (method != nullptr) scenario.options.condition = method->truth("condition");
    if (states("looks")) scenario.options.look_at_laws = method->truth("looks");
    if (method != nullptr) scenario.options.estimate = method->pick<SolveOptions::Estimate>("estimate");
    if (start != nullptr && start->text("initial") == "project")
        scenario.options.initial = StartPolicy::project;
    if (time != nullptr) scenario.options.end_at_bends = time->text("breaks") != "ignore";
    read_boundary(builder, scenario.conditions);
    remember_defaults(builder);
    if (time == nullptr) return;
    if (!read_time(builder, *time, method, scenario)) return;
    scenario.resolved = resolve(builder, *time, scenario);
}

}   // namespace livens
