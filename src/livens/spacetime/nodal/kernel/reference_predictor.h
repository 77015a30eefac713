// SPDX-License-Identifier: BSD-3-Clause
// Guesses for the elements of a march from a motion nearby on the same elements.
#pragma once

#include <vector>

#include "livens/dynamics/lanes/aligned_doubles.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/multibody/motion.h"
#include "livens/spacetime/elements/kernel_functions.h"
#include "livens/spacetime/elements/rule.h"
#include "livens/spacetime/elements/window_layout.h"

namespace livens::inline spacetime_internal {

/// Bodies move and turn, from the start of an element on, as they do in the motion that is followed: what
/// both motions are apart at the start does not count, only what they part by inside the element.
class ReferencePredictor {
public:
    ReferencePredictor() = default;
    /// References must outlive it; the motion may grow.
    ReferencePredictor(const Motion& motion, const ModelTables& tables, const ElementRule& rule,
                       const lanes::Functions& functions);

    /// Places of all nodes, as lanes::Values has them. False: the motion has no element there with these
    /// ends.
    bool place(const WindowLayout& layout, double* place);

private:
    void weigh();
    void follow_body(int body, int element, bool is_backwards, int last_lane, double* places);

    const Motion* motion_ = nullptr;
    const ModelTables* tables_ = nullptr;
    const ElementRule* rule_ = nullptr;
    const lanes::Functions* functions_ = nullptr;
    int degree_ = 0;   // of the motion, for which the weights below are
    AlignedDoubles
        weights_;             // of its nodes; lane 0 is its start, which the kernel also asks for as the last
    AlignedDoubles places_;   // of its nodes
};

}   // namespace livens::inline spacetime_internal
