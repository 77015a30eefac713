// SPDX-License-Identifier: BSD-3-Clause
// What files of strangers must not do beside crashing: deceive the eye, leave a message without a place. And
// files that must not be lost.
#include <sys/stat.h>

#include "livens/base/error.h"
#include "livens/io/exports.h"
#include "livens/io/json.h"
#include "livens/io/report.h"
#include "livens/io/scenario/bodies/meshes.h"
#include "unit/io/sample_run.h"
#include "unit/io/scenario_text.h"

namespace livens::strangers_test {
namespace {

const ExportFormat& format(std::string_view word)
{
    return *std::ranges::find(export_formats(), word, [](const ExportFormat& f) { return f.word; });
}

TEST_F(Results, OnlyWhatIsEmptyOrOfTheirKindMayBeReplaced)
{
    const Model model = sample_model();
    const std::string image = image_of(model, sample_run(model));
    const auto is_kept = [&](const std::string& bytes, bool (*is_own)(std::string_view)) {
        put_bytes(in_folder("file"), bytes);
        return is_occupied(in_folder("file"), is_own);
    };
    EXPECT_FALSE(is_occupied(in_folder("missing"), begins_as_run));
    EXPECT_FALSE(is_occupied(folder_, begins_as_run)) << "check_writable() refuses it";
    const ExportFormat* const all[] = {&format("csv"), &format("npz"), &format("gltf"), &format("pvd")};
    for (const char* text : {"format = 1\n", "t [s]", "<!doctype html>\n<html lang=\"en\">\n<head>", "glTF",
                             "PK\3\4", "CDF\1", "x", "livens_format"}) {
        EXPECT_TRUE(is_kept(text, begins_as_run)) << text;
        EXPECT_TRUE(is_kept(text, begins_as_report)) << text;
        for (const ExportFormat* f : all) EXPECT_TRUE(is_kept(text, f->is_own)) << f->word << text;
    }
    for (const ExportFormat* f : all) {
        EXPECT_FALSE(is_kept("", f->is_own));
        EXPECT_TRUE(is_kept(image, f->is_own));
    }
    EXPECT_FALSE(is_kept("", begins_as_run));
    EXPECT_FALSE(is_kept(image, begins_as_run));
    EXPECT_FALSE(is_kept(image.substr(0, image.size() / 2), begins_as_run)) << "by its content, cut or not";
}

TEST_F(Results, SetUserIdIsNotHandedOn)
{
    put_bytes(in_folder("run.nc"), "old");
    ASSERT_EQ(::chmod(in_folder("run.nc").c_str(), 06751), 0);
    replace_file(in_folder("run.nc"), "new");
    EXPECT_EQ(static_cast<int>(fs::status(in_folder("run.nc")).permissions()), 0751);
}

/// Each file that is written would list the folder again, and the folder grows.
TEST_F(Results, AFolderIsLookedThroughOnceAProcess)
{
    replace_file(in_folder("first"), "1");
    put_bytes(in_folder(".livens-999999-0.tmp"), "of a process that was killed meanwhile");
    replace_file(in_folder("second"), "2");
    EXPECT_TRUE(fs::exists(in_folder(".livens-999999-0.tmp")));
}

/// What is kept of meshes has a line each, whatever is in their names.
TEST_F(Results, NamesOfMeshesAndSurfacesComeBackWhateverIsInThem)
{
    put_bytes(in_folder("w.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng a\\nb\\\nf 1 3 2\n"
                                  "g c\\\\d\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    MeshStore read({folder_});
    const ReducedMesh& mesh = read.find("w.obj", false);
    ASSERT_GE(mesh.surfaces.size(), 3u);
    MeshStore again({{}, read.kept()});
    const ReducedMesh& kept = again.find("w.obj", false);
    ASSERT_EQ(kept.surfaces.size(), mesh.surfaces.size());
    for (std::size_t i = 0; i < mesh.surfaces.size(); ++i)
        EXPECT_EQ(kept.surfaces[i].name, mesh.surfaces[i].name);
    EXPECT_EQ(again.kept(), read.kept());
    EXPECT_EQ(read.files().size(), 1u);
    EXPECT_TRUE(again.files().empty());
    const std::string odd = "a\nmesh 0 1.obj";
    MeshStore by_hand({{}, "mesh 0 1 0 0 0 1 1 1 0 0 0 a\\nmesh 0 1.obj\n"});
    EXPECT_EQ(by_hand.find(odd, false).whole.volume, 1);
    MeshStore back({{}, by_hand.kept()});
    EXPECT_EQ(back.find(odd, false).whole.volume, 1);
    EXPECT_THROW(read.find(odd, false), InputError) << "new ones are refused";
}

TEST(Invisible, CharactersAreKnownAndEscapedInJson)
{
    for (const char* mark :
         {"\xc2\x85", "\xc2\x9b", "\xe2\x80\xa8", "\xe2\x80\xae", "\xe2\x81\xa6", "\xe2\x80\x8b",
          "\xef\xbb\xbf", "\xc2\xad", "\xf3\xa0\x80\x81", "\x7f", "\x1b"}) {
        EXPECT_TRUE(is_invisible(code_point(mark))) << mark;
        JsonWriter json;
        json.value(mark);
        EXPECT_EQ(json.text().find(mark), std::string::npos);
        EXPECT_TRUE(is_json(json.text())) << json.text();
    }
    for (const char* letter : {"a", " ", "\xc3\xa4", "\xe2\x80\x8d", "\xe2\x82\xac", "\xf0\x9f\x8c\x8d"}) {
        EXPECT_FALSE(is_invisible(code_point(letter))) << letter;
        JsonWriter json;
        json.value(letter);
        EXPECT_EQ(json.text(), '"' + std::string(letter) + '"');
    }
    JsonWriter json;
    json.value("\xf3\xa0\x80\x81");
    EXPECT_EQ(json.text(), "\"\\udb40\\udc01\"");
}

/// Where the parser itself knows no place.
TEST(Places, EverySyntaxErrorHasOne)
{
    const std::string far(5000, ' ');
    for (const auto& [text, line, column] : {std::tuple("r=[}", 1, 4), std::tuple("[[[a", 1, 3),
                                             std::tuple("x = 1\n\na = [1, \xe2\x80\xa8 2]\n", 3, 9),
                                             std::tuple("a = [\xc2\x85]", 1, 6), std::tuple("", 1, 1)})
        for (const std::string& before : {std::string(), "# \xc3\xa4 a comment\n" + far + "\n"}) {
            if (std::string_view(text).empty() && !before.empty()) continue;
            const ScenarioResult result = test::read(before + text);
            ASSERT_FALSE(result.diagnostics.empty()) << text;
            const Diagnostic& d = result.diagnostics.front();
            EXPECT_EQ(d.line, line + (before.empty() ? 0 : 2)) << text << test::shown(result);
            EXPECT_EQ(d.column, column) << text << test::shown(result);
        }
}

}   // namespace
}   // namespace livens::strangers_test
