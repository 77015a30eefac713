// SPDX-License-Identifier: BSD-3-Clause
// Counting and rank of conditions by component: theory.md, "Conditions by component".
#include "livens/spacetime/march/components.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "livens/base/text.h"
#include "livens/multibody/model.h"
#include "livens/solvers/dense.h"
#include "livens/solvers/factors.h"
#include "livens/spacetime/march/condition_rows.h"
#include "livens/spacetime/march/conserved.h"
#include "livens/spacetime/march/end_point.h"
#include "livens/spacetime/march/given_momenta.h"
#include "livens/spacetime/march/numbered.h"

namespace livens::inline spacetime_internal {

namespace {

constexpr int n_places = 3;

/// Judges conditions at a few places; what is dependent at all of them is so by itself.
class Judgement {
public:
    Judgement(const ModelTables& tables, const ModelTables& at_end, const Ends& ends,
              const UnknownNumbers& unknowns)
        : tables_(tables), at_end_(at_end), ends_(ends), duration_(ends.end.t - ends.start.t), start_(tables),
          end_(at_end)
    {
        are_placed_ = start_.place(ends.start) && end_.place(ends.end);
        Scatter scatter;
        for (int i = 0; are_placed_ && i < n_places; ++i)
            for (auto* at : {&starts_, &ends_about_}) {
                const bool is_start = at == &starts_;
                at->emplace_back(is_start ? tables : at_end);
                place_about(is_start ? start_ : end_, is_start ? tables : at_end, 1 / duration_, scatter,
                            at->back());
            }
        by_numbers_.assign(n_places, DenseMatrix(static_cast<int>(ends.components.size()), ends.n_numbers));
        const bool has_numbers = !unknowns.is_empty() || !ends.periodic.unfolding.empty();
        if (are_placed_ && has_numbers) differentiate_by_numbers(unknowns);
    }

    std::optional<Complaint> complaint() const
    {
        const int needed = (ends_.is_start_known() ? 0 : 2 * tables_.freedoms()) + ends_.n_numbers;
        const int n = static_cast<int>(ends_.components.size());
        if (!are_placed_) return {};
        if (std::optional<Complaint> why = why_dependent()) return why;
        if (n > needed) return too_many(needed, n);
        if (n < needed) return too_few(needed, n);
        return {};
    }

    /// Quantities that are alike at both ends if the states are.
    std::vector<Condition> alike(const std::optional<AxisTurn>& turn) const
    {
        std::vector<Condition> all;
        for (const StateQuantity& q : candidates()) all.push_back({q, 0, Condition::At::both, true, turn});
        return clearest(all, 2 * tables_.freedoms());
    }

    /// Whether bodies that are turned about this axis move as they did, turned.
    bool is_symmetric_about(const AxisTurn& turn) const
    {
        return spacetime_internal::is_symmetric_about(tables_, starts_, turn);
    }

    /// What every motion keeps, with how conditions on quantities that are alike are unfolded by it.
    void unfold(const std::optional<AxisTurn>& turn, const std::vector<Condition>& alike, Ends& ends) const
    {
        const std::vector<StateQuantity> kept = conserved_quantities(tables_, starts_, duration_, turn);
        ends.periodic.unfolding = unfolding(tables_, start_, alike, kept, duration_);
        // at rest nothing changes the energy to first order
        if (ends.periodic.unfolding.empty())
            ends.periodic.unfolding = unfolding(tables_, starts_.front(), alike, kept, duration_);
        for (std::size_t i = 0; i < ends.periodic.unfolding.size(); ++i)
            ends.periodic.conserved.push_back(kept[i].name);
    }

    /// Places at an end, or places and rates, as quantities that tell them.
    std::vector<Condition> of_state(Condition::At at, bool has_rates) const
    {
        const EndPoint& point = at == Condition::At::end ? end_ : start_;
        std::vector<Condition> all;
        for (const StateQuantity& q : candidates())
            if (are_placed_ && (has_rates || !q.is_rate()) && point.is_known(q))
                all.push_back({q, point.value(q), at});
        const int f = (at == Condition::At::end ? at_end_ : tables_).freedoms();
        return clearest(all, (has_rates ? 2 : 1) * f);
    }

    bool is_driven() const { return depends_on_time(tables_, starts_, ends_.start.t, duration_); }

private:
    /// Of each condition the remainder at the place where it depends least on those before.
    std::vector<Remainder> least_dependent(const std::vector<Condition>& conditions) const
    {
        std::vector<Remainder> best;
        for (int place = 0; place < n_places; ++place) {
            const DenseMatrix rows =
                rows_at({&tables_, &at_end_}, conditions, {&starts_[place], &ends_about_[place]}, duration_,
                        by_numbers_[place]);
            if (!all_finite(rows.a)) continue;   // a coordinate has no derivative there, or joints lock
            const std::vector<Remainder> here = remainders(rows);
            if (best.empty()) best = here;
            for (std::size_t i = 0; i < here.size(); ++i)
                if (here[i].norm > best[i].norm) best[i] = here[i];
        }
        // nothing can be said beforehand: solving tells
        if (best.empty()) best.assign(conditions.size(), {1, 1, {}});
        return best;
    }

    /// What conditions miss in rebuilt models, with bodies that are pulled onto the joints of these.
    void differentiate_by_numbers(const UnknownNumbers& unknowns)
    {
        const TimeMesh mesh{{ends_.start.t, ends_.end.t}};
        std::vector<double> stated;
        for (const UnknownNumber& number : unknowns.numbers) stated.push_back(number.guess);
        Rebuilt whole;   // with the joints of all of time
        if (!unknowns.is_empty()) whole = unknowns.rebuild(stated);
        if (whole.refused) throw InputError(std::move(*whole.refused));
        const Model& model = whole.model != nullptr ? *whole.model : *tables_.model;
        const NumberedProblem problem(model, ends_, mesh, unknowns);
        for (int j = 0; j < problem.size(); ++j)   // with those of what unfolds it
            for (const NumberedProblem::Sample& sample : problem.samples(j, problem[j].guess))
                add_sample(problem.beside_guesses(j, sample.value), j, sample.weight);
    }

    void add_sample(const NumberedProblem::Instance& other, int j, double weight)
    {
        const Rebuilt& rebuilt = other.rebuilt;
        for (const bool is_end : {false, true}) {
            const Model model = acting_at_end(*rebuilt.model, rebuilt.start, rebuilt.end, is_end);
            const ModelTables tables(model, is_end ? at_end_.independent : tables_.independent);
            for (int place = 0; place < n_places; ++place) {
                EndPoint point(tables);
                const EndPoint& at = (is_end ? ends_about_ : starts_)[place];
                const bool is_placed = point.place(at.state());
                for (std::size_t i = 0; i < ends_.components.size(); ++i) {
                    const Condition& one = other.ends.components[i];
                    if (one.at == (is_end ? Condition::At::start : Condition::At::end)) continue;
                    const double sign = is_end || one.at == Condition::At::start ? 1 : -1;
                    const StateQuantity q = is_end ? one.at_end() : one.quantity,
                                        q_there = is_end ? ends_.components[i].at_end()
                                                         : ends_.components[i].quantity;
                    double value = is_placed ? point.value(q) : std::nan("");
                    if (q.counts_turns())   // off by less than half a turn
                        value = turned_to(value, at.value(q_there));
                    const double stated = one.at == Condition::At::both && !is_end ? 0 : one.value;
                    by_numbers_[place](static_cast<int>(i), j) +=
                        sign * weight * (value - stated) / unit_of(one.quantity, tables_.length, duration_);
                }
            }
        }
    }

    /// The n of them that tell the states at these very places best.
    std::vector<Condition> clearest(const std::vector<Condition>& all, int n) const
    {
        if (!are_placed_ || all.empty()) return {};
        DenseMatrix rows = rows_at({&tables_, &at_end_}, all, {&start_, &end_}, duration_, {});
        for (double& one : rows.a)
            if (!std::isfinite(one)) one = 0;
        const PivotedQR factors(transpose(rows));
        std::vector<Condition> chosen;
        for (int k = 0; k < std::min(n, factors.n_pivots()); ++k)
            if (factors.pivot(k) > 1e-6 * factors.pivot(0))
                chosen.push_back(all[static_cast<std::size_t>(factors.column(k))]);
        return chosen;
    }

    static bool is_dependent(const Remainder& row)
    {
        return !(row.norm > dependent * std::max(row.of, 1e-3));
    }

    std::optional<Complaint> why_dependent() const
    {
        const std::vector<Condition>& conditions = ends_.components;
        const std::vector<Remainder> rows = least_dependent(conditions);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (!is_dependent(rows[i])) continue;
            const Condition& one = conditions[i];
            if (rows[i].of < dependent) return of_joints(one);
            std::string others;
            for (std::size_t k = 0; k < i; ++k) {
                if (rows[i].shares[k] * 1e6 < 1) continue;
                if (conditions[k].quantity.name == one.quantity.name && conditions[k].at == one.at)
                    return Complaint{
                        "conditions-twice", path_of(one), in_words(one) + " is given twice", "", "", "",
                        "give it once"};
                others += (others.empty() ? "" : ", ") + in_words(conditions[k]);
            }
            return Complaint{"conditions-dependent",
                             path_of(one),
                             in_words(one) + " says nothing that other conditions do not say",
                             "",
                             "",
                             "the joints make it a function of " + others,
                             "leave it out, or give another quantity instead"};
        }
        return {};
    }

    /// A quantity that no free motion changes.
    Complaint of_joints(const Condition& one) const
    {
        const EndPoint& point = one.at == Condition::At::end ? end_ : start_;
        double held = point.value(one.quantity);
        if (one.quantity.counts_turns()) held = turned_to(held, one.value);
        if (one.at == Condition::At::both) held = 0;
        const bool is_met =
            std::abs(held - one.value) <= met_component * scale_of(one, tables_.length, duration_);
        if (is_met)
            return {"conditions-joints",
                    path_of(one),
                    "the joints hold " + in_words(one) + ", so that it is no condition on the motion",
                    to_text(one.value, 6) + " " + one.quantity.unit,
                    "",
                    "",
                    "leave it out"};
        return {"conditions-joints",
                path_of(one),
                in_words(one) + " contradicts the joints",
                to_text(one.value, 6) + " " + one.quantity.unit,
                to_text(held, 6) + " " + one.quantity.unit,
                "the joints hold it, and no motion changes it",
                "leave it out, or change the mechanism"};
    }

    std::string reason() const
    {
        std::string why = ends_.is_start_known()
                              ? std::string("the state at the start is known")
                              : "the joints leave " + std::to_string(tables_.freedoms()) +
                                    " motions free, and each has a place and a rate to be known";
        const std::string one = ends_.is_start_known() ? "one condition" : "one more";
        const int n_unknown = ends_.n_numbers - static_cast<int>(ends_.periodic.conserved.size());
        if (n_unknown == 1) why += "; the unknown number takes " + one;
        if (n_unknown > 1)
            why += "; the " + std::to_string(n_unknown) + " unknown numbers take " + one + " each";
        if (ends_.periodic.n_alike > 0)
            why += "; periodicity gives " + std::to_string(ends_.periodic.n_alike);
        for (const std::string& name : ends_.periodic.conserved)
            why += "; no motion changes its " + name + ", so that one more tells which it is";
        return why;
    }

    Complaint too_many(int needed, int n) const
    {
        if (ends_.periodic.n_alike > 0 && ends_.n_numbers == 0)
            return {"conditions-too-many",
                    "time.periodic",
                    "a periodic motion with a given period takes no other conditions",
                    std::to_string(n),
                    std::to_string(needed),
                    "that places and rates are alike at both ends are " + std::to_string(needed) +
                        " conditions",
                    "leave out what is known at the start and at the end, or periodic"};
        return {"conditions-too-many",
                path_of(ends_.components.back()),
                "too many conditions at the ends of time",
                std::to_string(n),
                std::to_string(needed),
                reason(),
                "leave out " + std::to_string(n - needed) + " of them"};
    }

    Complaint too_few(int needed, int n) const
    {
        const std::string free = free_in_words(needed - n);
        return {"conditions-too-few",
                ends_.is_start_known() ? "end.known" : "start.known",
                "too few conditions at the ends of time",
                std::to_string(n),
                std::to_string(needed),
                reason(),
                free.empty() ? "give more quantities" : "give for instance " + free};
    }

    /// Quantities that the conditions leave free, so many of them: of joints, else of bodies, at the end
    /// that has fewer conditions.
    std::string free_in_words(int n) const
    {
        std::vector<Condition> all = ends_.components;
        const std::size_t n_stated = all.size();
        const auto at_end = std::ranges::count(all, Condition::At::end, &Condition::at);
        const Condition::At at = 2 * at_end < static_cast<std::ptrdiff_t>(n_stated) || ends_.is_start_known()
                                     ? Condition::At::end
                                     : Condition::At::start;
        for (const StateQuantity& q : candidates()) all.push_back({q, 0, at});
        std::string list;
        const std::vector<Remainder> rows = least_dependent(all);
        for (std::size_t i = n_stated; i < all.size() && n > 0; ++i) {
            if (is_dependent(rows[i])) continue;
            list += (list.empty() ? "" : ", ") + in_words(all[i]);
            --n;
        }
        return list;
    }

    std::vector<StateQuantity> candidates() const
    {
        const Model& model = *tables_.model;
        std::vector<StateQuantity> all;
        for (const int derivative : {0, 1})
            for (const Joint& joint : model.joints())
                for (const NamedCoordinate& q : joint.coordinates)
                    all.push_back(
                        {joint.name + "." + q.name + (derivative == 1 ? "_rate" : ""), "", q, derivative});
        for (const Body& body : model.bodies())
            for (const char* what : {"position", "rotation", "velocity", "angular_velocity"}) {
                if (!body.is_matter() || (body.is_point && (what[0] == 'r' || what[0] == 'a'))) continue;
                const std::vector<StateQuantity> three = state_quantities(model, body.name + "." + what);
                all.insert(all.end(), three.begin(), three.end());
            }
        return all;
    }

    const ModelTables &tables_, &at_end_;   // of the start, where joints differ
    const Ends& ends_;
    double duration_;
    EndPoint start_, end_;
    bool are_placed_ = false;
    std::deque<EndPoint> starts_, ends_about_;
    std::vector<DenseMatrix> by_numbers_;   // at each place
};

}   // namespace

std::optional<Complaint> make_periodic(const ModelTables& tables, const Conditions& given, Ends& ends)
{
    const Judgement judgement(tables, tables, ends, {});
    const bool is_driven = judgement.is_driven();
    if (given.turn && (is_driven || !judgement.is_symmetric_about(*given.turn)))
        return Complaint{"periodic-turn",
                         "time.periodic",
                         "the motion cannot end as it began, turned about this axis",
                         "",
                         "",
                         is_driven
                             ? "loads or joints depend on time, and a turn of the bodies is no later time"
                             : "joints, loads or gravity are not alike after a turn about it",
                         "choose an axis about which all is alike, or give periodic = true"};
    const std::vector<Condition> alike = judgement.alike(given.turn);
    ends.periodic.is_free = !is_driven;
    if (!is_driven) judgement.unfold(given.turn, alike, ends);
    ends.n_numbers += static_cast<int>(ends.periodic.unfolding.size());
    if (!is_driven && ends.n_numbers == 0)
        return Complaint{
            "periodic-free",
            "time.periodic",
            "a periodic motion is not determined by its period here",
            "",
            "",
            "nothing depends on time: whatever moves periodically may begin at any instant of its period, "
            "and "
            "loads take or give energy, so that the period is one number and not another",
            "let the end of time be unknown, as end = { unknown = 2.5 }, and give a condition at the start "
            "that says when it begins; or let a load or a joint depend on time"};
    ends.periodic.n_alike = alike.size();
    ends.components.insert(ends.components.end(), alike.begin(), alike.end());
    return {};
}

void make_given(const ModelTables& at_start, const ModelTables& at_end, Ends& ends)
{
    const Judgement judgement(at_start, at_end, ends, {});
    for (const Condition::At at : {Condition::At::start, Condition::At::end}) {
        const Known known = at == Condition::At::start ? ends.at_start : ends.at_end;
        if (known == Known::nothing || (at == Condition::At::start && ends.is_start_known())) continue;
        const bool is_end = at == Condition::At::end;
        const State& stated = is_end ? ends.end : ends.start;
        const std::vector<Condition> all = known == Known::momenta
                                               ? given_momenta(is_end ? at_end : at_start, stated, at)
                                               : judgement.of_state(at, known == Known::state);
        ends.components.insert(ends.components.end(), all.begin(), all.end());
    }
    ends.whole[0] = std::exchange(ends.at_start, Known::nothing);
    ends.whole[1] = std::exchange(ends.at_end, Known::nothing);
}

std::optional<Complaint> why_undetermined(const ModelTables& at_start, const ModelTables& at_end,
                                          const Ends& ends, const UnknownNumbers& unknowns)
{
    return Judgement(at_start, at_end, ends, unknowns).complaint();
}

}   // namespace livens::inline spacetime_internal
