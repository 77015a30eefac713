// SPDX-License-Identifier: BSD-3-Clause
// What every joint must fulfil; a new one gets it by a line in joint_kit_registry.cpp.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "livens/multibody/joints.h"
#include "properties/kit.h"
#include "unit/multibody/random_states.h"

namespace livens {

/// When joints that depend on time are looked at, and are closed.
inline constexpr Instant kit_instant{0.3};

/// A kind of joint: where it may sit in a configuration of its bodies, and how it is made there.
struct JointCase {
    std::string type;   ///< Joint::type, and the name of its file in src/livens/multibody/joints
    int n_rows = 0;
    /// A random frame in which the joint is closed; for the world X_first is world_configuration.
    std::function<JointFrame(Random&, const Matrix34& X_first, const Matrix34& X_second)> place;
    std::function<Joint(int first, int second, const JointFrame&, const Matrix34& X_first,
                        const Matrix34& X_second)>
        make;
    bool is_symmetric = true;   ///< the bodies may be exchanged: none has the line or plane alone
};

/// Every joint of the library.
const std::vector<JointCase>& joint_cases();

Failures check_joint_labels(const JointCase& joint);    ///< n_rows, labels unique, scales positive
Failures check_joint_closure(const JointCase& joint);   ///< zero at assembly, body or world first
Failures check_joint_gradient(
    const JointCase& joint);                         ///< gradient and curvature equal differences at any X
Failures check_joint_rates(const JointCase& joint);   ///< explicit rates equal differences in time
Failures check_joint_rank(const JointCase& joint);   ///< twist Jacobian has full row rank when closed
Failures check_joint_objectivity(
    const JointCase& joint);                          ///< |Phi| does not see a motion of both bodies together
Failures check_joint_world(const JointCase& joint);   ///< the world folded in equals a body that stands there
Failures check_joint_order(
    const JointCase& joint);   ///< bodies exchanged: the same configurations are allowed

Failures check_joint(const JointCase& joint);   ///< all of them

}   // namespace livens
