// SPDX-License-Identifier: BSD-3-Clause
#include "livens/io/exports/formats.h"

#include <algorithm>

namespace livens {

namespace {

constexpr ExportFormat formats[] = {
    {"csv", ".csv", "table of the samples at the output times",
     [](const std::filesystem::path& file, const ExportInput& input) {
         write_csv(file, input.scenario.model, input.run);
     }},
    {"npz", ".npz", "NumPy archive of all variables of the result",
     [](const std::filesystem::path& file, const ExportInput& input) { write_npz(file, input); }},
    {"gltf", ".glb", "glTF 2.0 animation of the bodies", write_gltf},
    {"pvd", ".pvd", "ParaView collection; its surfaces lie in a folder beside it", write_pvd},
};

}   // namespace

std::span<const ExportFormat> export_formats() { return formats; }

std::vector<double> reached_times(const Run& run)
{
    const auto first = std::ranges::lower_bound(run.output, run.motion.start());
    const auto last = std::ranges::upper_bound(run.output, run.motion.end());
    return {first, last};
}

}   // namespace livens
