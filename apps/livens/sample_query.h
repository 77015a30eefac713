// SPDX-License-Identifier: BSD-3-Clause
// What livens sample is asked, and what a run answers of a body or a joint at an instant.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "commands.h"
#include "failure.h"
#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/sample.h"
#include "livens/io/results.h"
#include "livens/io/scenario.h"

namespace livens::program {

struct Query {
    const SampleArguments& arguments;
    const Run& run;
    const Scenario& scenario;
    int index;                                     ///< of the body or joint
    std::optional<JointCoordinates> coordinates;   ///< of a joint
};

State state_at(const Query& q, double t);
BodySample body_at(const Query& q, double t);
/// nan where there is no estimate.
BodyGap body_error(const Query& q, double t);
struct BodyAcceleration {
    Vector3 linear, angular;
};
BodyAcceleration acceleration_at(const Query& q, double t);

JointSample joint_at(const Query& q, double t);
/// Relative to the largest reaction.
double joint_error(const Query& q, double t);
struct CoordinateAt {
    std::string name;
    const JointCoordinate* of;
    CoordinateValue value;
};
/// Those of the joint that is asked for.
std::vector<CoordinateAt> coordinates_at(const Query& q, double t);

/// The model, with sensors of its points and loads, which are read without one.
Model with_all_readings(const Model& model);
/// That there is no "body", "joint" or "sensor" of that name: what there is, or of what kind the name is.
Failure no_such(std::string_view kind, const std::string& name, const Model& model);

/// Known where the growth of perturbations is.
std::optional<bool> beyond_horizon(const Query& q, double t);

/// For people, and as a table; in the units that are wished.
std::string text_of(const Query& q, double t);
std::string csv_of(const Query& q, const std::vector<double>& times);
/// SI units of what both show.
std::vector<std::string> units_shown(const Query& q);

}   // namespace livens::program
