// SPDX-License-Identifier: BSD-3-Clause
// The ends of time as the engine sees them: conditions, closed and consistent.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "livens/diagnostics/estimate.h"
#include "livens/dynamics/start/consistent_start.h"
#include "livens/spacetime/problem.h"

namespace livens::inline spacetime_internal {

/// Of an end that is led: momenta that are known are this share of the way from those of another state,
/// and components from other values, if there are any.
struct LedEnds {
    State from{};
    double share = 1;
    std::vector<double> values{};
};

/// A periodic motion keeps its energy, say, so that its components are not independent: for each quantity
/// that it keeps by how much they may miss that it changes, times a number that comes out as 0.
struct PeriodicEnds {
    std::size_t n_alike = 0;   ///< the last components
    std::vector<std::vector<double>> unfolding{};
    std::vector<std::string> conserved{};   ///< their names
    bool is_free = false;                   ///< nothing that depends on time sets its period
};

/// States at both ends that fulfil the joints where they are known.
struct Ends {
    Known at_start = Known::state, at_end = Known::nothing;
    State start, end;   ///< V of known positions without momenta, and X of known momenta, are guesses
    std::vector<int> independent;            ///< rows, chosen where X is known
    std::vector<int> independent_at_end{};   ///< where other joints act there
    std::vector<int> redundant;
    std::vector<std::string> notes;
    LedEnds led{};
    /// Component by component, instead of what is known above: states are then guesses that meet what is
    /// stated at their end as far as they can.
    std::vector<Condition> components{};
    PeriodicEnds periodic{};
    int n_numbers = 0;   ///< unknown ones, which as many more components decide, with those of what unfolds
    /// What of components is a whole state at the start and at the end, or its places, or its momenta: then
    /// all is compared with what was stated.
    std::array<Known, 2> whole{Known::nothing, Known::nothing};
    bool is_end_guessed = false;   ///< else the state at the end is made of that at the start
    enum class Start {
        open,
        known,     ///< as it stands, beside components at the end that decide numbers alone
        of_phase   ///< given by the phase before; momenta at both ends are unknown
    };
    Start start_is = Start::open;

    bool is_start_known() const { return start_is == Start::known; }
    bool is_phase() const { return start_is == Start::of_phase; }
    /// What condition i is to be.
    double value(std::size_t i) const
    {
        const double from = led.values.empty() ? components[i].value : led.values[i];
        return led.share * components[i].value + (1 - led.share) * from;
    }
    bool has_components() const { return is_phase() || !components.empty(); }
    bool has_state() const { return at_start == Known::state || at_end == Known::state; }
    /// Windows follow each other from the end of time.
    bool is_backwards() const { return at_end == Known::state; }
};

/// Joints act for a part of the time between conditions at both ends, or numbers are to be found from a state
/// that is known: the motion is solved in phases, all at once.
bool is_over_phases(const Model& model, const Problem& problem);

/// The model with the joints that act just behind the start of time, or just before its end.
Model acting_at_end(const Model& model, double start, double end, bool last);

/// The problem, with room for what is found of its model.
Problem with_prepared(Problem problem);

/// The mechanism closed at the known ends, or what close_ends() would throw.
struct TriedEnds {
    std::optional<Ends> ends;
    Complaint why;   ///< where there are none
};
TriedEnds try_close_ends(const Model& model, const Problem& problem, double start, double end,
                         StartPolicy policy);

/// Throws InputError, see consistent_start().
Ends close_ends(const Model& model, const Problem& problem, double start, double end, StartPolicy policy);

/// What was stated at the ends of a whole motion and is not there: positions to 1e-8 (lengths of the model,
/// or of directors), linear momenta and moments of momentum in world axes to 1e-6 of what the largest speed
/// of the motion makes of the body, or ten estimated errors; without an estimate to 1e-3. A sentence for each
/// end; empty: all is met. Of momenta at a place that is not known joints leave only a part to choose, and
/// solving compares that part.
std::vector<std::string> unmet(const Model& model, const Ends& ends, const Motion& motion,
                               const ErrorEstimate& estimate);

}   // namespace livens::inline spacetime_internal
