#include <algorithm>
#include <limits>
#include <utility>

#include "livens/io/detail/builder.h"

namespace livens {

namespace {

struct Interval {
    double from = -std::numeric_limits<double>::infinity();
    double until = std::numeric_limits<double>::infinity();
};

Interval read_interval(const Section& load)
{
    Interval interval;
    if (load.has("from")) interval.from = load.number("from");
    if (load.has("until")) interval.until = load.number("until");
    return interval;
}

bool check_interval(const Builder& builder, const Section& load, Findings& findings)
{
    const Interval acts = read_interval(load);
    if (acts.until <= acts.from) {
        findings.error(load.place("until"), "window-order",
                       "'until' of " + load.label() + " must be later than 'from'");
        return false;
    }
    const std::span<const Section> time = builder.top().sections("time");
    if (time.empty() || !time.front().is_valid()) return true;
    const double start = time.front().number("start"), end = time.front().number("end");
    if (acts.from >= end || acts.until <= start)
        findings.warning(load.place(load.has("from") ? "from" : "until"), "load-never-acts",
                         load.label() + " never acts: its time lies outside the motion's",
                         {"", "the motion lasts from 'start' to 'end' of [time]"});
    return true;
}

bool check_value(const Section& load, Findings& findings)
{
    if (!at_most_one(load, {"value", "table"}, "load-value", findings)) return false;
    if (load.has("value") || load.has("table")) return true;
    findings.error(load.place(), "load-value", load.label() + " has neither 'value' nor 'table'",
                   {"", "give 'value' for a constant, 'table' for a function of time"});
    return false;
}

TimeVector read_table(const Section& table)
{
    const std::vector<double>& times = table.find("times")->numbers;
    const std::vector<double>& rows = table.find("values")->numbers;
    const auto make = table.text("interpolation") == "spline" ? spline_table : linear_table;
    TimeVector value;
    for (std::size_t c = 0; c < 3; ++c) {
        std::vector<double> column;
        for (std::size_t i = c; i < rows.size(); i += 3) column.push_back(rows[i]);
        value[c] = make(times, std::move(column));
    }
    return value;
}

TimeVector read_value(const Section& load)
{
    const Vector3 constant = load.vector("value");
    const std::span<const Section> tables = load.sections("table");
    const TimeVector value = tables.empty() ? TimeVector{constant[0], constant[1], constant[2]}
                                            : read_table(tables.front());
    const Interval acts = read_interval(load);
    return load.has("from") || load.has("until") ? window(value, acts.from, acts.until) : value;
}

Load build_on_body(const Section& section, const std::string& name, int body)
{
    const Frame frame = section.text("frame") == "body" ? Frame::body_fixed : Frame::inertial;
    if (section.text("type") == "torque") return torque(name, body, read_value(section), frame);
    return point_force(name, body, section.vector("point"), read_value(section), frame);
}

Load build_spring(const Section& section, const std::string& name, int first, int second)
{
    Vector3 point_first = section.row("points", 0), point_second = section.row("points", 1);
    if (first == world) {   // the law is symmetric; the core wants a body first
        std::swap(first, second);
        std::swap(point_first, point_second);
    }
    const SpringDamper law{section.number("stiffness"), section.number("damping"),
                           section.number("free_length")};
    return spring_damper(name, first, point_first, second, point_second, law);
}

/// A load without name is called by its type and bodies, and numbered if there are more of the kind.
std::string load_name(const Section& load, std::unordered_set<std::string>& taken, Findings& findings)
{
    if (load.has("name")) {
        const std::string name = load.text("name");
        if (load.find("name") != nullptr && !taken.insert(name).second)
            findings.error(load.place("name"), "name-duplicate",
                           "a load called '" + name + "' exists already",
                           {"", "rename one of them, or leave out the name"});
        return name;
    }
    std::string base = load.text("type");
    if (const Value* between = load.find("between"))
        base += " " + between->texts[0] + "-" + between->texts[1];
    else base += " on " + load.text("body");
    std::string name = base;
    for (int i = 2; !taken.insert(name).second; ++i) name = base + " " + std::to_string(i);
    return name;
}

void read_load(Builder& builder, const Section& section, const std::string& name, bool is_good)
{
    Findings& findings = builder.findings();
    const std::string path = "load[" + name + "]";
    builder.remember(path, section);
    if (section.find("type") == nullptr) return;
    if (section.text("type") == "spring") {
        BodyReference first, second;
        if (!builder.find_pair(section, first, second) || !is_good || !section.is_valid()) return;
        builder.guard(
            path, [&] { builder.model().add_load(build_spring(section, name, first.index, second.index)); });
        return;
    }
    is_good = check_value(section, findings) && is_good;
    is_good = check_interval(builder, section, findings) && is_good;
    const Value* named = section.find("body");
    if (named == nullptr) return;
    const BodyReference body = builder.find_body(named->text, named->node->place, section);
    if (named->text == "world") {
        findings.error(named->node->place, "load-self",
                       section.label() + " acts on the world, which does not move");
        return;
    }
    if (!body.is_usable || !is_good || !section.is_valid()) return;
    builder.guard(path, [&] { builder.model().add_load(build_on_body(section, name, body.index)); });
}

}   // namespace

void read_loads(Builder& builder)
{
    Findings& findings = builder.findings();
    const std::span<const Section> sections = builder.top().sections("load");
    // Known names come first, so that a default does not take one of them.
    std::unordered_set<std::string> taken;
    std::vector<std::string> names(sections.size());
    std::vector<bool> is_good(sections.size());
    for (const bool given : {true, false})
        for (std::size_t i = 0; i < sections.size(); ++i) {
            if (sections[i].has("name") != given) continue;
            const int before = findings.n_errors();
            check_name(sections[i], findings);
            names[i] = load_name(sections[i], taken, findings);
            is_good[i] = findings.n_errors() == before;
        }
    for (std::size_t i = 0; i < sections.size(); ++i) read_load(builder, sections[i], names[i], is_good[i]);
}

}   // namespace livens
