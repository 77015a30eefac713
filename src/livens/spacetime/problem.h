// SPDX-License-Identifier: BSD-3-Clause
// What is asked: conditions at the ends of time.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "livens/base/error.h"
#include "livens/multibody/motion.h"
#include "livens/multibody/state_quantities.h"

namespace [[gnu::visibility("default")]] livens {

class Prepared;

/// What is known at one end of time.
enum class Known {
    nothing,
    positions,   ///< X
    momenta,   ///< of each body the linear momentum and the moment of momentum about its reference point, in
               ///< world axes: those of the X and V that are stated
    state      ///< X and momenta
};

/// In scenarios, in this order.
constexpr std::array<std::string_view, 4> words_of(Known)
{
    return {"nothing", "positions", "momenta", "state"};
}

inline bool knows_positions(Known known) { return known == Known::positions || known == Known::state; }
inline bool knows_momenta(Known known) { return known == Known::momenta || known == Known::state; }

/// One number that is known at an end of time, or by how much it is more at the end than at the start.
struct Condition {
    enum class At { start, end, both };

    StateQuantity quantity;
    double value = 0;
    At at = At::start;
    bool forgets_turns = false;       ///< alike at both ends but for whole turns
    std::optional<AxisTurn> turn{};   ///< of all bodies, which is taken back before the end is compared
    bool is_of_all = false;           ///< one of those that momenta given of all bodies come to

    StateQuantity at_end() const
    {
        StateQuantity there = quantity;
        there.before = turn;
        return there;
    }
};

/// Conditions at the ends of time, for all bodies alike. Two halves must be known: the state at one end, or
/// positions or momenta at each. Stated values that are not known serve as a guess: V where positions are
/// known, X where momenta are (zeros mean none).
///
/// Or component by component: twice as many as the joints leave motions free, where positions or momenta that
/// are known at an end without components are as many as that; states are else guesses, one without bodies is
/// none.
struct Conditions {
    State start;
    Known at_start = Known::state;
    State end{};
    Known at_end = Known::nothing;
    std::vector<Condition> components{};
    /// The state at the end is that at the start, but for whole turns: twice as many quantities as the joints
    /// leave motions free are alike at both ends, beside other components. Where nothing depends on time
    /// these are needed: as many as there are unknown numbers and quantities that every motion keeps.
    bool is_periodic = false;
    std::optional<AxisTurn> turn{};   ///< of a periodic motion that ends as it began once this is taken back

    /// By component, or periodic: then the end states are guesses.
    bool has_components() const { return is_periodic || !components.empty(); }
    /// At one end of time; else the conditions are at both.
    bool has_state() const
    {
        return !has_components() && (at_start == Known::state || at_end == Known::state);
    }
};

/// A number in a model, in its conditions or in their times that is to be found with the motion.
struct UnknownNumber {
    std::string name;   ///< "damping"
    double guess = 0;
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    /// What it is compared with; 0: its guess, or where that is zero the width between its bounds, or one.
    double scale = 0;
    std::string unit{};   ///< "m", where it is told with one
};

/// What a number is compared with.
double scale_of(const UnknownNumber& number);

/// What is solved where unknown numbers have some values.
struct Rebuilt {
    std::shared_ptr<const Model> model;
    std::vector<Condition> components;   ///< of this model, in the order of the others
    double start = 0, end = 0;           ///< s
    /// At the start, where it is known as a whole; without bodies it is that of the problem.
    State state{};
    double turn = 0;                      ///< rad, of Conditions::turn
    std::vector<double> output{};         ///< s, in ascending order; empty: those of the problem's time
    std::optional<Complaint> refused{};   ///< these values make no model, and nothing else counts
};

/// As many more conditions by component decide them. Bodies, rows and loads are the same for all values.
struct UnknownNumbers {
    std::vector<UnknownNumber> numbers{};
    /// Values that make no model are to be refused, with InputError::complaint(): others are tried then.
    /// What it throws ends the solution. The problem itself is that of the guesses.
    std::function<Rebuilt(std::span<const double> values)> rebuild{};
    /// Element ends that stay where they are, whatever numbers do to the ends of time and to switches: s, in
    /// ascending order, inside the time and apart from these.
    std::vector<double> held{};

    bool is_empty() const { return numbers.empty(); }
};

/// What was found of unknown numbers: their values, and the model that these make, to which the motion
/// belongs.
struct FoundNumbers {
    std::vector<double> values{};
    Rebuilt rebuilt{};
    std::vector<double> unfolded{};   ///< 0 where what every motion keeps is kept, see Ends::unfolding
    /// Estimated, of the values: what those of the second solution differ by, and rounding. Empty: not known.
    std::vector<double> errors{};
    std::vector<double> rounding{};   ///< what of that is rounding; empty: nobody asked
    std::vector<double> left{};       ///< by how much conditions would still move them, if no bound was there
};

struct Problem {
    Conditions conditions;
    /// A motion that is about right, for conditions at both ends; empty: one is made from the conditions.
    /// With SolveOptions::threads it is called by any of them, by one at a time.
    std::function<State(double t)> guess{};
    /// A motion of the same bodies that is near: marches of lobatto(p) take it as their guess where their
    /// elements are its own. Must outlive the solution. Null: there is none.
    const Motion* near = nullptr;
    /// What was found of the model when it was solved before, for less work; null: nothing, and nothing is
    /// kept. One thread at a time.
    std::shared_ptr<Prepared> prepared{};
    UnknownNumbers unknowns{};
    /// Whether conditions at both ends determine the motion is asked of its equations.
    bool is_determination_asked = true;
    /// Between both ends no other motion is looked for than the one that is guessed.
    bool is_only_guess = false;
    /// Asked after each element of a march of single ones: events of the model that end it there.
    std::function<std::vector<int>(const Motion& so_far)> fired{};
    /// Whether events that end the motion do so; false: it goes on, for comparison.
    bool ends_by_events = true;
    /// To an accuracy: whether a second solution judges each try. False: it is judged elsewhere.
    bool is_followed = true;
};

}   // namespace livens
