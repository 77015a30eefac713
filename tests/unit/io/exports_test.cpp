// SPDX-License-Identifier: BSD-3-Clause
// Exports as far as a run need not be solved for them; tests/system/export_test.py has the rest.
#include "livens/io/exports.h"

#include <algorithm>
#include <cstdio>

#include "livens/io/exports/formats.h"
#include "livens/spacetime/solve.h"
#include "unit/io/sample_run.h"

namespace livens::exports_test {
namespace {

/// A wheel of a bolt, 2 turns a second for a minute.
TEST(Videos, SayWhereBodiesTurnBackBetweenFrames)
{
    const Scenario scenario =
        parse_scenario(
            "format = 1\n[[body]]\nname = \"bolt\"\nshape = { sphere = 0.1 }\nmass = 1\n"
            "position = [1, 0, 0]\n[[joint]]\nname = \"hub\"\ntype = \"revolute\"\n"
            "between = [\"world\", \"bolt\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\nrate = \"120 rpm\"\n"
            "[time]\nend = 60\nelements = 600\n[method]\ndegree = 4\nestimate = \"none\"\n",
            "wheel.toml")
            .scenario.value();
    const RunFile run =
        make_run(scenario.model, solve(scenario.model, {scenario.conditions}, scenario.time, scenario.method),
                 scenario.method);
    ExportInput input{"", scenario, run};
    const auto doubt = [&](const char* word) {
        const auto of = std::ranges::find(export_formats(), std::string_view(word), &ExportFormat::word);
        return of->doubt == nullptr ? "" : of->doubt(input);
    };
    EXPECT_NE(doubt("webm").find("0.25 s of the motion apart"), std::string::npos) << doubt("webm");
    EXPECT_NE(doubt("gif"), "");
    EXPECT_EQ(doubt("png") + doubt("csv"), "");
    input.picture.duration = 60;   // fifteen frames a turn
    EXPECT_EQ(doubt("webm") + doubt("gif"), "");
    input.picture.duration = 0;
    input.picture.to = 4;
    EXPECT_EQ(doubt("webm") + doubt("gif"), "");
    input.picture.rate = 2;   // each frame is a whole turn
    EXPECT_NE(doubt("gif"), "");
}

/// What a command prints.
std::string said_by(const std::string& command)
{
    std::FILE* pipe = ::popen(command.c_str(), "r");
    if (pipe == nullptr) return "";
    std::string text;
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
    return ::pclose(pipe) == 0 ? text : "";
}

/// Archives of more than 4 GiB have the records that small ones have here.
TEST_F(Results, ArchivesWithNumbersOf64Bits)
{
    if (said_by("python3 -c 'import zipfile; print(1)' 2> /dev/null") != "1\n")
        GTEST_SKIP() << "there is no Python to read zips with";
    Scenario scenario;
    scenario.model = sample_model();
    const RunFile run = sample_run(scenario.model);
    write_run(in_folder("run.nc"), scenario.model, run);
    const ExportInput input{in_folder("run.nc"), scenario, run};
    write_npz(in_folder("narrow.npz"), input);
    write_npz(in_folder("wide.npz"), input, 500);
    EXPECT_GT(fs::file_size(in_folder("wide.npz")), fs::file_size(in_folder("narrow.npz")) + 1000);
    const std::string program =
        "from zipfile import ZipFile; a, b = ZipFile('narrow.npz'), ZipFile('wide.npz'); "
        "print(a.testzip(), b.testzip(), len(a.namelist()) > 50, a.namelist() == b.namelist(), "
        "all(a.read(n) == b.read(n) for n in a.namelist()))";
    EXPECT_EQ(said_by("cd '" + folder_.string() + "' && python3 -c \"" + program + "\""),
              "None None True True True\n");
}

/// Variables that others have added to a file are left out, whatever their names and types.
TEST_F(Results, ArchivesHoldWhatIsKnown)
{
    std::string image;
    ClassicWriter writer;
    writer.dimension("three", 3);
    const std::vector<Attribute> odd{{"units", 7}};
    const int good = writer.variable({"good", {"three"}, NumberType::real, odd});
    const int folder = writer.variable({"../up", {"three"}, NumberType::real, {}});
    const int scalar = writer.variable({"letter", {}, NumberType::text, {}});
    writer.begin(into(image));
    const std::vector<double> values{1, 2, 3};
    writer.append(good, values);
    writer.append(folder, values);
    writer.append(scalar, "x");
    writer.finish();
    put_bytes(in_folder("run.nc"), image);
    Scenario scenario;
    write_npz(in_folder("run.npz"), {in_folder("run.nc"), scenario, RunFile{}});
    const std::string bytes = bytes_of(in_folder("run.npz"));
    EXPECT_NE(bytes.find("good.npy"), std::string::npos);
    EXPECT_EQ(bytes.find("up.npy"), std::string::npos);
    EXPECT_EQ(bytes.find("letter.npy"), std::string::npos);
}

TEST_F(Results, SurfacesStandForBodiesWithoutAShape)
{
    Scenario scenario;
    scenario.model = sample_model();   // made without a scenario: there are no outlines
    std::vector<Surface> surfaces;
    for (const std::vector<Drawn>& drawn : drawn_of(scenario)) surfaces.push_back(united(drawn));
    ASSERT_EQ(surfaces.size(), 3u);   // the world has none
    EXPECT_TRUE(surfaces[2].triangles.empty());
    const double size = 0.05 * scenario.model.length();
    EXPECT_EQ(surfaces[0].triangles.size(), 8u);   // an octahedron
    for (std::size_t b = 0; b < 2; ++b)
        for (const Vector3& p : surfaces[b].points)
            EXPECT_NEAR(norm(p - (b == 0 ? Vector3{0, 0.5, 0} : Vector3{})), size, 1e-12);
}

TEST_F(Results, ExportsThatCannotBeWrittenSaySo)
{
    Scenario scenario;
    scenario.model = sample_model();
    RunFile run = sample_run(scenario.model);
    write_run(in_folder("run.nc"), scenario.model, run);
    const ExportInput input{in_folder("run.nc"), scenario, run};
    put_bytes(in_folder("taken"), "a file where the folder of the surfaces would be");
    EXPECT_THROW(write_pvd(in_folder("taken.pvd"), input), IoError);
    EXPECT_FALSE(fs::exists(in_folder("taken.pvd")));
    run.output = {};
    EXPECT_THROW(write_gltf(in_folder("none.glb"), input), IoError);
    EXPECT_THROW(write_npz(in_folder("x.npz"), {in_folder("missing.nc"), scenario, run}), IoError);
    EXPECT_EQ(n_files(), 2);
}

}   // namespace
}   // namespace livens::exports_test
