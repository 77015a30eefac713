// SPDX-License-Identifier: BSD-3-Clause
// Densities that are expressions in the place (theory.md, Bodies from meshes, "density that is a field").
// Solids evaluate them inside by quadrature; a closed surface has no inside, and the divergence theorem
// serves linear densities alone, which are recognised here.
#include "livens/io/scenario/bodies/density_fields.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "livens/base/error.h"
#include "livens/time/expression.h"

namespace livens::inline io_internal {

namespace {

/// A word of its own in the text: letters, digits and _ are one.
bool has_word(std::string_view text, std::string_view word)
{
    const auto is_part = [&](std::size_t at) {
        if (at >= text.size()) return false;
        const char c = text[at];
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    };
    for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1))
        if (!(at > 0 && is_part(at - 1)) && !is_part(at + word.size())) return true;
    return false;
}

/// The density of a surface, whose inside has no points to ask at: slopes that are the same at many places,
/// of an expression without bends, are those of a linear one.
LinearDensity linear(const Expression& density, const Mesh& mesh, double unit)
{
    const auto refuse_field = [&](const std::string& why) {
        throw InputError({"density-field", "", "'" + mesh.name + "' is a surface, and its density " + why,
                          "'" + density.text() + "'", "",
                          "what a closed surface says of its inside is enough for linear densities",
                          "give a mesh with elements of volume"});
    };
    if (!density.kink_by_symbols().empty()) refuse_field("bends or jumps");
    LinearDensity found;
    std::array<double, 3> first{};
    const std::size_t n = mesh.points.size(), step = std::max<std::size_t>(1, n / 16);
    for (std::size_t k = 0; k + step < n + step; k += step) {
        // Points between two of the mesh: at the vertices of a symmetric one slopes may agree by accident.
        const Vector3 p = unit * (0.7 * mesh.points[k] + 0.3 * mesh.points[n - 1 - k]);
        std::array<double, 3> slopes{};
        const std::array<double, 3> at{p[0], p[1], p[2]};
        const double value = density(0, at, slopes);
        if (k == 0) first = slopes;
        double size = 0, gap = 0;
        for (int i = 0; i < 3; ++i) {
            size = std::max(size, std::abs(first[i]));
            gap = std::max(gap, std::abs(slopes[i] - first[i]));
        }
        // Slopes agree to 1e-12 of the largest at some sixteen places. Negated, so that nan is refused as
        // well.
        if (!(gap <= 1e-12 * size)) refuse_field("is not linear");
        if (k > 0) continue;
        // Per unit of the mesh, in whose numbers its surface is integrated.
        for (int i = 0; i < 3; ++i) found.gradient[i] = unit * slopes[i];
        found.at_origin = value - dot({slopes[0], slopes[1], slopes[2]}, p);
    }
    return found;
}

Expression density_of(const std::string& text)
{
    if (has_word(text, "t") || text.find('\n') != std::string::npos)
        throw InputError({"density-field", "", "a density does not change with time", "'" + text + "'", "",
                          "it is an expression in x, y and z, on one line", ""});
    return {text, {"x", "y", "z"}};
}

}   // namespace

Moments weighted_by_field(const Mesh& mesh, double unit, const std::string& text)
{
    const Expression density = density_of(text);
    if (!mesh.is_volume()) return scaled(weighted_moments(mesh, linear(density, mesh, unit)), unit);
    const auto value = [&](const Vector3& p) {
        const std::array<double, 3> at{unit * p[0], unit * p[1], unit * p[2]};
        return density(0, at);
    };
    return scaled(weighted_moments(mesh, value), unit);
}

Moments weighted_by_field(const PrimitiveSolid& solid, const std::string& text)
{
    const Expression density = density_of(text);
    return weighted_moments(solid, [&](const Vector3& p) { return density(0, p.a); });
}

}   // namespace livens::inline io_internal
