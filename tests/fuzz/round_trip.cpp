// SPDX-License-Identifier: BSD-3-Clause
// libFuzzer's target for the reader against the writer; fuzz.cmake says how it is run.
#include "fuzz/round_trip.h"

#include "fuzz/edits.h"

#include "livens/multibody/model.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace livens;
    struct Seed {
        Run run;
        Model model;
    };
    static const std::vector<Seed> seeds = [] {
        std::vector<Seed> all;
        for (const std::string& file : test::result_files()) {
            Run run = read_run_from(test::source_in(file));
            Model model = parse_scenario(run.scenario_text, "").scenario->model;
            all.push_back({std::move(run), std::move(model)});
        }
        return all;
    }();
    if (size == 0) return 0;
    const Seed& seed = seeds[data[0] % seeds.size()];
    const std::string_view program(reinterpret_cast<const char*>(data) + 1, size - 1);
    test::go_round(seed.model, test::AnyRun(program, seed.run).take());
    return 0;
}
