// SPDX-License-Identifier: BSD-3-Clause
// [[load]] type = "bushing".
// A bushing has two frames; where both are left to one point of the world they coincide at the start, so that
// its displacement u is zero there.
#include "livens/io/scenario/bodies/bodies.h"
#include "livens/io/scenario/joints/joints.h"
#include "livens/io/scenario/loads/load_makers.h"

namespace livens::inline io_internal {

namespace {

Matrix<6, 6> read_matrix(const Section& load, std::string_view key)
{
    Matrix<6, 6> matrix{};
    const Value* v = load.find(key);
    for (int i = 0; v != nullptr && i < 6; ++i)
        for (int j = 0; j < 6; ++j)
            // Six numbers are a diagonal: most data sheets have no coupling.
            if (v->numbers.size() == 36)
                matrix(i, j) = v->numbers[6 * i + j];
            else if (i == j)
                matrix(i, j) = v->numbers[i];
    return matrix;
}

/// At a point of the world with its axes, or by frames.
BodyFrame read_bushing_frame(const LoadSources& p, std::size_t i)
{
    const std::span<const Section> frames = p.section.sections("frames");
    const int body = i == 0 ? p.first : p.second;
    if (frames.size() == 2)
        return {p.builder.in_axes(body, frames[i].vector("point")), read_orientation(frames[i])};
    const Matrix34& X = p.builder.start_configuration(body);
    // The frame has the axes of the world at the start, in coordinates of the body.
    return {transpose(directors(X)) * (p.section.vector("at") - X.column(0)), transpose(directors(X))};
}

}   // namespace

bool check_bushing(const Section& load)
{
    if (!load.at_most_one({"at", "frames"}, "joint-placement")) return false;
    if (!load.has("at") && !load.has("frames"))
        return load.error("", "joint-placement", load.label() + " lacks its place",
                          {"", "give 'at', its point in the world at the start, or 'frames'"});
    bool is_good = check_frames(load);
    for (const std::string_view key : {"stiffness", "damping", "preload"}) {
        const Value* v = load.find(key);
        const std::size_t n = v == nullptr ? 6 : v->numbers.size();
        if (n == 6 || (n == 36 && key != "preload")) continue;
        is_good = load.error(key, "bushing-matrix",
                             "'" + std::string(key) + "' of " + load.label() + " has " + std::to_string(n) +
                                 " numbers",
                             {"", key == "preload" ? "give six: forces, then torques"
                                                   : "give six, of a diagonal matrix, or 36, row by row"});
    }
    return is_good;
}

Load make_bushing(const LoadSources& p)
{
    Bushing law{read_matrix(p.section, "stiffness"), read_matrix(p.section, "damping"), {}};
    law.by_angular_velocity = p.section.text("damping_by") == "angular_velocity";
    if (const Value* v = p.section.find("preload"))
        for (int i = 0; i < 6; ++i) law.preload[i] = v->numbers[i];
    const std::vector<Matrix34> X = p.builder.start_configurations();
    return bushing(p.name, p.first, read_bushing_frame(p, 0), p.second, read_bushing_frame(p, 1), law, X);
}

}   // namespace livens::inline io_internal
