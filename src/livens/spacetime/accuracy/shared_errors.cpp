// SPDX-License-Identifier: BSD-3-Clause
// Errors that a second solution shares, and so does not tell: what radau takes, at events too, and states
// inside of elements.
#include <algorithm>
#include <cmath>
#include <limits>

#include "livens/diagnostics/diagnostics.h"
#include "livens/diagnostics/largest.h"
#include "livens/spacetime/accuracy/reference_solution.h"
#include "livens/spacetime/phases/events.h"
#include "livens/statics/frequencies.h"

namespace livens {

namespace {

/// Of the joints that act before an element end, from `slowest` rad/s on.
std::vector<Vibration> vibrations_beside(const Model& model, const Motion& motion, int end, double slowest)
{
    if (!model.has_events()) return vibrations(model, motion.at_end(end), Side::right, slowest);
    const int element = std::max(end - 1, 0);
    const double middle = motion.mesh.ends[element] + 0.5 * motion.mesh.length(element);
    return vibrations(acting_at(model, middle).model, motion.at_end(end), Side::right, slowest);
}

/// The root of twice the energy that a motion of radau may have lost.
class LostEnergy {
public:
    LostEnergy(const Model& model, const Motion& motion)
    {
        if (!motion.damps()) return;
        const Balance whole = balance(model, motion);
        const double hidden = whole.hidden_energy_loss();
        root_ = std::sqrt(2 * std::max(whole.energy_loss, hidden));
        is_hidden_ = whole.energy_loss <= hidden;
    }
    /// Of vibrations that are as wide as the root times `width`. What is hidden bounds them badly; but they
    /// are no wider than the jumps of the elements that took them, in which the fastest is not resolved.
    double root_for(double width, double jumps) const
    {
        return is_hidden_ && root_ * width > jumps ? jumps / width : root_;
    }

private:
    double root_ = 0;
    bool is_hidden_ = false;
};

/// Element ends where events are: not of those behind the end of a motion that has ended before.
std::vector<int> event_ends(const Model& model, const Motion& motion)
{
    std::vector<int> ends;
    for (const double t : model.event_times()) {
        if (t < motion.start() || t > motion.end()) continue;
        const int end = element_end_at(motion.mesh, snap_to_element_end(motion.mesh, t));
        if (end > 0 && end < motion.n_elements()) ends.push_back(end);
    }
    return ends;
}

/// Adds what grows from an event on: errors of place, and of rates that go on.
void add_from(int event, const ActivationMismatch& off, const Model& model, const Motion& motion,
              ErrorEstimate& found)
{
    const auto n = static_cast<std::size_t>(found.n_bodies);
    for (std::size_t i = static_cast<std::size_t>(event) * n; i < found.position.size(); ++i) {
        const double since = motion.mesh.ends[i / n] - motion.mesh.ends[event];
        found.position[i] += off.shift + off.speed * since;
        if (!model.bodies()[i % n].is_point) found.orientation[i] += off.turn + off.spin * since;
        found.velocity[i] += off.speed * found.length;
    }
    found.find_largest(motion.mesh);
}

}   // namespace

void spacetime_internal::add_events(const Model& model, const Motion& motion, ErrorEstimate& found)
{
    if (!model.has_events() || found.empty()) return;
    const std::vector<double> jumps = velocity_jumps(model, motion);
    const LostEnergy lost(model, motion);
    int before = 0;
    for (const int event : event_ends(model, motion)) {
        ActivationMismatch off = activation_mismatch(model, motion, event);
        double slowest = std::numeric_limits<double>::infinity(), fastest = 0, shift = 0, turn = 0;
        const double unresolved = motion.X.degree / motion.mesh.length(event - 1);
        for (const Vibration& one : vibrations_beside(model, motion, event, unresolved)) {
            if (one.decay > one.rate) continue;
            slowest = std::min(slowest, one.rate);
            raise_to(fastest, one.rate);
            raise_to(shift, one.shift);
            raise_to(turn, one.turn);
        }
        if (motion.damps()) {
            double steps = 0;   // of rates
            for (int e = 0; e < event; ++e)
                if (fastest * motion.mesh.length(e) >= motion.X.degree)
                    steps += jumps[e] / motion.mesh.length(e);
            const double root = lost.root_for(std::max(shift / found.length, turn), steps);
            off.speed += root * shift / found.length;
            off.spin += root * turn;
        }
        const bool is_unresolved = std::isfinite(slowest) && !motion.damps();
        for (int e = before; e < event && is_unresolved; ++e) {
            const double h = motion.mesh.length(e);
            if (slowest * h < motion.X.degree) continue;
            raise_to(off.speed, jumps[e] / h);
            raise_to(off.spin, jumps[e] / h);
        }
        add_from(event, off, model, motion, found);
        before = event;
    }
}

/// Of a form y with y^T M y = 1 and the rate w the energy E is an amplitude of sqrt(2 E) y / w and a speed of
/// sqrt(2 E) y. Forms that dampers take faster than they vibrate die in truth, too.
void spacetime_internal::add_lost_vibrations(const Model& model, const Motion& motion, ErrorEstimate& found)
{
    if (!motion.damps() || found.empty()) return;
    double longest = 0;
    for (int e = 0; e < motion.n_elements(); ++e) raise_to(longest, motion.mesh.length(e));
    double shift = 0, turn = 0, speed = 0, fastest = 0;   // by the root of twice the energy; 1/s
    for (const int end : {0, motion.n_elements() / 2, motion.n_elements()}) {
        for (const Vibration& one : vibrations_beside(model, motion, end, motion.X.degree / longest)) {
            if (one.rate < one.decay) continue;
            raise_to(fastest, one.rate);
            raise_to(shift, one.shift / one.rate);
            raise_to(turn, one.turn / one.rate);
            raise_to(speed, one.shift);
        }
    }
    if (shift == 0 && turn == 0) return;
    double lost = 0;
    const std::vector<double> jumps = velocity_jumps(model, motion);
    for (int e = 0; e < motion.n_elements(); ++e)
        if (fastest * motion.mesh.length(e) >= motion.X.degree) lost += jumps[e];
    const double root = LostEnergy(model, motion).root_for(std::max(shift / found.length, turn), lost);
    for (double& error : found.position) error += root * shift / found.length;
    for (double& error : found.velocity) error += root * speed;
    for (std::size_t i = 0; i < found.orientation.size(); ++i)
        if (!model.bodies()[i % model.bodies().size()].is_point) found.orientation[i] += root * turn;
    found.find_largest(motion.mesh);
}

/// J lengths in place, and J by the length of the element in rates; told at both of its ends, as estimates
/// have no places between.
void spacetime_internal::add_inside(const Model& model, const Motion& motion,
                                    const std::vector<double>& instants, ErrorEstimate& found)
{
    if (instants.empty() || found.empty()) return;
    const std::vector<double> jumps = velocity_jumps(model, motion);
    const auto n = static_cast<std::size_t>(found.n_bodies);
    for (const double t : instants) {
        const int e = motion.mesh.element_at(t);
        for (std::size_t i = static_cast<std::size_t>(e) * n; i < (static_cast<std::size_t>(e) + 2) * n;
             ++i) {
            raise_to(found.position[i], jumps[e]);
            if (!model.bodies()[i % n].is_point) raise_to(found.orientation[i], jumps[e]);
            raise_to(found.velocity[i], jumps[e] * found.length / motion.mesh.length(e));
        }
    }
    found.find_largest(motion.mesh);
}

}   // namespace livens
