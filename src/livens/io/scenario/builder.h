// SPDX-License-Identifier: BSD-3-Clause
// From the sections of a scenario to a model: one object that the parts of the reader fill together. Each
// part has a header of its own: bodies/bodies.h, joints/joints.h, loads/load_kinds.h, run/run.h.
#pragma once

#include <map>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "livens/base/error.h"
#include "livens/io/scenario.h"
#include "livens/io/scenario/bodies/meshes.h"
#include "livens/io/scenario/joints/inputs.h"
#include "livens/io/scenario/schema/section.h"

namespace livens::inline io_internal {

/// What a name in `between` or `body` stands for.
struct BodyReference {
    int index = world;
    bool is_usable = false;   ///< the world, or a body in order; to refer to another one is no second error
};

/// A joint or load whose times are conditions, and what states it.
struct StatedConditions {
    bool is_load = false;
    std::string name;
    const Section* section = nullptr;
};

class Builder {
public:
    /// Of the tables below `top`; time, method and ends are those of `run`, which is the same but of what is
    /// included.
    Builder(Section& top, const Section& run, MeshStore& meshes, Findings& findings);

    Section& top() { return top_; }
    const Section& top() const { return top_; }
    const Section& run() const { return run_; }
    Findings& findings() { return findings_; }
    Model& model() { return model_; }
    const Model& model() const { return model_; }
    std::vector<Outline>& outlines() { return outlines_; }                     ///< of the bodies so far
    std::vector<std::vector<ShapePart>>& parts() { return parts_; }            ///< of the bodies so far
    std::vector<std::vector<NamedSurface>>& surfaces() { return surfaces_; }   ///< of the bodies so far
    MeshStore& meshes() { return meshes_; }
    std::vector<StatedConditions>& conditions() { return conditions_; }
    std::vector<ReadController>& controllers() { return controllers_; }
    const std::vector<ReadController>& controllers() const { return controllers_; }
    /// Once all bodies are there, also those around what is included.
    void set_length(double length);
    std::unordered_map<std::string, BodyReference>& bodies() { return bodies_; }

    /// Makes `path` known as the place of the section, and its keys as `path.key`.
    void remember(const std::string& path, const Section& section);
    /// Makes known what another builder knows, whose names have the prefix here.
    void remember(const Builder& included, const std::string& prefix);
    /// What begins so and is not found has been told of.
    void excuse(const std::string& prefix) { excused_.push_back(prefix); }
    bool is_excused(std::string_view name) const;
    /// Makes `path` known as this place, unless it is known.
    void remember(const std::string& path, const SourceLocation& place) { places_.try_emplace(path, place); }
    /// Of what the core calls so, for what is read at `context`.
    SourceLocation find_place(std::string path, const std::string& context) const;
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

    /// X of all bodies at the start.
    std::vector<Matrix34> start_configurations() const { return model_.start().X; }
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

    Section& top_;
    const Section& run_;
    Findings& findings_;
    Model model_;
    std::vector<Outline> outlines_;
    std::vector<std::vector<ShapePart>> parts_;
    std::vector<std::vector<NamedSurface>> surfaces_;
    MeshStore& meshes_;
    std::vector<StatedConditions> conditions_;
    std::vector<ReadController> controllers_;
    std::vector<std::string> excused_;
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

}   // namespace livens::inline io_internal
