// SPDX-License-Identifier: BSD-3-Clause
// Bodies, joints, sensors and estimated errors at the output times.
// All of it follows from the motion in the same file (docs/results.md, Samples at the output times). It is
// written for readers that want curves and do not interpolate polynomials themselves.
#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/rigidity.h"
#include "livens/diagnostics/sample.h"
#include "livens/io/results/writing.h"

namespace livens {

namespace {

constexpr std::size_t chunk = 1u << 15;   // numbers of samples that are held at a time

template <class Values>
void append(std::vector<double>& out, const Values& values)
{
    out.insert(out.end(), values.data(), values.data() + Values::rows * Values::cols);
}

/// A variable that is filled piece by piece.
struct Column {
    int variable;
    std::vector<double> values{};
};

using BodyPart = std::variant<Vector3 BodySample::*, Vector4 BodySample::*, Matrix3 BodySample::*>;

struct BodyVariable {
    const char* name;
    const char* units;
    const char* frame;
    const char* long_name;
    BodyPart part;
};

constexpr BodyVariable body_variables[] = {
    {"position", "m", "inertial", "position of the reference point", &BodySample::position},
    {"center_of_mass", "m", "inertial", "position of the centre of mass", &BodySample::center_of_mass},
    {"directors", "1", "inertial", "directors [d1, d2, d3], the rigid triad nearest to those of the motion",
     &BodySample::directors},
    {"directors_raw", "1", "inertial",
     "directors [d1, d2, d3] of the motion, with their violation of rigidity", &BodySample::directors_raw},
    {"quaternion", "1", "inertial", "orientation, body to world; sign continuous in time",
     &BodySample::quaternion},
    {"velocity", "m s-1", "inertial", "velocity of the reference point", &BodySample::velocity},
    {"angular_velocity", "rad s-1", "inertial", "angular velocity in inertial axes",
     &BodySample::angular_velocity},
    {"angular_velocity_body", "rad s-1", "body-fixed", "angular velocity in body axes",
     &BodySample::angular_velocity_body},
    {"linear_momentum", "kg m s-1", "inertial", "linear momentum", &BodySample::linear_momentum},
    {"angular_momentum", "kg m2 s-1", "inertial", "angular momentum about the world's origin",
     &BodySample::angular_momentum},
};

VariableInfo info_of(const BodyVariable& v)
{
    VariableInfo info{v.name, {"time", "body", "xyz"}, v.units, v.frame, v.long_name};
    if (v.part.index() == 2) info.dimensions = {"time", "body", "director", "xyz"};
    if (v.part.index() == 1) {
        info.dimensions = {"time", "body", "quaternion_part"};
        info.attributes = {{"order", "w, x, y, z"}};
    }
    return info;
}

struct ErrorVariable {
    VariableInfo info;
    std::vector<double> ErrorEstimate::*errors;
};

/// Beside what they judge.
const std::vector<ErrorVariable>& error_variables()
{
    static const std::vector<ErrorVariable> all{
        {{"estimated_position_error",
          {"time", "body"},
          "1",
          "none",
          "estimated error of the centre of mass, in lengths of the model (model_length)"},
         &ErrorEstimate::position},
        {{"estimated_orientation_error",
          {"time", "body"},
          "rad",
          "none",
          "estimated error of the orientation; 0 for point masses"},
         &ErrorEstimate::orientation},
        {{"estimated_velocity_error",
          {"time", "body"},
          "m s-1",
          "none",
          "estimated error of the velocity of the centre of mass"},
         &ErrorEstimate::velocity},
        {{"estimated_reaction_error",
          {"time", "joint"},
          "1",
          "none",
          "estimated error of force, or torque by model_length, relative to largest_reaction"},
         &ErrorEstimate::reaction}};
    return all;
}

struct CoordinateVariable {
    std::string name;   ///< of a NamedCoordinate
    std::string dimension;
    const char *units, *meaning, *rate_units, *rate_meaning;
};

const std::array<CoordinateVariable, 2> coordinate_variables{
    {{"angle", "angle", "rad", "angle of the joint since the start, turns counted", "rad s-1",
      "rate of the joint's angle"},
     {"displacement", "displacement", "m", "displacement of the joint since the start", "m s-1",
      "rate of the joint's displacement"}}};

/// Samples at the output times that the motion has reached, some instants at a time.
class Samples {
public:
    Samples(RunWriter& archive, const Model& model, const Run& run)
        : file_(archive.file()), model_(model), motion_(run.motion), estimate_(run.estimate),
          is_to_accuracy_(run.report.accuracy > 0), of_joints_(model, run.motion),
          of_rigidity_(model, run.motion), sensors_(model, run.motion)
    {
        // A motion that ended early has samples as far as it goes, and none beyond.
        const auto first = std::ranges::lower_bound(run.output, motion_.start());
        const auto last = std::ranges::upper_bound(run.output, motion_.end());
        times_ = {first, last};
        if (times_.empty()) return;
        const VariableInfo time{
            "time", {"time"}, "s", "none", "output times that the motion has reached", {{"axis", "T"}}};
        archive.view(time, NumberType::real, times_);
        if (!run.growth.empty()) {
            // Behind the horizon a sample is one of many motions (theory.md, The horizon), which plots should
            // show.
            std::vector<bool> beyond;
            for (const double t : times_) beyond.push_back(run.verdict.is_beyond_horizon(t));
            const char* const meaning = "1: rounding at the start decides which of many motions is shown";
            archive.flags({"beyond_horizon", {"time"}, "1", "none", meaning}, beyond);
        }
        const std::size_t n = times_.size() * model.bodies().size();
        for (const BodyVariable& v : body_variables) {
            const std::size_t sizes[] = {3, 4, 9};   // of the alternatives of BodyPart
            if (n > 0)
                bodies_.push_back({archive.declare(info_of(v), NumberType::real, n * sizes[v.part.index()])});
        }
        // A quaternion and its negative are one orientation; each takes the sign nearest to the sample before
        // it.
        previous_.resize(model.bodies().size(), Vector4{1, 0, 0, 0});
        declare_rigidity(archive);
        declare_errors(archive);
        declare_coordinates(archive);
        declare_sensors(archive);
        const bool has_multipliers = !motion_.end_multipliers.empty() || !motion_.multipliers.empty();
        if (model.joints().empty() || !has_multipliers) return;
        const std::vector<std::string> sides{"time", "joint", "side", "xyz"};
        const std::size_t n_joint = times_.size() * model.joints().size() * 6;
        const auto joint = [&](const char* name, const char* units, const char* long_name) {
            joints_.push_back(
                {archive.declare({name, sides, units, "inertial", long_name}, NumberType::real, n_joint)});
        };
        joint("reaction_force", "N", "force of the joint on its second body, from both sides");
        joint("reaction_torque", "N m",
              "torque of the joint on its second body about its joint point, from both sides");
    }

    void write()
    {
        std::size_t held = 0;
        for (const double t : times_) {
            if (!bodies_.empty()) add_bodies(t);
            if (!joints_.empty()) add_joints(t);
            if (!rigidity_.empty()) add_rigidity(t);
            add_errors(t);
            if (!coordinates_.empty()) add_coordinates(t);
            if (!readings_.empty()) append_all(readings_[0], sensors_.at(t));
            // Samples of long motions of many bodies exceed the memory: they go to the file in pieces. The
            // sum estimates the numbers of one instant, so that a piece has about `chunk` of them.
            held += 68 * model_.bodies().size() + 12 * model_.joints().size() + 6 * model_.sensors().size();
            if (held < chunk) continue;
            flush();
            held = 0;
        }
        flush();
    }

private:
    void declare_errors(RunWriter& archive)
    {
        const std::size_t n_ends = motion_.mesh.ends.size();
        for (const ErrorVariable& v : error_variables()) {
            const std::vector<double>& errors = estimate_.*v.errors;
            if (errors.empty()) continue;
            const std::size_t n = times_.size() * (errors.size() / n_ends);
            errors_.push_back({archive.declare(v.info, NumberType::real, n)});
            errors_at_ends_.push_back(&errors);
        }
    }

    /// What keeps bodies rigid, and their volumes, by which it becomes a stress.
    void declare_rigidity(RunWriter& archive)
    {
        std::vector<double> volumes;
        for (const Body& body : model_.bodies())
            // Without a shape there is no volume and no mean stress: nan says that nothing is known.
            volumes.push_back(body.volume > 0 ? body.volume : std::numeric_limits<double>::quiet_NaN());
        if (volumes.empty()) return;
        const std::size_t n = times_.size() * volumes.size() * 6;
        archive.list({"body_volume", {"body"}, "m3", "none", "volume of the body's shape"},
                     std::move(volumes));
        archive.names("rigidity_row", "components of rigidity_stress", {"11", "22", "33", "12", "13", "23"});
        const char* const meaning =
            "multipliers of the body's rigidity along its directors: its second Piola-Kirchhoff stress, "
            "summed up over the volume; tension is positive";
        rigidity_.push_back({archive.declare(
            {"rigidity_stress", {"time", "body", "rigidity_row"}, "N m", "body-fixed", meaning},
            NumberType::real, n)});
    }

    void add_rigidity(double t)
    {
        for (const RigiditySample& s : of_rigidity_.at(t)) {
            const Matrix3& m = s.right;
            append(rigidity_[0].values, Matrix<6, 1>{m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)});
        }
    }

    /// Output times are element ends; at another instant nothing is known of the polynomial's error.
    void add_errors(double t)
    {
        // The estimate compares two solutions at element ends (theory.md, The estimated error).
        const int end = element_end_at(motion_.mesh, snap_to_element_end(motion_.mesh, t));
        for (std::size_t i = 0; i < errors_.size(); ++i) {
            const std::size_t n = errors_at_ends_[i]->size() / motion_.mesh.ends.size();
            const auto first = errors_at_ends_[i]->begin() + static_cast<std::ptrdiff_t>(n) * end;
            std::vector<double>& values = errors_[i].values;
            if (end >= 0)
                values.insert(values.end(), first, first + static_cast<std::ptrdiff_t>(n));
            else if (is_to_accuracy_)   // inside since the joints lose rank there, which the estimate knows
                for (std::size_t k = 0; k < n; ++k)
                    values.push_back(ErrorEstimate::at(*errors_at_ends_[i], static_cast<int>(n),
                                                       static_cast<int>(k), motion_.mesh, t));
            else
                values.insert(values.end(), n, std::numeric_limits<double>::quiet_NaN());
        }
    }

    /// Angles and displacements each in a variable of their own, with names of the joints that have them.
    void declare_coordinates(RunWriter& archive)
    {
        for (std::size_t kind = 0; kind < coordinate_variables.size(); ++kind) {
            const CoordinateVariable& v = coordinate_variables[kind];
            std::vector<std::string> names;
            for (std::size_t i = 0; i < of_joints_.places().size(); ++i)
                if (of_joints_.coordinate(static_cast<int>(i)).name == v.name)
                    names.push_back(model_.joints()[of_joints_.places()[i].joint].name);
            if (names.empty()) continue;
            archive.names(v.dimension, "joints that have one", names);
            const std::size_t n = times_.size() * names.size();
            for (const bool is_rate : {false, true}) {
                const VariableInfo info{"joint_" + v.name + (is_rate ? "_rate" : ""),
                                        {"time", v.dimension},
                                        is_rate ? v.rate_units : v.units,
                                        "none",
                                        is_rate ? v.rate_meaning : v.meaning};
                coordinates_.push_back({archive.declare(info, NumberType::real, n)});
            }
            kinds_.push_back(v.name);
        }
    }

    /// One variable for all, whose units differ.
    void declare_sensors(RunWriter& archive)
    {
        std::vector<std::string> names, units;
        for (const Sensor& sensor : model_.sensors())
            for (const SensorComponent& component : sensor.components) {
                names.push_back(sensor.name + "." + component.name);
                units.push_back(component.unit);
            }
        if (names.empty()) return;
        archive.names("reading", "what a sensor reads", names);
        archive.names("reading_unit", "its unit", units, "reading");
        const VariableInfo info{
            "sensor_value", {"time", "reading"}, "1", "none", "what sensors read, in units of reading_unit"};
        readings_.push_back({archive.declare(info, NumberType::real, times_.size() * names.size())});
    }

    static void append_all(Column& column, const std::vector<double>& values)
    {
        column.values.insert(column.values.end(), values.begin(), values.end());
    }

    void add_coordinates(double t)
    {
        const std::vector<CoordinateValue> values = of_joints_.at(t);
        for (std::size_t i = 0; i < values.size(); ++i) {
            const auto kind = std::ranges::find(kinds_, of_joints_.coordinate(static_cast<int>(i)).name);
            const std::size_t column = 2 * static_cast<std::size_t>(kind - kinds_.begin());
            coordinates_[column].values.push_back(values[i].value);
            coordinates_[column + 1].values.push_back(values[i].rate);
        }
    }

    void flush()
    {
        for (auto* columns : {&bodies_, &rigidity_, &joints_, &errors_, &coordinates_, &readings_})
            for (Column& column : *columns) {
                file_.append(column.variable, std::span<const double>(column.values));
                column.values.clear();
            }
    }

    void add_bodies(double t)
    {
        std::vector<BodySample> samples = sample_bodies(model_, motion_, t);
        for (std::size_t b = 0; b < samples.size(); ++b) {
            previous_[b] = samples[b].quaternion = continued(previous_[b], samples[b].quaternion);
            for (std::size_t i = 0; i < bodies_.size(); ++i)
                std::visit([&](auto part) { append(bodies_[i].values, samples[b].*part); },
                           body_variables[i].part);
        }
    }

    void add_joints(double t)
    {
        std::vector<JointSample> samples = sample_joints(model_, motion_, t);
        if (samples.empty()) {   // this instant has no multipliers, others have
            const double nan = std::numeric_limits<double>::quiet_NaN();
            const Reaction none{{nan, nan, nan}, {nan, nan, nan}};
            samples.assign(model_.joints().size(), {none, none, false, false, false});
        }
        for (const JointSample& joint : samples) {
            append(joints_[0].values, joint.left.force);
            append(joints_[0].values, joint.right.force);
            append(joints_[1].values, joint.left.torque);
            append(joints_[1].values, joint.right.torque);
        }
    }

    ClassicWriter& file_;
    const Model& model_;
    const Motion& motion_;
    const ErrorEstimate& estimate_;
    bool is_to_accuracy_;
    std::span<const double> times_;
    JointCoordinates of_joints_;
    Rigidity of_rigidity_;
    SensorReadings sensors_;
    std::vector<Column> bodies_, rigidity_, joints_, errors_, coordinates_, readings_;
    std::vector<std::string> kinds_;   // of coordinates_, in pairs of value and rate
    std::vector<const std::vector<double>*> errors_at_ends_;
    std::vector<Vector4> previous_;
};

}   // namespace

void write_samples(RunWriter& archive, const Model& model, const Run& run)
{
    const auto samples = std::make_shared<Samples>(archive, model, run);
    archive.later([samples] { samples->write(); });
}

}   // namespace livens
