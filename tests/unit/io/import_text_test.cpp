// SPDX-License-Identifier: BSD-3-Clause
// What is written of an imported file is read again, whatever its names hold.
#include "livens/io/import.h"

#include <gtest/gtest.h>

#include <string>

#include "livens/io/scenario.h"

namespace livens::import_text_test {

namespace {

std::string robot_with_mesh(const std::string& file)
{
    const std::string inertial =
        "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>";
    return "<robot name='r'><link name='base'/><link name='arm'>" + inertial +
           "<visual><geometry><mesh filename='" + file +
           "'/></geometry></visual></link><joint name='j' type='revolute'><parent link='base'/>"
           "<child link='arm'/><axis xyz='0 1 0'/><limit lower='-1' upper='1' effort='1' velocity='1'/>"
           "</joint></robot>";
}

TEST(ImportText, KeepsWhatFilesQuoteInComments)
{
    for (const std::string end : {"&#10;", "&#13;", "&#10;&#10;", "&#9;", "&#127;"}) {
        const std::string mesh = "package://a" + end + "gravity = [0, 0, 7]" + end + "b = 1/c.stl";
        const UrdfResult result = parse_urdf(robot_with_mesh(mesh), "odd\nx = 1.urdf");
        ASSERT_TRUE(result.scenario) << end;
        const ScenarioResult again = parse_scenario(result.toml, "again.toml");
        ASSERT_TRUE(again.scenario) << end << '\n' << result.toml;
        EXPECT_TRUE(again.scenario->model.gravity() == result.scenario->model.gravity()) << end;
        std::size_t n_quoted = 0;
        for (std::size_t at = 0; (at = result.toml.find("[0, 0, 7]", at)) != std::string::npos; ++at) {
            ++n_quoted;
            EXPECT_EQ(result.toml[result.toml.rfind('\n', at) + 1], '#') << result.toml;
        }
        EXPECT_GT(n_quoted, 0u) << "what is lost is told";
    }
}

}   // namespace

}   // namespace livens::import_text_test
