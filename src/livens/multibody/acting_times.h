// SPDX-License-Identifier: BSD-3-Clause
// When a joint, drive or load acts: from and until instants that are stated, or as the motion decides.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

namespace [[gnu::visibility("default")]] livens {

/// From one instant until another, s.
struct TimeSpan {
    double from = -std::numeric_limits<double>::infinity();
    double until = std::numeric_limits<double>::infinity();

    bool has(double t) const { return from <= t && t < until; }
    /// Just before t.
    bool has_before(double t) const { return from < t && t <= until; }
};

/// When something acts: instants are events of the motion.
struct ActingTimes : TimeSpan {
    bool is_begun_by_event = false;   ///< it does not act before: an Event begins it
    bool is_ended_by_event = false;   ///< an Event may end it
    /// Of the model of a solved motion, once events have decided: when it acted, in order. They count instead
    /// of what is above.
    std::vector<TimeSpan> decided{};
    bool is_from_motion = false;   ///< `decided` counts

    bool is_decided_by_events() const { return is_begun_by_event || is_ended_by_event; }
    /// It may act for a part of the time alone.
    bool is_partial() const { return is_decided_by_events() || std::isfinite(from) || std::isfinite(until); }
    std::vector<TimeSpan> spans() const
    {
        if (is_from_motion) return decided;
        return is_begun_by_event ? std::vector<TimeSpan>{} : std::vector<TimeSpan>{*this};
    }
    bool acts_at(double t) const
    {
        if (!is_from_motion) return !is_begun_by_event && has(t);
        for (const TimeSpan& one : decided)
            if (one.has(t)) return true;
        return false;
    }
    bool acts_before(double t) const
    {
        if (!is_from_motion) return !is_begun_by_event && has_before(t);
        for (const TimeSpan& one : decided)
            if (one.has_before(t)) return true;
        return false;
    }
    /// Also at the ends of its time.
    bool holds_at(double t) const
    {
        if (!is_from_motion) return !is_begun_by_event && from <= t && t <= until;
        for (const TimeSpan& one : decided)
            if (one.from <= t && t <= one.until) return true;
        return false;
    }
    bool begins_near(double t, double gap) const { return is_near(&TimeSpan::from, t, gap); }
    bool ends_near(double t, double gap) const { return is_near(&TimeSpan::until, t, gap); }

private:
    bool is_near(double TimeSpan::*when, double t, double gap) const
    {
        for (const TimeSpan& one : spans())
            if (std::abs(one.*when - t) <= gap) return true;
        return false;
    }
};

}   // namespace gnu::visibility("default")]]livens
