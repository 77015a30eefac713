// SPDX-License-Identifier: BSD-3-Clause
// Stiff springs on what turns: vibrations that elements of Gauss collocation let grow.
// (docs/theory.md, "Springs that turn")
#pragma once

#include <limits>
#include <memory>
#include <string>

#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"
#include "livens/statics/rate_bounds.h"

namespace livens::inline spacetime_internal {

/// By what share a vibration grows in an element of lobatto of this degree in which it goes on by `phase`
/// (rad, h omega) and turns by `turn` (rad); 0: by none.
double growth_of_turning(int degree, double phase, double turn);
/// Of elements in which a vibration of this rate that turns so fast (rad/s) does not grow, s.
double longest_element(int degree, double rate, double turn_rate);

/// Beyond, of what moves, energy that nobody supplied may be a vibration that grows.
inline constexpr double doubtful_energy = 0.01;

/// Why the energy of a motion grows by an element end, this one or one behind it, if springs that turn are to
/// blame, in elements of lobatto or by the midpoint rule (degree 1), and if it grows enough to matter by
/// `until`; else empty. Work grows with the motion.
std::string of_turning_springs(const Model& model, const Motion& motion, int degree, int first_end = 1,
                               double until = std::numeric_limits<double>::infinity());

/// Of a motion whose energy is off from the first element on, by elements that are too long: the springs at
/// its start that would grow much by its end; empty: none.
std::string of_unsteady_springs(const Model& model, const Motion& motion, int degree);

/// Looks at a march on its way, so that of_turning_springs() is asked where energy says so alone.
class EnergyWatch {
public:
    EnergyWatch(const Model& model, int degree) : model_(model), degree_(degree) {}

    /// False: no load has stiffness.
    static bool serves(const Model& model);
    /// After another element, of a march until then; empty: go on.
    std::string look(const Motion& so_far, double until);

private:
    const Model& model_;
    int degree_;
    double last_ = 0;        // energy (J) where it was asked last
    double potential_ = 0;   // at the start
    double moving_ = 0;      // the largest kinetic energy or change of the potential one
    int next_ = 1;           // element end at which it may be asked
    bool is_started_ = false;
    std::shared_ptr<RateBounds> bounds_;   // made where energy asks first
};

}   // namespace livens::inline spacetime_internal
