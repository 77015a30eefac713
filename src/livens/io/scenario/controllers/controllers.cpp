// SPDX-License-Identifier: BSD-3-Clause
// A controller is read twice: its formulas at the start tell how large its states are, by which they are
// scaled (docs/theory.md, "States").
#include "livens/io/scenario/controllers/controllers.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/io/scenario/controllers/controller_reader.h"

namespace livens::inline io_internal {

namespace {

/// Of the time of the motion: a state of its size moves its body by the length of the model in this.
constexpr double share_of_time = 0.01;

StateScale scale_of(const Builder& builder)
{
    const Section* time = only_section(builder.run(), "time");
    const double duration = time == nullptr ? 1 : time->number("end") - time->number("start");
    double mass = 0;
    int n = 0;
    for (const Body& body : builder.model().bodies())
        if (body.is_matter()) mass += body.mass(0, 0), ++n;
    // States of their size have momenta like those of bodies.
    const double share = share_of_time * share_of_time;
    return {n > 0 ? share * mass / n : 1,
            builder.length() / (share_of_time * (duration > 0 && std::isfinite(duration) ? duration : 1))};
}

/// False after an error.
bool read_all(Builder& builder, const SizesOfStates& sizes, SizesOfStates* found)
{
    const StateScale scale = scale_of(builder);
    const int before = builder.findings().n_errors();
    std::vector<ControllerReader> all;
    for (const Section& section : builder.top().sections("controller")) {
        if (!section.is_valid()) continue;
        const std::string path = "controller[" + section.text("name") + "]";
        builder.guard(path, [&] {
            all.emplace_back(builder, section, sizes);
            all.back().hold(scale);
        });
    }
    if (builder.findings().n_errors() > before) return false;
    // Behind the states of all: formulas may read those of any controller.
    for (ControllerReader& one : all) builder.guard(one.path(), [&] { one.make(); });
    if (builder.findings().n_errors() > before) return false;
    if (found != nullptr)
        for (const ControllerReader& one : all) one.measure(*found);
    return true;
}

}   // namespace

Table controller_table()
{
    return {
        "[[controller]]",
        "States with rates of their own, `z' = f`, or values that are computed anew at fixed intervals: "
        "controllers, filters, motors, hydraulics. See [controllers](howto/controllers.md).",
        {Key{"name", types::text, "Name by which formulas and results refer to its states and outputs."}
             .needed(),
         Key{"inputs", types::named_texts,
             "Symbols for quantities of the motion or of other controllers, as for "
             "[loads](joints.md#expressions)."},
         Key{"states", types::named_texts,
             "Formula per state: its rate per second; with `every` its next value."},
         Key{"outputs", types::named_texts,
             "Formulas of inputs, states and earlier outputs, that other formulas read as "
             "`controller.output`. With `every` they hold their value between the samples."},
         Key{"start", types::factors, "Initial values of states. Default: 0."},
         Key{"size", types::factors,
             "Typical magnitude per state, to which its errors are relative. Default: estimated from the "
             "initial rates."},
         Key{"every", types::number,
             "Sampling period: inputs are read and states and outputs set at these intervals.", "s"},
         Key{"first", types::number, "Time of the first sample. Default: the start of the motion.", "s"}}};
}

void read_controllers(Builder& builder)
{
    std::unordered_set<std::string> taken;
    for (const Joint& joint : builder.model().joints()) taken.insert(joint.name);
    for (const Sensor& sensor : builder.model().sensors()) taken.insert(sensor.name);
    for (const ReadController& one : builder.controllers()) taken.insert(one.name);
    const int before = builder.findings().n_errors();
    for (const Section& section : builder.top().sections("controller")) {
        check_name(section);
        builder.remember("controller[" + section.text("name") + "]", section);
        if (const std::string name = section.text("name"); !name.empty())
            claim_name(section, "controller, sensor or joint", name, taken,
                       {"formulas refer to controllers as to joints and sensors", "give it another 'name'"});
        if (section.has("first") && !section.has("every"))
            section.error("first", "controller-every", section.label() + " is not sampled",
                          {"", "state 'every', or leave out 'first'"});
    }
    if (builder.findings().n_errors() > before || builder.top().sections("controller").empty()) return;
    // The first reading adds bodies and loads, which the second one would find a second time.
    const Model as_it_was = builder.model();
    const std::vector<ReadController> of_parts = builder.controllers();
    SizesOfStates sizes;
    if (!read_all(builder, {}, &sizes)) return;
    builder.model() = as_it_was;
    builder.controllers() = of_parts;
    read_all(builder, sizes, nullptr);
}

void add_controller_sensors(Builder& builder)
{
    for (const ReadController& one : builder.controllers()) {
        const std::vector<Sensor>& all = builder.model().sensors();
        if (std::ranges::find(all, one.name, &Sensor::name) != all.end()) continue;   // of a part
        Sensor sensor =
            load_sensor(one.name, one.load, builder.model().loads()[static_cast<std::size_t>(one.load)]);
        sensor.type = controller_type;
        builder.model().add_sensor(std::move(sensor));
    }
}

void take_controllers(const Builder& part, const Relocation& to, Builder& builder)
{
    for (ReadController one : part.controllers()) {
        one.name = to.name(one.name);
        one.load += to.first_load;
        for (ReadController::State& state : one.states) state.coordinate = relocated(state.coordinate, to);
        for (ReadController::Output& output : one.outputs) {
            for (LawCoordinate& q : output.inputs.coordinates) q.coordinate = relocated(q.coordinate, to);
            for (ReactionInput& r : output.inputs.reactions) r = relocated(r, to);
        }
        builder.controllers().push_back(std::move(one));
    }
}

}   // namespace livens::inline io_internal
