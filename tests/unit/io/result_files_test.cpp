// SPDX-License-Identifier: BSD-3-Clause
#include <csignal>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "livens/diagnostics/sample.h"
#include "livens/io/results.h"
#include "livens/multibody/model.h"
#include "sanitized.h"
#include "unit/io/sample_run.h"

namespace livens::result_files_test {
namespace {

// --- files of strangers
// ---------------------------------------------------------------------------------------------

/// Whether reading fails with this code and says this.
void expect_refused(const fs::path& file, const std::string& code, const std::string& part)
{
    const std::string error = error_of_reading(file);
    EXPECT_TRUE(error.starts_with(code + ": ")) << error;
    EXPECT_NE(error.find(part), std::string::npos) << error;
}

TEST_F(Results, ForeignFilesAreRefused)
{
    put_bytes(in_folder("empty.nc"), "");
    expect_refused(in_folder("empty.nc"), "io-truncated", "empty");
    put_bytes(in_folder("short.nc"), "CD");
    expect_refused(in_folder("short.nc"), "io-truncated", "2 bytes");
    put_bytes(in_folder("text.nc"), "format = 1\n");
    expect_refused(in_folder("text.nc"), "io-foreign", "no NetCDF");
    put_bytes(in_folder("hdf5.nc"), "\x89HDF\r\n\x1a\n and more");
    expect_refused(in_folder("hdf5.nc"), "io-foreign", "HDF5");
    put_bytes(in_folder("none.nc"), std::string("CDF\1", 4) + std::string(28, '\0'));
    expect_refused(in_folder("none.nc"), "io-foreign", "no run of livens");
    expect_refused(in_folder("missing.nc"), "io", "missing.nc");
    expect_refused(folder_, "io", "directory");
    ASSERT_EQ(::mkfifo(in_folder("pipe").c_str(), 0600), 0);
    expect_refused(in_folder("pipe"), "io-not-a-file", "regular");

    std::string other;
    ClassicWriter writer;
    writer.attribute("title", "not livens");
    writer.begin(into(other));
    writer.finish();
    put_bytes(in_folder("other.nc"), other);
    expect_refused(in_folder("other.nc"), "io-foreign", "no run of livens");
}

TEST_F(Results, UnknownMajorIsRefused)
{
    const auto file_with_format = [](int major) {
        std::string image;
        ClassicWriter writer;
        writer.attribute("livens_format", major);
        writer.begin(into(image));
        writer.finish();
        return image;
    };
    put_bytes(in_folder("new.nc"), file_with_format(format_major + 1));
    expect_refused(in_folder("new.nc"), "io-version", "format 3");
    put_bytes(in_folder("hollow.nc"), file_with_format(format_major));
    expect_refused(in_folder("hollow.nc"), "io-damaged", "missing");
}

TEST_F(Results, EveryTruncationIsToldAsOne)
{
    const Model model = sample_model();
    const std::string image = image_of(model, sample_run(model, 1));
    for (std::size_t n = 0; n < image.size(); n += is_sanitized ? 7 : 1) {
        const std::string part = image.substr(0, n);
        try {
            read_run_from(source_of(part));
            ADD_FAILURE() << n << " of " << image.size() << " bytes were taken for the whole";
        } catch (const IoError& error) {
            EXPECT_EQ(error.code(), "io-truncated") << n << " bytes: " << error.what();
        }
    }
}

TEST_F(Results, EveryFlippedBitIsSeen)
{
    const Model model = sample_model();
    std::string image = image_of(model, sample_run(model, 1));
    const std::size_t step = is_sanitized ? 31 : 1;   // 31 and eight: every bit of a byte all the same
    for (std::size_t place = 0; place < image.size(); place += step) {
        const char whole = image[place];
        image[place] = static_cast<char>(whole ^ (1 << place % 8));
        EXPECT_THROW(read_run_from(source_of(image)), IoError) << place;
        image[place] = whole;
    }
    EXPECT_NO_THROW(read_run_from(source_of(image)));
}

/// Damage that the checksums would find is looked at with checksums off, as if somebody had made them fit.
TEST_F(Results, MutationsEndInAnErrorOrARun)
{
    const Model model = sample_model();
    const std::string whole = image_of(model, sample_run(model, 2));
    const std::size_t header = Image(whole).reader().variables().front().begin;
    std::mt19937 random(20261122);
    int n_read = 0, n_refused = 0;
    for (int trial = 0; trial < (is_sanitized ? 2000 : 6000); ++trial) {
        std::string image = whole;
        for (unsigned n = 1 + random() % 4; n > 0; --n) {
            const bool is_anywhere = trial % 4 == 0;
            const std::size_t at =
                random() % (is_anywhere ? image.size() : std::min(header, image.size()));
            switch (random() % 6) {
            case 0: image[at] = static_cast<char>(random()); break;
            case 1: image[at] = static_cast<char>(image[at] ^ (1 << random() % 8)); break;
            case 2: image.replace(at, 4, 4, static_cast<char>(random() % 2 == 0 ? 0xff : 0)); break;
            case 3: image.erase(at, 4 * (1 + random() % 8)); break;
            case 4: image.insert(at, 4 * (1 + random() % 8), '\0'); break;
            default: image.resize(at + 1); break;
            }
        }
        try {
            const RunFile run = read_run_from(source_of(image), false);
            ++n_read;
            if (run.motion.n_elements() > 0 && run.motion.n_bodies == 2)
                sample_bodies(model, run.motion, run.motion.start());
        } catch (const IoError& error) {
            EXPECT_TRUE(error.code().starts_with("io-")) << error.what();
            ++n_refused;
        } catch (const std::bad_alloc&) {
            ADD_FAILURE() << "memory was asked for that the file cannot fill";
        }
    }
    EXPECT_GT(n_read, 100);
    EXPECT_GT(n_refused, 1000);
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
    EXPECT_TRUE(refused([](RunFile& r) { r.estimate.velocity.pop_back(); }));
    EXPECT_TRUE(refused([](RunFile& r) { r.estimate.position.clear(); }));
    EXPECT_TRUE(refused([](RunFile& r) { r.estimate.reaction.push_back(0); }));
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
    EXPECT_TRUE(refused([](RunFile& r) { r.motion.gauss_points = 65; }));
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
        EXPECT_EQ(image_of(model, read_run(in_folder(name))), image_of(model, run)) << name;
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
}   // namespace livens::result_files_test
