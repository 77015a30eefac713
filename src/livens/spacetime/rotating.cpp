// SPDX-License-Identifier: BSD-3-Clause
// theory.md, "Inertia along coordinates".
#include "livens/spacetime/rotating.h"

#include <string>

#include "livens/base/error.h"
#include "livens/spacetime/elements/rule.h"
#include "livens/spacetime/march/ends.h"

namespace livens::inline spacetime_internal {

namespace {

/// Of each `of` values the first `wanted`: those of the model come before those of its points.
void keep_first(std::vector<double>& values, int wanted, int of)
{
    if (values.empty() || of == 0) return;
    std::vector<double> kept;
    const auto n = static_cast<std::ptrdiff_t>(wanted), step = static_cast<std::ptrdiff_t>(of);
    for (auto first = values.begin(); first != values.end(); first += step)
        kept.insert(kept.end(), first, first + n);
    values = std::move(kept);
}

void take_off(const WithRotors& rotors, const TimeMesh& mesh, ErrorEstimate& estimate)
{
    if (estimate.empty()) return;
    for (auto* errors : {&estimate.position, &estimate.orientation, &estimate.velocity})
        keep_first(*errors, rotors.n_bodies(), estimate.n_bodies);
    keep_first(estimate.reaction, rotors.n_joints(), estimate.n_joints);
    estimate.n_bodies = rotors.n_bodies();
    estimate.n_joints = rotors.n_joints();
    if (estimate.body >= rotors.n_bodies()) estimate.body = rotors.told_body(estimate.body);
    static_cast<void>(mesh);
}

void tell(const WithRotors& rotors, Growing& growing)
{
    if (growing.body < rotors.n_bodies()) return;
    growing.body = rotors.told_body(growing.body);
}

}   // namespace

Problem with_rotors(const WithRotors& rotors, const Problem& problem)
{
    Problem all = with_prepared({problem.conditions, {}, nullptr, nullptr});
    all.conditions.start = rotors.with(problem.conditions.start);
    return all;
}

Solution without_rotors(const WithRotors& rotors, const std::shared_ptr<Solution>& whole)
{
    Solution told = *whole;
    rotors.take_off(told.motion);
    take_off(rotors, told.motion.mesh, told.estimate);
    tell(rotors, told.growing);
    tell(rotors, told.rounding_in);
    const auto n = static_cast<std::size_t>(rotors.n_bodies());
    for (Unseen& unseen : told.unseen) {
        if (unseen.shift.size() > n) unseen.shift.resize(n);
        if (unseen.turn.size() > n) unseen.turn.resize(n);
    }
    told.with_rotors = whole;
    return told;
}

void refuse_rotors(const Model& model, const Conditions& conditions, const Method& method)
{
    if (!model.has_rotors()) return;
    if (!is_nodal(method))
        throw InputError({"rotor-method", "method.family",
                          "the method " + name_of(method) + " does not take 'rotor_inertia' of joints",
                          name_of(method), "lobatto or radau",
                          "a rotor is bound to its joint by a row that is no quadratic form", "use lobatto"});
    if (conditions.at_start != Known::state)
        throw InputError({"rotor-method", "start.given",
                          "'rotor_inertia' of joints needs the whole state at the start", "",
                          "the state at the start",
                          "positions at both ends do not say how often a rotor turns in between",
                          "give the state at the start"});
}

}   // namespace livens::inline spacetime_internal
