// SPDX-License-Identifier: BSD-3-Clause
// Solved elements of a window: their end states, the checks that they have to pass, and the motion
// (docs/theory.md, "Element ends"). Several threads close a share each: what an element is told by the one
// before is momenta, which are summed before, turns of loads, which are followed, and the end state of the
// last element of the share before, which is found once more.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "livens/base/text.h"
#include "livens/solvers/crew.h"
#include "livens/solvers/patience.h"
#include "livens/spacetime/nodal/window.h"

namespace livens::inline spacetime_internal {

/// Who closes elements one after the other, and what is said of the last of them.
struct ElementCloser {
    ElementEnd& end;
    ElementChecks& checks;
    SolveReport& report;
    AcceptedElements closed{};
    Unseen unseen{};
};

}   // namespace livens::inline spacetime_internal

namespace livens {

namespace {

/// directors drift by rounding alone: now and then is enough to mend them
bool is_polished(int mesh_end) { return mesh_end % 16 == 15; }

}   // namespace

/// Finds the end state of a solved element and applies the checks to it.
bool NodalWindow::is_believed(ElementCloser& by, int e, const AcceptanceCriteria& criteria,
                              const double* momentum)
{
    constexpr double infinite = std::numeric_limits<double>::infinity();
    AcceptedElements& closed = by.closed;
    closed.jumps_back = false;
    closed.loss = criteria.full_rank ? by.checks.rank_loss(system_.nodes(), e) : RankLoss::none;
    closed.is_refused = closed.loss != RankLoss::none;
    if (closed.is_refused) return false;
    if (!by.end.reach(system_, kernel_, e, momentum, is_polished(mesh_end(e))))
        return fail(by.report,
                    "the free motions carry no inertia at t = " + to_text(layout_.times[e + 1], 6) + " s");
    closed.contradiction = by.end.contradiction();
    if (!closed.contradiction.empty()) {
        closed.velocity_jump = infinite;
        closed.is_refused = layout_.is_march() || fail(by.report, closed.contradiction);
        return false;
    }
    const bool is_watched = criteria.turns || !std::isinf(criteria.velocity_jump);
    if (is_watched) closed.velocity_jump = by.checks.velocity_jump(system_, e, by.end, criteria.turns);
    // an element near one of a motion that was watched is on its branch
    if (is_watched && !kernel_.has_followed() && by.checks.leaves(system_, e, by.end))
        closed.velocity_jump = infinite;
    by.unseen = by.checks.look_at_laws(system_, e, by.end, closed);
    if (std::string load = is_watched ? by.checks.jumps_back(system_, e, by.end) : ""; !load.empty()) {
        closed.velocity_jump = infinite;
        closed.load = std::move(load);
        closed.jumps_back = true;
    }
    closed.is_refused = !(closed.velocity_jump <= criteria.velocity_jump);
    return !closed.is_refused;
}

/// The nodes and multipliers of a believed element into the motion, its end as the start of the next.
void NodalWindow::close_element(ElementCloser& by, int e)
{
    const int p = layout_.degree, element = std::min(mesh_end(e), mesh_end(e + 1));
    for (int a = 0; a <= p; ++a) {
        const int place = ends_.is_backwards() ? p - a : a;
        if (a > 0 && a < p) record_.node(element, place, system_.nodes().X(e * p + a));
        record_.multipliers(element, place, by.end.multipliers(system_, e, a));
    }
    by.end.pass_on(system_, e);
    record_end(by.end, e + 1);
    if (!by.checks.has_reactions(system_.nodes(), e))
        record_.forget_reactions(mesh_end(e + 1), by.end.instant().weak_rows(by.end.here()));
}

AcceptedElements NodalWindow::close(const AcceptanceCriteria& criteria, SolveReport& report)
{
    if (layout_.is_march())
        end_.begin(system_.balances().impulses(0));
    else if (!find_first(report))
        return {};
    const std::vector<double> momenta = kernel_.is_solved() ? std::vector<double>() : end_.momenta(system_);
    ElementCloser by{end_, checks_, report};
    if (close_in_shares(criteria, momenta, by.closed)) return std::move(by.closed);
    for (int e = 0; e < layout_.n_elements(); ++e) {
        const double* momentum = momenta.empty() ? nullptr : momenta.data() + e * tables_.n_twists;
        if (!is_believed(by, e, criteria, momentum)) return std::move(by.closed);
        checks_.take(system_.nodes(), e, std::move(by.unseen));
        close_element(by, e);
        ++by.closed.n_elements;
    }
    is_ready_ = true;
    return std::move(by.closed);
}

/// False: one by one is better, as one of them is not believed, or rows are chosen anew on the way.
bool NodalWindow::close_share(ElementCloser& by, std::pair<int, int> elements,
                              const AcceptanceCriteria& criteria, const std::vector<double>& momenta,
                              std::vector<Unseen>& unseen)
{
    const auto momentum = [&](int e) { return momenta.data() + e * tables_.n_twists; };
    const int before = elements.first - 1;
    by.end.begin_as(end_, system_, std::max(before, 0));
    if (before >= 0) {
        if (!by.end.reach(system_, kernel_, before, momentum(before), is_polished(mesh_end(before))))
            return false;
        by.end.pass_on(system_, before);
    }
    for (int e = elements.first; e < elements.second; ++e) {
        Patience::ask();
        if (by.end.here().held.are_new || !is_believed(by, e, criteria, momentum(e))) return false;
        unseen[static_cast<std::size_t>(e)] = std::move(by.unseen);
        close_element(by, e);
    }
    return !by.end.here().held.are_new;
}

/// All elements, if all are believed; else nothing has happened.
bool NodalWindow::close_in_shares(const AcceptanceCriteria& criteria, const std::vector<double>& momenta,
                                  AcceptedElements& closed)
{
    struct Share {
        ElementEnd end;
        ElementChecks checks;
        SolveReport report{};   // of what one by one will tell
        AcceptedElements closed{};
        bool is_believed = false;
    };
    const int n = layout_.n_elements();
    if (momenta.empty() || !Crew::divides(n, least_shared)) return false;
    std::vector<std::unique_ptr<Share>> shares(static_cast<std::size_t>(Crew::size()));
    std::vector<Unseen> unseen(static_cast<std::size_t>(n));
    const auto written = record_.written();
    record_.make_room(std::min(mesh_end(0), mesh_end(n)), std::max(mesh_end(0), mesh_end(n)));
    const auto close_one = [&](int slot, int begin, int end) {
        auto& share = shares[static_cast<std::size_t>(slot)];
        share.reset(new Share{{tables_, is_sparse()}, {tables_, system_.rule()}});   // which cannot be moved
        if (checks_.ignores_laws()) share->checks.ignore_laws();
        ElementCloser by{share->end, share->checks, share->report};
        share->is_believed = close_share(by, {begin, end}, criteria, momenta, unseen);
        share->closed = std::move(by.closed);
    };
    try {
        in_shares(n, least_shared, close_one);
    } catch (...) {   // stopped, or out of memory: nothing of it is in the motion
        record_.forget_but(written);
        throw;
    }
    std::erase(shares, nullptr);
    if (!std::ranges::all_of(shares, [](const auto& share) { return share->is_believed; })) {
        record_.forget_but(written);
        return false;
    }
    for (int e = 0; e < n; ++e)
        checks_.take(system_.nodes(), e, std::move(unseen[static_cast<std::size_t>(e)]));
    std::swap(end_.here(), shares.back()->end.here());
    closed = std::move(shares.back()->closed);
    closed.n_elements = n;
    is_ready_ = true;
    return true;
}

}   // namespace livens
