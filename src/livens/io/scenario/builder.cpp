// SPDX-License-Identifier: BSD-3-Clause
// What the readers of tables share: the model as it grows, names, and places in the file for complaints. The
// core complains with paths as `body[upper].mass`; here they become line and column, words of the file, and
// help in its spelling.
#include "livens/io/scenario/builder.h"

#include <algorithm>
#include <utility>

#include "livens/io/scenario/schema/other_keys.h"

namespace livens::inline io_internal {

namespace {

// Names become rows of characters in results, all as wide as the longest.
constexpr std::size_t longest_part_name = 200;

/// How files spell what the advice of a complaint speaks of.
struct Spelling {
    std::string_view code, concept_word, toml;
};
// All entries count that have the code and whose concept the help names: see help_in_toml().
constexpr Spelling spellings[] = {
    {"boundary-conditions", "the state at one end", R"(given = "state")"},
    {"boundary-method", "lobatto or mixed", R"(family = "lobatto" in [method])"},
    {"end-position", "projected", R"(initial = "project" in [start])"},
    {"end-velocity", "projected", R"(initial = "project" in [start])"},
    {"joint-branch", "coordinates of the start", "`coordinates` in [start]"},
    {"joint-contradiction", "coordinates of the start", "`coordinates` in [start]"},
    {"joint-time-mesh", "elements end there", R"(breaks = "from_loads" in [time])"},
    {"mixed-block", "all elements together", R"(leave `window` out)"},
    {"mixed-pairing", "equal multipliers", R"(multipliers = "equal")"},
    {"mixed-pairing", "natural start", R"(momentum = "natural")"},
    {"mixed-pairing", "projected", R"(interfaces = "project")"},
    {"mixed-pairing", "strong start", R"(momentum = "strong")"},
    {"start-position", "coordinates of the start", "`coordinates` in [start]"},
    {"start-position", "projected", R"(initial = "project" in [start])"},
    {"start-velocity", "projected", R"(initial = "project" in [start])"},
};

std::string with_bounds(const Complaint& complaint)
{
    std::string text = complaint.message;
    if (complaint.value.empty() && complaint.bound.empty()) return text;
    text += " (";
    if (!complaint.value.empty()) text += "given: " + complaint.value;
    if (!complaint.value.empty() && !complaint.bound.empty()) text += ", ";
    if (!complaint.bound.empty()) text += "allowed: " + complaint.bound;
    return text + ")";
}

/// Paths of the core that begin with a table of the file; others are relative to what is being read.
bool is_of_table(const std::string& path)
{
    for (const std::string_view table : {"method.", "time.", "start.", "end."})
        if (path.starts_with(table)) return true;
    return false;
}

/// `body[upper].mass` as people say it: 'mass' of body 'upper'; `method.knots`: 'knots' of [method].
std::string spoken(const std::string& path)
{
    if (is_of_table(path)) {
        const std::size_t dot = path.find('.');
        return "'" + path.substr(dot + 1) + "' of [" + path.substr(0, dot) + "]";
    }
    const std::size_t open = path.find('['), close = path.rfind(']');
    if (open == std::string::npos || close == std::string::npos || close < open) return path;
    const std::string name = path.substr(0, open) + " '" + path.substr(open + 1, close - open - 1) + "'";
    return close + 2 < path.size() ? "'" + path.substr(close + 2) + "' of " + name : name;
}

/// Names that other programs have for the frame that stands still.
bool means_world(std::string_view name)
{
    const std::string plain = without_case(name);
    for (const std::string_view word :
         {"ground", "world", "base", "fixed", "frame", "inertial", "inertialframe", "worldbody", "global",
          "origin", "earth", "environment", "static", "none", "null", "0", ""})
        if (plain == word) return true;
    return false;
}

}   // namespace

Builder::Builder(Section& top, const Section& run, MeshStore& meshes, Findings& findings)
    : top_(top), run_(run), findings_(findings), model_(run.vector("gravity")), meshes_(meshes)
{
    remember("", top);
    for (const std::string_view name : {"world", "time", "method", "start", "end"})
        for (const Section& section : std::as_const(top).sections(name)) remember(std::string(name), section);
}

/// `joint[knee].axis` of an included file is `joint[left knee].axis` here.
void Builder::remember(const Builder& included, const std::string& prefix)
{
    for (const auto& [path, place] : included.places_) {
        const std::size_t open = path.find('[');
        if (open == std::string::npos) continue;   // of the file itself
        places_.try_emplace(path.substr(0, open + 1) + prefix + path.substr(open + 1), place);
    }
}

bool Builder::is_excused(std::string_view name) const
{
    return std::ranges::any_of(excused_, [&](const std::string& prefix) { return name.starts_with(prefix); });
}

void Builder::remember(const std::string& path, const Section& section)
{
    // Complaints about a table as a whole point at its name, which says more than its header.
    places_[path] = section.has("name") ? section.place("name") : section.place();
    for (const Value& value : section.values()) {
        const std::string prefix = path.empty() ? "" : path + ".";
        places_[prefix + std::string(value.key->name)] = value.node->place;
    }
}

/// The core writes `body[upper].mass`, or `load.until` where it does not know the name. The longest part of
/// the path that is known counts.
SourceLocation Builder::find_place(std::string path, const std::string& context) const
{
    for (const std::string_view kind : {"body.", "joint.", "drive.", "load.", "point."})
        if (path.substr(0, kind.size()) == kind) path = context + path.substr(kind.size() - 1);
    while (!path.empty()) {
        const auto found = places_.find(path);
        if (found != places_.end()) return found->second;
        // A key that has its default stands nowhere in the file: the table in which it could stand is shown.
        const std::size_t dot = path.rfind('.');
        path.resize(dot == std::string::npos ? 0 : dot);
    }
    const auto found = places_.find(context);
    return found != places_.end() ? found->second : SourceLocation{};
}

InputError Builder::unknown_name(const std::string& kind, const std::string& name, const std::string& path,
                                 const std::vector<std::string_view>& known) const
{
    // A thing that was stated wrongly is not in the model, and has been told of. To say that it does not
    // exist would be a second message about one mistake.
    const auto is_it = [&](const Section& one) {
        return (one.has("name") ? one.text("name") : default_name(one)) == name;
    };
    const Section& top = top_;
    const bool is_told =
        is_excused(name) || (findings_.n_errors() > 0 && std::ranges::any_of(top.sections(kind), is_it));
    for (const char* other : {"body", "joint", "drive", "load", "sensor", "point"})
        if (!is_told && kind != other && std::ranges::any_of(top.sections(other), is_it))
            return InputError(
                {kind + "-unknown", path + "." + kind, "'" + name + "' is a " + other + ", not a " + kind, "",
                 "", "",
                 known.empty() ? "" : "known here: " + quoted_alternatives({known.begin(), known.end()})});
    return InputError({is_told ? "" : kind + "-unknown", path + "." + kind,
                       "there is no " + kind + " '" + name + "'", "", "", "", suggest(name, known)});
}

/// Where the path of the complaint has no name in brackets it is relative to `path`, which is the subject
/// then. Messages that quote a name say of what they are, and need no subject.
void Builder::report(const Complaint& complaint, const std::string& path)
{
    if (complaint.code.empty()) return;   // unknown_name()
    const bool is_whole = complaint.path.find('[') != std::string::npos || is_of_table(complaint.path);
    const std::string subject = spoken(is_whole ? complaint.path : path);
    const bool is_named = complaint.message.find('\'') != std::string::npos;
    findings_.error(find_place(complaint.path, path), complaint.code,
                    (is_named || subject.empty() ? "" : subject + ": ") + with_bounds(complaint),
                    {complaint.note, help_in_toml(complaint)});
}

std::string help_in_toml(const Complaint& complaint)
{
    std::string keys;
    for (const Spelling& s : spellings)
        if (s.code == complaint.code && complaint.help.find(s.concept_word) != std::string::npos)
            keys += (keys.empty() ? " (" : ", ") + std::string(s.toml);
    // The core speaks of concepts; the keys that spell them are added unless it has named some.
    const bool has_keys = complaint.help.find(" = \"") != std::string::npos;
    return complaint.help + (keys.empty() || has_keys ? "" : keys + ")");
}

BodyReference Builder::find_body(const std::string& name, const SourceLocation& place, const Section& section)
{
    if (name == "world") return {world, true};
    const auto found = bodies_.find(name);
    if (found != bodies_.end()) return found->second;
    if (is_excused(name)) return {};
    // Bodies under a wrong key are not known, which has been told of.
    const Section& top = top_;
    if (top.find("body") == nullptr && findings_.n_errors() > 0 && top.sections("body").empty()) return {};
    std::vector<std::string_view> known;
    for (const Section& body : top.sections("body"))
        if (const Value* v = body.find("name")) known.push_back(v->text);
    // Bodies of included files have no section here: the model has them, under their names with prefix.
    if (!top.sections("include").empty())
        for (const Body& body : model_.bodies())
            if (std::ranges::find(known, body.name) == known.end()) known.push_back(body.name);
    known.push_back("world");
    const bool is_point = model_.find_point(name) >= 0;
    findings_.error(place, "body-unknown",
                    section.label() + " refers to '" + name + "', but there is no such body",
                    {is_point ? "'" + name + "' is a point, which 'point' or 'points' takes" : "",
                     means_world(name) ? "the fixed frame is called \"world\"" : suggest(name, known)});
    return {};
}

bool Builder::find_pair(const Section& section, std::string_view self, BodyReference& first,
                        BodyReference& second)
{
    const Value* between = section.find("between");
    if (between == nullptr) return false;
    const std::vector<Node>& names = between->node->items();
    first = find_body(between->texts[0], names[0].place, section);
    second = find_body(between->texts[1], names[1].place, section);
    if (between->texts[0] != between->texts[1]) return first.is_usable && second.is_usable;
    // Of a name that is unknown find_body() has told.
    if (between->texts[0] == "world" || bodies_.count(between->texts[0]) > 0)
        findings_.error(names[1].place, self,
                        section.label() + " connects '" + between->texts[0] + "' with itself",
                        {"", "'between' names two different bodies, or one and \"world\""});
    return false;
}

void Builder::set_length(double length)
{
    // A single point mass at rest has no length; slacks relative to the model then are in metres.
    length_ = length > 0 ? length : 1;
}

const Matrix3& Builder::stretch(int body) const
{
    static constexpr Matrix3 none = identity<3>();
    return body == world ? none : model_.bodies()[body].stretch;
}

const Matrix34& Builder::start_configuration(int body) const
{
    return body == world ? world_configuration : model_.bodies()[body].X;
}

bool check_name(const Section& section)
{
    const Value* name = section.find("name");
    if (name == nullptr) return !section.has("name");
    const std::string& text = name->text;
    if (text.empty()) return section.error("name", "name-empty", "a name must not be empty");
    if (text == "world")
        return section.error("name", "name-reserved", "the name 'world' is reserved for the fixed world");
    if (text.size() > longest_part_name)
        return section.error("name", "name-invalid",
                             "a name has at most " + std::to_string(longest_part_name) + " bytes");
    const std::string culprit = first_invisible(text);
    return culprit.empty() ||
           section.error("name", "name-invalid", "a name must not contain " + culprit,
                         {"control characters and marks of writing direction deceive the eye and the "
                          "terminal",
                          "leave it out"});
}

std::string default_name(const Section& section)
{
    const std::string type = section.text("type");
    // Names of points, where they stand for bodies.
    if (const Value* two = section.find("points"); two != nullptr && !two->texts.empty())
        return type + " " + two->texts[0] + "-" + two->texts[1];
    if (section.is_implied("body")) return type + " on " + section.find("point")->text;
    for (const char* key : {"between", "joints"})
        if (const Value* two = section.find(key)) return type + " " + two->texts[0] + "-" + two->texts[1];
    if (const std::span<const Section> over = section.sections("over"); !over.empty()) {
        std::string name = type;
        for (const Section& at : over)
            name += (name == type ? " " : "-") +
                    (at.is_implied("body") ? at.find("point")->text : at.text("body"));
        return name;
    }
    if (const Value* terms = section.find("terms")) {
        std::string name = type;
        for (const Entry& term : terms->node->entries()) name += (name == type ? " " : "-") + term.key;
        return name;
    }
    for (const char* key : {"body", "joint"})
        if (section.has(key)) return type + " on " + section.text(key);
    return type;
}

bool claim_name(const Section& section, const std::string& kind, const std::string& name,
                std::unordered_set<std::string>& taken, const Advice& advice)
{
    return taken.insert(name).second ||
           section.error("name", "name-duplicate", "a " + kind + " called '" + name + "' exists already",
                         advice);
}

}   // namespace livens::inline io_internal
