// SPDX-License-Identifier: BSD-3-Clause
// Problems whose models have unknown numbers: what they are for any values of these.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "livens/base/error.h"
#include "livens/spacetime/march/ends.h"

namespace livens::inline spacetime_internal {

/// A problem on a mesh with its unknown numbers, which may be none: models, conditions and element ends for
/// any values of them. References must outlive it.
class NumberedProblem {
public:
    NumberedProblem(const Model& model, const Ends& ends, const TimeMesh& mesh,
                    const UnknownNumbers& unknowns);

    /// A problem of its own, with what it is made of.
    struct Instance {
        Rebuilt rebuilt;
        Ends ends;
        TimeMesh mesh;
    };
    /// None: `why` says why these values make no problem.
    struct Tried {
        std::optional<Instance> made;
        Complaint why;
    };
    Tried try_at(std::span<const double> values) const;
    /// All guesses but one. Throws InputError, naming the number.
    Instance beside_guesses(int i, double value) const;

    int size() const { return static_cast<int>(numbers_.size()); }
    /// Those of the problem, then those of what unfolds it.
    const UnknownNumber& operator[](int i) const { return numbers_[i]; }
    int n_stated() const { return static_cast<int>(unknowns_.numbers.size()); }
    const Model& model() const { return model_; }
    const Ends& ends() const { return ends_; }
    const TimeMesh& mesh() const { return mesh_; }
    const UnknownNumbers& unknowns() const { return unknowns_; }
    std::vector<double> guesses() const;
    double scale(int i) const { return scale_of(numbers_[i]); }
    /// Values at which differences are taken, with their weights per scale: within the bounds.
    struct Sample {
        double value, weight;
    };
    std::vector<Sample> samples(int i, double value) const;

private:
    Rebuilt as_it_is() const;
    void put_components(const Rebuilt& rebuilt, std::span<const double> unfolded,
                        std::vector<Condition>& all) const;
    /// Components that are given, before those of a periodic motion.
    std::size_t n_given() const { return ends_.components.size() - ends_.periodic.n_alike; }

    const Model& model_;
    const Ends& ends_;
    const TimeMesh& mesh_;
    const UnknownNumbers& unknowns_;
    std::vector<UnknownNumber> numbers_;
    /// Both ends of time and the instants between them at which laws of loads jump or bend, or joints begin
    /// or end to act; and what is held.
    struct Anchors {
        std::vector<double> instants;
        std::vector<std::size_t> events;   ///< which of them are of joints
    };
    Anchors anchors_of(const Model& model, double start, double end) const;

    Anchors anchors_;   // instants that go with the numbers
};

/// The instant at which an element of one mesh is as far as an element of another at t.
double carried_to(const TimeMesh& from, double t, const TimeMesh& to);

}   // namespace livens::inline spacetime_internal
