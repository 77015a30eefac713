#include <csignal>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "livens/io/detail/netcdf_file.h"
#include "livens/io/detail/results_digest.h"
#include "livens/io/detail/results_layout.h"
#include "livens/io/results.h"
#include "unit/io/sample_run.h"

namespace livens {
namespace {

// --- files of strangers
// ---------------------------------------------------------------------------------------------

TEST_F(Results, ForeignFilesAreRefused)
{
    put_bytes(in_folder("empty.nc"), "");
    EXPECT_NE(error_of_reading(in_folder("empty.nc")).find("empty"), std::string::npos);
    put_bytes(in_folder("text.nc"), "format = 1\n");
    EXPECT_NE(error_of_reading(in_folder("text.nc")).find("no NetCDF-4"), std::string::npos);
    put_bytes(in_folder("signature.nc"), "\x89HDF\r\n\x1a\n");
    EXPECT_NE(error_of_reading(in_folder("signature.nc")), "");
    put_bytes(in_folder("classic.nc"), std::string("CDF\1", 4) + std::string(60, '\0'));
    EXPECT_NE(error_of_reading(in_folder("classic.nc")), "");
    EXPECT_NE(error_of_reading(in_folder("missing.nc")).find("missing.nc"), std::string::npos);
    EXPECT_NE(error_of_reading(folder_).find("directory"), std::string::npos);
    ASSERT_EQ(::mkfifo(in_folder("pipe").c_str(), 0600), 0);
    EXPECT_NE(error_of_reading(in_folder("pipe")).find("regular"), std::string::npos);

    NetcdfWriter writer(0);
    writer.attribute("title", std::string("not livens"));
    put_bytes(in_folder("other.nc"), writer.image());
    EXPECT_NE(error_of_reading(in_folder("other.nc")).find("no run of livens"), std::string::npos);
}

/// A file with a header of our making and nothing else.
std::string file_with_format(int major, int minor)
{
    NetcdfWriter writer(0);
    writer.attribute("livens_format", major);
    writer.attribute("livens_format_minor", minor);
    return writer.image();
}

TEST_F(Results, UnknownMajorIsRefused)
{
    put_bytes(in_folder("new.nc"), file_with_format(format_major + 1, 0));
    EXPECT_NE(error_of_reading(in_folder("new.nc")).find("format 2"), std::string::npos);
    put_bytes(in_folder("hollow.nc"), file_with_format(format_major, 0));
    EXPECT_NE(error_of_reading(in_folder("hollow.nc")), "");
}

TEST_F(Results, CutOffFilesAreRefused)
{
    const Model model = sample_model();
    const std::string image = run_image(model, sample_run(model));
    for (std::size_t part = 0; part < 64; ++part) {
        put_bytes(in_folder("cut.nc"), image.substr(0, image.size() * part / 64));
        EXPECT_NE(error_of_reading(in_folder("cut.nc")), "") << part << "/64";
    }
}

TEST_F(Results, FlippedBytesAreSeen)
{
    const Model model = sample_model();
    const std::string image = run_image(model, sample_run(model, 1));
    int seal = 0;
    for (std::size_t place = 0; place < image.size(); place += 97) {
        std::string damaged = image;
        damaged[place] = static_cast<char>(damaged[place] ^ 1);
        put_bytes(in_folder("damaged.nc"), damaged);
        seal += error_of_reading(in_folder("damaged.nc")).find("checksum") != std::string::npos;
    }
    EXPECT_EQ(seal, static_cast<int>((image.size() - 24 + 96) / 97)) << "damage reached the HDF5 library";
}

TEST_F(Results, FlippedBytesInDataAreSeenWithoutASeal)
{
    const Model model = sample_model();
    const RunFile run = sample_run(model);
    std::string image = run_image(model, run);
    image.resize(image.size() - 24);   // as other tools leave it
    put_bytes(in_folder("unsealed.nc"), image);
    EXPECT_EQ(error_of_reading(in_folder("unsealed.nc")), "");
    // The values of X lie in one piece: HDF5 keeps no checksum over them, the digest does.
    const std::string values(reinterpret_cast<const char*>(run.motion.X.values.data()), 8 * 48);
    const std::size_t place = image.find(values);
    ASSERT_NE(place, std::string::npos);
    image[place + 100] = static_cast<char>(image[place + 100] ^ 1);
    put_bytes(in_folder("damaged.nc"), image);
    EXPECT_NE(error_of_reading(in_folder("damaged.nc")).find("digest"), std::string::npos);
}

TEST_F(Results, SizesThatLieAreRefused)
{
    NetcdfWriter writer(0);
    const std::vector<double> ends{0, 1};
    writer.dimension("element_end", 2);
    writer.variable({"element_end", {"element_end"}}, std::span<const double>(ends));
    std::string image = writer.image();
    const NetcdfReader file(image);
    EXPECT_EQ(file.doubles({"element_end", {"element_end"}}), ends);
    EXPECT_THROW(file.doubles({"element_end", {"body"}}), IoError);
    EXPECT_THROW(file.doubles({"element_end", {"element_end", "xyz"}}), IoError);
    EXPECT_THROW(file.ints({"element_end", {"element_end"}}), IoError);
    EXPECT_THROW(file.doubles({"nothing", {}}), IoError);
    EXPECT_THROW(file.int_attribute("nothing"), IoError);
}

TEST_F(Results, RunsThatContradictThemselvesAreRefused)
{
    const Model model = sample_model();
    const auto refused = [&](auto&& change) {
        RunFile run = sample_run(model);
        change(run);
        try {
            write_run(in_folder("run.nc"), model, run);
        } catch (const IoError&) {
            return !fs::exists(in_folder("run.nc")) && n_files() == 0;
        }
        return false;
    };
    EXPECT_TRUE(refused([](RunFile& r) { r.motion.X.values.pop_back(); }));
    EXPECT_TRUE(refused([](RunFile& r) { r.motion.X.degree = 33; }));
    EXPECT_TRUE(refused([](RunFile& r) { r.motion.X.n_values = 0; }));
    EXPECT_TRUE(refused([](RunFile& r) { r.motion.mesh.ends[3] = 0; }));
    EXPECT_TRUE(refused([](RunFile& r) { r.motion.mesh.ends.clear(); }));
    EXPECT_TRUE(refused([](RunFile& r) { r.motion.velocities.pop_back(); }));
    EXPECT_TRUE(refused([](RunFile& r) { r.motion.end_multipliers.pop_back(); }));
    EXPECT_TRUE(refused([](RunFile& r) { r.motion.redundant_rows = {1}; }));
    EXPECT_TRUE(refused([](RunFile& r) { r.body_names.pop_back(); }));
    EXPECT_TRUE(refused([](RunFile& r) { r.body_names[0] = "other"; }));
    EXPECT_TRUE(refused([](RunFile& r) { r.output[1] = std::numeric_limits<double>::quiet_NaN(); }));
    EXPECT_TRUE(refused([](RunFile& r) { r.verdict.balance.work.pop_back(); }));
    EXPECT_TRUE(refused([](RunFile& r) { r.motion.X.continuous = false; }));
    EXPECT_TRUE(refused([](RunFile& r) { r.motion.X.denominators.assign(16, 1); }));
    EXPECT_TRUE(refused([](RunFile& r) { r.motion.X.denominators.assign(17, 0); }));
    EXPECT_TRUE(refused([](RunFile& r) {
        r.motion.X.denominators.assign(17, 1);
        r.motion.X.denominators[3] = std::numeric_limits<double>::quiet_NaN();
    }));
    EXPECT_TRUE(refused([](RunFile& r) { r.motion.rigidity.values.pop_back(); }));
    EXPECT_TRUE(refused([](RunFile& r) { r.motion.rigidity.n_values = 6; }));
    EXPECT_TRUE(refused([](RunFile& r) { r.motion.gauss_points = -1; }));
    EXPECT_TRUE(refused([](RunFile& r) { r.motion.block_ends = {0, 9}; }));
    EXPECT_TRUE(refused([](RunFile& r) { r.motion.block_ends = {-1, 8}; }));
    EXPECT_TRUE(refused([](RunFile& r) { r.motion.block_ends = {0, 4, 4}; }));
}

// --- the disk
// -------------------------------------------------------------------------------------------------------

TEST_F(Results, PlacesThatCannotBeWrittenAreNamedBefore)
{
    const auto message = [](const fs::path& file) {
        try {
            check_writable(file);
        } catch (const IoError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    fs::create_directory(in_folder("folder"));
    put_bytes(in_folder("file"), "x");
    EXPECT_EQ(message(in_folder("run.nc")), "");
    EXPECT_EQ(message(in_folder("file")), "");
    EXPECT_NE(message(in_folder("folder")).find("directory"), std::string::npos);
    EXPECT_NE(message(in_folder("missing") / "run.nc").find("missing"), std::string::npos);
    EXPECT_NE(message(in_folder("file") / "run.nc").find("file"), std::string::npos);
    EXPECT_NE(message("/dev/null").find("device"), std::string::npos);
    EXPECT_NE(message(""), "");
    EXPECT_NE(message(in_folder("folder") / ""), "");
    EXPECT_NE(message(in_folder(std::string(300, 'n'))), "");
    fs::create_symlink("loop", in_folder("loop"));
    EXPECT_NE(message(in_folder("loop")), "");
}

TEST_F(Results, LinksStayAndRightsAreKept)
{
    put_bytes(in_folder("target.nc"), "old");
    ASSERT_EQ(::chmod(in_folder("target.nc").c_str(), 0640), 0);
    fs::create_symlink("target.nc", in_folder("link.nc"));
    replace_file(in_folder("link.nc"), "new");
    EXPECT_TRUE(fs::is_symlink(in_folder("link.nc")));
    EXPECT_EQ(bytes_of(in_folder("target.nc")), "new");
    EXPECT_EQ(static_cast<int>(fs::status(in_folder("target.nc")).permissions()), 0640);
    EXPECT_EQ(n_files(), 2);
}

TEST_F(Results, OddNamesWork)
{
    const Model model = sample_model();
    const RunFile run = sample_run(model, 1);
    for (const std::string& name :
         {std::string("a b.nc"), std::string("größe ☃.nc"), std::string("back\\slash.nc"),
          std::string("x#mode=zarr"), std::string(255, 'n'), std::string("-o")}) {
        write_run(in_folder(name), model, run);
        EXPECT_EQ(digest(read_run(in_folder(name))), digest(run)) << name;
    }
}

/// Files may grow to `bytes` while this lives: what a full disk looks like to a process.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes)
    {
        ::signal(SIGXFSZ, SIG_IGN);
        ::getrlimit(RLIMIT_FSIZE, &old_);
        const rlimit limit{bytes, old_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() { ::setrlimit(RLIMIT_FSIZE, &old_); }

private:
    rlimit old_{};
};

TEST_F(Results, FullDiskLeavesTheOldFile)
{
    const Model model = sample_model();
    put_bytes(in_folder("run.nc"), "old result");
    for (const rlim_t bytes : {0, 1, 4096, 40000}) {
        const FileSizeLimit limit(bytes);
        EXPECT_THROW(write_run(in_folder("run.nc"), model, sample_run(model)), IoError) << bytes;
        EXPECT_THROW(replace_file(in_folder("run.nc"), std::string(50000, 'x')), IoError) << bytes;
    }
    EXPECT_EQ(bytes_of(in_folder("run.nc")), "old result");
    EXPECT_EQ(n_files(), 1) << "a temporary file was left behind";
}

}   // namespace
}   // namespace livens
