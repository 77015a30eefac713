// SPDX-License-Identifier: BSD-3-Clause
// From the text of a URDF to the tree of a scenario, in steps that stop at the first that finds errors: XML,
// tags and numbers, the tree of links, masses, tables.
#include "livens/io/import/urdf_scenario.h"

#include <set>

#include "livens/io/import/urdf_bodies.h"
#include "livens/io/import/urdf_joints.h"
#include "livens/io/import/urdf_meshes.h"
#include "livens/io/scenario/text/reading.h"
#include "livens/io/scenario/text/tree.h"

namespace livens::inline io_internal {

namespace {

constexpr double earth = -9.81;   // m/s^2, what simulators of robots take

class UrdfImport {
public:
    UrdfImport(const std::filesystem::path& file, const UrdfOptions& options, Findings& findings)
        : options_(options), findings_(findings), meshes_(file, options)
    {}

    /// All but tables. False after an error.
    bool read(std::string_view text);
    /// The tables, `[time]` last; meshes in these lines are left out.
    Node root(const std::set<int>& refused);
    const std::filesystem::path& folder() const { return meshes_.folder(); }
    Losses& losses() { return losses_; }

private:
    std::vector<TableMaker> bodies(const UrdfJoints& names, const std::set<int>& refused) const;
    std::vector<TableMaker> world_visuals(const std::set<int>& refused) const;

    const UrdfOptions& options_;
    Findings& findings_;
    Losses losses_, losses_before_;
    UrdfFile file_;
    UrdfTree tree_;
    std::vector<MassProperties> masses_;
    std::vector<std::vector<int>> links_;   // of each body
    UrdfMeshes meshes_;
};

bool UrdfImport::read(std::string_view text)
{
    const std::optional<XmlElement> root = parse_xml(text, findings_);
    if (!root) return false;
    file_ = read_urdf_file(*root, losses_, findings_);
    if (findings_.n_errors() > 0) return false;
    tree_ = place_links(file_, options_, losses_, findings_);
    if (findings_.n_errors() > 0) return false;
    masses_ = masses_of(file_, tree_, options_.inertias, losses_, findings_);
    if (findings_.n_errors() > 0) return false;
    links_.resize(tree_.frames.size());
    for (std::size_t i = 0; i < tree_.links.size(); ++i)
        if (tree_.links[i].body >= 0) links_[tree_.links[i].body].push_back(static_cast<int>(i));
    meshes_.find(file_, losses_);
    losses_before_ = losses_;
    return true;
}

std::vector<TableMaker> UrdfImport::bodies(const UrdfJoints& names, const std::set<int>& refused) const
{
    std::vector<TableMaker> all;
    for (std::size_t b = 0; b < masses_.size(); ++b) {
        const UrdfLink& link = file_.links[tree_.frames[b]];
        const PlacedLink& placed = tree_.links[tree_.frames[b]];
        const MassProperties& mass = masses_[b];
        const Matrix3& J = mass.inertia;
        TableMaker& table = all.emplace_back(link.place);
        table.text("name", names.body_name(static_cast<int>(b))).number("mass", mass.mass);
        if (!(mass.center_of_mass == Vector3{})) table.vector("center_of_mass", mass.center_of_mass);
        if (J(0, 1) == 0 && J(0, 2) == 0 && J(1, 2) == 0)
            table.vector("inertia", {J(0, 0), J(1, 1), J(2, 2)});
        else
            table.rows("inertia", {J.column(0), J.column(1), J.column(2)});
        place_in(table, placed.pose);
        if (!(placed.velocity == Vector3{})) table.vector("velocity", placed.velocity);
        if (!(placed.angular_velocity == Vector3{}))
            table.vector("angular_velocity", placed.angular_velocity);
        const Matrix3 back = transpose(placed.pose.axes);
        std::vector<TableMaker> visuals;
        for (const int i : links_[b]) {
            const Pose& pose = tree_.links[i].pose;
            const bool is_frame = i == tree_.frames[b];
            meshes_.draw(file_.links[i],
                         is_frame ? Pose{}
                                  : Pose{back * pose.axes, back * (pose.origin - placed.pose.origin)},
                         refused, visuals);
        }
        table.tables("visual", std::move(visuals));
    }
    return all;
}

std::vector<TableMaker> UrdfImport::world_visuals(const std::set<int>& refused) const
{
    std::vector<TableMaker> visuals;
    for (std::size_t i = 0; i < tree_.links.size(); ++i)
        if (tree_.links[i].body < 0) meshes_.draw(file_.links[i], tree_.links[i].pose, refused, visuals);
    return visuals;
}

Node UrdfImport::root(const std::set<int>& refused)
{
    // Each try tells its own losses, behind those of read().
    losses_ = losses_before_;
    UrdfJoints joints(file_, tree_, options_, losses_);
    std::vector<TableMaker> all_bodies = bodies(joints, refused);
    std::vector<TableMaker> all_points = joints.points(), all_joints = joints.joints();
    joints.add_loops(all_joints, findings_);
    TableMaker root(file_.place);
    root.whole("format", 1);
    if (!file_.name.empty()) root.text("title", file_.name);
    root.vector("gravity", {0, 0, earth});
    if (std::vector<TableMaker> visuals = world_visuals(refused); !visuals.empty()) {
        TableMaker world(file_.place);
        root.table("world", std::move(world.tables("visual", std::move(visuals))));
    }
    root.tables("body", std::move(all_bodies));
    root.tables("point", std::move(all_points));
    root.tables("joint", std::move(all_joints));
    if (!options_.loops.empty()) {   // the file's pose need not close them
        TableMaker start({});
        root.table("start", std::move(start.text("initial", "project")));
    }
    TableMaker time({});   // last
    root.table("time", std::move(time.number("end", options_.end)));
    return root.take();
}

/// What reading the tree as a scenario complains of. Meshes that cannot be read go to `refused`, and are no
/// error: true if there are some that were not there before.
bool is_refused_for_meshes(const std::vector<Diagnostic>& found, std::set<int>& refused, Losses& losses)
{
    bool is_new = false;
    for (const Diagnostic& d : found)
        if (d.severity == Severity::error && d.code.starts_with("mesh-") && refused.insert(d.line).second) {
            losses.add(losses::mesh_unreadable, {d.line, d.column, d.length}, {}, d.message);
            is_new = true;
        }
    return is_new;
}

void add_findings(const std::vector<Diagnostic>& from, Findings& findings)
{
    for (const Diagnostic& d : from) {
        const SourceLocation place{d.line, d.column, d.length};
        if (d.severity == Severity::error)
            findings.error(place, d.code, d.message, {d.note, d.help});
        else
            findings.warning(place, d.code, d.message, {d.note, d.help});
    }
}

/// Whether a mesh can be read shows when the scenario is. Each try leaves out those that were refused, and at
/// least one more than the one before, so that there are no more tries than meshes and one.
void import_into(ImportedTree& result, std::string_view text, const std::filesystem::path& file,
                 const UrdfOptions& options, bool with_time, Findings& findings)
{
    UrdfImport import(file, options, findings);
    if (!import.read(text)) return;
    result.folder = import.folder();
    std::set<int> refused;
    Losses unreadable;
    for (;;) {
        Node root = import.root(refused);
        if (findings.n_errors() > 0) return;
        ScenarioResult read = read_tree(root, {}, {result.folder});
        if (is_refused_for_meshes(read.diagnostics, refused, unreadable)) continue;
        add_findings(read.diagnostics, findings);
        if (!with_time) root.content->entries.pop_back();
        result.root = std::move(root);
        result.scenario = std::move(read.scenario);
        break;
    }
    import.losses().report(options.is_strict, findings);
    unreadable.report(options.is_strict, findings);
}

}   // namespace

ImportedTree import_urdf(std::string_view text, const std::filesystem::path& file, const UrdfOptions& options,
                         bool with_time)
{
    Findings findings;
    ImportedTree result;
    shield(findings, [&] {
        if (text.size() > max_scenario_bytes)
            findings.error({}, "resource-limit",
                           "the file has more than " + std::to_string(max_scenario_bytes) + " bytes");
        else
            import_into(result, text, file, options, with_time, findings);
    });
    if (findings.n_errors() > 0) {
        result.root.reset();
        result.scenario.reset();
    }
    result.diagnostics = findings.take(file.string());
    return result;
}

}   // namespace livens::inline io_internal
