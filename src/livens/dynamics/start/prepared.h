// SPDX-License-Identifier: BSD-3-Clause
// What is found once of a model, for whoever solves it more than once.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "livens/dynamics/start/consistent_start.h"

namespace [[gnu::visibility("default")]] livens {

inline namespace dynamics_internal {
struct KnownPattern;
}   // namespace dynamics_internal

/// What follows from a model alone and takes time to find: its last closed start and the pattern of its rows.
/// It is passed from solution to solution in Problem::prepared, by one thread at a time; what was found of
/// another model, or of this one before it changed (Model::version), is forgotten.
class Prepared {
public:
    Prepared();
    ~Prepared();
    Prepared(const Prepared&) = delete;
    Prepared& operator=(const Prepared&) = delete;

    /// try_consistent_start(), which is not done anew for the state and policy that were given last.
    TriedStart try_close(const Model& model, const State& start, StartPolicy policy);
    /// The same, thrown as consistent_start() does.
    ConsistentStart close(const Model& model, const State& start, StartPolicy policy);
    /// The same of a start that was closed, which is not looked at anew where the last one was in order.
    std::optional<Complaint> why_singular(const Model& model, const ConsistentStart& closed);
    /// Where the Tables of this model keep the pattern of their rows.
    std::shared_ptr<KnownPattern> pattern(const Model& model);

private:
    struct AcceptedElements {
        State state;
        StartPolicy policy;
        ConsistentStart closed;
    };

    void serve(const Model& model);

    std::uint64_t version_ = 0;
    std::optional<AcceptedElements> closed_;
    std::optional<State> regular_;   // the last that was no singular position
    std::shared_ptr<KnownPattern> pattern_;
};

}   // namespace livens
