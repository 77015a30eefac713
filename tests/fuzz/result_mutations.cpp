// SPDX-License-Identifier: BSD-3-Clause
// Random damage to result files, the same in every run: each is refused, or gives the run that was written.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <vector>

#include "fuzz/result.h"
#include "livens/io/results/classic_netcdf_bytes.h"

namespace livens {

namespace {

using RunFile = Run;   // testing::Test has a Run of its own

std::vector<std::string> files()
{
    std::vector<std::filesystem::path> paths;
    for (const auto& entry :
         std::filesystem::directory_iterator(LIVENS_SOURCE_DIR "/tests/fuzz/corpus_results"))
        paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    std::vector<std::string> all;
    for (const std::filesystem::path& path : paths) {
        std::ifstream in(path, std::ios::binary);
        all.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    }
    return all;
}

class Damage {
public:
    explicit Damage(unsigned seed) : random_(seed) {}

    std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }
    std::string to(std::string bytes)
    {
        for (std::size_t n = 1 + below(3); n > 0 && bytes.size() > 16; --n) change(bytes);
        return bytes;
    }

private:
    /// Most of a small file is its header, where most can go wrong.
    std::size_t aligned(const std::string& bytes) { return 4 * below(bytes.size() / 4 - 1); }

    template <class Word>
    void put(std::string& bytes, Word word)
    {
        word = big_endian(word);
        const std::size_t at = std::min(aligned(bytes), bytes.size() - sizeof word);
        std::memcpy(bytes.data() + at, &word, sizeof word);
    }

    void change(std::string& bytes)
    {
        constexpr std::uint32_t words[] = {0,  1,  2,          3,          4,          6,       10,
                                           11, 12, 0x7fffffff, 0x80000000, 0xffffffff, 1u << 16};
        constexpr double numbers[] = {0, -1, 33, 1e308, -1e308, 0.5, 5e-324};
        switch (below(9)) {
        case 0:
            bytes[below(bytes.size())] ^= static_cast<char>(1u << below(8));
            break;
        case 1:
            bytes[below(bytes.size())] = static_cast<char>(below(256));
            break;
        case 2:
            put(bytes, words[below(std::size(words))]);
            break;
        case 3:
            put(bytes, static_cast<std::uint32_t>(below(bytes.size() + 64)));
            break;
        case 4:
            put(bytes, std::bit_cast<std::uint64_t>(below(4) == 0 ? std::nan("")
                                                                  : numbers[below(std::size(numbers))]));
            break;
        case 5:
            bytes.resize(below(bytes.size()));
            break;
        case 6:
            bytes.erase(aligned(bytes), 4 * (1 + below(8)));
            break;
        case 7:
            bytes.insert(aligned(bytes), bytes.substr(aligned(bytes), 4 * (1 + below(16))));
            break;
        default: {
            const std::string piece = bytes.substr(aligned(bytes), 4 * (1 + below(16)));
            bytes.replace(aligned(bytes), piece.size(), piece);
        }
        }
    }

    std::mt19937 random_;
};

/// All numbers of the motion, bit by bit, and the texts that say what they are.
bool is_same(const Run& a, const Run& b)
{
    const auto bits = [](const std::vector<double>& x, const std::vector<double>& y) {
        return x.size() == y.size() &&
               (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(double)) == 0);
    };
    return bits(a.motion.X.values, b.motion.X.values) && bits(a.motion.P.values, b.motion.P.values) &&
           bits(a.motion.mesh.ends, b.motion.mesh.ends) && bits(a.output, b.output) &&
           bits(a.motion.multipliers.values, b.motion.multipliers.values) &&
           bits(a.motion.end_multipliers, b.motion.end_multipliers) && a.motion.momenta == b.motion.momenta &&
           a.motion.velocities == b.motion.velocities && a.scenario_text == b.scenario_text &&
           a.meshes == b.meshes && bits(a.estimate.position, b.estimate.position) &&
           bits(a.estimate.velocity, b.estimate.velocity) &&
           bits(a.estimate.orientation, b.estimate.orientation) &&
           bits(a.estimate.reaction, b.estimate.reaction) && a.body_names == b.body_names &&
           a.report.status == b.report.status && a.method == b.method;
}

/// Files that are read with their checksums, half of them, are refused or unharmed; without, they do no harm.
/// LIVENS_MUTATIONS asks for another number of them.
TEST(ResultMutations, EachIsRefusedOrTheRunThatWasWritten)
{
    const char* wanted = std::getenv("LIVENS_MUTATIONS");
    const unsigned n = wanted != nullptr ? static_cast<unsigned>(std::atol(wanted)) : 20'000;
    const std::vector<std::string> seeds = files();
    ASSERT_GT(seeds.size(), 5u);   // of format 2.2 lobatto and radau, of 2.1 the others
    std::vector<RunFile> runs;
    for (const std::string& seed : seeds) {
        std::optional<RunFile> run = test::answer_to(seed, true);
        ASSERT_TRUE(run.has_value());
        runs.push_back(std::move(*run));
    }
    unsigned n_read = 0, n_harmless = 0;
    for (unsigned i = 0; i < n; ++i) {
        Damage damage(i);
        const std::size_t which = damage.below(seeds.size());
        const std::string bytes = damage.to(seeds[which]);
        const bool verify = i % 2 == 0;
        const std::optional<RunFile> run = test::answer_to(bytes, verify);
        if (!run) continue;
        ++(verify ? n_harmless : n_read);
        if (verify) {
            ASSERT_TRUE(is_same(*run, runs[which])) << "mutation " << i;
        }
    }
    EXPECT_GT(n_read, n / 50) << "hardly any file gets beyond the header";
    EXPECT_LT(n_harmless, n / 50) << "hardly any file is damaged";
    std::printf("%u of %u mutations read without checksums, %u harmless with them\n", n_read, n, n_harmless);
}

}   // namespace

}   // namespace livens
