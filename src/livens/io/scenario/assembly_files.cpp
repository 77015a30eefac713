// SPDX-License-Identifier: BSD-3-Clause
// Opening what a scenario includes: paths, rings, limits, and what a part may not say of the whole.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/io/scenario/assembly.h"
#include "livens/io/scenario/bodies/bodies.h"
#include "livens/io/scenario/schema/repeat.h"

namespace livens::inline io_internal {

namespace {

constexpr double orthonormal_slack = 1e-10;   // |D^T D - I|, as of bodies

/// Directors that check_rotation() has let pass are made orthonormal: what they lack would skew all bodies.
Relocation relocation_of(const Section& include)
{
    return {include.text("prefix"),
            {include.vector("position"), project_directors(read_orientation(include))}};
}

/// Rotations alone: what is included does not stretch.
bool check_rotation(const Section& include)
{
    if (!check_orientation(include)) return false;
    if (include.find("directors") == nullptr) return true;
    const Matrix3 D = include.columns("directors");
    return (norm(transpose(D) * D - identity<3>()) <= orthonormal_slack && determinant(D) > 0) ||
           include.error("directors", "joint-frames",
                         "the axes of " + include.label() +
                             " are not a right-handed set of perpendicular unit vectors");
}

/// With the tables of its repeats; empty: it has none; without any table after an error.
std::optional<Node> with_copies(const Node& root, const Parameters& parameters, Findings& findings)
{
    if (root.find("repeat") == nullptr) return std::nullopt;
    std::optional<Node> all = without_repeats(root, parameters, findings);
    if (all) return all;
    Node nothing;
    nothing.place = root.place;
    nothing.content = std::make_unique<NodeContent>();
    return nothing;
}

std::string plain_path(const std::string& path)
{
    return std::filesystem::path(path).lexically_normal().generic_string();
}

}   // namespace

Table include_table()
{
    Table table{
        "[[include]]",
        "Another file as a part of this model: its bodies, points, joints, drives, loads and sensors, with a "
        "prefix before their names, displaced and rotated as a whole. Names in that file refer to its own "
        "parts, `world` is the world. Whatever the file states in the world is displaced with it: points and "
        "axes, forces in world axes, prescribed paths, and the axes of its sensors. The file may be a "
        "complete scenario: its `title`, `[time]`, `[method]`, `[start]` and `[end]` are not used; its "
        "gravity equals that of this file "
        "or is "
        "not stated.",
        {Key{"file", types::text,
             "Path of the file, relative to the folder of this file and inside of it. Excludes `model`."},
         Key{"model", types::model, "Content of such a file as a table. Excludes `file`."},
         Key{"prefix", types::text,
             "Prefix of all names: with `\"left.\"`, `knee` becomes `left.knee`. Default: none."},
         Key{"parameters", types::named_numbers,
             "Values for `[parameters]` of the included file: numbers, or expressions of parameters of this "
             "file, as in `{ L = \"2*reach\" }`."},
         Key{"position", types::vector3, "Position of the file's origin.", "m", "[0, 0, 0]"}}};
    for (const Key& key : orientation_keys()) table.keys.push_back(key);
    return table;
}

/// Members are made one from the other: parameters, copies that are computed with them, the section of all.
/// Where copies failed nothing is left to be read, and the part's table is taken, which needs no key.
Assembly::Assembly(const Node& root, const std::string& file, const std::vector<Override>& overrides,
                   AssemblySources& sources)
    : sources_(sources), file_(file), parameters_(root.find("parameters"), overrides, sources.findings),
      expanded_(with_copies(root, parameters_, sources.findings)),
      top_(expanded_ ? *expanded_ : root, is_readable() ? root_table() : part_table(), "the scenario",
           sources.findings, parameters_),
      builder_(top_, top_, sources.meshes, sources.findings)
{
    if (!file_.empty()) sources_.open.push_back(file_);
    open_all();
}

Assembly::Assembly(OpenedPart opened, const Section& include, Assembly& around)
    : sources_(around.sources_), root_(std::move(opened.root)), folder_(std::move(opened.folder)),
      file_(std::move(opened.file)),
      parameters_((root_ ? *root_ : *opened.inside).find("parameters"), opened.overrides, sources_.findings),
      expanded_(with_copies(root_ ? *root_ : *opened.inside, parameters_, sources_.findings)),
      top_(expanded_ ? *expanded_
           : root_   ? *root_
                     : *opened.inside,
           part_table(), opened.label, sources_.findings, parameters_),
      builder_(top_, around.builder_.run(), sources_.meshes, sources_.findings), include_(&include),
      around_(&around), to_(relocation_of(include))
{
    check_part();
    if (!file_.empty()) sources_.open.push_back(file_);
    open_all();
    if (!file_.empty()) sources_.open.pop_back();
}

/// What an include says of the parameters of its file, computed from those of this one.
std::vector<Override> Assembly::overrides_of(const Section& include)
{
    std::vector<Override> all;
    const Value* given = include.find("parameters");
    if (given == nullptr) return all;
    Findings& findings = sources_.findings;
    for (const Entry& entry : given->node->entries()) {
        const Node& value = entry.value;
        const std::string named = "the parameter '" + entry.key + "' of " + include.label();
        Override one{.name = entry.key, .text = {}, .amount = {}, .place = value.place, .said_by = {}};
        if (value.kind == Node::Kind::integer || value.kind == Node::Kind::number) {
            one.amount.value = value.number;
            if (!std::isfinite(value.number)) {
                findings.error(value.place, "not-finite", named + " must be finite");
                continue;
            }
        } else if (value.kind == Node::Kind::text) {
            const Computed found = compute(value.text(), parameters_);
            if (!found.code.empty()) {
                if (!found.error.empty())
                    findings.error(value.place, found.code,
                                   named + " cannot be \"" + value.text() + "\": " + found.error,
                                   {"", found.help});
                continue;
            }
            one.amount = found.amount;
        } else {
            findings.error(value.place, "wrong-type",
                           named + " must be a number or a string, not " + std::string(describe(value.kind)));
            continue;
        }
        all.push_back(std::move(one));
    }
    return all;
}

void Assembly::warn_of_unused_parameters() const
{
    parameters_.warn_of_unused(sources_.findings);
    for (const std::unique_ptr<Assembly>& part : parts_) part->warn_of_unused_parameters();
}

/// What a part says that is the whole's to say.
void Assembly::check_part()
{
    for (const std::string_view key : {"start", "end"})
        if (top_.has(key))
            sources_.findings.warning(
                top_.place(key), "include-ignored",
                "[" + std::string(key) + "] of " + top_.label() + " does not count",
                {"what is known at the ends of time says the file that includes it", ""});
    const Value* gravity = top_.find("gravity");
    const Vector3 here = builder_.run().vector("gravity");
    if (gravity == nullptr || top_.vector("gravity") == here) return;
    top_.error("gravity", "gravity-differs",
               "'gravity' of " + top_.label() + " is not that of the scenario, [" + to_text(here[0]) + ", " +
                   to_text(here[1]) + ", " + to_text(here[2]) + "] m/s^2",
               {"gravity is the world's: it does not turn with what is included",
                "write the same in both, or leave it out here"});
}

/// Names with the prefix of a faulty include may be meant for what it would have brought: they are excused.
void Assembly::open_all()
{
    for (const Section& include : std::as_const(top_).sections("include")) {
        const int before = sources_.findings.n_errors();
        if (std::unique_ptr<Assembly> part = open(include)) parts_.push_back(std::move(part));
        if (sources_.findings.n_errors() > before) builder_.excuse(include.text("prefix"));
    }
}

/// Null after an error.
/// Number and depth are bounded before anything is read: files that include others twice, level by level,
/// make no ring, and yet would double at each level.
std::unique_ptr<Assembly> Assembly::open(const Section& include)
{
    if (!include.is_valid() || !check_rotation(include)) return nullptr;
    if (!include.at_most_one({"file", "model"}, "include-source")) return nullptr;
    const auto refuse_limit = [&](const std::string& why) {
        include.error("", "include-limit", why, {"", ""});
        return nullptr;
    };
    if (++sources_.n_included > max_includes)
        return refuse_limit("more than " + std::to_string(max_includes) + " files are included");
    std::size_t depth = 0;
    for (const Assembly* at = this; at != nullptr && at->include_ != nullptr; ++depth) at = at->around_;
    if (depth >= max_include_depth)
        return refuse_limit("files include each other more than " + std::to_string(max_include_depth) +
                            " deep");
    if (const Value* model = include.find("model")) {
        OpenedPart inside{model->node, {}, include.label(), folder_, "", overrides_of(include)};
        return std::unique_ptr<Assembly>(new Assembly(std::move(inside), include, *this));
    }
    if (!include.has("file")) {
        include.error("", "include-source", include.label() + " has no 'file'",
                      {"", "give the path of a scenario file, from the folder of this one on"});
        return nullptr;
    }
    std::optional<OpenedPart> opened = open_file(include);
    return opened ? std::unique_ptr<Assembly>(new Assembly(std::move(*opened), include, *this)) : nullptr;
}

/// Empty after an error.
/// Scanner and parser know lines and columns alone: what they find is gathered apart, and adopted with the
/// number of the file, which all places of the tree get as well.
std::optional<OpenedPart> Assembly::open_file(const Section& include)
{
    Findings& findings = sources_.findings;
    const std::string own = include.text("file");
    try {
        // What climbs is refused before it is joined with the folder.
        if (own.empty() || std::filesystem::path(own).is_absolute())
            find_file(sources_.source, own, "include");
        for (const std::filesystem::path& step : std::filesystem::path(own))
            if (step == "..") find_file(sources_.source, own, "include");
        const std::string path = plain_path(folder_ + own);
        if (std::ranges::find(sources_.open, path) != sources_.open.end())
            throw InputError({"include-ring", "", "'" + path + "' includes itself",
                              sources_.open.back() == path ? "" : "by '" + sources_.open.back() + "'", "", "",
                              "leave one of these includes out"});
        const std::string& text = sources_.texts.find(path);
        const std::filesystem::path folder = sources_.source.folder.value_or("");
        const auto [at, is_new] = sources_.places.try_emplace(path, 0);
        if (is_new) at->second = findings.add_file((folder / path).generic_string(), text);
        const int file = at->second;
        Findings of_text;
        std::optional<Node> root;
        if (text.find_first_not_of(" \t\r\n") == std::string::npos)
            of_text.error({1, 1, 1}, "empty-file", "the file is empty", {"", ""});
        else if (scan(text, of_text))
            root = parse_toml(text, of_text);
        findings.adopt(of_text, file);
        if (!root) return {};
        place_in(*root, file);
        const std::string parent = std::filesystem::path(path).parent_path().generic_string();
        return OpenedPart{nullptr, std::move(root),      "'" + path + "'", parent.empty() ? "" : parent + "/",
                          path,    overrides_of(include)};
    } catch (const InputError& error) {
        const Complaint& c = error.complaint();
        include.error("file", c.code, c.message + (c.value.empty() ? "" : " (" + c.value + ")"),
                      {c.note, c.help});
        return {};
    }
}

}   // namespace livens::inline io_internal
