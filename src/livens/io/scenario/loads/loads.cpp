// SPDX-License-Identifier: BSD-3-Clause
// [[load]]: names, bodies, and what may be wrong with them.
// Names are claimed in the first pass, loads are made in the second: a load is known by its name in
// complaints, results and sensors.
#include <cmath>

#include "livens/dynamics/instant/reaction_laws.h"
#include "livens/io/scenario/joints/joints.h"
#include "livens/io/scenario/loads/load_makers.h"

namespace livens::inline io_internal {

namespace {

bool check_interval(const Builder& builder, const Section& load, Findings& findings)
{
    const Interval acts = read_interval(load);
    if (acts.until <= acts.from)
        return load.error("until", "window-order",
                          "'until' of " + load.label() + " must be later than 'from'");
    const Section* time = only_section(builder.run(), "time");
    if (time == nullptr || !time->is_valid()) return true;
    // Only a warning: the interval of a study may be shortened while its loads stay.
    if (acts.from >= time->number("end") || acts.until <= time->number("start"))
        findings.warning(load.place(load.has("from") ? "from" : "until"), "load-never-acts",
                         load.label() + " never acts: its time lies outside the motion's",
                         {"", "the motion lasts from 'start' to 'end' of [time]"});
    return true;
}

/// A load without name is called by its type and bodies, and numbered if there are more of the kind.
std::string claim_load_name(const Section& load, std::unordered_set<std::string>& taken)
{
    if (load.has("name")) {
        if (load.find("name") != nullptr)
            claim_name(load, "load", load.text("name"), taken,
                       {"a joint with 'damping' or 'stiffness' is a load of its name as well",
                        "rename one of them, or leave out the name"});
        return load.text("name");
    }
    const std::string base = default_name(load);
    std::string name = base;
    for (int i = 2; !taken.insert(name).second; ++i) name = base + " " + std::to_string(i);
    return name;
}

/// The bodies that it names by `between` or `body`; false unless they can be used.
bool find_bodies(Builder& builder, const Section& load, BodyReference& first, BodyReference& second)
{
    if (load.has("joint")) return load.find("joint") != nullptr;
    if (load.has("between")) return builder.find_pair(load, "load-self", first, second);
    const Value* named = load.find("body");
    if (named == nullptr) return false;
    if (named->text == "world")
        return load.error("body", "load-self", load.label() + " acts on the world, which does not move");
    first = builder.find_body(named->text, named->node->place, load);
    const Value* const other = load.takes("reaction") ? load.find("reaction") : nullptr;
    if (other == nullptr) return first.is_usable;
    if (other->text == named->text)
        return load.error("reaction", "load-self", load.label() + " acts from a body on itself");
    second = builder.find_body(other->text, other->node->place, load);
    return first.is_usable && second.is_usable;
}

void read_load(Builder& builder, const Section& load, const std::string& name, bool has_good_name)
{
    const std::string path = "load[" + name + "]";
    builder.remember(path, load);
    if (load.kind() == any_kind) return;
    bool is_good = load.is_valid() && has_good_name;
    const LoadKind& kind = load_kinds()[static_cast<std::size_t>(load.kind())];
    if (kind.check != nullptr) is_good = kind.check(load) && is_good;
    if (load.takes("from")) is_good = check_interval(builder, load, builder.findings()) && is_good;
    BodyReference first, second;
    std::optional<std::vector<BodyPoint>> over(std::in_place);
    if (load.has("over"))
        over = is_good ? read_over(builder, load) : std::nullopt;
    else if (!find_bodies(builder, load, first, second))
        return;
    if (!is_good || !over) return;
    builder.guard(path, [&] {
        Load made = kind.make({load, name, first.index, second.index, builder, *over});
        made.is_begun_by_event = !condition_of(load, "from").empty();
        made.is_ended_by_event = !condition_of(load, "until").empty();
        if (made.is_decided_by_events()) {
            if (has_number(load, "until")) made.until = load.number("until");
            builder.conditions().push_back({true, made.name, &load});
        }
        builder.model().add_load(std::move(made));
        warn_of_world_points(builder, load, {first.index, second.index});
    });
}

}   // namespace

Table load_table()
{
    return Table{
        "[[load]]",
        "Forces and torques on bodies. Gravity is not a load: set `gravity` at the top of the file.",
        {Key{"name", types::text, "Name, for messages, sensors and results. Default: type and bodies."},
         Key{"type", types::choice, ""}.needed()}}
        .with_kinds("type", {load_kinds().begin(), load_kinds().end()});
}

namespace {

/// What is no number at the start would end the motion before it begins. Those that wait for the whole are
/// asked where it is there.
void check_start(Builder& builder, bool of_whole = false)
{
    const Section *start = only_section(builder.run(), "start"), *time = only_section(builder.run(), "time");
    if (start != nullptr && start->text("initial") == "project") return;   // from another place
    const Model& model = builder.model();
    const State state = model.start();
    for (const Load& load : model.loads()) {
        if ((load.by_reactions != nullptr) != of_whole) continue;
        const Instant at{time == nullptr ? 0 : time->number("start"), Side::right};
        LoadForces F(load.n_acted);
        // The right side of the instant: a load that begins at the start acts from there on.
        load.forces(load_arguments(load, at, state.X, state.V), F);
        double sum = 0;
        for (const Matrix34& of_body : F)
            for (const double f : of_body.a) sum += std::abs(f);
        const std::string path = "load[" + load.name + "]";
        if (!std::isfinite(sum))
            builder.guard(path, [&] {
                throw InputError(
                    {"load-not-finite", path, not_finite(load) + " at the start", "", "", "", ""});
            });
    }
}

}   // namespace

void read_loads(Builder& builder)
{
    const std::span<const Section> sections = builder.top().sections("load");
    // Known names come first, so that a default does not take one of them.
    const std::vector<std::string> of_joints = names_of_joint_loads(builder);
    std::unordered_set<std::string> taken(of_joints.begin(), of_joints.end());
    for (const Load& load : builder.model().loads()) taken.insert(load.name);   // of what is included
    std::vector<std::string> names(sections.size());
    std::vector<bool> is_good(sections.size());
    for (const bool given : {true, false})
        for (std::size_t i = 0; i < sections.size(); ++i) {
            if (sections[i].has("name") != given) continue;
            const int before = builder.findings().n_errors();
            check_name(sections[i]);
            names[i] = claim_load_name(sections[i], taken);
            is_good[i] = builder.findings().n_errors() == before;
        }
    for (std::size_t i = 0; i < sections.size(); ++i) read_load(builder, sections[i], names[i], is_good[i]);
    read_joint_loads(builder);
    check_start(builder);
}

void bind_loads(Builder& builder)
{
    const Model& model = builder.model();
    if (!reads_reactions(model) || builder.findings().n_errors() > 0) return;
    const Section* time = only_section(builder.run(), "time");
    const bool is_good = builder.guard("load", [&] {
        bind_reaction_laws(builder.model());
        check_reaction_laws(model, time == nullptr ? 0 : time->number("start"));
    });
    if (is_good) check_start(builder, true);
}

}   // namespace livens::inline io_internal
