// SPDX-License-Identifier: BSD-3-Clause
// [time], [method], [start] and [end] as options of the solution, and the same as JSON with all defaults
// filled in. That text goes into the run's file: a later version may have other defaults, and the run still
// says how it was solved.
#include "livens/io/scenario/run/run.h"

#include "livens/io/json.h"

namespace livens::inline io_internal {

namespace {

/// Conditions by component under "known", where there are some.
void write_components(JsonWriter& json, const std::vector<Condition>& components)
{
    if (components.empty()) return;
    json.key("known").begin_object();
    for (const Condition::At at : {Condition::At::start, Condition::At::end}) {
        json.key(at == Condition::At::end ? "end" : "start").begin_object();
        for (const Condition& one : components)
            if (one.at == at) json.member(one.quantity.name, one.value);
        json.end_object();
    }
    json.end_object();
}

void write_periodic(JsonWriter& json, const Conditions& conditions)
{
    if (!conditions.is_periodic) return;
    if (!conditions.turn) {
        json.member("periodic", true);
        return;
    }
    const AxisTurn& turn = *conditions.turn;
    json.key("periodic").begin_object().member("turn", turn.angle);
    json.member("axis", std::span<const double>(turn.axis.a));
    json.member("at", std::span<const double>(turn.at.a)).end_object();
}

}   // namespace

}   // namespace livens::inline io_internal

void livens::write_found(JsonWriter& json, const Scenario& scenario)
{
    if (scenario.unknowns.is_empty()) return;
    json.key("found").begin_object();
    for (const UnknownNumber& one : scenario.unknowns.numbers) json.member(one.name, one.guess);
    json.end_object();
}

namespace livens::inline io_internal {

std::string resolved_run(const Builder& builder, const Scenario& scenario)
{
    const Section& time = *only_section(builder.run(), "time");
    const Vector3 gravity = builder.run().vector("gravity");
    const SolveOptions& options = scenario.options;
    JsonWriter json;
    json.begin_object().member("format", 1).member("title", scenario.title);
    json.member("gravity", std::span<const double>(gravity.a));
    if (const Parameters& parameters = builder.top().parameters(); !parameters.is_empty()) {
        json.key("parameters").begin_object();
        for (const Parameters::One& one : parameters.all()) json.member(one.name, one.amount.value);
        json.end_object();
    }
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
    json.member("breaks", time.text("breaks"));
    write_periodic(json, scenario.conditions);
    json.end_object();
    json.key("method").begin_object();
    write_method(json, scenario.method);
    write_options(json, options);
    json.end_object();
    json.key("start").begin_object().member("given", word_of(scenario.conditions.at_start));
    json.member("initial", word_of(options.initial)).end_object();
    json.key("end").begin_object().member("given", word_of(scenario.conditions.at_end)).end_object();
    write_components(json, scenario.conditions.components);
    write_found(json, scenario);
    return json.end_object().text();
}

namespace {

/// What is not stated follows from the accuracy.
void leave_open(Method& method, bool has_family, bool has_degree)
{
    auto* lobatto = std::get_if<Lobatto>(&method);
    // Degree 0 leaves the degree to the accuracy (theory.md, To an accuracy).
    if (!has_family && lobatto != nullptr)
        method = AutomaticFamily{has_degree ? lobatto->degree : 0};
    else if (lobatto != nullptr && !has_degree)
        lobatto->degree = 0;
    else if (auto* radau = std::get_if<Radau>(&method); radau != nullptr && !has_degree)
        radau->degree = 0;
}

/// Complaints about what the file leaves to its defaults point at what comes nearest.
void remember_defaults(Builder& builder)
{
    const Section* time = only_section(builder.run(), "time");
    const Section* start = only_section(builder.run(), "start");
    const Section* end = only_section(builder.run(), "end");
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
    const Section* time = only_section(builder.run(), "time");
    const Section* method = only_section(builder.run(), "method");
    const Section* start = only_section(builder.run(), "start");
    scenario.title = builder.top().text("title");
    scenario.method = read_method(method, builder.findings());
    const bool is_to_accuracy = time != nullptr && follows_accuracy(*time, scenario.method);
    const auto states = [&](const char* key) { return method != nullptr && method->has(key); };
    // The family is read before, since its knots decide whether elements follow from an accuracy.
    if (is_to_accuracy) leave_open(scenario.method, states("family"), states("degree"));
    scenario.options.growth = is_to_accuracy;
    if (method != nullptr) read_options(*method, scenario.options);
    if (start != nullptr) scenario.options.initial = start->pick<StartPolicy>("initial");
    if (time != nullptr) scenario.options.end_at_bends = time->text("breaks") != "ignore";
    read_boundary(builder, scenario.conditions);
    remember_defaults(builder);
    if (time != nullptr) read_time(builder, *time, method, scenario);
}

}   // namespace livens::inline io_internal
