// SPDX-License-Identifier: BSD-3-Clause
// Bodies, joints, sensors and estimated errors at the output times.
// All of it follows from the motion in the same file (docs/results.md, Samples at the output times). It is
// written for readers that want curves and do not interpolate polynomials themselves.
#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/rigidity.h"
#include "livens/diagnostics/sample.h"
#include "livens/io/results/writing.h"
#include "livens/multibody/model.h"

namespace livens::inline io_internal {

namespace {

constexpr double unknown_number = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t chunk = 1u << 15;   // numbers of samples that are held at a time

/// One by one: they are few, and there is room.
void append(std::vector<double>& out, const double* numbers, std::size_t n)
{
    for (std::size_t i = 0; i < n; ++i) out.push_back(numbers[i]);
}

template <class Values>
void append(std::vector<double>& out, const Values& values)
{
    append(out, values.data(), static_cast<std::size_t>(Values::rows * Values::cols));
}

/// A variable that is filled piece by piece.
struct Column {
    int variable;
    std::vector<double> values{};
};

/// Numbers of a sample, one after the other.
struct BodyPart {
    const double* (*of)(const BodySample& sample);
    std::size_t size;
};
template <auto part>
constexpr BodyPart body_part{[](const BodySample& sample) { return (sample.*part).data(); },
                             sizeof(std::declval<BodySample>().*part) / sizeof(double)};

struct BodyVariable {
    const char* name;
    const char* units;
    const char* frame;
    const char* long_name;
    BodyPart part;
};

constexpr BodyVariable body_variables[] = {
    {"position", "m", "inertial", "position of the reference point", body_part<&BodySample::position>},
    {"center_of_mass", "m", "inertial", "position of the centre of mass",
     body_part<&BodySample::center_of_mass>},
    {"directors", "1", "inertial", "directors [d1, d2, d3], the rigid triad nearest to those of the motion",
     body_part<&BodySample::directors>},
    {"directors_raw", "1", "inertial",
     "directors [d1, d2, d3] of the motion, with their violation of rigidity",
     body_part<&BodySample::directors_raw>},
    {"quaternion", "1", "inertial", "orientation, body to world; sign continuous in time",
     body_part<&BodySample::quaternion>},
    {"velocity", "m s-1", "inertial", "velocity of the reference point", body_part<&BodySample::velocity>},
    {"angular_velocity", "rad s-1", "inertial", "angular velocity in inertial axes",
     body_part<&BodySample::angular_velocity>},
    {"angular_velocity_body", "rad s-1", "body-fixed", "angular velocity in body axes",
     body_part<&BodySample::angular_velocity_body>},
    {"linear_momentum", "kg m s-1", "inertial", "linear momentum", body_part<&BodySample::linear_momentum>},
    {"angular_momentum", "kg m2 s-1", "inertial", "angular momentum about the world's origin",
     body_part<&BodySample::angular_momentum>},
};

VariableInfo info_of(const BodyVariable& v)
{
    VariableInfo info{v.name, {"time", "body", "xyz"}, v.units, v.frame, v.long_name};
    if (v.part.size == 9) info.dimensions = {"time", "body", "director", "xyz"};
    if (v.part.size == 4) {
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
          "estimated error of the centre of mass, in model lengths (model_length)"},
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

const std::array<CoordinateVariable, 5> coordinate_variables{
    {{"angle", "angle", "rad", "angle of the joint since the start, turns counted", "rad s-1",
      "rate of the joint's angle"},
     {"angle_1", "angle_1", "rad", "first angle of the joint, turns counted", "rad s-1",
      "rate of the joint's first angle"},
     {"angle_2", "angle_2", "rad",
      "second angle of the joint: of a universal joint with turns, of a ball joint within 90 degrees",
      "rad s-1", "rate of the joint's second angle"},
     {"angle_3", "angle_3", "rad", "third angle of the joint, turns counted", "rad s-1",
      "rate of the joint's third angle"},
     {"displacement", "displacement", "m", "displacement of the joint since the start", "m s-1",
      "rate of the joint's displacement"}}};

/// Variables that are filled instant by instant. Without columns `add` is not called.
struct Sampled {
    std::vector<Column> columns{};
    std::function<void(std::vector<Column>& columns, const State& state)> add{};
};

Sampled sampled_bodies(RunWriter& archive, const Model& model, const Motion& motion, std::size_t n_times)
{
    Sampled sampled;
    const std::size_t n = n_times * model.bodies().size();
    for (const BodyVariable& v : body_variables)
        if (n > 0)
            sampled.columns.push_back({archive.declare(info_of(v), NumberType::real, n * v.part.size)});
    std::vector<Vector4> before(model.bodies().size(), Vector4{1, 0, 0, 0});
    sampled.add = [&model, &motion, before](std::vector<Column>& columns, const State& state) mutable {
        std::vector<BodySample> samples = sample_bodies(model, motion, state);
        for (std::size_t b = 0; b < samples.size(); ++b) {
            before[b] = samples[b].quaternion = continued(before[b], samples[b].quaternion);
            for (std::size_t i = 0; i < columns.size(); ++i) {
                const BodyPart& part = body_variables[i].part;
                append(columns[i].values, part.of(samples[b]), part.size);
            }
        }
    };
    return sampled;
}

/// What keeps bodies rigid, and their volumes, by which it becomes a stress.
Sampled sampled_rigidity(RunWriter& archive, const Model& model, const Motion& motion, std::size_t n_times,
                         const JointSampler& joints)
{
    std::vector<double> volumes;
    for (const Body& body : model.bodies()) volumes.push_back(body.volume > 0 ? body.volume : unknown_number);
    if (volumes.empty()) return {};
    const std::size_t n = n_times * volumes.size() * 6;
    archive.list({"body_volume", {"body"}, "m3", "none", "volume of the body's shape"}, std::move(volumes));
    archive.names("rigidity_row", "components of rigidity_stress", {"11", "22", "33", "12", "13", "23"});
    const char* const meaning =
        "multipliers of the body's rigidity along its directors: its second Piola-Kirchhoff stress, "
        "summed up over the volume; tension is positive";
    const VariableInfo info{
        "rigidity_stress", {"time", "body", "rigidity_row"}, "N m", "body-fixed", meaning};
    const auto add = [rigidity = Rigidity(model, motion), joints](std::vector<Column>& columns,
                                                                  const State& state) {
        for (const RigiditySample& s : rigidity.at_sample(state, &joints)) {
            const Matrix3& m = s.right;
            append(columns[0].values, Matrix<6, 1>{m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)});
        }
    };
    return {{{archive.declare(info, NumberType::real, n)}}, add};
}

/// Output times are element ends; at another instant nothing is known of the polynomial's error.
Sampled sampled_errors(RunWriter& archive, const Run& run, std::size_t n_times)
{
    Sampled sampled;
    std::vector<const std::vector<double>*> at_ends;
    const TimeMesh& mesh = run.motion.mesh;
    for (const ErrorVariable& v : error_variables()) {
        const std::vector<double>& errors = run.estimate.*v.errors;
        if (errors.empty()) continue;
        const std::size_t n = n_times * (errors.size() / mesh.ends.size());
        sampled.columns.push_back({archive.declare(v.info, NumberType::real, n)});
        at_ends.push_back(&errors);
    }
    sampled.add = [&run, &mesh, at_ends](std::vector<Column>& columns, const State& state) {
        const double t = state.t;
        const int end = element_end_at(mesh, t);
        for (std::size_t i = 0; i < columns.size(); ++i) {
            const std::size_t n = at_ends[i]->size() / mesh.ends.size();
            const auto first = at_ends[i]->begin() + static_cast<std::ptrdiff_t>(n) * end;
            std::vector<double>& values = columns[i].values;
            if (end >= 0)
                values.insert(values.end(), first, first + static_cast<std::ptrdiff_t>(n));
            else if (run.report.accuracy > 0)   // inside since the joints lose rank there, which is known
                for (std::size_t k = 0; k < n; ++k)
                    values.push_back(
                        ErrorEstimate::at(*at_ends[i], static_cast<int>(n), static_cast<int>(k), mesh, t));
            else
                values.insert(values.end(), n, unknown_number);
        }
    };
    return sampled;
}

/// Angles and displacements each in a variable of their own, with names of the joints that have them.
Sampled sampled_coordinates(RunWriter& archive, const Model& model, const Motion& motion, std::size_t n_times)
{
    Sampled sampled;
    const JointCoordinates of_joints(model, motion);
    std::vector<std::string> kinds;   // in pairs of value and rate
    for (const CoordinateVariable& v : coordinate_variables) {
        std::vector<std::string> names;
        for (std::size_t i = 0; i < of_joints.places().size(); ++i)
            if (of_joints.coordinate(static_cast<int>(i)).name == v.name)
                names.push_back(model.joints()[of_joints.places()[i].joint].name);
        if (names.empty()) continue;
        archive.names(v.dimension, "joints that have one", names);
        const std::size_t n = n_times * names.size();
        for (const bool is_rate : {false, true}) {
            const VariableInfo info{"joint_" + v.name + (is_rate ? "_rate" : ""),
                                    {"time", v.dimension},
                                    is_rate ? v.rate_units : v.units,
                                    "none",
                                    is_rate ? v.rate_meaning : v.meaning};
            sampled.columns.push_back({archive.declare(info, NumberType::real, n)});
        }
        kinds.push_back(v.name);
    }
    sampled.add = [of_joints, kinds](std::vector<Column>& columns, const State& state) {
        const std::vector<CoordinateValue> values = of_joints.at(state);
        for (std::size_t i = 0; i < values.size(); ++i) {
            const auto kind = std::ranges::find(kinds, of_joints.coordinate(static_cast<int>(i)).name);
            const std::size_t column = 2 * static_cast<std::size_t>(kind - kinds.begin());
            columns[column].values.push_back(values[i].value);
            columns[column + 1].values.push_back(values[i].rate);
        }
    };
    return sampled;
}

/// One variable for all, whose units differ.
Sampled sampled_sensors(RunWriter& archive, const Model& model, const Motion& motion, std::size_t n_times)
{
    std::vector<std::string> names, units;
    for (const Sensor& sensor : model.sensors())
        for (const SensorComponent& component : sensor.components) {
            names.push_back(sensor.name + "." + component.name);
            units.push_back(component.unit);
        }
    if (names.empty()) return {};
    archive.names("reading", "what a sensor reads", names);
    archive.names("reading_unit", "its unit", units, "reading");
    const VariableInfo info{
        "sensor_value", {"time", "reading"}, "1", "none", "what sensors read, in units of reading_unit"};
    const auto add = [sensors = SensorReadings(model, motion)](std::vector<Column>& columns,
                                                               const State& state) {
        const std::vector<double> read = sensors.at(state.t);
        columns[0].values.insert(columns[0].values.end(), read.begin(), read.end());
    };
    return {{{archive.declare(info, NumberType::real, n_times * names.size())}}, add};
}

Sampled sampled_reactions(RunWriter& archive, const Model& model, const Motion& motion, std::size_t n_times,
                          const JointSampler& joints)
{
    const bool has_multipliers = !motion.end_multipliers.empty() || !motion.multipliers.empty();
    if (model.joints().empty() || !has_multipliers) return {};
    const std::vector<std::string> sides{"time", "joint", "side", "xyz"};
    const auto declare = [&](const char* name, const char* units, const char* meaning) {
        return Column{archive.declare({name, sides, units, "inertial", meaning}, NumberType::real,
                                      n_times * model.joints().size() * 6)};
    };
    const auto add = [&model, joints](std::vector<Column>& columns, const State& state) {
        std::vector<JointSample> samples = joints.at(state);
        if (samples.empty()) {   // this instant has no multipliers, others have
            const Reaction none{{unknown_number, unknown_number, unknown_number},
                                {unknown_number, unknown_number, unknown_number}};
            samples.assign(model.joints().size(), {none, none, false, false, false});
        }
        for (const JointSample& joint : samples) {
            append(columns[0].values, joint.left.force);
            append(columns[0].values, joint.right.force);
            append(columns[1].values, joint.left.torque);
            append(columns[1].values, joint.right.torque);
        }
    };
    return {{declare("reaction_force", "N", "force of the joint on its second body, from both sides"),
             declare("reaction_torque", "N m",
                     "torque of the joint on its second body about its joint point, from both sides")},
            add};
}

/// Samples at the output times that the motion has reached, some instants at a time.
class Samples {
public:
    Samples(RunWriter& archive, const Model& model, const Run& run)
        : file_(archive.file()), motion_(run.motion)
    {
        const Motion& motion = run.motion;
        // A motion that ended early has samples as far as it goes, and none beyond.
        const auto first = std::ranges::lower_bound(run.output, motion.start());
        const auto last = std::ranges::upper_bound(run.output, motion.end());
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
        const std::size_t n = times_.size();
        const JointSampler joints(model, motion);   // whose copies share what they find
        parts_.push_back(sampled_bodies(archive, model, motion, n));
        parts_.push_back(sampled_rigidity(archive, model, motion, n, joints));
        parts_.push_back(sampled_errors(archive, run, n));
        parts_.push_back(sampled_coordinates(archive, model, motion, n));
        parts_.push_back(sampled_sensors(archive, model, motion, n));
        parts_.push_back(sampled_reactions(archive, model, motion, n, joints));
        at_an_instant_ = 68 * model.bodies().size() + 12 * model.joints().size() + 6 * model.sensors().size();
    }

    void write()
    {
        std::size_t held = 0;
        for (const double t : times_) {
            const State state = sample_state(motion_, t);
            for (Sampled& part : parts_)
                if (!part.columns.empty()) part.add(part.columns, state);
            held += at_an_instant_;
            if (held < chunk) continue;
            flush();
            held = 0;
        }
        flush();
    }

private:
    void flush()
    {
        for (Sampled& part : parts_)
            for (Column& column : part.columns) {
                file_.append(column.variable, std::span<const double>(column.values));
                column.values.clear();
            }
    }

    ClassicWriter& file_;
    const Motion& motion_;
    std::span<const double> times_;
    std::vector<Sampled> parts_;
    std::size_t at_an_instant_ = 0;   // numbers
};

}   // namespace

void write_samples(RunWriter& archive, const Model& model, const Run& run)
{
    const auto samples = std::make_shared<Samples>(archive, model, run);
    archive.later([samples] { samples->write(); });
}

}   // namespace livens::inline io_internal
