// SPDX-License-Identifier: BSD-3-Clause
// Functions of Python as loads: slow, for trying out.
#pragma once

#include <string>

#include <nanobind/nanobind.h>

#include "livens/multibody/model.h"

namespace livens::python {

/// `function(t, position, directors, velocity, angular_velocity)` gives force (N) and torque (N m) on the
/// body, at its reference point, in world axes, as (fx, fy, fz, mx, my, mz). The tangent is made of
/// differences. What it raises is raised by solve(). Throws InputError for an unknown body.
void add_python_load(Model& model, const std::string& name, const std::string& body,
                     nanobind::object function);

/// The condition of an event becomes `function(t, input, ..)`, true where that is positive; its terms are the
/// inputs. What it raises is raised by solve(). Throws InputError for an unknown event.
void add_python_guard(Model& model, const std::string& event, nanobind::object function);

}   // namespace livens::python
