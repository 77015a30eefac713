// SPDX-License-Identifier: BSD-3-Clause
// From the sections of a scenario to a model: one object that the parts of the reader fill together.
#pragma once

#include <array>
#include <map>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "livens/base/error.h"
#include "livens/io/scenario.h"
#include "livens/io/scenario/bodies/meshes.h"
#include "livens/io/scenario/schema/section.h"
#include "livens/multibody/loads/load_laws.h"
#include "livens/time/expression.h"

namespace livens {

/// What a name in `between` or `body` stands for.
struct BodyReference {
    int index = world;
    bool is_usable = false;   ///< the world, or a body in order; to refer to another one is no second error
};

class Builder {
public:
    Builder(const Section& top, const MeshSource& meshes, Findings& findings);

    const Section& top() const { return top_; }
    Findings& findings() { return findings_; }
    Model& model() { return model_; }
    const Model& model() const { return model_; }
    std::vector<Outline>& outlines() { return outlines_; }                     ///< of the bodies so far
    std::vector<std::vector<ShapePart>>& parts() { return parts_; }            ///< of the bodies so far
    std::vector<std::vector<NamedSurface>>& surfaces() { return surfaces_; }   ///< of the bodies so far
    MeshStore& meshes() { return meshes_; }
    /// Call once all bodies are there: computes length().
    void close_bodies();
    std::unordered_map<std::string, BodyReference>& bodies() { return bodies_; }

    /// Makes `path` known as the place of the section, and its keys as `path.key`.
    void remember(const std::string& path, const Section& section);
    /// Makes `path` known as this place, unless it is known.
    void remember(const std::string& path, const SourceLocation& place) { places_.try_emplace(path, place); }
    /// Calls `build` and turns an InputError into a finding at the place it names, else at that of `path`.
    /// False if there was one.
    template <class Build>
    bool guard(const std::string& path, Build build)
    {
        try {
            build();
            return true;
        } catch (const InputError& error) {
            report(error.complaint(), path);
            return false;
        }
    }

    /// The body of a name in a section; an unknown one is reported at `place`.
    BodyReference find_body(const std::string& name, const SourceLocation& place, const Section& section);
    /// Both of `between`; false unless both can be used. `self` is the code of one body named twice.
    bool find_pair(const Section& section, std::string_view self, BodyReference& first,
                   BodyReference& second);

    /// That nothing of a kind ("joint", "load") has the name. Of one that is there and faulty, which was
    /// told, no more is said.
    InputError unknown_name(const std::string& kind, const std::string& name, const std::string& path,
                            const std::vector<std::string_view>& known) const;

    /// X of a body at the start, or of the world.
    const Matrix34& start_configuration(int body) const;
    /// From components along a body's directors, as its coordinates are stated, to those of its orthonormal
    /// triad.
    const Matrix3& stretch(int body) const;
    Vector3 in_axes(int body, const Vector3& components) const { return stretch(body) * components; }
    /// What violations of joints are measured by: the model's length; 1 m for a model without extent.
    double length() const { return length_; }
    std::string body_name(int body) const { return model_.body_name(body); }
    bool is_point(int body) const { return body != world && model_.bodies()[body].is_point; }

private:
    void report(const Complaint& complaint, const std::string& path);
    SourceLocation find_place(std::string path, const std::string& context) const;

    const Section& top_;
    Findings& findings_;
    Model model_;
    std::vector<Outline> outlines_;
    std::vector<std::vector<ShapePart>> parts_;
    std::vector<std::vector<NamedSurface>> surfaces_;
    MeshStore meshes_;
    std::unordered_map<std::string, BodyReference> bodies_;
    std::map<std::string, SourceLocation> places_;
    double length_ = 1;
};

/// The core's advice, which names concepts, with the keys that scenario files have for them.
std::string help_in_toml(const Complaint& complaint);

/// A name fit for results and messages; else an error at the name's place.
bool check_name(const Section& section);
/// Type and bodies, for joints and loads without a name: "rod world-upper", "force on upper".
std::string default_name(const Section& section);
/// Reports a name (at the key, or at the table without one) that another of its kind has.
bool claim_name(const Section& section, const std::string& kind, const std::string& name,
                std::unordered_set<std::string>& taken, const Advice& advice);

/// `from` and `until` of a joint or drive, as far as they are inside the time.
void read_times(const Builder& builder, const Section& section, Joint& joint);

/// `coordinate`: which of a joint's, for drives and loads.
Key coordinate_key();
/// What `joint` and `coordinate` of a section refer to; valid until a joint is added.
struct JointReference {
    const Joint* joint;
    const NamedCoordinate* coordinate;
};
/// Throws InputError (`joint-unknown`, `joint-coordinate`) at path.joint.
JointReference find_coordinate(const Builder& builder, const Section& section, const std::string& path);

// Expressions.

/// `expression` for one number, or for three, and `inputs`.
std::vector<Key> expression_keys(bool is_vector);
/// What expressions of a section read: of symbol k the number reads[k].
struct Inputs {
    struct Read {
        std::size_t coordinate;
        bool is_rate;
    };
    std::vector<std::string> symbols;
    std::vector<LawCoordinate> coordinates;
    std::vector<Read> reads;
};
/// Throw InputError at path.inputs, path.expression.
Inputs read_inputs(const Builder& builder, const Section& section, const std::string& path);
std::vector<Expression> read_expressions(const Section& section, const Inputs& inputs,
                                         const std::string& path);
/// `breaks`, and the events of the expressions, ascending; a warning where symbols decide about kinks.
std::vector<double> breaks_of(const Builder& builder, const Section& section,
                              const std::vector<Expression>& expressions);
/// One factor for each expression.
LoadLaw law_of(const std::vector<Expression>& expressions, const Inputs& inputs,
               const std::vector<double>& breaks);
/// How steep they may be.
LawSteepness steepness_of(const std::vector<Expression>& expressions, const Inputs& inputs);
/// What decides on which smooth pieces they are; empty: they have but one.
LawGuards guards_of(const std::vector<Expression>& expressions, const Inputs& inputs);

/// `directors`, `quaternion`, `rotation_vector`: of a body or a joint's frame.
std::vector<Key> orientation_keys();
bool check_orientation(const Section& section);
/// `frames`: one for each of two bodies.
Key frames_key(const std::string& heading, const std::string& doc);
bool check_frames(const Section& section);
Matrix3 read_orientation(const Section& section);
/// Where `points` of a joint or load lie outside of a body's shape, and as places in the world would not.
void warn_of_world_points(Builder& builder, const Section& section, const std::array<int, 2>& bodies);

// Position, orientation and velocities of a body, at the start ([[body]]) or at the end ([body.end]).
bool check_pose(const Section& body);
/// Throws InputError. Of `director_rates` it knows nothing.
/// `stretch`: of a body whose orientation may be told by others than its directors.
Placement read_placement(const Section& body, const Matrix3& stretch = identity<3>());

/// X and V of a body at the "start" or "end" of time; at the start what is left out is as in `state`.
void read_pose_of(Builder& builder, const std::string& name, const Section& pose, const std::string& when,
                  State& state);

// The parts of the reader. Each reports all it finds.
void read_bodies(Builder& builder);
void read_joints(Builder& builder);
/// Leads the bodies to what [start] and joints say of coordinates: after the joints, before all others.
void move_bodies(Builder& builder);
void read_drives(Builder& builder);   ///< after the joints
/// Those of loads follow the loads, whose expressions may read the others.
void read_sensors(Builder& builder, bool of_loads);
void read_loads(Builder& builder);
/// What is given at both ends, and the state at the end. The state at the start is the model's.
void read_boundary(Builder& builder, Conditions& boundary);
/// Closes the mechanism where something is given, as solve() will.
void check_ends(Builder& builder, const Conditions& boundary, StartPolicy policy, Prepared& prepared);
Method read_method(const Section* section, Findings& findings);
/// Time, method, conditions: everything of the scenario but the model.
void read_run(Builder& builder, Scenario& scenario);

/// Elements and output times. False after an error.
bool read_time(Builder& builder, const Section& time, const Section* method, Scenario& scenario);
/// Whether elements are to be found: an accuracy is stated, or no elements are.
bool follows_accuracy(const Section& time, const Method& method);

/// Knots make the mesh.
bool has_knots(const Method& method);

/// What motion and equations will take at least; a scenario of a few lines must not fill the memory of a
/// machine. The motion has at most 8 GiB, the factors of one block's matrix (mixed) too: 150 entries of
/// 16 bytes for each of 30 unknowns a rigid body and node (6 a point mass, 1 a row). That leaves 100,000
/// linear elements of a single body. False after an error at `place`.
bool check_size(const Model& model, const Method& method, double n_elements, const SourceLocation& place,
                Findings& findings);

}   // namespace livens
