// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <vector>

#include "livens/diagnostics/detail/largest.h"
#include "livens/diagnostics/detail/sampler.h"
#include "livens/diagnostics/diagnostics.h"

namespace livens {

VelocityJump velocity_jump(const Model& model, const Motion& motion)
{
    VelocityJump jump;
    const double length = model.length();
    const ElementSampler ends(motion, {1.0});
    std::vector<Vector4> centres;
    for (const Body& body : model.bodies())
        centres.push_back(point(body.is_point ? Vector3{} : mass_properties(body.mass).center_of_mass));
    std::vector<Matrix34> slopes(model.bodies().size());
    for (int e = 0; e < motion.n_elements(); ++e) {
        const double h = motion.mesh.length(e);
        const std::span<const Matrix34> V = velocities_at_end(motion, e + 1);
        ends.velocities(e, 0, slopes);
        for (std::size_t b = 0; b < slopes.size(); ++b) {
            const Matrix34 gap = h * (V[b] - slopes[b]);
            bool is_worse = raise_to(jump.largest, norm(gap * centres[b]) / length);
            for (int a = 1; a < 4; ++a)
                is_worse = raise_to(jump.largest, norm(gap.column(a)) / std::sqrt(2.0)) || is_worse;
            if (is_worse) jump.time = motion.mesh.ends[e + 1];
        }
    }
    return jump;
}

}   // namespace livens
