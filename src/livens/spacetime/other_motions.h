// SPDX-License-Identifier: BSD-3-Clause
// Motions that meet the equations and are not the one that was asked for.
#pragma once

#include <functional>
#include <memory>

#include "livens/multibody/model.h"
#include "livens/solvers/report.h"
#include "livens/spacetime/march/ends.h"
#include "livens/spacetime/march/window.h"

namespace livens::inline spacetime_internal {

/// Of a periodic motion that nothing drives: bodies that stay where they are do so for any time.
bool is_at_rest(const Model& model, const Ends& ends, const Motion& motion);
/// Of a part of a motion that begins in this state.
bool is_at_rest(const Model& model, const Ends& ends, const State& first, const Motion& part);
/// Such a motion is suspect, and one that ends elsewhere than it began.
void report_no_period(const FoundNumbers& numbers, bool is_at_rest, SolveReport& report);
void report_no_period(const Model& model, const Ends& ends, const FoundNumbers& numbers, const Motion& motion,
                      SolveReport& report);

/// `numbers`: what the window found, or stays so where there is no other.
/// Of momenta at a place that is not known, solving compares the part that joints leave to choose: a motion
/// may meet that and not the rest; and one that is periodic may be none. Then others are looked for; where
/// there is none, the first one is told.
std::unique_ptr<Window> find_met(const Model& model, const Ends& ends, FoundNumbers& numbers,
                                 std::unique_ptr<Window> window,
                                 const std::function<std::unique_ptr<Window>(SolveReport&)>& next,
                                 SolveReport& report);

}   // namespace livens::inline spacetime_internal
