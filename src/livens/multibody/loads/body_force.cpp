// SPDX-License-Identifier: BSD-3-Clause
// A force per unit mass: F = b w^T with the first column w of m (P20), theory.md, "Bodies from meshes", Loads
// on surfaces.
#include "livens/multibody/loads/load_values.h"
#include "livens/multibody/loads/surface_loads.h"

namespace livens {

Load body_force(const std::string& name, int body, const Matrix4& mass_matrix, const TimeVector& value,
                Frame frame)
{
    return uniform_load(name, "body_force", body, mass_matrix.column(0), value, frame, "m/s^2");
}

}   // namespace livens
