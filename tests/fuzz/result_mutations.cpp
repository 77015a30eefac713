// SPDX-License-Identifier: BSD-3-Clause
// Random damage to result files, the same in every run: each is refused, or gives the run that was written.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <vector>

#include "fuzz/edits.h"
#include "fuzz/round_trip.h"

#include "livens/multibody/model.h"

namespace livens {

namespace {

using RunFile = Run;   // testing::Test has a Run of its own

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

/// Files that are read with their checksums, half of them, are refused or unharmed; without, they do no harm.
/// LIVENS_MUTATIONS asks for another number of them.
TEST(ResultMutations, EachIsRefusedOrTheRunThatWasWritten)
{
    const char* wanted = std::getenv("LIVENS_MUTATIONS");
    const unsigned n = wanted != nullptr ? static_cast<unsigned>(std::atol(wanted)) : 7'000;
    const std::vector<std::string> seeds = test::result_files();
    ASSERT_GT(seeds.size(), 6u);   // of format 2.4 turns, of 2.2 lobatto and radau, of 2.1 the others
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
            ASSERT_TRUE(test::is_same(*run, runs[which])) << "mutation " << i;
        }
    }
    EXPECT_GT(n_read, n / 50) << "hardly any file gets beyond the header";
    EXPECT_LT(n_harmless, n / 50) << "hardly any file is damaged";
    std::printf("%u of %u mutations read without checksums, %u harmless with them\n", n_read, n, n_harmless);
}

std::string random_program(Damage& damage, std::size_t n)
{
    std::string program;
    for (std::size_t i = 0; i < n; ++i) program += static_cast<char>(damage.below(256));
    return program;
}

/// Edits of headers, with checksums that fit; and those of the corpus of the fuzzer, all of which are
/// refused.
TEST(ResultMutations, CraftedFilesAreRefusedOrReadInFull)
{
    const std::vector<std::string> seeds = test::result_files();
    for (const auto& entry :
         std::filesystem::directory_iterator(LIVENS_SOURCE_DIR "/tests/fuzz/corpus_crafted")) {
        std::ifstream in(entry.path(), std::ios::binary);
        const std::string program{std::istreambuf_iterator<char>(in), {}};
        EXPECT_FALSE(test::answer_to(test::Edits(program, seeds).bytes(), true).has_value()) << entry.path();
    }
    const char* wanted = std::getenv("LIVENS_MUTATIONS");
    const unsigned n = wanted != nullptr ? static_cast<unsigned>(std::atol(wanted)) : 4'000;
    unsigned n_read = 0;
    for (unsigned i = 0; i < n; ++i) {
        Damage damage(i);
        const std::string program = random_program(damage, 1 + 4 * (1 + damage.below(3)));
        n_read += test::answer_to(test::Edits(program, seeds).bytes(), true).has_value() ? 1 : 0;
    }
    EXPECT_GT(n_read, n / 50) << "hardly any file is read in full";
    EXPECT_LT(n_read, n / 2) << "hardly any file is damaged";
    std::printf("%u of %u crafted files read\n", n_read, n);
}

TEST(ResultMutations, RunsComeBackAsTheyWereWritten)
{
    for (const std::string& file : test::result_files()) {
        const RunFile run = read_run_from(test::source_in(file));
        const Model model = parse_scenario(run.scenario_text, "").scenario->model;
        for (unsigned i = 0; i < 100; ++i) {
            Damage damage(i);
            const std::string program = random_program(damage, 1 + damage.below(100));
            test::go_round(model, test::AnyRun(program, run).take());   // or the program ends
        }
    }
}

}   // namespace

}   // namespace livens
