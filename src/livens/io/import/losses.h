// SPDX-License-Identifier: BSD-3-Clause
// What an import does not keep as it is: each kind is told once, with how often and where first.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "livens/io/scenario/text/findings.h"

namespace livens::inline io_internal {

/// What is said before the count: "limits are not kept: 6 joints ('elbow', ..)". `@` stands for a word of the
/// file.
struct LossKind {
    std::string_view code;   ///< import-lost, import-mended or import-merged
    std::string_view one, many;
    std::string_view message;
    std::string_view help = "";
    bool changes_motion = false;   ///< a strict import refuses it
    bool names_all = false;        ///< not the first few alone
};

namespace losses {

// Lost.
inline constexpr LossKind limits{
    "import-lost", "joint", "joints", "joint limits are not kept", "limits = stop keeps them as springs",
    true};
inline constexpr LossKind limits_order{
    "import-lost", "joint", "joints", "limits are not kept whose lower is not below the upper", "", true};
inline constexpr LossKind limits_at_start{"import-lost",
                                          "joint",
                                          "joints",
                                          "limits are not kept beyond which a joint begins",
                                          "state by 'at' where the joint begins",
                                          true,
                                          true};
inline constexpr LossKind bounds{"import-lost", "joint", "joints", "effort and velocity limits are not kept",
                                 "they apply to motors, which a URDF does not have"};
inline constexpr LossKind friction{"import-lost",
                                   "joint",
                                   "joints",
                                   "dry friction is not kept",
                                   "docs/howto/friction.md has it as an expression",
                                   true};
inline constexpr LossKind damping{
    "import-lost", "joint", "joints", "damping of planar and floating joints is not kept", "", true};
inline constexpr LossKind limits_of_others{
    "import-lost",
    "joint",
    "joints",
    "limits are not kept of joints that are neither revolute nor prismatic",
    "",
    true};
inline constexpr LossKind collision{
    "import-lost", "shape", "shapes", "collision geometry is not kept (bodies do not touch)", "", true};
inline constexpr LossKind extension{"import-lost", "place", "places", "<@> is unknown and not kept", "",
                                    true};
inline constexpr LossKind attribute{"import-lost", "place", "places", "@ is unknown and not kept", "", true};
inline constexpr LossKind no_motion{"import-lost", "place", "places",
                                    "<@> is not kept (it does not affect the motion)"};
inline constexpr LossKind gazebo{
    "import-lost", "place", "places", "<gazebo> is not kept (it may set friction, damping or stiffness)", "",
    true};
inline constexpr LossKind texture{"import-lost", "material", "materials", "textures are not drawn"};
inline constexpr LossKind color{"import-lost", "material", "materials",
                                "colours outside 0 to 1 are not drawn"};
inline constexpr LossKind shape_size{"import-lost", "shape", "shapes", "shapes of size 0 are not drawn"};
inline constexpr LossKind mesh_missing{"import-lost", "mesh", "meshes",
                                       "mesh files that do not exist are not drawn"};
inline constexpr LossKind mesh_package{"import-lost", "mesh", "meshes",
                                       "meshes of package '@' are not drawn (its folder is not known)",
                                       "give the folder of package '@'"};
inline constexpr LossKind mesh_format{"import-lost", "mesh", "meshes", "@ meshes are not drawn",
                                      "STL, OBJ, PLY, DAE and MSH are drawn: convert them"};
inline constexpr LossKind mesh_outside{"import-lost", "mesh", "meshes",
                                       "meshes outside the given folders are not drawn",
                                       "give their folder as a package"};
inline constexpr LossKind mesh_unreadable{"import-lost", "mesh", "meshes", "not drawn: @"};
inline constexpr LossKind mesh_scale{"import-lost", "mesh", "meshes",
                                     "meshes with an uneven or negative scale are not drawn"};

// Kept as part of something else.
inline constexpr LossKind merged{
    "import-merged", "link", "links",
    "merged into the body of the parent link (fixed joints), and kept as points, without axes"};
inline constexpr LossKind grounded{
    "import-merged", "link", "links",
    "fixed to the world (their mass does not matter), and kept as points, without axes"};
inline constexpr LossKind held{"import-merged", "joint", "joints",
                               "fixed, because they mimic a joint that does not move"};
inline constexpr LossKind free_joint{"import-merged", "joint", "joints",
                                     "floating joints are not needed (the body is free)"};
inline constexpr LossKind renamed{
    "import-merged", "joint", "joints", "renamed with ' joint', because a link has the same name", "",
    false,           true};

// Mended.
inline constexpr LossKind massless{
    "import-mended", "link", "links", "massless, and given 1e-9 of the smallest mass", "", false, true};
inline constexpr LossKind inertia{
    "import-mended",
    "link",
    "links",
    "inertia is not physically possible and was changed to the nearest possible one",
    "inertias = strict makes this an error",
    true,
    true};
inline constexpr LossKind products{
    "import-mended",          "link", "links", "products of inertia that are not stated are taken as 0",
    "state ixy, ixz and iyz", true};
inline constexpr LossKind axis{"import-mended", "joint", "joints", "axis was normalised to length 1"};
inline constexpr LossKind multiplier{
    "import-mended",
    "joint",
    "joints",
    "multiplier of mimic was changed to the nearest ratio of whole numbers up to 10000",
    "",
    true,
    true};

}   // namespace losses

class Losses {
public:
    /// To what it happened (may be empty), and the word of the file that the message wants.
    void add(const LossKind& kind, const SourceLocation& place, std::string name = {}, std::string word = {});

    /// All of them, as warnings; if strict, those that change the motion as errors.
    void report(bool is_strict, Findings& findings) const;

private:
    struct Loss {
        const LossKind* kind;
        std::string word;
        SourceLocation first;
        std::vector<std::string> names;
        int count = 0;
    };
    std::vector<Loss> all_;
};

}   // namespace livens::inline io_internal
