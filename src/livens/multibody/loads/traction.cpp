// SPDX-License-Identifier: BSD-3-Clause
#include "livens/multibody/detail/load_values.h"
#include "livens/multibody/surface_loads.h"

namespace livens {

Load traction(const std::string& name, int body, const SurfaceMoments& surface, const TimeVector& value,
              Frame frame)
{
    return uniform_load(name, "traction", body, surface.area, value, frame, "Pa");
}

}   // namespace livens
