// SPDX-License-Identifier: BSD-3-Clause
// libFuzzer's target for meshes of one format (LIVENS_MESH_FORMAT: ".stl"); fuzz.cmake says how it is built
// and run.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "livens/base/error.h"
#include "livens/geometry/moments.h"
#include "livens/geometry/soundness.h"

namespace {

/// Fields that are linear, or bend within elements, are integrated or refused as densities.
void weigh(const livens::Mesh& mesh)
{
    using namespace livens;
    const auto answered = [](const auto& weighing) {
        try {
            weighing();
        } catch (const InputError& error) {
            if (error.complaint().code != "density-field") std::abort();
        }
    };
    answered([&] { weighted_moments(mesh, LinearDensity{2, {0.5, 0.25, -1}}); });
    if (mesh.is_volume() && mesh.n_elements(3) < 20)
        answered([&] { weighted_moments(mesh, [](const Vector3& p) { return 1 + std::abs(p[0] * p[1]); }); });
}

/// Any bytes are refused by a code of meshes, or make a mesh whose indices exist, which can be checked,
/// turned and integrated.
void answer_to(std::string_view bytes)
{
    using namespace livens;
    Mesh mesh;
    try {
        mesh = read_mesh(bytes, "fuzz" LIVENS_MESH_FORMAT);
    } catch (const InputError& error) {
        if (!error.complaint().code.starts_with("mesh-")) std::abort();
        return;
    }
    for (const ElementBlock& b : mesh.blocks) {
        if (b.nodes.size() != b.regions.size() * static_cast<std::size_t>(n_nodes(b.kind))) std::abort();
        for (const std::int32_t node : b.nodes)
            if (node < 0 || static_cast<std::size_t>(node) >= mesh.points.size()) std::abort();
        for (const std::int32_t region : b.regions)
            if (region < 0 || static_cast<std::size_t>(region) >= mesh.regions.size()) std::abort();
    }
    const bool is_sound = faults_of(mesh).empty();
    if (moments(mesh); is_sound && mesh.is_volume()) boundary_of(mesh);
    if (is_sound || !mesh.is_volume()) surface_moments(mesh);
    if (is_sound) weigh(mesh);
    n_pieces(mesh);
    turn_outwards(mesh);
    faults_of(mesh);
}

}   // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    answer_to({reinterpret_cast<const char*>(data), size});
    return 0;
}
