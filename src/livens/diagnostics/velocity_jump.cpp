// SPDX-License-Identifier: BSD-3-Clause
// The velocity jump h |V - X_h'| of each element, the indicator of elements that do not see the motion, and
// the local error C_p J^q that goes with it: theory.md, "Spurious elements" and "The local error".
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "livens/base/elementary.h"
#include "livens/diagnostics/detail/sampler.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/diagnostics/largest.h"
#include "livens/multibody/model.h"
#include "livens/solvers/patience.h"

namespace livens {

std::vector<double> velocity_jumps(const Model& model, const Motion& motion)
{
    return velocity_jumps(model, motion, 0, motion.n_elements());
}

std::vector<double> velocity_jumps(const Model& model, const Motion& motion, int first, int last)
{
    std::vector<double> jumps(static_cast<std::size_t>(last - first), 0.0);
    const double length = model.length();
    // On Radau points the polynomial meets the velocity at its end but for a projection; the jump is at the
    // start there.
    const bool at_start = motion.X.points == Points::radau;
    const ElementSampler ends(motion, {at_start ? 0.0 : 1.0});
    std::vector<Vector4> centres;
    for (const Body& body : model.bodies())
        centres.push_back(point(body.is_point ? Vector3{} : mass_properties(body.mass).center_of_mass));
    std::vector<Matrix34> slopes(model.bodies().size());
    for (int e = first; e < last; ++e) {
        Patience::ask();
        double& jump = jumps[e - first];
        const double h = motion.mesh.length(e);
        const std::span<const Matrix34> V =
            at_start ? velocities_at_end(motion, e) : velocities_at_end(motion, e + 1, Side::left);
        ends.velocities(e, 0, slopes);
        for (std::size_t b = 0; b < slopes.size(); ++b) {
            const Matrix34 gap = h * (V[b] - slopes[b]);
            // At the centre of mass: a far reference point would multiply the jump by its lever.
            raise_to(jump, norm(gap * centres[b]) / length);
            for (int a = 1; a < 4; ++a) raise_to(jump, norm(gap.column(a)) / std::sqrt(2.0));
        }
    }
    return jumps;
}

VelocityJump velocity_jump(const Model& model, const Motion& motion)
{
    VelocityJump jump;
    const std::vector<double> jumps = velocity_jumps(model, motion);
    for (int e = 0; e < motion.n_elements(); ++e)
        if (raise_to(jump.largest, jumps[e])) jump.time = motion.mesh.ends[e + 1];
    return jump;
}

double local_error(Points points, int degree, double jump)
{
    // p = 1, 2, ..; the last holds for all above.
    static constexpr double of_lobatto[] = {0.44, 0.13, 0.058, 0.04};
    static constexpr double of_radau[] = {0.4, 0.36, 0.35, 0.22, 0.22, 0.17, 0.15};
    const bool is_radau = points == Points::radau;
    const std::span<const double> C = is_radau ? std::span<const double>(of_radau) : of_lobatto;
    const double c = C[std::min(static_cast<std::size_t>(degree), C.size()) - 1];
    return c * power(jump, (2.0 * degree + (is_radau ? 0 : 1)) / (degree + 1));
}

}   // namespace livens
