// SPDX-License-Identifier: BSD-3-Clause
// The table of formats: word, ending, what it is, how a file of ours begins, and its writer. One more format
// is an entry here (docs/architecture.md, "The rooms").
#include "livens/io/exports/formats.h"

#include <algorithm>

namespace livens {

namespace {

/// As Zip of npz.cpp begins: stored, names in UTF-8, without a date; numpy.savez has other flags.
bool begins_as_npz(std::string_view head)
{
    constexpr std::string_view entry("PK\3\4\x2d\0\0\x08\0\0\0\0\x21\0", 14);
    return head.starts_with(entry) && head.find(".npy") != std::string_view::npos;
}

bool begins_as_gltf(std::string_view head)
{
    // A file is replaced without a question only where livens wrote it, which its first bytes tell.
    return head.starts_with("glTF") &&
           head.substr(0, 200).find(R"("generator": "livens )") != std::string_view::npos;
}

/// Pictures carry our name near their beginning: of a GIF behind its palette.
template <char First, char Second>
bool begins_as_picture(std::string_view head)
{
    return head.size() > 1 && head[0] == First && head[1] == Second &&
           head.substr(0, 1024).find("livens") != std::string_view::npos;
}

constexpr ExportFormat formats[] = {
    {"csv", ".csv", "table of the motion; at the output times if the scenario lists them",
     [](std::string_view head) { return head.starts_with("t [s],"); },
     [](const std::filesystem::path& file, const ExportInput& input) {
         write_csv(file, input.scenario.model, input.run,
                   instants_of(input.scenario, input.run, input.instants), input.units);
     }},
    {"npz", ".npz", "NumPy archive of all variables of the result", begins_as_npz,
     [](const std::filesystem::path& file, const ExportInput& input) { write_npz(file, input); }},
    {"gltf", ".glb", "glTF 2.0 animation of the bodies", begins_as_gltf, write_gltf},
    {"pvd", ".pvd", "ParaView collection, with its surface files in a folder beside it",
     [](std::string_view head) { return head.starts_with(pvd_head); }, write_pvd},
    {"webm", ".webm", "video, drawn by a browser without a window", begins_as_picture<'\x1a', '\x45'>,
     [](const std::filesystem::path& file, const ExportInput& input) { write_picture(file, input, "webm"); },
     true, [](const ExportInput& input) { return doubt_of_video(input, "webm"); }},
    {"gif", ".gif", "animated picture for slides, drawn in the same way", begins_as_picture<'G', 'I'>,
     [](const std::filesystem::path& file, const ExportInput& input) { write_picture(file, input, "gif"); },
     true, [](const ExportInput& input) { return doubt_of_video(input, "gif"); }},
    {"png", ".png", "still, drawn in the same way", begins_as_picture<'\x89', 'P'>,
     [](const std::filesystem::path& file, const ExportInput& input) { write_picture(file, input, "png"); },
     true},
    {"svg", ".svg", "sketch with joint symbols, drawn in the same way", begins_as_picture<'<', 's'>,
     [](const std::filesystem::path& file, const ExportInput& input) { write_picture(file, input, "svg"); },
     true},
};

}   // namespace

std::span<const ExportFormat> export_formats() { return formats; }

std::vector<double> io_internal::reached_times(const Run& run)
{
    const auto first = std::ranges::lower_bound(run.output, run.motion.start());
    const auto last = std::ranges::upper_bound(run.output, run.motion.end());
    return {first, last};
}

}   // namespace livens
