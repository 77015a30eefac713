// SPDX-License-Identifier: BSD-3-Clause
// Joints of a URDF as tables of a scenario: those that move, what couples them, and loops that the caller
// states.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "livens/io/import/table_maker.h"
#include "livens/io/import/urdf_tree.h"

namespace livens::inline io_internal {

class UrdfJoints {
public:
    UrdfJoints(const UrdfFile& file, const UrdfTree& tree, const UrdfOptions& options, Losses& losses);

    /// What a body is called; -1: the world.
    const std::string& body_name(int body) const { return body_names_[body + 1]; }

    /// Links that are part of a body or of the world, by their names: places, for points have no axes.
    std::vector<TableMaker> points() const;
    /// All joints, and couplings of those that follow others.
    std::vector<TableMaker> joints();
    void add_loops(std::vector<TableMaker>& joints, Findings& findings);

private:
    TableMaker joint(const PlacedJoint& placed);
    void add_loads(TableMaker& table, const PlacedJoint& placed);
    void add_limits(TableMaker& table, const UrdfLimit& limit, const std::string& name, double coordinate);
    void tell_lost(const UrdfJoint& joint);
    TableMaker coupling(const UrdfJoint& joint);
    std::string unused(std::string name);
    Pose in_body(const PlacedLink& link) const;
    const PlacedLink* find_link(const std::string& name, Findings& findings) const;

    const UrdfFile& file_;
    const UrdfTree& tree_;
    const UrdfOptions& options_;
    Losses& losses_;
    std::vector<std::string> body_names_;   ///< the world first
    std::set<std::string> taken_;
    std::vector<std::string> point_names_;       ///< of links; empty where one is no point
    std::map<std::string, std::string> names_;   ///< of joints, by those in the file
};

/// `position` and `directors` of a body or visual, where they are not those of what it stands in.
void place_in(TableMaker& table, const Pose& pose);

}   // namespace livens::inline io_internal
