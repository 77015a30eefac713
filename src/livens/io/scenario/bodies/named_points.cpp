// SPDX-License-Identifier: BSD-3-Clause
// [[point]]: a place of a body by its name, which may stand wherever a key takes the coordinates of a point:
// `at`, `point`, `points`. A name tells the body as well, so that `body` and `between` may be left out; where
// they are written they must agree.
#include "livens/io/scenario/bodies/named_points.h"

#include <utility>

namespace livens::inline io_internal {

namespace {

/// That nothing else that is looked up by its name beside points has this one.
bool check_point_name(const Builder& builder, const Section& point, const std::string& name)
{
    for (const std::string kind : {"body", "joint", "drive", "sensor"})
        for (const Section& other : builder.top().sections(kind)) {
            if (!other.has("name") || other.text("name") != name) continue;
            return point.error("name", "name-duplicate",
                               "a " + kind + " called '" + name + "' exists already",
                               {kind == "sensor" ? "a point tells what a sensor of it would, without one"
                                                 : "points are looked up by name as bodies, joints and "
                                                   "sensors are",
                                "rename one of them"});
        }
    return true;
}

/// A point that a name of a section stands for; null where it is unknown, which is told.
const NamedPoint* find_point(Builder& builder, Section& section, const std::string& name,
                             const SourceLocation& place)
{
    const int index = builder.model().find_point(name);
    if (index >= 0) return &builder.model().points()[static_cast<std::size_t>(index)];
    section.spoil();
    if (builder.is_excused(name)) return nullptr;
    // One that is stated, but wrong, has been told of.
    for (const Section& point : builder.top().sections("point"))
        if (point.has("name") && point.text("name") == name && builder.findings().n_errors() > 0)
            return nullptr;
    std::vector<std::string_view> known;
    for (const NamedPoint& point : builder.model().points()) known.push_back(point.name);
    const bool is_body = name == "world" || builder.bodies().count(name) > 0;
    builder.findings().error(
        place, "point-unknown", section.label() + " refers to '" + name + "', but there is no such point",
        {is_body ? "'" + name + "' is a body" : "",
         known.empty() ? "a table [[point]] gives a place a name; else give three numbers"
                       : suggest(name, known)});
    return nullptr;
}

/// In coordinates of its body as they are stated, along directors that may be skew.
Vector3 stated_position(const Builder& builder, const NamedPoint& point)
{
    const Matrix3& stretch = builder.stretch(point.body);
    return stretch == identity<3>() ? point.position : inverse(stretch) * point.position;
}

/// That a point is on the body that the section names.
bool check_body_of(Builder& builder, Section& section, const std::string& key, const NamedPoint& point,
                   const std::string& body, const SourceLocation& place)
{
    if (builder.body_name(point.body) == body) return true;
    section.spoil();
    return builder.findings().error(place, "point-body",
                                    "the point '" + point.name + "' in '" + key + "' of " + section.label() +
                                        " is one of '" + builder.body_name(point.body) + "', not of '" +
                                        body + "'",
                                    {"", "take a point of '" + body + "', or give its coordinates"});
}

bool has_names(const Value* v) { return v != nullptr && v->numbers.empty(); }

/// `points`, and `between`.
void tell_two(Builder& builder, Section& section)
{
    const Value* v = section.find("points");
    if (!has_names(v)) return;
    const std::vector<std::string> names = v->texts;
    const std::vector<Node>& nodes = v->node->items();
    std::vector<std::string> bodies;
    std::vector<double> numbers;
    for (std::size_t i = 0; i < 2; ++i) {
        const NamedPoint* point = find_point(builder, section, names[i], nodes[i].place);
        if (point == nullptr) return;
        bodies.push_back(builder.body_name(point->body));
        const Vector3 p = stated_position(builder, *point);
        numbers.insert(numbers.end(), p.a, p.a + 3);
        const Value* between = section.find("between");
        if (between != nullptr &&
            !check_body_of(builder, section, "points", *point, between->texts[i], nodes[i].place))
            return;
    }
    section.tell("points", numbers);
    if (!section.has("between") && !section.has("joint") && section.takes("between"))
        section.imply("between", bodies, *section.find("points"));
}

/// `point` of a section or of a frame in it, on a body of that name; empty: of whatever body.
const NamedPoint* tell_one(Builder& builder, Section& section, const std::string& body)
{
    const Value* v = section.find("point");
    if (!has_names(v)) return nullptr;
    const NamedPoint* point = find_point(builder, section, v->text, v->node->place);
    if (point == nullptr ||
        (!body.empty() && !check_body_of(builder, section, "point", *point, body, v->node->place)))
        return nullptr;
    const Vector3 p = stated_position(builder, *point);
    section.tell("point", {p[0], p[1], p[2]});
    return point;
}

void tell_point(Builder& builder, Section& section)
{
    const Value *between = section.find("between"), *body = section.find("body");
    const bool tells_body = section.takes("body") && section.key_of("body")->told_by == "point";
    std::string on;
    if (tells_body)
        on = body == nullptr ? "" : body->text;
    else if (section.takes("between"))
        on = between == nullptr ? "" : between->texts[1];   // what slides in a slot
    else
        on = "world";   // what attracts
    const NamedPoint* point = tell_one(builder, section, on);
    if (point != nullptr && tells_body && body == nullptr && !section.has("body"))
        section.imply("body", {builder.body_name(point->body)}, *section.find("point"));
}

void tell_frames(Builder& builder, Section& section)
{
    const Value* between = section.find("between");
    const std::span<Section> frames = section.sections("frames");
    for (std::size_t i = 0; i < frames.size() && i < 2; ++i) {
        tell_one(builder, frames[i], between == nullptr ? "" : between->texts[i]);
        if (!frames[i].is_valid()) section.spoil();
    }
}

void tell_rope(Builder& builder, Section& section)
{
    for (Section& at : section.sections("over")) {
        tell_point(builder, at);
        if (!at.is_valid()) section.spoil();
    }
}

/// `at`: where the point is when bodies are as they are stated.
void tell_place(Builder& builder, Section& section)
{
    const Value* v = section.find("at");
    if (!has_names(v)) return;
    const NamedPoint* point = find_point(builder, section, v->text, v->node->place);
    if (point == nullptr) return;
    const Vector3 place = builder.start_configuration(point->body) * livens::point(point->position);
    section.tell("at", {place[0], place[1], place[2]});
}

}   // namespace

Table point_table()
{
    return {
        "[[point]]",
        "A named point of a body or of the world. The name stands wherever a joint, drive, load or sensor "
        "takes the coordinates of a point: `at = \"tip\"`, `point = \"tip\"`, `points = [\"hook\", "
        "\"tip\"]`. It implies the body, so that `body` and `between` are not needed. The motion of a point "
        "is known without a sensor, to `livens sample --sensor`, `livens peaks` and Python, and expressions "
        "use it: `tip.x`.",
        {Key{"name", types::text, "Name of the point; no body, joint, drive or sensor may have it."}.needed(),
         Key{"body", types::text, "Name of the body, or `\"world\"`."}.needed(),
         Key{"position", types::vector3, "Position in body coordinates.", "m", "[0, 0, 0]"}}};
}

void read_points(Builder& builder)
{
    Findings& findings = builder.findings();
    std::unordered_set<std::string> taken;
    for (const NamedPoint& point : builder.model().points())
        taken.insert(point.name);   // of what is included
    for (const Section& section : std::as_const(builder).top().sections("point")) {
        const int before = findings.n_errors();
        const std::string name = section.text("name"), path = "point[" + name + "]";
        check_name(section);
        if (!name.empty() && check_point_name(builder, section, name))
            claim_name(section, "point", name, taken,
                       {"joints, drives, loads and sensors refer to points by name", "rename one of them"});
        builder.remember(path, section);
        const Value* named = section.find("body");
        if (named == nullptr) continue;
        const BodyReference body = builder.find_body(named->text, named->node->place, section);
        if (!body.is_usable || !section.is_valid() || findings.n_errors() > before) continue;
        builder.guard(path, [&] {
            builder.model().add_point(
                {name, body.index, builder.in_axes(body.index, section.vector("position"))});
        });
    }
}

void tell_points(Builder& builder)
{
    for (const std::string_view kind : {"joint", "drive", "load", "sensor"})
        for (Section& section : builder.top().sections(kind)) {
            if (section.kind() == any_kind) continue;
            tell_two(builder, section);
            if (section.takes("point")) tell_point(builder, section);
            tell_frames(builder, section);
            tell_rope(builder, section);
            tell_place(builder, section);
        }
}

}   // namespace livens::inline io_internal
