// SPDX-License-Identifier: BSD-3-Clause
// A scenario and what it includes: each file is read in its own coordinates, by its own names; what becomes
// of it is displaced and renamed, as Model::add() does it, and joins what the file around it has.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "livens/io/scenario/builder.h"
#include "livens/io/scenario/included.h"
#include "livens/io/scenario/text/document.h"
#include "livens/io/scenario/text/parameters.h"
#include "livens/multibody/relocation.h"

namespace livens::inline io_internal {

/// What all files of a scenario share.
struct AssemblySources {
    AssemblySources(const MeshSource& files, Findings& of)
        : source(files), meshes(files), texts(files), findings(of)
    {}

    MeshSource source;
    MeshStore meshes;
    IncludedTexts texts;
    Findings& findings;
    std::vector<std::string> open{};       ///< files that are being included, one in the other
    std::map<std::string, int> places{};   ///< of files, as findings have them
    int n_included = 0;
};

struct StatedStart;

/// What a section includes: read as a tree and a table.
struct OpenedPart {
    const Node* inside = nullptr;   ///< of the tree of the file around
    std::optional<Node> root{};     ///< or else a file's
    std::string label{}, folder{}, file{};
    std::vector<Override> overrides{};   ///< of its parameters
};

class Assembly {
public:
    /// The scenario itself; `file`: its own name, if it has one.
    Assembly(const Node& root, const std::string& file, const std::vector<Override>& overrides,
             AssemblySources& sources);
    Assembly(const Assembly&) = delete;
    Assembly& operator=(const Assembly&) = delete;

    Builder& builder() { return builder_; }
    const Section& top() const { return top_; }
    /// False: its copies could not be made, which was told.
    bool is_readable() const { return !expanded_ || !expanded_->entries().empty(); }
    void warn_of_unused_parameters() const;
    /// Everything of the model, in the order of references: joints name bodies, the start moves them along
    /// joints, drives begin where the joints stand then, and loads read sensors, except for sensors that read
    /// loads. Reports all it finds.
    void read_model();
    /// Whether a velocity at the start is stated anywhere.
    bool states_velocity() const;
    /// [body.end] of all bodies.
    void read_ends(bool is_given, State& end);
    /// Makes all places known to the outermost builder, for what is found of the whole.
    void remember_places();

private:
    Assembly(OpenedPart opened, const Section& include, Assembly& around);

    void open_all();
    std::unique_ptr<Assembly> open(const Section& include);
    std::optional<OpenedPart> open_file(const Section& include);
    std::vector<Override> overrides_of(const Section& include);
    void check_part();

    // Each goes through what is included first.
    void read_all_bodies(bool with_surfaces);
    void set_length(double length);
    void read_all_points();
    void read_all_joints();
    StatedStart all_stated();
    void settle();
    void read_all_drives();
    void read_all_sensors(bool of_loads);
    void read_all_controllers();
    void read_all_loads();
    void read_all_events(bool is_run);

    void complete_looks();
    bool check_count(std::size_t n, const std::string& what) const;
    void take_bodies(Assembly& part);
    template <class Read, class Take>
    void each_part(const Read& read, const Take& take);
    void refuse(Assembly& part, const InputError& error);

    AssemblySources& sources_;
    std::optional<Node> root_;    // of what is included
    std::string folder_, file_;   // from the scenario's folder on: "parts/", "parts/leg.toml"
    Parameters parameters_;
    std::optional<Node> expanded_;   // with copies, if there are some
    Section top_;
    Builder builder_;
    const Section* include_ = nullptr;   // that took it in, in
    const Assembly* around_ = nullptr;
    Relocation to_{};
    int first_joint_ = 0;
    bool is_refused_ = false;   // its names collide with others
    std::vector<std::unique_ptr<Assembly>> parts_;
};

}   // namespace livens::inline io_internal
