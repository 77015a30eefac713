// SPDX-License-Identifier: BSD-3-Clause
// What acts, as far as a motion has decided.
#pragma once

#include <vector>

#include "livens/multibody/model.h"
#include "livens/spacetime/solve.h"

namespace livens::inline spacetime_internal {

class Decisions {
public:
    /// As it is at the start: what is there from the first, and, of a motion that was decided before, as it
    /// was then.
    Decisions(const Model& model, double start);

    const DecidedTimes& times() const { return times_; }
    /// How often they have changed.
    int changes() const { return changes_; }
    bool acts(const EventAction& of, double t) const;
    /// Whether anything would happen.
    bool is_armed(const EventAction& action, double t) const;
    void act(const Model& model, const EventAction& action, double t);

private:
    std::vector<TimeSpan>& spans(const EventAction& of);

    DecidedTimes times_;
    int changes_ = 0;
};

/// The joint that an action begins with an impact; null: there is none.
const Joint* begun_by_impact(const Model& model, const EventAction& action);

}   // namespace livens::inline spacetime_internal
