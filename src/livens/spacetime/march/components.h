// SPDX-License-Identifier: BSD-3-Clause
// Conditions by component before they are solved for: whether they are as many as they must be and do not say
// one thing twice, and states that meet what is stated at one end.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "livens/dynamics/rows/tables.h"
#include "livens/spacetime/march/ends.h"

namespace livens::inline spacetime_internal {

/// Of the scale of a condition: what counts as met.
constexpr double met_component = 1e-8;

/// "'tip.x' at the end".
std::string in_words(const Condition& condition);

/// Where it stands: "end.known[tip.x]".
std::string path_of(const Condition& condition);

/// What is compared at the start of time, or at the end.
std::vector<StateQuantity> quantities_at(const std::vector<Condition>& conditions, bool last);

/// A length of the model or a radian, for rates over the duration; of energies that of such a speed.
double unit_of(const StateQuantity& quantity, double length, double duration);
/// What one unit of a condition is, for comparisons: its value, and at least the unit of its quantity.
double scale_of(const Condition& condition, double length, double duration);

/// Where turns of an angle begin to be counted: at what is stated at the start, or at the stated bodies.
double start_of_turns(const Ends& ends, const StateQuantity& quantity);

/// Why conditions do not determine a motion of these joints, and unknown numbers: they must be twice the free
/// motions and as many more as there are numbers, and none may follow from others. Judged at places about the
/// guesses, where no chance makes them dependent.
std::optional<Complaint> why_undetermined(const ModelTables& at_start, const ModelTables& at_end,
                                          const Ends& ends, const UnknownNumbers& unknowns);

/// Of an end at which places, or places and rates, are given: these as components beside the others; a state
/// at the start that is known as it stands needs none.
void make_given(const ModelTables& at_start, const ModelTables& at_end, Ends& ends);
/// Adds what makes a motion periodic to its conditions, with what unfolds it; or why that does not determine
/// it.
std::optional<Complaint> make_periodic(const ModelTables& tables, const Conditions& given, Ends& ends);

/// A state near a guess that meets what is stated at an end, as far as it comes.
State settled(const ModelTables& tables, const Ends& ends, Condition::At at, const State& guess);

/// What quantities of conditions are in a motion, at its ends; angles with their turns.
std::vector<double> values_in(const Model& model, const Ends& ends,
                              const std::function<State(double t)>& motion,
                              const std::vector<double>& instants);

/// A sentence for each condition that a motion does not meet, to 1e-8 of scale_of().
std::vector<std::string> unmet_components(const Model& model, const Ends& ends, const Motion& motion);
/// The same of what quantities of conditions are, over this duration.
std::vector<std::string> unmet_values(const Model& model, const Ends& ends, const std::vector<double>& values,
                                      double duration);

}   // namespace livens::inline spacetime_internal
